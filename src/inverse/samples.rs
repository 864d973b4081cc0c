//! Preparation of samples for smoother and polynomial: record, nodes, outlier weights, motion without mechanics.

use super::condensed::{Blocks, Condensed};
use super::first_path;
use super::grid::{Course, Grid, Path};
use super::measurement_model::{Scale, Sensor};
use super::model::prior::KINEMATIC;
use super::model::tone::{self, Carrier, Tone};
use super::outliers;
use super::problem::Problem;
use super::quantised::Codes;
use super::record::{Record, SensorBeside};
use super::residual_tests::repeats;
use super::scales::root_mean_square;
use super::smoother::Smoothed;
use super::turns::branch_tracking::CrankAngles;
use crate::mechanism::Equation;
use crate::numeric::ROUNDING_DEVIATION;
use crate::numeric::stop::Stop;
use crate::scene::{Beside, BesideColumn, Measured, Measurement};

/// Lower bound of the standard deviation of a sample, in units of rounding of the largest value.
const ROUNDING_STEPS: f64 = 2.0;

/// Maximum number of rounds of outlier detection.
const OUTLIER_ROUNDS: usize = 6;

/// What a motion is estimated from.
#[derive(Clone, Copy)]
pub(super) struct Given<'a> {
    pub measurement: &'a Measurement,
    pub angles: &'a CrankAngles<'a>,
    pub equation: &'a Equation,
    pub stop: Option<&'a Stop>,
}

impl<'a> Given<'a> {
    /// Returns the samples of the measurement less the tones of the sensor, at full weight; a measured crank angle is the unwrapped one.
    pub fn record(&self, tones: &[Tone]) -> Record<'a> {
        let (measurement, sensor) = (self.measurement, self.angles.sensor);
        let values = match sensor.measured {
            Measured::Theta => self.angles.theta.clone(),
            _ => measurement.values().to_vec(),
        };
        let largest = values.iter().fold(0.0, |most: f64, v| most.max(v.abs()));
        let codes = Codes::of(&values, measurement.resolution());
        let mut record = Record {
            sensor,
            step: codes.map_or(0.0, |codes| codes.step),
            times: measurement.elapsed().into(),
            weights: vec![1.0; values.len()],
            repeated: (0..values.len()).map(|i| repeats(&values, i)).collect(),
            spreads: Vec::new(),
            values,
            tones: tones.to_vec(),
            holds: false,
            codes: None,
            intervals: Vec::new(),
            shown: Vec::new(),
            beside: self.sensors_beside(),
            floor: (ROUNDING_DEVIATION * measurement.resolution())
                .max(ROUNDING_STEPS * f64::EPSILON * largest),
            origin: measurement.origin(),
        };
        record.holds = sensor.is_of_speed() && record.repeats_more_than_noise();
        record.weights = record.full_weights();
        for (value, t) in record.values.iter_mut().zip(measurement.elapsed()) {
            *value -= tone::sum(tones, Carrier::Sensor, *t);
        }
        record
    }

    /// Returns the sensors beside that of the record, with unknown noise.
    fn sensors_beside(&self) -> Vec<SensorBeside<'a>> {
        let of = |column: &'a BesideColumn| match column.beside {
            Beside::Sensor(measured) => Some(SensorBeside {
                sensor: Sensor {
                    measured,
                    scale: Scale::TRUE,
                    ..self.angles.sensor
                },
                values: column.values.as_slice().into(),
                sigma: f64::INFINITY,
                mean: 0.0,
            }),
            _ => None,
        };
        self.measurement.beside().iter().filter_map(of).collect()
    }

    /// Returns a record with its nodes, and a path along crank angles, rad: of means of up to so many samples where these are dense.
    pub fn problem(&self, record: Record<'a>, theta: &[f64], most: usize) -> (Problem<'a>, Path) {
        let blocks = Blocks::new(&record, theta, most);
        let means = |values: &[f64]| match &blocks {
            Some(blocks) => blocks.means(values),
            None => values.to_vec(),
        };
        let (times, angles) = (means(&record.times), means(theta));
        let computed = record.is_computed();
        let grid = Grid::new(&times, &angles, computed);
        let path = first_path::coarse(&grid, &times, &angles);
        let (record, condensed) = match blocks {
            None => (record, None),
            Some(blocks) => {
                let condensed = Condensed { record, blocks };
                let course = path.states.iter();
                let course = Course {
                    grid: &grid,
                    first: 0,
                    motion: course
                        .map(|[theta, omega, ..]| [*theta, *omega, 0.0])
                        .collect(),
                };
                (condensed.about(&course), Some(condensed))
            }
        };
        let problem = Problem {
            record,
            condensed,
            grid,
            computed,
            equation: self.equation,
            intensities: Vec::new(),
            stop: self.stop,
        };
        (problem, path)
    }

    /// Returns the quantisation of crank angles that were measured alone.
    pub fn codes(&self) -> Option<Codes> {
        let Given {
            measurement,
            angles,
            ..
        } = self;
        let alone = measurement.measured() == Measured::Theta && !measurement.has_sensors_beside();
        alone.then(|| Codes::of(&angles.theta, measurement.resolution()))?
    }

    /// Returns the samples of the measurement less the tones of the sensor, or means of up to so many, with their outlier weights, and the
    /// motion smoothed without mechanics.
    pub fn kinematic(&self, tones: &[Tone], most: usize) -> (Problem<'a>, Smoothed) {
        let Some(codes) = self.codes() else {
            let (mut problem, kinematic) = self.without_outliers(self.record(tones), most);
            let kinematic = problem.by_all_sensors(kinematic);
            return (problem, kinematic);
        };
        let coded = self.record(tones).coded(codes);
        let is_whole = coded.times.len() == self.measurement.len();
        let (mut problem, kinematic) = self.without_outliers(coded, most);
        if kinematic.noise.sigma < codes.step {
            let first = problem.record.clone();
            let record = &mut problem.record;
            record.codes = Some(codes);
            for (interval, weight) in record.intervals.iter_mut().zip(&record.weights) {
                if *weight < 0.5 {
                    interval.middle = f64::NAN;
                }
            }
            let found = problem.propagated(codes, kinematic.clone());
            if found.is_finite() {
                return (problem, found);
            }
            problem.record = first;
        }
        // Codes that yield no finite motion, or are finer than the noise, are treated as noisy samples.
        match is_whole {
            true => {
                problem.record.intervals.clear();
                (problem, kinematic)
            }
            false => self.without_outliers(self.record(tones), most),
        }
    }

    /// Returns the samples with outlier weights, and the motion smoothed without mechanics.
    fn without_outliers(&self, record: Record<'a>, most: usize) -> (Problem<'a>, Smoothed) {
        let theta = match record.is_linear() {
            true => record.values.clone(),
            false => self.angles.theta.clone(),
        };
        let (mut problem, first) = self.problem(record, &theta, most);
        let sigma = self.angles.sigma.max(problem.record.floor);
        let mut kinematic = problem.kinematic(first, sigma);
        let holds = problem.finds_held(&kinematic);
        if holds || problem.condensed.is_some() {
            // The first path follows the noise.
            problem.weigh(problem.single().full_weights(), &kinematic);
            kinematic = problem.kinematic(kinematic.path(), kinematic.noise.sigma);
        }
        let kinematic = problem.without_outliers(kinematic);
        (problem, kinematic)
    }
}

impl Problem<'_> {
    /// Weighs samples against outliers, by a motion that was smoothed without mechanics; returns that of the weighted samples.
    pub fn without_outliers(&mut self, mut kinematic: Smoothed) -> Smoothed {
        let mut few = true;
        for _ in 0..OUTLIER_ROUNDS {
            let Some(judged) = outliers::judge(self, &kinematic) else {
                break;
            };
            few = judged.few;
            let changes = self.weigh(judged.weights, &kinematic);
            kinematic = self.kinematic(kinematic.path(), kinematic.noise.sigma);
            if !changes {
                break;
            }
        }
        if !few {
            self.weigh(self.single().full_weights(), &kinematic);
            kinematic = self.kinematic(kinematic.path(), kinematic.noise.sigma);
        }
        kinematic
    }

    /// Smooths the motion without mechanics, from a first path and the sample noise σ, rad or m.
    pub fn kinematic(&self, first: Path, sigma: f64) -> Smoothed {
        let path = first.along(self.sampled());
        let scales = self.scales(KINEMATIC, &path, self.slope(&first), sigma);
        let linear = self.linear(KINEMATIC, scales, &path, sigma);
        let mut found = self.iterated(&linear.with(linear.anywhere(None)), path);
        let accelerations = found.estimates.iter().map(|e| e.alpha);
        found.scales.acceleration = root_mean_square(accelerations).max(f64::MIN_POSITIVE);
        self.completed(found, first, false)
    }
}
