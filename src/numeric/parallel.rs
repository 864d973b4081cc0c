//! Long lists on all cores.

use std::ops::Range;
use std::thread;

/// Entries that a thread makes at a time.
const PIECE: usize = 1 << 13;

/// The list of `f(0)`, `f(1)`, ... of this length.
pub fn list<T: Send>(length: usize, f: impl Fn(usize) -> T + Sync) -> Vec<T> {
    let cores = thread::available_parallelism().map_or(1, usize::from);
    let piece = |number: usize| {
        let from = (number * PIECE).min(length);
        from..(from + PIECE).min(length)
    };
    let entries = |range: Range<usize>| range.map(&f).collect::<Vec<T>>();
    let entries = &entries;
    let mut list = Vec::with_capacity(length);
    for first in (0..length.div_ceil(PIECE)).step_by(cores) {
        thread::scope(|scope| {
            let others = (first + 1..first + cores).map(piece);
            let others: Vec<_> = others
                .filter(|range| !range.is_empty())
                .map(|range| scope.spawn(move || entries(range)))
                .collect();
            list.extend(piece(first).map(&f));
            for thread in others {
                match thread.join() {
                    Ok(found) => list.extend(found),
                    Err(panic) => std::panic::resume_unwind(panic),
                }
            }
        });
    }
    list
}
