//! Resolution of the loads by rows of a search: rows are added where enclosures of the loads vary more than the rows.

use super::row::Row;
use crate::mechanism::{EnclosedState, Loads, UnitLoadEffects};
use crate::numeric::enclosure::{Interval, ellipses, resolved};
use crate::numeric::root;

/// Nodes that resolve the loads on a piece.
const NODES: usize = 16;
/// Rows between the ends of the first pieces: two for each node.
const ROWS: usize = 2 * NODES;
/// Part of their range over the whole run to which the loads are resolved.
const PART: f64 = 1e-3;
/// Largest number of pieces that are looked at.
const MOST_PIECES: usize = 400_000;

/// Piece of a run, divided until few rows resolve the loads on it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Piece {
    /// First value of the parameter.
    pub from: f64,
    /// Last value of the parameter.
    pub to: f64,
    /// Number of parts in which rows resolve the loads; 0 where the given rows do.
    pub parts: usize,
}

/// State at a value of the parameter.
#[derive(Clone, Copy)]
struct End {
    at: f64,
    row: Row,
}

/// Finds the pieces on which rows at rising `parameters` do not resolve the loads; none if too many or without a row.
pub(super) fn unresolved(
    loads: &Loads,
    parameters: &[f64],
    row: &dyn Fn(f64) -> Option<Row>,
) -> Option<Vec<Piece>> {
    let mut pieces = Vec::new();
    if !loads.vary_between_nodes() {
        return Some(pieces);
    }
    let end = |at: f64| Some(End { at, row: row(at)? });
    let places = parameters.iter().step_by(ROWS).chain(parameters.last());
    let ends = places.map(|at| end(*at)).collect::<Option<Vec<_>>>()?;
    let pairs = ends.windows(2).map(|pair| [pair[0], pair[1]]);
    let first: Vec<[End; 2]> = pairs.filter(|[a, b]| a.at < b.at).collect();
    let ellipses = ellipses(NODES, PART);
    let states: Vec<EnclosedState> = first.iter().map(between).collect();
    let effects = inverse_ranges(loads, &states, ellipses[0]);
    // Rounding of the parameter.
    let least = 4.0 * f64::EPSILON * ends.last()?.at.abs();
    let mut looked_at = 0;
    let mut left: Vec<_> = first.into_iter().map(|ends| (ends, false)).collect();
    while let Some((ends, is_divided)) = left.pop() {
        let [a, b] = ends;
        let nodes_on = |state: EnclosedState| {
            let variation = |ellipse| loads.variation(&state, effects, ellipse);
            resolved(variation, ellipses, PART, NODES).1
        };
        let state = between(&ends);
        let nodes = nodes_on(state).or_else(|| nodes_on(without_table_rows(loads, &ends, state)?));
        let inside = parameters.partition_point(|at| *at < b.at)
            - parameters.partition_point(|at| *at <= a.at);
        let middle = 0.5 * (a.at + b.at);
        let is_least = b.at - a.at <= least;
        // Both sides of a jump are rows.
        let parts = nodes.map_or(1, |nodes| nodes / 2);
        if nodes.is_some() || is_least {
            let parts = if parts > inside { parts } else { 0 };
            if is_divided || parts > 0 {
                let (from, to) = (a.at, b.at);
                pieces.push(Piece { from, to, parts });
            }
            continue;
        }
        let table_row = table_row(loads, &ends, row).map(|at| known(parameters, at, &ends));
        let at = table_row.unwrap_or(middle);
        let middle = end(at)?;
        left.push(([middle, b], true));
        left.push(([a, middle], true));
        looked_at += 1;
        if looked_at > MOST_PIECES {
            return None;
        }
    }
    Some(pieces)
}

/// Adds the rows of pieces to parameters in rising order.
pub(super) fn with_pieces(mut parameters: Vec<f64>, pieces: &[Piece]) -> Vec<f64> {
    let rows = |piece: &Piece| {
        let Piece { from, to, parts } = *piece;
        let part = (to - from) / parts as f64;
        (0..parts).map(move |k| from + k as f64 * part).chain([to])
    };
    let mut pieces = pieces.iter().filter(|piece| piece.parts > 0).peekable();
    if pieces.peek().is_some() {
        parameters.extend(pieces.flat_map(rows));
        parameters.sort_by(f64::total_cmp);
        parameters.dedup();
    }
    parameters
}

/// Part of a piece at its ends in which a row of a table counts as the end.
const AT_END: f64 = 1e-6;

/// Returns the parameter of the first row inside a piece of a table over the crank angle.
fn table_row(loads: &Loads, [a, b]: &[End; 2], row: &dyn Fn(f64) -> Option<Row>) -> Option<f64> {
    let (from, to) = (a.row.theta, b.row.theta);
    let little = AT_END * (to - from);
    let corner = loads.row_on_way(from + little, to - little)?;
    let beyond = |at: f64| row(at).map_or(f64::NAN, |row| row.theta - corner);
    root::bracketed(beyond, a.at, b.at)
}

/// Returns the parameter of a row at a place of a piece, if there is one, or else the place.
fn known(parameters: &[f64], at: f64, [a, b]: &[End; 2]) -> f64 {
    let next = parameters.partition_point(|row| *row < at);
    let rows = [next.checked_sub(1), Some(next)].into_iter().flatten();
    let mut rows = rows.filter_map(|index| parameters.get(index));
    let row = rows.find(|row| (*row - at).abs() <= AT_END * (b.at - a.at));
    row.copied()
        .filter(|row| *row > a.at && *row < b.at)
        .unwrap_or(at)
}

/// Returns the state on a piece without the rows of tables at its ends, if there are any.
fn without_table_rows(
    loads: &Loads,
    [a, b]: &[End; 2],
    state: EnclosedState,
) -> Option<EnclosedState> {
    let little = AT_END * (b.row.theta - a.row.theta).abs();
    let cut = |end: f64| {
        let row = loads.row_on_way(end - little, end + little);
        row.map_or(0.0, |_| little)
    };
    let Interval { low, high } = state.theta;
    let theta = Interval::new(low + cut(low), high - cut(high));
    (theta != state.theta).then_some(EnclosedState { theta, ..state })
}

/// Encloses the state between two rows: between them a quantity deviates from a straight line by no more than a quarter
/// of the change of its rate, times the time; an angle whose rate keeps its sign stays between those of the rows.
fn between([a, b]: &[End; 2]) -> EnclosedState {
    let (a, b) = (&a.row, &b.row);
    let quarter = 0.25 * (b.t - a.t).abs();
    let range = |value: fn(&Row) -> f64, rate: fn(&Row) -> f64| {
        let bent = quarter * (rate(b) - rate(a)).abs();
        Interval::between(value(a), value(b)).widened(bent)
    };
    let theta = match a.omega * b.omega > 0.0 {
        true => Interval::between(a.theta, b.theta),
        false => range(|row| row.theta, |row| row.omega),
    };
    EnclosedState {
        t: Interval::between(a.t, b.t),
        theta,
        omega: range(|row| row.omega, |row| row.alpha),
        x: range(|row| row.x, |row| row.v),
        v: range(|row| row.v, |row| row.a),
        dx: Interval::WHOLE,
    }
}

/// Returns the reciprocals of the ranges of torques and of slider forces over a run, by which they are compared.
fn inverse_ranges(loads: &Loads, states: &[EnclosedState], ellipse: f64) -> UnitLoadEffects {
    let hull = |value: fn(&EnclosedState) -> Interval| {
        let all = states.iter().map(value);
        all.reduce(Interval::hull).unwrap_or(Interval::WHOLE)
    };
    let whole = EnclosedState {
        t: hull(|state| state.t),
        theta: hull(|state| state.theta),
        omega: hull(|state| state.omega),
        x: hull(|state| state.x),
        v: hull(|state| state.v),
        dx: Interval::WHOLE,
    };
    let inverse = |effects: UnitLoadEffects| {
        let range = |state| loads.variation(state, effects, ellipse).change;
        let known = |range: &f64| range.is_finite();
        // A load may be unbounded over the whole alone.
        let of_pieces = || states.iter().map(range).filter(known).reduce(f64::max);
        let range = Some(range(&whole)).filter(known).or_else(of_pieces);
        range.filter(|range| *range > 0.0).map_or(1.0, f64::recip)
    };
    let [torque, force] =
        [[1.0, 0.0], [0.0, 1.0]].map(|[torque, force]| inverse(UnitLoadEffects { torque, force }));
    UnitLoadEffects { torque, force }
}
