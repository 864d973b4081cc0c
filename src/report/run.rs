//! Facts of a run: final state, cost, events, loose joint and periodic steady state.

use std::f64::consts::TAU;

use super::diagrams::stems;
use super::key_values::{Facts, fact, given, in_turn, six, text_table, with_error};
use crate::error::Error;
use crate::scene::counted;
use crate::simulate::{
    ClearanceSummary, ContactStatistics, Estimated, Flywheel, Row, SpeedExtreme, SpeedOrder,
    SteadyState, Summary,
};

/// Returns the facts of a run.
pub(super) fn run(summary: &Summary) -> Facts {
    let mut facts = Facts::of(&summary.scene);
    facts.add("engine", &summary.engine);
    end(&mut facts, summary);
    if let Some(torque) = &summary.driving_torque {
        let [least, most, mean] = [torque.min_nm, torque.max_nm, torque.mean_nm].map(six);
        fact!(facts, "driving torque" => "{least} to {most} N m, mean {mean} N m");
    }
    for (name, peak) in summary.peaks.iter().flat_map(|peaks| peaks.named()) {
        let (value, t, angle) = (six(peak.value_n), six(peak.t_s), in_turn(peak.theta_rad));
        fact!(facts, name => "at most {value} N, at t = {t} s, {angle} deg");
    }
    let (relative, residual) = (summary.energy_residual, summary.energy_residual_j);
    if relative.is_finite() {
        fact!(facts, "energy residual" => "{relative:.1e} of the largest energy ({residual:.1e} J)");
    }
    let (evaluations, steps) = (summary.evaluations, summary.steps);
    let time = seconds(summary.wall_s);
    fact!(facts, "cost" => "{evaluations} evaluations, {steps} steps, {time}");
    if let Some(cost) = &summary.estimate_cost {
        let (count, time) = (cost.evaluations, seconds(cost.wall_s));
        fact!(facts, "  of the estimate" => "{count} evaluations, {time}");
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

/// Formats a value with its error, or with "error not `none`" if it has none.
fn shown(value: f64, error: Option<f64>, unit: &str, none: &str) -> String {
    match error {
        Some(error) => with_error(value, error, unit),
        None => format!("{} {unit}, error not {none}", six(value)),
    }
}

/// Adds the final state with errors, and the range of the crank speed.
fn end(facts: &mut Facts, summary: &Summary) {
    let (last, error) = (&summary.last, summary.error_estimate);
    fact!(facts, "end" => "t = {} s", six(last.t_s));
    let [theta, omega] = [error.map(|e| e.theta_rad), error.map(|e| e.omega_rad_per_s)];
    let shown = |value, error, unit| shown(value, error, unit, "estimated");
    facts.add("  crank angle", shown(last.theta_rad, theta, "rad"));
    facts.add("  crank speed", shown(last.omega_rad_per_s, omega, "rad/s"));
    facts.add("turns", six(summary.revolutions));
    let bound = |speed: f64| match speed.is_finite() {
        true => six(speed),
        false => "no bound".to_owned(),
    };
    let [least, largest] = [summary.omega_min, summary.omega_max].map(bound);
    fact!(facts, "crank speed" => "{least} to {largest} rad/s");
}

fn events(summary: &Summary) -> String {
    let total = summary.events_total;
    if summary.clearance.is_some() {
        return format!("{total} dead centres, impacts and separations");
    }
    if total > summary.events.len() as u64 {
        return format!("{total} in all");
    }
    let mut said = Vec::new();
    for kind in "dead-centre,turning-point,limit,stick,slip,rest".split(',') {
        let noun = kind.replace('-', " ");
        let number = summary.events.iter().filter(|e| e.kind == kind).count();
        if number > 0 || kind != noun {
            said.push(counted(number, &noun));
        }
    }
    said.join(", ")
}

fn seconds(value: f64) -> String {
    match value {
        v if v < 1e-3 => format!("{:.1} us", v * 1e6),
        v if v < 1.0 => format!("{:.2} ms", v * 1e3),
        v => format!("{v:.2} s"),
    }
}

/// Returns rows as a table with aligned columns.
pub(super) fn table(rows: &[Row]) -> String {
    let header = "t [s],turns,theta [deg],omega [rad/s],x [mm],v [m/s]";
    let cells = rows.iter().map(|row| {
        let turns = (row.theta / TAU).floor();
        [
            format!("{:.6}", row.t),
            turns.to_string(),
            format!("{:.4}", (row.theta - turns * TAU).to_degrees()),
            format!("{:.6}", row.omega),
            format!("{:.4}", row.x * 1e3),
            // Minus zero prints as zero.
            format!("{:.5}", row.v + 0.0),
        ]
    });
    text_table(&[12, 10, 11, 14, 11, 11], header, cells)
}

/// Adds the facts of the loose joint.
fn clearance(facts: &mut Facts, joint: &ClearanceSummary) {
    let (name, radial, law) = (joint.joint, given(joint.radial_m), joint.contact_law);
    fact!(facts, "loose joint" => "{name}, {radial} m radial clearance, {law}");
    let share = 100.0 * joint.contact_share;
    let [peak, mean] = [joint.force_peak_n, joint.force_mean_n].map(six);
    let contact = format!("{} impacts, {share:.2} % of the time", joint.impacts);
    fact!(facts, "  contact" => "{contact}, peak {peak} N, mean {mean} N");
    let [lost, work] = [joint.dissipated_j, joint.work_j.abs()].map(six);
    let way = if joint.work_j < 0.0 { "out of" } else { "into" };
    let brought = format!("the loads and the drive bring {work} J {way} the mechanism");
    let text = format!("{lost} J in contact and guide; {brought}");
    facts.add("  energy lost", text);
    let last = &joint.last;
    let shown = |value, error, unit| shown(value, error, unit, "stated");
    facts.add("  slider", shown(last.x_m, last.error_x_m, "m"));
    facts.add("  rod", shown(last.phi_rad, last.error_phi_rad, "rad"));
    if let Some(horizon) = &joint.horizon {
        let until = if horizon.whole_run { "the end, " } else { "" };
        let (t, turns) = (six(horizon.t_s), horizon.revolutions);
        fact!(facts, "  reproducible" => "to {until}t = {t} s, {turns:.3} turns");
        if let Some(beyond) = &horizon.beyond {
            facts.add("  beyond", statistics(&beyond.run));
            facts.add("  at tol./1000", statistics(&beyond.tighter));
        }
    }
}

fn statistics(contact: &ContactStatistics) -> String {
    format!(
        "{} impacts, {:.1} % contact, force peak {:.0} N, mean {:.1} N, rms {:.1} N",
        contact.impacts,
        100.0 * contact.contact_share,
        contact.force_peak_n,
        contact.force_mean_n,
        contact.force_rms_n
    )
}

fn estimated(found: Estimated, unit: &str) -> String {
    with_error(found.value, found.error, unit)
}

/// Adds the key figures of the periodic steady state.
fn steady_state(facts: &mut Facts, steady: &SteadyState) {
    let (of_turns, a_cycle) = match steady.cycle_turns {
        1 => (String::new(), "turn"),
        turns => (format!(" ({turns} turns)"), "cycle"),
    };
    let period = estimated(steady.period_s, "s");
    fact!(facts, "steady state" => "period {period}{of_turns}");
    let mean = estimated(steady.omega_mean_rad_per_s, "rad/s");
    facts.add("  mean speed", mean);
    facts.add("  slowest", extreme(&steady.slowest));
    facts.add("  fastest", extreme(&steady.fastest));
    facts.add("  fluctuation", estimated(steady.fluctuation, ""));
    if let Some(orders) = speed_orders(&steady.speed_orders) {
        facts.add("  speed orders", orders);
    }
    let left = match steady.stable {
        true => {
            let multiplier = estimated(steady.multiplier, "");
            format!("{multiplier} of one is left after a {a_cycle}")
        }
        false => "do not die out".to_owned(),
    };
    facts.add("  deviations", left);
    facts.add("  power in", estimated(steady.power_in_w, "W"));
    facts.add("  power out", estimated(steady.power_out_w, "W"));
    if let Some(wheel) = &steady.flywheel {
        facts.add("  flywheel", flywheel(wheel));
    }
    for note in &steady.notes {
        facts.add("  note", note);
    }
}

/// Returns the three largest speed orders whose amplitude exceeds its error.
fn speed_orders(orders: &[SpeedOrder]) -> Option<String> {
    let amplitude = |order: &SpeedOrder| order.amplitude_rad_per_s.value;
    let known = |order: &&SpeedOrder| amplitude(order) > order.amplitude_rad_per_s.error;
    let mut largest: Vec<_> = orders.iter().filter(known).collect();
    largest.sort_by(|one, other| amplitude(other).total_cmp(&amplitude(one)));
    let words = largest.iter().take(3).map(|order| {
        let amplitude = estimated(order.amplitude_rad_per_s, "rad/s");
        format!("{} a turn {amplitude}", order.order)
    });
    let words: Vec<String> = words.collect();
    (!words.is_empty()).then(|| words.join("; "))
}

/// Returns the amplitudes of the speed orders as SVG.
pub(super) fn speed_figure(steady: &SteadyState) -> Result<String, Error> {
    let orders = steady.speed_orders.iter();
    let ends = orders.map(|order| (order.order, order.amplitude_rad_per_s.value));
    stems("crank speed [rad/s]", ends).to_svg()
}

fn extreme(extreme: &SpeedExtreme) -> String {
    let speed = estimated(extreme.omega_rad_per_s, "rad/s");
    match extreme.theta_rad {
        Some(theta) => format!("{speed}, at {:.4} deg", theta.value.to_degrees()),
        None => speed,
    }
}

fn flywheel(wheel: &Flywheel) -> String {
    let Estimated { value, error } = wheel.added_inertia_kg_m2;
    let what = match value < 0.0 {
        true => "could be taken from the crank",
        false => "to be added to the crank",
    };
    let inertia = with_error(value.abs(), error, "kg m2");
    let wanted = given(wheel.wanted_fluctuation);
    format!("{inertia} {what}, for a fluctuation of {wanted}")
}
