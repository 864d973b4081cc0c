//! Long lists on all cores, the same to the last bit whatever their number: what is summed is summed in fixed pieces.

use rayon::prelude::*;

/// Least entries of a list that a thread makes at a time.
const ENTRIES: usize = 1 << 12;

/// Does each job on whichever core is free.
pub fn each<J: Send>(jobs: impl Iterator<Item = J>, work: impl Fn(J) + Sync) {
    map(jobs, work);
}

/// What each job gives, in their order.
pub fn map<J: Send, R: Send>(
    jobs: impl Iterator<Item = J>,
    work: impl Fn(J) -> R + Sync,
) -> Vec<R> {
    let jobs: Vec<J> = jobs.collect();
    jobs.into_par_iter().with_max_len(1).map(&work).collect()
}

/// The list of `f(0)`, `f(1)`, ... of this length.
pub fn list<T: Send>(length: usize, f: impl Fn(usize) -> T + Sync) -> Vec<T> {
    let entries = (0..length).into_par_iter().with_min_len(ENTRIES);
    entries.map(&f).collect()
}

/// The lists of what stands first and second in `f(0)`, `f(1)`, ...
pub fn pairs<A: Send, B: Send>(
    length: usize,
    f: impl Fn(usize) -> (A, B) + Sync,
) -> (Vec<A>, Vec<B>) {
    let entries = (0..length).into_par_iter().with_min_len(ENTRIES);
    entries.map(&f).unzip()
}
