//! Where a run is looked at for its largest forces: places close enough to show them, in order.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use super::super::driving_torque::Drive;
use super::super::result::Summary;
use super::super::simulation::Simulation;
use super::{FORCES, sizes};
use crate::mechanism::Linkage;
use crate::scene::{Scene, Variable};

/// Least rows over time.
const LEAST_ROWS: f64 = 720.0;

/// A run along a parameter.
pub(super) struct Way<'a> {
    /// Values of the parameter, in order.
    pub places: Vec<f64>,
    /// Sizes of the forces there.
    pub sizes: Box<dyn Fn(f64) -> Option<[f64; FORCES]> + 'a>,
    /// The time there, s.
    pub time: Box<dyn Fn(f64) -> f64 + 'a>,
}

impl<'a> Way<'a> {
    /// Over the crank angle if the motion is a function of it, else over time.
    pub fn of(scene: &Scene, run: &'a Simulation, most: usize) -> Option<Way<'a>> {
        let way = at_constant_speed(run).or_else(|| over_orbit(run));
        way.or_else(|| over_time(scene, run, most))
    }
}

/// One turn if all are the same, else the whole run; as close as geometry and loads ask for.
fn at_constant_speed(run: &Simulation) -> Option<Way<'_>> {
    let (start, speed) = run.trajectory.as_ref()?.as_uniform()?;
    let maker = run.dense.maker.as_ref()?;
    let drive = Drive {
        equation: &maker.equation,
        maker,
        start,
        speed,
        end: run.summary.last.t_s,
    };
    let (places, whole) = drive.places().ok()?;
    let turn = TAU / speed.abs();
    let reactions = move |t: f64| maker.reactions(t, start.plus(speed * t), speed, Some(0.0));
    Some(Way {
        places,
        sizes: Box::new(move |t| reactions(t).as_ref().map(sizes)),
        time: Box::new(move |t| if whole { t.rem_euclid(turn) } else { t }),
    })
}

/// The points of the series of which the motion is made.
fn over_orbit(run: &Simulation) -> Option<Way<'_>> {
    let orbit = run.trajectory.as_ref()?.as_orbit()?;
    let end = run.summary.last.t_s;
    let maker = run.dense.maker.as_ref()?;
    // The time of a place takes longer than all else.
    let timed = maker.equation.loads().reads().has(Variable::T);
    let reactions = move |at: f64| {
        let (angle, speed) = orbit.state_at_place(at)?;
        let t = if timed { orbit.time_of_place(at)? } else { 0.0 };
        maker.reactions(t, angle, speed, None)
    };
    Some(Way {
        places: orbit.places(end)?,
        sizes: Box::new(move |at| reactions(at).as_ref().map(sizes)),
        time: Box::new(move |at| orbit.time_of_place(at).unwrap_or(end)),
    })
}

/// Rows at equal times: the crank turns by a degree at most between two of them.
fn over_time<'a>(scene: &Scene, run: &'a Simulation, most: usize) -> Option<Way<'a>> {
    let end = run.summary.last.t_s;
    let period = run.trajectory.as_ref()?.period();
    let span = period.map_or(end, |period| period.min(end));
    let step = first_step(scene, &run.summary);
    let rows = (span / step).ceil();
    let place = |index: usize| (index as f64 * step).min(span);
    (rows <= most as f64).then(|| Way {
        places: (0..=rows as usize).map(place).collect(),
        sizes: Box::new(move |t| run.row(t)?.reactions.as_ref().map(sizes)),
        time: Box::new(|t| t),
    })
}

/// Time between the rows, s: the crank turns by a degree at most, and by less where the run has narrow peaks.
fn first_step(scene: &Scene, summary: &Summary) -> f64 {
    let fastest = summary.omega_min.abs().max(summary.omega_max.abs());
    let way = fastest * summary.last.t_s;
    let narrow = narrowest(&Linkage::new(&scene.geometry), scene.motion.angle, way);
    let angle = (PI / 180.0).min(0.1 * narrow);
    summary.last.t_s / (way / angle).max(LEAST_ROWS)
}

/// Least width in the crank angle, rad, of the peaks on a way (rad) from an angle. Rods that are hardly long enough make
/// some of the width sqrt((l − |e ± r|)/r) where the crank stands normal to the guide; away from there nothing is narrower
/// than the distance from it.
fn narrowest(linkage: &Linkage, angle: f64, way: f64) -> f64 {
    let Linkage { r, l, e, .. } = *linkage;
    let width = |side: f64| {
        let apart = (angle - side * FRAC_PI_2).rem_euclid(TAU);
        let distance = apart.min(TAU - apart) - way;
        ((l - (e + side * r).abs()) / r).abs().sqrt().max(distance)
    };
    width(1.0).min(width(-1.0))
}
