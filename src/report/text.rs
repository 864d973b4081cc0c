//! Summaries for people.

use std::f64::consts::TAU;
use std::fmt::Write;

use super::joint::clearance;
use super::steady::steady_state;
use crate::study::{Kinematics, Located, NamedPosition, Row, Summary};

/// The summary of a run, with a few of its rows.
pub fn summary(summary: &Summary, rows: &[Row]) -> String {
    let mut text = String::new();
    for (name, value) in facts(summary) {
        let _ = writeln!(text, "{name:<17} {value}");
    }
    if !rows.is_empty() {
        text.push('\n');
        text.push_str(&table(rows));
    }
    text
}

/// What there is to say of a run, each with its name; names that belong to the one before begin with spaces.
pub(super) fn facts(summary: &Summary) -> Vec<(String, String)> {
    let mut facts = Vec::new();
    let mut put = |name: &str, value: String| facts.push((name.to_owned(), value));
    if !summary.scene.is_empty() {
        put("scene", summary.scene.clone());
    }
    put(
        "engine",
        format!("{} ({})", summary.engine, summary.plan.reason),
    );
    let last = &summary.last;
    let error = summary.error_estimate;
    let plus_minus = |value: f64, bound: Option<f64>, unit: &str| match bound {
        Some(bound) => format!("{} +- {bound:.1e} {unit}", digits(value, bound)),
        None => format!("{value} {unit}, error not estimated"),
    };
    put("end", format!("t = {} s", last.t_s));
    put(
        "  crank angle",
        plus_minus(last.theta_rad, error.map(|e| e.theta_rad), "rad"),
    );
    put(
        "  crank speed",
        plus_minus(
            last.omega_rad_per_s,
            error.map(|e| e.omega_rad_per_s),
            "rad/s",
        ),
    );
    put("turns", format!("{}", summary.revolutions));
    put(
        "crank speed",
        format!(
            "{} to {} rad/s",
            bound(summary.omega_min),
            bound(summary.omega_max)
        ),
    );
    if let Some(torque) = &summary.driving_torque {
        put(
            "driving torque",
            format!(
                "{} to {} N m, mean {} N m",
                torque.min_nm, torque.max_nm, torque.mean_nm
            ),
        );
    }
    put(
        "energy residual",
        format!(
            "{:.1e} of the largest energy ({:.1e} J)",
            summary.energy_residual, summary.energy_residual_j
        ),
    );
    put(
        "cost",
        format!(
            "{} evaluations, {} steps, {}",
            summary.evaluations,
            summary.steps,
            seconds(summary.wall_s)
        ),
    );
    if let Some(cost) = &summary.estimate_cost {
        put(
            "  of the estimate",
            format!("{} evaluations, {}", cost.evaluations, seconds(cost.wall_s)),
        );
    }
    put("events", events(summary));
    if let Some(joint) = &summary.clearance {
        clearance(&mut put, joint);
    }
    if let Some(steady) = &summary.steady_state {
        steady_state(&mut put, steady);
    }
    for warning in &summary.warnings {
        put("warning", warning.clone());
    }
    if let Some(stopped) = &summary.stopped {
        put("stopped early", stopped.clone());
    }
    facts
}

fn events(summary: &Summary) -> String {
    let count = |kind: &str| summary.events.iter().filter(|e| e.kind == kind).count();
    if summary.clearance.is_some() {
        return format!(
            "{} dead centres, impacts and separations",
            summary.events_total
        );
    }
    if summary.events_total > summary.events.len() as u64 {
        return format!("{} in all", summary.events_total);
    }
    let mut text = format!(
        "{} dead centres, {} turning points",
        count("dead-centre"),
        count("turning-point")
    );
    for kind in ["limit", "stick", "slip", "rest"] {
        let number = count(kind);
        if number > 0 {
            let _ = write!(text, ", {number} {kind}");
        }
    }
    text
}

/// A value with the digits that its error leaves, and no more.
pub(super) fn digits(value: f64, error: f64) -> String {
    if error == 0.0 {
        return format!("{value}");
    }
    let places = (-error.log10()).ceil().clamp(0.0, 17.0) as usize;
    format!("{value:.places$}")
}

fn bound(speed: f64) -> String {
    if speed.is_finite() {
        format!("{speed}")
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
    let mut text = String::new();
    let _ = writeln!(
        text,
        "{:>12} {:>10} {:>11} {:>14} {:>11} {:>11}",
        "t [s]", "turns", "theta [deg]", "omega [rad/s]", "x [mm]", "v [m/s]"
    );
    for row in rows {
        let turns = (row.theta / TAU).floor();
        let _ = writeln!(
            text,
            "{:>12.6} {:>10} {:>11.4} {:>14.6} {:>11.4} {:>11.5}",
            row.t,
            turns,
            (row.theta - turns * TAU).to_degrees(),
            row.omega,
            row.x * 1e3,
            // Minus zero is zero.
            row.v + 0.0
        );
    }
    text
}

/// Where a named position is, and why it has its name.
pub(super) fn place(position: &NamedPosition) -> String {
    let from = position.theta_rad.to_degrees();
    let to = position
        .to_rad
        .map_or(String::new(), |to| format!(" to {}", to.to_degrees()));
    format!("{from}{to} deg: {}", position.reason)
}

/// What the lengths give.
pub(super) fn kinematics(result: &Kinematics) -> String {
    let mut text = String::new();
    let mut put = |name: &str, value: String| {
        let _ = writeln!(text, "{name:<22} {value}");
    };
    if !result.scene.is_empty() {
        put("scene", result.scene.clone());
    }
    put("class", result.class.to_owned());
    put("stroke", format!("{} m", result.stroke_m));
    for dead_centre in &result.dead_centres {
        put(
            &format!("{} dead centre", dead_centre.kind),
            format!(
                "{} deg, x = {} m",
                dead_centre.theta_rad.to_degrees(),
                dead_centre.x_m
            ),
        );
    }
    if let (Some(advance), Some(back), Some(ratio)) =
        (result.advance_rad, result.return_rad, result.time_ratio)
    {
        put("outward stroke", format!("{} deg", advance.to_degrees()));
        put("inward stroke", format!("{} deg", back.to_degrees()));
        put("time ratio", format!("{ratio}"));
    }
    for [from, to] in &result.reach_rad {
        put(
            "reachable crank angles",
            format!("{} to {} deg", from.to_degrees(), to.to_degrees()),
        );
    }
    for position in &result.positions {
        if position.kind != "dead-centre" {
            put(position.kind, place(position));
        }
    }
    put(
        "least transmission",
        format!("{} deg", result.transmission_min_rad.to_degrees()),
    );
    let units = match result.speed_rad_per_s {
        Some(_) => ["m/s", "m/s2"],
        None => ["m/rad", "m/rad2"],
    };
    for (name, extreme, unit) in [
        ("largest velocity", result.velocity_max, units[0]),
        ("smallest velocity", result.velocity_min, units[0]),
        ("largest acceleration", result.acceleration_max, units[1]),
        ("smallest acceleration", result.acceleration_min, units[1]),
    ] {
        if let Some(Located { value, theta_rad }) = extreme {
            put(
                name,
                format!("{value} {unit} at {} deg", theta_rad.to_degrees()),
            );
        }
    }
    for warning in &result.warnings {
        put("warning", warning.clone());
    }
    text
}
