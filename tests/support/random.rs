//! Random mechanisms, reproducible from a seed.

use std::f64::consts::{FRAC_PI_2, PI};

use proptest::prelude::*;
use slider_crank::scene::{
    Branch, Crank, Geometry, Gravity, InertiaAbout, Load, Period, Rod, RodModel, Scene, Slider,
    Variables,
};

use super::seed::seed;

/// Returns the configuration for this number of cases from one seed.
pub fn cases(cases: u32) -> ProptestConfig {
    ProptestConfig {
        cases,
        failure_persistence: None,
        rng_seed: seed(20_260_101),
        max_global_rejects: 100 * cases,
        ..ProptestConfig::default()
    }
}

/// Strategy for log-uniform magnitudes.
pub fn magnitude(from: f64, to: f64) -> impl Strategy<Value = f64> {
    (from.ln()..to.ln()).prop_map(f64::exp)
}

fn branch() -> impl Strategy<Value = Branch> {
    prop_oneof![Just(Branch::Right), Just(Branch::Left)]
}

/// Strategy for magnitudes of either sign, zero in one case out of eight.
fn signed(from: f64, to: f64) -> impl Strategy<Value = f64> {
    prop_oneof![
        1 => Just(0.0),
        7 => (magnitude(from, to), any::<bool>()).prop_map(|(x, minus)| if minus { -x } else { x }),
    ]
}

/// Strategy for cranks that turn fully, with l − r − |e| from `least` to 100 crank lengths.
pub fn rotating_crank(least: f64) -> impl Strategy<Value = Geometry> {
    (
        magnitude(1e-3, 10.0),
        signed(1e-3, 5.0),
        magnitude(least, 100.0),
        branch(),
    )
        .prop_map(|(crank, offset, margin, branch)| Geometry {
            crank,
            rod: crank * (1.0 + offset.abs() + margin),
            offset: crank * offset,
            branch,
        })
}

/// Strategy for arbitrary lengths that can be assembled, not close to a change point.
pub fn any_class() -> impl Strategy<Value = Geometry> {
    (
        magnitude(1e-3, 10.0),
        magnitude(0.05, 20.0),
        -0.999..0.999,
        branch(),
    )
        .prop_map(|(crank, ratio, offset, branch)| Geometry {
            crank,
            rod: crank * ratio,
            offset: crank * (1.0 + ratio) * offset,
            branch,
        })
        .prop_filter("change point", |g| {
            let (r, l, e) = (g.crank, g.rod, g.offset.abs());
            ((l - r).abs() - e).abs() > 1e-6 * (l + r)
        })
}

/// Strategy for crank angles over several turns, half of them close to ±90°.
pub fn angle() -> impl Strategy<Value = f64> {
    prop_oneof![
        -20.0..20.0,
        (-6..6, signed(1e-16, 0.3))
            .prop_map(|(turns, from)| FRAC_PI_2 + PI * f64::from(turns) + from),
    ]
}

/// All loads with formulas, as a scene takes them and as the test computes them.
#[derive(Clone, Copy, Debug)]
pub struct Drive {
    torque: f64,
    rotary: f64,
    stall: f64,
    no_load: f64,
    wave: f64,
    force: f64,
    stiffness: f64,
    rest: f64,
    linear: f64,
    drag: f64,
}

impl Drive {
    pub fn add_to(&self, scene: Scene) -> Scene {
        let Drive { wave, drag, .. } = *self;
        let (stiffness, rest) = (self.stiffness, self.rest);
        scene
            .torque(Load::Constant(self.torque))
            .torque(Load::Viscous(self.rotary))
            .torque(Load::Motor {
                stall: self.stall,
                no_load_speed: self.no_load,
            })
            .torque(
                Load::function(Variables::THETA.or(Variables::T), move |now| {
                    wave * (2.0 * now.theta + now.t).sin()
                })
                .with_period(Period::TURN),
            )
            .force(Load::Constant(self.force))
            .force(Load::Spring { stiffness, rest })
            .force(Load::Viscous(self.linear))
            .force(Load::function(Variables::X.or(Variables::V), move |now| {
                drag * now.x * now.v.abs()
            }))
    }

    /// Returns torque and force.
    pub fn value(&self, t: f64, theta: f64, omega: f64, x: f64, v: f64) -> [f64; 2] {
        [
            self.torque - self.rotary * omega + self.stall - self.stall / self.no_load * omega
                + self.wave * (2.0 * theta + t).sin(),
            self.force - self.stiffness * (x - self.rest) - self.linear * v
                + self.drag * x * v.abs(),
        ]
    }

    /// Returns torque and force of the loads without a potential: damping, the falling part of the motor line, and the
    /// functions.
    pub fn without_potential(&self, t: f64, theta: f64, omega: f64, x: f64, v: f64) -> [f64; 2] {
        [
            -self.rotary * omega - self.stall / self.no_load * omega
                + self.wave * (2.0 * theta + t).sin(),
            -self.linear * v + self.drag * x * v.abs(),
        ]
    }

    /// Returns the potential of the other loads.
    pub fn potential(&self, theta: f64, x: f64) -> f64 {
        let stretched = x - self.rest;
        -(self.torque + self.stall) * theta - self.force * x
            + 0.5 * self.stiffness * stretched * stretched
    }

    /// Returns the sizes of the terms of torque and force, for x and x' of these sizes.
    pub fn sizes(&self, x: f64, dx: f64, omega: f64) -> [f64; 2] {
        let (omega, v) = (omega.abs(), dx * omega.abs());
        [
            self.torque.abs()
                + self.rotary * omega
                + self.stall
                + self.stall / self.no_load * omega
                + self.wave.abs(),
            self.force.abs()
                + self.stiffness * (x + self.rest.abs())
                + self.linear * v
                + self.drag.abs() * x * v,
        ]
    }

    /// Returns the size of the potential energies, J, over a few turns.
    pub fn energy_size(&self, scene: &Scene) -> f64 {
        let x = scene.geometry.crank + scene.geometry.rod;
        let stretched = x + self.rest.abs();
        20.0 * (self.torque.abs() + self.stall)
            + self.force.abs() * x
            + self.stiffness * stretched * stretched
    }
}

fn drive() -> impl Strategy<Value = Drive> {
    let any = || -10.0..10.0;
    let positive = || 0.0..10.0;
    (
        any(),
        positive(),
        positive(),
        magnitude(1.0, 100.0),
        any(),
        any(),
        positive(),
        any(),
        positive(),
        any(),
    )
        .prop_map(
            |(torque, rotary, stall, no_load, wave, force, stiffness, rest, linear, drag)| Drive {
                torque,
                rotary,
                stall,
                no_load,
                wave,
                force,
                stiffness,
                rest,
                linear,
                drag,
            },
        )
}

/// Mechanism with bodies and loads in a state of motion.
#[derive(Clone, Debug)]
pub struct Case {
    pub scene: Scene,
    pub drive: Drive,
    pub t: f64,
    pub theta: f64,
    pub omega: f64,
}

/// Strategy for arbitrary bodies, gravity and loads, each body sometimes absent, on mechanisms from `geometry`.
pub fn case(geometry: impl Strategy<Value = Geometry>) -> impl Strategy<Value = Case> {
    let mass = || magnitude(0.01, 100.0);
    let crank = (mass(), -1.5..1.5, -1.0..1.0, magnitude(1e-3, 10.0));
    let rod = (
        mass(),
        -0.5..1.5,
        -0.5..0.5,
        magnitude(1e-4, 1.0),
        any::<bool>(),
    );
    let bodies = (
        prop::option::weighted(0.9, crank),
        prop::option::weighted(0.9, rod),
        prop::option::weighted(0.9, mass()),
        prop::option::weighted(0.8, (0.0..20.0, -4.0..4.0)),
    );
    (geometry, bodies, drive(), 0.0..10.0, angle(), -50.0..50.0)
        .prop_filter("no body", |(_, bodies, ..)| {
            bodies.0.is_some() || bodies.1.is_some()
        })
        .prop_map(
            |(g, (crank, rod, slider, gravity), drive, t, theta, omega)| {
                let mut scene = Scene::new(g.crank, g.rod).offset(g.offset).branch(g.branch);
                scene.crank =
                    crank.map(
                        |(mass, along, left, gyration): (f64, f64, f64, f64)| Crank {
                            mass,
                            cg: along * g.crank,
                            cg_lateral: left * g.crank,
                            inertia: mass
                                * g.crank
                                * g.crank
                                * (along * along + left * left + gyration),
                        },
                    );
                scene.rod = rod.map(|(mass, along, left, gyration, about_pin)| {
                    rigid_rod(&g, mass, [along, left], gyration, about_pin)
                });
                scene.slider = slider.map(|mass| Slider { mass });
                scene.gravity = gravity.map(|(acceleration, direction)| Gravity {
                    acceleration,
                    direction,
                });
                Case {
                    scene: drive.add_to(scene),
                    drive,
                    t,
                    theta,
                    omega,
                }
            },
        )
}

fn rigid_rod(g: &Geometry, mass: f64, cg: [f64; 2], gyration: f64, about_pin: bool) -> Rod {
    let [along, left] = cg;
    let squared = if about_pin {
        along * along + left * left
    } else {
        0.0
    };
    Rod {
        model: RodModel::Rigid,
        mass,
        cg: along * g.rod,
        cg_lateral: left * g.rod,
        inertia: mass * g.rod * g.rod * (gyration + squared),
        inertia_about: if about_pin {
            InertiaAbout::CrankPin
        } else {
            InertiaAbout::Cg
        },
    }
}
