//! The plan of a scene with clearance in a joint.

use std::borrow::Cow;

use super::{Engine, Method, Stepper};
use crate::error::Error;

/// What the contact engine integrates.
pub(super) fn contact_state(prescribed: bool) -> Vec<&'static str> {
    let mut state = vec![
        "t",
        "psi",
        "x",
        "psi.",
        "v",
        "work",
        "energy lost in the contact",
    ];
    if !prescribed {
        state.splice(1..1, ["theta", "omega"]);
    }
    state
}

/// The engine of a scene with clearance.
pub(super) fn contact(
    method: Method,
) -> Result<(Engine, Option<Stepper>, Cow<'static, str>), Error> {
    if method != Method::Auto {
        return Err(Error::refused(
            format!("method {method} cannot serve a scene with clearance in a joint"),
            "use --method auto, or take [clearance] out of the scene",
        ));
    }
    let reason = "a joint has clearance: rod and slider move freely of it but for the contact force; flight and contact are integrated apart";
    Ok((Engine::Contact, None, reason.into()))
}
