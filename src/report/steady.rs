//! The periodic steady state in words.

use super::text::digits;
use crate::study::{Estimated, Flywheel, SpeedExtreme, SteadyState};

fn shown(estimated: Estimated, unit: &str) -> String {
    let Estimated { value, error } = estimated;
    format!("{} +- {error:.1e} {unit}", digits(value, error))
        .trim_end()
        .to_owned()
}

/// The key figures.
pub(super) fn steady_state(put: &mut impl FnMut(&str, String), steady: &SteadyState) {
    put(
        "steady state",
        format!("period {}", shown(steady.period_s, "s")),
    );
    put("  mean speed", shown(steady.omega_mean_rad_per_s, "rad/s"));
    put("  slowest", extreme(&steady.slowest));
    put("  fastest", extreme(&steady.fastest));
    put("  fluctuation", shown(steady.fluctuation, ""));
    let left = if steady.stable {
        format!(
            "{} of one is left after a turn",
            shown(steady.multiplier, "")
        )
    } else {
        "do not die out".to_owned()
    };
    put("  deviations", left);
    put("  power in", shown(steady.power_in_w, "W"));
    put("  power out", shown(steady.power_out_w, "W"));
    if let Some(wheel) = &steady.flywheel {
        flywheel(put, wheel);
    }
    for note in &steady.notes {
        put("  note", note.clone());
    }
}

fn extreme(extreme: &SpeedExtreme) -> String {
    let speed = shown(extreme.omega_rad_per_s, "rad/s");
    match extreme.theta_rad {
        Some(theta) => format!("{speed}, at {:.4} deg", theta.value.to_degrees()),
        None => speed,
    }
}

fn flywheel(put: &mut impl FnMut(&str, String), wheel: &Flywheel) {
    let added = wheel.added_inertia_kg_m2;
    let (value, what) = if added.value < 0.0 {
        (-added.value, "could be taken from the crank")
    } else {
        (added.value, "to be added to the crank")
    };
    let inertia = Estimated { value, ..added };
    put(
        "  flywheel",
        format!(
            "{} {what}, for a fluctuation of {}",
            shown(inertia, "kg m2"),
            wheel.wanted_fluctuation
        ),
    );
}
