//! Every command runs with the built-in scene and with a scene file.

use serde_json::Value;

use super::program::{Folder, at, close, driven, free, has_keys, repository};

const WITH_A_SCENE: [&str; 4] = ["simulate", "kinematics", "explain", "check"];

/// Removes the measured times, which alone differ between two runs of one scene.
fn without_times(mut object: Value) -> Value {
    object.as_object_mut().expect("an object").remove("wall_s");
    object
        .as_object_mut()
        .expect("an object")
        .remove("evaluation_ns");
    if let Some(Value::Object(cost)) = object.get_mut("estimate_cost") {
        cost.remove("wall_s");
    }
    object
}

#[test]
fn every_command_has_a_built_in_scene_the_engine_of_duarte() {
    let folder = Folder::new();
    for command in WITH_A_SCENE {
        let shown = folder.run(&[command]).done().stdout;
        assert!(
            shown.contains("Duarte 2018 Diesel engine, free spin"),
            "{command}: {shown}"
        );
    }
    assert_eq!(
        folder.names(),
        [""; 0],
        "no command writes a file that was not asked for"
    );
}

#[test]
fn the_built_in_scene_is_the_one_in_data() {
    let folder = Folder::new();
    let file = repository("data/duarte-engine.toml");
    let file = file.to_str().expect("a plain path");
    for command in ["simulate", "kinematics", "explain"] {
        let built_in = folder.run(&[command, "--json"]).done().json();
        let read = folder.run(&[command, file, "--json"]).done().json();
        assert_eq!(without_times(built_in), without_times(read), "{command}");
    }
}

#[test]
fn every_command_serves_a_scene_file() {
    let title = "title = \"A pump\"\n";
    let folder = Folder::with(&format!("{title}{}", free("duration = \"0.1 s\"")));
    for command in WITH_A_SCENE {
        let shown = folder.run(&[command, "scene.toml"]).done().stdout;
        assert!(shown.contains("A pump"), "{command}: {shown}");
    }
}

#[test]
fn every_scene_in_data_is_simulated() {
    let folder = Folder::new();
    let entries = std::fs::read_dir(repository("data")).expect("data");
    let files = entries.map(|entry| entry.expect("an entry of data").path());
    let scenes = files.filter(|file| file.extension().is_some_and(|e| e == "toml"));
    let mut simulated = 0;
    for scene in scenes {
        let scene = scene.to_str().expect("a plain path");
        folder.run(&["check", scene]).done();
        folder.run(&["kinematics", scene]).done();
        let summary = folder.run(&["simulate", scene, "--json"]).done().json();
        assert!(at(&summary, "energy_residual").abs() < 1e-6, "{scene}");
        simulated += 1;
    }
    assert!(simulated > 10, "{simulated}");
}

#[test]
fn schema_is_a_json_schema() {
    let folder = Folder::new();
    let schema = folder.run(&["schema"]).done().json();
    assert_eq!(
        schema["$schema"],
        "https://json-schema.org/draft/2020-12/schema"
    );
    assert_eq!(schema["type"], "object");
    let sections = [
        "title",
        "geometry",
        "crank",
        "rod",
        "slider",
        "gravity",
        "torque",
        "force",
        "friction",
        "clearance",
        "motion",
        "run",
    ];
    has_keys(&schema["properties"], &sections);
}

/// r = 50 mm, l = 130 mm, crank straight up: sin φ = 5/13, x' = −r, x'' = r tan φ = r·5/12. Hence M = J + m r², ½ M' =
/// m x' x'', and a force F contributes −F r to Q.
#[test]
fn explain_gives_every_term_at_an_angle() {
    let folder = Folder::with(
        r#"
        [geometry]
        crank = "50 mm"
        rod = "130 mm"
        [crank]
        mass = "2 kg"
        cg = "10 mm"
        inertia = "0.02 kg m^2"
        [slider]
        mass = "0.6 kg"
        [gravity]
        acceleration = "10 m/s^2"
        direction = "180 deg"
        [[torque]]
        kind = "constant"
        value = "2 N m"
        [[force]]
        kind = "constant"
        value = "-100 N"
        [motion]
        speed = "30 rad/s"
        "#,
    );
    let explained = folder
        .run(&["explain", "scene.toml", "--json", "--at", "90 deg"])
        .done()
        .json();
    let terms = &explained["at"];
    let exact =
        |key: &str, expected: f64| close(at(terms, key), expected, 1e-15 + 1e-15 * expected.abs());
    let slope = 0.05 * 5.0 / 12.0;
    let inertia = 0.02 + 0.6 * 0.05 * 0.05;
    let half_slope = 0.6 * -0.05 * slope;
    // Gravity along −x: V = 2·10·0.01 cos θ + 0.6·10·x.
    let weight = -0.2 - 6.0 * 0.05;
    exact("theta_rad", std::f64::consts::FRAC_PI_2);
    exact("omega_rad_per_s", 30.0);
    exact("x_m", 0.12);
    exact("dx_m_per_rad", -0.05);
    exact("m_kg_m2", inertia);
    exact("half_dm_kg_m2_per_rad", half_slope);
    exact("dv_nm", weight);
    exact("q_nm", 2.0 + 5.0);
    let alpha = (7.0 - weight - half_slope * 900.0) / inertia;
    close(at(terms, "alpha_rad_per_s2"), alpha, 1e-13 * alpha);
    close(
        at(terms, "holding_torque_nm"),
        half_slope * 900.0 + weight - 7.0,
        1e-14,
    );
    let loads = terms["loads"].as_array().expect("loads");
    let parts: Vec<_> = loads
        .iter()
        .map(|load| (at(load, "value"), at(load, "q_nm")))
        .collect();
    assert_eq!(parts, [(2.0, 2.0), (-100.0, 5.0)]);

    let text = folder
        .run(&["explain", "scene.toml", "--at", "90 deg"])
        .done()
        .stdout;
    for name in [
        "at theta = 90 deg",
        "M ",
        "1/2 M'",
        "V'",
        "x'",
        "Q of torque[1]",
        "Q of force[1]",
        "theta..",
    ] {
        assert!(text.contains(name), "no {name} in {text}");
    }
}

#[test]
fn explain_says_what_is_modelled_what_is_left_out_and_what_computes_it() {
    let more =
        "[gravity]\nacceleration = 0\n[[torque]]\nkind = \"expression\"\nvalue = \"sin(t)\"\n";
    let folder = Folder::with(&format!("{}{more}", free("duration = \"1 s\"")));
    let time = ["explain", "scene.toml", "--method", "time"];
    let explained = folder.run(&[&time[..], &["--json"]].concat()).done().json();
    has_keys(
        &explained,
        &["scene", "plan", "equation", "conventions", "at"],
    );
    assert!(explained["at"].is_null(), "no angle was asked for");
    let plan = &explained["plan"];
    assert_eq!(plan["engine"], "time");
    let state = plan["state"].as_array().expect("a list");
    assert_eq!(state[..2], ["theta", "omega"]);
    let named = |list: &str| -> Vec<(String, String)> {
        let text = |value: &Value| value.as_str().expect("a text").to_owned();
        let terms = plan[list].as_array().expect("terms");
        terms
            .iter()
            .map(|term| (text(&term["name"]), text(&term["reason"])))
            .collect()
    };
    let kept: Vec<_> = named("kept").into_iter().map(|(name, _)| name).collect();
    assert_eq!(kept, ["crank inertia", "slider inertia", "torque[1]"]);
    let left_out = named("left_out");
    let reason = |name: &str| {
        let term = left_out.iter().find(|(other, _)| other == name);
        term.unwrap_or_else(|| panic!("{name} is not left out: {left_out:?}"))
            .1
            .clone()
    };
    assert_eq!(reason("gravity"), "its strength is zero");
    for name in [
        "connecting rod inertia",
        "force",
        "Coulomb friction",
        "joint clearance",
    ] {
        assert_eq!(reason(name), "not in the scene");
    }
    let text = folder.run(&time).done().stdout;
    for part in [
        "M theta.. + 1/2 M' theta.^2 + V' = Q",
        "counter-clockwise",
        "gravity",
        "its strength is zero",
        "sin(t)",
        "engine",
    ] {
        assert!(text.contains(part), "no {part} in {text}");
    }
}

#[test]
fn simulate_follows_the_plan_that_explain_shows() {
    let load = "[[force]]\nkind = \"viscous\"\ncoefficient = \"3 N s/m\"\n";
    let run = "duration = \"0.1 s\"";
    for scene in [free(run), driven(run), format!("{}{load}", free(run))] {
        let folder = Folder::with(&scene);
        for method in [&[][..], &["--method", "dopri5"]] {
            let show = |command| {
                let arguments = [&[command, "scene.toml", "--json"], method].concat();
                folder.run(&arguments)
            };
            let (explained, simulated) = (show("explain"), show("simulate"));
            assert_eq!(explained.code, simulated.code, "{scene}");
            if explained.code == Some(0) {
                assert_eq!(
                    explained.json()["plan"],
                    simulated.json()["plan"],
                    "{scene}"
                );
            }
        }
    }
}

#[test]
fn a_prescribed_motion_has_no_state() {
    let folder = Folder::with(&driven("duration = \"1 s\""));
    let explained = folder
        .run(&["explain", "scene.toml", "--json"])
        .done()
        .json();
    assert_eq!(explained["plan"]["engine"], "closed-form");
    assert_eq!(explained["plan"]["state"], Value::Array(Vec::new()));
}
