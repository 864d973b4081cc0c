//! Conclusion of a run with a loose joint: summary, errors, reproducible horizon and warnings.

use std::f64::consts::TAU;

use super::super::energy_balance::EnergyBalance;
use super::super::passages;
use super::super::recorder::Record;
use super::super::result::Peaks;
use super::super::run_end::{Estimate, RunEnd};
use super::super::second_run::MARGIN;
use super::super::simulation::Simulation;
use super::super::warning::Warning;
use super::SecondRun;
use super::contact_follower::ContactFollower;
use super::journal_record::JournalRecord;
use super::motion::{DRIVEN, FREE, Loose, phi};
use super::result::{Beyond, ClearanceSummary, Horizon, LooseFinal};
use crate::engine::contact::ContactEnd;
use crate::mechanism::LooseState;
use crate::plan::Engine;
use crate::scene::Joint;
use crate::trajectory::Trajectory;

impl<const N: usize> Loose<'_, N> {
    /// Makes the result of a run that ended in the state `last`; `record` has its rows.
    pub(super) fn concluded(
        &self,
        ended: &ContactEnd<N>,
        seen: &ContactFollower<'_, N>,
        mut record: Record,
        last: &LooseState,
        wall_s: f64,
    ) -> Simulation {
        let task = self.task;
        let stopped = self.stopped(ended, last);
        let tighter = (task.options.estimate && stopped.is_none())
            .then(|| self.second_run(last.t))
            .flatten();
        let [work, lost] = self.work(&ended.last);
        let at_end = self.state(&ended.last);
        let gained = self.mechanism.energy(&at_end) - self.mechanism.energy(&self.start);
        let horizon = tighter.as_ref().map(|t| self.horizon(seen, t, last));
        let same = horizon.is_some_and(|h| h.whole_run);
        let against = tighter.as_ref().filter(|_| same).map(|t| &t.last);
        // Steps round independently of each other.
        let rounding = 8.0 * f64::EPSILON * (1.0 + ended.steps as f64).sqrt();
        let error = |value: fn(&LooseState) -> f64, size: f64| {
            against.map(|t| MARGIN * (value(t) - value(last)).abs() + rounding * size)
        };
        let struck = self.struck(seen, f64::EPSILON * self.reach, last.t);
        let summary = self.summary(
            seen,
            [work, lost],
            last,
            |value, length| Some(error(value, self.reach / length)? + struck / length),
            horizon,
        );
        let mut warnings = self.warnings(&summary, seen, tighter.is_some() || stopped.is_some());
        if N == DRIVEN {
            let (passages, count) = passages::at_constant_speed(task, last.t);
            record.events.extend(passages);
            record.events_total += count;
            record.events.sort_by(|a, b| a.t_s.total_cmp(&b.t_s));
            record.events.truncate(task.options.events_kept);
        }
        let at = self.crank(last);
        let theta = at.angle.radians().abs();
        let estimate = match N {
            DRIVEN => Some((2.0 * f64::EPSILON * theta, 0.0)),
            _ => error(|s| s.theta, 1.0 + theta).zip(error(|s| s.omega, 1.0 + last.omega.abs())),
        };
        if N == FREE && estimate.is_none() && task.options.estimate && stopped.is_none() {
            warnings.push(Warning::BeyondHorizon);
        }
        let peaks = seen.peaks.filter(|_| stopped.is_none()).map(Peaks::new);
        let end = RunEnd {
            engine: Engine::Contact,
            at,
            turned: last.theta - self.start.theta,
            estimate: estimate.map(|(theta, omega)| Estimate::of_end(theta, omega)),
            balance: EnergyBalance {
                residual: gained - work + lost,
                largest: seen.energy,
            },
            evaluations: ended.evaluations,
            steps: ended.steps,
            wall_s,
            warnings,
            stopped,
            record,
        };
        let mut run = end.conclude(task);
        let result = &mut run.summary;
        result.estimate_cost = tighter.map(|t| t.cost);
        (result.peaks, result.clearance) = (peaks, Some(summary));
        if N == DRIVEN {
            let motion = Trajectory::uniform(task.start(), self.start.omega, last.t);
            run.trajectory = Some(motion);
        }
        run
    }

    /// Finds the time up to which the journal follows the tighter run, with the statistics of both runs beyond it.
    fn horizon(
        &self,
        seen: &ContactFollower<'_, N>,
        tighter: &SecondRun,
        end: &LooseState,
    ) -> Horizon {
        let distance = 0.01 * self.mechanism.clearance.radial;
        let parted = seen.journal.agrees_until(&tighter.record, distance);
        let t = parted.unwrap_or(end.t);
        let statistics = |record: &JournalRecord| {
            let (tally, from) = record.since(t);
            tally.statistics(from, end.t)
        };
        Horizon {
            t_s: t,
            // The mean speed suffices for a number of turns.
            revolutions: match end.t > 0.0 {
                true => ((end.theta - self.start.theta) * t / end.t).abs() / TAU,
                false => 0.0,
            },
            whole_run: parted.is_none(),
            beyond: parted.map(|_| Beyond {
                run: statistics(&seen.journal),
                tighter: statistics(&tighter.record),
            }),
        }
    }

    /// Returns the error of the slider position (m) that an error of the gap (m) causes through the impacts up to time
    /// t, s. In the deepest impact, of depth δ and force F, the energy 2Fδ/5 stops the free bodies of mass m,
    /// v = √(4Fδ/5m), and returns them about as fast. The relative error of the force, and of the change 2v of
    /// velocity, is 3/2 of that of the depth; the next impact ends it.
    fn struck(&self, seen: &ContactFollower<'_, N>, gap: f64, t: f64) -> f64 {
        let scene = &self.task.scene;
        let slider = scene.slider.map_or(0.0, |slider| slider.mass);
        let mass = match self.mechanism.clearance.joint {
            Joint::WristPin => slider,
            Joint::CrankPin => slider + scene.rod.map_or(0.0, |rod| rod.mass),
        };
        let (force, depth) = (seen.total.peak, seen.total.deepest);
        if seen.separations == 0 || depth == 0.0 || mass == 0.0 {
            return 0.0;
        }
        let change = 2.0 * (0.8 * force * depth / mass).sqrt();
        1.5 * gap / depth * change * t / seen.separations as f64
    }

    fn summary(
        &self,
        seen: &ContactFollower<'_, N>,
        [work, lost]: [f64; 2],
        last: &LooseState,
        error: impl Fn(fn(&LooseState) -> f64, f64) -> Option<f64>,
        horizon: Option<Horizon>,
    ) -> ClearanceSummary {
        let clearance = &self.mechanism.clearance;
        let whole = seen.total.statistics(0.0, last.t);
        let linked = self.mechanism.is_linked();
        ClearanceSummary {
            joint: clearance.joint.name(),
            contact_law: clearance.law.name(),
            radial_m: clearance.radial,
            stiffness_n_per_m_1_5: (!linked).then_some(self.mechanism.force.stiffness),
            impacts: whole.impacts,
            separations: seen.separations,
            contact_share: whole.contact_share,
            drawn_share: (linked && last.t > 0.0).then(|| seen.total.drawn / last.t),
            force_peak_n: whole.force_peak_n,
            force_mean_n: whole.force_mean_n,
            penetration_peak_m: seen.total.deepest,
            dissipated_j: lost,
            work_j: work,
            last: LooseFinal {
                x_m: last.x,
                v_m_per_s: last.v,
                phi_rad: phi(last.psi, self.task.scene.geometry.branch.sign()),
                error_x_m: error(|s| s.x, 1.0),
                error_phi_rad: error(|s| s.psi, self.task.scene.geometry.rod),
            },
            horizon,
        }
    }

    fn warnings(
        &self,
        summary: &ClearanceSummary,
        seen: &ContactFollower<'_, N>,
        compared: bool,
    ) -> Vec<Warning> {
        let unknown = self.task.options.estimate && !compared;
        let parted = summary.horizon.filter(|horizon| !horizon.whole_run);
        let deepest = seen.total.deepest;
        let deep = deepest > summary.radial_m;
        let drawn = summary.drawn_share.filter(|share| *share > 0.0);
        [
            unknown.then_some(Warning::NoHorizon),
            parted.map(|horizon| Warning::HorizonAt {
                t: horizon.t_s,
                turns: horizon.revolutions,
            }),
            deep.then_some(Warning::DeepContact(deepest)),
            drawn.map(Warning::DrawnLink),
        ]
        .into_iter()
        .flatten()
        .collect()
    }
}
