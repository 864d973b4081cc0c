//! Long lists on all cores, equal to the last bit for any number of cores: sums are taken over fixed pieces.

use rayon::prelude::*;

/// Returns the result of each job, in the order of the jobs; a single job is done in this thread.
pub fn map<J: Send, R: Send>(
    jobs: impl Iterator<Item = J>,
    work: impl Fn(J) -> R + Sync,
) -> Vec<R> {
    let jobs: Vec<J> = jobs.collect();
    if jobs.len() < 2 {
        return jobs.into_iter().map(work).collect();
    }
    jobs.into_par_iter().with_max_len(1).map(&work).collect()
}

/// Entries of a list that pay for a thread, at least.
const ENTRIES_OF_A_THREAD: usize = 1 << 12;

/// Returns the list of `f(0)`, `f(1)`, ... of this length; a short list is computed in this thread.
pub fn list<T: Send>(length: usize, f: impl Fn(usize) -> T + Sync) -> Vec<T> {
    match length < 2 * ENTRIES_OF_A_THREAD {
        true => (0..length).map(f).collect(),
        false => entries(length).map(&f).collect(),
    }
}

/// Returns the lists of the first and of the second values of `f(0)`, `f(1)`, ...
pub fn pairs<A: Send, B: Send>(
    length: usize,
    f: impl Fn(usize) -> (A, B) + Sync,
) -> (Vec<A>, Vec<B>) {
    entries(length).map(&f).unzip()
}

/// Returns the indices of a list, in parts that pay for a thread.
fn entries(length: usize) -> impl IndexedParallelIterator<Item = usize> {
    (0..length)
        .into_par_iter()
        .with_min_len(ENTRIES_OF_A_THREAD)
}
