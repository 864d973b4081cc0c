//! Values that are free, and what is found of them.

/// A value that is free.
#[derive(Clone, Debug)]
pub struct FreeValue {
    /// Name, as `crank.inertia`.
    pub key: String,
    /// SI unit.
    pub unit: String,
    /// Value from which the search sets out.
    pub start: f64,
    /// Size of a change that matters where the start is 0.
    pub scale: f64,
    /// Whether it is what the sensor shows where it should show 0 (rad or m): the index mark of an angle, the zero of x.
    pub is_sensor_zero: bool,
}

/// A value with its error.
#[derive(Clone, Debug, serde::Serialize)]
pub struct IdentifiedValue {
    /// Name, as `crank.inertia`.
    pub key: String,
    /// SI unit.
    pub unit: String,
    /// Value from which the search set out.
    pub start: f64,
    /// Value found.
    pub value: f64,
    /// Standard error.
    pub standard_error: f64,
    /// Half of the 95 % band.
    pub half_band: f64,
}

/// First step of differences over a value.
const FIRST: f64 = 1e-4;

impl FreeValue {
    /// First step of differences.
    pub(super) fn first_step(&self) -> f64 {
        FIRST
            * match self.start {
                0.0 => self.scale,
                start => start.abs(),
            }
    }
}
