//! Resolution test for state loads on a panel.

use super::panel::{PanelTable, Problem};
use super::solution::PanelSolution;
use super::{Dynamics, State, Table};
use crate::engine::energy::NotApplicable;
use crate::engine::events::ANGLE_ROUNDING;
use crate::engine::resolution::{Feature, ForceAlong, NodeCriterion, Unresolved, unresolved};
use crate::numeric::angle::Angle;
use crate::numeric::chebyshev::{MAX_DEGREE, Series, largest};
use crate::numeric::enclosure::{Interval, MotionPiece, Variation, ellipses};
use crate::numeric::exact::SUM_ROUNDING;

/// Motion on a solved panel.
struct OnPanel<'a, D: Dynamics> {
    problem: &'a Problem<'a, D>,
    solution: &'a PanelSolution,
    /// Time after the start of the panel as a series in x, s.
    time: Series,
    /// Non-conservative force as a series in x, N m.
    non_conservative: Series,
    /// Bounds of the deviation of dt/dx from its mean and of d²t/dx², s.
    varies: [f64; 2],
}

/// Returns the fraction at which a solved panel has to end for its points to resolve the loads; none if they do.
///
/// # Errors
/// [`NotApplicable::NotFinite`] for a panel with a pole of a load.
pub(super) fn unresolved_at(
    problem: &Problem<'_, impl Dynamics>,
    tail: f64,
    solution: &PanelSolution,
) -> Result<Option<f64>, NotApplicable> {
    let (panel, kinetic) = (problem.panel, problem.start.kinetic);
    if !problem.dynamics.varies_between_nodes() {
        return Ok(None);
    }
    let (rule, slope) = (panel.rule, &solution.slope);
    let degree = rule.degree();
    let sum = |of: fn(f64) -> f64| {
        let terms = (1..=degree).map(|k| of(k as f64) * slope.coefficient(k).abs());
        terms.sum::<f64>()
    };
    let way = OnPanel {
        problem,
        solution,
        time: slope.integral(),
        non_conservative: rule.series(&solution.forces.non_conservative),
        varies: [sum(|_| 1.0), sum(|k| k * k)],
    };
    let forces = largest(&solution.forces.non_conservative[..=degree]).max(panel.largest_force);
    let rounding = SUM_ROUNDING * forces;
    let look = NodeCriterion {
        nodes: degree,
        ellipses: ellipses(degree, tail),
        allowed: rounding.max(tail * kinetic / panel.half().abs()),
        least: 2.0 * ANGLE_ROUNDING / panel.half().abs(),
        finest: ANGLE_ROUNDING / panel.half().abs(),
        has_interpolant: true,
    };
    match unresolved(&way, look) {
        Some(Unresolved {
            feature: Feature::Pole,
            ..
        }) => Err(NotApplicable::NotFinite),
        found => Ok(found.map(|found| found.at)),
    }
}

/// True if the criterion resolves the loads over a range of speeds (rad/s), at each point of a panel.
pub(super) fn resolves_speeds<D: Dynamics>(
    dynamics: &D,
    panel: &PanelTable<D::Place>,
    speed: Interval,
    look: NodeCriterion,
) -> bool {
    let points = &panel.rule.points()[..=panel.rule.degree()];
    points.iter().all(|x| {
        let angle = Angle::new(panel.turns, panel.piece.angle(*x));
        let reach = MotionPiece {
            t: Interval::default(),
            angle: Interval::point(angle.radians()),
            speed,
        };
        look.resolves(|ellipse| dynamics.variation(&reach, ellipse))
    })
}

impl<D: Dynamics> OnPanel<'_, D> {
    fn angle(&self, at: f64) -> Angle {
        let Problem { panel, start, .. } = self.problem;
        Angle::new(start.turns, panel.piece.angle(2.0 * at - 1.0))
    }

    fn time(&self, at: f64) -> f64 {
        self.problem.start.t + self.time.value(2.0 * at - 1.0)
    }

    fn speed(&self, slope: f64) -> f64 {
        self.problem.start.direction * self.problem.panel.half().abs() / slope
    }
}

impl<D: Dynamics> ForceAlong for OnPanel<'_, D> {
    fn variation(&self, from: f64, to: f64, ellipse: f64) -> Variation {
        let slope = &self.solution.slope;
        let [about, steep] = self.varies;
        let by_mean = Interval::point(slope.coefficient(0)).widened(about);
        let by_middle = Interval::point(slope.value(from + to - 1.0)).widened(steep * (to - from));
        let slowness = Interval::new(
            by_mean.low.max(by_middle.low),
            by_mean.high.min(by_middle.high),
        );
        let least = self.solution.slopes[..=slope.degree()]
            .iter()
            .fold(f64::INFINITY, |least: f64, slope| least.min(*slope));
        // A rotating crank is slower everywhere than twice the largest speed at the points.
        let low = slowness.low.max(0.5 * least);
        let reach = MotionPiece {
            t: Interval::between(self.time(from), self.time(to)),
            angle: Interval::between(self.angle(from).radians(), self.angle(to).radians()),
            speed: Interval::between(self.speed(low), self.speed(slowness.high.max(low))),
        };
        self.problem.dynamics.variation(&reach, ellipse)
    }

    fn force(&self, at: f64) -> f64 {
        let (dynamics, panel) = (self.problem.dynamics, self.problem.panel);
        let x = 2.0 * at - 1.0;
        let speed = self.speed(self.solution.slope.value(x));
        let mut table = Table::default();
        let mut angles = [0.0; MAX_DEGREE + 1];
        angles[0] = self.angle(at).rest;
        // The order of the angles gives the direction of the panel.
        angles[1] = panel.piece.to;
        dynamics.fill_table(panel.turns, (&angles, 2), panel.side, &mut table);
        let Some(place) = table.places.first() else {
            return 0.0;
        };
        let [state_loads] = dynamics.state_loads(&[State {
            place,
            t: self.time(at),
            angle: self.angle(at),
            speed,
        }]);
        let squared = table.switch.map_or(0.0, |switch| switch.force[0]) * speed * speed;
        table.push[0] - table.damping[0] * speed + squared + state_loads
    }

    fn missed(&self, at: &mut [f64]) {
        for at in at {
            *at = self.force(*at) - self.non_conservative.value(2.0 * *at - 1.0);
        }
    }
}
