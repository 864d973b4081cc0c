//! Switching: zero of the switch on a panel, at which the forces change their form.

use super::panel::{PanelStart, PanelTable, Problem, SHORTEST_PANEL};
use super::solution::PanelSolution;
use super::{Dynamics, Switch};
use crate::numeric::chebyshev::{MAX_DEGREE, Series, Values, largest};
use crate::numeric::dip::may_dip;
use crate::numeric::exact::SUM_ROUNDING;
use crate::numeric::maximum;
use crate::numeric::root;

/// Change of the motion on a panel to the other side of the switch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Switching {
    /// Motion on the side of the panel throughout.
    Never,
    /// Motion on the other side from the start.
    AtStart,
    /// Motion that changes to the other side at this fraction of the panel.
    At(f64),
}

/// Determines the switching of the motion on a panel that was solved for one side. `has_sign`: whether the switch at the
/// start tells the side there; it does not where it is zero but for the error of the motion.
pub(super) fn switching(
    problem: &Problem<'_, impl Dynamics>,
    solution: &PanelSolution,
    has_sign: bool,
) -> Switching {
    let panel = problem.panel;
    let Some(switch) = &panel.table.switch else {
        return Switching::Never;
    };
    let (values, noise) = values(problem, switch, solution);
    let length = 2.0 * panel.half().abs();
    let threshold = noise.max(SHORTEST_PANEL * largest(&values));
    if has_sign && values[0] < -threshold && rise(panel, &values) * length >= SHORTEST_PANEL {
        return Switching::AtStart;
    }
    let at_zero = !has_sign || values[0].abs() <= threshold;
    if at_zero && values[1] < -noise {
        let share = crest(panel, &values, noise).map(|x| 0.5 * (x + 1.0));
        return share
            .filter(|share| share * length >= SHORTEST_PANEL)
            .map_or(Switching::AtStart, Switching::At);
    }
    let Some(x) = first_below(panel, &values, noise) else {
        return Switching::Never;
    };
    let share = 0.5 * (x + 1.0);
    if share * length < SHORTEST_PANEL {
        match has_sign {
            true => Switching::AtStart,
            false => Switching::Never,
        }
    } else if (1.0 - share) * length < SHORTEST_PANEL {
        Switching::Never
    } else {
        Switching::At(share)
    }
}

/// True if the motion starts on the other side of the switch, judged at the start alone: under a steep loss the wrong
/// side produces a transient, which is harder to resolve than the motion.
pub(super) fn begins_beyond(problem: &Problem<'_, impl Dynamics>) -> bool {
    let (panel, start) = (problem.panel, problem.start);
    let Some(switch) = &panel.table.switch else {
        return false;
    };
    let speed = start.direction * (start.kinetic * panel.mobility[0]).sqrt();
    let (value, size) = value(problem, switch, (0, start.t, speed));
    value < -SHORTEST_PANEL * size
}

/// Returns the switch at point `j` at a time (s) and a speed (rad/s), positive on the side of the panel, and the
/// largest magnitude of its parts.
fn value(
    problem: &Problem<'_, impl Dynamics>,
    switch: &Switch,
    (j, t, speed): (usize, f64, f64),
) -> (f64, f64) {
    let dynamics = problem.dynamics;
    let of_state_loads = if dynamics.has_state_loads() {
        dynamics.switch_of_state_loads(&problem.state(j, t, speed))
    } else {
        0.0
    };
    let (rate, square) = (switch.rate[j] * speed, switch.square[j] * speed * speed);
    let parts = [switch.place[j], rate, square, of_state_loads];
    let value = problem.panel.side * (switch.place[j] + rate + square + of_state_loads);
    (value, largest(&parts))
}

impl PanelSolution {
    /// Ends the motion at the fraction `share` of the panel. The energy gained is less rounded than a value of the series
    /// of the kinetic energy, whose rounding would add up over the turns.
    pub fn end_at<P: Copy>(&mut self, panel: &PanelTable<P>, start: PanelStart, share: f64) {
        let (rule, x) = (panel.rule, 2.0 * share - 1.0);
        // Under steep loads the end energy is not the sum of start and gain.
        let summed = self.end == start.kinetic + self.gain;
        self.slopes = rule.values(|x| share * (1.0 + x) - 1.0);
        let slopes = &mut self.slopes[..=rule.degree()];
        self.slope.values(slopes);
        slopes.iter_mut().for_each(|slope| *slope *= share);
        self.slope = rule.series(&self.slopes);
        if summed {
            self.gain = panel.half() * rule.series(&self.forces.total).integral().value(x);
            self.end = start.kinetic + self.gain;
        } else {
            self.end = rule.series(&self.kinetic).value(x);
            self.gain = self.end - start.kinetic;
        }
        self.share = share;
    }
}

/// Returns the switch at the points, positive on the side of the panel, and its rounding error.
fn values(
    problem: &Problem<'_, impl Dynamics>,
    switch: &Switch,
    solution: &PanelSolution,
) -> (Values, f64) {
    let rule = problem.panel.rule;
    let times = if problem.dynamics.reads_time() {
        rule.integrals(&solution.slopes)
    } else {
        [0.0; MAX_DEGREE + 1]
    };
    let mut values = [0.0; MAX_DEGREE + 1];
    let mut size = 0.0f64;
    for j in 0..=rule.degree() {
        let (t, speed) = (problem.start.t + times[j], solution.forces.speeds[j]);
        let largest_part;
        (values[j], largest_part) = value(problem, switch, (j, t, speed));
        size = size.max(largest_part);
    }
    (values, SUM_ROUNDING * size)
}

/// Returns the fraction of a panel after which values negative at its start rise above zero, if before the second
/// point.
fn rise<P: Copy>(panel: &PanelTable<P>, values: &Values) -> f64 {
    let [first, second, ..] = *values;
    match second > 0.0 {
        true => 0.5 * (panel.rule.points()[1] + 1.0) * first / (first - second),
        false => f64::INFINITY,
    }
}

/// Returns the x at which values that are negative from the second point on fall below zero, if they are above it
/// before: a panel that begins at a dip of the switch.
fn crest<P: Copy>(panel: &PanelTable<P>, values: &Values, noise: f64) -> Option<f64> {
    let series = panel.rule.series(values);
    let (from, to) = (panel.rule.points()[0], panel.rule.points()[1]);
    let (crest, height) = maximum::largest(|x| series.value(x), from, to);
    (height > noise).then(|| root::bracketed(|x| series.value(x), crest, to))?
}

/// Returns the first x at which the values fall below zero, by more than `noise`. Values below zero from the start on
/// count from where they first rise above it.
fn first_below<P: Copy>(panel: &PanelTable<P>, values: &Values, noise: f64) -> Option<f64> {
    let points = panel.rule.points();
    let series = || panel.rule.series(values);
    let first = values[..points.len()]
        .iter()
        .position(|value| *value >= -noise)?;
    for j in first + 1..points.len() {
        if values[j] < -noise {
            let root =
                |series: &Series| root::bracketed(|x| series.value(x), points[j - 1], points[j]);
            let above = values[j - 1] > 0.0;
            return Some(if above {
                root(&series()).unwrap_or(points[j - 1])
            } else {
                points[j - 1]
            });
        }
        if j + 1 < points.len()
            && may_dip(
                [points[j - 1], points[j], points[j + 1]],
                [values[j - 1], values[j], values[j + 1]],
            )
        {
            let series = series();
            let value = |x: f64| series.value(x);
            let (least, depth) = maximum::largest(|x| -value(x), points[j - 1], points[j + 1]);
            if depth > noise && values[j - 1] > 0.0 {
                return root::bracketed(value, points[j - 1], least);
            }
        }
    }
    None
}
