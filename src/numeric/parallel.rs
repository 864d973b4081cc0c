//! Long lists on all cores, equal to the last bit for any number of cores: sums are taken over fixed pieces.

use rayon::prelude::*;

/// Least number of entries of a list that a thread makes at a time.
const ENTRIES: usize = 1 << 12;

/// Runs each job on any free core.
pub fn each<J: Send>(jobs: impl Iterator<Item = J>, work: impl Fn(J) + Sync) {
    map(jobs, work);
}

/// Returns the result of each job, in the order of the jobs.
pub fn map<J: Send, R: Send>(
    jobs: impl Iterator<Item = J>,
    work: impl Fn(J) -> R + Sync,
) -> Vec<R> {
    let jobs: Vec<J> = jobs.collect();
    jobs.into_par_iter().with_max_len(1).map(&work).collect()
}

/// Returns the list of `f(0)`, `f(1)`, ... of this length.
pub fn list<T: Send>(length: usize, f: impl Fn(usize) -> T + Sync) -> Vec<T> {
    let entries = (0..length).into_par_iter().with_min_len(ENTRIES);
    entries.map(&f).collect()
}

/// Returns the lists of the first and of the second values of `f(0)`, `f(1)`, ...
pub fn pairs<A: Send, B: Send>(
    length: usize,
    f: impl Fn(usize) -> (A, B) + Sync,
) -> (Vec<A>, Vec<B>) {
    let entries = (0..length).into_par_iter().with_min_len(ENTRIES);
    entries.map(&f).unzip()
}
