//! Warnings of an inverse computation: reasons, in words, not to trust its result.

use std::f64::consts::{PI, TAU};

use super::super::InverseOptions;
use super::super::fitted::Fitted;
use super::super::model::tone::Carrier;
use super::super::residual_tests::DEVIATIONS;
use super::super::row::InverseRow;
use super::super::selection;
use crate::mechanism::Equation;
use crate::numeric::median::median;
use crate::scene::{Measured, Measurement, Scene};

/// Returns warnings about the forces and the friction of the scene.
pub(in crate::inverse) fn of_scene(scene: &Scene, options: &InverseOptions) -> Vec<String> {
    let reduced = scene.reduced();
    let forces = (!reduced.forces.is_empty()).then_some(if options.beside_forces {
        "the scene has forces on the slider: slider_force_n and crank_torque_nm are what acts beside them"
    } else {
        "the scene has forces on the slider: slider_force_n is the whole force on it, with those of the scene in it (--beside-forces takes them off)"
    });
    let friction = reduced.friction.map(|_| {
        "the scene has friction at the guide: slider_force_n and crank_torque_nm are what acts beside it; where the slider is at rest or turns round the force is left empty, and the torque is the middle of what friction allows"
    });
    forces
        .into_iter()
        .chain(friction)
        .map(str::to_owned)
        .collect()
}

/// Least ratio of speeds that suggests a mistaken unit: 2π, turns for radians, less 20 % for speeds that vary.
const MISTAKEN: f64 = 0.8 * TAU;

/// Least number of rows per turn by the sampling theorem: the inertia of the mechanism varies twice per turn.
const ROWS_IN_A_TURN: f64 = 4.0;

/// Returns warnings of a motion against the scene's `[motion] speed`, and of one over whole turns with too few rows.
pub(in crate::inverse) fn of_motion(
    scene: &Scene,
    measured: Measured,
    rows: &[InverseRow],
) -> Vec<String> {
    let (first, last) = (&rows[0], &rows[rows.len() - 1]);
    let turns = (last.theta - first.theta) / TAU;
    let rotates = turns.abs() >= 1.0;
    let mut warnings = Vec::new();
    let stated = scene.motion.speed;
    let shows_sense = matches!(measured, Measured::Theta | Measured::Omega);
    if rotates && shows_sense && turns * stated < 0.0 {
        warnings.push(format!("the crank turns against the sense of the scene's [motion] speed: {turns:.2} turns, positive anticlockwise"));
    }
    let speeds = || rows.iter().map(|row| row.omega.abs());
    let fastest = speeds().fold(0.0, f64::max);
    let usual = median(speeds()).unwrap_or(fastest);
    let times = [usual, fastest].map(|speed| speed / stated.abs());
    // A swing has no speed that contradicts the scene.
    let is_one_way = rotates || rows.iter().all(|row| row.omega * stated > 0.0);
    let is_mistaken = rotates && times[0] > MISTAKEN || is_one_way && times[1] < 1.0 / MISTAKEN;
    if stated != 0.0 && is_mistaken {
        warnings.push(format!(
            "the crank turns at {usual:.4} rad/s, {:.3} times the scene's [motion] speed: check the units of the data (degrees taken for radians make it 57.3 times, radians for degrees 0.0175 times, milliseconds for seconds 0.001 times) or the scene",
            times[0]
        ));
    }
    let in_a_turn = (rows.len() - 1) as f64 / turns.abs();
    if rotates && in_a_turn < ROWS_IN_A_TURN {
        warnings.push(format!(
            "there are {in_a_turn:.1} rows in a turn: with fewer than {ROWS_IN_A_TURN} the samples do not show how the speed varies within a turn, and force and torque rest on the scene's inertia"
        ));
    }
    warnings
}

/// Returns the warning of a torque that repeats: the samples do not tell it beyond a harmonic, and an error of a measured crank
/// angle that repeats, too, looks the same at one speed, whatever the band.
pub(in crate::inverse) fn of_sensor(
    fitted: &Fitted,
    measured: Measured,
    equation: &Equation,
    rows: &[InverseRow],
) -> Option<String> {
    let of_radian = |row: &InverseRow| equation.terms(row.theta).m * row.omega.powi(2);
    let of_milliradian = 1e-3 * median(rows.iter().map(of_radian))?;
    (fitted.told >= 1.0).then(|| {
        let told = fitted.told;
        match measured {
            Measured::Theta => format!(
                "the torque that repeats rests on the samples alone, up to harmonic {told} of a turn: an error of the sensor that repeats, like that of an encoder off its centre, is taken for it ({of_milliradian:.1e} N m for each mrad once in a turn) and not in the band; what varies faster is hidden by noise, and in the band as far as these harmonics suggest it"
            ),
            Measured::X | Measured::Gamma => format!(
                "the torque that repeats rests on the samples and on the lengths of the scene, up to harmonic {told} of a turn: an error of the sensor or of the lengths is taken for it ({of_milliradian:.1e} N m for each thousandth of the crank once in a turn) and not in the band, unless it is stated; what varies faster is hidden by noise, and in the band as far as these harmonics suggest it"
            ),
            Measured::Omega => format!(
                "the torque that repeats is known up to harmonic {told} of a turn: what varies faster is hidden by noise, and in the band as far as these harmonics suggest it"
            ),
        }
    })
}

/// Returns warnings about the estimated motion.
pub(in crate::inverse) fn of_fit(fitted: &Fitted, measurement: &Measurement) -> Vec<String> {
    let summary = &fitted.summary;
    let mut warnings = Vec::new();
    if !fitted.converged {
        warnings.push(
            "the iterations did not settle: the motion between the samples is not certain"
                .to_owned(),
        );
    }
    if fitted.without_equation {
        warnings.push(
            "a load of the scene has no finite value along the motion, or the inertia vanishes: the motion is smoothed without the equation"
                .to_owned(),
        );
    }
    let rows = measurement.len() as f64;
    if rows < 3.0 * summary.parameters {
        warnings.push(format!(
            "{rows} samples are few for a motion that is worth {} parameters: its error is hardly known",
            summary.parameters.round()
        ));
    }
    if fitted.patterned {
        let so = match summary.kind {
            "polynomial" => {
                "a polynomial of this degree does not follow the motion, or the samples are not independent: force, torque and their standard errors are not to be trusted, --fit smoother follows it"
            }
            _ => {
                "the fit misses part of the motion, or the samples are not independent, and the standard errors may be too small"
            }
        };
        warnings.push(format!(
            "the residuals are not white noise (correlation of each with the next {:.2}, runs of one sign {:+.0} standard deviations, Ljung-Box test {:.1}): {so}",
            summary.residual_lag_one, summary.residual_runs, summary.residual_ljung_box,
        ));
    }
    if let Some(farthest) = fitted.farthest_outlier {
        let samples = match summary.outliers {
            1 => "1 sample is far off and hardly counts".to_owned(),
            count => format!("{count} samples are far off and hardly count"),
        };
        let held = fitted.held.map_or(String::new(), |row| {
            format!("; at {} and before the value is the same: the sensor held, or was at the end of its range", measurement.place(row))
        });
        warnings.push(format!(
            "{samples}, the farthest at {} by {}{held}",
            measurement.place(farthest),
            measurement.shown(fitted.residuals[farthest].residual)
        ));
    }
    if summary.kind == "polynomial" && measurement.has_sensors_beside() {
        warnings.push(alone(measurement));
    }
    for sensor in &summary.beside {
        let off = sensor.mean_residual;
        if off.abs() > 5.0 * sensor.sigma / rows.sqrt() {
            warnings.push(format!(
                "{} is off by {off:.2e} (SI) in the mean beside the motion: check its zero, and the lengths of the scene",
                sensor.column
            ));
        }
        if sensor.residual_ljung_box > DEVIATIONS {
            warnings.push(format!(
                "{} differs from the motion by {:.2e} (SI), and not by noise: the sensors contradict each other, and no band covers that; check the zero and the sense of the angle, the unit and the zero of the position, and the lengths of the scene",
                sensor.column, sensor.sigma
            ));
        }
    }
    if let Some(step) = fitted.coded {
        warnings.push(format!(
            "the values go in steps of {}, and the noise is less than a step: each sample says within which step the angle is",
            measurement.shown(step)
        ));
    }
    if measurement.is_counted() && summary.sigma > measurement.resolution() {
        warnings.push(format!(
            "the noise is {:.1} counts of the encoder, and no more than one is its own: the samples may be too far apart to show the motion between them, or the counts per turn are others",
            summary.sigma / measurement.resolution()
        ));
    }
    for tone in &summary.tones {
        let (of, size, other) = match tone.carrier {
            Carrier::Sensor => (
                "the sensor, as hum of the mains, and is not in the motion",
                measurement.shown(tone.amplitude),
                "a torque",
            ),
            Carrier::Torque => (
                "the torque, and is in the result",
                format!("{:.2e} N m", tone.amplitude),
                "an error of the sensor",
            ),
        };
        let rival = tone.log_odds.map_or(String::new(), |odds| {
            let band = match selection::counts(odds) {
                true => ", and in the band",
                false => "",
            };
            format!(": {other} of that frequency is e^{odds:.1} times less likely{band}")
        });
        warnings.push(format!(
            "a tone of {:.4} Hz and {size} is taken for one of {of}{rival}",
            tone.frequency_hz,
        ));
    }
    if let Some(time) = summary.noise_correlation_s {
        warnings.push(format!(
            "the noise of the samples is correlated over about {time:.1e} s: what varies like that is taken for noise, not for motion"
        ));
    }
    warnings.extend(slow(fitted, measurement));
    if summary.coefficients.iter().any(Option::is_none) {
        warnings.push("coefficients in plain time are left out where cancellation leaves no digits: let the time begin near 0".to_owned());
    }
    warnings
}

/// Returns the warning that one sensor alone is used of several.
pub(in crate::inverse) fn alone(measurement: &Measurement) -> String {
    let name = measurement.measured().name();
    format!("{name} alone is taken, not the sensors beside it: only the smoother takes several")
}

/// Returns a warning if the samples do not resolve the torque within each turn: within the fastest ones of a motion over turns.
fn slow(fitted: &Fitted, measurement: &Measurement) -> Option<String> {
    let times = measurement.elapsed();
    let duration = times[times.len() - 1] - times[0];
    let speeds = fitted.motion.iter().map(|motion| motion.value[1].abs());
    let steps = fitted.motion.windows(2);
    let steps = steps.map(|w| (w[1].value[0] - w[0].value[0]).abs());
    let turns = steps.sum::<f64>() / TAU;
    let mean = TAU * turns / duration;
    let fastest = speeds.fold(mean, f64::max);
    let resolved = (1.0 / fitted.summary.corner_hz?).min(duration);
    // The inertia varies twice in a turn, and harmonics that the samples determine resolve it at any speed.
    let from = PI / resolved;
    (turns > 1.0 && fitted.told < 2.0 && fastest > from).then(|| {
        let at = match mean > from {
            true => format!("a turn takes {:.1e} s", TAU / mean),
            false => format!("a turn takes less than twice that from {from:.3} rad/s on"),
        };
        format!(
            "the noise hides how the torque varies in less than about {resolved:.1e} s, and {at}: what it does within each turn is neither in the result nor in its band"
        )
    })
}
