//! Alignment of a position sensor: slider samples and a scene in, sensors with corrected zero and gain out, by the
//! distance of fitted turning points from the dead centres.
//!
//! To first order an error of the lengths shifts and stretches the slider's stroke, as zero and gain of a sensor do.
//! Without the correction, a slider that turns back short of the scene's dead centre reverses the crank with it.

use std::ops::Range;

use super::super::measurement_model::{Scale, Sensor};
use super::super::residual_tests::Whiteness;
use super::branch_tracking::LARGEST_VALUE_ERROR;
use crate::mechanism::{DeadCentre, Limits, Linkage};
use crate::numeric::median::{median, range};
use crate::numeric::polynomial_fit::{Equations, PolynomialFit};
use crate::numeric::root::bracketed;
use crate::scene::{Measured, Measurement};

/// Slider travel about a turning point that is fitted, in crank lengths: about 0.8 rad of the crank on both sides.
const WAY: f64 = 0.3;

/// Minimum number of samples about a turning point.
const LEAST_SAMPLES: usize = 6;

/// Distance of a turning point from a dead centre, in standard errors, above which the sensor is corrected.
const ERRORS_OFF: f64 = 3.0;

/// Returns the sensor as it is and, if turning points are off the dead centres, sensors corrected to match them.
pub(in crate::inverse) fn sensors<'a>(
    sensor: Sensor<'a>,
    measurement: &Measurement,
) -> Vec<Sensor<'a>> {
    let mut list = vec![sensor];
    let mut found = stroke_ends(&sensor, measurement);
    let at = |turn: &StrokeEnd| sensor.scale.shift + sensor.scale.stretch * turn.at;
    found.retain(|turn| (turn.shown - at(turn)).abs() < LARGEST_VALUE_ERROR * sensor.linkage.r);
    if !found.iter().any(StrokeEnd::is_off) {
        return list;
    }
    let mut scales: Vec<Scale> = Vec::new();
    if let [a, b] = &found[..] {
        let stretch = (a.shown - b.shown) / (a.at - b.at);
        let shift = a.shown - stretch * a.at;
        scales.push(Scale { shift, stretch });
    }
    scales.extend(found.iter().filter(|turn| turn.is_off()).map(|turn| Scale {
        shift: turn.shown - turn.at,
        stretch: 1.0,
    }));
    list.extend(scales.into_iter().map(|scale| Sensor { scale, ..sensor }));
    list
}

/// Returns the sensor with the zero that puts the turning points about the dead centres, if the samples show both.
pub(in crate::inverse) fn centred<'a>(sensor: Sensor<'a>, measurement: &Measurement) -> Sensor<'a> {
    let [a, b] = &stroke_ends(&sensor, measurement)[..] else {
        return sensor;
    };
    let shift = 0.5 * (a.shown + b.shown - a.at - b.at);
    let scale = Scale {
        shift,
        ..Scale::TRUE
    };
    Sensor { scale, ..sensor }
}

/// Returns the turning points of a position sensor next to the dead centres.
fn stroke_ends(sensor: &Sensor<'_>, measurement: &Measurement) -> Vec<StrokeEnd> {
    if sensor.measured != Measured::X {
        return Vec::new();
    }
    let of = |dead_centre: DeadCentre| {
        let bend = sensor.linkage.pose(dead_centre.theta).d2x;
        let [shown, error] = turning_point(measurement, -bend.signum(), sensor.linkage.r)?;
        Some(StrokeEnd {
            at: dead_centre.x,
            shown,
            error,
        })
    };
    let dead_centres = Limits::new(sensor.linkage, 0.0).dead_centres;
    dead_centres.into_iter().filter_map(of).collect()
}

/// Returns the scale of a sensor on a mechanism with other lengths. Where the turning points are off its dead centres, the
/// readings at both dead centres stay as they are, or the one that the samples show is taken.
pub(in crate::inverse) fn realigned(
    sensor: &Sensor<'_>,
    other: &Linkage,
    measurement: &Measurement,
) -> Scale {
    let moved = Sensor {
        linkage: other,
        scale: Scale::TRUE,
        ..*sensor
    };
    // The first correction has zero and gain, if the samples show both dead centres.
    let Some(Sensor { scale, .. }) = sensors(moved, measurement).get(1).copied() else {
        return Scale::TRUE;
    };
    if scale.stretch == 1.0 {
        return scale;
    }
    let ends = |linkage: &Linkage| {
        let list = Limits::new(linkage, 0.0).dead_centres;
        let (low, high) = range(&list.iter().map(|end| end.x).collect::<Vec<_>>());
        [low, high]
    };
    let Scale { shift, stretch } = sensor.scale;
    let [low, high] = ends(sensor.linkage).map(|x| shift + stretch * x);
    let [near, far] = ends(other);
    let stretch = (high - low) / (far - near);
    Scale {
        shift: low - stretch * near,
        stretch,
    }
}

/// Turning point of the slider next to a dead centre.
#[derive(Clone, Copy, Debug)]
struct StrokeEnd {
    /// Position of the dead centre, m.
    at: f64,
    /// Measured position of the turning point, m.
    shown: f64,
    /// Standard error of `shown`, m.
    error: f64,
}

impl StrokeEnd {
    fn is_off(&self) -> bool {
        (self.shown - self.at).abs() > ERRORS_OFF * self.error
    }
}

/// Returns the largest value (the least, for sense −1) at which the samples turn back, m, with its standard error: from the
/// highest turn on, the median of those that agree with it. A crank that swings may turn back before its dead centre, too.
fn turning_point(measurement: &Measurement, sense: f64, crank: f64) -> Option<[f64; 2]> {
    let values = measurement.values();
    // Isolated extremes are outliers.
    let middles = values
        .windows(3)
        .map(|w| sense * w[0].max(w[1]).min(w[0].min(w[1]).max(w[2])));
    let top = middles.fold(f64::NEG_INFINITY, f64::max);
    let is_near = |sample: &usize| sense * values[*sample] > top - WAY * crank;
    let all = Vec::from_iter(0..values.len());
    let about = all.chunk_by(|a, b| is_near(a) && is_near(b));
    let about = about.filter(|samples| samples.len() >= LEAST_SAMPLES);
    let turns: Vec<[f64; 2]> = about
        .filter_map(|samples| vertex(measurement, samples[0]..samples[0] + samples.len(), sense))
        .collect();
    let highest = turns.iter().copied();
    let [mut shown, mut error] =
        highest.max_by(|a, b| (sense * a[0]).total_cmp(&(sense * b[0])))?;
    let mut count = 0;
    loop {
        let agrees =
            |turn: &&[f64; 2]| (turn[0] - shown).abs() <= ERRORS_OFF * turn[1].hypot(error);
        let near: Vec<_> = turns.iter().filter(agrees).collect();
        if near.len() <= count {
            // The median of n normal numbers has √(π/2n) of their standard deviation.
            return Some([shown, error * (1.6 / count as f64).sqrt().min(1.0)]);
        }
        count = near.len();
        shown = median(near.iter().map(|turn| turn[0]))?;
        error = median(near.iter().map(|turn| turn[1]))?;
    }
}

/// Returns the largest value (the least, for sense −1) of a polynomial through samples about a turning point, with its standard
/// error, m: a crank that turns back just past its dead centre passes it twice. The samples are those about the largest value of
/// which the polynomial leaves nothing but noise.
fn vertex(measurement: &Measurement, mut range: Range<usize>, sense: f64) -> Option<[f64; 2]> {
    loop {
        let t = &measurement.elapsed()[range.clone()];
        let values = &measurement.values()[range.clone()];
        let equations = Equations {
            t,
            target: values,
            weight: None,
            floor: measurement.resolution(),
        };
        let fit = PolynomialFit::new(&equations, None).ok()?;
        let shown: Vec<f64> = t.iter().map(|t| fit.state(*t).value[0]).collect();
        let height = |k: &usize| sense * shown[*k];
        let top = (1..t.len() - 1).max_by(|a, b| height(a).total_cmp(&height(b)))?;
        let residuals = values
            .iter()
            .zip(&shown)
            .map(|(value, shown)| value - shown);
        if !Whiteness::of(residuals).is_violated() || range.len() < 2 * LEAST_SAMPLES {
            let slope = |t: f64| fit.state(t).value[1];
            let state = fit.state(bracketed(slope, t[top - 1], t[top + 1])?);
            return Some([state.value[0], state.covariance[0].sqrt()]);
        }
        let (middle, quarter) = (range.start + top, range.len() / 4);
        let begin = middle.saturating_sub(quarter).max(range.start);
        range = begin..range.end.min(middle + quarter + 1);
    }
}
