//! Release of a sticking slider by loads in time: first zero of the static margin, by sampling and load enclosures.

use crate::engine::WorkLimit;
use crate::mechanism::AtRest;
use crate::numeric::root;

/// Sample places in an interval, as parts of its length: uneven, as a periodic load could hide between even ones.
const SAMPLE_PLACES: [f64; 5] = [0.0, 0.29, 0.53, 0.83, 1.0];

/// Result of a search for release.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Release {
    /// The static friction gives way after this time, s.
    At(f64),
    /// The slider sticks for all of the time.
    Never,
    /// The work limit ended the search at this time, s.
    Unknown(f64),
}

/// Finds the first time between `from` and `to` (s) after which static friction gives way; counts evaluations.
pub(super) fn time(
    rest: &AtRest<'_>,
    mu_static: f64,
    from: f64,
    to: f64,
    allowed: WorkLimit<'_>,
) -> (Release, u64) {
    let mut count = 0;
    let band = |t: f64| rest.margin(t, mu_static);
    // Intervals, s: a prime number of them is out of step with the period of most loads; shorter dips are not resolved.
    let [longest, shortest] = [1.0 / 317.0, 1e-9].map(|part| part * (to - from));
    let (mut t, mut length) = (from, longest);
    while t < to && !allowed.is_reached(count) {
        let corner = rest.equation.loads().next_corner(t);
        let end = corner.min(to).min(t + length);
        let times = SAMPLE_PLACES.map(|part| match part {
            1.0 => end,
            _ => t + part * (end - t),
        });
        let values = times.map(band);
        count += SAMPLE_PLACES.len() as u64;
        // The distance of the samples from a straight line indicates the dip of the margin between them.
        let line = |part: f64| values[0] + part * (values[4] - values[0]);
        let bend = (1..4)
            .map(|i| (values[i] - line(SAMPLE_PLACES[i])).abs())
            .fold(0.0, f64::max);
        let least = values.iter().fold(f64::INFINITY, |a, b| a.min(*b));
        // A margin that is zero throughout, as at a dead centre without weight, holds.
        let even = least > 2.0 * bend || least >= 0.0 && bend == 0.0;
        let change = rest.margin_change(mu_static, [t, end]);
        let is_resolved = even && least >= change || end - t <= shortest;
        let falls = |i: usize| change == 0.0 && values[..i].windows(2).all(|w| w[1] <= w[0]);
        // A margin that falls all the way to its crossing needs no closer look.
        if let Some(i) = (1..5).find(|i| values[*i] < 0.0)
            && (is_resolved || falls(i))
        {
            let crossing = root::bracketed(band, times[i - 1], times[i]).unwrap_or(times[i]);
            // Where the margin jumps, the loads that move the slider act behind the crossing.
            let behind = (crossing * (1.0 + 4.0 * f64::EPSILON)).min(times[i]);
            let holds = band(crossing) >= 0.0;
            return (Release::At(if holds { behind } else { crossing }), count);
        }
        if is_resolved {
            t = end;
            length = (2.0 * length).min(longest);
        } else {
            length = 0.5 * (end - t);
        }
    }
    let end = match t < to {
        true => Release::Unknown(t),
        false => Release::Never,
    };
    (end, count)
}
