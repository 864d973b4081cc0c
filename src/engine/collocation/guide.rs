//! Run beside a guide, which is another run from the same start whose error it is to show.

use super::super::NODES;
use super::super::step::Step;

/// Length of a step over that of the guide's step: by the order 2 NODES, 6e-5 of its error remains.
const LENGTH_RATIO: f64 = 2.0 / 3.0;

/// Returns the tolerance beside a guide of the same method and this tolerance. Steps are chosen by the decay of the
/// acceleration inside, which is of order NODES.
pub fn tolerance_beside(tolerance: f64) -> f64 {
    // A power would be rounded as the compiler likes.
    (0..NODES).fold(tolerance, |finer, _| LENGTH_RATIO * finer)
}

/// Returns the longest step (s) at a time (s) beside a guide by the same method, which errs alike where its steps are
/// not chosen by the tolerance.
pub(super) fn length_beside(guide: &[Step], t: f64) -> f64 {
    let now = guide.partition_point(|step| step.end.t <= t);
    let steps = match guide.get(now) {
        // A step cut short by a corner says little: the one before counts, too.
        Some(step) if step.start.t <= t => &guide[now.saturating_sub(1)..=now],
        // The guide was over the angle, and its next step begins anew.
        Some(_) => guide,
        None => &[],
    };
    let of_method = steps.iter().filter(|step| step.has_polynomial());
    let longest = of_method.map(Step::length).reduce(f64::max);
    longest.map_or(f64::INFINITY, |longest| LENGTH_RATIO * longest)
}

/// Returns accelerations (rad/s²) of the guide at times (s) in rising order; none where it has no step, or a step
/// without its own polynomial, which is less accurate inside than at its ends.
pub(super) fn guided(guide: &[Step], t: &[f64; NODES]) -> Option<[f64; NODES]> {
    let past = guide.partition_point(|step| step.end.t < t[0]);
    let mut steps = guide[past..].iter();
    let mut step = steps.next()?;
    let mut alpha = [0.0; NODES];
    for (alpha, t) in alpha.iter_mut().zip(t) {
        while step.end.t < *t {
            step = steps.next()?;
        }
        let knows = step.start.t <= *t && step.has_polynomial();
        *alpha = knows.then(|| step.acceleration_at(*t))?;
    }
    Some(alpha)
}

#[cfg(test)]
mod tests {
    use super::super::super::step::{Node, Step, TERMS};
    use super::{LENGTH_RATIO, length_beside};

    #[test]
    fn a_guide_bounds_steps_by_those_at_their_time_or_by_its_longest() {
        let at = |t: f64| Node {
            t,
            ..Node::default()
        };
        // Two pieces in time, with a piece over the angle between them.
        let ends = [[1.0, 1.001], [1.001, 1.1], [2.0, 2.001], [2.001, 2.2]];
        let guide = ends.map(|[from, to]| Step::with_powers(0.0, at(from), at(to), [0.0; TERMS]));
        assert_eq!(length_beside(&guide, 2.3), f64::INFINITY);
        let beside = [(1.0, 0.001), (1.05, 0.099), (2.0, 0.099), (2.1, 0.199)];
        for (t, length) in beside.into_iter().chain([(0.5, 0.199), (1.5, 0.199)]) {
            let ratio = length_beside(&guide, t) / length;
            assert!((ratio / LENGTH_RATIO - 1.0).abs() < 1e-9, "{t} {ratio}");
        }
    }
}
