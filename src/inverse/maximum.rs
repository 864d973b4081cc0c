//! Maximum of the likelihood along one parameter.

use super::scales::Noise;

/// Returns the likelier of two noises.
pub(super) fn better(a: Noise, b: Noise) -> Noise {
    if b.likelihood > a.likelihood { b } else { a }
}

/// First step of a search over ln of a frequency.
pub(super) const FIRST_STEP: f64 = 0.5;

/// Maximises the likelihood near a guess: uphill in growing steps, then parabolas through the three best points.
pub(super) fn climb(
    at: impl Fn(f64) -> Noise,
    guess: f64,
    first: Noise,
    [lowest, highest]: [f64; 2],
) -> Noise {
    let mut points = vec![(guess, first)];
    for direction in [1.0, -1.0] {
        let mut step = FIRST_STEP;
        let (mut here, mut before) = (guess, first.likelihood);
        loop {
            let next = (here + direction * step).clamp(lowest, highest);
            if next == here {
                break;
            }
            let found = at(next);
            points.push((next, found));
            if found.likelihood <= before {
                break;
            }
            (here, before) = (next, found.likelihood);
            step *= 1.6;
        }
        if here != guess {
            break;
        }
    }
    for _ in 0..4 {
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        let Some(best) = (0..points.len())
            .max_by(|a, b| points[*a].1.likelihood.total_cmp(&points[*b].1.likelihood))
        else {
            break;
        };
        if best == 0 || best + 1 == points.len() {
            break;
        }
        let [a, b, c] = [best - 1, best, best + 1].map(|k| (points[k].0, points[k].1.likelihood));
        let top = vertex(a, b, c);
        if !top.place.is_finite() || top.rise < ENOUGH_RISE {
            break;
        }
        points.push((top.place, at(top.place)));
    }
    let best = points
        .into_iter()
        .max_by(|a, b| a.1.likelihood.total_cmp(&b.1.likelihood));
    best.map_or(first, |(_, noise)| noise)
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
        // No parabola: the middle of the wider side.
        let place = match c.0 - b.0 > b.0 - a.0 {
            true => 0.5 * (b.0 + c.0),
            false => 0.5 * (a.0 + b.0),
        };
        let rise = f64::INFINITY;
        return Top { place, rise };
    }
    let top = 0.5 * (a.0 + b.0) - 0.5 * left / curvature;
    Top {
        place: top.clamp(a.0 + 0.1 * (b.0 - a.0), c.0 - 0.1 * (c.0 - b.0)),
        rise: -curvature * (top - b.0).powi(2),
    }
}
