//! Model over the crank angle for the energy and angle engines: inertia, potential and generalized force of a scene.

mod panel_ends;
mod profile;

use std::cell::{Cell, RefCell};
use std::f64::consts::TAU;

use super::guide_friction::{
    DEAD_CENTRE_WIDTH, GuideFriction, GuideLoadEffect, NEARBY_ANGLE, PanelPlace,
    sign_between_dead_centres,
};
use super::run_setup::RunSetup;
use crate::engine::WorkLimit;
use crate::engine::angle::{Dynamics, Panels, State, StateVariable, Table};
use crate::mechanism::{Equation, LoadValue};
use crate::numeric::angle::{self, Angle};
use crate::numeric::chebyshev::{MAX_DEGREE, Values};
use crate::numeric::enclosure::{Interval, MotionPiece, Variation};
use crate::plan::{Engine, cycle_over_angle};
use crate::scene::{Load, Variable};
use panel_ends::{PanelEnds, sorted_corners};

pub(super) use panel_ends::SAME_CORNER;

/// Inertia, generalized force and loads of an equation as functions of the crank angle.
pub(super) struct AngleModel<'a> {
    equation: &'a Equation,
    /// Guide, if it has friction.
    guide: Option<&'a GuideFriction>,
    /// Crank speed at the start, rad/s.
    speed: f64,
    /// Whole turns of the start, added to all angles: loads over theta may differ from turn to turn.
    turns: f64,
    /// True if the inertia vanishes at the dead centres: √M has a corner there.
    inertia_vanishes: bool,
    /// Dead centres of a turn, rad.
    dead_centres: Vec<f64>,
    /// Corners of loads in a turn, rad, and dead centres where the inertia vanishes.
    corners: Vec<f64>,
    /// Number of turns after which the loads repeat.
    cycle: u32,
    /// Corners of loads in a cycle, rad.
    load_corners: Vec<f64>,
    /// Corners of loads and dead centres of a cycle, rad.
    pub cycle_corners: Vec<f64>,
    /// Corners and narrow parts of formulas; the flag is set where they are corners of each turn.
    panel_ends: PanelEnds<'a>,
    panel_ends_are_corners: bool,
    repeats: bool,
    /// Work of the loads in one turn and the error of this work, J, if all turns are equal.
    work_of_turn: Option<(f64, f64)>,
    evaluations: Cell<u64>,
    /// Limit on the number of positions of a motion from its energy.
    limit: WorkLimit<'a>,
    shared: Option<RefCell<Panels<PanelPlace>>>,
}

impl<'a> AngleModel<'a> {
    /// Makes the model of a run; angles exclude the whole turns of the start. Panels end at the rows of tables over the
    /// crank angle, and at dead centres where the inertia vanishes.
    pub fn of(task: &'a RunSetup<'_>) -> AngleModel<'a> {
        let (equation, start) = (task.equation(), task.start());
        let loads = equation.loads();
        let dead_centres = task.dead_centres();
        let inertia_vanishes = task.inertia_vanishes();
        let panel_ends = PanelEnds::new(task);
        let known_cycle = match task.plan.engine {
            Engine::Time => None,
            _ => cycle_over_angle(task.scene).ok(),
        };
        let cycle = known_cycle.unwrap_or(1);
        let length = f64::from(cycle) * TAU;
        let ends_in_cycle = known_cycle.map(|_| panel_ends.in_cycle(length));
        let ends_in_cycle = ends_in_cycle.unwrap_or_default();
        let tables = loads.called().flat_map(Load::angle_corners);
        let in_turn = sorted_corners(tables.map(|theta| theta.rem_euclid(TAU)));
        let of_loads = match cycle {
            1 => in_turn.clone(),
            // Corners at the start of the cycle belong to the cycle.
            _ => loads.corners_between(-SAME_CORNER, length - SAME_CORNER),
        };
        let load_corners = sorted_corners(of_loads.into_iter().chain(ends_in_cycle));
        let in_cycle = angle::in_turns(&dead_centres, 0..cycle.into());
        let cycle_corners = sorted_corners(in_cycle.chain(load_corners.iter().copied()));
        let of_turn = if cycle == 1 {
            load_corners.clone()
        } else {
            in_turn
        };
        let mut model = AngleModel {
            equation,
            guide: task.maker.guide.as_deref(),
            speed: task.speed,
            turns: start.turns,
            corners: match inertia_vanishes {
                true => sorted_corners(dead_centres.iter().copied().chain(of_turn)),
                false => of_turn,
            },
            cycle,
            inertia_vanishes,
            cycle_corners,
            dead_centres,
            load_corners,
            panel_ends,
            panel_ends_are_corners: known_cycle == Some(1),
            repeats: loads.have_potential() && loads.constant.torque == 0.0,
            work_of_turn: None,
            evaluations: Cell::new(0),
            limit: task.options.limit(),
            shared: None,
        };
        let by_energy = task.plan.engine == Engine::Energy;
        if by_energy && model.panel_ends_are_corners && task.turns_fully() {
            model.work_of_turn = Some(model.work_of_one_turn());
        }
        model
    }

    /// Shares the tables of all positions, for many runs of one cycle.
    pub fn with_shared_panels(self) -> AngleModel<'a> {
        AngleModel {
            shared: Some(RefCell::default()),
            ..self
        }
    }

    /// Whether loads of the state are not analytic where the slider reverses, like v |v|.
    fn has_kinks_at_dead_centres(&self) -> bool {
        let point = Interval::point;
        let is_kink = |theta: &f64| {
            let reach = MotionPiece {
                t: point(0.0),
                angle: Interval::new(theta - NEARBY_ANGLE, theta + NEARBY_ANGLE),
                speed: point(self.speed),
            };
            self.variation(&reach, 1.0).deviation > 0.0
        };
        self.has_state_loads() && self.dead_centres.iter().any(is_kink)
    }

    /// Returns the angle with the whole turns of the start.
    fn angle(&self, theta: f64) -> Angle {
        Angle::new(self.turns, theta)
    }

    fn count(&self, positions: usize) {
        self.evaluations.update(|before| before + positions as u64);
    }
}

impl Dynamics for AngleModel<'_> {
    type Place = PanelPlace;

    fn positions(&self) -> u64 {
        self.evaluations.get()
    }

    fn fill_table(
        &self,
        turns: f64,
        (angles, count): (&Values, usize),
        side: f64,
        table: &mut Table<PanelPlace>,
    ) {
        self.count(count);
        let loads = self.equation.loads();
        let driven = self.has_state_loads();
        let mut guided = None;
        let at = match self.guide {
            None => self.equation.first_terms(angles, count),
            Some(guide) => {
                let (at, normals) = self.equation.first_guided(angles, count);
                guided = Some((guide, normals));
                at
            }
        };
        table.places.clear();
        let sign = driven.then(|| sign_between_dead_centres(&at.dx[..count]));
        let least_dx = DEAD_CENTRE_WIDTH * self.equation.linkage().r;
        let mut of_place = [LoadValue::default(); MAX_DEGREE + 1];
        for (i, angle) in angles.iter().enumerate().take(count) {
            let (x, dx) = (at.x[i], at.dx[i]);
            table.inertia[i] = at.m[i];
            let stored = loads.with_potential_at(x);
            let placed = loads.of_place(Angle::new(turns, *angle), x);
            table.force[i] = stored.generalized(dx) - at.dv[i];
            table.push[i] = placed.generalized(dx);
            table.damping[i] = loads.damping(dx);
            of_place[i] = stored.plus(placed);
            if driven {
                let load_effect = GuideLoadEffect::default();
                // A load that jumps where the slider reverses has its value on the panel also at the ends.
                let dx = if dx.abs() < least_dx {
                    (f64::EPSILON * least_dx).copysign(sign.unwrap_or_default())
                } else {
                    dx
                };
                table.places.push(PanelPlace { x, dx, load_effect });
            }
        }
        if let Some((guide, normals)) = guided {
            // Panels run in the direction of motion.
            let direction = (angles[count - 1] - angles[0]).signum();
            let nodes = (&at.dx[..count], &normals[..count]);
            guide.tabulate(nodes, direction * side, loads, &of_place, table);
        }
    }

    fn shared(&self) -> Option<&RefCell<Panels<PanelPlace>>> {
        self.shared.as_ref()
    }

    fn cycle(&self) -> u32 {
        self.cycle
    }

    fn has_state_loads(&self) -> bool {
        self.equation.loads().have_nonlinear_rates()
    }

    fn reads_time(&self) -> bool {
        self.has_state_loads() && self.equation.loads().reads.has(Variable::T)
    }

    fn state_variable(&self) -> Option<StateVariable> {
        let reads = self.equation.loads().reads_of_states;
        let of_speed = reads.has(Variable::Omega) || reads.has(Variable::V);
        match (reads.has(Variable::T), of_speed) {
            (true, false) => Some(StateVariable::Time),
            (false, true) => Some(StateVariable::Energy),
            _ => None,
        }
    }

    fn state_loads<const N: usize>(&self, at: &[State<'_, PanelPlace>; N]) -> [f64; N] {
        let now = PanelPlace::instants(at);
        let mut forces = [0.0; N];
        let loads = self.equation.loads().of_states(&now);
        for ((force, load), at) in forces.iter_mut().zip(&loads).zip(at) {
            let place = at.place;
            *force = load.generalized(place.dx) + place.load_effect.friction_torque(*load);
        }
        forces
    }

    fn varies_between_nodes(&self) -> bool {
        self.has_state_loads() && self.equation.loads().vary_between_nodes()
    }

    fn variation(&self, reach: &MotionPiece, ellipse: f64) -> Variation {
        let loads = self.equation.loads();
        let seen = self
            .equation
            .linkage()
            .enclosed_state(reach, loads.slider_use());
        let friction_torque = self.guide.map(|guide| guide.unit_load_effects(reach.angle));
        let arms = seen
            .unit_load_effects()
            .plus(friction_torque.unwrap_or_default());
        loads.variation_with_state(&seen, arms, ellipse)
    }

    fn switch_of_state_loads(&self, at: &State<'_, PanelPlace>) -> f64 {
        let [load] = self
            .equation
            .loads()
            .of_states(&PanelPlace::instants(&[*at]));
        at.place.load_effect.normal_force(load)
    }

    fn corners_of_cycle(&self) -> &[f64] {
        // Friction and dry loads change sign at the dead centres.
        let [_, dry_on_slider] = self.equation.loads().dry_on();
        let reverses = self.guide.is_some() || dry_on_slider;
        if reverses || self.inertia_vanishes || self.has_kinks_at_dead_centres() {
            &self.cycle_corners
        } else {
            &self.load_corners
        }
    }
}
