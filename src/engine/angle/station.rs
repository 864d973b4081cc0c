//! The panels of one turn and the positions on them.

use std::f64::consts::TAU;

use super::Driven;
use crate::engine::energy::Unserved;
use crate::engine::energy::piece::{Piece, Turning};
use crate::numeric::chebyshev::{self, POINTS, Values};

/// The positions of a panel, the same in each turn.
pub(super) struct Station<P> {
    pub piece: Piece,
    pub inertia: Values,
    pub force: Values,
    pub places: [P; POINTS],
    /// Kinetic energy at the points in the turn before.
    pub last: Option<Values>,
}

/// Panels are not cut below this, rad.
const SHORTEST: f64 = 1e-3;
/// Panels of one turn between the corners.
pub(super) fn stations<D: Driven>(
    driven: &D,
    start: f64,
    direction: f64,
) -> Result<Vec<Station<D::Place>>, Unserved> {
    let mut ends: Vec<f64> = driven
        .corners()
        .iter()
        .map(|corner| (direction * (corner - start)).rem_euclid(TAU))
        .filter(|ahead| *ahead > 1e-9 && *ahead < TAU - 1e-9)
        .collect();
    ends.sort_by(f64::total_cmp);
    ends.push(TAU);
    let mut from = 0.0;
    let mut list = Vec::with_capacity(8);
    for to in ends {
        list.push(station(
            driven,
            start + direction * from,
            start + direction * to,
        )?);
        from = to;
    }
    Ok(list)
}

fn station<D: Driven>(driven: &D, from: f64, to: f64) -> Result<Station<D::Place>, Unserved> {
    let piece = Piece {
        from,
        to,
        turning: Turning::Nowhere,
    };
    let (m, f, place) = driven.place(from);
    let mut station = Station {
        piece,
        inertia: [m; POINTS],
        force: [f; POINTS],
        places: [place; POINTS],
        last: None,
    };
    for (j, x) in chebyshev::points().iter().enumerate() {
        (station.inertia[j], station.force[j], station.places[j]) = driven.place(piece.angle(*x));
        if !station.inertia[j].is_finite() || !station.force[j].is_finite() {
            return Err(Unserved::NotFinite);
        }
    }
    Ok(station)
}

/// Cuts a panel in two at a share of its length; false if it is too short for that.
pub(super) fn split<D: Driven>(
    driven: &D,
    stations: &mut Vec<Station<D::Place>>,
    index: usize,
    share: f64,
) -> Result<bool, Unserved> {
    let Piece { from, to, .. } = stations[index].piece;
    if (to - from).abs() < SHORTEST {
        return Ok(false);
    }
    let middle = from + share * (to - from);
    stations[index] = station(driven, from, middle)?;
    stations.insert(index + 1, station(driven, middle, to)?);
    Ok(true)
}
