//! Diagrams of a cycle at constant speed: turning moment, indicated work, orders of the shaking force and of the torque
//! (Fourier), balance of the first order.

use std::f64::consts::{PI, TAU};

use serde::Serialize;

use super::forces::ForceAnalysis;
use super::turning_moment::{TurningMoment, areas};
use crate::mechanism::{Limits, single};
use crate::numeric::{fourier, gauss, maximum};
use crate::scene::{Load, Scene};

/// Diagrams of a cycle.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Diagrams {
    /// Driving torque and its mean.
    pub turning_moment: TurningMoment,
    /// Work of the gas on the piston; none without a pressure.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub indicated: Option<Indicated>,
    /// Fourier coefficients of the shaking force and of the driving torque.
    pub orders: Vec<Order>,
    /// Balance by a counterweight on the crank.
    pub balance: Counterweight,
}

/// Work of the gas on the piston over the cycle.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Indicated {
    /// Work, J; positive: the gas drives the crank.
    pub work_j: f64,
    /// Swept volume of the largest piston, m³.
    pub swept_volume_m3: f64,
    /// Mean effective pressure: the work over the swept volume, Pa.
    pub mean_effective_pressure_pa: f64,
    /// Indicated power, W.
    pub power_w: f64,
}

/// Amplitudes of one order, a number of periods per turn.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Order {
    /// Order, periods per turn.
    pub order: f64,
    /// Amplitude of the shaking force along x, N.
    pub shaking_x_n: f64,
    /// Amplitude of the shaking force along y, N.
    pub shaking_y_n: f64,
    /// Amplitude of the shaking moment, N m.
    pub shaking_moment_nm: f64,
    /// Amplitude of the driving torque, N m.
    pub torque_nm: f64,
}

/// Counterweight for the rotating mass and a part of the reciprocating mass. The first order of the shaking force is
/// one vector that turns with the crank and one that turns against the crank; a counterweight changes only the former.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Counterweight {
    /// Balanced part of the first order of the reciprocating mass; 0.5 leaves the least largest force of first order.
    pub part: f64,
    /// Mass times distance from the crank's axis, kg m.
    pub counterweight_kg_m: f64,
    /// Angle of the counterweight from the crank, rad in [0, 2π).
    pub angle_rad: f64,
    /// First-order force that turns with the crank, without the counterweight, N.
    pub forward_n: f64,
    /// First-order force that turns with the crank and is left by the counterweight, N.
    pub forward_left_n: f64,
    /// First-order force that turns against the crank, N.
    pub backward_n: f64,
    /// Largest shaking force of all orders without the counterweight, N.
    pub largest_n: f64,
    /// Largest shaking force of all orders with the counterweight, N.
    pub largest_left_n: f64,
}

impl ForceAnalysis {
    /// Computes the diagrams of the cycle, with a counterweight for this part of the reciprocating mass; none where a
    /// force is not finite, as of a crank that cannot turn fully, or a load varies too often in a turn.
    pub fn diagrams(&self, scene: &Scene, part: f64) -> Option<Diagrams> {
        let samples = self.samples()?;
        let mut values = samples.iter().flat_map(|sample| sample.values);
        if self.linkage().margin() <= 0.0 || !values.all(f64::is_finite) {
            return None;
        }
        Some(Diagrams {
            turning_moment: self.turning_moment(),
            indicated: self.indicated(scene),
            orders: self.orders(&samples),
            balance: self.balance(&samples, part),
        })
    }

    /// Returns the ends of pieces of a smooth torque, rad, from the start of the cycle to its end.
    pub(super) fn pieces(&self) -> Vec<f64> {
        let whole = self.whole();
        let mut ends = self.equation.loads().corners_between(0.0, whole);
        ends.extend((0..=8 * self.cycle_turns).map(|k| f64::from(k) * (PI / 4.0)));
        ends.retain(|end| (0.0..=whole).contains(end));
        ends.sort_by(f64::total_cmp);
        ends.dedup();
        ends
    }

    /// Computes the work of all pressures of the scene.
    fn indicated(&self, scene: &Scene) -> Option<Indicated> {
        let gases = scene.forces.iter().filter_map(|load| match load {
            Load::Gas { area, .. } => Some((load, *area)),
            _ => None,
        });
        let gases: Vec<(&Load, f64)> = gases.collect();
        let area = gases.iter().map(|(_, area)| *area).reduce(f64::max)?;
        let linkage = self.linkage();
        let scene_stroke = Limits::new(linkage, self.speed_rad_per_s).stroke;
        let power = |theta: f64| {
            let pose = linkage.pose(theta);
            let now = pose.instant(0.0, theta, 0.0);
            let forces = gases.iter().map(|(load, _)| single(load, true, &now));
            forces.sum::<f64>() * pose.dx
        };
        let pieces = self.pieces();
        let work_between = areas(&power, &pieces);
        let work = pieces.windows(2).map(|w| work_between(&power, w[0], w[1]));
        let work: f64 = work.sum();
        let swept = area * scene_stroke;
        // A crank of negative speed passes the cycle backwards.
        let work = work * self.speed_rad_per_s.signum();
        Some(Indicated {
            work_j: work,
            swept_volume_m3: swept,
            mean_effective_pressure_pa: work / swept,
            power_w: work * self.speed_rad_per_s.abs() / self.whole(),
        })
    }

    /// Computes shaking force, shaking moment and torque at the nodes of the Gauss-Legendre rule on the cells of the
    /// grid, whose distance from the branch points makes its error about 32⁻¹². Under loads that the grid need not
    /// resolve cells are halved until their integrals no longer change; none where they are too many.
    fn samples(&self) -> Option<Vec<fourier::Sample<4>>> {
        let whole = self.whole();
        let at = |[from, to]: [f64; 2]| {
            gauss::RULE_6.map(|(x, weight)| {
                let theta = from + x * (to - from);
                let row = self.row(theta);
                let [fx, fy] = row.reactions.shaking;
                fourier::Sample {
                    at: theta / whole,
                    weight: weight * (to - from) / whole,
                    values: [fx, fy, row.reactions.shaking_moment, row.torque],
                }
            })
        };
        let mut grid = self.grid(0.0, whole);
        grid.retain(|theta| (0.0..=whole).contains(theta));
        let sampled = |cell: [f64; 2]| (cell, at(cell));
        let cells = grid.windows(2).map(|cell| sampled([cell[0], cell[1]]));
        let mut open: Vec<_> = cells.collect();
        let torques = open.iter().flat_map(|(_, samples)| samples);
        let largest = torques.fold(0.0, |most: f64, s| most.max(s.values[3].abs()));
        let resolved = !self.equation.loads().vary_between_nodes();
        // Part of the largest torque by which the mean may change.
        let tolerance = 1e-11;
        // Half a second.
        let most_samples = 1_000_000;
        let mut closed = Vec::new();
        while let Some(([from, to], samples)) = open.pop() {
            if closed.len() > most_samples {
                return None;
            }
            let middle = 0.5 * (from + to);
            let mean = |samples: &[_; 6]| -> f64 {
                let part = |s: &fourier::Sample<4>| s.weight * s.values[3];
                samples.iter().map(part).sum()
            };
            let halves = (!resolved).then(|| [[from, middle], [middle, to]].map(sampled));
            let changed = halves.filter(|halves| {
                let change = mean(&samples) - halves.iter().map(|(_, s)| mean(s)).sum::<f64>();
                change.abs() > tolerance * largest
            });
            match changed {
                Some(halves) => open.extend(halves),
                None => closed.extend(samples),
            }
        }
        Some(closed)
    }

    fn orders(&self, samples: &[fourier::Sample<4>]) -> Vec<Order> {
        let turns = self.cycle_turns;
        let order = |k: u32| {
            let samples = samples.iter().copied();
            let [x, y, moment, torque] =
                fourier::coefficients(samples, k).map(|[cos, sin]| 2.0 * cos.hypot(sin));
            Order {
                order: f64::from(k) / f64::from(turns),
                shaking_x_n: x,
                shaking_y_n: y,
                shaking_moment_nm: moment,
                torque_nm: torque,
            }
        };
        (1..=fourier::HIGHEST_ORDER * turns).map(order).collect()
    }

    fn balance(&self, samples: &[fourier::Sample<4>], part: f64) -> Counterweight {
        let first_order = fourier::coefficients(samples.iter().copied(), self.cycle_turns);
        let [[xc, xs], [yc, ys], ..] = first_order;
        // x + iy = forward e^{iθ} + backward e^{-iθ}.
        let forward = [xc + ys, yc - xs];
        let backward = [xc - ys, yc + xs];
        let [with, against] = [forward, backward].map(|[re, im]| re.hypot(im));
        let taken = with + (2.0 * part - 1.0) * against;
        let unit = if with > 0.0 {
            forward.map(|c| c / with)
        } else {
            [1.0, 0.0]
        };
        let counter = unit.map(|c| -taken * c);
        // The shaking force at constant speed has no part of the loads: one turn tells all.
        let grid = self.linkage().grid_between(0.0, TAU, &[]);
        let largest = |[re, im]: [f64; 2]| {
            let force = |theta: f64| {
                let [x, y] = self.row(theta).reactions.shaking;
                let (sin, cos) = theta.sin_cos();
                (x + re * cos - im * sin).hypot(y + re * sin + im * cos)
            };
            let peaks = maximum::peaks(force, &grid).into_iter();
            peaks.map(|(_, peak)| peak).fold(force(0.0), f64::max)
        };
        Counterweight {
            part,
            counterweight_kg_m: taken.abs() / self.speed_rad_per_s.powi(2),
            angle_rad: counter[1].atan2(counter[0]).rem_euclid(TAU) % TAU,
            forward_n: with,
            forward_left_n: (with - taken).abs(),
            backward_n: against,
            largest_n: largest([0.0, 0.0]),
            largest_left_n: largest(counter),
        }
    }
}
