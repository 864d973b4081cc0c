//! The work of each load over the periodic motion.

use std::f64::consts::TAU;

use serde::Serialize;

use super::Estimated;
use super::found::{Found, MARGIN};
use crate::mechanism::{Limits, Linkage, single};
use crate::numeric::gauss;
use crate::scene::{Instant, Load, Scene};

/// Pieces of a turn beside those that dead centres and tables make.
const PIECES: u32 = 16;

/// One load over a period.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LoadWork {
    /// As `torque[1]`, with what it is.
    pub name: String,
    /// Mean over time of the power it puts in, W.
    pub power_w: Estimated,
    /// Mean over the crank angle of the crank torque that it amounts to, N m.
    pub torque_nm: Estimated,
}

/// Each load of a scene.
pub(super) fn works(scene: &Scene, found: &Found, check: &Found, relative: f64) -> Vec<LoadWork> {
    let lists = [("torque", &scene.torques), ("force", &scene.forces)];
    let mut works = Vec::new();
    for (name, list) in lists {
        for (i, load) in list.iter().enumerate() {
            let on_slider = name == "force";
            let (work, size) = work(scene, load, on_slider, found);
            let (other, _) = self::work(scene, load, on_slider, check);
            let error = MARGIN * (work - other).abs() + 4.0 * relative * size;
            let over = |span: f64| Estimated {
                value: work / span,
                error: error / span.abs(),
            };
            works.push(LoadWork {
                name: format!("{name}[{}]: {load}", i + 1),
                power_w: over(found.period),
                torque_nm: over(found.speed.signum() * found.way()),
            });
        }
    }
    works
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

/// Work over a period, J, and the size of what adds up to it.
fn work(scene: &Scene, load: &Load, on_slider: bool, found: &Found) -> (f64, f64) {
    let linkage = Linkage::new(&scene.geometry);
    let sense = found.speed.signum();
    let torque = |turned: f64| {
        let angle = found.start.plus(sense * turned);
        let (pose, theta) = (linkage.pose(angle.rest), angle.radians());
        let omega = found.omega(turned);
        let now = Instant {
            t: 0.0,
            theta,
            omega,
            x: pose.x,
            v: pose.dx * omega,
        };
        let arm = if on_slider { pose.dx } else { 1.0 };
        sense * arm * single(load, on_slider, &now)
    };
    let limits = Limits::new(&linkage, found.speed);
    let begin = found.start.radians();
    let (low, high) = (
        begin.min(begin + sense * found.way()),
        begin.max(begin + sense * found.way()),
    );
    let turned = |theta: f64| sense * (theta - begin);
    let dead_centres = limits.dead_centres.iter();
    let dead_centres = dead_centres.map(|dc| turned(dc.theta).rem_euclid(TAU));
    let rows = load.corners_between(low, high).into_iter().map(turned);
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
