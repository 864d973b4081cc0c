//! Printed results: stroke times, time ratio, torques by offset, and the comparison of table 3.

use std::f64::consts::{PI, TAU};

use super::super::entry::{Claim, about, number, without_data, worded};
use super::printed::{Printed, existing_acceleration};
use super::{CRANK, CRANK_MASS, ROD_MASS, SLIDER_MASS, SPEED, engine};
use crate::error::Error;
use crate::kinematics::{ForceAnalysis, StrokeTorque, forces};
use crate::mechanism::{Extremes, Limits, Linkage};
use crate::scene::Scene;

/// Table 2: crank and rod, m, and speed, rad/s.
pub const EXPERIMENT: [f64; 2] = [0.0381, 0.1524];
pub const EXPERIMENT_SPEED: f64 = 20.994;

pub fn claims() -> Result<Vec<Claim>, Error> {
    let mut claims = strokes();
    claims.extend(torques()?);
    claims.extend(experiment());
    Ok(claims)
}

/// Last samples, ms, before the slider velocity (13) changes its sign on a grid of 1 ms.
fn sign_changes(e: f64) -> Vec<f64> {
    let velocity = |ms: i32| {
        let theta = SPEED * f64::from(ms) * 1e-3;
        let printed = Printed {
            e,
            theta,
            m2: 0.0,
            m3: 0.0,
        };
        printed.ds()
    };
    (1..30)
        .filter(|ms| velocity(*ms) * velocity(ms + 1) < 0.0)
        .map(f64::from)
        .collect()
}

fn strokes() -> Vec<Claim> {
    let limits = Limits::new(&Linkage::new(&engine(super::OFFSET).geometry), SPEED);
    let (out, back) = (
        limits.advance.unwrap_or(f64::NAN),
        limits.retreat.unwrap_or(f64::NAN),
    );
    let ratio = limits.time_ratio().unwrap_or(f64::NAN);
    let straight = Limits::new(&Linkage::new(&engine(0.0).geometry), SPEED);
    let grid = sign_changes(0.0);
    let (first, last) = (grid[0], grid[1]);
    let degrees = |ms: f64| (SPEED * ms * 1e-3).to_degrees();
    let on_grid = "e = 0 and the last sample before the velocity changes sign on a grid of 1 ms";
    let wrong_point = "the same, and the decimal point one place to the left";
    vec![
        number(
            "4.1",
            "crank speed of 2400 rev/min",
            "rad/s",
            "251",
            2400.0 * TAU / 60.0,
        ),
        number("4.2.1", "period", "s", "0.025", TAU / SPEED),
        number("table 1", "stroke", "mm", "80", limits.stroke * 1e3)
            .only_if("e = 0", straight.stroke * 1e3),
        number(
            "4.2.1",
            "crank angle of the return stroke",
            "deg",
            "172.57",
            back.to_degrees(),
        )
        .only_if(on_grid, degrees(first)),
        number(
            "4.2.1",
            "time of the return stroke",
            "s",
            "0.12",
            back / SPEED,
        )
        .only_if(wrong_point, first * 1e-2),
        number(
            "4.2.1",
            "crank angle of the forward stroke",
            "deg",
            "186.96",
            out.to_degrees(),
        )
        .only_if(on_grid, degrees(last - first)),
        number(
            "4.2.1",
            "time of the forward stroke",
            "s",
            "0.13",
            out / SPEED,
        )
        .only_if(wrong_point, (last - first) * 1e-2),
        number(
            "4.2.1",
            "end of the forward stroke",
            "deg",
            "359.53",
            (back + out).to_degrees(),
        )
        .only_if(on_grid, degrees(last)),
        number("4.2.1", "time ratio Q, (51)", "", "1.08", ratio)
            .only_if(on_grid, (last - first) / first),
    ]
}

/// Largest magnitude of a torque on a stroke.
fn largest(stroke: Option<StrokeTorque>) -> f64 {
    stroke.map_or(f64::NAN, |s| s.max.value.abs().max(s.min.value.abs()))
}

/// Largest k F_i sin theta on the inward and on the outward stroke, with the rod's centre of gravity at a
/// third of it from the crank pin: what the sentence above (48) says, with exact accelerations.
fn perpendicular(e: f64) -> [f64; 2] {
    let m2 = 2.0 / 3.0 * ROD_MASS + 0.5 * CRANK_MASS;
    let m3 = ROD_MASS / 3.0 + SLIDER_MASS;
    let linkage = Linkage::new(&engine(e).geometry);
    let mut found = [0.0f64; 2];
    for i in 0..36_000 {
        let theta = TAU * f64::from(i) / 36_000.0;
        let pose = linkage.pose(theta);
        let printed = Printed { e, theta, m2, m3 };
        let torque = CRANK * printed.inertia(pose.d2x * SPEED * SPEED) * pose.sin;
        let stroke = &mut found[usize::from(pose.dx > 0.0)];
        *stroke = stroke.max(torque.abs());
    }
    found
}

fn torques() -> Result<Vec<Claim>, Error> {
    let condition = "T = k F_i sin theta with exact accelerations and the rod's c.g. at a third from the crank pin";
    let mut claims = Vec::new();
    for (offset, back, out) in [(20.0, 250.0, 50.0), (10.0, 120.0, 50.0), (0.0, 80.0, 80.0)] {
        let result: ForceAnalysis = forces(&engine(offset * 1e-3))?;
        let assumed = perpendicular(offset * 1e-3);
        let strokes = [
            ("return", back, result.inward, assumed[0]),
            ("advance", out, result.outward, assumed[1]),
        ];
        for (stroke, printed, ours, assumed) in strokes {
            // What can be read from a figure whose axis spans some hundreds of N m.
            let tolerance = f64::max(0.06 * printed, 6.0);
            let what = format!("largest torque of the {stroke} stroke, e = {offset} mm");
            let (place, unit, ours) = ("4.3, figure 16", "N m", largest(ours));
            let claim = match (offset, stroke) {
                (20.0, "advance") => {
                    worded(place, &what, unit, "less than 50", [0.0, printed], ours)
                }
                _ => about(place, &what, unit, printed, tolerance, ours),
            };
            claims.push(claim.only_if(condition, assumed));
        }
    }
    Ok(claims)
}

/// Extreme accelerations of the mechanism of table 2, at a speed, rad/s: exact, and by (52).
fn accelerations(speed: f64) -> ([f64; 2], [f64; 2]) {
    let [k, c] = EXPERIMENT;
    let squared = speed * speed;
    let exact = Extremes::new(&Linkage::new(&Scene::new(k, c).geometry));
    let exact = exact.map_or([f64::NAN; 2], |e| {
        [
            e.acceleration_max.value * squared,
            e.acceleration_min.value * squared,
        ]
    });
    let existing =
        (0..=3600).map(|i| existing_acceleration(EXPERIMENT, speed, PI * f64::from(i) / 1800.0));
    let existing = existing.fold([f64::MIN, f64::MAX], |[most, least], a| {
        [most.max(a), least.min(a)]
    });
    (exact, existing)
}

fn experiment() -> Vec<Claim> {
    let ([exact_max, exact_min], [existing_max, existing_min]) = accelerations(EXPERIMENT_SPEED);
    let beyond = "it is beyond the extremes of the exact model, which are those of (52)";
    let unit = "m/s2";
    vec![
        number(
            "table 2",
            "crank speed of 200 rev/min",
            "rad/s",
            "20.994",
            200.0 * TAU / 60.0,
        )
        .cannot("it is 20.944; table 3 was computed with 20.994"),
        number(
            "table 3",
            "existing model, maximum acceleration",
            unit,
            "12.59",
            existing_max,
        ),
        number(
            "table 3",
            "existing model, minimum acceleration",
            unit,
            "-20.99",
            existing_min,
        ),
        number(
            "table 3",
            "this model, maximum acceleration",
            unit,
            "13.58",
            exact_max,
        )
        .cannot(beyond),
        number(
            "table 3",
            "this model, minimum acceleration",
            unit,
            "-19.98",
            exact_min,
        )
        .cannot("the exact model has the minimum of (52), at the outer dead centre"),
        without_data("table 3", "experiment, maximum acceleration", unit, "19.56"),
        without_data(
            "table 3",
            "experiment, minimum acceleration",
            unit,
            "-13.97",
        ),
        without_data("table 3", "this model, maximum error", unit, "16.24"),
        without_data("table 3", "existing model, maximum error", unit, "16.30"),
        without_data("table 3", "this model, minimum error", unit, "0.3678"),
        without_data("table 3", "existing model, minimum error", unit, "0.3715"),
    ]
}
