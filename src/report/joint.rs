//! A loose joint in words.

use super::key_values::{Facts, fact, given, six, with_error};
use crate::simulate::{ClearanceSummary, ContactStatistics};

/// The loose joint.
pub(super) fn clearance(facts: &mut Facts, joint: &ClearanceSummary) {
    let (radial, law) = (given(joint.radial_m), joint.contact_law);
    fact!(
        facts,
        "loose joint",
        "{}, {radial} m radial clearance, {law}",
        joint.joint
    );
    fact!(
        facts,
        "  contact",
        "{} impacts, {:.2} % of the time, peak {} N, mean {} N",
        joint.impacts,
        100.0 * joint.contact_share,
        six(joint.force_peak_n),
        six(joint.force_mean_n)
    );
    let (lost, work) = (six(joint.dissipated_j), six(joint.work_j.abs()));
    let way = if joint.work_j < 0.0 { "out of" } else { "into" };
    fact!(
        facts,
        "  energy lost",
        "{lost} J in contact and guide; the loads and the drive bring {work} J {way} the mechanism"
    );
    let shown = |value: f64, error: Option<f64>, unit: &str| match error {
        Some(error) => with_error(value, error, unit),
        None => format!("{} {unit}, error not stated", six(value)),
    };
    let last = &joint.last;
    facts.add("  slider", shown(last.x_m, last.error_x_m, "m"));
    facts.add("  rod", shown(last.phi_rad, last.error_phi_rad, "rad"));
    if let Some(horizon) = &joint.horizon {
        let until = if horizon.whole_run { "the end, " } else { "" };
        let (t, turns) = (six(horizon.t_s), horizon.revolutions);
        fact!(
            facts,
            "  reproducible",
            "to {until}t = {t} s, {turns:.3} turns"
        );
        if let Some(beyond) = &horizon.beyond {
            facts.add("  beyond", statistics(&beyond.run));
            facts.add("  at 1/50 of tol.", statistics(&beyond.tighter));
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
