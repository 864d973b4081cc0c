//! Maximum of the likelihood along one parameter.

use super::scales::Noise;
use crate::numeric::parallel;

/// Returns the likelier of two noises.
pub(super) fn better(a: Noise, b: Noise) -> Noise {
    if b.likelihood > a.likelihood { b } else { a }
}

/// First step of a search over ln of a frequency.
pub(super) const FIRST_STEP: f64 = 0.5;

/// Maximises the likelihood near a guess: uphill in growing steps from the likelier neighbour, then parabolas through the three
/// best points.
pub(super) fn climb(
    at: impl Fn(f64) -> Noise + Sync,
    guess: f64,
    first: Noise,
    first_step: f64,
    [lowest, highest]: [f64; 2],
) -> Noise {
    let with = |place: f64| (place, at(place));
    let stepped =
        |from: f64, step: f64| Some((from + step).clamp(lowest, highest)).filter(|to| *to != from);
    let mut points = vec![(guess, first)];
    let sides = [first_step, -first_step].map(|step| stepped(guess, step));
    points.extend(parallel::map(sides.into_iter().flatten(), with));
    let (mut here, mut step) = ((guess, first), first_step);
    loop {
        let best = points[likeliest(&points)];
        let rises = best.1.likelihood > here.1.likelihood + ENOUGH_RISE;
        if !rises {
            break;
        }
        step = (1.6 * step).copysign(best.0 - here.0);
        here = best;
        points.extend(stepped(here.0, step).map(with));
    }
    let mut width = f64::INFINITY;
    for _ in 0..12 {
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        let best = likeliest(&points);
        if best == 0 || best + 1 == points.len() {
            break;
        }
        let [a, b, c] = [best - 1, best, best + 1].map(|k| (points[k].0, points[k].1.likelihood));
        let Top { place, rise } = vertex(a, b, c);
        if !place.is_finite() || rise < ENOUGH_RISE {
            break;
        }
        // Beside a cliff parabolas come nearer by little at a time.
        let is_slow = c.0 - a.0 > 0.5 * width;
        width = c.0 - a.0;
        points.push(with(if is_slow {
            middle_of_wider(a, b, c)
        } else {
            place
        }));
    }
    points[likeliest(&points)].1
}

/// Returns the index of the likeliest of some places with their noise, the first of several.
fn likeliest(points: &[(f64, Noise)]) -> usize {
    let likelier = |best: usize, k: usize| match points[k].1.likelihood > points[best].1.likelihood
    {
        true => k,
        false => best,
    };
    (1..points.len()).fold(0, likelier)
}

/// Rise of ln of the likelihood below which another evaluation does not pay.
pub(super) const ENOUGH_RISE: f64 = 0.05;

/// ln of the likelihood ratio above which more of a model is significant: a torque, a further free key, further harmonics.
pub(super) const SIGNIFICANT_RISE: f64 = 2.0;

/// Vertex of a parabola, with its expected rise above the best known point.
pub(super) struct Top {
    pub place: f64,
    rise: f64,
}

/// Returns the vertex of the parabola through three points, kept between the outer ones.
pub(super) fn vertex(a: (f64, f64), b: (f64, f64), c: (f64, f64)) -> Top {
    let (left, right) = ((b.1 - a.1) / (b.0 - a.0), (c.1 - b.1) / (c.0 - b.0));
    let curvature = (right - left) / (c.0 - a.0);
    if !curvature.is_finite() || curvature >= 0.0 {
        return Top {
            place: middle_of_wider(a, b, c),
            rise: f64::INFINITY,
        };
    }
    let top = 0.5 * (a.0 + b.0) - 0.5 * left / curvature;
    Top {
        place: top.clamp(a.0 + 0.1 * (b.0 - a.0), c.0 - 0.1 * (c.0 - b.0)),
        rise: -curvature * (top - b.0).powi(2),
    }
}

/// Returns the middle of the wider side of three points.
fn middle_of_wider(a: (f64, f64), b: (f64, f64), c: (f64, f64)) -> f64 {
    match c.0 - b.0 > b.0 - a.0 {
        true => 0.5 * (b.0 + c.0),
        false => 0.5 * (a.0 + b.0),
    }
}
