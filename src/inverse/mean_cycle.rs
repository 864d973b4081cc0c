//! Mean of the cycles: force and torque over the crank angle, with standard errors and scatter from cycle to cycle.

use std::f64::consts::TAU;

use super::Inverse;

/// Number of angles per turn at which cycles are compared.
const IN_A_TURN: usize = 360;

/// Mean force and torque at one angle of the cycle.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MeanRow {
    /// Crank angle within the cycle, rad.
    pub theta: f64,
    /// Force on the slider, N; none where no cycle determines it.
    pub slider_force: Option<CycleMean>,
    /// Torque on the crank that drives the motion in place of the force, N m.
    pub crank_torque: Option<CycleMean>,
}

/// A mean over cycles, N or N m.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CycleMean {
    /// Number of cycles that determine the mean.
    pub cycles: usize,
    /// Mean of the cycles.
    pub value: f64,
    /// Standard error of the mean.
    pub standard_error: f64,
    /// Standard deviation from cycle to cycle; none for a single cycle.
    pub scatter: Option<f64>,
}

/// Value of one cycle, its standard error, and the part of the error that all cycles share.
struct Passage {
    value: f64,
    error: f64,
    shared: f64,
}

/// Sums over the passages of an angle; the mean and the squares about it by Welford's recurrence.
#[derive(Clone, Copy, Default)]
struct Sums {
    cycles: usize,
    mean: f64,
    about: f64,
    errors: f64,
    shared: f64,
}

impl Sums {
    fn take(&mut self, passage: Passage) {
        self.cycles += 1;
        let off = passage.value - self.mean;
        self.mean += off / self.cycles as f64;
        self.about += off * (passage.value - self.mean);
        self.errors += passage.error.powi(2) - passage.shared.powi(2);
        self.shared += passage.shared.powi(2);
    }

    /// Returns the mean. The unshared variance, the larger of scatter and own errors, falls with the number of cycles.
    fn mean(&self) -> Option<CycleMean> {
        let count = self.cycles as f64;
        let variance = (self.cycles > 1).then(|| self.about / (count - 1.0));
        let own = (self.errors / count).max(variance.unwrap_or(0.0));
        (self.cycles > 0).then(|| CycleMean {
            cycles: self.cycles,
            value: self.mean,
            standard_error: (own / count + self.shared / count).sqrt(),
            scatter: variance.map(f64::sqrt),
        })
    }
}

impl Inverse {
    /// Returns the mean of the cycles, one row for each degree of crank angle that was passed. A cycle is a turn, or
    /// two turns where the torque repeats after two. Errors of scene values are shared by all cycles; with a periodic
    /// prior of the smoother each cycle rests on all, and all errors are shared.
    pub fn mean_cycle(&self) -> Vec<MeanRow> {
        let count = IN_A_TURN * usize::from(self.cycle.max(1));
        let step = TAU / IN_A_TURN as f64;
        let mut sums = vec![[Sums::default(); 2]; count];
        for (k, pair) in self.rows.windows(2).enumerate() {
            let [from, to] = [pair[0].theta / step, pair[1].theta / step];
            // The begin counts, the end is the begin of the next pair.
            let passed = match from < to {
                true => from.ceil()..to.ceil(),
                false => to.floor() + 1.0..from.floor() + 1.0,
            };
            for angle in passed.start as i64..passed.end as i64 {
                let part = (angle as f64 - from) / (to - from);
                let of = &mut sums[angle.rem_euclid(count as i64) as usize];
                for (which, sums) in of.iter_mut().enumerate() {
                    let passage = self.passage(k, part, which);
                    passage.into_iter().for_each(|passage| sums.take(passage));
                }
            }
        }
        let rows = sums.iter().enumerate().map(|(k, [force, torque])| MeanRow {
            theta: k as f64 * step,
            slider_force: force.mean(),
            crank_torque: torque.mean(),
        });
        rows.filter(|row| row.crank_torque.is_some()).collect()
    }

    /// Interpolates force (`which` = 0) or torque (1) at a fraction of the way from a row to the next.
    fn passage(&self, row: usize, part: f64, which: usize) -> Option<Passage> {
        let of = |row: usize| {
            let found = &self.rows[row];
            let (value, error) = match which {
                0 => (found.slider_force?, found.slider_force_se?),
                _ => (found.crank_torque?, found.crank_torque_se?),
            };
            let shared = match self.cycle {
                0 => self.shared.with(row, [0.0; 2])[which],
                _ => error,
            };
            Some([value, error, shared])
        };
        let (a, b) = (of(row)?, of(row + 1)?);
        let [value, error, shared] = std::array::from_fn(|k| a[k] + part * (b[k] - a[k]));
        Some(Passage {
            value,
            error,
            shared,
        })
    }
}
