//! Likelihood of a motion through the equation, by a window of its samples.

use std::f64::consts::TAU;
use std::ops::Range;

use super::super::measurement_model::Scale;
use super::super::problem::Problem;
use super::super::samples::Given;
use super::super::smoother::Smoothed;
use super::branch_tracking::{CrankAngles, EARLY, LARGEST_VALUE_ERROR};
use super::mirror_image::Imaged;
use crate::mechanism::Equation;
use crate::numeric::parallel;
use crate::numeric::stop::Stop;
use crate::scene::{Measurement, Motion};

/// Samples of several motions, and the scene by which these are judged.
#[derive(Clone, Copy, Debug)]
pub(in crate::inverse) struct Windows<'e> {
    pub measurement: &'e Measurement,
    pub equation: &'e Equation,
    /// Motion of the scene.
    pub motion: &'e Motion,
    pub stop: Option<&'e Stop>,
}

/// What a window of samples says of a motion.
#[derive(Clone, Copy, Debug)]
pub(in crate::inverse) struct Judged {
    /// ln of the marginal likelihood by the likeliest prior, less the cost of zero and gain.
    pub likelihood: f64,
    /// Crank angle at the first sample, rad.
    pub begin: f64,
    /// Sense of rotation (±1) where the speed first exceeds half of the scene's; if it never does, over the first
    /// quarter of a turn.
    pub sense: f64,
}

impl Windows<'_> {
    /// Returns the samples about one at which two motions part, or the first ones.
    pub fn about(&self, fork: Option<usize>) -> Range<usize> {
        let all = self.measurement.len();
        let count = EARLY.min(all);
        let begin = fork.unwrap_or(0).saturating_sub(count / 2).min(all - count);
        begin..begin + count
    }

    /// Judges motions and their images by a window of samples, the same for all: without those that the sensor holds for the first
    /// one, and without those that are far off from each.
    pub fn judged(&self, motions: &[&Imaged<'_>], window: &Range<usize>) -> Vec<[Judged; 2]> {
        // The likelihood of an incomplete image is unknown: the motion's own stands for it.
        let angles = motions.iter().flat_map(|one| match one.leaves {
            None => [&one.angles, &one.image],
            Some(_) => [&one.angles; 2],
        });
        let angles: Vec<&CrankAngles<'_>> = angles.collect();
        let mut seen = parallel::map(angles.iter(), |angles| self.smoothed(angles, window));
        let (problem, kinematic) = &mut seen[0];
        let holds = problem.finds_held(kinematic);
        let told = parallel::map(seen.iter_mut(), |(problem, kinematic)| {
            if holds {
                problem.set_held(true, kinematic);
                *kinematic = problem.kinematic(kinematic.path(), kinematic.noise.sigma);
            }
            *kinematic = problem.without_outliers(kinematic.clone());
            problem.record.weights.clone()
        });
        let most = |i: usize| told.iter().map(|weights| weights[i]).fold(0.0, f64::max);
        let weights: Vec<f64> = (0..window.len()).map(most).collect();
        let seen = seen.iter_mut().zip(angles);
        let judged = parallel::map(seen, |((problem, kinematic), angles)| {
            if problem.weigh(weights.clone(), kinematic) {
                *kinematic = problem.kinematic(kinematic.path(), kinematic.noise.sigma);
            }
            self.of(problem, kinematic, angles, window)
        });
        let pairs = judged.chunks_exact(2).zip(motions);
        let pairs = pairs.map(|(pair, one)| {
            let (own, mut image) = (pair[0], pair[1]);
            if one.leaves.is_some() {
                (image.begin, image.sense) = (one.image.theta[0], -own.sense);
            }
            [own, image]
        });
        pairs.collect()
    }

    fn of(
        &self,
        problem: &Problem<'_>,
        kinematic: &Smoothed,
        angles: &CrankAngles<'_>,
        window: &Range<usize>,
    ) -> Judged {
        // A zero and a gain that are found from the samples cost ln of their width before over that after (MacKay, Neural
        // Computation 4 (1992) 415).
        let Scale { shift, stretch } = angles.sensor.scale;
        let found = f64::from(u8::from(shift != 0.0) + u8::from(stretch != 1.0));
        let width = LARGEST_VALUE_ERROR * angles.sensor.size();
        let cost = found * (width / angles.sigma).max(1.0).ln();
        let starts = window.start == 0;
        let begin = match starts {
            true => kinematic.estimates[0].state[0],
            false => angles.theta[0],
        };
        let far = |theta: &&f64| (**theta - begin).abs() > 0.25 * TAU;
        let way = angles.theta.iter().find(far).or(angles.theta.last());
        let speeds = kinematic.estimates.iter().map(|estimate| estimate.state[1]);
        let stated = speeds
            .take_while(|_| starts)
            .find(|speed| speed.abs() > 0.5 * self.motion.speed.abs());
        Judged {
            likelihood: problem.all_tried(kinematic).likelihood() - cost,
            begin,
            sense: stated
                .or(way.map(|way| way - begin))
                .map_or(0.0, f64::signum),
        }
    }

    fn smoothed<'b>(
        &'b self,
        angles: &'b CrankAngles<'b>,
        window: &Range<usize>,
    ) -> (Problem<'b>, Smoothed) {
        let given = Given {
            measurement: self.measurement,
            angles,
            equation: self.equation,
            stop: self.stop,
        };
        let mut record = given.record(&[]);
        record.keep(window.clone());
        let (problem, first) = given.problem(record, &angles.theta[window.clone()], 1);
        let kinematic = problem.kinematic(first, angles.sigma.max(problem.record.floor));
        (problem, kinematic)
    }
}
