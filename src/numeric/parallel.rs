//! Long lists on all cores, the same to the last bit whatever their number.

use std::ops::Range;
use std::panic::resume_unwind;
use std::sync::{Mutex, OnceLock, PoisonError};
use std::thread;

/// Entries that a thread makes at a time.
const PIECE: usize = 1 << 12;

/// Does each job on whichever core is free.
pub fn each<J>(jobs: impl ExactSizeIterator<Item = J> + Send, work: impl Fn(J) + Sync) {
    // The system takes its time to tell.
    static CORES: OnceLock<usize> = OnceLock::new();
    let cores = *CORES.get_or_init(|| thread::available_parallelism().map_or(1, usize::from));
    let others = cores.min(jobs.len()).saturating_sub(1);
    if others == 0 {
        return jobs.for_each(work);
    }
    let jobs = Mutex::new(jobs);
    let next = || jobs.lock().unwrap_or_else(PoisonError::into_inner).next();
    let worker = || {
        while let Some(job) = next() {
            work(job);
        }
    };
    thread::scope(|scope| {
        for _ in 0..others {
            scope.spawn(worker);
        }
        worker();
    });
}

/// What two jobs give that are done side by side.
pub fn both<A: Send, B>(one: impl FnOnce() -> A + Send, other: impl FnOnce() -> B) -> (A, B) {
    thread::scope(|scope| {
        let one = scope.spawn(one);
        let other = other();
        match one.join() {
            Ok(one) => (one, other),
            Err(panic) => resume_unwind(panic),
        }
    })
}

/// What each job gives, in their order.
pub fn map<J, R: Default + Send>(
    jobs: impl ExactSizeIterator<Item = J> + Send,
    work: impl Fn(J) -> R + Sync,
) -> Vec<R> {
    let mut results: Vec<R> = Vec::new();
    results.resize_with(jobs.len(), R::default);
    each(jobs.zip(&mut results), |(job, result)| *result = work(job));
    results
}

/// The list of `f(0)`, `f(1)`, ... of this length.
pub fn list<T: Copy + Default + Send>(length: usize, f: impl Fn(usize) -> T + Sync) -> Vec<T> {
    let mut list = vec![T::default(); length];
    each(list.chunks_mut(PIECE).enumerate(), |(piece, entries)| {
        for (i, entry) in entries.iter_mut().enumerate() {
            *entry = f(piece * PIECE + i);
        }
    });
    list
}

/// The largest size of `f(0)`, `f(1)`, ... up to this number; what is not a number has none.
pub fn largest(number: usize, f: impl Fn(usize) -> f64 + Sync) -> f64 {
    let piece = |piece: usize| {
        let end = number.min((piece + 1) * PIECE);
        (piece * PIECE..end).fold(0.0, |most: f64, i| most.max(f(i).abs()))
    };
    let pieces = map(0..number.div_ceil(PIECE), piece);
    pieces.into_iter().fold(0.0, f64::max)
}

/// The list of what `f` gives for numbers, of which it takes several side by side; the last ones may be repeated.
pub fn lanes<const N: usize>(
    numbers: &[f64],
    f: impl Fn(&[f64; N]) -> [f64; N] + Sync,
) -> Vec<f64> {
    let mut list = vec![0.0; numbers.len()];
    let pieces = list.chunks_mut(PIECE).zip(numbers.chunks(PIECE));
    each(pieces, |(entries, numbers)| {
        for (entries, numbers) in entries.chunks_mut(N).zip(numbers.chunks(N)) {
            let last = numbers.len() - 1;
            let found = f(&std::array::from_fn(|lane| numbers[lane.min(last)]));
            entries.copy_from_slice(&found[..=last]);
        }
    });
    list
}

/// The lists of what stands first and second in `f(0)`, `f(1)`, ...
pub fn pairs<A, B>(length: usize, f: impl Fn(usize) -> (A, B) + Sync) -> (Vec<A>, Vec<B>)
where
    A: Copy + Default + Send,
    B: Copy + Default + Send,
{
    pairs_by(length, |range| range.map(&f))
}

/// The lists of what stands first and second in what `f` gives for ranges one after the other.
pub fn pairs_by<A, B, I>(length: usize, f: impl Fn(Range<usize>) -> I + Sync) -> (Vec<A>, Vec<B>)
where
    A: Copy + Default + Send,
    B: Copy + Default + Send,
    I: Iterator<Item = (A, B)>,
{
    let mut lists = (vec![A::default(); length], vec![B::default(); length]);
    let pieces = lists.0.chunks_mut(PIECE).zip(lists.1.chunks_mut(PIECE));
    each(pieces.enumerate(), |(piece, (a, b))| {
        let from = piece * PIECE;
        let entries = f(from..from + a.len());
        for ((a, b), entry) in a.iter_mut().zip(b).zip(entries) {
            (*a, *b) = entry;
        }
    });
    lists
}

/// The lists of the first, second and third entries of `f(0)`, `f(1)`, ...
pub fn columns(length: usize, f: impl Fn(usize) -> [f64; 3] + Sync) -> [Vec<f64>; 3] {
    let mut columns = [(); 3].map(|()| vec![0.0; length]);
    let [a, b, c] = columns.each_mut().map(|list| list.chunks_mut(PIECE));
    each(a.zip(b).zip(c).enumerate(), |(piece, ((a, b), c))| {
        for i in 0..a.len() {
            [a[i], b[i], c[i]] = f(piece * PIECE + i);
        }
    });
    columns
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_have_the_entries_of_their_places() {
        for length in [0, 1, PIECE, 3 * PIECE + 5] {
            let wanted: Vec<f64> = (0..length).map(|i| i as f64).collect();
            let more = |by: f64| wanted.iter().map(|i| i + by).collect::<Vec<f64>>();
            assert_eq!(list(length, |i| i as f64), wanted);
            assert_eq!(map(wanted.iter(), |i| i + 1.0), more(1.0));
            let (first, second) = pairs(length, |i| (i as f64, i as f64 + 1.0));
            assert_eq!((first, second), (wanted.clone(), more(1.0)));
            let columns = columns(length, |i| [0.0, 1.0, 2.0].map(|k| i as f64 + k));
            assert_eq!(columns, [wanted.clone(), more(1.0), more(2.0)]);
        }
    }
}
