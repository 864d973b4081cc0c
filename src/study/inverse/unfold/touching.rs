//! Motions that come to rest just at a fold: one that goes back and one that passes show the same there, and both are smooth
//! but for a jump of the acceleration.

use super::super::sensor::Sensor;
use super::evidence::{ENOUGH, Evidence, Misfit, fitted};
use super::refined::{STEPS, refined, rows, solved, sum, values};
use super::window::Window;
use crate::numeric::golden;
use crate::numeric::orthogonal::Expansion;

/// Whether a motion that goes back, as a fit has it, is told from one that touches the fold.
pub(super) fn stays_off(window: &Window, sensor: &Sensor<'_>, back: &Expansion<f64>) -> bool {
    let misfits = refined(window, sensor, back);
    let simplest = misfits.iter().min_by(|a, b| a.cost().total_cmp(&b.cost()));
    let Some(simplest) = simplest.filter(|simplest| simplest.degree > 1) else {
        return false;
    };
    let degree = simplest.degree;
    let angles = solved(window, sensor, back, degree).angles;
    // What the degree does not reach may be just what moves the motion off the fold.
    let touching = [degree, degree + 2].map(|degree| Misfit {
        degree,
        squares: touching(window, sensor, angles.clone(), degree),
    });
    Evidence::between(&touching, &misfits, window.t.len()).passes > ENOUGH
}

/// What is left by the polynomial of a degree that touches the fold, from one that is near to it on, by steps of Gauss and Newton
/// between polynomials that are zero where the last one was nearest to it.
fn touching(window: &Window, sensor: &Sensor<'_>, mut angles: Vec<f64>, degree: usize) -> f64 {
    let side = window.back.iter().sum::<f64>().signum();
    let [from, to] = window.around_fold();
    let mut least = f64::INFINITY;
    for _ in 0..STEPS {
        let even = vec![1.0; window.t.len()];
        let near = fitted(&window.t, &angles, &even, degree);
        let value = |t: f64| side * near.value(degree, t);
        let (nearest, away) = golden::largest(|t| -value(t), from, to);
        for angle in &mut angles {
            *angle += side * away;
        }
        let (rest, slopes) = rows(window, sensor, &angles);
        least = least.min(sum(&rest));
        let way: Vec<f64> = window.t.iter().map(|t| t - nearest).collect();
        let weights: Vec<f64> = slopes
            .iter()
            .zip(&way)
            .map(|(slope, way)| slope * way)
            .collect();
        let change = values(
            &fitted(&window.t, &rest, &weights, degree - 1),
            degree - 1,
            &window.t,
        );
        for (angle, (change, way)) in angles.iter_mut().zip(change.iter().zip(&way)) {
            *angle += change * way;
        }
    }
    least
}
