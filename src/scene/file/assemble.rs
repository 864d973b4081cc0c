//! Assembles a scene from the values of its tables: defaults, boxes, loads.

use std::f64::consts::FRAC_PI_2;

use super::keys::SECTIONS;
use super::loads::check_keys;
use super::read::{Contents, Values};
use super::{bodies, loads};
use crate::scene::check::Check;
use crate::scene::{
    Branch, Clearance, ContactLaw, Extent, Friction, Geometry, Gravity, Joint, Load, Motion,
    MotionKind, Run, Scene,
};

/// Assembles the scene of these tables. A value that is missing or could not be read gets one that raises no further
/// problem; the caller returns no scene with problems.
pub(super) fn scene(check: &mut Check, contents: Contents) -> Scene {
    let tables = contents.tables.iter();
    tables.clone().for_each(|values| required(check, values));
    let mut names = tables.map(|values| values.section.name);
    if !names.any(|name| name == "geometry") && check.has_no_problem(&["geometry"]) {
        let help = "add [geometry] with crank = \"47 mm\" and rod = \"155.83 mm\"";
        check.add("geometry", "the scene has no [geometry]", help);
    }
    // Lengths, m, in place of those that cannot be read.
    let mut scene = Scene::new(1.0, 2.0);
    // The geometry comes first; the order of the sections is that of the problems.
    for section in SECTIONS {
        for values in contents.of_section(section) {
            enter(check, values, &mut scene);
        }
    }
    scene.title = contents.title;
    scene
}

/// Enters the part of a table into the scene so far.
fn enter(check: &mut Check, values: &Values, scene: &mut Scene) {
    let Geometry { rod, branch, .. } = scene.geometry;
    match values.section.name {
        "geometry" => scene.geometry = geometry(values, scene.geometry),
        "crank" => scene.crank = Some(bodies::crank(check, values)),
        "rod" => scene.rod = Some(bodies::rod(check, values, rod)),
        "slider" => scene.slider = Some(bodies::slider(check, values)),
        "gravity" => scene.gravity = gravity(values),
        "torque" => scene.torques.push(load(check, values, branch)),
        "force" => scene.forces.push(load(check, values, branch)),
        "friction" => scene.friction = friction(values),
        "clearance" => scene.clearance = clearance(values),
        "motion" => scene.motion = motion(check, values),
        _ => scene.run = run(check, values),
    }
}

/// Returns the load of a table, which is read once for all scenes that leave the table as it is.
fn load(check: &mut Check, values: &Values, branch: Branch) -> Load {
    let read = values.load.get().cloned().or_else(|| {
        let read = loads::load(check, values)?;
        if check.problems.is_empty() {
            values.load.get_or_init(|| read.clone());
        }
        Some(read)
    });
    // A load that could not be read keeps its place, because problems of the others count the loads.
    let mut load = read.unwrap_or(Load::Constant(0.0));
    if let Load::Gas { towards_crank, .. } = &mut load {
        *towards_crank = -branch.sign();
    }
    load
}

/// Adds a problem for each key that every table of the section needs and this one lacks.
fn required(check: &mut Check, values: &Values) {
    let section = values.section;
    for key in section.required.iter().filter_map(|name| section.key(name)) {
        check.missing(values, key.name, || {
            let what = format!("`{}` is missing in {}", key.name, section.name);
            [what, format!("add {}: {}", key.example(), key.meaning)]
        });
    }
}

fn geometry(values: &Values, default: Geometry) -> Geometry {
    let number = |key: &str, default: f64| values.number(key).unwrap_or(default);
    Geometry {
        crank: number("crank", default.crank),
        rod: number("rod", default.rod),
        offset: number("offset", default.offset),
        branch: values.choice("branch", Branch::named).unwrap_or_default(),
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
    let joint = values.choice("joint", Joint::named)?;
    let default = Clearance::new(joint, values.number("radial")?);
    let law = values.choice("contact_law", ContactLaw::named);
    let number = |key: &str, default: f64| values.number(key).unwrap_or(default);
    Some(Clearance {
        bearing_radius: values.number("bearing_radius"),
        young_modulus: values.number("young_modulus"),
        poisson_ratio: values.number("poisson_ratio"),
        restitution: values.number("restitution"),
        friction: values.number("friction"),
        law: law.unwrap_or_default(),
        friction_threshold: number("friction_threshold", default.friction_threshold),
        least_approach_speed: number("least_approach_speed", default.least_approach_speed),
        eccentricity: values.number("eccentricity"),
        eccentricity_angle: values.number("eccentricity_angle"),
        ..default
    })
}

fn motion(check: &mut Check, values: &Values) -> Motion {
    let kind = values.choice("kind", MotionKind::named).unwrap_or_default();
    check_keys(check, values, kind.name());
    Motion {
        kind,
        angle: values.number("angle").unwrap_or(0.0),
        speed: values.number("speed").unwrap_or(0.0),
    }
}

fn run(check: &mut Check, values: &Values) -> Run {
    let duration = values.number("duration").map(Extent::Duration);
    let revolutions = values.number("revolutions").map(Extent::Revolutions);
    if duration.is_some() && revolutions.is_some() {
        let what = "the run has both `duration` and `revolutions`";
        check.add(values.field("revolutions"), what, "keep one of them");
    }
    let tolerance = values.number("tolerance");
    Run {
        extent: duration.or(revolutions),
        output_every: values.every("output_every"),
        tolerance: tolerance.unwrap_or(Run::default().tolerance),
    }
}
