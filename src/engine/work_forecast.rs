//! Whether a run will reach its end before the work limit, told from how it proceeds.

use super::time::{FAR, Finish};

/// Evaluations over which a pace is taken.
const WINDOW: u64 = 1_000_000;
/// A run is given up if at its pace it needs more than the work limit by this factor in two windows in a row, and either
/// moves by less than so much (rad) with each evaluation, or turns at a speed that lasts.
const BEYOND: f64 = 5.0;
const CRAWL: f64 = 1e-5;

/// Where a run ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ends {
    /// Last time, s.
    pub t: f64,
    /// How far (rad) the crank turns, or infinite.
    pub way: f64,
    /// The work limit.
    pub evaluations: u64,
}

/// How fast a run proceeds.
#[derive(Clone, Copy, Debug)]
pub struct WorkForecast {
    t: f64,
    evaluations: u64,
    ends: Ends,
    /// Whether loads depend on the time: then no speed is known to last.
    in_time: bool,
    /// Way in the window, with sign and without, and since the start, rad.
    net: f64,
    travel: f64,
    turned: f64,
    /// Speed in the window before, rad/s.
    speed: f64,
    slow: bool,
}

impl WorkForecast {
    /// Of a run that begins at this time (s), with so many evaluations before it; `in_time`: loads depend on the time.
    pub fn new(t: f64, evaluations: u64, ends: Ends, in_time: bool) -> WorkForecast {
        WorkForecast {
            t,
            evaluations,
            ends,
            in_time,
            net: 0.0,
            travel: 0.0,
            turned: 0.0,
            speed: f64::INFINITY,
            slow: false,
        }
    }

    /// Why the work limit will be reached long before the end, as a run shows that has got to this time (s) with so many
    /// evaluations in all, and moved by `travel` (rad) since it was last asked.
    pub fn is_hopeless(&mut self, evaluations: u64, t: f64, travel: f64) -> Option<Finish> {
        self.travel += travel.abs();
        self.net += travel;
        let spent = (evaluations - self.evaluations) as f64;
        if spent < WINDOW as f64 {
            return None;
        }
        self.turned += self.net;
        let ends = self.ends;
        let seconds = t - self.t;
        let turns = self.net.abs() == self.travel;
        let windows = if ends.t < FAR {
            (ends.t - t) / seconds
        } else if turns {
            (ends.way - self.turned.abs()) / self.travel
        } else {
            0.0
        };
        let left = ends.evaluations.saturating_sub(evaluations) as f64;
        let crawls = ends.t < FAR && self.travel < CRAWL * spent;
        // A crank that loses less than this part of its speed in a window does not come to rest before the limit.
        let speed = self.travel / seconds;
        let lasts = turns && !self.in_time && speed >= self.speed * (1.0 - spent / left);
        let slow = windows * spent > BEYOND * left && (crawls || lasts);
        let was_slow = std::mem::replace(&mut self.slow, slow);
        (self.t, self.evaluations, self.speed) = (t, evaluations, speed);
        (self.net, self.travel) = (0.0, 0.0);
        let why = match crawls {
            true => Finish::WorkLimitAhead,
            false => Finish::TooManyTurns,
        };
        (slow && was_slow).then_some(why)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LIMIT: u64 = 100_000_000;

    /// Feeds a run that takes 100 evaluations a turn and has turned by `way(t)` (rad); whether it is given up before
    /// its end or the limit.
    fn given_up(ends: Ends, in_time: bool, way: impl Fn(f64) -> f64) -> bool {
        let mut pace = WorkForecast::new(0.0, 0, ends, in_time);
        let (mut t, mut before, mut evaluations) = (0.0, 0.0, 0);
        while t < ends.t && before < ends.way && evaluations < LIMIT {
            t += 1e-3;
            let turned: f64 = way(t) - before;
            evaluations += (turned.abs() * 20.0) as u64;
            before = way(t);
            if pace.is_hopeless(evaluations, t, turned).is_some() {
                return true;
            }
        }
        false
    }

    fn ends(t: f64, way: f64) -> Ends {
        Ends {
            t,
            way,
            evaluations: LIMIT,
        }
    }

    #[test]
    fn a_speed_that_lasts_is_given_up_if_it_takes_too_long() {
        let steady = |t: f64| 1e6 * t;
        assert!(given_up(ends(1e3, f64::INFINITY), false, steady));
        assert!(given_up(ends(FAR, 1e9), false, steady));
        assert!(given_up(ends(1e3, f64::INFINITY), false, |t| 1e6 * t * t));
        assert!(!given_up(ends(4.0, f64::INFINITY), false, steady));
        assert!(!given_up(ends(FAR, 4e6), false, steady));
    }

    /// Friction may bring it to rest, a load in time may do anything, and one that swings has its turns before it.
    #[test]
    fn a_speed_that_may_not_last_is_not() {
        let slowing = |t: f64| 4e6 * (1.0 - (-t).exp());
        assert!(!given_up(ends(1e3, f64::INFINITY), false, slowing));
        let stopping = |t: f64| {
            if t < 4.0 {
                1e6 * (t - t * t / 8.0)
            } else {
                2e6
            }
        };
        assert!(!given_up(ends(1e3, f64::INFINITY), false, stopping));
        assert!(!given_up(ends(5e1, f64::INFINITY), true, |t| 1e6 * t));
        assert!(!given_up(ends(FAR, 1e9), false, |t| 1e2 * (1e2 * t).sin()));
    }
}
