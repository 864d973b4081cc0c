//! Slider force and crank torque from a measured motion: a fitted θ(t) is a prescribed motion, for which the
//! equation is read backwards.

mod bands;
mod course;
mod errors;
mod fitted;
mod force;
mod guide;
mod limit;
mod missed;
mod near;
mod passages;
mod pattern;
mod printed;
mod rounding;
mod row;
mod seen;
mod sensor;
mod summary;
mod unfold;
mod warnings;
mod waves;

pub use bands::{BandRule, DeadCentreBand};
pub use printed::AsPrinted;
pub use row::{InverseRow, Residual};
pub use summary::{DataSummary, FitSummary, ForceRange, InverseSummary};

use self::fitted::Fitted;
use self::force::Backwards;
use self::guide::Guide;
use self::row::Rows;
use self::sensor::Sensor;
use crate::error::Error;
use crate::mechanism::{Equation, Reactions, Reactor};
pub use crate::numeric::fit::{Kind as FitKind, Size as FitSize};
use crate::numeric::student;
use crate::plan::{Method, Plan};
use crate::scene::{Measurement, MotionKind, Scene};

/// What is asked of an inverse computation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InverseOptions {
    /// Kind of curve that is fitted to the motion.
    pub fit: FitKind,
    /// Its degree, or number of harmonics.
    pub size: FitSize,
    /// Joint forces for the rows.
    pub reactions: bool,
    /// Whether the slider force is what acts beside the forces of the scene; if not it is the whole force on the
    /// slider.
    pub beside_forces: bool,
}

impl Default for InverseOptions {
    fn default() -> InverseOptions {
        InverseOptions {
            fit: FitKind::Polynomial,
            size: FitSize::Auto,
            reactions: false,
            beside_forces: false,
        }
    }
}

/// Slider force and crank torque along a measured motion.
#[derive(Debug)]
pub struct Inverse {
    /// The numbers.
    pub summary: InverseSummary,
    /// One row for each sample.
    pub rows: Vec<InverseRow>,
    /// One residual for each sample.
    pub residuals: Vec<Residual>,
    equation: Equation,
    reactor: Option<Reactor>,
}

/// Slider force and crank torque from a measured motion.
///
/// # Errors
/// [`Error::Scene`] for impossible values of scene or data, [`Error::Refused`] for what cannot be computed.
///
/// ```
/// use slider_crank::scene::{Measured, Measurement, Scene, Slider};
/// use slider_crank::study::{InverseOptions, inverse};
///
/// // A massless crank and rod of 50 and 150 mm, a slider of 2 kg, turned at 10 rad/s.
/// let scene = Scene::new(0.05, 0.15).slider(Slider { mass: 2.0 });
/// let times: Vec<f64> = (0..40).map(|i| 0.01 * f64::from(i)).collect();
/// let angles = times.iter().map(|t| 0.3 + 10.0 * t).collect();
/// let motion = Measurement::new(Measured::Theta, times, angles)?;
///
/// let found = inverse(&scene, &motion, &InverseOptions::default())?;
/// let row = found.rows[12];
/// // Newton: force = mass times acceleration of the slider, x'' omega^2.
/// let x = |theta: f64| 0.05 * theta.cos() + (0.15f64.powi(2) - (0.05 * theta.sin()).powi(2)).sqrt();
/// let second = (x(row.theta + 1e-4) - 2.0 * x(row.theta) + x(row.theta - 1e-4)) / 1e-8;
/// assert!((row.slider_force.unwrap() - 2.0 * second * 100.0).abs() < 1e-4);
/// # Ok::<(), slider_crank::error::Error>(())
/// ```
pub fn inverse(
    scene: &Scene,
    measurement: &Measurement,
    options: &InverseOptions,
) -> Result<Inverse, Error> {
    let plan = plan(scene)?;
    let reactor = options.reactions.then(|| Reactor::new(scene)).transpose()?;
    let guide = Guide::new(scene)?;
    let equation = Equation::new(scene);
    let sensor = Sensor {
        linkage: equation.linkage(),
        measured: measurement.measured(),
    };
    let unfolded = unfold::unfold(&sensor, measurement, &scene.motion)?;
    let fitted = Fitted::new(
        &sensor,
        measurement,
        unfolded.theta,
        options.fit,
        options.size,
    );
    let fitted = fitted.map_err(|what| limit::unfit(sensor.linkage, what, &unfolded.warnings))?;
    let backwards = Backwards {
        equation: &equation,
        beside_forces: options.beside_forces,
        sigma: fitted.errors.sigma(),
        guide: guide.as_ref(),
        exact: fitted.errors.exact,
    };
    let factor = student::half_band(fitted.errors.free);
    let mut found = Rows::new(&backwards, &fitted, measurement, factor);
    reachable(measurement, &found)?;
    let lost = warnings::of_lost(&fitted, &found)?;
    limit::keeps_clear(&backwards, &sensor, &fitted, measurement)?;
    let locked = finite(&backwards, measurement, &found.rows)?;
    found.leave_out_lost();
    let mut warnings = measurement.notes().to_vec();
    warnings.extend(unfolded.warnings);
    warnings.extend(warnings::of_scene(scene, options));
    warnings.extend(locked);
    warnings.extend(lost);
    warnings.extend(warnings::of_fit(&fitted, measurement, options));
    let summary = InverseSummary::new(
        scene,
        plan,
        measurement,
        &fitted,
        &found,
        (options.beside_forces, factor),
        warnings,
    );
    let residuals = Residual::list(&fitted, measurement);
    Ok(Inverse {
        summary,
        rows: found.rows,
        residuals,
        reactor,
        equation,
    })
}

impl Inverse {
    /// Whether joint forces were asked for.
    pub fn with_reactions(&self) -> bool {
        self.reactor.is_some()
    }

    /// The lever arm x' of the slider force at a row, m/rad.
    pub fn lever_arm(&self, row: &InverseRow) -> f64 {
        self.equation.linkage().pose(row.theta).dx
    }

    /// The joint forces of a row, with its slider force acting; none where that is empty, or if they were not asked
    /// for.
    pub fn reactions(&self, row: &InverseRow) -> Option<Reactions> {
        let reactor = self.reactor.as_ref()?;
        row.slider_force?;
        let terms = self.equation.terms(row.theta);
        let mut load = self.equation.load(row.t, row.theta, row.omega);
        // The whole force along the guide, friction included.
        let needed = self
            .equation
            .generalized_force(&terms, row.omega, row.alpha);
        load.force = (needed - load.torque) / terms.pose.dx;
        Some(reactor.reactions(&terms.pose, row.omega, row.alpha, &load))
    }
}

/// The plan of a scene whose motion was measured.
fn plan(scene: &Scene) -> Result<Plan, Error> {
    if scene.reduced().clearance.is_some() {
        return Err(Error::refused(
            "with clearance in a joint the motion of the crank does not say where the slider is: inverse reads the equation of tight joints",
            "take [clearance] out of the scene, or set its radial to 0",
        ));
    }
    let mut prescribed = scene.clone();
    prescribed.motion.kind = MotionKind::ConstantSpeed;
    let mut plan = Plan::new(&prescribed, Method::Auto)?;
    plan.reason = "the crank motion is measured: nothing to integrate, the equation is read backwards along the fitted theta(t)".into();
    Ok(plan)
}

/// Refuses a fit that leaves the angles that the crank can take.
fn reachable(measurement: &Measurement, found: &Rows) -> Result<(), Error> {
    let Some(sample) = found.unreachable else {
        return Ok(());
    };
    Err(Error::refused(
        format!(
            "the fitted crank angle at {}, {} rad, is one at which the rod does not reach the guide",
            measurement.place(sample),
            found.rows[sample].theta
        ),
        "try another --fit or --degree, or check the lengths of the scene",
    ))
}

/// Refuses loads without a value along the motion; says where a guide locks itself, and refuses a motion all along which
/// it does.
fn finite(
    backwards: &Backwards<'_>,
    measurement: &Measurement,
    rows: &[InverseRow],
) -> Result<Option<String>, Error> {
    let place = |sample: usize| {
        let InverseRow { t, theta, .. } = rows[sample];
        let place = measurement.place(sample);
        format!("at {place} (t = {t} s, theta = {theta} rad)")
    };
    let without = || (0..rows.len()).filter(|i| rows[*i].crank_torque.is_none());
    for sample in without() {
        let row = &rows[sample];
        let load = backwards.equation.load(row.t, row.theta, row.omega);
        if !load.is_finite() {
            return Err(Error::refused(
                format!(
                    "the loads of the scene have no finite value {}",
                    place(sample)
                ),
                "let the tables of the scene cover the measured motion, or take the load out",
            ));
        }
        if backwards.guide.is_none() {
            return Err(Error::refused(
                format!("the crank torque is not a finite number {}", place(sample)),
                "check the units of the data, of the time above all",
            ));
        }
    }
    let (Some(first), count) = (without().next(), without().count()) else {
        return Ok(None);
    };
    let locks = |place: String| {
        format!(
            "the guide locks itself {place}: friction holds the slider against any torque on the crank"
        )
    };
    if count == rows.len() {
        return Err(Error::refused(
            locks(place(first)),
            "a motion like this one needs less friction, or the longer rod of another mechanism: check [friction] and [geometry]",
        ));
    }
    let samples = match count {
        1 => place(first),
        _ => format!("at {count} samples, the first {}", place(first)),
    };
    Ok(Some(format!(
        "{}; their crank torque is left empty, and the slider force is what drives it by a pull or push on the slider",
        locks(samples)
    )))
}
