//! The plan of a scene with clearance in a joint.

use super::choice::Choice;
use super::{Engine, Method};
use crate::error::Error;

/// What the contact engine integrates.
pub(super) fn contact_state(prescribed: bool) -> Vec<&'static str> {
    let mut state = vec!["t", "psi", "x", "psi.", "v", "work", "energy lost"];
    if !prescribed {
        state.splice(1..1, ["theta", "omega"]);
    }
    state
}

/// The engine of a scene with clearance.
pub(super) fn contact(method: Method) -> Result<Choice, Error> {
    if method != Method::Auto {
        return Err(Error::refused(
            format!("method {method} cannot serve a scene with clearance in a joint"),
            "use --method auto, or take [clearance] out of the scene",
        ));
    }
    Ok(Choice::of(
        Engine::Contact,
        "a joint has clearance: rod and slider move freely of it but for the contact force; flight and contact are integrated apart",
    ))
}
