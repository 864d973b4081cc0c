//! Long lists on all cores, equal to the last bit for any number of cores: sums are taken over fixed pieces.

use rayon::prelude::*;
use std::sync::Mutex;

/// Does work on one of the threads that share jobs: those in it begin there at once, where another thread would have to wake
/// this one and to wait for it each time.
pub fn inside<R: Send>(work: impl FnOnce() -> R + Send) -> R {
    rayon::scope(|_| work())
}

/// Returns the result of each job, in the order of the jobs; a single job is done in this thread.
pub fn map<J: Send, R: Send>(
    jobs: impl Iterator<Item = J>,
    work: impl Fn(J) -> R + Sync,
) -> Vec<R> {
    let jobs: Vec<J> = jobs.collect();
    if jobs.len() < 2 {
        return jobs.into_iter().map(work).collect();
    }
    let jobs: Vec<_> = jobs
        .into_iter()
        .map(|job| Mutex::new((Some(job), None)))
        .collect();
    each(jobs.len(), &|index| {
        if let Ok(mut job) = jobs[index].lock() {
            job.1 = job.0.take().map(&work);
        }
    });
    let done = jobs.into_iter().flat_map(Mutex::into_inner);
    done.filter_map(|(_, result)| result).collect()
}

/// Does the work of each index. Rayon's part is compiled once, not for every kind of work.
fn each(count: usize, work: &(dyn Fn(usize) + Sync)) {
    let indices = (0..count).into_par_iter().with_max_len(1);
    indices.for_each(work);
}

/// Returns the list of `f(0)`, `f(1)`, ... of this length; a short list is computed in this thread.
pub fn list<T: Send>(length: usize, f: impl Fn(usize) -> T + Sync) -> Vec<T> {
    let f: &(dyn Fn(usize) -> T + Sync) = &f;
    match entries(length) {
        Some(entries) => entries.map(f).collect(),
        None => (0..length).map(f).collect(),
    }
}

/// Returns the lists of the first and of the second values of `f(0)`, `f(1)`, ...
pub fn pairs<A: Send, B: Send>(
    length: usize,
    f: impl Fn(usize) -> (A, B) + Sync,
) -> (Vec<A>, Vec<B>) {
    match entries(length) {
        Some(entries) => entries.map(&f).unzip(),
        None => (0..length).map(f).unzip(),
    }
}

/// Returns the indices of a list, in parts that pay for a thread; none if there are not two of them.
fn entries(length: usize) -> Option<impl IndexedParallelIterator<Item = usize>> {
    let least = 1 << 9;
    let all = (0..length).into_par_iter().with_min_len(least);
    (length >= 2 * least).then_some(all)
}
