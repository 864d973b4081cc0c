//! The smoothed motion: Gauss-Newton iterations of the linear smoother about the last path (iterated extended smoother), the
//! prior chosen by marginal likelihood.

use super::kalman;
use super::likelihood::{Linear, Noise, Scales, Stretch};
use super::measurement_model::Sensor;
use super::residual_tests::Whiteness;
use super::state_space::{Deviations, Motion, Observed, Prior, Rates, State, Unknown};
use crate::mechanism::Equation;
use crate::numeric::parallel;

/// Samples with the crank angles that they were read as.
#[derive(Clone, Debug)]
pub(super) struct Record<'a> {
    pub sensor: Sensor<'a>,
    /// Times, s, rising.
    pub times: &'a [f64],
    /// Measured values, rad or m; a crank angle continued over the turns.
    pub values: Vec<f64>,
    /// Weight of each sample: 0 for none, 1 for a full one.
    pub weights: Vec<f64>,
    /// Least standard deviation of a sample, rad or m.
    pub floor: f64,
    /// Time of the scene at time 0 of the record, s.
    pub origin: f64,
}

/// Nodes of the path with their samples.
#[derive(Clone, Debug, Default)]
pub(super) struct Grid {
    /// Times, s.
    pub times: Vec<f64>,
    /// First sample of each node, and at the end the number of samples: a node has those up to the next one's first.
    pub first: Vec<usize>,
}

/// A path: the nominal one of a linear model.
#[derive(Clone, Debug)]
pub(super) struct Path {
    /// One for each node.
    pub states: Vec<State>,
    /// Variance of the crank angle, rad², where the samples are so curved in it that it counts.
    pub variances: Option<Vec<f64>>,
}

/// The smoothed motion at a node.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Estimate {
    pub state: State,
    /// θ, ω, θ̈.
    pub motion: [f64; 3],
    /// Their covariance: 00, 01, 11, 02, 12, 22.
    pub covariance: [f64; 6],
    /// Prediction error of the samples of the node over its standard deviation; not a number without samples.
    pub innovation: f64,
}

/// Largest way of the crank from node to node, rad.
const LONGEST: f64 = 0.12;

/// Nodes that one thread smooths at a time, at least, beside those at both ends that are shared with its neighbours.
const PIECE: usize = 8192;

/// Time constants of the smoother after which nothing is left of what was before.
const FORGOTTEN: f64 = 60.0;

impl Grid {
    /// Nodes at the samples and between those that are far apart.
    pub fn new(times: &[f64], angles: &[f64]) -> Grid {
        let mut grid = Grid::default();
        for (i, t) in times.iter().enumerate() {
            grid.times.push(*t);
            grid.first.push(i);
            let Some(next) = times.get(i + 1) else { break };
            let parts = ((angles[i + 1] - angles[i]).abs() / LONGEST)
                .ceil()
                .clamp(1.0, 1e4);
            for k in 1..parts as usize {
                grid.times.push(t + (next - t) * k as f64 / parts);
                grid.first.push(i + 1);
            }
        }
        grid.first.push(times.len());
        grid
    }

    pub fn len(&self) -> usize {
        self.times.len()
    }
}

impl Record<'_> {
    /// What the samples of a node show beside a nominal state.
    fn observed(&self, grid: &Grid, path: &Path, node: usize, sigma: f64) -> Observed {
        let none = Observed {
            variance: f64::INFINITY,
            ..Observed::default()
        };
        let range = grid.first[node]..grid.first[node + 1];
        let theta = path.states[node][0];
        let (mut weight, mut sum, mut slope) = (0.0, 0.0, 0.0);
        for i in range {
            let (residual, shown) = self.sensor.residual(self.values[i], theta);
            let mut precision = self.weights[i];
            if let Some(variances) = &path.variances {
                // What the curvature of h leaves beside its tangent.
                let bent = 0.5 * shown.curvature * variances[node] / sigma;
                precision /= 1.0 + precision * 2.0 * bent * bent;
            }
            if !(precision > 0.0 && residual.is_finite() && shown.slope.is_finite()) {
                continue;
            }
            weight += precision;
            sum += precision * residual;
            slope += precision * shown.slope;
        }
        if weight == 0.0 {
            return none;
        }
        Observed {
            residual: sum / weight,
            slope: slope / weight,
            variance: 1.0 / weight,
        }
    }
}

/// A record with its nodes and the equation of its mechanism.
#[derive(Debug)]
pub(super) struct Problem<'a> {
    pub record: Record<'a>,
    pub grid: Grid,
    pub equation: &'a Equation,
}

impl<'a> Problem<'a> {
    /// The node of a sample.
    pub fn node_of(&self, sample: usize) -> usize {
        self.grid.first.partition_point(|first| *first <= sample) - 1
    }

    pub fn motion(&self, prior: Prior) -> Motion<'a> {
        Motion {
            equation: self.equation,
            prior,
            origin: self.record.origin,
        }
    }

    /// The linear model of a stretch of nodes about a path.
    fn stretch(
        &self,
        motion: &Motion<'_>,
        path: &Path,
        range: std::ops::Range<usize>,
        sigma: f64,
    ) -> Stretch {
        let times = &self.grid.times;
        let rates: Vec<Rates> = range
            .clone()
            .map(|k| motion.rates(times[k], &path.states[k]))
            .collect();
        let steps = (range.start..range.end - 1).map(|k| {
            let at = k - range.start;
            let ends = [&path.states[k], &path.states[k + 1]];
            motion.linearised([times[k], times[k + 1]], ends, [&rates[at], &rates[at + 1]])
        });
        Stretch {
            steps: steps.collect(),
            observed: range
                .clone()
                .map(|k| self.record.observed(&self.grid, path, k, sigma))
                .collect(),
        }
    }

    /// The ranges of nodes by which hyper-parameters are estimated: all, or of long records a few stretches.
    fn sampled(&self) -> Vec<std::ops::Range<usize>> {
        const MOST: usize = 6000;
        const PARTS: usize = 4;
        let nodes = self.grid.len();
        if nodes <= MOST {
            return std::iter::once(0..nodes).collect();
        }
        let length = MOST / PARTS;
        let begin = |part: usize| (nodes - length) * part / (PARTS - 1);
        (0..PARTS)
            .map(|part| begin(part)..begin(part) + length)
            .collect()
    }

    /// Stretches of the linear model for the estimate of hyper-parameters.
    pub fn stretches(&self, motion: &Motion<'_>, path: &Path, sigma: f64) -> Vec<Stretch> {
        let ranges = self.sampled();
        ranges
            .into_iter()
            .map(|range| self.stretch(motion, path, range, sigma))
            .collect()
    }

    /// Typical sizes along a path with a prior.
    pub fn scales(&self, motion: &Motion<'_>, path: &Path, slope: f64, shape: [f64; 2]) -> Scales {
        let times = &self.grid.times;
        let duration = times[times.len() - 1] - times[0];
        let samples = self.record.times.len() as f64;
        let stride = times.len().div_ceil(1000);
        let (mut lever, mut count) = (0.0, 0.0);
        for k in (0..times.len()).step_by(stride) {
            let state = &path.states[k];
            let rates = motion.rates(times[k], state);
            let tempo = if motion.prior.per_angle {
                state[1].abs()
            } else {
                1.0
            };
            if rates.by_unknown.is_finite() {
                lever += rates.by_unknown * rates.by_unknown * tempo;
                count += 1.0;
            }
        }
        Scales {
            spacing: duration / (samples - 1.0),
            duration,
            slope,
            lever: (lever / count).sqrt(),
            motion: shape,
            floor: self.record.floor,
        }
    }

    /// The smoothed motion, in pieces side by side.
    pub fn smoothed(
        &self,
        motion: &Motion<'_>,
        path: &Path,
        scales: Scales,
        noise: &Noise,
    ) -> Vec<Estimate> {
        let nodes = self.grid.len();
        let times = &self.grid.times;
        let shared = FORGOTTEN / noise.corner;
        let density = nodes as f64 / scales.duration;
        let length = PIECE.max((4.0 * shared * density).min(nodes as f64) as usize);
        let pieces = nodes.div_ceil(length);
        let job = |piece: usize| {
            let core = nodes * piece / pieces..nodes * (piece + 1) / pieces;
            let from = times.partition_point(|t| *t < times[core.start] - shared);
            let to = times.partition_point(|t| *t <= times[core.end - 1] + shared);
            let stretch = self.stretch(motion, path, from..to, noise.sigma);
            let linear = Linear {
                stretches: &[],
                order: motion.prior.order,
                scales,
            };
            let model = linear.deviations(&stretch, noise);
            let mut all = self.estimates(motion, path, from, &model, noise);
            all.truncate(core.end - from);
            all.drain(..core.start - from);
            all
        };
        parallel::map(0..pieces, job).concat()
    }

    fn estimates(
        &self,
        motion: &Motion<'_>,
        path: &Path,
        from: usize,
        model: &Deviations<'_>,
        noise: &Noise,
    ) -> Vec<Estimate> {
        match (model.order, model.correlated) {
            (1, None) => self.estimated::<3>(motion, path, from, model, noise),
            (1, Some(_)) | (2, None) => self.estimated::<4>(motion, path, from, model, noise),
            _ => self.estimated::<5>(motion, path, from, model, noise),
        }
    }

    fn estimated<const N: usize>(
        &self,
        motion: &Motion<'_>,
        path: &Path,
        from: usize,
        model: &Deviations<'_>,
        noise: &Noise,
    ) -> Vec<Estimate> {
        let (deviations, innovations) = kalman::smooth::<N>(model);
        let variance = noise.sigma * noise.sigma;
        let dimension = 2 + model.order;
        let estimate =
            |(at, (deviation, innovation)): (usize, (&kalman::Gaussian<N>, &Option<f64>))| {
                let mut state = path.states[from + at];
                for k in 0..dimension {
                    state[k] += deviation.mean[k];
                }
                let rates = motion.rates(self.grid.times[from + at], &state);
                let gradient = [rates.by_theta, rates.by_omega, rates.by_unknown];
                let p = &deviation.covariance;
                let across: [f64; 3] =
                    std::array::from_fn(|i| (0..3).map(|k| p[i][k] * gradient[k]).sum::<f64>());
                let own: f64 = (0..3).map(|k| gradient[k] * across[k]).sum();
                let covariance = [p[0][0], p[0][1], p[1][1], across[0], across[1], own];
                Estimate {
                    state,
                    motion: [state[0], state[1], rates.alpha],
                    covariance: covariance.map(|value| value * variance),
                    innovation: innovation.map_or(f64::NAN, |value| value / noise.sigma),
                }
            };
        deviations
            .iter()
            .zip(&innovations)
            .enumerate()
            .map(estimate)
            .collect()
    }
}

/// A smoothed motion with its prior and noise.
#[derive(Clone, Debug)]
pub(super) struct Smoothed {
    pub prior: Prior,
    pub noise: Noise,
    pub scales: Scales,
    pub estimates: Vec<Estimate>,
    /// Whether the iterations came to rest.
    pub settled: bool,
}

/// The prior without mechanics: a smoothing spline of degree seven in state-space form.
pub(super) const KINEMATIC: Prior = Prior {
    unknown: Unknown::Acceleration,
    order: 2,
    per_angle: false,
};

/// Priors through the equation of motion.
pub(super) const MECHANICAL: [Prior; 4] = [
    Prior {
        unknown: Unknown::Torque,
        order: 1,
        per_angle: false,
    },
    Prior {
        unknown: Unknown::Torque,
        order: 2,
        per_angle: false,
    },
    Prior {
        unknown: Unknown::Force,
        order: 1,
        per_angle: false,
    },
    Prior {
        unknown: Unknown::Force,
        order: 2,
        per_angle: false,
    },
];

/// Most iterations of Gauss and Newton.
const ITERATIONS: usize = 12;

/// Change of the path, in its standard errors, at which the iterations have come to rest.
const AT_REST: f64 = 0.01;

impl Problem<'_> {
    /// Root mean square of d measured/dθ.
    fn slope(&self, path: &Path) -> f64 {
        let stride = path.states.len().div_ceil(1000);
        let slopes = path.states.iter().step_by(stride);
        let slopes = slopes.map(|state| self.record.sensor.shown(state[0]).slope.powi(2));
        let (sum, count) = slopes
            .filter(|s| s.is_finite())
            .fold((0.0, 0.0), |(s, n), x| (s + x, n + 1.0));
        (sum / f64::max(count, 1.0)).sqrt()
    }

    /// The motion without mechanics, from a first path.
    pub fn kinematic(&self, mut path: Path, sigma: f64) -> Smoothed {
        let motion = self.motion(KINEMATIC);
        let slope = self.slope(&path);
        // The start of this prior is compared with others only once the motion is known.
        let mut shape = [1.0, 1.0];
        let mut best: Option<Smoothed> = None;
        let is_linear = self.record.sensor.measured == crate::scene::Measured::Theta;
        let mut sigma = sigma;
        for iteration in 0..ITERATIONS {
            let scales = self.scales(&motion, &path, slope, shape);
            let stretches = self.stretches(&motion, &path, sigma);
            let linear = Linear {
                stretches: &stretches,
                order: 2,
                scales,
            };
            let noise = match &best {
                Some(last) if iteration < 3 || is_linear => {
                    linear.maximised(last.noise.corner, None)
                }
                Some(last) => linear.maximised(last.noise.corner, None),
                None => linear.anywhere(),
            };
            let estimates = self.smoothed(&motion, &path, scales, &noise);
            let change = change(&estimates, &path);
            sigma = noise.sigma;
            path = Path {
                states: estimates.iter().map(|e| e.state).collect(),
                variances: (!is_linear)
                    .then(|| estimates.iter().map(|e| e.covariance[0]).collect()),
            };
            let rms = |k: usize| {
                (estimates.iter().map(|e| e.state[k].powi(2)).sum::<f64>() / estimates.len() as f64)
                    .sqrt()
            };
            shape = [rms(2).max(f64::MIN_POSITIVE), rms(3).max(f64::MIN_POSITIVE)];
            let settled = change < AT_REST || is_linear;
            best = Some(Smoothed {
                prior: KINEMATIC,
                noise,
                scales,
                estimates,
                settled,
            });
            // A second pass takes what is lost to rounding about a straight line.
            if change < AT_REST || is_linear && iteration > 0 {
                break;
            }
        }
        let Some(mut found) = best else {
            unreachable!("at least one iteration")
        };
        found.scales.motion = shape;
        found
    }

    /// The states of a prior along a smoothed motion.
    pub fn path_of(&self, prior: Prior, from: &Smoothed) -> Path {
        let r = self.equation.linkage().r;
        let states = parallel::list(from.estimates.len(), |k| {
            let [theta, omega, alpha] = from.estimates[k].motion;
            let terms = self.equation.terms(theta);
            let t = self.record.origin + self.grid.times[k];
            let known = self.equation.loads().value(t, theta, omega, &terms.pose);
            let torque = self.equation.generalized_force(&terms, omega, alpha)
                - known.generalized(&terms.pose);
            let dx = terms.pose.dx;
            let unknown = match prior.unknown {
                Unknown::Acceleration => alpha,
                Unknown::Torque => torque,
                Unknown::Force => torque * dx / (dx * dx + 0.01 * r * r),
            };
            [theta, omega, unknown, 0.0]
        });
        let variances = match self.record.sensor.measured {
            crate::scene::Measured::Theta => None,
            _ => Some(from.estimates.iter().map(|e| e.covariance[0]).collect()),
        };
        Path { states, variances }
    }

    /// A prior about a smoothed path.
    fn candidate(&self, prior: Prior, from: &Smoothed, correlated: bool) -> Candidate {
        let motion = self.motion(prior);
        let path = self.path_of(prior, from);
        let scales = self.scales(&motion, &path, from.scales.slope, from.scales.motion);
        let stretches = self.stretches(&motion, &path, from.noise.sigma);
        let linear = Linear {
            stretches: &stretches,
            order: prior.order,
            scales,
        };
        let mut noise = linear.maximised(from.noise.corner, None);
        if correlated {
            let found = linear.correlated(&noise);
            // Noise that leaves the path rougher than white noise does is motion.
            let rougher = found.corner > noise.corner;
            noise = if rougher { noise } else { found };
        }
        if std::env::var("MIX").is_ok() && prior.order == 2 {
            noise = linear.mixed(&noise);
        }
        Candidate {
            prior,
            noise,
            scales,
            path,
        }
    }

    /// The smoothed motion with the likeliest prior, and all that were tried with the ln of their likelihoods, the likeliest
    /// first. Noise of the samples is correlated where the prediction errors say so, and the likelihood agrees.
    pub fn likeliest(&self, kinematic: Smoothed) -> (Smoothed, Vec<(Prior, f64)>) {
        let white = self.tried(&kinematic, false);
        let Some(found) = self.first_settled(&white) else {
            return (kinematic, listed(&white));
        };
        let innovations = found.estimates.iter().map(|e| e.innovation);
        let is_noise = found.noise.sigma > 1.5 * self.record.floor;
        if is_noise && Whiteness::of(innovations).is_violated() {
            let correlated = self.tried(&kinematic, true);
            // Two parameters more (Schwarz 1978).
            let cost = (self.record.times.len() as f64).ln();
            let gain = |tried: &[Candidate]| {
                tried
                    .first()
                    .map_or(f64::NEG_INFINITY, |c| c.noise.likelihood)
            };
            if gain(&correlated) > gain(&white) + cost
                && let Some(found) = self.first_settled(&correlated)
            {
                return (found, listed(&correlated));
            }
        }
        (found, listed(&white))
    }

    /// All priors about a path, the likeliest first.
    fn tried(&self, kinematic: &Smoothed, correlated: bool) -> Vec<Candidate> {
        let priors: Vec<Prior> = std::iter::once(KINEMATIC).chain(MECHANICAL).collect();
        let tried = parallel::map(priors.iter(), |prior| {
            Some(self.candidate(*prior, kinematic, correlated))
        });
        let mut tried: Vec<_> = tried.into_iter().flatten().collect();
        tried.sort_by(|a, b| b.noise.likelihood.total_cmp(&a.noise.likelihood));
        tried
    }

    /// The smoothed motion with the first prior whose iterations come to rest.
    fn first_settled(&self, tried: &[Candidate]) -> Option<Smoothed> {
        let smoothed = tried.iter().map(|candidate| self.iterated(candidate));
        smoothed.into_iter().find(|found| found.settled)
    }

    /// The smoothed motion with a prior, about paths that approach it.
    fn iterated(&self, candidate: &Candidate) -> Smoothed {
        let Candidate {
            prior,
            mut noise,
            scales,
            mut path,
        } = candidate.clone();
        let motion = self.motion(prior);
        let mut result = Smoothed {
            prior,
            noise,
            scales,
            estimates: Vec::new(),
            settled: false,
        };
        for iteration in 0..ITERATIONS {
            if iteration > 0 {
                let stretches = self.stretches(&motion, &path, noise.sigma);
                let linear = Linear {
                    stretches: &stretches,
                    order: prior.order,
                    scales,
                };
                if std::env::var("MIX").is_ok() && prior.order == 2 {
                    if iteration < 3 {
                        noise = linear.mixed(&noise);
                    }
                } else {
                    noise = linear.maximised(noise.corner, noise.correlated);
                    if prior.order == 2 && std::env::var("NOLEVEL").is_err() {
                        noise = linear.with_level(&noise);
                    }
                }
            }
            let estimates = self.smoothed(&motion, &path, scales, &noise);
            let change = change(&estimates, &path);
            path.states = estimates.iter().map(|e| e.state).collect();
            if path.variances.is_some() {
                path.variances = Some(estimates.iter().map(|e| e.covariance[0]).collect());
            }
            (result.noise, result.estimates) = (noise, estimates);
            if change < AT_REST {
                result.settled = true;
                break;
            }
            if !change.is_finite() {
                break;
            }
        }
        result
    }
}

/// A prior with its noise, about a path.
#[derive(Clone, Debug)]
struct Candidate {
    prior: Prior,
    noise: Noise,
    scales: Scales,
    path: Path,
}

fn listed(tried: &[Candidate]) -> Vec<(Prior, f64)> {
    tried
        .iter()
        .map(|candidate| (candidate.prior, candidate.noise.likelihood))
        .collect()
}

/// Root mean square change of the crank angles in their standard errors.
fn change(estimates: &[Estimate], path: &Path) -> f64 {
    let changes = estimates
        .iter()
        .zip(&path.states)
        .map(|(estimate, before)| {
            let variance = estimate.covariance[0]
                .max((1e-14 * estimate.state[0]).powi(2))
                .max(f64::MIN_POSITIVE);
            (estimate.state[0] - before[0]).powi(2) / variance
        });
    (changes.sum::<f64>() / estimates.len() as f64).sqrt()
}
