//! `kinematics`: columns, rows and keys, checked against the geometry.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use super::program::{Folder, PUMP, ROCKER, Rows, at, close, has_keys, keys, rocker_limit};

const POSITION: &str =
    "theta_rad,x_m,dx_m_per_rad,d2x_m_per_rad2,phi_rad,dphi,d2phi,transmission_rad";
const RATES: &str = "v_m_per_s,a_m_per_s2,rod_omega_rad_per_s,rod_alpha_rad_per_s2";

/// Returns a folder with Gupta's mechanism: r = 140 mm, l = 310 mm, e = 60 mm.
fn gupta(geometry: &str, motion: &str) -> Folder {
    Folder::with(&format!(
        "[geometry]\ncrank = \"140 mm\"\nrod = \"310 mm\"\n{geometry}\n[motion]\n{motion}\n"
    ))
}

#[test]
fn columns_without_and_with_a_speed() {
    let (_, rows) = Folder::with(PUMP).kinematics(&[]);
    assert_eq!(rows.header, POSITION);
    for kind in ["free", "constant-speed"] {
        let motion = format!("kind = \"{kind}\"\nspeed = \"-20 rad/s\"");
        let (_, rows) = gupta("", &motion).kinematics(&[]);
        assert_eq!(rows.header, format!("{POSITION},{RATES}"));
    }
}

#[test]
fn rows_go_from_0_to_360_degrees_inclusive() {
    let folder = Folder::with(PUMP);
    for (every, step, count) in [
        ("1 deg", 1.0, 361),
        ("0.5 deg", 0.5, 721),
        ("0.1 deg", 0.1, 3601),
        ("0.25 rev", 90.0, 5),
        ("7 deg", 7.0, 53),
        ("400 deg", 400.0, 2),
    ] {
        let (_, rows) = folder.kinematics(&["--every", every]);
        assert_eq!(rows.len(), count, "{every}");
        let theta = rows.column("theta_rad");
        assert_eq!((theta[0], theta[count - 1]), (0.0, TAU), "{every}");
        for (i, theta) in theta[..count - 1].iter().enumerate() {
            close(*theta, (i as f64 * step).to_radians(), 1e-14);
        }
    }
    let (_, by_default) = folder.kinematics(&[]);
    assert_eq!(by_default.len(), 361);
    assert!(by_default.complete());
}

#[test]
fn the_built_in_scene_has_rows_too() {
    let folder = Folder::new();
    folder.run(&["kinematics", "--out", "rows.csv"]).done();
    let rows = Rows::read(&folder.read("rows.csv"));
    assert_eq!(
        (rows.header.clone(), rows.len()),
        (format!("{POSITION},{RATES}"), 361)
    );
}

#[test]
fn the_summary_has_every_key() {
    for folder in [
        Folder::with(PUMP),
        gupta("offset = \"60 mm\"", "speed = \"300 rpm\""),
        Folder::with(ROCKER),
    ] {
        let summary = folder
            .run(&["kinematics", "scene.toml", "--json"])
            .done()
            .json();
        let expected = [
            "class",
            "stroke_m",
            "dead_centres",
            "advance_rad",
            "return_rad",
            "time_ratio",
            "transmission_min_rad",
            "acceleration_max",
            "acceleration_min",
        ];
        has_keys(&summary, &expected);
        for dead_centre in summary["dead_centres"].as_array().expect("a list") {
            has_keys(dead_centre, &["theta_rad", "x_m"]);
        }
        for extreme in ["acceleration_max", "acceleration_min"] {
            let extreme = &summary[extreme];
            assert!(
                extreme.is_null()
                    || keys(extreme) == ["theta_rad", "value"]
                    || keys(extreme) == ["value", "theta_rad"]
            );
        }
    }
}

/// In-line mechanism: x = r ± l at the dead centres, and the rod is most inclined when the crank is upright.
#[test]
fn figures_of_a_mechanism_in_line() {
    let summary = Folder::with(PUMP).kinematics(&[]).0;
    assert_eq!(summary["class"], "rotating-crank");
    for (path, expected) in [
        ("stroke_m", 0.1),
        ("advance_rad", PI),
        ("return_rad", PI),
        ("time_ratio", 1.0),
        ("transmission_min_rad", (1.0f64 / 3.0).acos()),
        // At θ = 0, x'' has its minimum −(r + r²/l); without a speed the value is per radian.
        ("acceleration_min.value", -(0.05 + 0.05 * 0.05 / 0.15)),
        ("acceleration_min.theta_rad", 0.0),
    ] {
        close(at(&summary, path), expected, 1e-15 * 8.0);
    }
    let centres = summary["dead_centres"].as_array().expect("a list");
    assert_eq!(centres.len(), 2);
    for (centre, [theta, x]) in centres.iter().zip([[0.0, 0.2], [PI, 0.1]]) {
        close(at(centre, "theta_rad"), theta, 1e-15);
        close(at(centre, "x_m"), x, 1e-16);
    }
}

/// At the dead centres O, A and P lie on one line, which meets the guide at depth e: the outer dead centre is l + r
/// away from O, the inner one l − r.
#[test]
fn figures_of_an_offset_mechanism() {
    let (outer, inner) = ((0.06f64 / 0.45).asin(), (0.06f64 / 0.17).asin());
    let stroke =
        (0.45f64.powi(2) - 0.06f64.powi(2)).sqrt() - (0.17f64.powi(2) - 0.06f64.powi(2)).sqrt();
    let rising = PI + inner - outer;
    // x grows during the outward stroke; reversing the rotation exchanges the strokes.
    for (speed, outward) in [
        ("300 rpm", rising),
        ("-300 rpm", TAU - rising),
        ("0 rpm", rising),
    ] {
        let summary = gupta("offset = \"60 mm\"", &format!("speed = \"{speed}\""))
            .kinematics(&[])
            .0;
        for (path, expected) in [
            ("stroke_m", stroke),
            ("advance_rad", outward),
            ("return_rad", TAU - outward),
            ("time_ratio", outward / (TAU - outward)),
            ("transmission_min_rad", (0.2f64 / 0.31).acos()),
        ] {
            close(at(&summary, path), expected, 1e-14);
        }
        let centres = summary["dead_centres"].as_array().expect("a list");
        let angles: Vec<_> = centres
            .iter()
            .map(|centre| at(centre, "theta_rad"))
            .collect();
        assert_eq!(angles.len(), 2);
        close(angles[0], PI - inner, 1e-14);
        close(angles[1], TAU - outer, 1e-14);
    }
}

#[test]
fn the_outward_stroke_is_where_the_rows_say_so() {
    for geometry in [
        "offset = \"60 mm\"",
        "offset = \"-60 mm\"",
        "offset = \"60 mm\"\nbranch = \"left\"",
    ] {
        for speed in ["10 rad/s", "-10 rad/s"] {
            let folder = gupta(geometry, &format!("speed = \"{speed}\""));
            let (summary, rows) = folder.kinematics(&["--every", "0.1 deg"]);
            let sign = if geometry.contains("left") { -1.0 } else { 1.0 };
            // Away from the crank pivot: |x| grows.
            let v = rows.column("v_m_per_s");
            let outward = v[1..].iter().filter(|v| sign * **v > 0.0).count();
            close(
                at(&summary, "advance_rad"),
                (outward as f64 * 0.1).to_radians(),
                0.2f64.to_radians(),
            );
        }
    }
}

/// The loop closes in every row, and each derivative is the slope of its quantity.
#[test]
fn columns_hold_what_they_are_named_after() {
    for (geometry, e, s) in [
        ("offset = \"60 mm\"", 0.06, 1.0),
        ("offset = \"-60 mm\"\nbranch = \"left\"", -0.06, -1.0),
    ] {
        let (_, rows) =
            gupta(geometry, "speed = \"-20 rad/s\"").kinematics(&["--every", "0.1 deg"]);
        let column = |name: &str| rows.column(name);
        let (r, l, omega) = (0.14, 0.31, -20.0);
        let (theta, x, phi) = (column("theta_rad"), column("x_m"), column("phi_rad"));
        let (dx, d2x) = (column("dx_m_per_rad"), column("d2x_m_per_rad2"));
        let (dphi, d2phi) = (column("dphi"), column("d2phi"));
        let (v, a) = (column("v_m_per_s"), column("a_m_per_s2"));
        let (rod_omega, rod_alpha) = (
            column("rod_omega_rad_per_s"),
            column("rod_alpha_rad_per_s2"),
        );
        let transmission = column("transmission_rad");
        for i in 0..rows.len() {
            close(l * phi[i].sin(), e + r * theta[i].sin(), 1e-15);
            close(x[i], r * theta[i].cos() + s * l * phi[i].cos(), 1e-15);
            close(transmission[i], FRAC_PI_2 - phi[i].abs(), 1e-15);
            close(v[i], dx[i] * omega, 1e-14);
            close(a[i], d2x[i] * omega * omega, 1e-12);
            // The rod turns counter-clockwise: P moves relative to A with rod_omega × (P − A).
            let across = -e - r * theta[i].sin();
            close(
                v[i] + r * omega * theta[i].sin(),
                -rod_omega[i] * across,
                1e-13,
            );
            close(
                -r * omega * theta[i].cos(),
                rod_omega[i] * (x[i] - r * theta[i].cos()),
                1e-13,
            );
            close(rod_alpha[i].abs(), (d2phi[i] * omega * omega).abs(), 1e-11);
        }
        let step = theta[1] - theta[0];
        for i in 1..rows.len() - 2 {
            let slope = |column: &[f64]| (column[i + 1] - column[i - 1]) / (2.0 * step);
            close(slope(&x), dx[i], 1e-6);
            close(slope(&dx), d2x[i], 1e-6);
            close(slope(&phi), dphi[i], 1e-5);
            close(slope(&dphi), d2phi[i], 1e-5);
            close(slope(&rod_omega) * omega, rod_alpha[i], 1e-2);
        }
    }
}

#[test]
fn extremes_are_the_extremes_of_the_rows() {
    for speed in ["0 rad/s", "31.416 rad/s", "-31.416 rad/s"] {
        let folder = gupta("offset = \"60 mm\"", &format!("speed = \"{speed}\""));
        let (summary, rows) = folder.kinematics(&["--every", "0.02 deg"]);
        let (velocity, acceleration) = match speed {
            "0 rad/s" => ("dx_m_per_rad", "d2x_m_per_rad2"),
            _ => ("v_m_per_s", "a_m_per_s2"),
        };
        let theta = rows.column("theta_rad");
        for (name, column, sign) in [
            ("velocity_max", velocity, 1.0),
            ("velocity_min", velocity, -1.0),
            ("acceleration_max", acceleration, 1.0),
            ("acceleration_min", acceleration, -1.0),
        ] {
            let column = rows.column(column);
            let best = (0..column.len())
                .max_by(|i, j| (sign * column[*i]).total_cmp(&(sign * column[*j])));
            let best = best.expect("rows");
            let found = at(&summary[name], "value");
            close(found, column[best], 1e-6 * found.abs());
            assert!(
                sign * found >= sign * column[best] - 1e-13 * found.abs(),
                "{name} at {speed}"
            );
            close(
                at(&summary[name], "theta_rad"),
                theta[best],
                0.02f64.to_radians(),
            );
        }
    }
}

/// A rocker has rows where the rod reaches the guide; elsewhere the cells are empty.
#[test]
fn angles_out_of_reach_have_empty_cells() {
    let (summary, rows) = Folder::with(ROCKER).kinematics(&[]);
    assert_eq!(rows.len(), 361);
    assert_eq!(summary["class"], "double-rocker");
    for key in [
        "advance_rad",
        "return_rad",
        "time_ratio",
        "acceleration_max",
        "acceleration_min",
    ] {
        assert!(summary[key].is_null(), "{key}: {}", summary[key]);
    }
    let (x, v) = (rows.cells_of("x_m"), rows.cells_of("dx_m_per_rad"));
    for (i, theta) in rows.column("theta_rad").into_iter().enumerate() {
        let reached = 0.05 * theta.sin() < 0.04;
        assert_eq!(
            (x[i].is_some(), v[i].is_some()),
            (reached, reached),
            "{} deg",
            theta.to_degrees()
        );
    }
    let reach = &summary["reach_rad"][0];
    let [from, to] = [&reach[0], &reach[1]].map(|angle| angle.as_f64().expect("an angle"));
    close(from, PI - rocker_limit(), 1e-14);
    close(to, TAU + rocker_limit(), 1e-14);
    assert!(!summary["warnings"].as_array().expect("a list").is_empty());
}

#[test]
fn the_summary_for_people_says_the_same() {
    let shown = gupta("offset = \"60 mm\"", "")
        .run(&["kinematics", "scene.toml"])
        .done()
        .stdout;
    for name in [
        "class",
        "rotating-crank",
        "stroke",
        "outer dead centre",
        "inner dead centre",
        "outward stroke",
        "inward stroke",
        "time ratio",
        "least transmission",
        "largest acceleration",
        "smallest acceleration",
    ] {
        assert!(shown.contains(name), "no {name} in {shown}");
    }
}

#[test]
fn a_length_is_changed_once() {
    let folder = Folder::new();
    let twice = [
        "kinematics",
        "--change",
        "offset=1 mm",
        "--change",
        "offset=2 mm",
    ];
    folder.run(&twice).fails(2, &["offset is given twice"]);
    let both = [
        "kinematics",
        "--change",
        "offset=1 mm",
        "--change",
        "rod=150 mm",
    ];
    folder.run(&both).done();
}
