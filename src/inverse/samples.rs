//! The samples of a measurement as the smoother and the polynomial take them.

use super::branch_tracking::CrankAngles;
use super::problem::Problem;
use super::record::{Grid, Record};
use crate::mechanism::Equation;
use crate::scene::{Measured, Measurement};

/// Units of rounding of computed values.
const COMPUTED: f64 = 2.0;

/// The samples of a measurement with the crank angles that they were read as.
pub(super) fn record<'a>(measurement: &'a Measurement, angles: &CrankAngles<'a>) -> Record<'a> {
    let sensor = angles.sensor;
    let values = match sensor.measured {
        Measured::Theta => angles.theta.clone(),
        _ => measurement.values().to_vec(),
    };
    let largest = values.iter().fold(0.0, |most: f64, v| most.max(v.abs()));
    Record {
        sensor,
        times: measurement.elapsed().into(),
        weights: vec![1.0; values.len()],
        values,
        codes: None,
        digits: measurement.resolution(),
        floor: (measurement.resolution() / 12f64.sqrt()).max(COMPUTED * f64::EPSILON * largest),
        origin: measurement.origin(),
    }
}

/// A record with its nodes.
pub(super) fn problem<'a>(
    record: Record<'a>,
    theta: &[f64],
    equation: &'a Equation,
) -> Problem<'a> {
    let grid =
        Grid::of_blocks(&record.times, theta).unwrap_or_else(|| Grid::new(&record.times, theta));
    Problem {
        record,
        grid,
        equation,
    }
}
