//! Identification of keys of a scene file from a measured motion.

use std::str::FromStr;

use super::{FreeValue, Identification, identify_among, not_modelled};
use crate::error::Error;
use crate::numeric::stop::Stop;
use crate::scene::{Assigned, Draft, Measured, Measurement, NumberKey, Scene};

/// Free quantity of an identification.
#[derive(Clone, Copy, Debug)]
pub enum FreeKey {
    /// A key of the scene.
    Key(NumberKey),
    /// Zero error of the sensor: its reading, rad or m, where 0 is true.
    SensorZero,
}

const SENSOR_ZERO: &str = "sensor.zero";

impl FromStr for FreeKey {
    type Err = <NumberKey as FromStr>::Err;

    fn from_str(text: &str) -> Result<FreeKey, Self::Err> {
        match text.trim() {
            SENSOR_ZERO => Ok(FreeKey::SensorZero),
            key => key.parse().map(FreeKey::Key),
        }
    }
}

impl FreeKey {
    fn value(self, draft: &Draft, crank: f64, measured: Measured) -> Result<FreeValue, Error> {
        let FreeKey::Key(key) = self else {
            if measured == Measured::Omega {
                let what =
                    "sensor.zero belongs to a sensor of the position, and the motion is a speed";
                return Err(Error::refused(what, "leave it out"));
            }
            let is_length = measured == Measured::X;
            return Ok(FreeValue {
                key: SENSOR_ZERO.to_owned(),
                unit: if is_length { "m" } else { "rad" }.to_owned(),
                start: 0.0,
                scale: if is_length { crank } else { 1.0 },
                is_sensor_zero: true,
            });
        };
        match key.to_string().split('.').next() {
            Some("friction") => return Err(not_modelled("Coulomb friction at the guide")),
            Some("clearance") => return Err(not_modelled("clearance in a joint")),
            _ => {}
        }
        let start = draft.number(&key)?;
        let scale = match (start, key.unit()) {
            (_, "m") => crank.max(start.abs()),
            (0.0, _) => 1.0,
            _ => start.abs(),
        };
        Ok(FreeValue {
            key: key.to_string(),
            unit: key.unit().to_owned(),
            start,
            scale,
            is_sensor_zero: false,
        })
    }
}

/// Identifies free keys of a scene file from a measured motion; `complete` makes the file's scene the modelled one.
///
/// # Errors
/// The errors of [`identify`](super::identify()); [`Error::Scene`] for keys not in the scene; [`Error::Interrupted`].
pub fn identify_keys(
    draft: &Draft,
    complete: &(dyn Fn(Scene) -> Scene + Sync),
    free: &[FreeKey],
    measurement: &Measurement,
    stop: Option<&Stop>,
) -> Result<Identification, Error> {
    let crank = draft.scene()?.geometry.crank;
    let value = |key: &FreeKey| key.value(draft, crank, measurement.measured());
    let mut all = free.iter().map(value).collect::<Result<Vec<_>, Error>>()?;
    let mut keys = free.to_vec();
    // Candidates of the score tests; keys that the equation does not have leave the prediction errors as they are.
    let others = draft.number_keys().map(FreeKey::Key);
    for key in std::iter::once(FreeKey::SensorZero).chain(others) {
        if let Ok(value) = value(&key)
            && all.iter().all(|other| other.key != value.key)
        {
            keys.push(key);
            all.push(value);
        }
    }
    let is_stopped = || stop.is_some_and(Stop::is_requested);
    let scene_at = |values: &[f64]| {
        if is_stopped() {
            return Err(Error::Interrupted);
        }
        let numbers = keys.iter().zip(values);
        let numbers = numbers.filter_map(|(key, value)| match key {
            FreeKey::Key(key) => Some(Assigned {
                key: *key,
                value: *value,
            }),
            FreeKey::SensorZero => None,
        });
        draft
            .with_numbers(&numbers.collect::<Vec<_>>())
            .map(complete)
    };
    match identify_among(&scene_at, &all, free.len(), measurement) {
        _ if is_stopped() => Err(Error::Interrupted),
        found => found.map_err(|error| error.with_notes(measurement.notes())),
    }
}
