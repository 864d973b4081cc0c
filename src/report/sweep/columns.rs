//! Columns of a sweep.

use super::super::csv::shortest as cell;
use crate::kinematics::{Kinematics, Located};
use crate::scene::printable;
use crate::simulate::{SteadyState, Summary};
use crate::sweep::{Design, Sweep};

/// Names of columns with their cells.
type Columns<T> = [(&'static str, fn(&T) -> String)];

/// Columns of the closed form of one turn, after the varied values and the status; velocities and
/// accelerations are those at the scene's speed.
const TURN: &Columns<Kinematics> = &[
    ("class", |turn| turn.class.to_owned()),
    ("stroke_m", |turn| cell(turn.stroke_m)),
    ("advance_rad", |turn| some(turn.advance_rad)),
    ("return_rad", |turn| some(turn.return_rad)),
    ("time_ratio", |turn| some(turn.time_ratio)),
    ("transmission_min_rad", |turn| {
        cell(turn.transmission_min_rad)
    }),
    ("velocity_max_m_per_s", |turn| {
        at_speed(turn, turn.velocity_max)
    }),
    ("velocity_min_m_per_s", |turn| {
        at_speed(turn, turn.velocity_min)
    }),
    ("acceleration_max_m_per_s2", |turn| {
        at_speed(turn, turn.acceleration_max)
    }),
    ("acceleration_min_m_per_s2", |turn| {
        at_speed(turn, turn.acceleration_min)
    }),
];

/// Columns of the forward motion.
const MOTION: &Columns<Summary> = &[
    ("engine", |run| run.engine.clone()),
    ("t_s", |run| cell(run.last.t_s)),
    ("theta_rad", |run| cell(run.last.theta_rad)),
    ("omega_rad_per_s", |run| cell(run.last.omega_rad_per_s)),
    ("error_theta_rad", |run| {
        some(run.error_estimate.map(|error| error.theta_rad))
    }),
    ("error_omega_rad_per_s", |run| {
        some(run.error_estimate.map(|error| error.omega_rad_per_s))
    }),
    ("revolutions", |run| cell(run.revolutions)),
    ("omega_min_rad_per_s", |run| cell(run.omega_min)),
    ("omega_max_rad_per_s", |run| cell(run.omega_max)),
    ("driving_torque_min_nm", |run| {
        some(run.driving_torque.map(|torque| torque.min_nm))
    }),
    ("driving_torque_max_nm", |run| {
        some(run.driving_torque.map(|torque| torque.max_nm))
    }),
    ("driving_torque_mean_nm", |run| {
        some(run.driving_torque.map(|torque| torque.mean_nm))
    }),
    ("energy_residual", |run| cell(run.energy_residual)),
    ("evaluations", |run| run.evaluations.to_string()),
    ("events", |run| run.events_total.to_string()),
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
const STEADY: &Columns<SteadyState> = &[
    ("cycle_turns", |steady| steady.cycle_turns.to_string()),
    ("steady_omega_mean_rad_per_s", |steady| {
        cell(steady.omega_mean_rad_per_s.value)
    }),
    ("steady_omega_min_rad_per_s", |steady| {
        cell(steady.slowest.omega_rad_per_s.value)
    }),
    ("steady_omega_max_rad_per_s", |steady| {
        cell(steady.fastest.omega_rad_per_s.value)
    }),
    ("fluctuation", |steady| cell(steady.fluctuation.value)),
    ("error_fluctuation", |steady| cell(steady.fluctuation.error)),
    ("steady_power_in_w", |steady| cell(steady.power_in_w.value)),
];
const FLYWHEEL: &str = "flywheel_added_inertia_kg_m2";

fn some(value: Option<f64>) -> String {
    value.map_or(String::new(), cell)
}

fn at_speed(turn: &Kinematics, located: Option<Located>) -> String {
    let moves = turn.speed_rad_per_s.is_some();
    some(located.filter(|_| moves).map(|located| located.value))
}

fn names<T>(columns: &Columns<T>) -> impl Iterator<Item = String> {
    columns.iter().map(|(name, _)| (*name).to_owned())
}

/// The cells of what there is, or empty ones.
fn cells_of<T>(columns: &Columns<T>, of: Option<&T>) -> impl Iterator<Item = String> {
    columns
        .iter()
        .map(move |(_, cell)| of.map_or(String::new(), cell))
}

/// Number of columns before the key figures: the design and its values, then `status`.
pub(super) fn before_figures(sweep: &Sweep) -> usize {
    sweep.varied().len() + 2
}

pub(super) fn header(sweep: &Sweep) -> Vec<String> {
    let mut all = vec!["design".to_owned()];
    all.extend(sweep.varied().iter().map(|one| one.column()));
    all.push("status".to_owned());
    all.extend(names(TURN));
    if sweep.has_motion() {
        all.extend(names(MOTION));
    }
    if sweep.has_reactions() {
        all.extend(PEAKS.map(str::to_owned));
    }
    if let Some(asked) = sweep.steady() {
        all.extend(names(STEADY));
        all.extend(asked.fluctuation.map(|_| FLYWHEEL.to_owned()));
    }
    all.push("notes".to_owned());
    all
}

pub(super) fn cells(sweep: &Sweep, design: &Design) -> Vec<String> {
    let mut cells = vec![(design.index + 1).to_string()];
    for (varied, value) in sweep.varied().iter().zip(&design.values) {
        let text = || printable(varied.text(*value)).into_owned();
        cells.push(varied.number(*value).map_or_else(text, cell));
    }
    cells.push(design.outcome.name().to_owned());
    cells.extend(cells_of(TURN, design.kinematics.as_ref()));
    if sweep.has_motion() {
        cells.extend(cells_of(MOTION, design.motion.as_ref()));
    }
    if sweep.has_reactions() {
        match design.motion.as_ref().and_then(|summary| summary.peaks) {
            Some(peaks) => cells.extend(peaks.named().map(|(_, peak)| cell(peak.value_n))),
            None => cells.extend(PEAKS.map(|_| String::new())),
        }
    }
    if let Some(asked) = sweep.steady() {
        let found = design.steady.as_ref();
        cells.extend(cells_of(STEADY, found));
        let wheel = found.and_then(|steady| steady.flywheel.as_ref());
        let inertia = some(wheel.map(|wheel| wheel.added_inertia_kg_m2.value));
        cells.extend(asked.fluctuation.map(|_| inertia));
    }
    // A row is a line.
    let notes = design.notes.join("; ").replace(['\n', '\r'], " ");
    cells.push(printable(&notes).into_owned());
    cells
}
