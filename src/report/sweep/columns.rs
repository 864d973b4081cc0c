//! Columns of a sweep.

use super::super::csv::shortest as cell;
use crate::kinematics::Kinematics;
use crate::scene::printable;
use crate::simulate::{SteadyState, Summary};
use crate::sweep::{Design, Sweep};

/// Columns of the closed form of one turn, after the varied values and the status; velocities and
/// accelerations are those at the scene's speed.
const TURN: [&str; 10] = [
    "class",
    "stroke_m",
    "advance_rad",
    "return_rad",
    "time_ratio",
    "transmission_min_rad",
    "velocity_max_m_per_s",
    "velocity_min_m_per_s",
    "acceleration_max_m_per_s2",
    "acceleration_min_m_per_s2",
];

/// Columns of the forward motion.
const MOTION: [&str; 15] = [
    "engine",
    "t_s",
    "theta_rad",
    "omega_rad_per_s",
    "error_theta_rad",
    "error_omega_rad_per_s",
    "revolutions",
    "omega_min_rad_per_s",
    "omega_max_rad_per_s",
    "driving_torque_min_nm",
    "driving_torque_max_nm",
    "driving_torque_mean_nm",
    "energy_residual",
    "evaluations",
    "events",
];

/// Columns of the largest joint forces.
const PEAKS: [&str; 5] = [
    "crank_bearing_peak_n",
    "crank_pin_peak_n",
    "wrist_pin_peak_n",
    "guide_peak_n",
    "shaking_peak_n",
];

/// Columns of the periodic steady state, and of its flywheel.
const STEADY: [&str; 7] = [
    "cycle_turns",
    "steady_omega_mean_rad_per_s",
    "steady_omega_min_rad_per_s",
    "steady_omega_max_rad_per_s",
    "fluctuation",
    "error_fluctuation",
    "steady_power_in_w",
];
const FLYWHEEL: &str = "flywheel_added_inertia_kg_m2";

/// Number of columns before the key figures: the design and its values, then `status`.
pub(super) fn before_figures(sweep: &Sweep) -> usize {
    sweep.varied().len() + 2
}

pub(super) fn header(sweep: &Sweep) -> Vec<String> {
    let mut names = vec!["design".to_owned()];
    names.extend(sweep.varied().iter().map(|one| one.column()));
    names.push("status".to_owned());
    names.extend(TURN.map(str::to_owned));
    if sweep.has_motion() {
        names.extend(MOTION.map(str::to_owned));
    }
    if sweep.has_reactions() {
        names.extend(PEAKS.map(str::to_owned));
    }
    if let Some(asked) = sweep.steady() {
        names.extend(STEADY.map(str::to_owned));
        names.extend(asked.fluctuation.map(|_| FLYWHEEL.to_owned()));
    }
    names.push("notes".to_owned());
    names
}

pub(super) fn cells(sweep: &Sweep, design: &Design) -> Vec<String> {
    let mut cells = vec![(design.index + 1).to_string()];
    for (varied, value) in sweep.varied().iter().zip(&design.values) {
        let text = || printable(varied.text(*value)).into_owned();
        cells.push(varied.number(*value).map_or_else(text, cell));
    }
    cells.push(design.outcome.name().to_owned());
    match &design.kinematics {
        Some(turn) => cells.extend(self::turn(turn)),
        None => cells.extend(TURN.map(|_| String::new())),
    }
    if sweep.has_motion() {
        match &design.motion {
            Some(summary) => cells.extend(motion(summary)),
            None => cells.extend(MOTION.map(|_| String::new())),
        }
    }
    if sweep.has_reactions() {
        match design.motion.as_ref().and_then(|summary| summary.peaks) {
            Some(peaks) => cells.extend(peaks.named().map(|(_, peak)| cell(peak.value_n))),
            None => cells.extend(PEAKS.map(|_| String::new())),
        }
    }
    if let Some(asked) = sweep.steady() {
        let found = design.steady.as_ref();
        cells.extend(found.map_or(STEADY.map(|_| String::new()), steady));
        let wheel = found.and_then(|steady| steady.flywheel.as_ref());
        let inertia = wheel.map_or(String::new(), |wheel| cell(wheel.added_inertia_kg_m2.value));
        cells.extend(asked.fluctuation.map(|_| inertia));
    }
    // A row is a line.
    let notes = design.notes.join("; ").replace(['\n', '\r'], " ");
    cells.push(printable(&notes).into_owned());
    cells
}

fn turn(turn: &Kinematics) -> [String; TURN.len()] {
    let some = |value: Option<f64>| value.map_or(String::new(), cell);
    let at_speed = |located: Option<crate::kinematics::Located>| {
        let moves = turn.speed_rad_per_s.is_some();
        some(located.filter(|_| moves).map(|located| located.value))
    };
    [
        turn.class.to_owned(),
        cell(turn.stroke_m),
        some(turn.advance_rad),
        some(turn.return_rad),
        some(turn.time_ratio),
        cell(turn.transmission_min_rad),
        at_speed(turn.velocity_max),
        at_speed(turn.velocity_min),
        at_speed(turn.acceleration_max),
        at_speed(turn.acceleration_min),
    ]
}

fn steady(steady: &SteadyState) -> [String; STEADY.len()] {
    [
        steady.cycle_turns.to_string(),
        cell(steady.omega_mean_rad_per_s.value),
        cell(steady.slowest.omega_rad_per_s.value),
        cell(steady.fastest.omega_rad_per_s.value),
        cell(steady.fluctuation.value),
        cell(steady.fluctuation.error),
        cell(steady.power_in_w.value),
    ]
}

fn motion(summary: &Summary) -> [String; MOTION.len()] {
    let some = |value: Option<f64>| value.map_or(String::new(), cell);
    let (last, error) = (&summary.last, &summary.error_estimate);
    let torque = &summary.driving_torque;
    [
        summary.engine.clone(),
        cell(last.t_s),
        cell(last.theta_rad),
        cell(last.omega_rad_per_s),
        some(error.map(|error| error.theta_rad)),
        some(error.map(|error| error.omega_rad_per_s)),
        cell(summary.revolutions),
        cell(summary.omega_min),
        cell(summary.omega_max),
        some(torque.map(|torque| torque.min_nm)),
        some(torque.map(|torque| torque.max_nm)),
        some(torque.map(|torque| torque.mean_nm)),
        cell(summary.energy_residual),
        summary.evaluations.to_string(),
        summary.events_total.to_string(),
    ]
}
