//! Values that have been read, put together to a scene: defaults, boxes, loads.

mod bodies;
mod loads;

use std::f64::consts::FRAC_PI_2;
use std::path::Path;

use super::keys::{self, KindKeys};
use super::read::{Reader, Values};
use super::{
    Branch, Clearance, ContactLaw, Extent, Friction, Gravity, Joint, Load, Motion, MotionKind, Run,
    Scene,
};

/// The scene of these tables. What is missing or could not be read has a value that raises no further
/// problem; a scene with problems is not handed out.
pub(super) fn scene(
    reader: &mut Reader,
    title: Option<String>,
    tables: &[Values],
    folder: &Path,
) -> Scene {
    let find = |name: &str| tables.iter().find(|values| values.section.name == name);
    if find("geometry").is_none() && !reader.doubtful("geometry") {
        reader.problem(
            "geometry",
            "the scene has no [geometry]",
            "add [geometry] with crank = \"47 mm\" and rod = \"155.83 mm\"",
        );
    }
    let length = |key: &str, default: f64| {
        let values = find("geometry");
        values.and_then(|g| g.number(key)).unwrap_or(default)
    };
    let mut scene = Scene::new(length("crank", 1.0), length("rod", 2.0));
    scene.title = title;
    scene.geometry.offset = length("offset", 0.0);
    if find("geometry").and_then(|g| g.text("branch")) == Some("left") {
        scene.geometry.branch = Branch::Left;
    }
    scene.crank = find("crank").map(|values| bodies::crank(reader, values));
    scene.rod = find("rod").map(|values| bodies::rod(reader, values, scene.geometry.rod));
    scene.slider = find("slider").map(|values| bodies::slider(reader, values));
    scene.gravity = find("gravity").and_then(gravity);
    for values in tables {
        let list = match values.section.name {
            "torque" => &mut scene.torques,
            "force" => &mut scene.forces,
            _ => continue,
        };
        let branch = scene.geometry.branch;
        let known = values.load.clone();
        let load = known.or_else(|| loads::load(reader, values, branch, folder));
        // A load that could not be read keeps its place: problems of the others count the loads.
        list.push(load.unwrap_or(Load::Constant(0.0)));
    }
    scene.friction = find("friction").and_then(friction);
    scene.clearance = find("clearance").and_then(clearance);
    if let Some(values) = find("motion") {
        scene.motion = motion(reader, values);
    }
    if let Some(values) = find("run") {
        scene.run = run(reader, values);
    }
    scene
}

fn gravity(values: &Values) -> Option<Gravity> {
    Some(Gravity {
        acceleration: values.number("acceleration")?,
        direction: values.number("direction").unwrap_or(-FRAC_PI_2),
    })
}

fn friction(values: &Values) -> Option<Friction> {
    let coefficient = values.number("coefficient")?;
    Some(Friction {
        coefficient,
        static_coefficient: values.number("static_coefficient").unwrap_or(coefficient),
    })
}

fn clearance(values: &Values) -> Option<Clearance> {
    let joint = match values.text("joint")? {
        "wrist-pin" => Joint::WristPin,
        _ => Joint::CrankPin,
    };
    let default = Clearance::new(joint, values.number("radial")?);
    let number = |key: &str, default: f64| values.number(key).unwrap_or(default);
    let word = values.text("contact_law");
    let law = ContactLaw::ALL.iter().find(|(name, _)| word == Some(*name));
    Some(Clearance {
        bearing_radius: values.number("bearing_radius"),
        young_modulus: values.number("young_modulus"),
        poisson_ratio: values.number("poisson_ratio"),
        restitution: values.number("restitution"),
        friction: values.number("friction"),
        law: law.map_or(default.law, |(_, law)| *law),
        friction_threshold: number("friction_threshold", default.friction_threshold),
        least_approach_speed: number("least_approach_speed", default.least_approach_speed),
        eccentricity: values.number("eccentricity"),
        eccentricity_angle: values.number("eccentricity_angle"),
        ..default
    })
}

fn motion(reader: &mut Reader, values: &Values) -> Motion {
    let word = values.text("kind").unwrap_or("free");
    if let Some(kind) = keys::MOTIONS.iter().find(|kind| kind.name == word) {
        keys_fit(reader, values, kind);
    }
    Motion {
        kind: match word {
            "constant-speed" => MotionKind::ConstantSpeed,
            _ => MotionKind::Free,
        },
        angle: values.number("angle").unwrap_or(0.0),
        speed: values.number("speed").unwrap_or(0.0),
    }
}

/// Whether all keys that the kind needs are there. Those that are not are reported, and those of other
/// kinds.
fn keys_fit(reader: &mut Reader, values: &Values, kind: &KindKeys) -> Option<()> {
    for name in values.names().filter(|name| *name != "kind") {
        if !kind.keys.contains(&name) {
            let what = format!("`{name}` does not belong to kind \"{}\"", kind.name);
            let help = format!("kind \"{}\" has {}", kind.name, kind.keys.join(", "));
            reader.problem(&values.field(name), what, help);
        }
    }
    let required = &kind.keys[..kind.required];
    let known = values.section.keys.iter();
    for key in known.filter(|key| required.contains(&key.name)) {
        let what = format!("`{}` is missing for kind \"{}\"", key.name, kind.name);
        reader.missing(values, key.name, what, format!("add {}", key.example()));
    }
    required.iter().all(|name| values.has(name)).then_some(())
}

fn run(reader: &mut Reader, values: &Values) -> Run {
    let duration = values.number("duration").map(Extent::Duration);
    let revolutions = values.number("revolutions").map(Extent::Revolutions);
    if duration.is_some() && revolutions.is_some() {
        reader.problem(
            &values.field("revolutions"),
            "the run has both `duration` and `revolutions`",
            "keep one of them",
        );
    }
    Run {
        extent: duration.or(revolutions),
        output_every: values.every("output_every"),
        tolerance: values
            .number("tolerance")
            .unwrap_or(Run::default().tolerance),
    }
}
