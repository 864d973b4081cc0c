//! Checks the values of a clearance.

use crate::scene::check::Check;
use crate::scene::number::{apart, show};
use crate::scene::{Clearance, ContactLaw};

pub(super) fn clearance(check: &mut Check, clearance: &Clearance) {
    check.not_negative("clearance.radial", clearance.radial, "m");
    let threshold = Some(clearance.friction_threshold);
    let least_speed = Some(clearance.least_approach_speed);
    for (name, value, unit) in [
        ("bearing_radius", clearance.bearing_radius, "m"),
        ("young_modulus", clearance.young_modulus, "Pa"),
        ("friction_threshold", threshold, "m/s"),
        ("least_approach_speed", least_speed, "m/s"),
    ] {
        if let Some(value) = value {
            check.positive(format_args!("clearance.{name}"), value, unit);
        }
    }
    for (name, value, low, high) in [
        ("poisson_ratio", clearance.poisson_ratio, -1.0, 0.5),
        ("restitution", clearance.restitution, 0.0, 1.0),
        ("friction", clearance.friction, 0.0, f64::MAX),
    ] {
        if let Some(value) = value
            && !(low..=high).contains(&value)
        {
            check.add(
                format_args!("clearance.{name}"),
                format!("{} is not a possible {name}", show(value)),
                "poisson_ratio lies between -1 and 0.5, restitution between 0 and 1, friction is not negative",
            );
        }
    }
    if let Some(angle) = clearance.eccentricity_angle {
        check.finite("clearance.eccentricity_angle", angle);
    }
    journal_fits(check, clearance);
    law_fits(check, clearance);
}

/// Checks that the journal fits into the bearing, and lies inside it at the start.
fn journal_fits(check: &mut Check, clearance: &Clearance) {
    let radial = clearance.radial;
    if let Some(bearing) = clearance.bearing_radius
        && radial >= bearing
        && check.has_no_problem(&["clearance.radial", "clearance.bearing_radius"])
    {
        let (radial, bearing) = apart(radial, bearing);
        let what = format!(
            "a clearance of {radial} m leaves no journal in a bearing of radius {bearing} m"
        );
        let help = "make the clearance smaller than the radius of the bearing";
        check.add("clearance.radial", what, help);
    }
    let Some(eccentricity) = clearance.eccentricity else {
        return;
    };
    check.not_negative("clearance.eccentricity", eccentricity, "m");
    let linked = clearance.law == ContactLaw::MasslessLink;
    let impossible = eccentricity > radial || (linked && eccentricity != radial);
    if impossible && check.has_no_problem(&["clearance.radial", "clearance.eccentricity"]) {
        let (shown, radial) = apart(eccentricity, radial);
        let [what, help] = match linked {
            true => [
                "a massless link keeps the journal at the radial clearance",
                "leave out eccentricity, or give the radial clearance",
            ],
            false => [
                "the journal would begin inside the bearing's wall, and its approach speed would not be known",
                "give at most the radial clearance",
            ],
        };
        let what = format!("{what}: {shown} m, and the radial clearance is {radial} m");
        check.add("clearance.eccentricity", what, help);
    }
}

/// Rejects friction of a massless link, and restitution 0 under laws that divide by it.
fn law_fits(check: &mut Check, clearance: &Clearance) {
    let friction = clearance.friction.unwrap_or(0.0);
    if clearance.law == ContactLaw::MasslessLink && friction > 0.0 {
        let friction = show(friction);
        let what = format!("a massless link has no friction, but it is {friction}");
        let help = "leave it out, or use another contact_law";
        check.add("clearance.friction", what, help);
    }
    let divides = matches!(clearance.law, ContactLaw::Flores | ContactLaw::Gonthier);
    if divides && clearance.restitution == Some(0.0) {
        let law = clearance.law;
        let what = format!(
            "the damping of the law \"{law}\" grows without bound as the restitution nears 0"
        );
        let help = "use contact_law = \"lankarani-nikravesh\" or \"hunt-crossley\", or a restitution above 0";
        check.add("clearance.restitution", what, help);
    }
}
