//! Figures of `inverse`: data and fit, residuals, slider force and crank torque with their bands.

use super::InverseReport;
use crate::error::Error;
use crate::inverse::Inverse;
use crate::report::curves::{CURVE_POINTS, axis};
use crate::report::quantity::Quantity;
use crate::report::{Axis, Figure, Report, Sheet, View};

/// Returns data and fit, residuals, force and torque as SVG, with the forces printed by Duarte et al. if given.
pub(super) fn figure(report: &InverseReport, view: &View) -> Result<String, Error> {
    let result = report.result;
    let mut figures = vec![motion(result), residuals(result)];
    figures.extend(loads(report, view)?);
    let sheet = Sheet {
        title: &result.summary.scene,
        columns: 2,
        size: view.size,
    };
    sheet.svg(&figures)
}

/// Returns the time axis over all samples, with or without a force.
fn time(result: &Inverse) -> Axis {
    let data = &result.summary.data;
    Axis::linear("time [s]").around(data.from_s, data.to_s)
}

fn measured(result: &Inverse) -> Quantity {
    let data = &result.summary.data;
    Quantity::of(&format!("{}_{}", data.column, data.unit))
}

/// Returns the stride between drawn rows that leaves at most `most`.
fn stride(rows: usize, most: usize) -> usize {
    rows.div_ceil(most).max(1)
}

/// Returns the label of points, with the stride if some are left out.
fn one_in(stride: usize, name: &str) -> String {
    match stride {
        1 => name.to_owned(),
        _ => format!("{name}, one in {stride}"),
    }
}

fn motion(result: &Inverse) -> Figure {
    let quantity = measured(result);
    let scale = quantity.factor;
    // More samples would hide the fit.
    let most_samples = 100;
    let few = stride(result.residuals.len(), most_samples);
    let many = stride(result.residuals.len(), CURVE_POINTS);
    let samples = result.residuals.iter().step_by(few);
    let fit = result.residuals.iter().step_by(many);
    Figure::new(
        format!(
            "{}: samples and {} fit",
            quantity.label, result.summary.fit.kind
        ),
        time(result),
        axis(&quantity.label, &quantity.unit),
    )
    .points(
        one_in(few, "samples"),
        samples.map(|s| (s.t, s.measured * scale)).collect(),
    )
    .line(
        "fit",
        fit.map(|s| (s.t, (s.measured - s.residual) * scale))
            .collect(),
    )
}

fn residuals(result: &Inverse) -> Figure {
    let Quantity {
        unit,
        factor: scale,
        ..
    } = measured(result);
    let (data, sigma) = (&result.summary.data, result.summary.fit.sigma * scale);
    let many = stride(result.residuals.len(), CURVE_POINTS);
    let list = result.residuals.iter().step_by(many);
    let level = |y: f64| [data.from_s, data.to_s].map(|t| (t, y)).to_vec();
    let label = "twice the standard deviation of a sample";
    Figure::new(
        "residuals",
        time(result),
        Axis::linear(format!("measured minus fitted [{unit}]")),
    )
    .points(
        one_in(many, "residuals"),
        list.map(|s| (s.t, s.residual * scale)).collect(),
    )
    .dashed(label, level(2.0 * sigma))
    .dashed(label, level(-2.0 * sigma))
}

/// Returns the panels of force and torque with their bands, marked where the force is not determined.
fn loads(report: &InverseReport, view: &View) -> Result<Vec<Figure>, Error> {
    let result = report.result;
    let mut panels = view.figures(&report.table(), &report.default_view())?;
    for panel in &mut panels {
        panel.x = time(result);
    }
    let most_marks = 40;
    let bands = &result.summary.dead_centre_bands;
    let few = stride(bands.len(), most_marks);
    let marked = bands
        .iter()
        .step_by(few)
        .map(|band| 0.5 * (band.from_s + band.to_s));
    panels[0] = marked.fold(panels[0].clone(), |figure, t| {
        figure.vertical_mark(t, one_in(few, "not determined"))
    });
    let cut = match panels[0].y.has_range() {
        true => "; peaks at dead centres are cut off",
        false => "",
    };
    panels[0].title = format!("slider force with 95 % band{cut}");
    panels[1].title = "crank torque that does the same, with 95 % band".to_owned();
    Ok(panels)
}
