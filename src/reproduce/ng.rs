//! Ng: static forces with friction, equations (1)-(11), (A1)-(A3), tables 1 and 2. This module computes the values
//! without formula: the calibration line, and the points of the tables in the figures.

use super::drawing::{Drawing, Style};
use super::formulas::{PaperFormulas, files};
use super::quantities::{self, MechanismQuantities};
use crate::error::Error;
use crate::mechanism::friction_from_tilt;
use crate::numeric::line_fit::LineFit;
use crate::scene::{Load, Scene};
use crate::statics::{StaticsOptions, statics};

/// Table 1: weights, N, and strains, 1e-6.
const CALIBRATION: [(f64, f64); 6] = [
    (2.45, 50.0),
    (4.91, 95.0),
    (7.36, 148.0),
    (9.81, 190.0),
    (12.27, 238.0),
    (14.72, 290.0),
];

pub(super) fn formulas() -> Result<PaperFormulas, Error> {
    let symbols = PaperFormulas::new(files!("ng"))?;
    let [k, c, torque] = symbols.numbers(["k", "c", "torque"])?;
    let friction = friction_from_tilt(std::f64::consts::FRAC_PI_4);
    let held = |torque: f64| -> Result<MechanismQuantities, Error> {
        let scene = Scene::new(k, c).torque(Load::Constant(torque));
        let options = StaticsOptions {
            friction: Some(friction),
            ..StaticsOptions::default()
        };
        Ok(MechanismQuantities::held(
            scene.clone(),
            statics(&scene, &options)?,
        ))
    };
    let mechanisms = vec![
        ("described", held(torque)?),
        ("doubled", held(2.0 * torque)?),
    ];
    let line = LineFit::new(&CALIBRATION);
    let about_zero = LineFit::through_origin(&CALIBRATION);
    let of_tables = move |name: &str, theta: f64| match name {
        "friction" => Some(friction),
        "r_squared" => line.and_then(|line| line.r_squared),
        "r_squared_about_zero" => about_zero.map(|fit| fit.1),
        "strain" => line.map(|line| line.value(theta)),
        _ => None,
    };
    Ok(symbols.with(quantities::of(mechanisms, of_tables)))
}

/// Returns the figures, with the points of the tables.
pub(super) fn drawings(formulas: &PaperFormulas) -> Result<Vec<Drawing>, Error> {
    let mut drawings = formulas.drawings()?;
    let printed = |what: &str| formulas.column("table 2", what);
    let (forces, found) = (printed("F at")?, printed("F' by experiment")?);
    let at = |angle: f64| found.iter().find(|point| point.0 == angle);
    let measured = |&(angle, _): &(f64, f64)| (angle, at(angle).map_or(f64::NAN, |point| point.1));
    let measured = forces.iter().map(measured).collect();
    let tables = [
        ("table 1", CALIBRATION.to_vec()),
        ("F printed", forces),
        ("F' printed", printed("F' by theory")?),
        ("F' measured", measured),
    ];
    for drawing in &mut drawings {
        for series in drawing.plots.iter_mut().flat_map(|plot| &mut plot.series) {
            let table = tables.iter().find(|(label, _)| *label == series.label);
            if let (Style::Points, Some((_, points))) = (series.style, table) {
                series.points.clone_from(points);
            }
        }
    }
    Ok(drawings)
}
