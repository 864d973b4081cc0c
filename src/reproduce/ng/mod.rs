//! Ng: static forces with friction, equations (1)-(11), (A1)-(A3), tables 1 and 2.

mod figures;

use super::entry::{Claim, Verdict, formula, number};
use crate::error::Error;
use crate::mechanism::{Linkage, drum_torque, friction_from_tilt};
use crate::numeric::line_fit::LineFit;
use crate::scene::{Load, Scene};
use crate::statics::{StaticAnalysis, StaticsOptions, StaticsRow, statics};

pub(super) use figures::drawings;

const CRANK: f64 = 0.025;
const ROD: f64 = 0.072;
const DRUM: f64 = 0.027;
/// m/s²
const G: f64 = 9.81;
/// As the paper computes with it.
const ROUNDED_PI: f64 = 314.0 / 100.0;

/// Table 1: weights in N and strains in 1e-6.
const CALIBRATION: [(&str, f64, f64); 6] = [
    ("2.45", 2.45, 50.0),
    ("4.91", 4.91, 95.0),
    ("7.36", 7.36, 148.0),
    ("9.81", 9.81, 190.0),
    ("12.27", 12.27, 238.0),
    ("14.72", 14.72, 290.0),
];

/// Table 2: crank angle in degrees, F and F' by theory, F' by experiment, transmission angle.
const FORCES: [(f64, &str, &str, &str, &str); 16] = [
    (10.0, "45.47", "31.13", "", "166.54"),
    (20.0, "23.33", "15.97", "", "153.18"),
    (30.0, "16.24", "11.12", "", "140.00"),
    (40.0, "12.95", "8.87", "9.22", "127.10"),
    (50.0, "11.23", "7.69", "7.65", "114.57"),
    (60.0, "10.35", "7.09", "7.26", "102.49"),
    (70.0, "10.01", "6.86", "6.87", "90.95"),
    (80.0, "10.11", "6.92", "7.06", "80.00"),
    (90.0, "10.59", "7.25", "7.46", "69.67"),
    (100.0, "11.49", "7.87", "8.04", "59.99"),
    (110.0, "12.89", "8.82", "10.20", "50.94"),
    (120.0, "14.94", "10.23", "12.16", "42.48"),
    (130.0, "17.97", "12.31", "", "34.55"),
    (140.0, "22.63", "15.49", "", "27.08"),
    (150.0, "30.42", "20.83", "", "19.97"),
    (160.0, "45.95", "31.46", "", "13.15"),
];

/// The torque as described: two weights of 0.25 kg on the circular crank.
fn described() -> f64 {
    drum_torque(0.5 * G, DRUM)
}

fn held(torque: f64) -> Result<StaticAnalysis, Error> {
    let scene = Scene::new(CRANK, ROD).torque(Load::Constant(torque));
    let friction = Some(friction_from_tilt(std::f64::consts::FRAC_PI_4));
    statics(
        &scene,
        &StaticsOptions {
            friction,
            ..StaticsOptions::default()
        },
    )
}

fn force(row: &StaticsRow) -> f64 {
    row.balance.band.map_or(f64::NAN, |band| band.value)
}

/// The edge of the band on the side of zero, (8).
fn least(row: &StaticsRow) -> f64 {
    let edge = row.balance.band.and_then(|band| band.min);
    edge.unwrap_or(f64::NAN)
}

/// Formulas as printed, at a crank angle in rad; `pi` is what half a turn counts as.
struct Printed {
    theta: f64,
    torque: f64,
}

impl Printed {
    fn phi(&self) -> f64 {
        (CRANK * self.theta.sin() / ROD).asin()
    }

    /// (6)
    fn force(&self) -> f64 {
        let x = CRANK * self.theta.cos() + ROD * self.phi().cos();
        self.torque / (self.phi().tan() * x)
    }
}

/// A row of table 2 as the spreadsheet seems to have it: twice the torque, 3.14 for pi, and the inclination
/// of the row of 120 degrees in every F'.
fn spreadsheet(degrees: f64) -> [f64; 3] {
    let at = |degrees: f64| Printed {
        theta: degrees * ROUNDED_PI / 180.0,
        torque: 2.0 * described(),
    };
    let row = at(degrees);
    let mu = (45.0 * ROUNDED_PI / 180.0).tan();
    let beta = 180.0 - (row.phi() + row.theta) * 180.0 / ROUNDED_PI;
    let frozen = 1.0 - mu * at(120.0).phi().tan();
    [row.force(), row.force() * frozen, beta]
}

pub(super) fn claims() -> Result<Vec<Claim>, Error> {
    let mut claims = equations()?;
    claims.extend(calibration());
    claims.extend(table_2()?);
    Ok(claims)
}

fn equations() -> Result<Vec<Claim>, Error> {
    let theta = 50f64.to_radians();
    let row = held(described())?.row(theta);
    let printed = Printed {
        theta,
        torque: described(),
    };
    let (pose, force_6) = (
        Linkage::new(&Scene::new(CRANK, ROD).geometry).pose(theta),
        printed.force(),
    );
    let om = printed.phi().tan() * (CRANK * theta.cos() + ROD * printed.phi().cos());
    let thrust = row.balance.side_thrust.unwrap_or(f64::NAN);
    let table = held(2.0 * described())?;
    let angle_of_least = table
        .least
        .first()
        .map_or(f64::NAN, |least| least.theta_rad);
    let at_least = table.row(angle_of_least);
    Ok(vec![
        formula(
            "(4)",
            "rod inclination at 50 deg",
            "rad",
            printed.phi(),
            pose.phi(),
        ),
        formula("(6)", "slider force at 50 deg", "N", force_6, force(&row)),
        formula(
            "(7)",
            "side thrust at 50 deg",
            "N",
            force_6 * printed.phi().tan(),
            thrust,
        ),
        formula(
            "(8)",
            "slider force with friction at 50 deg, the lower edge of the band",
            "N",
            force_6 * (1.0 - printed.phi().tan()),
            least(&row),
        ),
        formula(
            "(11)",
            "transmission angle at 50 deg",
            "rad",
            std::f64::consts::PI - printed.phi() - theta,
            row.crank_pin_angle,
        ),
        formula(
            "(A3)",
            "velocity ratio at 50 deg",
            "",
            om / CRANK,
            row.velocity_ratio,
        ),
        number(
            "part 2",
            "friction coefficient from a tilt of 45 deg, (10)",
            "",
            "1",
            friction_from_tilt(std::f64::consts::FRAC_PI_4),
        ),
        number(
            "discussion",
            "transmission angle at the least force",
            "deg",
            "90",
            at_least.crank_pin_angle.to_degrees(),
        )
        .cannot("the least force is near it, at a crank angle of 72.6 deg instead of 70.9 deg"),
    ])
}

fn calibration() -> Vec<Claim> {
    let mut claims = Vec::new();
    for (i, (text, ..)) in CALIBRATION.iter().enumerate() {
        let mass = 0.25 * (i + 1) as f64;
        let claim = number(
            "table 1",
            &format!("weight of {mass} kg, g = 9.81 m/s2"),
            "N",
            text,
            mass * G,
        );
        claims.push(if i == 4 {
            claim.only_if("g = 9.813 m/s2", mass * 9.813)
        } else {
            claim
        });
    }
    let points = CALIBRATION.map(|(_, weight, strain)| (weight, strain));
    let fit = LineFit::new(&points);
    let r_squared = fit.and_then(|fit| fit.r_squared).unwrap_or(f64::NAN);
    let about_zero = LineFit::through_origin(&points).map_or(f64::NAN, |fit| fit.1);
    claims.push(
        number(
            "figure 7",
            "R squared of the calibration",
            "",
            "0.9998",
            r_squared,
        )
        .only_if(
            "the line goes through the origin and the sum of squares is about zero",
            about_zero,
        ),
    );
    claims
}

fn table_2() -> Result<Vec<Claim>, Error> {
    let (as_described, doubled) = (held(described())?, held(2.0 * described())?);
    let assumed = "T = 264.87 N mm and pi = 3.14";
    let frozen = "T = 264.87 N mm, pi = 3.14, and phi of the row of 120 deg";
    let mut claims = Vec::new();
    for (degrees, f, with_friction, measured, beta) in FORCES {
        let theta = degrees.to_radians();
        let (row, twice) = (as_described.row(theta), doubled.row(theta));
        let sheet = spreadsheet(degrees);
        let what = |name: &str| format!("{name} at {degrees} deg");
        let place = "table 2";
        // Two of the numbers were cut off, not rounded.
        let force_claim = number(place, &what("F"), "N", f, force(&row));
        claims.push(match degrees {
            70.0 => force_claim.only_if_cut(assumed, sheet[0]),
            _ => force_claim.only_if(assumed, sheet[0]),
        });
        claims.push(
            number(
                place,
                &what("F' by theory"),
                "N",
                with_friction,
                least(&row),
            )
            .only_if(frozen, sheet[1]),
        );
        if !measured.is_empty() {
            claims.push(
                number(
                    place,
                    &what("F' by experiment, beside (8) with T = 264.87 N mm"),
                    "N",
                    measured,
                    least(&twice),
                )
                .cannot("it is measured"),
            );
        }
        let angle = number(
            place,
            &what("transmission angle"),
            "deg",
            beta,
            row.crank_pin_angle.to_degrees(),
        );
        claims.push(match degrees {
            60.0 => angle.only_if_cut("pi = 3.14", sheet[2]),
            10.0..=50.0 | 80.0 => angle.expect(Verdict::Reproduces),
            _ => angle.only_if("pi = 3.14", sheet[2]),
        });
    }
    Ok(claims)
}
