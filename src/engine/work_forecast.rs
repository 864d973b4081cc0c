//! Forecast: will the run exceed its evaluation limit long before its end? Extrapolates the progress per evaluation.

use super::run_in_time::{Ends, Finish, UNLIMITED_TIME};

/// Progress of a run.
#[derive(Clone, Copy, Debug)]
pub struct WorkForecast<'a> {
    t: f64,
    evaluations: u64,
    ends: Ends<'a>,
    /// True if loads depend on time: then no speed is known to last.
    in_time: bool,
    /// Travel in the window with sign (`net`) and without, and net travel before the window, rad.
    net: f64,
    travel: f64,
    turned: f64,
    /// Mean speed in the window before, rad/s.
    speed: f64,
    slow: bool,
}

impl<'a> WorkForecast<'a> {
    /// Starts the forecast of a run at a time (s), after `evaluations`; `in_time`: loads depend on time.
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

    /// Returns the reason to give up a run that has reached time `t` (s) with `evaluations` in all and moved by
    /// `travel` (rad) since the last call; none while it may reach its end within the work limit.
    pub fn reason_to_stop(&mut self, evaluations: u64, t: f64, travel: f64) -> Option<Finish> {
        self.travel += travel.abs();
        self.net += travel;
        let ends = self.ends;
        if let Some(stop) = ends.limit.stop {
            stop.reach((t / ends.t).max((self.turned + self.net).abs() / ends.way));
        }
        let spent = (evaluations - self.evaluations) as f64;
        // Evaluations in a window over which the progress is measured.
        let window = 1e6;
        if spent < window {
            return None;
        }
        self.turned += self.net;
        let seconds = t - self.t;
        let turns = self.net.abs() == self.travel;
        let windows = if ends.t < UNLIMITED_TIME {
            (ends.t - t) / seconds
        } else if turns {
            (ends.way - self.turned.abs()) / self.travel
        } else {
            0.0
        };
        let left = ends.limit.evaluations.saturating_sub(evaluations) as f64;
        // Travel per evaluation, rad, below which a run crawls.
        let crawl = 1e-5;
        let crawls = ends.t < UNLIMITED_TIME && self.travel < crawl * spent;
        // A crank that loses less than `spent / left` of its speed per window does not come to rest before the limit.
        let speed = self.travel / seconds;
        let lasts = turns && !self.in_time && speed >= self.speed * (1.0 - spent / left);
        // Ratio of extrapolated to remaining evaluations, twice in a row, that ends a crawling or steadily turning run.
        let beyond = 5.0;
        let slow = windows * spent > beyond * left && (crawls || lasts);
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
