//! The samples of a measurement as the smoother and the polynomial take them.

use super::branch_tracking::CrankAngles;
use super::problem::Problem;
use super::quantised;
use super::record::{Grid, Record};
use crate::mechanism::Equation;
use crate::scene::{Measured, Measurement};

/// Units of rounding of computed values.
const COMPUTED: f64 = 2.0;

/// Part of an encoder's step that is the least standard deviation of a sample told by a transition.
const SHARP: f64 = 1e-3;

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
        rows: None,
        step: None,
        floor: (measurement.resolution() / 12f64.sqrt()).max(COMPUTED * f64::EPSILON * largest),
        origin: measurement.origin(),
    }
}

/// A record with its nodes; codes of an encoder are told by their transitions.
pub(super) fn problem<'a>(
    record: Record<'a>,
    theta: &[f64],
    equation: &'a Equation,
) -> Problem<'a> {
    let coded = match record.is_linear() {
        true => quantised::transitions(&record.times, &record.values),
        false => None,
    };
    match coded {
        Some(coded) => Problem {
            grid: Grid::new(&coded.times, &coded.values),
            record: Record {
                times: coded.times.into(),
                values: coded.values,
                weights: coded.weights,
                rows: Some(coded.rows),
                step: Some(coded.step),
                floor: SHARP * coded.step,
                ..record
            },
            equation,
        },
        None => Problem {
            grid: Grid::of_blocks(&record.times, theta)
                .unwrap_or_else(|| Grid::new(&record.times, theta)),
            record,
            equation,
        },
    }
}
