//! Figures of `inverse`: data and fit, residuals, slider force and crank torque with their bands.

use super::InverseReport;
use super::rows::unit_in_names;
use crate::error::Error;
use crate::figure::{Axis, Figure, sheet};
use crate::inverse::{Inverse, Residual};
use crate::report::curves::{CURVE_POINTS, axis};
use crate::report::quantity::Quantity;
use crate::report::{Report, View};

/// Returns data and fit, residuals, force and torque as SVG, with the forces printed by Duarte et al. if given.
pub(super) fn figure(report: &InverseReport, view: &View) -> Result<String, Error> {
    let mut figures = samples(report.result).to_vec();
    figures.extend(loads(report, view)?);
    sheet(&report.result.summary.scene, 2, view.size, &figures)
}

/// Returns the time axis over all samples, with or without a force.
fn time(result: &Inverse) -> Axis {
    let data = &result.summary.data;
    Axis::linear("time [s]").around(data.from_s, data.to_s)
}

/// Returns the stride between drawn items that leaves at most `most`, and the label that tells it if some are left out.
fn thinned(items: usize, most: usize, name: &str) -> (usize, String) {
    match items.div_ceil(most) {
        0 | 1 => (1, name.to_owned()),
        stride => (stride, format!("{name}, one in {stride}")),
    }
}

/// Returns the panels of the samples with their fit, and of the residuals.
fn samples(result: &Inverse) -> [Figure; 2] {
    let (data, fit) = (&result.summary.data, &result.summary.fit);
    let Quantity {
        label,
        unit,
        factor,
        ..
    } = Quantity::of(&format!("{}_{}", data.column, unit_in_names(data)));
    let points = |stride, value: fn(&Residual) -> f64| {
        let samples = result.residuals.iter().step_by(stride);
        samples.map(|s| (s.t, value(s) * factor)).collect()
    };
    let count = result.residuals.len();
    // More samples would hide the fit.
    let (few, measured) = thinned(count, 100, "samples");
    let (many, residuals) = thinned(count, CURVE_POINTS, "residuals");
    let level = |y: f64| [data.from_s, data.to_s].map(|t| (t, y)).to_vec();
    let (spread, sigma) = (
        "twice the standard deviation of a sample",
        fit.sigma * factor,
    );
    [
        Figure::new(
            format!("{label}: samples and {} fit", fit.kind),
            time(result),
            axis(&label, &unit),
        )
        .points(measured, points(few, |s| s.measured))
        .line("fit", points(many, |s| s.measured - s.residual)),
        Figure::new(
            "residuals",
            time(result),
            Axis::linear(format!("measured minus fitted [{unit}]")),
        )
        .points(residuals, points(many, |s| s.residual))
        .dashed(spread, level(2.0 * sigma))
        .dashed(spread, level(-2.0 * sigma)),
    ]
}

/// Returns the panels of force and torque with their bands, marked where the force is not determined.
fn loads(report: &InverseReport, view: &View) -> Result<Vec<Figure>, Error> {
    let mut panels = view.figures(&report.table(), &report.default_view())?;
    for panel in &mut panels {
        panel.x = time(report.result);
    }
    let bands = &report.result.summary.dead_centre_bands;
    let (stride, label) = thinned(bands.len(), 40, "not determined");
    let middles = bands.iter().step_by(stride);
    let middles = middles.map(|band| 0.5 * (band.from_s + band.to_s));
    panels[0] = middles.fold(panels[0].clone(), |figure, t| {
        figure.vertical_mark(t, &label)
    });
    let cut = match panels[0].y.range.is_some() {
        true => "; peaks at dead centres are cut off",
        false => "",
    };
    panels[0].title = format!("slider force with 95 % band{cut}");
    panels[1].title = "crank torque that does the same, with 95 % band".to_owned();
    Ok(panels)
}
