//! The mechanism as the energy engine sees it: inertia, potential and force over the crank angle.

use std::cell::Cell;
use std::f64::consts::TAU;

use crate::engine::angle::{Driven, Table};
use crate::engine::energy::Profile;
use crate::mechanism::{Equation, Limits};
use crate::numeric::angle::Angle;
use crate::numeric::chebyshev::Values;
use crate::numeric::gauss;
use crate::scene::Variable;

/// Inertia, potential and force of an equation whose loads depend on the position alone.
pub(super) struct Position<'a> {
    equation: &'a Equation,
    corners: Vec<f64>,
    repeats: bool,
    evaluations: Cell<u64>,
}

impl<'a> Position<'a> {
    /// Panels end at the dead centres, where the inertia of a mechanism without crank inertia has a corner, and
    /// at the rows of tables over the crank angle.
    pub fn new(equation: &'a Equation, limits: &Limits) -> Position<'a> {
        let loads = equation.loads();
        let dead_centres = limits.dead_centres.iter().map(|dc| dc.theta);
        let tables = loads
            .angle_corners()
            .into_iter()
            .map(|theta| theta.rem_euclid(TAU));
        let mut corners: Vec<f64> = dead_centres.chain(tables).collect();
        corners.sort_by(f64::total_cmp);
        // A corner that rounding has made two would make a panel without length.
        corners.dedup_by(|a, b| (*a - *b).abs() < 1e-9);
        Position {
            equation,
            corners,
            repeats: loads.have_potential() && !loads.turn_the_crank(),
            evaluations: Cell::new(0),
        }
    }

    /// Positions at which inertia and force were computed so far.
    pub fn evaluations(&self) -> u64 {
        self.evaluations.get()
    }

    fn count(&self, positions: usize) {
        self.evaluations
            .set(self.evaluations.get() + positions as u64);
    }

    /// Work (J) of the loads without potential between two angles, by a quadrature of its own.
    pub fn work(&self, from: f64, to: f64) -> f64 {
        let loads = self.equation.loads();
        if loads.have_potential() {
            return 0.0;
        }
        let force = |theta: f64| {
            let pose = self.equation.linkage().pose(theta);
            loads
                .without_potential(0.0, theta, 0.0, &pose)
                .generalized(&pose)
        };
        let (low, high) = (from.min(to), from.max(to));
        let turns = (low / TAU).floor() as i64..=(high / TAU).floor() as i64;
        let corners = turns.flat_map(|turn| {
            let whole = turn as f64 * TAU;
            self.corners.iter().map(move |corner| corner + whole)
        });
        let mut cuts = vec![low];
        cuts.extend(corners.filter(|corner| low < *corner && *corner < high));
        cuts.push(high);
        let piece = |w: &[f64]| gauss::adaptive(&force, w[0], w[1], 0.0);
        let work: f64 = cuts.windows(2).map(piece).sum();
        if to < from { -work } else { work }
    }
}

impl Driven for Position<'_> {
    /// x (m) and x' (m/rad).
    type Place = [f64; 2];

    fn tabulate(&self, angles: &Values, count: usize, table: &mut Table<[f64; 2]>) {
        self.count(count);
        let loads = self.equation.loads();
        let driven = self.is_driven();
        let at = self.equation.first_positions(angles, count);
        table.places.clear();
        for (i, angle) in angles.iter().enumerate().take(count) {
            let (x, dx) = (at.x[i], at.dx[i]);
            table.inertia[i] = at.m[i];
            table.force[i] = loads.with_potential_at(x).over(dx) - at.dv[i];
            table.push[i] = loads.of_place(*angle, x).over(dx);
            table.damping[i] = loads.damping(dx);
            if driven {
                table.places.push([x, dx]);
            }
        }
    }

    fn is_driven(&self) -> bool {
        self.equation.loads().are_called()
    }

    fn reads_time(&self) -> bool {
        self.equation.loads().reads().has(Variable::T)
    }

    fn drive(&self, place: &[f64; 2], t: f64, angle: Angle, speed: f64) -> f64 {
        let load = self.equation.loads().of_state(t, angle, speed, *place);
        load.over(place[1])
    }

    fn corners(&self) -> &[f64] {
        &self.corners
    }
}

impl Profile for Position<'_> {
    fn inertia_and_force(&self, theta: f64) -> (f64, f64) {
        self.count(1);
        let terms = self.equation.terms(theta);
        let load = self.equation.loads().value(0.0, theta, 0.0, &terms.pose);
        (terms.inertia.m, load.generalized(&terms.pose) - terms.dv)
    }

    fn tabulate(&self, angles: &Values, count: usize, inertia: &mut Values, force: &mut Values) {
        self.count(count);
        let loads = self.equation.loads();
        let at = self.equation.positions(angles);
        for (i, angle) in angles.iter().enumerate().take(count) {
            let load = loads
                .with_potential_at(at.x[i])
                .plus(loads.of_place(*angle, at.x[i]));
            inertia[i] = at.m[i];
            force[i] = load.over(at.dx[i]) - at.dv[i];
        }
    }

    fn corners(&self) -> &[f64] {
        &self.corners
    }

    fn repeats(&self) -> bool {
        self.repeats
    }
}
