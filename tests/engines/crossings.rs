//! Angles passed within a step.

use slider_crank::engine::events::{Crossing, crossings};
use slider_crank::engine::step::{Node, Step};

/// Two steps at a constant speed (rad/s); the first one ends at the watched angle.
#[test]
fn steps_that_end_at_a_watched_angle_pass_it_once() {
    for (speed, watched) in [(2.0, 1.0), (-2.0, std::f64::consts::TAU - 1.0)] {
        let node = |t: f64| Node {
            t,
            theta: speed * t,
            omega: speed,
            ..Node::default()
        };
        let (mut found, mut all) = (Vec::new(), Vec::new());
        for [from, to] in [[0.0, 0.5], [0.5, 1.0]] {
            let step = Step::new(0.0, node(from), node(to));
            crossings(&step, &[watched], &mut found);
            all.extend(found.iter().copied());
        }
        assert_eq!(all, [(0.5, Crossing::Angle)], "{speed}");
    }
}
