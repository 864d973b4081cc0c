//! Summaries for people.

use std::f64::consts::TAU;
use std::fmt::Write;

use super::joint::clearance;
use super::key_values::{Facts, aligned, degrees, fact, in_turn, six, with_error};
use super::steady::steady_state;
use crate::kinematics::{Kinematics, Located, NamedPosition};
use crate::simulate::{Row, Summary, TorqueRange};

/// Characters of the longest name of a position.
pub(super) const NAMES: usize = 24;

/// What there is to say of a run.
pub(super) fn run(summary: &Summary) -> Facts {
    let mut facts = Facts::of(&summary.scene);
    facts.add("engine", &summary.engine);
    end(&mut facts, summary);
    if let Some(torque) = &summary.driving_torque {
        let TorqueRange {
            min_nm,
            max_nm,
            mean_nm,
        } = *torque;
        let [least, most, mean] = [min_nm, max_nm, mean_nm].map(six);
        fact!(
            facts,
            "driving torque",
            "{least} to {most} N m, mean {mean} N m"
        );
    }
    for (name, peak) in summary.peaks.iter().flat_map(|peaks| peaks.named()) {
        let (value, t, angle) = (six(peak.value_n), six(peak.t_s), in_turn(peak.theta_rad));
        fact!(facts, name, "at most {value} N, at t = {t} s, {angle} deg");
    }
    let (relative, residual) = (summary.energy_residual, summary.energy_residual_j);
    if relative.is_finite() {
        fact!(
            facts,
            "energy residual",
            "{relative:.1e} of the largest energy ({residual:.1e} J)"
        );
    }
    let (evaluations, steps) = (summary.evaluations, summary.steps);
    let time = seconds(summary.wall_s);
    fact!(
        facts,
        "cost",
        "{evaluations} evaluations, {steps} steps, {time}"
    );
    if let Some(cost) = &summary.estimate_cost {
        let (evaluations, time) = (cost.evaluations, seconds(cost.wall_s));
        fact!(
            facts,
            "  of the estimate",
            "{evaluations} evaluations, {time}"
        );
    }
    facts.add("events", events(summary));
    if let Some(joint) = &summary.clearance {
        clearance(&mut facts, joint);
    }
    if let Some(steady) = &summary.steady_state {
        steady_state(&mut facts, steady);
    }
    facts.warnings(&summary.warnings);
    if let Some(stopped) = &summary.stopped {
        facts.add("stopped early", stopped);
    }
    facts
}

/// The last state, and the speeds on the way to it.
fn end(facts: &mut Facts, summary: &Summary) {
    let last = &summary.last;
    let error = summary.error_estimate;
    let shown = |value: f64, error: Option<f64>, unit: &str| match error {
        Some(error) => with_error(value, error, unit),
        None => format!("{} {unit}, error not estimated", six(value)),
    };
    fact!(facts, "end", "t = {} s", six(last.t_s));
    let angle = shown(last.theta_rad, error.map(|e| e.theta_rad), "rad");
    facts.add("  crank angle", angle);
    let speed = shown(
        last.omega_rad_per_s,
        error.map(|e| e.omega_rad_per_s),
        "rad/s",
    );
    facts.add("  crank speed", speed);
    facts.add("turns", six(summary.revolutions));
    let [least, largest] = [summary.omega_min, summary.omega_max].map(bound);
    fact!(facts, "crank speed", "{least} to {largest} rad/s");
}

fn events(summary: &Summary) -> String {
    let counted = |kind: &str, noun: &str| {
        let number = summary.events.iter().filter(|e| e.kind == kind).count();
        let plural = if number == 1 { "" } else { "s" };
        (number, format!("{number} {noun}{plural}"))
    };
    if summary.clearance.is_some() {
        return format!(
            "{} dead centres, impacts and separations",
            summary.events_total
        );
    }
    if summary.events_total > summary.events.len() as u64 {
        return format!("{} in all", summary.events_total);
    }
    let (_, mut text) = counted("dead-centre", "dead centre");
    let (_, turning_points) = counted("turning-point", "turning point");
    let _ = write!(text, ", {turning_points}");
    for kind in ["limit", "stick", "slip", "rest"] {
        let (number, said) = counted(kind, kind);
        if number > 0 {
            let _ = write!(text, ", {said}");
        }
    }
    text
}

fn bound(speed: f64) -> String {
    if speed.is_finite() {
        six(speed)
    } else {
        "no bound".to_owned()
    }
}

fn seconds(value: f64) -> String {
    match value {
        v if v < 1e-3 => format!("{:.1} us", v * 1e6),
        v if v < 1.0 => format!("{:.2} ms", v * 1e3),
        v => format!("{v:.2} s"),
    }
}

/// Rows in columns that stand below each other.
pub(super) fn table(rows: &[Row]) -> String {
    const WIDTHS: [isize; 6] = [12, 10, 11, 14, 11, 11];
    let [theta, omega, x, v] = ["theta [deg]", "omega [rad/s]", "x [mm]", "v [m/s]"];
    let mut text = aligned(&WIDTHS, ["t [s]", "turns", theta, omega, x, v]);
    for row in rows {
        let turns = (row.theta / TAU).floor();
        let cells = [
            format!("{:.6}", row.t),
            turns.to_string(),
            format!("{:.4}", (row.theta - turns * TAU).to_degrees()),
            format!("{:.6}", row.omega),
            format!("{:.4}", row.x * 1e3),
            // Minus zero is zero.
            format!("{:.5}", row.v + 0.0),
        ];
        text += &aligned(&WIDTHS, cells);
    }
    text
}

/// Where a named position is, and why it has its name.
pub(super) fn place(position: &NamedPosition) -> String {
    let from = degrees(position.theta_rad);
    let to = position.to_rad.map(degrees);
    let to = to.map_or(String::new(), |to| format!(" to {to}"));
    format!("{from}{to} deg: {}", position.reason)
}

/// Where an extreme is.
pub(super) fn extreme(found: &Located, unit: &str) -> String {
    format!(
        "{} {unit} at {} deg",
        six(found.value),
        degrees(found.theta_rad)
    )
}

/// What the lengths give.
pub(super) fn kinematics(result: &Kinematics) -> Facts {
    let mut facts = Facts::of(&result.scene);
    facts.add("class", result.class);
    fact!(facts, "stroke", "{} m", six(result.stroke_m));
    for dead_centre in &result.dead_centres {
        let (angle, x) = (degrees(dead_centre.theta_rad), six(dead_centre.x_m));
        facts.add(
            format_args!("{} dead centre", dead_centre.kind),
            format_args!("{angle} deg, x = {x} m"),
        );
    }
    if let (Some(advance), Some(back), Some(ratio)) =
        (result.advance_rad, result.return_rad, result.time_ratio)
    {
        fact!(facts, "outward stroke", "{} deg", degrees(advance));
        fact!(facts, "inward stroke", "{} deg", degrees(back));
        facts.add("time ratio", six(ratio));
    }
    for reach in &result.reach_rad {
        let [from, to] = reach.map(degrees);
        fact!(facts, "reachable crank angles", "{from} to {to} deg");
    }
    for position in &result.positions {
        if position.kind != "dead-centre" {
            facts.add(position.kind, place(position));
        }
    }
    let transmission = degrees(result.transmission_min_rad);
    fact!(facts, "least transmission", "{transmission} deg");
    let units = match result.speed_rad_per_s {
        Some(_) => ["m/s", "m/s2"],
        None => ["m/rad", "m/rad2"],
    };
    for (name, found, unit) in [
        ("largest velocity", result.velocity_max, units[0]),
        ("smallest velocity", result.velocity_min, units[0]),
        ("largest acceleration", result.acceleration_max, units[1]),
        ("smallest acceleration", result.acceleration_min, units[1]),
    ] {
        if let Some(found) = found {
            facts.add(name, extreme(&found, unit));
        }
    }
    facts.warnings(&result.warnings);
    facts
}
