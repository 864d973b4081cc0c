//! Figures 7 and 8.

use super::super::drawing::{Drawing, Plot, sampled};
use super::{CALIBRATION, FORCES, described, force, held, least};
use crate::error::Error;
use crate::numeric::line_fit::LineFit;
use crate::statics::{StaticAnalysis, StaticsRow};

pub fn drawings() -> Result<Vec<Drawing>, Error> {
    let points = CALIBRATION
        .map(|(_, weight, strain)| (weight, strain))
        .to_vec();
    let line = LineFit::new(&points);
    let fitted = sampled(0.0, 15.0, 30, |force| {
        line.map_or(f64::NAN, |line| line.value(force))
    });
    let (described, doubled) = (held(described())?, held(2.0 * described())?);
    let theory = |analysis: &StaticAnalysis, of: fn(&StaticsRow) -> f64| {
        sampled(10.0, 160.0, 150, |degrees| {
            of(&analysis.row(degrees.to_radians()))
        })
    };
    let column = |cell: fn(&(f64, &str, &str, &str, &str)) -> f64| -> Vec<(f64, f64)> {
        FORCES.iter().map(|row| (row.0, cell(row))).collect()
    };
    let force_plot = Plot::new("crank angle [deg]", "slider force [N]")
        .line("F, T = 264.87 N mm", theory(&doubled, force))
        .line("F' of (8), T = 264.87 N mm", theory(&doubled, least))
        .dashed(
            "F, T = 132.435 N mm as described",
            theory(&described, force),
        )
        .points("F printed", column(|row| row.1.parse().unwrap_or(f64::NAN)))
        .points(
            "F' printed",
            column(|row| row.2.parse().unwrap_or(f64::NAN)),
        )
        .points(
            "F' measured",
            column(|row| row.3.parse().unwrap_or(f64::NAN)),
        );
    Ok(vec![
        Drawing::new(
            "figure-07",
            "Calibration of the force transducer",
            vec![
                Plot::new("weight [N]", "strain [1e-6]")
                    .points("table 1", points)
                    .line("least squares", fitted),
            ],
        ),
        Drawing::new("figure-08", "Slider force at rest", vec![force_plot]),
    ])
}
