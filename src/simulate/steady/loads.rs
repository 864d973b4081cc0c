//! Work of each load over the periodic motion, by adaptive Gauss quadrature over the crank angle.

use std::f64::consts::TAU;

use super::super::guide_friction::GuideFriction;
use super::cycles::CycleRun;
use super::result::{Estimated, LoadWork};
use super::{MARGIN, Verified};
use crate::mechanism::{Equation, Limits, Linkage, single};
use crate::numeric::angle::{self, Angle};
use crate::numeric::gauss;
use crate::scene::{Load, Scene};

/// Computes the work of each load of a scene and of friction at the guide.
pub(super) fn works(scene: &Scene, verified: &Verified) -> Vec<LoadWork> {
    let [found, check] = [&verified.found.cycle, &verified.check.cycle];
    let relative_error = verified.relative_error;
    let linkage = &Linkage::new(&scene.geometry);
    let mut works = Vec::new();
    let mut add = |name: String, load: Option<&Load>, torque: &Torque<'_>| {
        let cuts = cuts(load, linkage, found);
        let work = work(&cuts, torque, relative_error, found);
        let error = MARGIN * (work - self::work(&cuts, torque, relative_error, check)).abs()
            + 4.0 * relative_error * size(&cuts, torque, found);
        let over = |span: f64| Estimated {
            value: work / span,
            error: error / span.abs(),
        };
        works.push(LoadWork {
            name,
            power_w: over(found.period),
            torque_nm: over(found.speed.signum() * found.rotation()),
        });
    };
    for of in scene.loads() {
        let torque = |angle: Angle, omega: f64| {
            let pose = linkage.pose(angle.rest);
            let arm = if of.key.on_slider { pose.dx } else { 1.0 };
            arm * single(of.load, of.key.on_slider, &pose.instant(0.0, angle, omega))
        };
        let name = format!("{}: {}", of.key, of.load);
        add(name, Some(of.load), &torque);
    }
    let equation = Equation::new(scene);
    if let Some(guide) = GuideFriction::new(scene, &equation) {
        // Any time but the start, at which the guide takes its sign from ahead.
        let torque = |angle: Angle, omega: f64| {
            let (_, touch) = guide.state(f64::MIN_POSITIVE, angle, omega);
            touch.friction * linkage.pose(angle.rest).dx
        };
        add("friction at the guide".to_owned(), None, &torque);
    }
    works
}

/// Crank torque (N m) as a function of crank angle and speed (rad/s).
type Torque<'a> = dyn Fn(Angle, f64) -> f64 + 'a;

/// Lists the rotations (rad) at the corners of a load, at the dead centres of a period and at equal parts of each turn.
fn cuts(load: Option<&Load>, linkage: &Linkage, found: &CycleRun) -> Vec<f64> {
    let sense = found.speed.signum();
    let begin = found.start.radians();
    let end = begin + sense * found.rotation();
    let turned = |theta: f64| sense * (theta - begin);
    let corners = load.map(|load| load.corners_between(begin.min(end), begin.max(end)));
    let corners = corners.into_iter().flatten();
    let mut cuts: Vec<f64> = corners.map(turned).collect();
    let dead_centres = Limits::new(linkage, found.speed).dead_centres;
    let dead_centres = dead_centres
        .iter()
        .map(|dc| turned(dc.theta).rem_euclid(TAU));
    // Of a turn: adaptive quadrature may miss a narrow part of a formula between its first nodes.
    let parts = 16u32;
    let of_turn = (0..parts).map(|i| f64::from(i) / f64::from(parts) * TAU);
    let of_turn: Vec<f64> = dead_centres.chain(of_turn).collect();
    cuts.extend(angle::in_turns(&of_turn, 0..found.turns.into()));
    cuts.push(found.rotation());
    cuts.sort_by(f64::total_cmp);
    cuts
}

/// Computes the work over a period, J, resolved as far as the uncertainty of the speeds, a part `relative`, allows.
fn work(cuts: &[f64], torque: &Torque<'_>, relative: f64, found: &CycleRun) -> f64 {
    let sense = found.speed.signum();
    let force = |turned: f64| sense * torque(found.angle(turned), found.omega(turned));
    let piece = |ends: &[f64]| {
        let [from, to] = [ends[0], ends[1]];
        let open = |turned: f64| {
            let (angle, speed) = (found.angle(turned), found.omega(turned));
            (torque(angle, speed * (1.0 + relative)) - torque(angle, speed)).abs()
        };
        // A load may be steep on a part of the piece only.
        let open = open(from).min(open(0.5 * (from + to))).min(open(to));
        let tolerance = (1e-15 * found.largest_kinetic).max(open * (to - from));
        gauss::adaptive(&force, ends, tolerance)
    };
    cuts.windows(2).map(piece).sum()
}

/// Computes the integral of the absolute torque, J, the scale of the rounding of the work.
fn size(cuts: &[f64], torque: &Torque<'_>, found: &CycleRun) -> f64 {
    let size = |turned: f64| torque(found.angle(turned), found.omega(turned)).abs();
    let pieces = cuts.windows(2);
    pieces
        .map(|ends| gauss::composite(size, ends[0], ends[1], 1))
        .sum()
}
