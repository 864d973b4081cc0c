//! Motions that come to rest just at a fold: one that goes back and one that passes show the same there, and both are smooth
//! but for a jump of the acceleration.

use super::evidence::{ENOUGH, Misfit, fitted, least, misfits, over};
use super::window::Window;
use crate::numeric::orthogonal::Expansion;

/// Whether a motion that goes back, as a fit has it, is told from one that comes to rest just at the fold. The angle off the fold
/// is a square then, and its root a polynomial with a zero there.
pub(super) fn stays_off(window: &Window, back: &Expansion<f64>) -> bool {
    let root = |k: usize| {
        let (angle, error) = (window.back[k].abs(), window.error[k]);
        let sign = if k < window.after { -1.0 } else { 1.0 };
        (sign * angle.sqrt(), 2.0 * angle.max(error).sqrt() / error)
    };
    let (roots, weights): (Vec<f64>, Vec<f64>) = (0..window.t.len()).map(root).unzip();
    let most = back.squares.len().saturating_sub(1);
    let touching = misfits(&fitted(&window.t, &over(&roots, &weights), &weights, most));
    let cost = |list: &[Misfit]| least(list, Misfit::cost);
    cost(&touching) > cost(&misfits(back)) + ENOUGH
}
