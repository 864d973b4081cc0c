//! Tones: sinusoids of fixed frequencies in time, in the values of a sensor, as hum of the mains, or in the torque, as the ripple of
//! an inverter.

use serde::Serialize;

/// What has a tone.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Carrier {
    /// The values of a sensor, as hum of the mains: not part of the motion.
    Sensor,
    /// The torque, as the ripple of an inverter: part of the result.
    Torque,
}

impl Carrier {
    /// Returns the other one.
    pub(in crate::inverse) fn other(self) -> Carrier {
        match self {
            Carrier::Sensor => Carrier::Torque,
            Carrier::Torque => Carrier::Sensor,
        }
    }
}

/// A sinusoid a cos ωt + b sin ωt.
#[derive(Clone, Copy, Debug)]
pub(in crate::inverse) struct Tone {
    pub carrier: Carrier,
    /// ω, rad/s.
    pub frequency: f64,
    /// a and b, rad or m of a sensor, N m of the torque.
    pub amplitudes: [f64; 2],
    /// ln of the determinant of the covariance of a, b and ω by which it was accepted: the unit of their density before the samples.
    pub log_unit: f64,
    /// ln of the odds to a tone of the other carrier; none where that has no likelihood.
    pub log_odds: Option<f64>,
}

impl Tone {
    /// Returns its value at a time, s.
    pub fn at(&self, t: f64) -> f64 {
        let (sin, cos) = (self.frequency * t).sin_cos();
        self.amplitudes[0] * cos + self.amplitudes[1] * sin
    }

    /// Returns the derivatives of its value at a time, s, by a, b and ω.
    pub fn slopes(&self, t: f64) -> [f64; 3] {
        let (sin, cos) = (self.frequency * t).sin_cos();
        let [a, b] = self.amplitudes;
        [cos, sin, t * (b * cos - a * sin)]
    }

    /// Returns it with a and b, and its frequency, changed.
    pub fn moved(self, by: [f64; 3]) -> Tone {
        Tone {
            amplitudes: [self.amplitudes[0] + by[0], self.amplitudes[1] + by[1]],
            frequency: self.frequency + by[2],
            ..self
        }
    }

    /// Returns its amplitude.
    pub fn amplitude(&self) -> f64 {
        self.amplitudes[0].hypot(self.amplitudes[1])
    }

    /// Returns ln of the density of ln of its amplitude, up to a constant: half a Cauchy distribution, of which the scale alone is
    /// known (Gelman, Bayesian Analysis 1 (2006) 515).
    pub fn log_prior(&self, scale: f64) -> f64 {
        let ratio = self.amplitude() / scale;
        ratio.ln() - (ratio * ratio).ln_1p()
    }
}

/// Returns the sum of the tones of a carrier at a time, s.
pub(in crate::inverse) fn sum(tones: &[Tone], carrier: Carrier, t: f64) -> f64 {
    let of_carrier = tones.iter().filter(|tone| tone.carrier == carrier);
    of_carrier.map(|tone| tone.at(t)).sum()
}
