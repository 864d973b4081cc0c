//! The work of each load over the periodic motion.

use std::f64::consts::TAU;

use super::super::guide_friction::Sliding;
use super::periodic_orbit::Found;
use super::result::{Estimated, LoadWork};
use super::{Both, MARGIN};
use crate::mechanism::{Equation, Limits, Linkage, single};
use crate::numeric::angle::Angle;
use crate::numeric::gauss;
use crate::scene::{Instant, Load, Scene};

/// Pieces of a turn beside those that dead centres and tables make.
const PIECES: u32 = 16;

/// Each load of a scene, and friction at its guide.
pub(super) fn works(scene: &Scene, both: &Both) -> Vec<LoadWork> {
    let Both { found, check, .. } = both;
    let linkage = Linkage::new(&scene.geometry);
    let linkage = &linkage;
    let mut works = Vec::new();
    let mut add = |name: String, load: Option<&Load>, torque: &Torque<'_>| {
        let (work, size) = work(linkage, load, torque, found);
        let (other, _) = self::work(linkage, load, torque, check);
        let error = MARGIN * (work - other).abs() + 4.0 * both.relative * size;
        let over = |span: f64| Estimated {
            value: work / span,
            error: error / span.abs(),
        };
        works.push(LoadWork {
            name,
            power_w: over(found.cycle.period),
            torque_nm: over(found.cycle.speed.signum() * found.way()),
        });
    };
    for (list, loads) in [("torque", &scene.torques), ("force", &scene.forces)] {
        for (i, load) in loads.iter().enumerate() {
            let on_slider = list == "force";
            let torque =
                |angle: Angle, omega: f64| crank_torque(linkage, load, on_slider, angle, omega);
            add(format!("{list}[{}]: {load}", i + 1), Some(load), &torque);
        }
    }
    let equation = Equation::new(scene);
    if let Some(sliding) = Sliding::new(scene, &equation) {
        // Not at the start of a motion, where the guide is what it will be.
        let force =
            |angle: Angle, omega: f64| sliding.state(f64::MIN_POSITIVE, angle, omega).1.friction;
        let torque = |angle: Angle, omega: f64| force(angle, omega) * linkage.pose(angle.rest).dx;
        add("friction at the guide".to_owned(), None, &torque);
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

/// Work over a period, J, and the size of what adds up to it.
fn work(linkage: &Linkage, load: Option<&Load>, torque: &Torque<'_>, found: &Found) -> (f64, f64) {
    let sense = found.cycle.speed.signum();
    let torque =
        |turned: f64| sense * torque(found.start.plus(sense * turned), found.omega(turned));
    let begin = found.start.radians();
    let end = begin + sense * found.way();
    let turned = |theta: f64| sense * (theta - begin);
    let mut cuts: Vec<f64> = load
        .map(|load| load.corners_between(begin.min(end), begin.max(end)))
        .unwrap_or_default()
        .into_iter()
        .map(turned)
        .collect();
    let dead_centres = Limits::new(linkage, found.cycle.speed).dead_centres;
    for turn in 0..found.turns as u32 {
        let before = f64::from(turn) * TAU;
        let ahead = |theta: f64| before + turned(theta).rem_euclid(TAU);
        cuts.extend(dead_centres.iter().map(|dc| ahead(dc.theta)));
        let part = |i: u32| before + f64::from(i) / f64::from(PIECES) * TAU;
        cuts.extend((0..PIECES).map(part));
    }
    cuts.push(found.way());
    cuts.sort_by(f64::total_cmp);
    let integral = |f: &dyn Fn(f64) -> f64, tolerance: f64| -> f64 {
        let pieces = cuts.windows(2);
        pieces
            .map(|w| gauss::adaptive(f, w[0], w[1], tolerance))
            .sum()
    };
    let size = integral(&|turned| torque(turned).abs(), f64::INFINITY);
    (integral(&torque, 1e-15 * found.cycle.largest), size)
}
