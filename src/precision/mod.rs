//! Speed against error: every method that can serve a scene, at a ladder of tolerances, each against a tight run of another.

mod cell;

use serde::Serialize;

use crate::error::Error;
use crate::numeric::double_double::DoubleDouble;
use crate::plan::{Engine, Method, Plan};
use crate::scene::{Extent, Places, Scene};
use cell::{MethodRun, closed_form, run, tight_runs, time};

/// What is asked of a comparison.
#[derive(Clone, Debug, PartialEq)]
pub struct PrecisionOptions {
    /// Tolerances, each for every method.
    pub tolerances: Vec<f64>,
    /// Timed runs of each method at each tolerance; fewer if they take longer than `most_s`.
    pub repeats: u32,
    /// Most time for repeated runs of one scene, s.
    pub most_s: f64,
    /// Most evaluations of the equation in one run; a run that needs more is a row that says so.
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

/// One method at one tolerance. What does not exist is empty.
#[derive(Clone, Debug, Default, Serialize)]
pub struct PrecisionRow {
    /// The method, as `--method` names it; `contact` for scenes with a loose joint.
    pub method: String,
    /// Tolerance of the method.
    pub tolerance: f64,
    /// Error of the crank angle at the end, rad; an upper bound if [`Self::error_is_bound`].
    pub error_theta_rad: Option<f64>,
    /// Error of the crank speed at the end, rad/s; an upper bound if [`Self::error_is_bound`].
    pub error_omega_rad_per_s: Option<f64>,
    /// What the run states as error of its angle, rad.
    pub estimate_theta_rad: Option<f64>,
    /// What it states as error of its speed, rad/s.
    pub estimate_omega_rad_per_s: Option<f64>,
    /// Least time of the solution, without error estimate, s.
    pub wall_s: Option<f64>,
    /// Median of that time, s.
    pub wall_median_s: Option<f64>,
    /// Timed runs.
    pub runs: usize,
    /// Error of the slider's position at the end, m, where a joint is loose.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub error_slider_x_m: Option<f64>,
    /// What the run states as that error, m; none beyond the horizon of what is reproducible.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub estimate_slider_x_m: Option<f64>,
    /// Evaluations of the equation.
    pub evaluations: Option<u64>,
    /// Steps.
    pub steps: Option<u64>,
    /// Whether the reference is less than a hundred times better than the error of angle or speed: these are
    /// then the distance from the reference and the reference's own error, added.
    pub error_is_bound: bool,
    /// What it was measured against, if that is not the reference of the scene.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub measured_against: Option<String>,
    /// Why there are no numbers.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub failure: Option<String>,
}

impl PrecisionRow {
    fn empty(method: Method, tolerance: f64) -> PrecisionRow {
        PrecisionRow {
            method: method.to_string(),
            tolerance,
            ..PrecisionRow::default()
        }
    }
}

/// The comparison of one scene.
#[derive(Clone, Debug, Serialize)]
pub struct Precision {
    /// Title of the scene.
    pub scene: String,
    /// Time of the state that is compared, s: the end of the run or, if the equations end before, of the motion.
    pub t_s: f64,
    /// What the runs were measured against.
    pub reference: String,
    /// How far the reference's angle may be off, rad.
    pub reference_error_theta_rad: Option<f64>,
    /// How far the reference's speed may be off, rad/s.
    pub reference_error_omega_rad_per_s: Option<f64>,
    /// Methods that cannot serve the scene, with the reason.
    pub left_out: Vec<String>,
    /// The rows, method by method.
    pub rows: Vec<PrecisionRow>,
}

impl Precision {
    /// Whether any method reached the end of the run, or of the motion.
    pub fn has_results(&self) -> bool {
        self.rows
            .iter()
            .any(|row| row.error_theta_rad.is_some() || row.failure.is_none())
    }

    /// A scene that cannot be computed: one row that says why.
    pub fn refused(scene: &Scene, why: &Error) -> Precision {
        let mut row = PrecisionRow::empty(Method::Auto, scene.run.tolerance);
        row.failure = Some(first_line(why));
        Precision {
            scene: scene.title.clone().unwrap_or_default(),
            t_s: 0.0,
            reference: "none".to_owned(),
            reference_error_theta_rad: None,
            reference_error_omega_rad_per_s: None,
            left_out: Vec::new(),
            rows: vec![row],
        }
    }
}

/// Compares all methods that the plan of a scene allows. A run of so many turns is compared at the time at
/// which the planned method completes them.
///
/// The reference is the run of all methods at tolerance 1e-13 with the least stated error, and a row of its own method is
/// measured against the next best; a prescribed motion has a closed form. An error that is not a hundred times the reference's
/// own is stated as a bound.
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

/// The state at the end of a run, and how far it may be off.
#[derive(Clone, Debug)]
#[doc(hidden)]
pub struct Reference {
    pub what: String,
    /// rad
    pub theta: DoubleDouble,
    /// rad/s
    pub omega: DoubleDouble,
    /// rad
    pub theta_error: f64,
    /// rad/s
    pub omega_error: f64,
    /// The time (s) at which the equations end, if they do before the run.
    pub ends_at: Option<f64>,
    /// Slider position (m) and how far it may be off, where a joint is loose.
    pub slider: Option<(DoubleDouble, f64)>,
}

/// The state at the end of a scene's run to a time (s), by so many evaluations at the most.
#[doc(hidden)]
pub type FindReference<'a> = dyn Fn(&Scene, f64, u64) -> Option<Reference> + 'a;

/// As [`precision`], with a reference of one's own where one is found.
///
/// # Errors
/// As [`precision`].
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
    // The tolerances have no place in its file.
    scene.places = Places::default();
    let mut left_out = Vec::new();
    let mut cells = Vec::new();
    // A loose joint has one engine, which no method names.
    let loose = plan.engine == Engine::Contact;
    for method in Method::each().filter(|method| (*method == Method::Auto) == loose) {
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
            match run.stopped {
                None => Ok(run.last.t_s),
                Some(why) => Err(Error::refused(why.to_string(), "give the run a duration")),
            }
        }
    }
}
