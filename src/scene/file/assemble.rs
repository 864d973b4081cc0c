//! Values that have been read, put together to a scene: defaults, boxes, loads.

use std::f64::consts::FRAC_PI_2;

use super::loads::keys_fit;
use super::read::{Contents, Values};
use super::{bodies, loads};
use crate::scene::check::Check;
use crate::scene::{
    Branch, Clearance, ContactLaw, Extent, Friction, Gravity, Joint, Load, Motion, MotionKind, Run,
    Scene,
};

/// The scene of these tables. What is missing or could not be read has a value that raises no further
/// problem; a scene with problems is not handed out.
pub(super) fn scene(check: &mut Check, contents: Contents) -> Scene {
    let tables = &contents.tables;
    tables.iter().for_each(|values| required(check, values));
    let find = |name: &str| tables.iter().find(|values| values.section.name == name);
    let geometry = find("geometry");
    if geometry.is_none() && check.sound(["geometry"]) {
        let help = "add [geometry] with crank = \"47 mm\" and rod = \"155.83 mm\"";
        check.add("geometry", "the scene has no [geometry]", help);
    }
    let length = |key: &str, default: f64| {
        let length = geometry.and_then(|values| values.number(key));
        length.unwrap_or(default)
    };
    let mut scene = Scene::new(length("crank", 1.0), length("rod", 2.0));
    scene.title = contents.title;
    scene.geometry.offset = length("offset", 0.0);
    if geometry.and_then(|values| values.text("branch")) == Some("left") {
        scene.geometry.branch = Branch::Left;
    }
    scene.crank = find("crank").map(|values| bodies::crank(check, values));
    scene.rod = find("rod").map(|values| bodies::rod(check, values, scene.geometry.rod));
    scene.slider = find("slider").map(|values| bodies::slider(check, values));
    scene.gravity = find("gravity").and_then(|values| gravity(values));
    for values in tables {
        let list = match values.section.name {
            "torque" => &mut scene.torques,
            "force" => &mut scene.forces,
            _ => continue,
        };
        let known = values.load.get().cloned();
        let load = known.or_else(|| loads::load(check, values));
        // A load that could not be read keeps its place: problems of the others count the loads.
        let mut load = load.unwrap_or(Load::Constant(0.0));
        if check.problems.is_empty() {
            values.load.get_or_init(|| load.clone());
        }
        if let Load::Gas { towards_crank, .. } = &mut load {
            *towards_crank = -scene.geometry.branch.sign();
        }
        list.push(load);
    }
    scene.friction = find("friction").and_then(|values| friction(values));
    scene.clearance = find("clearance").and_then(|values| clearance(values));
    if let Some(values) = find("motion") {
        scene.motion = motion(check, values);
    }
    if let Some(values) = find("run") {
        scene.run = run(check, values);
    }
    scene
}

/// Keys that every table of the section has.
fn required(check: &mut Check, values: &Values) {
    let section = values.section;
    let required = section.required.iter();
    let missing = required.filter(|name| !check.met(values, name));
    let missing: Vec<_> = missing.filter_map(|name| section.key(name)).collect();
    for key in missing {
        let what = format!("`{}` is missing in {}", key.name, section.name);
        let help = format!("add {}: {}", key.example(), key.meaning);
        check.add(values.field(key.name), what, help);
    }
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

fn motion(check: &mut Check, values: &Values) -> Motion {
    let kind = values.text("kind").unwrap_or("free");
    keys_fit(check, values, kind);
    Motion {
        kind: match kind {
            "constant-speed" => MotionKind::ConstantSpeed,
            _ => MotionKind::Free,
        },
        angle: values.number("angle").unwrap_or(0.0),
        speed: values.number("speed").unwrap_or(0.0),
    }
}

fn run(check: &mut Check, values: &Values) -> Run {
    let duration = values.number("duration").map(Extent::Duration);
    let revolutions = values.number("revolutions").map(Extent::Revolutions);
    if duration.is_some() && revolutions.is_some() {
        check.add(
            values.field("revolutions"),
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
