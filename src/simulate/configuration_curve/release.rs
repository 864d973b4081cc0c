//! When loads that change in time tear a sticking slider loose.

use crate::engine::WorkLimit;
use crate::mechanism::AtRest;
use crate::numeric::root;

/// Where inside an interval the band is looked at: unevenly, so that no period of a load hides between.
const PLACES: [f64; 5] = [0.0, 0.29, 0.53, 0.83, 1.0];
/// The first interval, as part of the time that is left, and the shortest.
const FIRST_INTERVAL: f64 = 1.0 / 317.0;
const SHORTEST_INTERVAL: f64 = 1e-9;

/// What a search found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Release {
    /// The static band does not hold after this time, s.
    At(f64),
    /// The slider sticks all the time.
    Never,
    /// The search was not allowed to go further than this time, s.
    Unknown(f64),
}

/// The first time between `from` and `to` (s) after which the static band does not hold, and how often it was
/// evaluated.
pub(super) fn time(
    rest: &AtRest<'_>,
    mu_static: f64,
    from: f64,
    to: f64,
    allowed: WorkLimit<'_>,
) -> (Release, u64) {
    let mut count = 0;
    let band = |t: f64| rest.margin(t, mu_static);
    let longest = FIRST_INTERVAL * (to - from);
    let shortest = SHORTEST_INTERVAL * (to - from);
    let (mut t, mut length) = (from, longest);
    while t < to && !allowed.is_reached(count) {
        let end = rest.next_corner(t).min(to).min(t + length);
        let times = PLACES.map(|part| {
            if part == 1.0 {
                end
            } else {
                t + part * (end - t)
            }
        });
        let values = times.map(band);
        count += PLACES.len() as u64;
        // How far the values are from a straight line says how far the band may dip between them.
        let line = |part: f64| values[0] + part * (values[4] - values[0]);
        let bend = (1..4)
            .map(|i| (values[i] - line(PLACES[i])).abs())
            .fold(0.0, f64::max);
        let least = values.iter().fold(f64::INFINITY, |a, b| a.min(*b));
        // A band that is zero throughout, as at a dead centre without weight, holds.
        let even = least > 2.0 * bend || least >= 0.0 && bend == 0.0;
        let change = rest.margin_change(mu_static, [t, end]);
        let calm = even && least >= change;
        if calm || end - t <= shortest {
            if let Some(i) = (1..5).find(|i| values[*i] < 0.0) {
                return (Release::At(crossing(band, times[i - 1], times[i])), count);
            }
            t = end;
            length = (2.0 * length).min(longest);
        } else if let Some(i) = (1..5).find(|i| values[*i] < 0.0)
            && change == 0.0
            && values[..i].windows(2).all(|w| w[1] <= w[0])
        {
            // It falls all the way to where it is exceeded.
            return (Release::At(crossing(band, times[i - 1], times[i])), count);
        } else {
            length = 0.5 * (end - t);
        }
    }
    let end = if t < to {
        Release::Unknown(t)
    } else {
        Release::Never
    };
    (end, count)
}

fn crossing(band: impl Fn(f64) -> f64, from: f64, to: f64) -> f64 {
    root::bracketed(band, from, to).unwrap_or(to)
}
