//! Named positions of a linkage: dead centres and other positions of note, with crank angles in closed form.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use serde::Serialize;

use super::{Class, Limits, Linkage};
use crate::numeric::angle::in_turn;

/// Named position, or named range of crank angles.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct NamedPosition {
    /// `dead-centre`, `rod-normal-to-guide`, `crank-normal-to-rod`, `least-transmission-angle`, `blocked`, `self-
    /// locking`.
    pub kind: &'static str,
    /// Crank angle in [0, 2 pi), rad; for a range the start.
    pub theta_rad: f64,
    /// End of a range, rad, counter-clockwise from the start.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub to_rad: Option<f64>,
    /// Reason for the name.
    pub reason: &'static str,
}

fn at(kind: &'static str, theta: f64, reason: &'static str) -> NamedPosition {
    NamedPosition {
        kind,
        theta_rad: in_turn(theta),
        to_rad: None,
        reason,
    }
}

fn range(kind: &'static str, [from, to]: [f64; 2], reason: &'static str) -> NamedPosition {
    let begin = in_turn(from);
    NamedPosition {
        kind,
        theta_rad: begin,
        to_rad: Some(begin + (to - from)),
        reason,
    }
}

impl Linkage {
    /// Returns the positions of note and the blocked ranges, by angle.
    pub fn named_positions(&self) -> Vec<NamedPosition> {
        let limits = Limits::new(self, 0.0);
        let mut found = Vec::new();
        for centre in &limits.dead_centres {
            let reason = if centre.kind == "outer" {
                "crank and rod in one line: no slider force turns the crank, no crank torque moves the slider"
            } else {
                "crank and rod folded into one line: no slider force turns the crank, no crank torque moves the slider"
            };
            found.push(at("dead-centre", centre.theta, reason));
        }
        for theta in self.crank_normal_to_rod() {
            found.push(at(
                "crank-normal-to-rod",
                theta,
                "the rod force has its longest lever about O: the least rod force balances a crank torque",
            ));
        }
        if limits.class == Class::RotatingCrank {
            let worst = [
                (self.e + self.r, FRAC_PI_2),
                (self.r - self.e, 3.0 * FRAC_PI_2),
            ];
            for (lift, theta) in worst {
                if lift >= self.r + self.e.abs() {
                    found.push(at(
                        "least-transmission-angle",
                        theta,
                        "the rod is most inclined: the greatest part of its force is side thrust",
                    ));
                }
            }
        }
        let reach = &limits.reach;
        for theta in reach.iter().flatten() {
            found.push(at(
                "rod-normal-to-guide",
                *theta,
                "the rod stands normal to the guide: the crank cannot turn on, its force on the slider is all side thrust",
            ));
        }
        for (i, [_, to]) in reach.iter().enumerate() {
            let next = reach
                .get(i + 1)
                .map_or(reach[0][0] + TAU, |[from, _]| *from);
            found.push(range(
                "blocked",
                [*to, next],
                "the rod does not reach the guide",
            ));
        }
        found.sort_by(|a, b| a.theta_rad.total_cmp(&b.theta_rad));
        found
    }

    /// Returns the crank angles, rad, at which the angle between crank and rod is 90°: |OP|² = r² + l².
    ///
    /// (l² − u²) cos²θ = u² sin²θ with u = e + r sin θ is quadratic in sin θ.
    fn crank_normal_to_rod(&self) -> Vec<f64> {
        let Linkage { r, l, e, s, .. } = *self;
        let squares = l * l + r * r;
        let discriminant = l * l * (squares - e * e);
        if discriminant < 0.0 {
            return Vec::new();
        }
        let root = discriminant.sqrt();
        let mut angles: Vec<f64> = [root, -root]
            .into_iter()
            .map(|root| (root - e * r) / squares)
            .filter(|sin| sin.abs() <= 1.0)
            .map(|sin| {
                // s W cos θ = u sin θ gives the angle without the loss of digits of an arc sine near ±90°.
                let u = e + r * sin;
                let w = s * ((l - u) * (l + u)).max(0.0).sqrt();
                if sin * w < 0.0 {
                    (-w).atan2(-u)
                } else {
                    w.atan2(u)
                }
            })
            .collect();
        angles.dedup();
        angles
    }

    /// Returns the ranges of the crank angle, rad, in which friction locks the slider: μ |tan φ| ≥ 1, that is, |e + r
    /// sin θ| ≥ l/sqrt(1 + μ²), within the reach of the rod.
    pub fn self_locking(&self, friction: f64) -> Vec<NamedPosition> {
        if friction <= 0.0 {
            return Vec::new();
        }
        let threshold = self.l / friction.hypot(1.0);
        let mut found = Vec::new();
        for (offset, below) in [(self.e, false), (-self.e, true)] {
            let sine = |lift: f64| ((lift - offset) / self.r).max(-1.0);
            let (from, to) = (sine(threshold), sine(self.l));
            if from > 1.0 || to <= -1.0 {
                continue;
            }
            let from = from.asin();
            let ranges = if to >= 1.0 {
                vec![[from, PI - from]]
            } else if from == -FRAC_PI_2 {
                vec![[PI - to.asin(), TAU + to.asin()]]
            } else {
                vec![[from, to.asin()], [PI - to.asin(), PI - from]]
            };
            for [from, to] in ranges {
                // Below the guide the ranges are mirrored.
                let ends = if below { [-to, -from] } else { [from, to] };
                found.push(range(
                    "self-locking",
                    ends,
                    "mu |tan phi| >= 1: friction at the guide holds any force that the rod brings to the slider",
                ));
            }
        }
        found.sort_by(|a, b| a.theta_rad.total_cmp(&b.theta_rad));
        found
    }
}
