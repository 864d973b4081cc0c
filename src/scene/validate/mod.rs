//! Checks the values of a scene from any source; returns all that no mechanism can have.

mod clearance;
mod loads;

use std::f64::consts::TAU;

use super::check::Check;
use super::number::{apart, computed, show};
use super::{
    Every, Extent, Friction, Geometry, InertiaAbout, Motion, MotionKind, Problems, Rod, RodModel,
    Run, Scene,
};
use crate::numeric::exact::sum3;

/// Least local error target that can be met in double precision.
pub(crate) const LEAST_RUN_TOLERANCE: f64 = 1e-14;

/// Largest number of output rows; more, some hundred gigabytes, come from a wrong unit.
pub(crate) const MOST_OUTPUT_ROWS: f64 = 1e9;

/// Keys that decide whether the mechanism can be assembled.
const LENGTHS: [&str; 3] = ["geometry.crank", "geometry.rod", "geometry.offset"];

impl Scene {
    /// Checks all values of the scene.
    ///
    /// # Errors
    /// [`Problems`] with one entry for each impossible value.
    pub fn check(&self) -> Result<(), Problems> {
        let mut check = Check {
            problems: Vec::new(),
            places: &self.places,
        };
        problems(self, &mut check);
        check.places.reject_any(check.problems)
    }
}

/// Adds one problem for each impossible value. A value with a problem is not compared with others, which would report
/// the fault twice.
pub(super) fn problems(scene: &Scene, check: &mut Check) {
    geometry(check, &scene.geometry);
    if let Some(crank) = &scene.crank {
        let cg = [crank.cg, crank.cg_lateral];
        body(check, "crank", crank.mass, crank.inertia, cg);
        inertia(check, "crank", "O", crank.inertia, crank.mass * square(cg));
    }
    if let Some(rod) = &scene.rod {
        self::rod(check, rod, scene.geometry.rod);
    }
    if let Some(slider) = &scene.slider {
        check.not_negative("slider.mass", slider.mass, "kg");
    }
    if let Some(gravity) = &scene.gravity {
        check.not_negative("gravity.acceleration", gravity.acceleration, "m/s2");
        check.finite("gravity.direction", gravity.direction);
    }
    for of in scene.loads() {
        loads::load(check, &of.key.to_string(), of.key.on_slider, of.load);
    }
    if let Some(friction) = &scene.friction {
        self::friction(check, friction);
    }
    if let Some(clearance) = &scene.clearance {
        clearance::clearance(check, clearance);
    }
    start(check, &scene.geometry, &scene.motion);
    run(check, &scene.run, &scene.motion);
}

fn geometry(check: &mut Check, geometry: &Geometry) {
    check.positive("geometry.crank", geometry.crank, "m");
    check.positive("geometry.rod", geometry.rod, "m");
    check.finite("geometry.offset", geometry.offset);
    let (r, l, e) = (geometry.crank, geometry.rod, geometry.offset);
    // A single rounding, after the difference: crank plus rod may round up to the offset.
    let reach = sum3(r, l, -e.abs());
    if reach < 0.0 && check.has_no_problem(&LENGTHS) {
        let larger = if e.abs() > r + l {
            let (offset, most) = apart(e, r + l);
            format!("{offset} m is larger than crank plus rod, {most} m")
        } else {
            format!("is larger than crank plus rod by {} m", show(-reach))
        };
        let what = format!("the mechanism cannot be assembled: the offset {larger}");
        let help = "make the offset smaller or the rod longer";
        check.add("geometry.offset", what, help);
    }
}

fn body(check: &mut Check, name: &str, mass: f64, inertia: f64, cg: [f64; 2]) {
    check.not_negative(format_args!("{name}.mass"), mass, "kg");
    check.not_negative(format_args!("{name}.inertia"), inertia, "kg m2");
    check.finite(format_args!("{name}.cg"), cg[0]);
    check.finite(format_args!("{name}.cg_lateral"), cg[1]);
}

fn square(cg: [f64; 2]) -> f64 {
    cg[0] * cg[0] + cg[1] * cg[1]
}

/// Checks the moment of inertia of a body about a point against the `least` that its centre of gravity allows, kg m².
fn inertia(check: &mut Check, body: &str, about: &str, inertia: f64, least: f64) {
    let relative_rounding = 1e-9;
    if inertia < least * (1.0 - relative_rounding) && check.has_no_problem_in(body) {
        let (inertia, least) = apart(inertia, least);
        let what = format!(
            "{inertia} kg m2 about {about} is less than mass times distance of the centre of gravity squared, {least} kg m2"
        );
        let help =
            "no body has that: check inertia, mass and cg, and the point the inertia is about";
        check.add(format_args!("{body}.inertia"), what, help);
    }
}

fn rod(check: &mut Check, rod: &Rod, length: f64) {
    let cg = [rod.cg, rod.cg_lateral];
    body(check, "rod", rod.mass, rod.inertia, cg);
    if rod.inertia_about == InertiaAbout::CrankPin && rod.model == RodModel::Rigid {
        let least = rod.mass * square(cg);
        inertia(check, "rod", "the crank pin", rod.inertia, least);
    }
    if rod.model != RodModel::TwoMass || rod.mass == 0.0 {
        return;
    }
    if rod.cg_lateral != 0.0 && check.has_no_problem(&["rod.cg_lateral"]) {
        let lateral = show(rod.cg_lateral);
        let what = format!(
            "two masses at the pins have no lateral centre of gravity, but it is {lateral} m"
        );
        let help = "leave out cg_lateral or use model = \"rigid\"";
        check.add("rod.cg_lateral", what, help);
    }
    if !(0.0..=length).contains(&rod.cg) && check.has_no_problem(&["geometry.rod", "rod.cg"]) {
        let (cg, length) = apart(rod.cg, length);
        let what = format!("{cg} m is not between the pins, which are {length} m apart");
        let help = "two masses at the pins need it between them; use model = \"rigid\" otherwise";
        check.add("rod.cg", what, help);
    }
}

fn friction(check: &mut Check, friction: &Friction) {
    let (kinetic, held) = (friction.coefficient, friction.static_coefficient);
    check.not_negative("friction.coefficient", kinetic, "");
    if check.finite("friction.static_coefficient", held)
        && held < kinetic
        && check.has_no_problem(&["friction.coefficient", "friction.static_coefficient"])
    {
        let (held, kinetic) = apart(held, kinetic);
        let what = format!("the static coefficient {held} is below the kinetic one {kinetic}");
        let help = "give one at least as large, or leave it out";
        check.add("friction.static_coefficient", what, help);
    }
}

/// Returns the output rows of a run, as far as the scene determines them: rows over the crank angle of at least one
/// turn, at constant speed of the whole run; 0 if it does not.
fn rows(run: &Run, motion: &Motion) -> f64 {
    match (run.output_every, run.extent) {
        (Some(Every::Angle(step)), Some(Extent::Duration(duration)))
            if motion.kind == MotionKind::ConstantSpeed =>
        {
            (motion.speed.abs() * duration).max(TAU) / step
        }
        (Some(Every::Time(step)), Some(Extent::Duration(duration))) => duration / step,
        (Some(Every::Angle(step)), Some(Extent::Revolutions(turns))) => turns * TAU / step,
        (Some(Every::Angle(step)), _) => TAU / step,
        _ => 0.0,
    }
}

fn run(check: &mut Check, run: &Run, motion: &Motion) {
    match run.extent {
        Some(Extent::Duration(duration)) => check.not_negative("run.duration", duration, "s"),
        Some(Extent::Revolutions(turns)) => check.not_negative("run.revolutions", turns, ""),
        None => {}
    }
    match run.output_every {
        Some(Every::Time(step)) => check.positive("run.output_every", step, "s"),
        Some(Every::Angle(step)) => check.positive("run.output_every", step, "rad"),
        None => {}
    }
    if check.has_no_problem(&["run.output_every"]) && rows(run, motion) > MOST_OUTPUT_ROWS {
        let what = format!("more than {MOST_OUTPUT_ROWS} output rows would be written");
        let help = "give a larger step, like \"1 ms\" or \"1 deg\", or leave it out for 500 rows";
        check.add("run.output_every", what, help);
    }
    let largest = 0.1;
    if !(LEAST_RUN_TOLERANCE..=largest).contains(&run.tolerance) {
        let what = format!("a tolerance of {} cannot be used", show(run.tolerance));
        let usual = Run::default().tolerance;
        let help =
            format!("give one from {LEAST_RUN_TOLERANCE:e} to {largest}; {usual:e} is the default");
        check.add("run.tolerance", what, help);
    }
}

/// Checks the crank angle at the start: rounding must leave its place in the turn, and the rod must reach the guide. A
/// scene without motion has no start, but has kinematics.
fn start(check: &mut Check, geometry: &Geometry, motion: &Motion) {
    let angle = motion.angle;
    check.finite("motion.speed", motion.speed);
    // Doubles of this size, rad, are 0.007 degrees apart.
    let largest = 1e12;
    if check.finite("motion.angle", angle) && angle.abs() > largest {
        let what =
            format!("{angle:e} rad is so many turns that rounding hides the place in the last one");
        let help = format!("give an angle below {largest:e} rad");
        check.add("motion.angle", what, help);
    }
    let Geometry {
        crank, rod, offset, ..
    } = *geometry;
    let distance = (offset + crank * angle.sin()).abs();
    // At a limit of the angle, rounding may leave the pin this far outside, m.
    let rounding = 1e-12 * (crank + rod);
    let outside = distance > rod + rounding;
    if !outside
        || *motion == Motion::default()
        || !check.has_no_problem(&LENGTHS)
        || !check.has_no_problem(&["motion.angle"])
    {
        return;
    }
    let ranges = ranges(geometry).into_iter();
    let ranges = ranges.map(|range| range.map(computed));
    let ranges = ranges.map(|[from, to]| format!("from {from} to {to} deg"));
    let ranges: Vec<String> = ranges.collect();
    let (angle, distance, rod) = (show(angle.to_degrees()), computed(distance), show(rod));
    check.add(
        "motion.angle",
        format!("the mechanism has no position at a crank angle of {angle} deg: the crank pin is {distance} m from the guide, the rod {rod} m long"),
        format!("give an angle {}", ranges.join(" or ")),
    );
}

/// Returns the crank angles with |e + r sin θ| ≤ l, in degrees.
fn ranges(geometry: &Geometry) -> Vec<[f64; 2]> {
    let Geometry {
        crank, rod, offset, ..
    } = *geometry;
    let angle = |sine: f64| sine.asin().to_degrees();
    let (low, high) = ((-rod - offset) / crank, (rod - offset) / crank);
    match (low > -1.0, high < 1.0) {
        (true, true) => vec![
            [angle(low), angle(high)],
            [180.0 - angle(high), 180.0 - angle(low)],
        ],
        (true, false) => vec![[angle(low), 180.0 - angle(low)]],
        (false, true) => vec![[180.0 - angle(high), 360.0 + angle(high)]],
        (false, false) => Vec::new(),
    }
}
