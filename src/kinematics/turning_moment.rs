//! Turning moment: driving torque over a cycle at constant speed, and the energies a flywheel has to store.

use serde::Serialize;

use super::forces::ForceAnalysis;
use crate::numeric::{gauss, root};

/// Driving torque over the crank angle and its mean; the areas between are energies a flywheel stores and returns.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TurningMoment {
    /// Mean torque, N m.
    pub mean_nm: f64,
    /// Work of the drive of the crank per cycle, J, in the sense of the speed: positive where the drive turns the crank.
    pub work_j: f64,
    /// Greatest minus least stored energy, J.
    pub fluctuation_j: f64,
    /// Areas between crossings of the mean.
    pub areas: Vec<Area>,
}

/// Area between the torque and its mean.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Area {
    /// Crank angle of the start, rad.
    pub from_rad: f64,
    /// Crank angle of the end, rad.
    pub to_rad: f64,
    /// Energy, J; positive where the drive gives more than in the mean.
    pub energy_j: f64,
}

/// Returns an integrator of functions of the size of one function at the ends of pieces.
pub(super) fn areas(
    size: &dyn Fn(f64) -> f64,
    pieces: &[f64],
) -> impl Fn(&dyn Fn(f64) -> f64, f64, f64) -> f64 {
    let sizes = pieces.iter().map(|end| size(*end).abs());
    let largest = sizes.fold(0.0, f64::max);
    // Allowed error of an area, as a part of the largest value times the length.
    let tolerance = 1e-12;
    move |f, from, to| gauss::adaptive(f, &[from, to], tolerance * largest * (to - from))
}

impl ForceAnalysis {
    /// Computes the mean of the driving torque, and the areas on either side of it.
    pub(super) fn turning_moment(&self) -> TurningMoment {
        let pieces = self.pieces();
        let torque = |theta: f64| self.torque(theta);
        let area = areas(&torque, &pieces);
        let work: f64 = pieces.windows(2).map(|w| area(&torque, w[0], w[1])).sum();
        let mean = work / self.whole();
        let above = |theta: f64| torque(theta % self.whole()) - mean;
        let crossings = self.crossings(above).into_iter();
        let mut cuts: Vec<_> = crossings.map(|at| (at, true)).collect();
        cuts.extend(pieces.iter().skip(1).map(|end| (*end, false)));
        cuts.sort_by(|one, other| one.0.total_cmp(&other.0));
        // Energy above the mean from the start of the cycle to each crossing.
        let (mut stored, mut from) = (0.0, 0.0);
        let mut crossings: Vec<(f64, f64)> = Vec::new();
        for (to, crosses) in cuts {
            stored += area(&|theta| torque(theta) - mean, from, to);
            from = to;
            crossings.extend(crosses.then_some((to, stored)));
        }
        let next = crossings.iter().skip(1).copied();
        // The last area ends in the next cycle.
        let first = crossings.first();
        let first = first.map(|(to, energy)| (to + self.whole(), energy + stored));
        let areas = crossings.iter().zip(next.chain(first));
        let energies = || crossings.iter().map(|(_, energy)| *energy);
        let sense = self.speed_rad_per_s.signum();
        TurningMoment {
            mean_nm: mean,
            work_j: sense * work,
            fluctuation_j: (energies().fold(f64::NEG_INFINITY, f64::max)
                - energies().fold(f64::INFINITY, f64::min))
            .max(0.0),
            areas: areas
                .map(|((from, before), (to, after))| Area {
                    from_rad: *from,
                    to_rad: to,
                    energy_j: sense * (after - before),
                })
                .collect(),
        }
    }

    /// Locates the sign changes of a function of the cycle, rad. The function is sampled in the middle of the cells of
    /// the grid, as it may vanish at their ends.
    fn crossings(&self, of: impl Fn(f64) -> f64) -> Vec<f64> {
        let whole = self.whole();
        let grid = self.grid(0.0, whole);
        let middles = grid.windows(2).map(|cell| 0.5 * (cell[0] + cell[1]));
        let mut middles: Vec<f64> = middles.filter(|at| (0.0..whole).contains(at)).collect();
        middles.extend(middles.first().map(|first| first + whole));
        let cells = middles.windows(2);
        // A plateau at zero has one crossing at most.
        let crossed = cells.filter(|w| (of(w[0]) > 0.0) != (of(w[1]) > 0.0));
        let crossings = crossed.filter_map(|w| root::bracketed(&of, w[0], w[1]));
        crossings.map(|theta| theta % whole).collect()
    }
}
