//! The forecast whether a run will reach its work limit long before its end, from the progress per evaluation.

use super::run_in_time::{Ends, FAR, Finish};

/// Evaluations over which a pace is taken.
const WINDOW: u64 = 1_000_000;
/// A run is given up if at its pace it needs more than the work limit by this factor in two windows in a row, and either
/// moves by less than so much (rad) with each evaluation, or turns at a speed that lasts.
const BEYOND: f64 = 5.0;
const CRAWL: f64 = 1e-5;

/// How fast a run proceeds.
#[derive(Clone, Copy, Debug)]
pub struct WorkForecast<'a> {
    t: f64,
    evaluations: u64,
    ends: Ends<'a>,
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

impl<'a> WorkForecast<'a> {
    /// Of a run that begins at this time (s), with so many evaluations before it; `in_time`: loads depend on the time.
    pub fn new(t: f64, evaluations: u64, ends: Ends<'a>, in_time: bool) -> WorkForecast<'a> {
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
        let ends = self.ends;
        if let Some(stop) = ends.limit.stop {
            stop.reach((t / ends.t).max((self.turned + self.net).abs() / ends.way));
        }
        let spent = (evaluations - self.evaluations) as f64;
        if spent < WINDOW as f64 {
            return None;
        }
        self.turned += self.net;
        let seconds = t - self.t;
        let turns = self.net.abs() == self.travel;
        let windows = if ends.t < FAR {
            (ends.t - t) / seconds
        } else if turns {
            (ends.way - self.turned.abs()) / self.travel
        } else {
            0.0
        };
        let left = ends.limit.evaluations.saturating_sub(evaluations) as f64;
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
