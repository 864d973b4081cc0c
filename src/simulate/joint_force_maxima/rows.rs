//! Forces at places of a run, and beside which of them they may be largest.

use super::FORCES;

/// Sizes of the forces at places in order.
pub(super) struct Rows<'a> {
    pub places: &'a [f64],
    pub sizes: &'a [[f64; FORCES]],
}

/// A place at which a force is no smaller than beside it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Top {
    /// The place and those beside it, with the force there; the first and the last place are beside themselves.
    pub beside: [(f64, f64); 3],
    /// Top of the parabola through them.
    pub value: f64,
}

impl Top {
    /// The force at the place.
    pub fn row(&self) -> f64 {
        self.beside[1].1
    }
}

impl Rows<'_> {
    /// The tops of a force on every `stride`-th place.
    pub fn tops(&self, force: usize, stride: usize) -> impl Iterator<Item = Top> + '_ {
        let last = self.places.len().saturating_sub(1) / stride;
        let size = move |row: usize| self.sizes[stride * row][force];
        (0..=last).filter_map(move |row| {
            let (before, after) = (row.saturating_sub(1), (row + 1).min(last));
            let is_top = size(before) <= size(row) && size(row) >= size(after);
            is_top.then(|| {
                let at = |row: usize| (self.places[stride * row], size(row));
                let beside = [at(before), at(row), at(after)];
                Top {
                    beside,
                    value: parabola(beside),
                }
            })
        })
    }

    /// The highest of them.
    pub fn highest(&self, force: usize, stride: usize) -> f64 {
        let tops = self.tops(force, stride).map(|top| top.value);
        tops.fold(0.0, f64::max)
    }
}

/// Top of the parabola through three points of which the middle one is the largest.
fn parabola([(t0, a), (t1, b), (t2, c)]: [(f64, f64); 3]) -> f64 {
    if t0 == t1 || t1 == t2 {
        return b;
    }
    let (left, right) = ((b - a) / (t1 - t0), (c - b) / (t2 - t1));
    let bend = (right - left) / (t2 - t0);
    let slope = left + bend * (t1 - t0);
    match bend < 0.0 {
        true => b - 0.25 * slope * slope / bend,
        false => b,
    }
}
