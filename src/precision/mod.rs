//! Work-precision diagram: time and error of each applicable method at a ladder of tolerances, against a reference.

mod cell;

use serde::Serialize;

use crate::error::Error;
use crate::numeric::double_double::DoubleDouble;
use crate::plan::{Engine, Method, Plan};
use crate::scene::{Extent, Places, Scene};
use cell::{MethodRun, closed_form, run, tight_runs, time};

/// Settings of a comparison.
#[derive(Clone, Debug, PartialEq)]
pub struct PrecisionOptions {
    /// Tolerances for every method.
    pub tolerances: Vec<f64>,
    /// Timed runs of each method at each tolerance, at least one; fewer if all take longer than `most_s`.
    pub repeats: u32,
    /// Time limit, s, after which no new round of timed runs begins.
    pub most_s: f64,
    /// Maximum number of evaluations of the equation in one run; the row of a run that needs more states a failure.
    pub max_evaluations: u64,
}

impl Default for PrecisionOptions {
    fn default() -> PrecisionOptions {
        PrecisionOptions {
            tolerances: (4..=13).map(|k| 10f64.powi(-k)).collect(),
            repeats: 15,
            most_s: 5.0,
            max_evaluations: 5_000_000,
        }
    }
}

/// Result of one method at one tolerance; missing values are none.
#[derive(Clone, Debug, Default, Serialize)]
pub struct PrecisionRow {
    /// Method, by its `--method` name; `contact` for scenes with a loose joint.
    pub method: String,
    /// Tolerance of the method.
    pub tolerance: f64,
    /// Error of the crank angle at the end, rad; an upper bound if [`Self::error_is_bound`].
    pub error_theta_rad: Option<f64>,
    /// Error of the crank speed at the end, rad/s; an upper bound if [`Self::error_is_bound`].
    pub error_omega_rad_per_s: Option<f64>,
    /// Estimated error of the crank angle at the end, rad, as stated by the run.
    pub estimate_theta_rad: Option<f64>,
    /// Estimated error of the crank speed at the end, rad/s, as stated by the run.
    pub estimate_omega_rad_per_s: Option<f64>,
    /// Shortest wall time of the solution, s, without error estimate.
    pub wall_s: Option<f64>,
    /// Median wall time of the solution, s, without error estimate.
    pub wall_median_s: Option<f64>,
    /// Number of timed runs.
    pub runs: usize,
    /// Number of evaluations of the equation.
    pub evaluations: Option<u64>,
    /// Number of steps.
    pub steps: Option<u64>,
    /// Whether an error (angle, speed) is less than a hundred times that of the reference: the error stated is
    /// then the sum of the distance from the reference and the error of the reference.
    pub error_is_bound: bool,
    /// Reference of this row, if it differs from that of the scene.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub measured_against: Option<String>,
    /// Reason for missing values.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub failure: Option<String>,
}

/// Comparison of the methods for one scene.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Precision {
    /// Title of the scene.
    pub scene: String,
    /// Time of the compared state, s: end of the run, or of the motion if the equations end earlier.
    pub t_s: f64,
    /// Description of the reference.
    pub reference: String,
    /// Error bound of the crank angle of the reference, rad.
    pub reference_error_theta_rad: Option<f64>,
    /// Error bound of the crank speed of the reference, rad/s.
    pub reference_error_omega_rad_per_s: Option<f64>,
    /// Reasons why methods do not apply to the scene, one per method.
    pub left_out: Vec<String>,
    /// Rows, grouped by method.
    pub rows: Vec<PrecisionRow>,
}

impl Precision {
    /// Whether any method reached the end of the run, or of the motion.
    pub fn has_results(&self) -> bool {
        let mut rows = self.rows.iter();
        rows.any(|row| row.error_theta_rad.is_some() || row.failure.is_none())
    }

    /// Returns the comparison of a scene that cannot be computed: one row with the reason.
    pub fn refused(scene: &Scene, why: &Error) -> Precision {
        let row = PrecisionRow {
            method: Method::Auto.to_string(),
            tolerance: scene.run.tolerance,
            failure: Some(first_line(why)),
            ..PrecisionRow::default()
        };
        Precision {
            scene: scene.title.clone().unwrap_or_default(),
            reference: "none".to_owned(),
            rows: vec![row],
            ..Precision::default()
        }
    }
}

/// Compares all methods that the plan of a scene allows. A run over a number of turns is compared at the time when the
/// planned method completes them.
///
/// The reference is the run at tolerance 1e-13 with the least estimated angle error of all methods; rows of the method
/// that made it are measured against the next best. A prescribed motion has a closed form as reference. An error below
/// a hundred times that of the reference is stated as a bound.
///
/// # Errors
/// [`Error::Scene`] for impossible values or tolerances, [`Error::Refused`] for a scene that cannot be
/// computed.
///
/// ```
/// use slider_crank::scene::Scene;
/// use slider_crank::precision::{PrecisionOptions, precision};
///
/// let options = PrecisionOptions {
///     tolerances: vec![1e-9],
///     repeats: 1,
///     ..PrecisionOptions::default()
/// };
/// let result = precision(&Scene::duarte().duration(0.1), &options)?;
/// let energy = result.rows.iter().find(|row| row.method == "energy").unwrap();
/// assert!(energy.error_theta_rad.unwrap() < 1e-13);
/// # Ok::<(), slider_crank::error::Error>(())
/// ```
pub fn precision(scene: &Scene, options: &PrecisionOptions) -> Result<Precision, Error> {
    precision_against(scene, options, &|_, _, _| None)
}

/// Reference state at the end of a run, with error bounds.
#[derive(Clone, Debug)]
#[doc(hidden)]
pub struct Reference {
    pub what: String,
    /// Crank angle, rad.
    pub theta: DoubleDouble,
    /// Crank speed, rad/s.
    pub omega: DoubleDouble,
    /// Error bound of the crank angle, rad.
    pub theta_error: f64,
    /// Error bound of the crank speed, rad/s.
    pub omega_error: f64,
    /// Time at which the equations end, s, if before the end of the run.
    pub ends_at: Option<f64>,
}

/// Function from scene, end time (s) and maximum number of evaluations to the reference state, if it finds one.
#[doc(hidden)]
pub type FindReference<'a> = dyn Fn(&Scene, f64, u64) -> Option<Reference> + 'a;

/// Compares methods as [`precision`] does, against the reference of `find` where there is one.
///
/// # Errors
/// Errors of [`precision`].
#[doc(hidden)]
pub fn precision_against(
    scene: &Scene,
    options: &PrecisionOptions,
    find: &FindReference,
) -> Result<Precision, Error> {
    let plan = Plan::new(scene, Method::Auto)?;
    let t_end = last_time(scene, options)?;
    let mut scene = scene.clone();
    scene.run.extent = Some(Extent::Duration(t_end));
    // Errors must not point at lines of the file for values set here.
    scene.places = Places::default();
    let mut left_out = Vec::new();
    let mut cells = Vec::new();
    // A loose joint has one engine, run as `Method::Auto`.
    let loose = plan.engine == Engine::Contact;
    for method in Method::ALL
        .into_iter()
        .filter(|method| (*method == Method::Auto) == loose)
    {
        if let Err(refused) = Plan::new(&scene, method) {
            if (method == Method::ClosedForm) == (plan.engine == Engine::ClosedForm) {
                left_out.push(first_line(&refused));
            }
            continue;
        }
        for &tolerance in &options.tolerances {
            cells.push(MethodRun::new(&scene, method, tolerance, options)?);
        }
    }
    let common = find(&scene, t_end, options.max_evaluations)
        .or_else(|| (plan.engine == Engine::ClosedForm).then(|| closed_form(&scene, t_end)));
    let references = match common {
        Some(common) => vec![(None, common)],
        None => tight_runs(&scene, options),
    };
    let best = references.first().map(|(_, reference)| reference);
    let ends_at = best.and_then(|reference| reference.ends_at);
    time(&mut cells, ends_at.is_some(), options);
    let rows = cells.iter().map(|cell| {
        let mut row = cell.row(&references);
        if loose {
            row.method = plan.engine.name().to_owned();
        }
        row
    });
    Ok(Precision {
        scene: scene.title.clone().unwrap_or_default(),
        t_s: ends_at.unwrap_or(t_end),
        rows: rows.collect(),
        reference: best
            .map_or("none: no method reaches the end", |best| &best.what)
            .to_owned(),
        reference_error_theta_rad: best.map(|best| best.theta_error),
        reference_error_omega_rad_per_s: best.map(|best| best.omega_error),
        left_out,
    })
}

fn first_line(error: &Error) -> String {
    let text = error.to_string();
    text.lines().next().unwrap_or_default().to_owned()
}

fn last_time(scene: &Scene, options: &PrecisionOptions) -> Result<f64, Error> {
    match scene.run.extent {
        Some(Extent::Duration(duration)) => Ok(duration),
        _ => {
            let run = run(scene, Method::Auto, false, options)?;
            run.stopped.map_or(Ok(run.last.t_s), |why| {
                Err(Error::refused(why.to_string(), "give the run a duration"))
            })
        }
    }
}
