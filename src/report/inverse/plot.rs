//! Figures of `inverse`: data and fit, residuals, slider force and crank torque with their bands.

use crate::error::Error;
use crate::inverse::{AsPrinted, Inverse, InverseRow};
use crate::report::curves::CURVE_POINTS;
use crate::report::key_values::rounded;
use crate::report::{Axis, Figure, Shape, Sheet};

/// Returns data and fit, residuals, force and torque as SVG, with the forces printed by Duarte et al. if given.
pub(super) fn figure(
    result: &Inverse,
    printed: Option<&AsPrinted>,
    size: Option<Shape>,
) -> Result<String, Error> {
    let figures = [
        motion(result),
        residuals(result),
        forces(result, printed),
        torques(result),
    ];
    let sheet = Sheet {
        title: &result.summary.scene,
        columns: 2,
        size,
    };
    sheet.svg(&figures)
}

/// Returns the time axis over all samples, with or without a force.
fn time(result: &Inverse) -> Axis {
    let data = &result.summary.data;
    Axis::linear("time [s]").around(data.from_s, data.to_s)
}

/// Returns name and displayed unit of the measured quantity, and the factor from SI to this unit.
fn quantity(result: &Inverse) -> (&'static str, &'static str, f64) {
    match result.summary.data.column {
        "x" => ("slider position x", "mm", 1e3),
        "gamma" => ("crank-pin angle γ", "°", 1f64.to_degrees()),
        _ => ("crank angle θ", "°", 1f64.to_degrees()),
    }
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
    let (name, unit, scale) = quantity(result);
    // More samples would hide the fit.
    let most_samples = 100;
    let few = stride(result.residuals.len(), most_samples);
    let many = stride(result.residuals.len(), CURVE_POINTS);
    let samples = result.residuals.iter().step_by(few);
    let fit = result.residuals.iter().step_by(many);
    Figure::new(
        format!("{name}: samples and {} fit", result.summary.fit.kind),
        time(result),
        match unit {
            "°" => Axis::degrees(format!("{name} [{unit}]")),
            _ => Axis::linear(format!("{name} [{unit}]")),
        },
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
    let (_, unit, scale) = quantity(result);
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

fn forces(result: &Inverse, printed: Option<&AsPrinted>) -> Figure {
    let summary = &result.summary;
    let rows = drawn(result);
    let of = |row: &InverseRow, side: f64| {
        let error = row.slider_force_se.unwrap_or(f64::NAN);
        row.slider_force.unwrap_or(f64::NAN) + side * summary.band_factor * error
    };
    let with_arm = |row: &&InverseRow| Some((row.slider_force?, result.lever_arm(row)));
    let values: Vec<_> = rows.iter().flatten().filter_map(with_arm).collect();
    let (axis, cut) = without_peaks("slider force [N]", &values);
    let force = summary.slider_force.as_ref();
    let median = force.map_or(f64::NAN, |force| force.median_se);
    let label = band_label("slider force", median * summary.band_factor, "N");
    let title = match cut {
        true => "slider force with 95 % band; peaks at dead centres are cut off",
        false => "slider force with 95 % band",
    };
    let line = |value: &dyn Fn(&InverseRow) -> f64| -> Vec<(f64, f64)> {
        let point =
            |row: &Option<&InverseRow>| row.map_or((f64::NAN, f64::NAN), |r| (r.t, value(r)));
        rows.iter().map(point).collect()
    };
    let mut figure = Figure::new(title, time(result), axis)
        .band(&label, band(&rows, of))
        .line(&label, line(&|row| of(row, 0.0)));
    if let Some(printed) = printed {
        let force = |which: usize| {
            move |row: &InverseRow| printed.forces(row).map_or(f64::NAN, |f| f[which])
        };
        figure = figure
            .line("energies of the paper", line(&force(0)))
            .dashed("(9) as printed", line(&force(1)));
    }
    let most_marks = 40;
    let few = stride(summary.dead_centre_bands.len(), most_marks);
    for band in summary.dead_centre_bands.iter().step_by(few) {
        let label = one_in(few, "not determined");
        figure = figure.vertical_mark(0.5 * (band.from_s + band.to_s), label);
    }
    figure
}

fn torques(result: &Inverse) -> Figure {
    let factor = result.summary.band_factor;
    let of = |row: &InverseRow, side: f64| {
        let value = row.crank_torque.zip(row.crank_torque_se);
        value.map_or(f64::NAN, |(torque, error)| torque + side * factor * error)
    };
    let rows: Vec<_> = drawn(result).into_iter().filter(Option::is_some).collect();
    let half = result.summary.crank_torque.median_se * factor;
    let label = band_label("crank torque", half, "N m");
    let line = rows.iter().flatten().map(|row| (row.t, of(row, 0.0)));
    Figure::new(
        "crank torque that does the same, with 95 % band",
        time(result),
        Axis::linear("crank torque [N m]"),
    )
    .band(&label, band(&rows, of))
    .line(&label, line.collect())
}

/// Returns the drawn rows, with a gap where the lever arm x' changes sign: the force has a pole at a dead centre, with
/// opposite signs on its sides.
fn drawn(result: &Inverse) -> Vec<Option<&InverseRow>> {
    let stride = stride(result.rows.len(), CURVE_POINTS);
    let mut drawn = Vec::new();
    let mut side = 0.0;
    for row in result.rows.iter().step_by(stride) {
        let now = result.lever_arm(row).signum();
        if side * now < 0.0 {
            drawn.push(None);
        }
        drawn.push(Some(row));
        side = now;
    }
    drawn
}

fn band(
    rows: &[Option<&InverseRow>],
    of: impl Fn(&InverseRow, f64) -> f64,
) -> Vec<(f64, f64, f64)> {
    let ends = |row: &InverseRow| (row.t, of(row, -1.0), of(row, 1.0));
    let gap = (f64::NAN, f64::NAN, f64::NAN);
    rows.iter().map(|row| row.map_or(gap, ends)).collect()
}

/// Returns the label of a value with the median half-width of its band, which may be too narrow to see.
fn band_label(name: &str, half: f64, unit: &str) -> String {
    if half.is_nan() {
        return name.to_owned();
    }
    format!("{name}, band +- {} {unit} at the median", rounded(half, 2))
}

/// Returns an axis for (force, lever arm) pairs, and whether it cuts off peaks near dead centres: the range holds the
/// central forces, widened by their range, and all forces on a long arm, which belong to no peak.
fn without_peaks(label: &str, forces: &[(f64, f64)]) -> (Axis, bool) {
    let axis = Axis::linear(label);
    let mut sorted: Vec<f64> = forces.iter().map(|(force, _)| *force).collect();
    sorted.sort_unstable_by(f64::total_cmp);
    let Some(last) = sorted.len().checked_sub(1) else {
        return (axis, false);
    };
    let share_at_each_end = 0.025;
    let beyond = (share_at_each_end * last as f64) as usize;
    let (low, high) = (sorted[beyond], sorted[last - beyond]);
    let longest = forces.iter().map(|(_, arm)| arm.abs()).fold(0.0, f64::max);
    let is_long = |(_, arm): &&(f64, f64)| arm.abs() > 0.1 * longest;
    let long = forces.iter().filter(is_long);
    let (low, high) = long.fold(
        (2.0 * low - high, 2.0 * high - low),
        |(low, high), (force, _)| (low.min(*force), high.max(*force)),
    );
    let (lowest, highest) = (sorted[0], sorted[last]);
    if low <= lowest && highest <= high {
        return (axis, false);
    }
    (axis.around(low.max(lowest), high.min(highest)), true)
}
