//! Contact phase: its start and end with the square root of the depth as independent variable, the middle in time.

use super::dop853::Stages;
use super::flight::{END_CORRECTION, depth};
use super::run::{Halt, Runner, growth};
use super::{Contact, Phase};
use crate::numeric::root;

/// Relative change of the depth rate up to which the square root of the depth serves as independent variable.
const RATE_CHANGE: f64 = 0.3;

impl<M: Contact<N>, const N: usize> Runner<'_, M, N> {
    pub(super) fn touch(&mut self, approach: f64) -> Halt {
        let began = self.y[0];
        let (depth, rate) = (self.now.depth, self.now.depth_rate);
        if rate > 0.0 {
            let reach = self.reach(rate);
            let from = match depth > self.model.rounding(&self.y) {
                true => depth.sqrt(),
                false => 0.0,
            };
            // A contact that is deeper already is integrated in time.
            let begins = depth < 1e-3 * reach;
            if begins && self.by_root(approach, from, reach.sqrt())? {
                // First step in time, as a part of the time over the square root of the depth.
                self.h = 0.7 * (self.y[0] - began);
                self.enter(self.phase);
            }
        }
        while self.y[0] < self.until {
            let recedes = self.now.depth_rate < 0.0 && !self.is_pressed_at_rest();
            if recedes && self.now.depth <= self.model.rounding(&self.y) {
                self.part();
                return Ok(());
            }
            if self.leaves() {
                let from = self.now.depth.sqrt();
                let out = self.by_root(approach, from, 0.0)?;
                if out || self.now.depth <= self.model.rounding(&self.y) {
                    self.part();
                    return Ok(());
                }
            }
            if !self.press(approach)? {
                return Ok(());
            }
        }
        Ok(())
    }

    /// Takes one step in time; false if the contact no longer transmits force.
    fn press(&mut self, approach: f64) -> Halt<bool> {
        let (depth, rate) = (self.now.depth, self.now.depth_rate);
        let longest = if rate < 0.0 && depth > 0.0 {
            // The step is to end before the contact does.
            self.settings.share * 0.8 * depth / -rate
        } else {
            f64::INFINITY
        };
        let (mut stages, h, end, then) = loop {
            let (stages, h) = self.controlled_step(longest)?;
            let end = self.snapped(stages.end, h);
            let then = self.sample(None, &end);
            if then.depth > 0.0 || depth <= self.model.rounding(&self.y) {
                break (stages, h, end, then);
            }
            // The step has passed the end of the contact.
            self.h = 0.3 * h;
        };
        let model = self.model;
        if model.pressing(approach, then.depth_rate) >= 0.0 {
            stages.set_last_rate(then.rates);
            self.accept_to(&stages, end, then)?;
            return Ok(true);
        }
        let (dense, _) = self.inside(&mut stages);
        let phase = self.phase;
        let pressing = |u: f64| model.pressing(approach, self::depth(model, phase, &dense.at(u)).1);
        if let Some(u) = root::bracketed(pressing, 0.0, 1.0).filter(|u| *u > 0.0) {
            self.cut_at(u * h)?;
        }
        self.enter(Phase::Release { approach });
        Ok(false)
    }

    /// Returns the depth (m) up to which its square root may be the independent variable, from trial decelerations.
    fn reach(&mut self, rate: f64) -> f64 {
        let y = self.y;
        let trial = 1e-6;
        let [free, pressed] =
            [0.0, trial].map(|depth| self.sample(Some(depth), &y).depth_acceleration);
        // The deceleration grows with the 3/2 power of the depth.
        let growth = (free - pressed).max(0.0) / (trial * f64::sqrt(trial));
        let energy = 0.5 * RATE_CHANGE * rate * rate;
        let by_wall = (energy / growth.max(1e-300)).powf(0.4);
        by_wall.min(energy / free.abs().max(1e-300))
    }

    /// True if the contact is ending, with a depth rate that stays nearly constant until then.
    fn leaves(&mut self) -> bool {
        let (depth, rate) = (self.now.depth, self.now.depth_rate);
        let bounded = |acceleration: f64| acceleration.abs() * depth < RATE_CHANGE * rate * rate;
        if rate >= 0.0 || depth <= 0.0 || !bounded(self.now.depth_acceleration) {
            return false;
        }
        bounded(self.sample(Some(0.0), &{ self.y }).depth_acceleration)
    }

    /// Integrates from one square root of the depth to another. False, at the last valid state, where that is
    /// impossible: beyond `until`, without force, with a vanishing depth rate, or with a missed load.
    fn by_root(&mut self, approach: f64, from: f64, to: f64) -> Halt<bool> {
        let (model, phase) = (self.model, self.phase);
        let (mut s, mut ds) = (from, self.settings.share * (to - from));
        let scale = self.scale(0.0);
        let shortest = 1e-3 * (to - from).abs();
        while s != to {
            self.check_work()?;
            let near = self.near;
            let slope = 2.0 * s / self.now.depth_rate;
            let first = self.now.rates.map(|each| each * slope);
            let (s0, length) = (s, ds);
            let mut rates = |c: f64, y: &[f64; N]| {
                let s = s0 + c * length;
                let sample = model.sample(&near, phase, Some(s * s), y);
                let slope = 2.0 * s / sample.depth_rate;
                sample.rates.map(|rate| rate * slope)
            };
            let mut stages = Stages::new(&mut rates, &self.y, &first, length);
            self.evaluations += 11;
            let error = stages.error(&scale, self.counted);
            let end = stages.end;
            let next = if ds == to - s { to } else { s + ds };
            let then = self.sample(Some(next * next), &end);
            let sound = end[0] > self.y[0] && then.depth_rate * (to - from) > 0.0;
            if !sound || error.is_nan() || error > 1.0 {
                let shrink = if error.is_finite() {
                    growth(error).min(0.5)
                } else {
                    0.2
                };
                ds *= shrink;
                if ds.abs() < shortest {
                    return Ok(false);
                }
                continue;
            }
            let is_unresolved = self.unresolved_after(&end).is_some();
            if is_unresolved
                || end[0] > self.until
                || model.pressing(approach, then.depth_rate) < 0.0
            {
                return Ok(false);
            }
            s = next;
            let slope = 2.0 * s / then.depth_rate;
            stages.set_last_rate(then.rates.map(|each| each * slope));
            self.follow(&stages, &mut rates, end, then)?;
            ds *= growth(error);
            if (to - s).abs() <= ds.abs() {
                ds = to - s;
            }
        }
        Ok(true)
    }

    /// Ends the contact; a small step in time removes the remaining depth.
    fn part(&mut self) {
        let (depth, rate) = depth(self.model, Phase::Flight, &self.y);
        let dt = -depth / rate;
        if dt.is_finite() && dt.abs() < END_CORRECTION * self.flight_h {
            self.y = self.nudged(&{ self.y }, dt, Phase::Flight);
            self.near = self.model.near_after(&self.near, &self.y);
        }
        self.enter(Phase::Flight);
    }
}
