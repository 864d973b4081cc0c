//! Checks of the extent of a run: absent, or in revolutions that the crank never completes.

use std::f64::consts::TAU;

use crate::mechanism::{Curve, CurveEquation, Limits, Linkage};
use crate::numeric::angle::Angle;
use crate::scene::{Extent, MotionKind, Problem, Scene, Variable};

/// Adds problems of the extent; `scene` has no parts of zero strength, `starts` is true if its start has no problem.
pub(super) fn problems(scene: &Scene, linkage: &Linkage, starts: bool, list: &mut Vec<Problem>) {
    let turns = match scene.run.extent {
        None => {
            list.push(Problem::new(
                "run",
                "the scene does not say how long the run is",
                "add [run] with duration = \"1 s\" or revolutions = 10",
            ));
            return;
        }
        Some(Extent::Duration(_)) => return,
        Some(Extent::Revolutions(turns)) => turns,
    };
    let free = scene.motion.kind == MotionKind::Free;
    if turns == 0.0 {
        return;
    }
    if let Some(widest) = widest_turn(scene, linkage).filter(|widest| turns * TAU > *widest) {
        list.push(Problem::new(
            "run.revolutions",
            format!(
                "run.revolutions: the crank cannot turn by more than {} deg between its limits and never completes {turns} turns",
                widest.to_degrees()
            ),
            "give run.duration instead",
        ));
    } else if scene.motion.speed == 0.0 && (!free || starts && is_balanced(scene, linkage)) {
        list.push(Problem::new(
            "run.revolutions",
            format!("a crank at rest never completes {turns} turns"),
            "give motion.speed, or run.duration",
        ));
    }
}

/// Returns the largest crank rotation between limits, rad; none if the crank turns fully or is driven into its limit.
fn widest_turn(scene: &Scene, linkage: &Linkage) -> Option<f64> {
    let reach = match (scene.clearance, scene.motion.kind) {
        (Some(clearance), _) => {
            Limits::new(&linkage.with_rod(linkage.l + clearance.radial), 0.0).reach
        }
        (None, MotionKind::ConstantSpeed) => return None,
        (None, MotionKind::Free) => Limits::new(linkage, 0.0).reach,
    };
    let widths = reach.iter().map(|[from, to]| to - from);
    widths.reduce(f64::max)
}

/// Whether a crank at rest starts in lasting equilibrium. False with friction or clearance, where only a run can tell.
fn is_balanced(scene: &Scene, linkage: &Linkage) -> bool {
    if scene.friction.is_some() || scene.clearance.is_some() {
        return false;
    }
    let theta = Angle::from(scene.motion.angle).reduced();
    Curve::through(linkage, theta).is_some_and(|(curve, q)| {
        let equation = CurveEquation::new(scene, curve);
        let loads = equation.loads();
        !loads.are_dry()
            && !loads.reads.has(Variable::T)
            && equation.free(0.0, q, 0.0).acceleration == 0.0
    })
}
