//! Figures of `inverse`: data and fit, residuals, slider force and crank torque with their bands.

use crate::error::Error;
use crate::report::{Axis, Figure, panels};
use crate::study::Inverse;

/// Points of a curve that a figure shows.
const POINTS: usize = 2000;

/// Samples that are drawn over the fit, so that both are seen.
const SAMPLES: usize = 100;

/// Data, fit, residuals, force and torque side by side, as SVG.
///
/// # Errors
/// [`Error::Write`] if it cannot be drawn.
pub fn inverse_figure(result: &Inverse) -> Result<String, Error> {
    let summary = &result.summary;
    let (data, factor) = (&summary.data, summary.band_factor);
    let (name, unit, scale) = match data.column {
        "x" => ("slider position x", "mm", 1e3),
        "gamma" => ("crank-pin angle gamma", "deg", 1f64.to_degrees()),
        _ => ("crank angle theta", "deg", 1f64.to_degrees()),
    };
    let stride = result.rows.len().div_ceil(POINTS);
    let rows = || result.rows.iter().step_by(stride);
    let samples = || result.residuals.iter().step_by(stride);
    let time = || Axis::linear("time [s]");
    let few = result
        .residuals
        .iter()
        .step_by(result.residuals.len().div_ceil(SAMPLES));
    let measured = few.map(|s| (s.t, s.measured * scale)).collect();
    let fitted = samples()
        .map(|s| (s.t, (s.measured - s.residual) * scale))
        .collect();
    let motion = Figure::new(
        format!("{name}: samples and {} fit", summary.fit.kind),
        time(),
        Axis::linear(format!("{name} [{unit}]")),
    )
    .points("samples", measured)
    .line("fit", fitted);
    let sigma = summary.fit.sigma * scale;
    let ends = [data.from_s, data.to_s];
    let residuals = Figure::new(
        "residuals",
        time(),
        Axis::linear(format!("measured minus fitted [{unit}]")),
    )
    .points(
        "residual",
        samples().map(|s| (s.t, s.residual * scale)).collect(),
    )
    .dashed(
        "twice their standard deviation",
        ends.map(|t| (t, 2.0 * sigma)).to_vec(),
    )
    .dashed(
        "twice their standard deviation",
        ends.map(|t| (t, -2.0 * sigma)).to_vec(),
    );
    let force = |row: &crate::study::InverseRow, side: f64| {
        row.slider_force.unwrap_or(f64::NAN)
            + side * factor * row.slider_force_se.unwrap_or(f64::NAN)
    };
    let mut forces = Figure::new(
        "slider force with 95 % band",
        time(),
        Axis::linear("slider force [N]"),
    )
    .band(
        "slider force",
        rows()
            .map(|r| (r.t, force(r, -1.0), force(r, 1.0)))
            .collect(),
    )
    .line(
        "slider force",
        rows().map(|r| (r.t, force(r, 0.0))).collect(),
    );
    for band in summary.dead_centre_bands.iter().take(40) {
        forces = forces.vertical_mark(
            0.5 * (band.from_s + band.to_s),
            "not determined (dead centre)",
        );
    }
    let torque = |row: &crate::study::InverseRow, side: f64| {
        row.crank_torque + side * factor * row.crank_torque_se
    };
    let torques = Figure::new(
        "crank torque that does the same, with 95 % band",
        time(),
        Axis::linear("crank torque [N m]"),
    )
    .band(
        "crank torque",
        rows()
            .map(|r| (r.t, torque(r, -1.0), torque(r, 1.0)))
            .collect(),
    )
    .line(
        "crank torque",
        rows().map(|r| (r.t, r.crank_torque)).collect(),
    );
    panels(&summary.scene, &[motion, residuals, forces, torques], 2)
}
