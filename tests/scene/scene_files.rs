//! Correct scenes: every key, unit, load and table gives the intended SI value.

use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::PI;
use std::fs;
use std::path::{Path, PathBuf};

use serde_json::Value;
use slider_crank::mechanism::single;
use slider_crank::scene::{
    Branch, ContactLaw, Every, Extent, InertiaAbout, Instant, Joint, Load, MotionKind, Period,
    Periodicity, RodModel, Scene, Table, Variable, schema,
};
use tempfile::TempDir;

const GEOMETRY: &str = "[geometry]\ncrank = \"50 mm\"\nrod = \"150 mm\"\n";

fn read(text: &str) -> Scene {
    Scene::parse(Path::new("test.toml"), text)
        .unwrap_or_else(|problems| panic!("{text}\n{problems}"))
}

/// Returns a scene of minimal geometry with additional text.
fn with(more: &str) -> Scene {
    read(&format!("{GEOMETRY}{more}"))
}

#[track_caller]
fn close(found: f64, expected: f64) {
    assert!(
        (found - expected).abs() <= 4e-16 * expected.abs(),
        "{found} where {expected} is expected"
    );
}

/// Checks a value from an empirical formula or a chain of roundings.
#[track_caller]
fn near(found: f64, expected: f64, relative: f64) {
    assert!(
        (found - expected).abs() <= relative * expected.abs(),
        "{found} where {expected} is expected"
    );
}

fn now() -> Instant {
    Instant {
        t: 0.25,
        theta: 0.7,
        omega: 100.0,
        x: 0.12,
        v: -3.0,
    }
}

// The scenes in data/

fn data() -> Vec<PathBuf> {
    let mut files: Vec<_> = fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join("data"))
        .expect("data")
        .map(|entry| entry.expect("an entry of data").path())
        .filter(|path| {
            path.extension()
                .is_some_and(|extension| extension == "toml")
        })
        .collect();
    files.sort();
    files
}

fn example(name: &str) -> Scene {
    let file = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("data")
        .join(name);
    Scene::load(&file).unwrap_or_else(|error| panic!("{name}: {error}"))
}

#[test]
fn every_scene_in_data_is_right() {
    for file in data() {
        let scene = Scene::load(&file).unwrap_or_else(|error| panic!("{error}"));
        let name = file.display();
        assert!(scene.title.is_some(), "{name} has no title");
        assert!(scene.run.extent.is_some(), "{name} has no end");
        assert!(
            fs::read_to_string(&file).expect("a text").starts_with("# "),
            "{name} does not say what it is"
        );
        let g = scene.geometry;
        assert!(
            g.rod - g.crank > g.offset.abs(),
            "{name}: the crank does not turn fully"
        );
        if let Some(rod) = scene.rod.filter(|rod| rod.model == RodModel::Rigid) {
            let squared = rod.central_inertia() / rod.mass;
            assert!(
                squared > 0.0 && squared < rod.cg * (g.rod - rod.cg),
                "{name}: radius of gyration² {squared}"
            );
        }
    }
}

#[test]
fn the_scenes_in_data_show_every_section_and_kind_of_load_but_plain_tables() {
    let mut missing = BTreeSet::new();
    let texts: String = data()
        .iter()
        .map(|file| fs::read_to_string(file).expect("a scene"))
        .collect();
    for (section, value) in schema()["properties"].as_object().expect("sections") {
        if section == "title" {
            continue;
        }
        if !texts.contains(&format!("[{section}]")) {
            missing.insert(section.clone());
        }
        for kind in words(&properties(value)["kind"]) {
            if !texts.contains(&format!("kind = \"{kind}\"")) {
                missing.insert(format!("{section} {kind}"));
            }
        }
    }
    assert_eq!(
        missing,
        BTreeSet::from(["force table".to_owned(), "torque table".to_owned()])
    );
}

#[test]
fn obaseki_alfred_has_the_equivalent_masses_of_the_paper() {
    let scene = example("obaseki-alfred.toml");
    let (crank, rod, slider) = (
        scene.crank.unwrap(),
        scene.rod.unwrap(),
        scene.slider.unwrap(),
    );
    let (k, c) = (scene.geometry.crank, scene.geometry.rod);
    assert_eq!((k, c, scene.geometry.offset), (0.04, 0.064, 0.02));
    // (31)-(36) with c2 = c3 = c/2 and k1 = k/2.
    let at_slider = rod.mass * rod.cg / c;
    near(
        rod.mass - at_slider + crank.mass * crank.cg / k,
        0.35,
        1e-15,
    );
    near(at_slider + slider.mass, 1.05, 1e-15);
    near(crank.inertia, 0.2 * 0.04 * 0.04 / 3.0, 1e-15);
    assert_eq!(scene.motion.speed, 251.0);
    let experiment = example("obaseki-alfred-experiment.toml");
    let crank = experiment.crank.unwrap();
    near(crank.inertia, 7.0 * 0.0381 * 0.0381, 1e-15);
    assert_eq!((crank.cg, experiment.slider.unwrap().mass), (0.0381, 1.543));
    assert_eq!(experiment.motion.speed, 20.994);
}

#[test]
fn gupta_has_the_moments_about_the_normal_of_the_plane() {
    let scene = example("gupta.toml");
    let (crank, rod) = (scene.crank.unwrap(), scene.rod.unwrap());
    near(
        crank.inertia - crank.mass * crank.cg * crank.cg,
        1758.88e-6,
        1e-14,
    );
    close(rod.central_inertia(), 14559.33482e-6);
    assert_eq!(
        (crank.mass, rod.mass, scene.slider.unwrap().mass),
        (0.764, 1.56, 1.95)
    );
    // The three printed moments of AB are those of along² + across², along² + normal² and across² + normal²; hence the
    // normal² of a depth of 20 mm.
    let normal = 0.764 * 20.0 * 20.0 / 12.0;
    let across = 1758.88 - 1729.192 + normal;
    near(across + normal, 80.607, 3e-4);
    let turned = example("left-negative-offset.toml");
    assert_eq!(turned.geometry.branch, Branch::Left);
    assert_eq!(turned.geometry.offset, -scene.geometry.offset);
    assert_eq!(
        (turned.crank, turned.rod, turned.slider),
        (scene.crank, scene.rod, scene.slider)
    );
}

#[test]
fn ng_has_twice_the_torque_of_its_text() {
    let scene = example("ng.toml");
    let [Load::Constant(torque)] = scene.torques[..] else {
        panic!("{:?}", scene.torques)
    };
    near(torque, 2.0 * 0.5 * 9.81 * 0.027, 1e-15);
    assert_eq!(scene.friction.unwrap().coefficient, 1.0);
    // The run ends at 160 deg and has a row at each angle of table 2.
    let Some(Extent::Duration(duration)) = scene.run.extent else {
        panic!()
    };
    near(
        scene.motion.angle + scene.motion.speed * duration,
        160.0 * PI / 180.0,
        1e-15,
    );
    assert_eq!(scene.run.output_every, Some(Every::Angle(PI / 18.0)));
}

#[test]
fn the_duarte_scenes_are_one_engine() {
    let engine = Scene::duarte();
    let (printed, cycle) = (
        example("duarte-as-printed.toml"),
        example("duarte-cycle.toml"),
    );
    for scene in [&printed, &cycle] {
        assert_eq!(
            (scene.geometry, scene.crank, scene.slider),
            (engine.geometry, engine.crank, engine.slider)
        );
    }
    assert_eq!(cycle.rod, engine.rod);
    let mut rod = engine.rod.unwrap();
    rod.model = RodModel::SpinOnly;
    assert_eq!(printed.rod, Some(rod));
}

#[test]
fn the_pressure_of_the_cycle_is_its_formula() {
    let scene = example("duarte-cycle.toml");
    let [
        Load::Gas {
            pressure,
            ambient,
            area,
            towards_crank,
        },
    ] = &scene.forces[..]
    else {
        panic!()
    };
    assert_eq!((*ambient, *towards_crank), (1e5, -1.0));
    near(*area, PI * 0.04 * 0.04, 1e-15);
    near(pressure.period().unwrap(), 2.0 * PI, 1e-15);
    let (r, l) = (47.0f64, 155.83f64);
    let c = 2.0 * r / 15.0;
    let ramp = |a: f64| (1.0 - (PI * a.clamp(0.0, 1.0)).cos()) / 2.0;
    let mut work = 0.0;
    for degrees in (0..360).step_by(2).map(f64::from) {
        let theta = degrees * PI / 180.0;
        let x = r * theta.cos() + (l * l - (r * theta.sin()).powi(2)).sqrt();
        let s = ramp(degrees / 30.0) * (1.0 - ramp((degrees - 130.0) / 50.0));
        let expected = 1e5 * ((2.0 * r + c) / (r + l - x + c)).powf(1.35) * (1.0 + 1.5 * s);
        near(pressure.value(theta), expected, 1e-6);
        let x_dash = -1e-3
            * r
            * (theta.sin()
                + r * theta.sin() * theta.cos() / (l * l - (r * theta.sin()).powi(2)).sqrt());
        let instant = Instant {
            theta,
            ..Instant::default()
        };
        work += single(&scene.forces[0], true, &instant) * x_dash * PI / 90.0;
    }
    // The mean torque is given in the comment of the scene.
    near(work / (2.0 * PI), 46.8, 1e-3);
}

#[test]
fn the_pressure_of_the_four_strokes_is_its_formulas() {
    let scene = example("four-stroke.toml");
    let [Load::Gas { pressure, .. }] = &scene.forces[..] else {
        panic!()
    };
    assert_eq!(
        pressure.repeats(),
        Periodicity::After(Period::turns(2).unwrap())
    );
    let (r, l) = (43.0f64, 143.5f64);
    let h = |degrees: f64| {
        let theta = degrees.to_radians();
        let x = r * theta.cos() + (l * l - (r * theta.sin()).powi(2)).sqrt();
        r + l - x + 2.0 * r / 9.0
    };
    let closed = |degrees: f64| {
        let compressed = |at: f64| 0.85 * (h(-145.0) / h(at)).powf(1.32);
        let burnt = 1.0 - (-6.908 * ((degrees + 12.0) / 50.0).max(0.0).powi(3)).exp();
        let expanded = 3.4 * compressed(0.0) * (h(0.0) / h(degrees)).powf(1.27);
        (1.0 - burnt) * compressed(degrees) + burnt * expanded
    };
    let fall = |a: f64| (1.0 + (PI * a.clamp(0.0, 1.0)).cos()) / 2.0;
    for degrees in (0..720).step_by(2).map(f64::from) {
        let expected = match degrees {
            _ if degrees <= 130.0 => closed(degrees),
            _ if degrees >= 575.0 => closed(degrees - 720.0),
            _ if degrees < 360.0 => 1.08 + (closed(130.0) - 1.08) * fall((degrees - 130.0) / 60.0),
            _ => 0.85 + (1.08 - 0.85) * fall((degrees - 360.0) / 40.0),
        };
        // The values have five digits.
        near(pressure.value(degrees.to_radians()) / 1e5, expected, 1e-4);
    }
}

// Sections and keys

/// Scene of the documentation, with every section and nearly every key.
const WHOLE: &str = r#"
title = "Duarte 2018 Diesel engine, free spin"

[geometry]
crank = "47 mm"
rod = "155.83 mm"
offset = "3 mm"
branch = "left"

[crank]
mass = "15.3351 kg"
cg = "2 mm"
cg_lateral = "-1 mm"
inertia = "27698.81 kg mm^2"

[rod]
model = "rigid"
mass = "0.8602 kg"
cg = "51.07 mm"
cg_lateral = "0.5 mm"
inertia = "5807.55 kg mm^2"
inertia_about = "crank-pin"

[slider]
mass = "0.5341 kg"

[gravity]
acceleration = "9.80665 m/s^2"
direction = "-45 deg"

[[torque]]
kind = "constant"
value = "2 N m"

[[torque]]
kind = "viscous"
coefficient = "0.02 N m s/rad"

[[torque]]
kind = "motor"
stall = "5 N m"
no_load_speed = "1500 rpm"

[[torque]]
kind = "expression"
value = "2 - 0.01*omega + 0.3*sin(2*theta)"

[[force]]
kind = "constant"
value = "-200 N"

[[force]]
kind = "viscous"
coefficient = "15 N s/m"

[[force]]
kind = "spring"
stiffness = "2 kN/m"
rest = "100 mm"

[[force]]
kind = "expression"
value = "-1e3*(x - 0.1) + 2*v + t"

[friction]
coefficient = 0.1
static_coefficient = 0.15

[clearance]
joint = "wrist-pin"
radial = "0.5 mm"
bearing_radius = "10 mm"
young_modulus = "207 GPa"
poisson_ratio = 0.3
restitution = 0.9
friction = 0.05
contact_law = "gonthier"
friction_threshold = "5 mm/s"
least_approach_speed = "2 mm/s"
eccentricity = "0.2 mm"
eccentricity_angle = "180 deg"

[motion]
kind = "constant-speed"
angle = "30 deg"
speed = "-100 rad/s"

[run]
revolutions = 16
output_every = "1 deg"
tolerance = 1e-8
"#;

#[test]
fn every_key_is_read_to_its_si_value() {
    let scene = read(WHOLE);
    assert_eq!(
        scene.title.as_deref(),
        Some("Duarte 2018 Diesel engine, free spin")
    );
    let g = scene.geometry;
    assert_eq!(
        (g.crank, g.rod, g.offset, g.branch),
        (0.047, 0.15583, 0.003, Branch::Left)
    );
    let crank = scene.crank.unwrap();
    assert_eq!(
        (crank.mass, crank.cg, crank.cg_lateral, crank.inertia),
        (15.3351, 0.002, -0.001, 0.02769881)
    );
    let rod = scene.rod.unwrap();
    assert_eq!(
        (rod.model, rod.inertia_about),
        (RodModel::Rigid, InertiaAbout::CrankPin)
    );
    assert_eq!(
        (rod.mass, rod.cg, rod.cg_lateral, rod.inertia),
        (0.8602, 0.05107, 0.0005, 0.00580755)
    );
    assert_eq!(scene.slider.unwrap().mass, 0.5341);
    let gravity = scene.gravity.unwrap();
    assert_eq!(gravity.acceleration, 9.80665);
    close(gravity.direction, -PI / 4.0);
    let friction = scene.friction.unwrap();
    assert_eq!(
        (friction.coefficient, friction.static_coefficient),
        (0.1, 0.15)
    );
    let clearance = scene.clearance.unwrap();
    assert_eq!(
        (clearance.joint, clearance.radial),
        (Joint::WristPin, 0.0005)
    );
    assert_eq!(
        (clearance.bearing_radius, clearance.young_modulus),
        (Some(0.01), Some(207e9))
    );
    assert_eq!(
        (
            clearance.poisson_ratio,
            clearance.restitution,
            clearance.friction
        ),
        (Some(0.3), Some(0.9), Some(0.05))
    );
    assert_eq!(clearance.law, ContactLaw::Gonthier);
    assert_eq!(
        (clearance.friction_threshold, clearance.least_approach_speed),
        (0.005, 0.002)
    );
    assert_eq!(
        (clearance.eccentricity, clearance.eccentricity_angle),
        (Some(0.0002), Some(PI))
    );
    assert_eq!(scene.motion.kind, MotionKind::ConstantSpeed);
    close(scene.motion.angle, PI / 6.0);
    assert_eq!(scene.motion.speed, -100.0);
    assert_eq!(scene.run.extent, Some(Extent::Revolutions(16.0)));
    assert_eq!(scene.run.output_every, Some(Every::Angle(PI / 180.0)));
    assert_eq!(scene.run.tolerance, 1e-8);
}

#[test]
fn every_kind_of_load_has_its_value() {
    let scene = read(WHOLE);
    let now = now();
    let torques: Vec<f64> = scene
        .torques
        .iter()
        .map(|load| single(load, false, &now))
        .collect();
    assert_eq!(torques.len(), 4);
    assert_eq!(torques[..2], [2.0, -2.0]);
    near(torques[2], 5.0 * (1.0 - 100.0 / (50.0 * PI)), 1e-15);
    near(torques[3], 1.0 + 0.3 * 1.4f64.sin(), 1e-15);
    let forces: Vec<f64> = scene
        .forces
        .iter()
        .map(|load| single(load, true, &now))
        .collect();
    assert_eq!(forces.len(), 4);
    assert_eq!(forces[..2], [-200.0, 45.0]);
    near(forces[2], -2000.0 * (0.12 - 0.1), 1e-14);
    near(forces[3], -1e3 * (0.12 - 0.1) - 6.0 + 0.25, 1e-14);
}

#[test]
fn loads_say_what_they_read() {
    let scene = read(WHOLE);
    let reads = |loads: &[Load], on_slider| {
        loads
            .iter()
            .map(|l| l.reads(on_slider).to_string())
            .collect::<Vec<_>>()
    };
    assert_eq!(
        reads(&scene.torques, false),
        ["nothing", "omega", "omega", "theta, omega"]
    );
    assert_eq!(reads(&scene.forces, true), ["nothing", "v", "x", "t, x, v"]);
}

#[test]
fn what_is_not_said_has_its_default() {
    let scene = read(GEOMETRY);
    assert_eq!(
        (scene.title, scene.geometry.offset, scene.geometry.branch),
        (None, 0.0, Branch::Right)
    );
    assert!(scene.crank.is_none() && scene.rod.is_none() && scene.slider.is_none());
    assert!(scene.gravity.is_none() && scene.friction.is_none() && scene.clearance.is_none());
    assert!(scene.torques.is_empty() && scene.forces.is_empty());
    assert_eq!(
        (scene.motion.kind, scene.motion.angle, scene.motion.speed),
        (MotionKind::Free, 0.0, 0.0)
    );
    assert_eq!(
        (
            scene.run.extent,
            scene.run.output_every,
            scene.run.tolerance
        ),
        (None, None, 1e-10)
    );

    let scene = with(
        "[crank]\nmass = \"1 kg\"\ninertia = \"1 kg m^2\"\n\
         [rod]\nmass = \"1 kg\"\ncg = \"70 mm\"\ninertia = \"0.01 kg m^2\"\n\
         [gravity]\nacceleration = \"1 m/s^2\"\n\
         [friction]\ncoefficient = 0.2\n\
         [clearance]\njoint = \"crank-pin\"\nradial = \"0.1 mm\"\n",
    );
    let (crank, rod) = (scene.crank.unwrap(), scene.rod.unwrap());
    assert_eq!((crank.cg, crank.cg_lateral), (0.0, 0.0));
    assert_eq!(
        (rod.model, rod.inertia_about, rod.cg_lateral),
        (RodModel::Rigid, InertiaAbout::Cg, 0.0)
    );
    assert_eq!(scene.gravity.unwrap().vector(), [0.0, -1.0]);
    assert_eq!(scene.friction.unwrap().static_coefficient, 0.2);
    let clearance = scene.clearance.unwrap();
    assert_eq!(
        (
            clearance.bearing_radius,
            clearance.young_modulus,
            clearance.poisson_ratio
        ),
        (None, None, None)
    );
    assert_eq!((clearance.restitution, clearance.friction), (None, None));
    assert_eq!(clearance.law, ContactLaw::LankaraniNikravesh);
    assert_eq!(
        (clearance.friction_threshold, clearance.least_approach_speed),
        (0.01, 0.001)
    );
    assert_eq!(
        (clearance.eccentricity, clearance.eccentricity_angle),
        (None, None)
    );
}

#[test]
fn every_word_of_a_choice_is_read() {
    for (word, branch) in [("right", Branch::Right), ("left", Branch::Left)] {
        assert_eq!(
            read(&format!("{GEOMETRY}branch = \"{word}\""))
                .geometry
                .branch,
            branch
        );
    }
    for (word, model) in [
        ("rigid", RodModel::Rigid),
        ("two-mass", RodModel::TwoMass),
        ("spin-only", RodModel::SpinOnly),
        ("massless", RodModel::Massless),
    ] {
        let rod = format!(
            "[rod]\nmodel = \"{word}\"\nmass = \"1 kg\"\ncg = \"60 mm\"\ninertia = \"0.01 kg m^2\""
        );
        assert_eq!(with(&rod).rod.unwrap().model, model);
    }
    for (word, about) in [
        ("cg", InertiaAbout::Cg),
        ("crank-pin", InertiaAbout::CrankPin),
    ] {
        let rod = format!(
            "[rod]\nmass = \"1 kg\"\ncg = \"60 mm\"\ninertia = \"0.01 kg m^2\"\ninertia_about = \"{word}\""
        );
        assert_eq!(with(&rod).rod.unwrap().inertia_about, about);
    }
    for (word, joint) in [
        ("crank-pin", Joint::CrankPin),
        ("wrist-pin", Joint::WristPin),
    ] {
        let clearance = format!("[clearance]\njoint = \"{word}\"\nradial = \"1 mm\"");
        assert_eq!(with(&clearance).clearance.unwrap().joint, joint);
    }
    for (word, kind) in [
        ("free", MotionKind::Free),
        ("constant-speed", MotionKind::ConstantSpeed),
    ] {
        let motion = format!("[motion]\nkind = \"{word}\"\nspeed = \"1 rad/s\"");
        assert_eq!(with(&motion).motion.kind, kind);
    }
}

#[test]
fn a_run_ends_after_a_time_or_turns_and_has_rows_every_time_or_angle() {
    let run = |text: &str| with(&format!("[run]\n{text}")).run;
    assert_eq!(
        run("duration = \"1.5 min\"").extent,
        Some(Extent::Duration(90.0))
    );
    assert_eq!(run("duration = 0").extent, Some(Extent::Duration(0.0)));
    assert_eq!(
        run("revolutions = 2.5").extent,
        Some(Extent::Revolutions(2.5))
    );
    assert_eq!(
        run("output_every = \"0.2 ms\"").output_every,
        Some(Every::Time(0.0002))
    );
    assert_eq!(
        run("output_every = \"0.5 rad\"").output_every,
        Some(Every::Angle(0.5))
    );
    assert_eq!(run("tolerance = 1e-13").tolerance, 1e-13);
}

#[test]
fn a_constant_speed_may_be_zero_if_it_is_said() {
    for zero in ["0", "0.0", "\"0 rpm\""] {
        let motion = with(&format!(
            "[motion]\nkind = \"constant-speed\"\nspeed = {zero}"
        ))
        .motion;
        assert_eq!(
            (motion.kind, motion.speed),
            (MotionKind::ConstantSpeed, 0.0)
        );
    }
}

#[test]
fn a_start_may_be_at_the_limit_but_not_beyond() {
    let start = |degrees: f64| {
        Scene::new(0.1, 0.05)
            .start(degrees * PI / 180.0, 0.0)
            .check()
    };
    for degrees in [0.0, 29.0, 30.0, -30.0, 150.0, 210.0, 750.0, -3630.0] {
        assert!(start(degrees).is_ok(), "{degrees}");
    }
    for degrees in [30.001, -30.001, 90.0, 149.999, 270.0, 1170.0] {
        let problems = start(degrees).expect_err("a start out of reach");
        assert_eq!(problems.list()[0].field, "motion.angle", "{degrees}");
    }
}

/// The capabilities of a mechanism may be asked before it has a start.
#[test]
fn a_scene_without_motion_needs_no_position_at_zero() {
    let scene = read("[geometry]\ncrank = \"50 mm\"\nrod = \"40 mm\"\noffset = \"60 mm\"");
    assert!(scene.start(0.0, 1.0).check().is_err());
}

#[test]
fn a_crank_without_mass_may_have_an_inertia() {
    let crank = with("[crank]\ncg = 0\ninertia = \"0.01 kg m^2\"")
        .crank
        .unwrap();
    assert_eq!((crank.mass, crank.inertia), (0.0, 0.01));
    let rod = with("[rod]\nmodel = \"massless\"\ncg = \"50 mm\"")
        .rod
        .unwrap();
    assert_eq!((rod.model, rod.mass), (RodModel::Massless, 0.0));
    let rod = with("[rod]\nmass = 0\ninertia = \"0.01 kg m^2\"")
        .rod
        .unwrap();
    assert_eq!((rod.mass, rod.inertia), (0.0, 0.01));
}

#[test]
fn toml_may_be_written_in_its_other_ways() {
    let scene = read(
        "geometry = { crank = '50 mm', rod = \"\"\"150 mm\"\"\", \"offset\" = 0 }\n\
         torque = [ { kind = \"constant\", value = \"2 N m\" } ]\n\
         motion.speed = \"10 rad/s\"\n",
    );
    assert_eq!(
        (scene.geometry.crank, scene.geometry.rod, scene.motion.speed),
        (0.05, 0.15, 10.0)
    );
    assert!(matches!(scene.torques[..], [Load::Constant(2.0)]));
    assert_eq!(
        with("[friction]\ncoefficient = 1_0.2_5 # rough\n")
            .friction
            .unwrap()
            .coefficient,
        10.25
    );
    assert_eq!(
        with("[friction]\ncoefficient = \"0.25\"")
            .friction
            .unwrap()
            .coefficient,
        0.25
    );
    assert!(read(&format!("torque = []\n{GEOMETRY}")).torques.is_empty());
}

#[test]
fn windows_line_ends_and_a_byte_order_mark_change_nothing() {
    let expected = format!("{:?}", read(WHOLE));
    for text in [
        WHOLE.replace('\n', "\r\n"),
        format!("\u{feff}{WHOLE}"),
        format!("\u{feff}{}", WHOLE.replace('\n', "\r\n")),
    ] {
        assert_eq!(format!("{:?}", read(&text)), expected);
    }
}

// Units

#[test]
fn lengths_in_many_spellings() {
    for (text, metres) in [
        ("47 mm", 0.047),
        ("47mm", 0.047),
        ("  47   mm ", 0.047),
        ("+47 mm", 0.047),
        ("4.7e1 mm", 0.047),
        ("4.7E+1 mm", 0.047),
        (".047 m", 0.047),
        ("47. mm", 0.047),
        ("4.7 cm", 0.047),
        ("0.47 dm", 0.047),
        ("47000 um", 0.047),
        ("47000 µm", 0.047),
        ("47000 μm", 0.047),
        ("47e6 nm", 0.047),
        ("0.000047 km", 0.047),
        ("2 in", 0.0508),
        ("0.25 ft", 0.0762),
    ] {
        let scene = read(&format!("[geometry]\ncrank = \"{text}\"\nrod = \"1 m\""));
        close(scene.geometry.crank, metres);
    }
}

/// Returns a quantity as a scene reads it.
fn si(quantity: &str, text: &str) -> f64 {
    let key = match quantity {
        "mass" => "[slider]\nmass",
        "inertia" => "[crank]\ninertia",
        "angle" => "[motion]\nangle",
        "speed" => "[motion]\nspeed",
        "acceleration" => "[gravity]\nacceleration",
        "time" => "[run]\nduration",
        "torque" => "[[torque]]\nkind = \"constant\"\nvalue",
        "force" => "[[force]]\nkind = \"constant\"\nvalue",
        "rotary damping" => "[[torque]]\nkind = \"viscous\"\ncoefficient",
        "linear damping" => "[[force]]\nkind = \"viscous\"\ncoefficient",
        "stiffness" => "[[force]]\nkind = \"spring\"\nrest = 0\nstiffness",
        "pressure" => "[clearance]\njoint = \"crank-pin\"\nradial = \"1 mm\"\nyoung_modulus",
        "density" => "[slider]\nlength = \"1 m\"\nwidth = \"1 m\"\ndepth = \"1 m\"\ndensity",
        _ => unreachable!("{quantity}"),
    };
    let scene = with(&format!("{key} = \"{text}\""));
    match quantity {
        "mass" | "density" => scene.slider.unwrap().mass,
        "inertia" => scene.crank.unwrap().inertia,
        "angle" => scene.motion.angle,
        "speed" => scene.motion.speed,
        "acceleration" => scene.gravity.unwrap().acceleration,
        "pressure" => scene.clearance.unwrap().young_modulus.unwrap(),
        "time" => match scene.run.extent {
            Some(Extent::Duration(duration)) => duration,
            other => panic!("{other:?}"),
        },
        _ => match scene.torques.first().or(scene.forces.first()) {
            Some(Load::Constant(value) | Load::Viscous(value)) => *value,
            Some(Load::Spring { stiffness, .. }) => *stiffness,
            other => panic!("{other:?}"),
        },
    }
}

#[test]
fn units_of_every_quantity_in_many_spellings() {
    const INCH: f64 = 0.0254;
    const FOOT: f64 = 0.3048;
    const POUND: f64 = 0.453_592_37;
    const G: f64 = 9.806_65;
    for (quantity, text, expected) in [
        ("mass", "0.86 kg", 0.86),
        ("mass", "860 g", 0.86),
        ("mass", "860000 mg", 0.86),
        ("mass", "2 t", 2000.0),
        ("mass", "1.9 lb", 1.9 * POUND),
        ("mass", "1.9 lbm", 1.9 * POUND),
        ("mass", "8 oz", 0.5 * POUND),
        ("mass", "1 slug", POUND * G / FOOT),
        ("inertia", "5807.55 kg mm^2", 0.00580755),
        ("inertia", "5807.55 kg·mm²", 0.00580755),
        ("inertia", "5807.55 kg*mm2", 0.00580755),
        ("inertia", "58.0755 kg cm²", 0.00580755),
        ("inertia", "0.00580755 kg m^2", 0.00580755),
        ("inertia", "5.80755 g m^2", 0.00580755),
        ("inertia", "0.00580755 kg × m²", 0.00580755),
        ("inertia", "0.00580755 N m s^2", 0.00580755),
        ("inertia", "2 lb in^2", 2.0 * POUND * INCH * INCH),
        ("angle", "40 deg", 40.0 * PI / 180.0),
        ("angle", "40°", 40.0 * PI / 180.0),
        ("angle", "-40 °", -40.0 * PI / 180.0),
        ("angle", "−40 deg", -40.0 * PI / 180.0),
        ("angle", "0.7 rad", 0.7),
        ("angle", "250 mrad", 0.25),
        ("angle", "2 rev", 4.0 * PI),
        ("angle", "0.5 turn", PI),
        ("speed", "200 rpm", 200.0 * PI / 30.0),
        ("speed", "100 rad/s", 100.0),
        ("speed", "100 rad s^-1", 100.0),
        ("speed", "100 rad·s⁻¹", 100.0),
        ("speed", "30 deg/s", PI / 6.0),
        ("speed", "90°/s", PI / 2.0),
        ("speed", "2 rev/s", 4.0 * PI),
        ("speed", "2400 rev/min", 80.0 * PI),
        ("speed", "1 turn/h", 2.0 * PI / 3600.0),
        ("speed", "5 rad/ms", 5000.0),
        ("acceleration", "9.80665 m/s^2", G),
        ("acceleration", "9.80665 m/s2", G),
        ("acceleration", "9.80665 m/s²", G),
        ("acceleration", "9.80665 m s⁻²", G),
        ("acceleration", "9.80665 m/(s s)", G),
        ("acceleration", "9.80665 m/s/s", G),
        ("acceleration", "9806.65 mm/s^2", G),
        ("acceleration", "9.80665 N/kg", G),
        ("acceleration", "10 ft/s^2", 10.0 * FOOT),
        ("time", "1.5 s", 1.5),
        ("time", "1500 ms", 1.5),
        ("time", "20 us", 2e-5),
        ("time", "20 µs", 2e-5),
        ("time", "3 min", 180.0),
        ("time", "0.5 h", 1800.0),
        ("torque", "2 N m", 2.0),
        ("torque", "2 N*m", 2.0),
        ("torque", "2 N·m", 2.0),
        ("torque", "2 N⋅m", 2.0),
        ("torque", "2 Nm", 2.0),
        ("torque", "2000 Nmm", 2.0),
        ("torque", "2000 N mm", 2.0),
        ("torque", "0.002 kN m", 2.0),
        ("torque", "2 kNm", 2000.0),
        ("torque", "2 J", 2.0),
        ("torque", "-264.87 N mm", -0.26487),
        ("torque", "2 kg m^2/s^2", 2.0),
        ("torque", "1 lbf ft", POUND * G * FOOT),
        ("torque", "1 lbf in", POUND * G * INCH),
        ("torque", "3 kgf cm", 3.0 * G / 100.0),
        ("force", "-200 N", -200.0),
        ("force", "−200 N", -200.0),
        ("force", "-0.2 kN", -200.0),
        ("force", "5 mN", 0.005),
        ("force", "10 lbf", 10.0 * POUND * G),
        ("force", "2 kgf", 2.0 * G),
        ("force", "3 kg m/s^2", 3.0),
        ("rotary damping", "0.02 N m s/rad", 0.02),
        ("rotary damping", "0.02 N m s", 0.02),
        ("rotary damping", "0.02 N·m·s/rad", 0.02),
        ("rotary damping", "20 N mm s/rad", 0.02),
        ("rotary damping", "0.02 N m/(rad/s)", 0.02),
        ("rotary damping", "1 N m/rpm", 30.0 / PI),
        ("linear damping", "15 N s/m", 15.0),
        ("linear damping", "15 N/(m/s)", 15.0),
        ("linear damping", "0.015 N s/mm", 15.0),
        ("linear damping", "15 kg/s", 15.0),
        ("stiffness", "2 kN/m", 2000.0),
        ("stiffness", "2 N/mm", 2000.0),
        ("stiffness", "2000 N/m", 2000.0),
        ("stiffness", "2000 kg/s^2", 2000.0),
        ("stiffness", "5 lbf/in", 5.0 * POUND * G / INCH),
        ("pressure", "207 GPa", 207e9),
        ("pressure", "207000 MPa", 207e9),
        ("pressure", "2.07e11 Pa", 207e9),
        ("pressure", "2.07e6 bar", 207e9),
        ("pressure", "207 kN/mm^2", 207e9),
        ("pressure", "1 atm", 101_325.0),
        ("pressure", "10 hPa", 1000.0),
        ("pressure", "5 mbar", 500.0),
        ("pressure", "1 kg/(m s^2)", 1.0),
        ("pressure", "1000 psi", 1000.0 * POUND * G / INCH / INCH),
        ("density", "7800 kg/m^3", 7800.0),
        ("density", "7.8 g/cm^3", 7800.0),
        ("density", "7.8 g/cm³", 7800.0),
        ("density", "7.8 kg/dm³", 7800.0),
        ("density", "7.8 t/m^3", 7800.0),
        ("density", "7.8e-6 kg/mm^3", 7800.0),
    ] {
        let found = si(quantity, text);
        let error = (found - expected).abs();
        assert!(
            error <= 1e-15 * expected.abs(),
            "{text}: {found} where {expected} is expected"
        );
    }
}

/// Editors and web pages replace hyphens by minus signs, also in exponents.
#[test]
fn a_typographic_minus_is_a_minus_everywhere() {
    assert_eq!(
        with("[gravity]\nacceleration = \"9.81 m s^−2\"")
            .gravity
            .unwrap()
            .acceleration,
        9.81
    );
    assert_eq!(
        with("[gravity]\nacceleration = \"9.81 m s−2\"")
            .gravity
            .unwrap()
            .acceleration,
        9.81
    );
    close(si("force", "−2e−3 N"), -0.002);
    let scene = with("[[force]]\nkind = \"expression\"\nvalue = \"−2 − 1e−3*x\"");
    close(single(&scene.forces[0], true, &now()), -2.00012);
    let table = torque_table("x [m],torque [N m]\n−1,−2\n1,3\n", "x", "");
    assert_eq!((table.rows(), table.value(-1.0)), (&[-1.0, 1.0][..], -2.0));
}

#[test]
fn decimal_digits_are_rounded_once() {
    for (text, metres) in [
        ("155.83 mm", 0.15583),
        ("0.1 mm", 0.0001),
        ("0.3 mm", 0.0003),
        ("47.07 mm", 0.04707),
        ("123.456789 mm", 0.123456789),
        ("1.7e-3 mm", 0.0000017),
    ] {
        assert_eq!(
            read(&format!("[geometry]\ncrank = \"{text}\"\nrod = \"9 m\""))
                .geometry
                .crank,
            metres
        );
    }
}

#[test]
fn zero_needs_no_unit() {
    let scene = with("offset = 0\n[motion]\nspeed = 0.0\nangle = \"0\"\n");
    assert_eq!(
        (
            scene.geometry.offset,
            scene.motion.speed,
            scene.motion.angle
        ),
        (0.0, 0.0, 0.0)
    );
}

// Bodies from density and size

#[test]
fn boxes_give_mass_and_inertia() {
    let steel =
        "density = \"7850 kg/m^3\"\nlength = \"200 mm\"\nwidth = \"30 mm\"\ndepth = \"20 mm\"\n";
    let mass = 7850.0 * 0.2 * 0.03 * 0.02;
    let central = mass * (0.2 * 0.2 + 0.03 * 0.03) / 12.0;

    near(
        with(&format!("[slider]\n{steel}")).slider.unwrap().mass,
        mass,
        1e-15,
    );

    let crank = with(&format!("[crank]\n{steel}")).crank.unwrap();
    near(crank.mass, mass, 1e-15);
    near(crank.inertia, central, 1e-15);
    // Inertia about O, also if the box does not turn about its middle.
    let crank = with(&format!(
        "[crank]\n{steel}cg = \"60 mm\"\ncg_lateral = \"-8 mm\""
    ))
    .crank
    .unwrap();
    near(
        crank.inertia,
        central + mass * (0.06 * 0.06 + 0.008 * 0.008),
        1e-15,
    );

    let rod = with(&format!("[rod]\n{steel}")).rod.unwrap();
    assert_eq!(rod.cg, 0.075, "the middle of the rod");
    near(rod.central_inertia(), central, 1e-15);
    let rod = with(&format!("[rod]\n{steel}cg = \"60 mm\"")).rod.unwrap();
    near(rod.central_inertia(), central, 1e-15);
    let rod = with(&format!(
        "[rod]\n{steel}cg = \"60 mm\"\ninertia_about = \"crank-pin\""
    ))
    .rod
    .unwrap();
    near(rod.inertia, central + mass * 0.06 * 0.06, 1e-15);
    near(rod.central_inertia(), central, 1e-14);
}

#[test]
fn what_is_stated_beside_a_box_holds_if_it_agrees_to_a_percent() {
    let steel =
        "density = \"7800 kg/m^3\"\nlength = \"100 mm\"\nwidth = \"50 mm\"\ndepth = \"50 mm\"\n";
    assert_eq!(
        with(&format!("[slider]\nmass = \"1.96 kg\"\n{steel}"))
            .slider
            .unwrap()
            .mass,
        1.96
    );
    let rod = with(&format!(
        "[rod]\nmass = \"1.96 kg\"\ninertia = \"2031 kg mm^2\"\n{steel}"
    ))
    .rod
    .unwrap();
    assert_eq!((rod.mass, rod.inertia), (1.96, 0.002031));
}

#[test]
fn an_inertia_about_the_crank_pin_is_carried_to_the_centre_of_gravity() {
    let rod = |more: &str| {
        with(&format!(
            "[rod]\nmass = \"2 kg\"\ncg = \"60 mm\"\ncg_lateral = \"10 mm\"\n{more}"
        ))
        .rod
        .unwrap()
    };
    let squared = 0.06 * 0.06 + 0.01 * 0.01;
    near(
        rod("inertia = \"0.01 kg m^2\"\ninertia_about = \"crank-pin\"").central_inertia(),
        0.01 - 2.0 * squared,
        1e-15,
    );
    assert_eq!(rod("inertia = \"0.01 kg m^2\"").central_inertia(), 0.01);
    // Duarte's rod: 5807.55 − 0.8602·51.07² kg mm².
    near(
        Scene::duarte().rod.unwrap().central_inertia(),
        3564.02375702e-6,
        1e-14,
    );
}

#[test]
fn the_least_inertia_of_a_point_mass_is_allowed() {
    let scene = with(
        "[crank]\nmass = \"7 kg\"\ncg = \"38.1 mm\"\ninertia = \"10161.27 kg mm^2\"\n\
         [rod]\nmass = \"1 kg\"\ncg = \"70 mm\"\ninertia = \"4900 kg mm^2\"\ninertia_about = \"crank-pin\"\n",
    );
    assert!(scene.rod.unwrap().central_inertia().abs() < 1e-17);
}

// Tables

/// Temporary folder with a scene file and a table.
struct Folder(TempDir);

impl Folder {
    fn with(table: &str) -> Folder {
        let folder = TempDir::new().expect("a temporary folder");
        fs::create_dir(folder.path().join("measured")).expect("a folder");
        fs::write(folder.path().join("measured/table.csv"), table).expect("a table");
        Folder(folder)
    }

    fn load(&self, load: &str) -> Scene {
        let file = self.0.path().join("scene.toml");
        fs::write(&file, format!("{GEOMETRY}{load}")).expect("a scene");
        Scene::load(&file).unwrap_or_else(|error| panic!("{error}"))
    }
}

/// Returns the table of a torque over `of`.
fn torque_table(table: &str, of: &str, more: &str) -> Table {
    let load = format!(
        "[[torque]]\nkind = \"table\"\nfile = \"measured/table.csv\"\nof = \"{of}\"\n{more}"
    );
    match Folder::with(table).load(&load).torques.remove(0) {
        Load::Table(table) => table,
        other => panic!("{other}"),
    }
}

#[test]
fn tables_of_every_variable() {
    for (of, header, factor) in [
        ("theta", "theta [deg]", PI / 180.0),
        ("t", "t [ms]", 1e-3),
        ("omega", "omega [rpm]", PI / 30.0),
        ("x", "x [mm]", 1e-3),
        ("v", "v [m/s]", 1.0),
    ] {
        let table = torque_table(
            &format!("{header},torque [N mm]\n-10,500\n0,1000\n30,4000\n"),
            of,
            "interpolation = \"linear\"",
        );
        assert_eq!(Some(table.of()), Variable::named(of));
        for (at, value) in [
            (-10.0, 0.5),
            (0.0, 1.0),
            (30.0, 4.0),
            (15.0, 2.5),
            (-5.0, 0.75),
        ] {
            near(table.value(at * factor), value, 1e-14);
        }
        assert!(table.period().is_none());
        let rows = table.rows();
        near(rows[0], -10.0 * factor, 1e-15);
        near(rows[rows.len() - 1], 30.0 * factor, 1e-15);
        assert!(table.value(31.0 * factor).is_nan() && table.value(-11.0 * factor).is_nan());
    }
}

#[test]
fn tables_as_instruments_and_spreadsheets_write_them() {
    for text in [
        "theta [deg],torque [N m]\n0,1\n90,2\n180,4\n",
        "theta [deg];torque [N m]\n0;1\n90;2\n180;4\n",
        "theta [deg]\ttorque [N m]\n0\t1\n90\t2\n180\t4\n",
        "theta [deg] , torque [N m]\r\n 0 , 1 \r\n90, 2\r\n180 ,4\r\n",
        "# measured on the bench\n# one turn; falling load\ntheta [deg],torque [N m]\n0,1\n# the middle\n90,2\n\n180,4",
        "theta [deg],torque [N m]\n0,1\n  \n90,2\n180,4\n \n",
        "\u{feff}theta [deg],torque [N m]\n0,1\n90,2\n180,4\n",
        "\u{feff}# measured\ntheta [deg],torque [N m]\n0,1\n90,2\n180,4\n",
        "Theta (deg),Torque (Nm)\n0,1\n90,2\n180,4\n",
        "theta_deg,torque_N_m\n0,1\n90,2\n180,4\n",
        "theta_rad,torque_N_m\n0,1\n1.5707963267948966,2\n3.141592653589793,4\n",
        "theta / deg,torque / N m\n0,1\n90,2\n180,4\n",
        "\"theta [°]\",\"torque [N·m]\"\n\"0\",\"1\"\n90,2\n180,4\n",
        "theta [rev],torque [kN mm]\n0,1\n0.25,2\n0.5,4\n",
        "theta [deg],torque [N m]\n0,1.0e0\n9e1,+2\n180.,4\n",
    ] {
        let table = torque_table(text, "theta", "");
        for (at, value) in [(0.0, 1.0), (PI / 2.0, 2.0), (PI, 4.0)] {
            near(table.value(at), value, 1e-15);
        }
    }
}

#[test]
fn units_of_headers_with_per() {
    let table = torque_table(
        "omega_rad_per_s,torque_N_m\n0,5\n100,0\n",
        "omega",
        "interpolation = \"linear\"",
    );
    near(table.value(25.0), 3.75, 1e-15);
}

#[test]
fn a_table_repeats_with_and_without_its_last_row() {
    let open = "theta [deg],torque [N m]\n0,1\n90,2\n180,4\n270,2\n";
    let closed = format!("{open}360,1\n");
    for (text, interpolation) in [
        (open, "linear"),
        (&closed, "linear"),
        (open, "pchip"),
        (&closed, "pchip"),
    ] {
        let table = torque_table(
            text,
            "theta",
            &format!("period = \"1 rev\"\ninterpolation = \"{interpolation}\""),
        );
        near(table.period().unwrap(), 2.0 * PI, 1e-15);
        for turns in [-3.0, 0.0, 40.0] {
            for (degrees, value) in [(0.0, 1.0), (90.0, 2.0), (180.0, 4.0), (270.0, 2.0)] {
                near(
                    table.value(turns * 2.0 * PI + degrees * PI / 180.0),
                    value,
                    1e-12,
                );
            }
        }
        if interpolation == "linear" {
            near(table.value(315.0 * PI / 180.0), 1.5, 1e-14);
            near(table.value(-45.0 * PI / 180.0), 1.5, 1e-14);
        }
    }
}

#[test]
fn tables_are_interpolated_by_pchip_unless_said_otherwise() {
    // Between 1 and 2, by hand: slopes (w1 + w2)/(w1/1 + w2/3) with w1 = w2 = 3, and 0 at the peak.
    let text = "x [m],torque [N m]\n0,0\n1,1\n2,4\n3,0\n";
    let (slope, middle) = (1.5, 1.5);
    let expected = 0.5 * (1.0 + 4.0) + slope / 8.0;
    near(torque_table(text, "x", "").value(middle), expected, 1e-15);
    near(
        torque_table(text, "x", "interpolation = \"pchip\"").value(middle),
        expected,
        1e-15,
    );
    near(
        torque_table(text, "x", "interpolation = \"linear\"").value(middle),
        2.5,
        1e-15,
    );
}

#[test]
fn a_table_over_time_repeats_after_a_time() {
    let table = torque_table(
        "t [ms],torque [N m]\n0,1\n5,3\n",
        "t",
        "period = \"10 ms\"\ninterpolation = \"linear\"",
    );
    for (t, value) in [(0.0025, 2.0), (0.0075, 2.0), (1.005, 3.0)] {
        near(table.value(t), value, 1e-12);
    }
}

#[test]
fn a_force_table_has_the_unit_of_a_force() {
    let folder = Folder::with("x [mm],force [kN]\n0,0\n200,-2\n");
    let scene = folder.load("[[force]]\nkind = \"table\"\nfile = \"measured/table.csv\"\nof = \"x\"\ninterpolation = \"linear\"");
    near(single(&scene.forces[0], true, &now()), -1200.0, 1e-15);
    assert_eq!(scene.forces[0].reads(true).to_string(), "x");
}

#[test]
fn gas_pushes_towards_the_crank() {
    let folder = Folder::with("theta [deg],pressure [bar]\n0,10\n90,6\n180,1\n270,3\n360,10\n");
    let gas = "[[force]]\nkind = \"gas\"\nfile = \"measured/table.csv\"\nbore = \"80 mm\"\nperiod = \"360 deg\"\n";
    let area = PI * 0.08 * 0.08 / 4.0;
    let instant = Instant {
        theta: 2.5 * PI,
        ..Instant::default()
    };
    let force = |text: &str| single(&folder.load(text).forces[0], true, &instant);
    near(
        force(&format!("{gas}ambient = \"1 bar\"")),
        -5e5 * area,
        1e-12,
    );
    near(force(&format!("{gas}ambient = 0")), -6e5 * area, 1e-12);
    near(force(gas), -(6e5 - 101_325.0) * area, 1e-12);
    let left = format!("branch = \"left\"\n{gas}ambient = \"1 bar\"");
    near(force(&left), 5e5 * area, 1e-12);
}

#[test]
fn paths_are_relative_to_the_scene_file_or_absolute() {
    let folder = Folder::with("theta [deg],torque [N m]\n0,1\n90,2\n");
    for path in [
        "measured/table.csv".to_owned(),
        "./measured/../measured/table.csv".to_owned(),
        folder
            .0
            .path()
            .join("measured/table.csv")
            .to_str()
            .expect("a plain path")
            .to_owned(),
    ] {
        let scene = folder.load(&format!(
            "[[torque]]\nkind = \"table\"\nfile = '{path}'\nof = \"theta\""
        ));
        assert_eq!(scene.torques.len(), 1);
    }
}

// Loads in order

#[test]
fn loads_keep_their_order_and_number() {
    let scene = with(
        &(1..=5)
            .map(|n| format!("[[torque]]\nkind = \"constant\"\nvalue = \"{n} N m\"\n"))
            .collect::<String>(),
    );
    let values: Vec<f64> = scene
        .torques
        .iter()
        .map(|load| single(load, false, &now()))
        .collect();
    assert_eq!(values, [1.0, 2.0, 3.0, 4.0, 5.0]);
}

// The schema

fn properties(section: &Value) -> &Value {
    let table = if section["type"] == "array" {
        &section["items"]
    } else {
        section
    };
    &table["properties"]
}

fn words(key: &Value) -> Vec<String> {
    let list = key["enum"]
        .as_array()
        .map(Vec::as_slice)
        .unwrap_or_default();
    list.iter()
        .map(|word| word.as_str().expect("a word").to_owned())
        .collect()
}

/// Returns the sections and keys that a scene may have, as documented.
fn documented() -> BTreeMap<&'static str, BTreeSet<&'static str>> {
    [
        ("geometry", "crank rod offset branch"),
        (
            "crank",
            "mass cg cg_lateral inertia density length width depth",
        ),
        (
            "rod",
            "model mass cg cg_lateral inertia inertia_about density length width depth",
        ),
        ("slider", "mass density length width depth"),
        ("gravity", "acceleration direction"),
        (
            "torque",
            "kind value coefficient stall no_load_speed file of period interpolation",
        ),
        (
            "force",
            "kind value coefficient stiffness rest file of period interpolation bore ambient",
        ),
        ("friction", "coefficient static_coefficient"),
        (
            "clearance",
            "joint radial bearing_radius young_modulus poisson_ratio restitution friction contact_law \
             friction_threshold least_approach_speed eccentricity eccentricity_angle",
        ),
        ("motion", "kind angle speed"),
        ("run", "duration revolutions output_every tolerance"),
    ]
    .into_iter()
    .map(|(section, keys)| (section, keys.split_whitespace().collect()))
    .collect()
}

#[test]
fn the_schema_lists_every_key() {
    let schema = schema();
    let listed: BTreeMap<&str, BTreeSet<&str>> = schema["properties"]
        .as_object()
        .expect("sections")
        .iter()
        .filter(|(name, _)| *name != "title")
        .map(|(name, section)| {
            let keys = properties(section).as_object().expect("keys");
            (name.as_str(), keys.keys().map(String::as_str).collect())
        })
        .collect();
    assert_eq!(listed, documented());
    assert_eq!(schema["required"], serde_json::json!(["geometry"]));
    assert_eq!(schema["properties"]["title"]["type"], "string");
}

/// Returns one `key = value` line for each spelling of a key in the schema.
fn lines(key: &str, value: &Value) -> Vec<String> {
    let mut texts = words(value);
    let examples = value["examples"]
        .as_array()
        .map(Vec::as_slice)
        .unwrap_or_default();
    texts.extend(
        examples
            .iter()
            .map(|text| text.as_str().expect("a text").to_owned()),
    );
    if key == "file" {
        texts.push("bad/tables/torque.csv".to_owned());
    }
    let mut lines: Vec<String> = texts
        .iter()
        .map(|text| format!("{key} = \"{text}\""))
        .collect();
    if value["type"] == "number" {
        lines.push(format!("{key} = 0.05"));
    }
    lines
}

#[test]
fn the_reader_knows_every_key_and_value_of_the_schema() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/schema.toml");
    for (name, section) in schema()["properties"].as_object().expect("sections") {
        if name == "title" {
            continue;
        }
        let header = if section["type"] == "array" {
            format!("[[{name}]]")
        } else {
            format!("[{name}]")
        };
        for (key, value) in properties(section).as_object().expect("keys") {
            assert!(
                value["description"]
                    .as_str()
                    .is_some_and(|text| !text.is_empty()),
                "{name}.{key}"
            );
            let lines = lines(key, value);
            assert!(!lines.is_empty(), "{name}.{key} has no example");
            for line in lines {
                let geometry = if name == "geometry" { "" } else { GEOMETRY };
                let Err(problems) = Scene::parse(&file, &format!("{geometry}{header}\n{line}\n"))
                else {
                    continue;
                };
                // Other keys may be missing, but this key and its value are right.
                for problem in problems.list() {
                    assert!(
                        problem.what.contains("missing") || problem.what.contains("no `"),
                        "{line}: {problems}"
                    );
                }
            }
        }
    }
}

#[test]
fn the_schema_requires_what_the_reader_requires() {
    for (name, section) in schema()["properties"].as_object().expect("sections") {
        let table = if section["type"] == "array" {
            &section["items"]
        } else {
            section
        };
        let required = table["required"]
            .as_array()
            .map(Vec::as_slice)
            .unwrap_or_default();
        let header = if section["type"] == "array" {
            format!("[[{name}]]")
        } else {
            format!("[{name}]")
        };
        let geometry = if name == "geometry" { "" } else { GEOMETRY };
        if name == "title" {
            continue;
        }
        let missing: BTreeSet<String> =
            match Scene::parse(Path::new("empty.toml"), &format!("{geometry}{header}\n")) {
                Ok(_) => BTreeSet::new(),
                Err(problems) => problems
                    .list()
                    .iter()
                    .map(|p| p.field.rsplit('.').next().unwrap_or_default().to_owned())
                    .collect(),
            };
        // A slider needs its mass or the four numbers of a box, which the schema leaves to the reader.
        let required: BTreeSet<String> = match name.as_str() {
            "slider" => BTreeSet::from(["mass".to_owned()]),
            _ => required
                .iter()
                .map(|key| key.as_str().expect("a key").to_owned())
                .collect(),
        };
        assert_eq!(missing, required, "{name}");
    }
}

#[test]
fn the_schema_requires_the_keys_of_each_kind_of_load() {
    for name in ["torque", "force"] {
        let schema = schema();
        let rules = schema["properties"][name]["items"]["allOf"]
            .as_array()
            .expect("rules")
            .clone();
        let kinds = words(&properties(&schema["properties"][name])["kind"]);
        assert_eq!(rules.len(), kinds.len());
        for rule in rules {
            let kind = rule["if"]["properties"]["kind"]["const"]
                .as_str()
                .expect("a kind")
                .to_owned();
            assert!(kinds.contains(&kind));
            let text = format!("{GEOMETRY}[[{name}]]\nkind = \"{kind}\"\n");
            let problems =
                Scene::parse(Path::new("test.toml"), &text).expect_err("an incomplete load");
            let missing: BTreeSet<&str> = problems
                .list()
                .iter()
                .filter_map(|p| p.field.rsplit('.').next())
                .collect();
            // A magnitude is a value or a table: the schema names the first alternative.
            let ways = rule["then"]["anyOf"][0]["required"].as_array();
            let required: BTreeSet<&str> = rule["then"]["required"]
                .as_array()
                .or(ways)
                .expect("keys")
                .iter()
                .filter_map(Value::as_str)
                .collect();
            assert_eq!(missing, required, "{kind}");
        }
    }
}

#[test]
fn the_schema_requires_the_speed_of_a_constant_speed() {
    let rules = &schema()["properties"]["motion"]["allOf"];
    let rule = rules
        .as_array()
        .expect("rules")
        .iter()
        .find(|rule| rule["if"]["properties"]["kind"]["const"] == "constant-speed")
        .expect("a rule");
    assert_eq!(rule["if"]["required"], serde_json::json!(["kind"]));
    assert_eq!(rule["then"]["required"], serde_json::json!(["speed"]));
}
