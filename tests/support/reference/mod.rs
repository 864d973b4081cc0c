//! References in double-double arithmetic for motions made of pieces: with friction, past limits, with a loose joint.
//! Runs at two resolutions must agree; equations and method are independent of the engines.

mod collocation;
mod extended;
mod extrapolation;
mod guided;
mod loose;
mod whole;

use extended::Extended;
use extrapolation::{Fineness, State};
use guided::Guided;
use loose::Loose;
use slider_crank::error::Error;
use slider_crank::mechanism::{Class, Equation, Limits, Linkage};
use slider_crank::numeric::double_double::DoubleDouble;
use slider_crank::precision::{Precision, PrecisionOptions, Reference, precision_against};
use slider_crank::scene::{MotionKind, Scene};
use whole::distance;

/// Compares the methods, with a reference also for motions made of pieces.
pub fn precision(scene: &Scene, options: &PrecisionOptions) -> Result<Precision, Error> {
    precision_against(scene, options, &find)
}

fn find(scene: &Scene, t_end: f64, evaluations: u64) -> Option<Reference> {
    let reduced = scene.reduced();
    if reduced.clearance.is_some() {
        return loose(scene, t_end, evaluations);
    }
    let class = Limits::new(&Linkage::new(&reduced.geometry), 0.0).class;
    let whole = reduced.friction.is_none() && class == Class::RotatingCrank;
    if whole || scene.motion.kind == MotionKind::ConstantSpeed {
        return whole::extended(scene, t_end, evaluations);
    }
    // The reference equations do not include dry loads.
    if class == Class::ChangePoint || Equation::new(scene).loads().are_dry() {
        return None;
    }
    in_pieces(scene, t_end, evaluations)
}

const WHAT: &str = "extrapolation of order 20 in double-double arithmetic, event by event";

/// Step tolerances of the two runs for exact loads; loads in floats carry their rounding and need the coarser set.
const STEPS_EXACT: [f64; 2] = [1e-20, 1e-22];
const STEPS_ROUNDED: [f64; 2] = [1e-15, 1e-16];

/// Returns the reference of motions with friction or past limits, which are made of pieces.
fn in_pieces(scene: &Scene, t_end: f64, evaluations: u64) -> Option<Reference> {
    let extended = Extended::new(scene, t_end);
    let guided = Guided::new(scene, &extended, t_end);
    let [(coarse, _), (fine, ends)] = twice(&extended, evaluations, |fineness| {
        guided.end(scene, fineness)
    })?;
    Some(Reference {
        what: WHAT.to_owned(),
        theta: fine[1],
        omega: fine[2],
        theta_error: distance(coarse[1], fine[1]),
        omega_error: distance(coarse[2], fine[2]),
        ends_at: ends.then(|| fine[0].value()),
    })
}

/// Returns the reference of motions with a loose joint.
fn loose(scene: &Scene, t_end: f64, evaluations: u64) -> Option<Reference> {
    let [coarse, fine] = loose_ends(scene, t_end, evaluations)?;
    Some(Reference {
        what: WHAT.to_owned(),
        theta: fine[1],
        omega: fine[4],
        theta_error: distance(coarse[1], fine[1]),
        omega_error: distance(coarse[4], fine[4]),
        ends_at: None,
    })
}

/// Returns the slider position of a scene with a loose joint at a time (s), and its error bound, m.
pub fn slider(scene: &Scene, t_end: f64) -> Option<(DoubleDouble, f64)> {
    let [coarse, fine] = loose_ends(scene, t_end, PrecisionOptions::default().max_evaluations)?;
    Some((fine[3], distance(coarse[3], fine[3])))
}

fn loose_ends(
    scene: &Scene,
    t_end: f64,
    evaluations: u64,
) -> Option<[State<{ loose::NUMBERS }>; 2]> {
    let extended = Extended::new(scene, t_end);
    let loose = Loose::new(scene, &extended)?;
    twice(&extended, evaluations, |fineness| {
        loose.end(t_end, fineness)
    })
}

/// Makes two runs, the second with the finer resolution.
fn twice<T>(
    extended: &Extended,
    evaluations: u64,
    run: impl Fn(Fineness) -> Option<T>,
) -> Option<[T; 2]> {
    let steps = if extended.is_exact() {
        STEPS_EXACT
    } else {
        STEPS_ROUNDED
    };
    let [coarse, fine] = steps.map(|tolerance| Fineness {
        tolerance,
        evaluations,
    });
    Some([run(coarse)?, run(fine)?])
}
