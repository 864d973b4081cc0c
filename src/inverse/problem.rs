//! The linear model of a record about a path, and its smoothed motion.

use std::ops::{Range, RangeInclusive};

use super::condensed::Condensed;
use super::estimate::Estimate;
use super::grid::{Course, Grid, Path};
use super::intensity::{Span, factor_at};
use super::likelihood::Linear;
use super::measurement_model::Scale;
use super::model::harmonics::{Increments, ways};
use super::model::kalman;
use super::model::linearised::{Motion, Node};
use super::model::matrix::Matrix;
use super::model::prior::Prior;
use super::model::regressors::Regressors;
use super::model::state_space::Stretch;
use super::record::Record;
use super::scales::{Noise, Scales};
use super::smoother::Smoothed;
use crate::mechanism::Equation;
use crate::numeric::hermite::between;
use crate::numeric::parallel;
use crate::numeric::stop::Stop;

/// A record with its nodes and the equation of its mechanism.
#[derive(Debug)]
pub(super) struct Problem<'a> {
    pub record: Record<'a>,
    /// Samples that have the means of the record in their place, if there are any.
    pub condensed: Option<Condensed<'a>>,
    pub grid: Grid,
    /// Whether the samples, if not codes, were computed.
    pub computed: bool,
    pub equation: &'a Equation,
    /// Stretches with another intensity of the process noise.
    pub intensities: Vec<Span>,
    /// Request to stop; results are invalid then.
    pub stop: Option<&'a Stop>,
}

/// Most nodes by which hyper-parameters are estimated.
pub(super) const MOST_NODES: usize = 6000;

impl<'a> Problem<'a> {
    /// Returns the smoothed motion at a time: between nodes u beside what follows θ and ω is interpolated, the acceleration
    /// is the equation's.
    pub fn at(&self, smoothed: &Smoothed, t: f64) -> Estimate {
        let estimates = &smoothed.estimates;
        let a = self.grid.before(t);
        let times = [self.grid.times[a], self.grid.times[a + 1]];
        let part = (t - times[0]) / (times[1] - times[0]);
        let (a, b) = (&estimates[a], &estimates[a + 1]);
        if part == 0.0 || part == 1.0 {
            return if part == 0.0 { *a } else { *b };
        }
        let [theta, omega] = between(times, [a.motion(), b.motion()], t);
        let torque = smoothed.repeating.as_ref();
        let follows = |theta, omega| {
            let repeated = torque.map_or(0.0, |torque| torque.at(theta, omega)[0]);
            smoothed.prior.of_speed(&a.state, omega)[0] + repeated
        };
        let [before, after] = [a, b].map(|e| follows(e.state[0], e.state[1]));
        let rest = a.state[2] - before + part * (b.state[2] - after - (a.state[2] - before));
        let unknown = rest + follows(theta, omega);
        let motion = self.motion(smoothed.prior);
        // Beyond the ends as at the ends.
        let part = part.clamp(0.0, 1.0);
        let between = |k: usize| a.covariance[k] + part * (b.covariance[k] - a.covariance[k]);
        let mut state = a.state;
        [state[0], state[1], state[2]] = [theta, omega, unknown];
        Estimate {
            state,
            alpha: motion.acceleration(t, theta, omega, unknown)[0],
            covariance: std::array::from_fn(between),
            innovation: f64::NAN,
        }
    }

    /// The samples that may have means in their place.
    pub fn single(&self) -> &Record<'a> {
        self.condensed
            .as_ref()
            .map_or(&self.record, |condensed| &condensed.record)
    }

    /// The samples that may have means in their place.
    pub fn single_mut(&mut self) -> &mut Record<'a> {
        match &mut self.condensed {
            None => &mut self.record,
            Some(condensed) => &mut condensed.record,
        }
    }

    /// True if the samples were computed.
    pub fn is_computed(&self) -> bool {
        self.computed && self.record.codes.is_none()
    }

    /// Returns the record less its codes by another mechanism and scale of the sensor, shifted by a zero, rad.
    pub fn moved<'b>(&'b self, equation: &'b Equation, scale: Scale, zero: f64) -> Problem<'b> {
        Problem {
            record: self.record.moved(equation.linkage(), scale, zero),
            condensed: None,
            grid: self.grid.clone(),
            computed: self.computed,
            equation,
            intensities: self.intensities.clone(),
            stop: self.stop,
        }
    }

    /// Leaves out all but a range of nodes; returns the number of their samples.
    pub fn keep(&mut self, nodes: RangeInclusive<usize>) -> usize {
        let (begin, end) = nodes.into_inner();
        let samples = self.grid.first[begin]..self.grid.first[end + 1];
        self.record.keep(samples.clone());
        self.grid.times = self.grid.times[begin..=end].to_vec();
        let first = self.grid.first[begin..=end + 1].iter();
        self.grid.first = first.map(|sample| sample - samples.start).collect();
        match self.condensed.take() {
            Some(Condensed { blocks, .. }) => {
                blocks.first[samples.end] - blocks.first[samples.start]
            }
            None => samples.len(),
        }
    }

    /// True if a stop is requested.
    pub fn is_stopped(&self) -> bool {
        self.stop.is_some_and(Stop::is_requested)
    }

    pub fn motion(&self, prior: Prior) -> Motion<'_> {
        Motion {
            equation: self.equation,
            prior,
            origin: self.record.origin,
            tones: &self.record.tones,
        }
    }

    /// The linear model of a stretch of nodes about a path.
    pub fn stretch(&self, prior: Prior, path: &Path, range: Range<usize>, sigma: f64) -> Stretch {
        let motion = self.motion(prior);
        let times = &self.grid.times[range.clone()];
        let states = path.part(&range);
        let torque = path.repeating.as_ref();
        let nodes = parallel::list(times.len(), |k| {
            let (t, state) = (times[k], &states[k]);
            Node {
                t,
                state,
                rates: motion.rates_following(torque, t, state),
                repeated: torque.map_or(0.0, |torque| torque.at(state[0], state[1])[0]),
            }
        });
        let mut steps = parallel::list(times.len().saturating_sub(1), |k| {
            let (begin, end) = (&nodes[k], &nodes[k + 1]);
            motion.linearised(begin, end, torque)
        });
        let middles = times.windows(2).map(|ends| 0.5 * (ends[0] + ends[1]));
        let intensities = middles.map(|t| factor_at(&self.intensities, t));
        let mut increments = Increments::default();
        if prior.cycle > 0 {
            increments = Increments::new(ways(states, &steps, path.speed()), prior);
            if let Some(known) = torque {
                increments.take_out(&known.coefficients, &mut steps);
            }
        }
        let course = nodes.iter().map(Node::motion);
        let course = Course {
            grid: &self.grid,
            first: range.start,
            motion: course.collect(),
        };
        let observed = parallel::list(range.len(), |k| {
            self.record.observed(&course, range.start + k, sigma)
        });
        let constants = states.first().map_or([0.0; 2], |first| {
            let known = |k| first[prior.diffuse() + k];
            [0, 1].map(|k| if k < prior.powers { known(k) } else { 0.0 })
        });
        // A part of the record does not tell a tone.
        let tones = match range.len() == self.grid.len() {
            true => self.regressors(&self.record.tones, prior, range.clone(), states),
            false => Regressors::default(),
        };
        Stretch {
            tones: tones.into(),
            steps: steps.into(),
            intensities: intensities.collect(),
            constants,
            increments,
            observed: observed.into(),
        }
    }

    /// The ranges of nodes by which hyper-parameters are estimated: all, or of long records a few stretches.
    pub fn sampled(&self) -> Vec<Range<usize>> {
        const STRETCHES: usize = 4;
        let nodes = self.grid.len();
        if nodes <= MOST_NODES {
            return self.all();
        }
        let length = MOST_NODES / STRETCHES;
        let begin = |part: usize| (nodes - length) * part / (STRETCHES - 1);
        (0..STRETCHES)
            .map(|part| begin(part)..begin(part) + length)
            .collect()
    }

    /// The range of all nodes.
    pub fn all(&self) -> Vec<Range<usize>> {
        std::iter::once(0..self.grid.len()).collect()
    }

    /// The linear model of a prior about a path, along the stretches for the estimate of hyper-parameters.
    pub fn linear(&self, prior: Prior, scales: Scales, path: &Path, sigma: f64) -> Linear {
        let ranges = self.sampled().into_iter().filter(|_| !self.is_stopped());
        let of = |range| self.stretch(prior, path, range, sigma);
        Linear {
            stretches: parallel::map(ranges, of).into(),
            ..Linear::of(prior, scales)
        }
    }

    /// Returns the motion at nodes from the first of a piece, with the deviations of a path from it.
    pub fn estimated<const N: usize>(
        &self,
        prior: Prior,
        path: &Path,
        from: usize,
        deviations: &[kalman::Gaussian<N>],
        innovations: &[Option<f64>],
        noise: &Noise,
    ) -> Vec<Estimate> {
        let motion = self.motion(prior);
        let states = path.part(&(from..from + deviations.len()));
        let variance = noise.sigma * noise.sigma;
        let dimension = prior.states();
        let torque = path.repeating.as_ref();
        let known = torque.filter(|_| prior.cycle == 0);
        let beside = known.map_or([[0.0; 3]; 3], |known| known.covariance);
        parallel::list(deviations.len(), |at| {
            let (deviation, mut state) = (&deviations[at], states[at]);
            // The model has the deviation of u less what follows θ and ω.
            let slopes = motion.slopes(torque, &state);
            state[2] += (0..2).map(|k| slopes[k] * deviation.mean[k]).sum::<f64>();
            let pairs = state.iter_mut().zip(&deviation.mean).take(dimension);
            pairs.for_each(|(value, change)| *value += change);
            let rates = motion.rates_following(torque, self.grid.times[from + at], &state);
            let gradient = [rates.by_theta, rates.by_omega, rates.by_unknown];
            let p: Matrix<3> = std::array::from_fn(|i| {
                std::array::from_fn(|k| variance * deviation.covariance[i][k] + beside[i][k])
            });
            let across: [f64; 3] =
                std::array::from_fn(|i| (0..3).map(|k| p[i][k] * gradient[k]).sum::<f64>());
            let own: f64 = (0..3).map(|k| gradient[k] * across[k]).sum();
            Estimate {
                state,
                alpha: rates.alpha,
                covariance: [p[0][0], p[0][1], p[1][1], across[0], across[1], own],
                innovation: innovations[at].map_or(f64::NAN, |value| value / noise.sigma),
            }
        })
    }
}
