//! Computes designs of the unit box and ranks them by Deb's rules, by goal and by scaled margins of the limits.

use std::cmp::Ordering;
use std::f64::consts::TAU;
use std::sync::atomic::{AtomicU64, Ordering as Memory};

use super::{AGREEMENT, Asked, GAIN};
use crate::numeric::stop::Stop;
use crate::scene::VariedValue;
use crate::sweep::{Goal, Outcome, Source, Sweep};

/// Objective and constraints over the unit box: coordinate 0 is the lower bound of a key, 1 the upper one.
pub(super) struct Judge<'a> {
    pub sweep: &'a Sweep,
    pub asked: &'a Asked,
    pub stop: &'a Stop,
    /// Number of designs computed.
    pub computed: AtomicU64,
    /// Scale of the goal: its interquartile range in the sample, on which outliers have little influence.
    goal_scale: f64,
    /// Scale of each limited figure: its interquartile range in the sample.
    scales: Vec<f64>,
}

/// A design with its goal and its violation of the limits.
#[derive(Clone, Debug)]
pub(super) struct Judged {
    /// Point of the unit box, one coordinate per key.
    pub at: Vec<f64>,
    /// Goal, to be minimised (sign reversed for a maximum); none if the design or a figure could not be computed.
    pub aim: Option<f64>,
    /// Margin to each limit, positive if met, in the unit of the figure; empty without goal and limited figures.
    pub margins: Vec<f64>,
    /// Largest scaled violation of a limit, 0 if all are met; infinite for a design without goal.
    pub violation: f64,
}

impl Judged {
    /// Returns the goal figure with its own sign.
    pub fn value(&self, goal: Goal) -> Option<f64> {
        self.aim.map(|aim| if goal.most { -aim } else { aim })
    }

    /// Orders by Deb's rules, better designs first: by violation, then by goal.
    pub fn order(&self, other: &Judged) -> Ordering {
        let aim = |one: &Judged| one.aim.unwrap_or(f64::INFINITY);
        let violation = self.violation.total_cmp(&other.violation);
        violation.then(aim(self).total_cmp(&aim(other)))
    }
}

impl<'a> Judge<'a> {
    pub fn new(sweep: &'a Sweep, asked: &'a Asked, stop: &'a Stop) -> Judge<'a> {
        Judge {
            sweep,
            asked,
            stop,
            computed: AtomicU64::new(0),
            goal_scale: 1.0,
            scales: vec![1.0; asked.subjects.len()],
        }
    }

    pub fn values(&self, at: &[f64]) -> Vec<VariedValue> {
        let varied = self.sweep.varied().iter().zip(at);
        varied.map(|(one, at)| one.quantile(*at)).collect()
    }

    /// Computes and ranks a design; returns one without figures after a request to stop.
    pub fn judge(&self, at: Vec<f64>) -> Judged {
        if self.stop.is_requested() {
            return self.verdict(at, None, Vec::new());
        }
        self.computed.fetch_add(1, Memory::Relaxed);
        let design = self.sweep.design_of(0, self.values(&at));
        let Asked { goal, subjects, .. } = self.asked;
        let margins = subjects.iter().map(|subject| {
            let value = subject.figure.number(&design)?;
            Some(subject.margin(value)).filter(|margin| margin.is_finite())
        });
        let aim = goal.figure.number(&design);
        let aim = aim.filter(|aim| aim.is_finite() && design.outcome == Outcome::Done);
        let aim = aim.map(|aim| if goal.most { -aim } else { aim });
        match margins.collect::<Option<Vec<f64>>>() {
            Some(margins) => self.verdict(at, aim, margins),
            None => self.verdict(at, None, Vec::new()),
        }
    }

    fn verdict(&self, at: Vec<f64>, aim: Option<f64>, margins: Vec<f64>) -> Judged {
        let missed = margins.iter().zip(&self.scales);
        let missed = missed.map(|(margin, scale)| -margin / scale);
        let violation = match aim {
            Some(_) => missed.fold(0.0, f64::max),
            None => f64::INFINITY,
        };
        Judged {
            at,
            aim,
            margins,
            violation,
        }
    }

    /// Sets the scales from a sample and ranks the sample again with them.
    pub fn calibrate(&mut self, sample: Vec<Judged>) -> Vec<Judged> {
        let of = |value: &dyn Fn(&Judged) -> f64| {
            let computed = sample.iter().filter(|one| one.aim.is_some());
            middle_half(computed.map(value).collect())
        };
        let subjects = 0..self.asked.subjects.len();
        self.scales = subjects.map(|i| of(&|one| one.margins[i])).collect();
        self.goal_scale = of(&|one| one.aim.unwrap_or_default());
        let again = sample
            .into_iter()
            .map(|one| self.verdict(one.at, one.aim, one.margins));
        again.collect()
    }

    /// Returns the scaled goal, `worst` for a design without goal.
    pub fn aim(&self, one: &Judged, worst: f64) -> f64 {
        one.aim.map_or(worst, |aim| aim / self.goal_scale)
    }

    /// Returns the scaled margin to a limit, positive if met; -1, a violation by one scale, without figures.
    pub fn margin(&self, one: &Judged, subject: usize) -> f64 {
        let margin = one.margins.get(subject).copied();
        margin.map_or(-1.0, |margin| margin / self.scales[subject])
    }

    /// Whether a figure equals its limit to [`AGREEMENT`] of its scale.
    pub fn is_active(&self, subject: usize, value: f64) -> bool {
        let margin = self.asked.subjects[subject].margin(value);
        margin.abs() <= AGREEMENT * self.scales[subject]
    }

    /// Whether goals (scaled) and violations of two designs agree to [`AGREEMENT`].
    pub fn agree(&self, one: &Judged, other: &Judged) -> bool {
        let aims = one.aim.zip(other.aim);
        let near = aims.is_some_and(|(a, b)| (a - b).abs() <= AGREEMENT * self.goal_scale);
        near && (one.violation - other.violation).abs() <= AGREEMENT
    }

    /// Returns the least significant difference of the goal: |goal| times the relative error of the motion (speed error
    /// to fastest speed, angle error to angle travelled) or of the steady fluctuation; at least [`GAIN`] of the scale.
    pub fn resolution(&self, one: &Judged) -> f64 {
        let aim = one.aim.map_or(0.0, f64::abs);
        let least = GAIN * self.goal_scale;
        if self.asked.goal.figure.source() <= Source::Diagrams || self.stop.is_requested() {
            return least;
        }
        let vouched = self.sweep.with_estimates();
        let design = vouched.design_of(0, self.values(&one.at));
        let motion = design.motion.as_ref().and_then(|run| {
            let error = run.error_estimate?;
            let fastest = run.omega_max.abs().max(run.omega_min.abs());
            let way = run.revolutions.abs() * TAU;
            Some((error.omega_rad_per_s / fastest).max(error.theta_rad / way))
        });
        let steady = design.steady.as_ref();
        let steady = steady.map(|cycle| cycle.fluctuation.error / cycle.fluctuation.value);
        let errors = motion.into_iter().chain(steady);
        let errors = errors
            .map(|error| error * aim)
            .filter(|error| error.is_finite());
        errors.fold(least, f64::max)
    }

    /// Whether `one` beats `other`: by more than `resolution` in goal at equal violation, else [`GAIN`] in violation.
    pub fn improves(&self, one: &Judged, other: &Judged, resolution: f64) -> bool {
        if one.order(other) != Ordering::Less {
            return false;
        }
        match (one.aim, other.aim) {
            (Some(a), Some(b)) if one.violation == other.violation => b - a > resolution,
            _ => other.violation - one.violation > GAIN,
        }
    }
}

/// Returns the interquartile range; the full range if that is zero, 1 if both are zero or not finite.
fn middle_half(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    let Some(last) = values.len().checked_sub(1) else {
        return 1.0;
    };
    let spreads = [
        values[last - last / 4] - values[last / 4],
        values[last] - values[0],
    ];
    let found = spreads
        .into_iter()
        .find(|spread| *spread > 0.0 && spread.is_finite());
    found.unwrap_or(1.0)
}
