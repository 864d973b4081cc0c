//! Rows of `simulate`: columns, number, ends and values.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use super::program::{
    Folder, PENDULUM, Rows, WAYS, at, close, driven, free, free_ways, keys, same,
};

const MOTION: &str =
    "t_s,theta_rad,omega_rad_per_s,alpha_rad_per_s2,x_m,v_m_per_s,a_m_per_s2,phi_rad";
const REACTIONS: &str = "crank_bearing_x_n,crank_bearing_y_n,crank_pin_x_n,crank_pin_y_n,\
    wrist_pin_x_n,wrist_pin_y_n,guide_n,shaking_x_n,shaking_y_n,shaking_moment_nm";
const TORQUE: &str = "crank_torque_nm";

#[test]
fn columns_are_those_that_are_asked_for() {
    for way in WAYS {
        for (options, header) in [
            (&[][..], MOTION.to_owned()),
            (&["--reactions"], format!("{MOTION},{REACTIONS}")),
            (&["--torque"], format!("{MOTION},{TORQUE}")),
            (
                &["--torque", "--reactions"],
                format!("{MOTION},{REACTIONS},{TORQUE}"),
            ),
        ] {
            let (_, rows) = way.simulated_at("10 rad/s", "duration = \"0.1 s\"", options);
            assert_eq!(rows.header, header, "{way:?}");
            assert!(rows.complete(), "{way:?}");
        }
    }
}

#[test]
fn the_built_in_scene_gives_500_rows() {
    let folder = Folder::new();
    folder.run(&["simulate", "--out", "rows.csv"]).done();
    let rows = Rows::read(&folder.read("rows.csv"));
    assert_eq!((rows.header.as_str(), rows.len()), (MOTION, 500));
    assert!(rows.complete());
    close(rows.column("omega_rad_per_s")[0], 100.0, 1e-13);
}

#[test]
fn a_run_has_500_rows_unless_said_otherwise() {
    for way in WAYS {
        for run in [
            "duration = \"1 s\"",
            "revolutions = 3",
            "revolutions = 0.01",
        ] {
            assert_eq!(way.simulated(run).1.len(), 500, "{run}: {way:?}");
        }
    }
}

/// A crank at rest passes no output angles, but has its first and its last row.
#[test]
fn a_crank_at_rest_has_rows_at_both_ends() {
    let scene = driven("duration = \"1 s\"\noutput_every = \"1 deg\"");
    let folder = Folder::with(&scene.replace("10 rad/s", "0 rad/s"));
    let (_, rows) = folder.simulated(&[]);
    assert_eq!(rows.column("t_s"), [0.0, 1.0]);
}

#[test]
fn rows_are_due_at_multiples_of_the_time_step_and_at_both_ends() {
    for way in WAYS {
        let times = |step: &str| {
            let run = format!("duration = \"1 s\"\noutput_every = \"{step}\"");
            way.simulated(&run).1.column("t_s")
        };
        let every_millisecond = times("1 ms");
        assert_eq!(every_millisecond.len(), 1001, "{way:?}");
        for (i, t) in every_millisecond.into_iter().enumerate() {
            close(t, i as f64 / 1000.0, 1e-15);
        }
        let uneven = times("0.3 s");
        assert_eq!(
            (uneven.len(), uneven[0], uneven[4]),
            (5, 0.0, 1.0),
            "{way:?}"
        );
        assert_eq!(times("5 s"), [0.0, 1.0], "{way:?}");
    }
}

#[test]
fn rows_are_due_at_multiples_of_the_angle_step_and_at_both_ends() {
    for way in WAYS {
        for (speed, sense) in [("10 rad/s", 1.0), ("-10 rad/s", -1.0)] {
            for start in [0.0f64, 10.0, -123.4] {
                let motion = format!("{speed}\"\nangle = \"{start} deg");
                let run = "revolutions = 3\noutput_every = \"1 deg\"";
                let (_, rows) = way.simulated_at(&motion, run, &[]);
                assert_eq!(rows.len(), 1081, "{speed} from {start} deg: {way:?}");
                for (i, theta) in rows.column("theta_rad").into_iter().enumerate() {
                    close(theta, (start + sense * i as f64).to_radians(), 1e-11);
                }
            }
        }
    }
}

#[test]
fn no_two_rows_have_the_same_time() {
    for way in WAYS {
        for run in [
            "duration = \"1 s\"",
            "duration = \"0.3 s\"\noutput_every = \"0.1 s\"",
            "duration = \"1 s\"\noutput_every = \"1 deg\"",
            "revolutions = 3",
            "revolutions = 2\noutput_every = \"5 deg\"",
            "revolutions = 2\noutput_every = \"1 ms\"",
        ] {
            let times = way.simulated(run).1.column("t_s");
            for pair in times.windows(2) {
                assert!(pair[1] - pair[0] > 1e-9, "{pair:?} in {run}: {way:?}");
            }
        }
    }
}

/// The motion reverses at multiples of the angle step, and starts at one.
#[test]
fn turning_back_gives_one_row() {
    let run = "[run]\nduration = \"2 s\"\noutput_every = \"10 deg\"\n";
    let folder = Folder::with(&format!("{PENDULUM}{run}"));
    for method in ["auto", "time"] {
        let (_, rows) = folder.simulated(&["--method", method]);
        let times = rows.column("t_s");
        for pair in times.windows(2) {
            assert!(pair[1] - pair[0] > 1e-6, "{pair:?} with method {method}");
        }
        for theta in &rows.column("theta_rad")[..rows.len() - 1] {
            let steps = (theta.to_degrees() + 30.0) / 10.0;
            close(steps, steps.round(), 1e-6);
        }
    }
}

#[test]
fn three_turns_end_at_three_turns() {
    for way in WAYS {
        for (speed, sense) in [("10 rad/s", 1.0), ("-10 rad/s", -1.0)] {
            let (summary, rows) = way.simulated_at(speed, "revolutions = 3", &[]);
            close(at(&summary, "revolutions"), sense * 3.0, 3e-15);
            close(at(&summary, "final.theta_rad"), sense * 3.0 * TAU, 1e-14);
            close(
                rows.column("theta_rad")[rows.len() - 1],
                sense * 3.0 * TAU,
                1e-14,
            );
        }
    }
}

#[test]
fn a_negative_speed_turns_clockwise() {
    for way in WAYS {
        let (summary, rows) = way.simulated_at("-10 rad/s", "duration = \"1 s\"", &[]);
        assert!(
            rows.column("theta_rad")
                .windows(2)
                .all(|pair| pair[1] < pair[0])
        );
        assert!(
            rows.column("omega_rad_per_s")
                .iter()
                .all(|omega| *omega < 0.0)
        );
        assert!(at(&summary, "revolutions") < -1.5, "{way:?}");
        // For a guide through the pivot both senses of rotation are mirror images, to the tolerance.
        let (forward, _) = way.simulated("duration = \"1 s\"");
        close(
            at(&summary, "final.theta_rad"),
            -at(&forward, "final.theta_rad"),
            1e-9,
        );
        close(at(&summary, "omega_max"), -at(&forward, "omega_min"), 1e-9);
    }
}

#[test]
fn a_run_of_no_length_is_one_row() {
    for way in WAYS {
        for run in [
            "duration = \"0 s\"",
            "duration = 0\noutput_every = \"1 ms\"",
            "revolutions = 0",
        ] {
            let (summary, rows) = way.simulated(run);
            assert_eq!(rows.len(), 1, "{run}: {way:?}");
            for path in ["final.t_s", "final.theta_rad", "revolutions"] {
                assert_eq!(at(&summary, path), 0.0, "{path} in {run}: {way:?}");
            }
            for path in ["final.omega_rad_per_s", "omega_min", "omega_max"] {
                close(at(&summary, path), 10.0, 1e-14);
            }
        }
    }
}

#[test]
fn the_last_row_is_the_final_state() {
    for way in WAYS {
        for run in [
            "duration = \"0.77 s\"",
            "revolutions = 1.5",
            "duration = \"0.77 s\"\noutput_every = \"7 deg\"",
        ] {
            let (summary, rows) = way.simulated(run);
            for key in ["t_s", "theta_rad", "omega_rad_per_s"] {
                let last = rows.column(key)[rows.len() - 1];
                same(last, at(&summary["final"], key));
            }
        }
    }
}

/// Returns slider position, velocity and acceleration, and rod inclination of the pump (r = 50 mm, l = 150 mm).
fn pose(theta: f64, omega: f64, alpha: f64) -> [f64; 4] {
    let (r, l) = (0.05, 0.15);
    let sin_phi = r * theta.sin() / l;
    let phi = sin_phi.asin();
    let phi1 = r * theta.cos() / (l * phi.cos());
    let phi2 = (-r * theta.sin() / l + sin_phi * phi1 * phi1) / phi.cos();
    let dx = -r * theta.sin() - l * sin_phi * phi1;
    let d2x = -r * theta.cos() - l * (phi.cos() * phi1 * phi1 + sin_phi * phi2);
    [
        r * theta.cos() + l * phi.cos(),
        dx * omega,
        dx * alpha + d2x * omega * omega,
        phi,
    ]
}

/// Without load, M θ̈ + ½ M' θ̇² = 0 states that the power of the force m a at velocity v and the power of the flywheel
/// cancel: J ω α + m v a = 0.
#[test]
fn columns_hold_what_they_are_named_after() {
    for way in free_ways() {
        let (_, rows) = way.simulated("duration = \"1 s\"");
        let column = |name: &str| rows.column(name);
        let (theta, omega) = (column("theta_rad"), column("omega_rad_per_s"));
        let alpha = column("alpha_rad_per_s2");
        let (x, phi) = (column("x_m"), column("phi_rad"));
        let (v, a) = (column("v_m_per_s"), column("a_m_per_s2"));
        for i in 0..rows.len() {
            let expected = pose(theta[i], omega[i], alpha[i]);
            for (found, expected) in [x[i], v[i], a[i], phi[i]].into_iter().zip(expected) {
                close(found, expected, 1e-13);
            }
            close(0.02 * omega[i] * alpha[i] + 0.5 * v[i] * a[i], 0.0, 1e-12);
        }
    }
}

/// The massless rod is a two-force member; slider and flywheel are each in balance.
#[test]
fn reactions_are_the_forces_on_each_body() {
    let (_, rows) =
        Folder::with(&driven("duration = \"1 s\"")).simulated(&["--reactions", "--torque"]);
    let column = |name: &str| rows.column(name);
    let (theta, a, phi) = (column("theta_rad"), column("a_m_per_s2"), column("phi_rad"));
    let (bearing_x, bearing_y) = (column("crank_bearing_x_n"), column("crank_bearing_y_n"));
    let (pin_x, pin_y) = (column("crank_pin_x_n"), column("crank_pin_y_n"));
    let (wrist_x, wrist_y) = (column("wrist_pin_x_n"), column("wrist_pin_y_n"));
    let (guide, torque) = (column("guide_n"), column("crank_torque_nm"));
    let (shaking_x, shaking_y) = (column("shaking_x_n"), column("shaking_y_n"));
    for i in 0..rows.len() {
        let push = 0.5 * a[i];
        let lift = -push * phi[i].tan();
        for (found, expected) in [
            (wrist_x[i], push),
            (wrist_y[i], lift),
            (guide[i], -lift),
            (pin_x[i], push),
            (pin_y[i], lift),
            (bearing_x[i], push),
            (bearing_y[i], lift),
            (shaking_x[i], -push),
            (shaking_y[i], 0.0),
            // The crank pin is at r (cos θ, sin θ).
            (
                torque[i],
                0.05 * (theta[i].cos() * lift - theta[i].sin() * push),
            ),
        ] {
            close(found, expected, 1e-13);
        }
    }
}

/// Newton's second law for each body, at constant speed without gravity: the centre of gravity of the crank circles O,
/// that of the rod interpolates the accelerations of A and P.
#[test]
fn each_joint_is_in_its_own_columns() {
    let scene = driven("duration = \"1 s\"")
        .replace("[crank]\n", "[crank]\nmass = \"2 kg\"\ncg = \"20 mm\"\n")
        .replace(
            "[slider]\n",
            "[rod]\nmass = \"1 kg\"\ncg = \"60 mm\"\ninertia = \"0.003 kg m^2\"\n[slider]\n",
        );
    let (_, rows) = Folder::with(&scene).simulated(&["--reactions"]);
    let column = |name: &str| rows.column(name);
    let pair = |name: &str| {
        [
            column(&format!("{name}_x_n")),
            column(&format!("{name}_y_n")),
        ]
    };
    let [bearing, pin, wrist] = ["crank_bearing", "crank_pin", "wrist_pin"].map(pair);
    let (theta, a, guide) = (column("theta_rad"), column("a_m_per_s2"), column("guide_n"));
    for i in 0..rows.len() {
        let inwards = [-100.0 * theta[i].cos(), -100.0 * theta[i].sin()];
        let slider = [a[i], 0.0];
        for k in 0..2 {
            close(bearing[k][i] - pin[k][i], 2.0 * 0.02 * inwards[k], 1e-12);
            let rod = (1.0 - 0.4) * 0.05 * inwards[k] + 0.4 * slider[k];
            close(pin[k][i] - wrist[k][i], rod, 1e-12);
        }
        close(wrist[0][i], 0.5 * a[i], 1e-12);
        close(wrist[1][i] + guide[i], 0.0, 1e-12);
    }
}

/// About O the crank has the angular momentum m k² ω, and the slider m e v on its line y = −e.
#[test]
fn the_shaking_moment_is_minus_the_rate_of_change_of_angular_momentum() {
    let scene = free("duration = \"1 s\"").replace("[crank]", "offset = \"20 mm\"\n\n[crank]");
    let (_, rows) = Folder::with(&scene).simulated(&["--reactions"]);
    let column = |name: &str| rows.column(name);
    let (alpha, a, moment) = (
        column("alpha_rad_per_s2"),
        column("a_m_per_s2"),
        column("shaking_moment_nm"),
    );
    for i in 0..rows.len() {
        close(moment[i], -(0.02 * alpha[i] + 0.5 * 0.02 * a[i]), 1e-13);
    }
}

#[test]
fn driving_torque_has_a_range_a_mean_and_a_column() {
    let scene = driven("revolutions = 2\noutput_every = \"1 deg\"");
    let load = "[[torque]]\nkind = \"constant\"\nvalue = \"-3 N m\"\n";
    let (summary, rows) = Folder::with(&format!("{scene}{load}")).simulated(&["--torque"]);
    let range = &summary["driving_torque"];
    let mut expected = keys(range);
    expected.sort();
    assert_eq!(expected, ["max_nm", "mean_nm", "min_nm"]);
    let torque = rows.column("crank_torque_nm");
    let (low, high) = torque
        .iter()
        .fold((f64::MAX, f64::MIN), |(a, b), t| (a.min(*t), b.max(*t)));
    // Rows at every degree miss an extreme by at most half a degree, that is by 4e-5 of the amplitude.
    close(at(range, "min_nm"), low, 1e-4 * (high - low));
    close(at(range, "max_nm"), high, 1e-4 * (high - low));
    // Over whole turns the inertia does no work: the mean is that of the load.
    close(at(range, "mean_nm"), 3.0, 1e-12);
    for (theta, torque) in rows.column("theta_rad").into_iter().zip(torque) {
        let [_, v, a, _] = pose(theta, 10.0, 0.0);
        close(torque, 3.0 + 0.5 * v * a / 10.0, 1e-13);
    }
    let (summary, _) = Folder::with(&free("duration = \"1 s\"")).simulated(&[]);
    assert!(
        summary.get("driving_torque").is_none(),
        "the crank of a free motion is not driven"
    );
}

#[test]
fn tables_of_loads_are_found_beside_the_scene() {
    let load = "[[torque]]\nkind = \"table\"\nfile = \"torque.csv\"\nof = \"t\"\n";
    let scene = format!("{}{load}", free("duration = \"1 s\""));
    let table = "t [s],torque [N m]\n0,2\n1,2\n";
    let folder = Folder::new();
    std::fs::create_dir(folder.path("scenes")).expect("a folder");
    folder.write("scenes/scene.toml", &scene);
    folder.write("scenes/torque.csv", table);
    let beside = folder
        .run(&["simulate", "scenes/scene.toml", "--json"])
        .done()
        .json();
    // The tables of a scene on standard input are relative to the current folder.
    let torque = "torque.csv";
    folder
        .run_with_input(&["simulate", "-", "--json"], &scene)
        .fails(2, &[torque]);
    folder.write(torque, table);
    let here = folder
        .run_with_input(&["simulate", "-", "--json"], &scene)
        .done()
        .json();
    assert_eq!(beside["final"], here["final"]);
    assert!(
        at(&beside, "final.omega_rad_per_s") > 50.0,
        "2 N m on 0.02 kg m² for a second"
    );
}

#[test]
fn angles_between_turns_are_unwrapped() {
    let scene = driven("revolutions = 2\noutput_every = \"90 deg\"")
        .replace("[run]", "angle = \"90 deg\"\n[run]");
    let (_, rows) = Folder::with(&scene).simulated(&[]);
    for (i, theta) in rows.column("theta_rad").into_iter().enumerate() {
        close(theta, FRAC_PI_2 + i as f64 * FRAC_PI_2, 1e-14);
    }
    close(rows.column("theta_rad")[8], 4.5 * PI, 1e-14);
}
