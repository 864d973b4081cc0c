//! A loose joint in words.

use super::text::digits;
use crate::study::ClearanceSummary;

/// The loose joint.
pub(super) fn clearance(put: &mut impl FnMut(&str, String), joint: &ClearanceSummary) {
    put(
        "loose joint",
        format!(
            "{}, {} m radial clearance, {}",
            joint.joint, joint.radial_m, joint.contact_law
        ),
    );
    put(
        "  contact",
        format!(
            "{} impacts, {:.2} % of the time, peak {:.6} N, mean {:.6} N",
            joint.impacts,
            100.0 * joint.contact_share,
            joint.force_peak_n,
            joint.force_mean_n
        ),
    );
    put(
        "  energy lost",
        format!("{} J of {} J put in", joint.dissipated_j, joint.work_j),
    );
    let with_error = |value: f64, error: Option<f64>, unit: &str| match error {
        Some(error) => format!("{} +- {error:.1e} {unit}", digits(value, error)),
        None => format!("{value:.6} {unit}, error not stated"),
    };
    let last = &joint.last;
    put("  slider", with_error(last.x_m, last.error_x_m, "m"));
    put("  rod", with_error(last.phi_rad, last.error_phi_rad, "rad"));
    if let Some(horizon) = &joint.horizon {
        let until = if horizon.whole_run { "the end, " } else { "" };
        put(
            "  reproducible",
            format!(
                "to {until}t = {} s, {:.3} turns",
                horizon.t_s, horizon.revolutions
            ),
        );
        if let Some(beyond) = &horizon.beyond {
            for (name, one) in [
                ("  beyond", &beyond.run),
                ("  at 1/50 of tol.", &beyond.tighter),
            ] {
                put(
                    name,
                    format!(
                        "{} impacts, {:.1} % contact, force peak {:.0} N, mean {:.1} N, rms {:.1} N",
                        one.impacts,
                        100.0 * one.contact_share,
                        one.force_peak_n,
                        one.force_mean_n,
                        one.force_rms_n
                    ),
                );
            }
        }
    }
}
