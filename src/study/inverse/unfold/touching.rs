//! Motions that come to rest just at a fold: one that goes back and one that passes show the same there, and both are smooth
//! but for a jump of the acceleration.

use super::super::sensor::Sensor;
use super::evidence::{ENOUGH, Evidence, fitted, over};
use super::refined::{itself, refined};
use super::window::{AT_FOLD, Window};
use crate::numeric::orthogonal::Expansion;

/// Whether a motion that goes back, as a fit has it, is told from one that comes to rest just at the fold. The angle off the fold
/// is a square then, and its root a polynomial with a zero there.
pub(super) fn stays_off(window: &Window, sensor: &Sensor<'_>, back: &Expansion<f64>) -> bool {
    let most = back.squares.len().saturating_sub(1);
    let side = window.back.iter().sum::<f64>().signum();
    let (roots, weights) = roots(window);
    // The root of an angle of even degree is odd, and may need one degree more.
    let rough = fitted(&window.t, &over(&roots, &weights), &weights, most + 1);
    let touching = refined(window, sensor, &rough, |root| {
        (side * root * root, 2.0 * side * root)
    });
    let back = refined(window, sensor, back, itself);
    Evidence::between(&touching, &back, window.t.len()).passes > ENOUGH
}

/// The roots of the angles off the fold, negative before it, and their weights. Noise may have moved the turning point: the zero is
/// in the middle of the blocks at the fold, which tell the root to be small, but not its sign.
fn roots(window: &Window) -> (Vec<f64>, Vec<f64>) {
    let count = window.t.len();
    let zero = usize::midpoint(window.clear[0], count - window.clear[1]);
    let root = |k: usize| {
        let (angle, error) = (window.back[k].abs(), window.error[k]);
        if angle < AT_FOLD * error {
            return (0.0, 1.0 / (AT_FOLD * error).sqrt());
        }
        let sign = if k < zero { -1.0 } else { 1.0 };
        (sign * angle.sqrt(), 2.0 * angle.sqrt() / error)
    };
    (0..count).map(root).unzip()
}
