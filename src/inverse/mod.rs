//! Slider force and crank torque from a measured motion: samples and a scene go in, force and torque with their
//! standard errors come out, by an iterated extended Kalman smoother whose model is the equation of motion (or by a
//! polynomial), and by inverse dynamics along the estimated motion.
//!
//! ```
//! use slider_crank::scene::{Measurement, Reading, Scene};
//! use slider_crank::inverse::{FitKind, InverseOptions, inverse};
//!
//! fn main() -> Result<(), slider_crank::error::Error> {
//!     let scene = Scene::load("data/duarte-engine.toml")?;
//!     let motion = Measurement::load("data/duarte-motion.csv", &Reading::default())?;
//!     let options = InverseOptions { fit: FitKind::Smoother, reactions: true, ..InverseOptions::default() };
//!
//!     let found = inverse(&scene, &motion, &options)?;
//!     for warning in &found.summary.warnings {
//!         eprintln!("{warning}");
//!     }
//!     for row in &found.rows {
//!         // None where the motion does not determine the force.
//!         let (Some(force), Some(se)) = (row.slider_force, row.slider_force_se) else { continue };
//!         let band = found.summary.band_factor * se;
//!         println!("t = {} s: {force} N, 95 % within {band} N", row.t);
//!     }
//!     let guide = found.reactions(&found.rows[0]).map(|forces| forces.guide);
//!     println!("the guide presses with {guide:?} N at the beginning");
//!     Ok(())
//! }
//! ```

mod all_samples;
mod as_printed;
mod averaging;
mod candidates;
mod code_moments;
mod comparison;
mod condensed;
mod estimate;
mod first_path;
mod fitted;
mod grid;
pub mod identify;
mod intensity;
mod interval;
mod likelihood;
mod limit;
mod linear_smoother;
mod maximum;
mod mean_cycle;
mod mean_length;
mod measurement_model;
mod model;
mod motion_estimate;
mod noise_search;
mod options;
mod outliers;
mod polynomial;
mod problem;
mod quantised;
mod record;
mod repeating;
mod residual_tests;
mod result;
mod rotation;
mod row;
mod samples;
mod scales;
mod selection;
mod sensors_beside;
mod smoother;
mod tones;
mod turns;
mod typical_sizes;
mod weighed;

pub use as_printed::AsPrinted;
pub use mean_cycle::{CycleMean, MeanRow};
pub use options::{FitKind, InverseOptions};
pub use result::bands::{BandRule, DeadCentreBand};
pub use result::shared_errors::BudgetShare;
pub use result::summary::{
    CandidateSummary, Carrier, DataSummary, FitSummary, ForceRange, IntensitySummary,
    InverseSummary, SensorSummary, ToneSummary,
};
pub use row::{InverseRow, Residual};

use self::fitted::Fitted;
use self::measurement_model::Sensor;
use self::result::inverse_dynamics::{Guide, InverseDynamics};
use self::result::rows::Rows;
use self::result::shared_errors::SharedErrors;
use crate::error::Error;
use crate::mechanism::{Equation, Reactions, Reactor};
use crate::numeric::parallel;
use crate::numeric::stop::Stop;
use crate::numeric::student;
use crate::scene::{Measurement, MovedScene, Scene};

/// Slider force and crank torque along a measured motion.
#[derive(Debug)]
pub struct Inverse {
    /// Summary: plan, data, fit, ranges, bands and warnings.
    pub summary: InverseSummary,
    /// One row for each sample.
    pub rows: Vec<InverseRow>,
    /// One residual for each sample.
    pub residuals: Vec<Residual>,
    equation: Equation,
    reactor: Option<Reactor>,
    shared: SharedErrors,
    cycle: u8,
}

/// Computes slider force and crank torque from a measured motion.
///
/// # Errors
/// [`Error::Scene`] for impossible values of scene or data, [`Error::Refused`] for what cannot be computed,
/// [`Error::Interrupted`].
///
/// ```
/// use slider_crank::scene::{Measured, Measurement, Scene, Slider};
/// use slider_crank::inverse::{InverseOptions, inverse};
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
    inverse_of_uncertain(scene, &[], measurement, options)
}

/// Computes slider force and crank torque as [`inverse`], with the errors of uncertain scene values in the bands.
///
/// # Errors
/// The errors of [`inverse`].
pub fn inverse_of_uncertain(
    scene: &Scene,
    uncertain: &[MovedScene],
    measurement: &Measurement,
    options: &InverseOptions,
) -> Result<Inverse, Error> {
    let found = parallel::inside(|| recovered(scene, uncertain, measurement, options));
    match &options.stop {
        // An interrupted fit looks like unusable samples.
        Some(stop) if stop.is_requested() => Err(Error::Interrupted),
        _ => found,
    }
}

fn recovered(
    scene: &Scene,
    uncertain: &[MovedScene],
    measurement: &Measurement,
    options: &InverseOptions,
) -> Result<Inverse, Error> {
    let scene = &measurement.known_in(scene)?;
    let plan = result::refusals::plan(scene)?;
    let reactor = options.reactions.then(|| Reactor::new(scene)).transpose()?;
    let guide = Guide::new(scene)?;
    let equation = Equation::new(scene);
    let sensor = Sensor::exact(equation.linkage(), measurement.measured());
    let stop = options.stop.as_ref();
    let angles =
        turns::branch_choice::crank_angles(&sensor, measurement, &equation, &scene.motion, stop)?;
    let given = samples::Given {
        measurement,
        angles: &angles,
        equation: &equation,
        stop,
    };
    let zero = given.codes().and_then(|codes| codes.zero_error());
    let sources = result::shared_errors::sources(scene, uncertain, measurement, zero)?;
    let fitted = Fitted::new(given, options, &sources)
        .map_err(|what| Error::refused(what, "give more samples, or another --fit or --degree"))?;
    if stop.is_some_and(Stop::is_requested) {
        return Err(Error::Interrupted);
    }
    let backwards = InverseDynamics {
        equation: &equation,
        beside_forces: options.beside_forces,
        guide: guide.as_ref(),
    };
    let factor = student::half_band(fitted.free);
    let shared = SharedErrors::new(
        &sources,
        &backwards,
        &fitted.motion,
        &fitted.moved,
        measurement.times(),
    );
    let found = Rows::new(&backwards, &fitted, measurement, &shared, factor);
    limit::keeps_clear(&angles.sensor, &fitted, measurement)?;
    turns::branch_tracking::resolves(&angles.sensor, &found.rows)?;
    let locked = result::refusals::finite(&backwards, measurement, &found.rows)?;
    let (measured, rows) = (measurement.measured(), &found.rows);
    let warnings = [
        measurement.notes().to_vec(),
        angles.warnings.clone(),
        result::warnings::of_scene(scene, options),
        result::warnings::of_motion(scene, measured, rows),
        locked.into_iter().collect(),
        result::warnings::of_fit(&fitted, measurement),
        Vec::from_iter(result::warnings::of_sensor(
            &fitted, measured, &equation, rows,
        )),
    ];
    let force = ForceRange::of(rows, |row| row.slider_force, |row| row.slider_force_se);
    let torque = ForceRange::of(rows, |row| row.crank_torque, |row| row.crank_torque_se);
    let summary = InverseSummary {
        scene: scene.title.clone().unwrap_or_default(),
        plan,
        data: DataSummary::new(measurement, &found.rows),
        fit: fitted.summary,
        beside_forces: options.beside_forces,
        band_factor: factor,
        slider_force: force,
        crank_torque: torque.unwrap_or_default(),
        error_budget: shared.budget(&found.rows),
        dead_centre_bands: found.bands,
        dead_centre_rule: found.rule,
        warnings: warnings.concat(),
    };
    Ok(Inverse {
        summary,
        rows: found.rows,
        residuals: fitted.residuals,
        reactor,
        equation,
        shared,
        cycle: fitted.cycle,
    })
}

impl Inverse {
    /// True if joint forces were requested.
    pub fn with_reactions(&self) -> bool {
        self.reactor.is_some()
    }

    /// Returns the lever arm x' of the slider force at a row, m/rad.
    pub fn lever_arm(&self, row: &InverseRow) -> f64 {
        self.equation.linkage().pose(row.theta).dx
    }

    /// Returns the joint forces of a row with its slider force acting; none if the row has no force or joint forces
    /// were not requested.
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
