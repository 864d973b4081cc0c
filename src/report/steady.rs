//! The periodic steady state in words.

use super::diagrams::stems;
use super::key_values::{Facts, fact, given, with_error};
use crate::error::Error;
use crate::simulate::{Estimated, Flywheel, SpeedExtreme, SpeedOrder, SteadyState};

fn shown(estimated: Estimated, unit: &str) -> String {
    let Estimated { value, error } = estimated;
    with_error(value, error, unit)
}

/// The key figures.
pub(super) fn steady_state(facts: &mut Facts, steady: &SteadyState) {
    let period = shown(steady.period_s, "s");
    let (of_turns, a_cycle) = match steady.cycle_turns {
        1 => (String::new(), "turn"),
        turns => (format!(" ({turns} turns)"), "cycle"),
    };
    fact!(facts, "steady state", "period {period}{of_turns}");
    facts.add("  mean speed", shown(steady.omega_mean_rad_per_s, "rad/s"));
    facts.add("  slowest", extreme(&steady.slowest));
    facts.add("  fastest", extreme(&steady.fastest));
    facts.add("  fluctuation", shown(steady.fluctuation, ""));
    if let Some(orders) = speed_orders(&steady.speed_orders) {
        facts.add("  speed orders", orders);
    }
    let left = if steady.stable {
        format!(
            "{} of one is left after a {a_cycle}",
            shown(steady.multiplier, "")
        )
    } else {
        "do not die out".to_owned()
    };
    facts.add("  deviations", left);
    facts.add("  power in", shown(steady.power_in_w, "W"));
    facts.add("  power out", shown(steady.power_out_w, "W"));
    if let Some(wheel) = &steady.flywheel {
        flywheel(facts, wheel);
    }
    for note in &steady.notes {
        facts.add("  note", note);
    }
}

/// The largest orders that are beyond their errors.
fn speed_orders(orders: &[SpeedOrder]) -> Option<String> {
    const SHOWN: usize = 3;
    let amplitude = |order: &SpeedOrder| order.amplitude_rad_per_s.value;
    let known = |order: &&SpeedOrder| amplitude(order) > order.amplitude_rad_per_s.error;
    let mut largest: Vec<_> = orders.iter().filter(known).collect();
    largest.sort_by(|one, other| amplitude(other).total_cmp(&amplitude(one)));
    let words = largest.iter().take(SHOWN).map(|order| {
        let amplitude = shown(order.amplitude_rad_per_s, "rad/s");
        format!("{} a turn {amplitude}", order.order)
    });
    let words: Vec<String> = words.collect();
    (!words.is_empty()).then(|| words.join("; "))
}

/// The orders of the speed as SVG.
///
/// # Errors
/// [`Error::Write`], which would be a defect.
pub(super) fn speed_figure(steady: &SteadyState) -> Result<String, Error> {
    let orders = steady.speed_orders.iter();
    let ends = orders.map(|order| (order.order, order.amplitude_rad_per_s.value));
    stems("crank speed [rad/s]", ends).to_svg()
}

fn extreme(extreme: &SpeedExtreme) -> String {
    let speed = shown(extreme.omega_rad_per_s, "rad/s");
    match extreme.theta_rad {
        Some(theta) => format!("{speed}, at {:.4} deg", theta.value.to_degrees()),
        None => speed,
    }
}

fn flywheel(facts: &mut Facts, wheel: &Flywheel) {
    let added = wheel.added_inertia_kg_m2;
    let (value, what) = if added.value < 0.0 {
        (-added.value, "could be taken from the crank")
    } else {
        (added.value, "to be added to the crank")
    };
    let inertia = with_error(value, added.error, "kg m2");
    let wanted = given(wheel.wanted_fluctuation);
    fact!(
        facts,
        "  flywheel",
        "{inertia} {what}, for a fluctuation of {wanted}"
    );
}
