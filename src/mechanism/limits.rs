//! Limits of a linkage from its lengths, in closed form: class, dead centres, stroke, time ratio, reachable angles.

use std::f64::consts::{PI, TAU};

use serde::Serialize;

use super::Linkage;
use super::linkage::SAME_LENGTHS;
use crate::numeric::angle::in_turn;
use crate::numeric::exact::sum3;

named! {
    /// Class of the mechanism.
    pub enum Class {
        /// l − r > |e|: the crank turns fully.
        RotatingCrank = "rotating-crank",
        /// r − l > |e|: the crank rocks, the rod turns fully.
        RotatingRod = "rotating-rod",
        /// |l − r| < |e| < l + r: both rock.
        DoubleRocker = "double-rocker",
        /// On a border between two classes, to a few units in the last place of the lengths.
        ChangePoint = "change-point",
    }
}

impl Class {
    /// Returns the class of a linkage.
    pub fn of(linkage: &Linkage) -> Class {
        let Linkage { r, l, e, .. } = *linkage;
        let same = SAME_LENGTHS * (l + r);
        let crank_turns = linkage.margin();
        let rod_turns = sum3(r, -l, -e.abs());
        let assembles = sum3(l, r, -e.abs());
        if crank_turns.abs() <= same || rod_turns.abs() <= same || assembles.abs() <= same {
            Class::ChangePoint
        } else if crank_turns > 0.0 {
            Class::RotatingCrank
        } else if rod_turns > 0.0 {
            Class::RotatingRod
        } else {
            Class::DoubleRocker
        }
    }
}

/// Dead centre: a position with x' = 0, O, A and P in line.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct DeadCentre {
    /// Crank angle in [0, 2 pi), rad.
    #[serde(rename = "theta_rad")]
    pub theta: f64,
    /// Slider position, m.
    #[serde(rename = "x_m")]
    pub x: f64,
    /// `outer`: crank and rod stretched out in one line; `inner`: folded over each other.
    pub kind: &'static str,
}

/// Limits of a linkage, from its lengths.
#[derive(Clone, Debug, PartialEq)]
pub struct Limits {
    /// Class of the mechanism.
    pub class: Class,
    /// Dead centres of the linkage's branch, by angle.
    pub dead_centres: Vec<DeadCentre>,
    /// Distance between the extreme slider positions of the motion, m.
    pub stroke: f64,
    /// Crank angle of the outward stroke, rad; none if the crank cannot turn fully.
    pub advance: Option<f64>,
    /// Crank angle of the inward stroke, rad; none if the crank cannot turn fully.
    pub retreat: Option<f64>,
    /// Least transmission angle over a turn, rad, or 0 if the crank cannot turn fully.
    pub transmission_min: f64,
    /// Reachable crank angles as [from, to], rad; empty: all.
    pub reach: Vec<[f64; 2]>,
}

impl Limits {
    /// Computes the limits for a crank that turns in the direction of `speed`; zero means counter-clockwise.
    pub fn new(linkage: &Linkage, speed: f64) -> Limits {
        let class = Class::of(linkage);
        let outer = dead_centre(linkage, true);
        let inner = dead_centre(linkage, false);
        let mut dead_centres: Vec<DeadCentre> = [outer, inner].into_iter().flatten().collect();
        dead_centres.sort_by(|a, b| a.theta.total_cmp(&b.theta));
        let stroke = match (outer, inner) {
            // |x| differs by (outer² − inner²)/(outer + inner), without cancellation.
            (Some(outer), Some(inner)) => {
                4.0 * linkage.r * linkage.l / (outer.x.abs() + inner.x.abs())
            }
            (Some(outer), None) => 2.0 * outer.x.abs(),
            _ => 0.0,
        };
        let advance = match (class, outer, inner) {
            (Class::RotatingCrank, Some(outer), Some(inner)) => {
                let along = (outer.theta - inner.theta).rem_euclid(TAU);
                Some(if speed < 0.0 { TAU - along } else { along })
            }
            _ => None,
        };
        let transmission_min = if class == Class::RotatingCrank {
            let u = linkage.r + linkage.e.abs();
            (linkage.margin() * (linkage.l + u)).sqrt().atan2(u)
        } else {
            0.0
        };
        Limits {
            class,
            dead_centres,
            stroke,
            advance,
            retreat: advance.map(|outward| TAU - outward),
            transmission_min,
            reach: reach(linkage, class),
        }
    }

    /// Returns the reachable crank angles, rad, with the rod 0.001 rad or more off the guide's normal; empty: all.
    pub fn clear_reach(linkage: &Linkage) -> Vec<[f64; 2]> {
        // cos φ nearer to the normal, where the crank angle determines the position poorly.
        let nearest = 1e-3;
        let shorter = linkage.with_rod(linkage.l * (1.0 - 0.5 * nearest * nearest));
        let class = Class::of(linkage);
        if class == Class::RotatingCrank {
            return Vec::new();
        }
        reach(&shorter, class)
    }

    /// Returns the crank angles, rad, through which a drive can keep up a constant speed against the friction
    /// coefficient `mu` of the guide; empty: all. A change point is not passed: the slider's velocity would jump there.
    pub fn driven_reach(linkage: &Linkage, mu: f64) -> Vec<[f64; 2]> {
        match (linkage.unlocked(mu), Class::of(linkage)) {
            (Some(shorter), _) => Limits::new(&shorter, 0.0).reach,
            (None, Class::ChangePoint) => Limits::clear_reach(linkage),
            (None, class) => reach(linkage, class),
        }
    }

    /// Whether a crank angle in [0, 2π) lies in one of the intervals; no intervals: anywhere.
    pub fn inside(reach: &[[f64; 2]], theta: f64) -> bool {
        let within = |[from, to]: &[f64; 2]| (theta - from).rem_euclid(TAU) <= to - from;
        reach.is_empty() || reach.iter().any(within)
    }

    /// Returns the advance angle over the return angle (Obaseki & Alfred (51)); none if the crank cannot turn fully.
    pub fn time_ratio(&self) -> Option<f64> {
        Some(self.advance? / self.retreat?)
    }
}

impl Linkage {
    /// Returns the crank angles, in [−π/2, 3π/2], at which the rod stands normal to the guide and the branches meet:
    /// limits of a crank that cannot turn fully, or their like at a change point; empty for a crank that turns fully.
    pub fn limit_angles(&self) -> Vec<f64> {
        let Linkage { r, l, .. } = *self;
        let same = SAME_LENGTHS * (l + r);
        let [up, down] = limits(self, |below, lift| below >= -same && r + lift >= -same);
        let both = up.into_iter().chain(down.map(|down| -down));
        both.flat_map(|angle| [angle, PI - angle]).collect()
    }
}

/// Returns angles in [−π/2, π/2]: A is as high as the rod reaches at the first, θ, and as low at minus the second;
/// sin θ = ±(l ∓ e)/r, cos² = (r − l ± e)(r + l ∓ e)/r². `exists` decides from the height of the crank's circle beyond
/// the reach and that of the reach, m.
fn limits(linkage: &Linkage, exists: impl Fn(f64, f64) -> bool) -> [Option<f64>; 2] {
    let Linkage { r, l, e, .. } = *linkage;
    [e, -e].map(|e| {
        let (lift, below) = (l - e, -sum3(l, -e, -r));
        let cos_squared = (below * (r + lift)).max(0.0) / (r * r);
        exists(below, lift).then(|| (lift / r).atan2(cos_squared.sqrt()))
    })
}

/// Locates a dead centre. Outer: |OP| = l + r with A between. Inner: |OP| = |l − r|. On branch s the outer one has x of
/// the sign of s; the inner one too if l > r, else the other sign.
fn dead_centre(linkage: &Linkage, outer: bool) -> Option<DeadCentre> {
    let Linkage { r, l, e, s, .. } = *linkage;
    let (reach, sign) = match outer {
        true => ([l, r], s),
        false if l >= r => ([l, -r], s),
        false => ([r, -l], -s),
    };
    let squared = sum3(reach[0], reach[1], -e) * sum3(reach[0], reach[1], e);
    let on_border = squared.abs() <= SAME_LENGTHS * (l + r) * (l + r);
    if squared < 0.0 && !on_border {
        return None;
    }
    let x = sign * squared.max(0.0).sqrt();
    // The crank points from O towards P, or away from P where the rod is folded back over the crank.
    let towards = if !outer && l >= r { -1.0 } else { 1.0 };
    let theta = (towards * -e).atan2(towards * x);
    Some(DeadCentre {
        // Plus zero: an angle of −0 is 0.
        theta: in_turn(theta) + 0.0,
        x,
        kind: if outer { "outer" } else { "inner" },
    })
}

/// Returns the intervals of angles at which |e + r sin θ| ≤ l; empty: all.
fn reach(linkage: &Linkage, class: Class) -> Vec<[f64; 2]> {
    let Linkage { r, l, .. } = *linkage;
    if class == Class::RotatingCrank || linkage.margin() >= -SAME_LENGTHS * (l + r) {
        return Vec::new();
    }
    let [up, down] = limits(linkage, |below, _| below > 0.0);
    match (up, down) {
        (Some(up), Some(down)) => vec![[-down, up], [PI - up, PI + down]],
        (Some(up), None) => vec![[PI - up, TAU + up]],
        (None, Some(down)) => vec![[-down, PI + down]],
        (None, None) => Vec::new(),
    }
}
