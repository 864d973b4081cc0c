//! The work of each load over the periodic motion.

use std::f64::consts::TAU;

use super::super::error_estimate::MARGIN;
use super::super::guide_friction::Sliding;
use super::periodic_orbit::Found;
use super::result::{Estimated, LoadWork};
use crate::mechanism::{Equation, Limits, Linkage, single};
use crate::numeric::angle::Angle;
use crate::numeric::gauss;
use crate::scene::{Instant, Load, Scene};

/// Pieces of a turn beside those that dead centres and tables make.
const PIECES: u32 = 16;

/// Each load of a scene, and friction at its guide.
pub(super) fn works(scene: &Scene, found: &Found, check: &Found, relative: f64) -> Vec<LoadWork> {
    let linkage = Linkage::new(&scene.geometry);
    let linkage = &linkage;
    let mut works = Vec::new();
    let mut add = |name: String, corners: &dyn Fn(f64, f64) -> Vec<f64>, torque: &Torque<'_>| {
        let (work, size) = work(linkage, corners, torque, found);
        let (other, _) = self::work(linkage, corners, torque, check);
        let error = MARGIN * (work - other).abs() + 4.0 * relative * size;
        let over = |span: f64| Estimated {
            value: work / span,
            error: error / span.abs(),
        };
        works.push(LoadWork {
            name,
            power_w: over(found.period),
            torque_nm: over(found.speed.signum() * found.way()),
        });
    };
    let lists = [("torque", &scene.torques), ("force", &scene.forces)];
    for (list, loads) in lists {
        for (i, load) in loads.iter().enumerate() {
            let name = format!("{list}[{}]: {load}", i + 1);
            let corners = |low: f64, high: f64| load.corners_between(low, high);
            let on_slider = list == "force";
            let torque =
                |angle: Angle, omega: f64| crank_torque(linkage, load, on_slider, angle, omega);
            add(name, &corners, &torque);
        }
    }
    let equation = Equation::new(scene);
    if let Some(sliding) = Sliding::new(scene, &equation) {
        // Not at the start of a motion, where the guide is what it will be.
        let force =
            |angle: Angle, omega: f64| sliding.state(f64::MIN_POSITIVE, angle, omega).1.friction;
        let torque = |angle: Angle, omega: f64| force(angle, omega) * linkage.pose(angle.rest).dx;
        add(
            "friction at the guide".to_owned(),
            &|_, _| Vec::new(),
            &torque,
        );
    }
    works
}

/// Crank torque (N m) at an angle and a speed (rad/s).
type Torque<'a> = dyn Fn(Angle, f64) -> f64 + 'a;

/// The crank torque that a load amounts to, N m.
fn crank_torque(linkage: &Linkage, load: &Load, on_slider: bool, angle: Angle, omega: f64) -> f64 {
    let pose = linkage.pose(angle.rest);
    let now = Instant {
        t: 0.0,
        theta: angle.radians(),
        omega,
        x: pose.x,
        v: pose.dx * omega,
    };
    let arm = if on_slider { pose.dx } else { 1.0 };
    arm * single(load, on_slider, &now)
}

/// Powers put in and taken out.
pub(super) fn powers(loads: &[LoadWork]) -> (Estimated, Estimated) {
    let sum = |sign: f64| {
        let powers = loads.iter().map(|load| load.power_w);
        let none = Estimated {
            value: 0.0,
            error: 0.0,
        };
        powers.fold(none, |sum, power| Estimated {
            value: sum.value + (sign * power.value).max(0.0),
            error: sum.error + power.error,
        })
    };
    (sum(1.0), sum(-1.0))
}

/// Work over a period, J, and the size of what adds up to it; `corners` between two angles, rad.
fn work(
    linkage: &Linkage,
    corners: &dyn Fn(f64, f64) -> Vec<f64>,
    torque: &Torque<'_>,
    found: &Found,
) -> (f64, f64) {
    let sense = found.speed.signum();
    let torque =
        |turned: f64| sense * torque(found.start.plus(sense * turned), found.omega(turned));
    let limits = Limits::new(linkage, found.speed);
    let begin = found.start.radians();
    let (low, high) = (
        begin.min(begin + sense * found.way()),
        begin.max(begin + sense * found.way()),
    );
    let turned = |theta: f64| sense * (theta - begin);
    let dead_centres = limits.dead_centres.iter();
    let dead_centres = dead_centres.map(|dc| turned(dc.theta).rem_euclid(TAU));
    let rows = corners(low, high).into_iter().map(turned);
    let turns = found.turns as u32;
    let even =
        |turn: u32| (0..PIECES).map(move |i| f64::from(turn) + f64::from(i) / f64::from(PIECES));
    let whole = (0..turns).flat_map(|turn| {
        dead_centres
            .clone()
            .map(move |ahead| f64::from(turn) * TAU + ahead)
    });
    let parts = (0..turns).flat_map(even).map(|turns| turns * TAU);
    let mut cuts: Vec<f64> = whole
        .chain(rows)
        .chain(parts)
        .chain([found.way()])
        .collect();
    cuts.sort_by(f64::total_cmp);
    let tolerance = 1e-15 * found.largest;
    let integral = |f: &dyn Fn(f64) -> f64, tolerance: f64| -> f64 {
        let pieces = cuts.windows(2);
        pieces
            .map(|w| gauss::adaptive(f, w[0], w[1], tolerance))
            .sum()
    };
    let size = integral(&|turned| torque(turned).abs(), f64::INFINITY);
    (integral(&torque, tolerance), size)
}
