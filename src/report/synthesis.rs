//! Lengths that were looked for, as text and as a scene file.

use super::key_values::{fact, given};
use super::text;
use crate::kinematics::Synthesis;

/// The lengths, and one turn of them.
pub fn synthesis(found: &Synthesis) -> String {
    let mut facts = text::kinematics(&found.turn);
    for (name, value) in lengths(found) {
        fact!(facts, name, "{} m", given(value));
    }
    facts.lines(22)
}

/// A scene of these lengths.
pub fn synthesis_scene(found: &Synthesis) -> String {
    let lines = lengths(found).map(|(name, value)| format!("{name} = \"{value} m\"\n"));
    format!("[geometry]\n{}", lines.concat())
}

fn lengths(found: &Synthesis) -> [(&'static str, f64); 3] {
    [
        ("crank", found.crank_m),
        ("rod", found.rod_m),
        ("offset", found.offset_m),
    ]
}
