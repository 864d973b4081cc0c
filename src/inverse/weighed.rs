//! Values of a hyper-parameter with their posterior probability, for sums over them.

use crate::numeric::parallel;

/// A value with ln of its posterior probability, up to a constant.
#[derive(Clone, Debug)]
pub(super) struct Weighed<T> {
    pub value: T,
    pub log: f64,
}

/// ln of the odds to the most probable model below which another one does not count.
pub(super) const LEAST_LOG_ODDS: f64 = -6.0;

/// Returns the largest ln of a probability.
pub(super) fn most<T>(list: &[Weighed<T>]) -> f64 {
    let logs = list.iter().map(|one| one.log);
    logs.fold(f64::NEG_INFINITY, f64::max)
}

/// Returns the first value and those at multiples of a step on both sides of it, as far as their odds to the most probable one
/// are more than `least`, in ln; `at` knows none beyond the bounds.
pub(super) fn on_both_sides<T: Send>(
    first: Weighed<T>,
    step: f64,
    least: f64,
    at: impl Fn(f64) -> Option<Weighed<T>> + Sync,
) -> Vec<Weighed<T>> {
    let sides = parallel::map([step, -step].into_iter(), |step| {
        // Far more than count where the samples tell anything.
        let ways = (1..=100).map(|k| step * f64::from(k));
        let mut most = first.log;
        let found = ways.map_while(&at).take_while(|one| {
            most = most.max(one.log);
            one.log > most + least
        });
        found.collect::<Vec<_>>()
    });
    sides.into_iter().flatten().chain([first]).collect()
}

/// Returns the values whose odds to the most probable one are more than `least`, in ln, with that one's probability as unit.
pub(super) fn counting<T>(mut list: Vec<Weighed<T>>, least: f64) -> Vec<Weighed<T>> {
    let most = most(&list);
    list.iter_mut().for_each(|one| one.log -= most);
    list.retain(|one| one.log > least);
    list
}
