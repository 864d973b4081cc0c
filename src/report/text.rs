//! Text of the kinematics and synthesis of a linkage: positions, extremes and quantities derived from the lengths.

use super::key_values::{Facts, degrees, fact, given, six};
use crate::kinematics::{Kinematics, Located, NamedPosition, Synthesis};

/// Width of the column of names, characters, more than the longest fixed name has.
pub(super) const NAME_WIDTH: usize = 24;

/// Returns the angle or range of angles of a named position, and the reason for its name.
pub(super) fn place(position: &NamedPosition) -> String {
    let from = degrees(position.theta_rad);
    let to = position.to_rad.map(degrees);
    let to = to.map_or(String::new(), |to| format!(" to {to}"));
    format!("{from}{to} deg: {}", position.reason)
}

/// Returns value and crank angle of an extreme.
pub(super) fn extreme(found: &Located, unit: &str) -> String {
    let (value, angle) = (six(found.value), degrees(found.theta_rad));
    format!("{value} {unit} at {angle} deg")
}

/// Returns the facts of one turn in closed form.
pub(super) fn kinematics(result: &Kinematics) -> Facts {
    let mut facts = Facts::of(&result.scene);
    facts.add("class", result.class);
    fact!(facts, "stroke" => "{} m", six(result.stroke_m));
    for dead_centre in &result.dead_centres {
        let (angle, x) = (degrees(dead_centre.theta), six(dead_centre.x));
        let name = format!("{} dead centre", dead_centre.kind);
        fact!(facts, name => "{angle} deg, x = {x} m");
    }
    if let (Some(advance), Some(back), Some(ratio)) =
        (result.advance_rad, result.return_rad, result.time_ratio)
    {
        fact!(facts, "outward stroke" => "{} deg", degrees(advance));
        fact!(facts, "inward stroke" => "{} deg", degrees(back));
        facts.add("time ratio", six(ratio));
    }
    for reach in &result.reach_rad {
        let [from, to] = reach.map(degrees);
        fact!(facts, "reachable crank angles" => "{from} to {to} deg");
    }
    for position in &result.positions {
        if position.kind != "dead-centre" {
            facts.add(position.kind, place(position));
        }
    }
    let transmission = degrees(result.transmission_min_rad);
    fact!(facts, "least transmission" => "{transmission} deg");
    let units = match result.speed_rad_per_s {
        Some(_) => ["m/s", "m/s2"],
        None => ["m/rad", "m/rad2"],
    };
    for (name, found, unit) in [
        ("largest velocity", result.velocity_max, units[0]),
        ("smallest velocity", result.velocity_min, units[0]),
        ("largest acceleration", result.acceleration_max, units[1]),
        ("smallest acceleration", result.acceleration_min, units[1]),
    ] {
        if let Some(found) = found {
            facts.add(name, extreme(&found, unit));
        }
    }
    facts.warnings(&result.warnings);
    facts
}

/// Returns the facts of one turn, followed by the synthesised lengths.
pub fn synthesis(found: &Synthesis) -> String {
    let mut facts = kinematics(&found.turn);
    for (name, value) in lengths(found) {
        fact!(facts, name => "{} m", given(value));
    }
    facts.lines(22)
}

/// Returns the `[geometry]` table of a scene file with the synthesised lengths.
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
