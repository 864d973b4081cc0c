//! Why a free motion ended before its goal.

use super::super::configuration_curve;
use super::super::stop::Why;
use super::super::stop_reason;
use super::arrived::{Arrived, End};
use super::engine_loop::Course;
use crate::engine::step::{Node, Step};

/// Why the run ended before its time, if it did.
pub(super) fn stopped(course: &Course<'_>, arrived: &Arrived) -> Option<Why> {
    let task = course.task;
    if let (Some(followed), Some(on)) = (&arrived.on_curve, course.curve.get()) {
        return configuration_curve::why(task, followed, &on.equation);
    }
    let finish = match &arrived.end {
        End::Named(why) => return Some(why.clone()),
        End::Integrator(finish) => *finish,
        End::AtGoal | End::Elsewhere => return None,
    };
    let now = &arrived.now;
    let node = Node {
        t: now.t,
        theta: now.angle.rest,
        omega: now.speed,
        ..Node::default()
    };
    let last = arrived
        .last
        .unwrap_or_else(|| Step::new(now.angle.turns, node, node));
    stop_reason::reason(
        finish,
        task.equation(),
        arrived.impossible,
        &last,
        task.extent,
    )
}
