//! Random mechanisms with friction, of all classes, under switching loads.

use std::f64::consts::PI;

use proptest::prelude::*;
use slider_crank::scene::{Friction, Interpolation, Variable};

use super::alike::{bodies, branch};
use super::image::{Act, Setting};
use super::random::magnitude;

/// Features to leave out.
#[derive(Clone, Copy, Debug)]
pub struct Without {
    pub friction: bool,
    /// Loads other than weight and a spring.
    pub loads: bool,
    /// Formulas with jumps.
    pub jumps: bool,
}

/// Returns a crank angle at which the crank pin is at this fraction of the way between the least and the largest height
/// that the rod can reach.
fn reached([r, l, e]: [f64; 3], part: f64, beyond: bool) -> f64 {
    let (low, high) = (f64::max(-l, e - r), f64::min(l, e + r));
    let angle = ((low + part * (high - low) - e) / r)
        .clamp(-1.0, 1.0)
        .asin();
    if beyond { PI - angle } else { angle }
}

/// Strategy for lengths with a rotating crank, a rotating rod, or neither.
fn lengths() -> impl Strategy<Value = [f64; 3]> {
    let size = || magnitude(0.02, 0.3);
    prop_oneof![
        2 => (size(), 1.15..5.0f64, -0.9..0.9f64).prop_map(|(r, l, e)| [r, r * (l + e.abs()), r * e]),
        1 => (size(), 0.2..0.9f64, -0.9..0.9f64).prop_map(|(r, l, e)| [r, r * l, r * (1.0 - l) * e]),
        2 => (size(), 0.3..3.0f64, 0.1..0.9f64, any::<bool>()).prop_map(|(r, l, e, below)| {
            let (least, most) = ((1.0 - l).abs(), 1.0 + l);
            let e = least + e * (most - least);
            [r, r * l, if below { -r * e } else { r * e }]
        }),
    ]
}

/// Returns a load that switches between two values at a fraction of the run, for another fraction of it.
fn switch(kind: usize, [at, width, low, high]: [f64; 4], size: f64, duration: f64) -> Act {
    let (low, high) = (low * size, high * size);
    let [from, to] = [at, at + width].map(|part| part * duration);
    let flank = [0.02, 1e-6][kind % 2] * duration;
    match kind {
        0 | 1 => Act::Table {
            of: Variable::T,
            rows: vec![
                (-0.2 * duration, low),
                (from - flank, low),
                (from, high),
                (to, high),
                (to + flank, low),
                (1.2 * duration, low),
            ],
            interpolation: Interpolation::Linear,
            period: None,
        },
        2 => Act::Formula(format!(
            "({low}) + ({})*sin({}*T)",
            high - low,
            7.0 / duration
        )),
        _ => Act::Formula(format!(
            "({low}) + ({})*(step(T - {from}) - step(T - {to}))",
            high - low
        )),
    }
}

/// Strategy for runs of a few radians at the start speed.
pub fn rubbing(without: Without) -> impl Strategy<Value = Setting> {
    let kinds = if without.jumps { 0..3usize } else { 0..4usize };
    let shape = (lengths(), any::<bool>(), bodies());
    let start = (
        0.1..0.9f64,
        any::<bool>(),
        magnitude(3.0, 30.0),
        any::<bool>(),
        2.0..15.0f64,
        prop::bool::weighted(0.15),
    );
    let switches = (
        [kinds.clone(), kinds],
        [
            [0.05..0.5f64, 0.1..0.45, -0.3..0.3, -0.3..0.3],
            [0.05..0.5f64, 0.1..0.45, -0.3..0.3, -0.3..0.3],
        ],
    );
    let rest = (
        0.0..0.5f64,
        0.0..0.3f64,
        0.0..0.05f64,
        0.02..0.4f64,
        1.0..1.6f64,
    );
    (shape, start, switches, rest).prop_map(
        move |((lengths, left, bodies), start, (kinds, switches), rest)| {
            let (part, beyond, omega, back, way, still) = start;
            let (stiffness, gravity, loss, mu, more) = rest;
            let [r, ..] = lengths;
            let unit = r * omega * omega;
            let mut setting = Setting::new(lengths, branch(left), bodies);
            setting.gravity = gravity * unit;
            let speed = if still { 0.0 } else { omega };
            let theta = reached(lengths, part, beyond);
            setting.start = (theta, if back { -speed } else { speed });
            setting.duration = way / omega;
            setting.forces = vec![Act::Spring {
                stiffness: stiffness * omega * omega,
                rest: 0.3 * r,
            }];
            if !without.loads {
                setting.torques = vec![
                    switch(kinds[0], switches[0], r * unit, setting.duration),
                    Act::Viscous(loss * r * r * omega),
                ];
                if without.friction {
                    setting.torques.pop();
                }
                setting
                    .forces
                    .push(switch(kinds[1], switches[1], unit, setting.duration));
            }
            if !without.friction {
                setting.friction = Some(Friction {
                    coefficient: mu,
                    static_coefficient: mu * more,
                });
            }
            setting
        },
    )
}
