//! Which of several motions that fit the samples alike begins like the scene.

use super::anchors::in_turn;
use super::search::Path;
use crate::scene::Motion;

/// The motion that is taken.
#[derive(Debug)]
pub(super) struct Start {
    pub path: Path,
    /// How it was chosen.
    pub reason: &'static str,
    /// Whether angle and speed of the scene belong to different motions.
    pub contradicted: bool,
}

/// The scene's angle belongs to a motion that begins this near to it, rad...
const NEAR: f64 = 0.1;

/// ... if each other one begins beyond this many times as far from it.
const FARTHER: f64 = 4.0;

/// Sums of squares within this factor do not decide: the mirror image of a smooth motion is smooth as well, if less so
/// where the direction of the wrist pin from the pivot changes fast.
const ALIKE: f64 = 1e4;

const BY_ANGLE: &str = "the one that begins at the scene's angle is taken";
const BY_NEARER_ANGLE: &str = "the one that begins nearer to the scene's angle is taken";
const BY_SPEED: &str = "the one that begins with the sense of the scene's speed is taken";
const BY_NOTHING: &str =
    "the one that begins counter-clockwise is taken, as the scene has neither speed nor angle";

/// Chooses among motions with their sums of squares, the `first` angle of each being right to `blur`, rad.
///
/// A motion may begin slowly and reverse at once, so an angle of the scene that is plainly that of one motion counts
/// before the speed. Angle 0 does not, because scenes that say nothing have it.
pub(super) fn choose(
    mut paths: Vec<(f64, Path)>,
    start: &Motion,
    blur: f64,
    first: impl Fn(&[f64]) -> f64,
) -> Option<Start> {
    paths.sort_by(|a, b| a.0.total_cmp(&b.0));
    let least = paths.first()?.0;
    paths.retain(|(cost, _)| *cost <= ALIKE * least + 1e-6);
    let off = |i: usize| (in_turn(first(&paths[i].1.theta), start.angle) - start.angle).abs();
    let mut by_angle: Vec<usize> = (0..paths.len()).collect();
    by_angle.sort_by(|a, b| off(*a).total_cmp(&off(*b)));
    let nearest = by_angle[0];
    let next = by_angle.get(1).map_or(f64::INFINITY, |i| off(*i));
    let plain = off(nearest) <= NEAR && next > FARTHER * NEAR + blur;
    let sign = if start.speed < 0.0 { -1.0 } else { 1.0 };
    let agrees = |(_, path): &(f64, Path)| sign * first_motion(&path.theta) >= 0.0;
    let by_speed = paths.iter().position(agrees).unwrap_or(0);
    let (taken, reason) = match (start.angle != 0.0, start.speed != 0.0) {
        (true, false) => (nearest, BY_NEARER_ANGLE),
        (true, true) if plain => (nearest, BY_ANGLE),
        (_, true) => (by_speed, BY_SPEED),
        (false, false) => (by_speed, BY_NOTHING),
    };
    let contradicted = start.speed != 0.0 && plain && !agrees(&paths[nearest]);
    let (_, path) = paths.swap_remove(taken);
    Some(Start {
        path,
        reason,
        contradicted,
    })
}

/// The first step that is not small against the largest.
fn first_motion(theta: &[f64]) -> f64 {
    let steps: Vec<f64> = theta.windows(2).map(|w| w[1] - w[0]).collect();
    let largest = steps.iter().fold(0.0f64, |m, s| m.max(s.abs()));
    steps
        .into_iter()
        .find(|s| s.abs() > 0.2 * largest)
        .unwrap_or(0.0)
}
