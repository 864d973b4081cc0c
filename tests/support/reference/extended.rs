//! Equation of motion in double-double arithmetic, independent of the mechanics of the engines, so that each checks the
//! other: velocities and accelerations of the joints from the closed loop, forces by d'Alembert's principle, no
//! energies and no derivatives of them.
//!
//! With unit rates (velocities for θ̇ = 1, marked ₁) and accelerations for θ̈ = 0 (marked ₀),
//! θ̈ = (Q + Σ m g·v₁ − Σ m a₀·v₁ − Σ I ψ̈₀ ψ̇₁) / (Σ m v₁² + Σ I ψ̇₁²).

use crate::support::exact::SinCos;
use slider_crank::mechanism::single;
use slider_crank::numeric::double_double::DoubleDouble;
use slider_crank::numeric::enclosure::{Enclosed, Interval, PanelResolution, Variation, partition};
use slider_crank::scene::{InertiaAbout, Instant, Load, RodModel, Scene, Variables};

type Vector = [DoubleDouble; 2];

/// Mechanism with its loads.
pub struct Extended {
    scene: Scene,
    pub crank_inertia: DoubleDouble,
    /// Mass, and position along the crank and to its left, of the parts with weight on the crank.
    pub on_crank: Vec<(DoubleDouble, DoubleDouble, DoubleDouble)>,
    pub rod: Option<Rod>,
    pub slider_mass: DoubleDouble,
    /// Gravity, m/s².
    pub gravity: [f64; 2],
    exact: bool,
    /// Corners and narrow features of formulas over time, s.
    marks: Vec<f64>,
}

/// Mass, centre of gravity and central moment of inertia of a rod modelled as a body.
pub struct Rod {
    /// Mass, kg.
    pub mass: DoubleDouble,
    /// Centre of gravity along the rod from the crank pin (`along`) and to the left of it (`left`), m.
    pub along: f64,
    pub left: f64,
    /// Central moment of inertia, kg m².
    pub inertia: DoubleDouble,
}

/// Time (s), crank angle (rad) and speed (rad/s) at which loads are evaluated.
pub struct State {
    pub t: f64,
    pub theta: DoubleDouble,
    pub omega: DoubleDouble,
}

fn exactly(value: f64) -> DoubleDouble {
    DoubleDouble::from(value)
}

impl Extended {
    /// Creates the mechanism of a scene, for a run to `t_end`, s.
    pub fn new(scene: &Scene, t_end: f64) -> Extended {
        let scene = scene.reduced();
        let zero = DoubleDouble::ZERO;
        let loads = scene.torques.iter().chain(&scene.forces);
        let mut extended = Extended {
            crank_inertia: zero,
            on_crank: Vec::new(),
            rod: None,
            slider_mass: exactly(scene.slider.map_or(0.0, |slider| slider.mass)),
            gravity: scene.gravity.map_or([0.0; 2], |gravity| gravity.vector()),
            exact: loads.clone().all(is_exact),
            marks: loads.flat_map(|load| marks(load, t_end)).collect(),
            scene: scene.clone(),
        };
        if let Some(crank) = &scene.crank {
            extended.crank_inertia = exactly(crank.inertia);
            let place = (
                exactly(crank.mass),
                exactly(crank.cg),
                exactly(crank.cg_lateral),
            );
            extended.on_crank.push(place);
        }
        if let Some(rod) = &scene.rod {
            let (mass, cg, left) = (exactly(rod.mass), exactly(rod.cg), rod.cg_lateral);
            let (r, l) = (exactly(scene.geometry.crank), exactly(scene.geometry.rod));
            match rod.model {
                RodModel::Massless => {}
                RodModel::Rigid => {
                    let about_cg = match rod.inertia_about {
                        InertiaAbout::Cg => exactly(rod.inertia),
                        InertiaAbout::CrankPin => {
                            exactly(rod.inertia) - mass * (cg * cg + exactly(left) * left)
                        }
                    };
                    extended.rod = Some(Rod {
                        mass,
                        along: rod.cg,
                        left,
                        inertia: if about_cg.value() < 0.0 {
                            zero
                        } else {
                            about_cg
                        },
                    });
                }
                RodModel::TwoMass => {
                    let at_wrist_pin = mass * cg / l;
                    let at_crank_pin = mass - at_wrist_pin;
                    extended.crank_inertia += at_crank_pin * r * r;
                    extended.on_crank.push((at_crank_pin, r, zero));
                    extended.slider_mass += at_wrist_pin;
                }
                RodModel::SpinOnly => {
                    extended.rod = Some(Rod {
                        mass: zero,
                        along: 0.0,
                        left: 0.0,
                        inertia: exactly(rod.inertia),
                    });
                    extended.on_crank.push((mass, l + cg, zero));
                }
            }
        }
        extended
    }

    /// Whether all loads are known beyond the digits of a float.
    pub fn is_exact(&self) -> bool {
        self.exact
    }

    /// Whether a turning crank repeats its motion every turn: no load does net work in a turn.
    pub fn repeats(&self) -> bool {
        let conserves = |load: &Load| matches!(load, Load::Constant(_) | Load::Spring { .. });
        self.scene.torques.is_empty() && self.scene.forces.iter().all(conserves)
    }

    /// Returns r, l and e, m.
    pub fn lengths(&self) -> (f64, f64, f64) {
        let geometry = &self.scene.geometry;
        (geometry.crank, geometry.rod, geometry.offset)
    }

    /// Returns the torques on the crank.
    pub fn torques(&self) -> &[Load] {
        &self.scene.torques
    }

    /// Returns the forces on the slider.
    pub fn forces(&self) -> &[Load] {
        &self.scene.forces
    }

    /// Returns all loads.
    pub fn loads(&self) -> impl Iterator<Item = &Load> {
        self.scene.torques.iter().chain(&self.scene.forces)
    }

    /// Returns the first time after `t` (s) at which a load is not smooth.
    pub fn next_corner(&self, t: f64) -> f64 {
        let corners = self.loads().map(|load| load.next_corner(t));
        let marks = self.marks.iter().copied().filter(|mark| *mark > t);
        corners.chain(marks).fold(f64::INFINITY, f64::min)
    }

    /// Returns θ̈; not finite where it does not exist.
    pub fn acceleration(&self, state: &State) -> DoubleDouble {
        let geometry = &self.scene.geometry;
        let (r, l, e) = (geometry.crank, geometry.rod, geometry.offset);
        let (sin, cos) = state.theta.sin_cos();
        let omega = state.omega;
        let squared = omega * omega;
        // Crank pin, and direction of the rod from there: the wrist pin lies at y = −e.
        let (ax, ay) = (cos * r, sin * r);
        let rise = -(ay + e);
        let dy = rise / l;
        let run = ((rise + l) * (exactly(l) - rise)).sqrt() * geometry.branch.sign();
        let dx = run / l;
        // Velocities at θ̇ = 1. The wrist pin stays on its line: ẏ_A + ψ̇ l dx = 0.
        let spin = -ax / run;
        let slider_rate = -ay - spin * rise;
        // Accelerations at θ̈ = 0, divided by θ̇²: ÿ_A + ψ̈ l dx − ψ̇² l dy = 0.
        let spin2 = spin * spin;
        let bias_spin = (ay + spin2 * rise) / run;
        let bias_slider = -ax - bias_spin * rise - spin2 * run;

        let [gx, gy] = self.gravity;
        let mut inertia = self.crank_inertia + self.slider_mass * slider_rate * slider_rate;
        let mut bias = self.slider_mass * bias_slider * slider_rate;
        let mut moment = self.slider_mass * slider_rate * gx;
        for &(mass, along, left) in &self.on_crank {
            let rate: Vector = [-(sin * along) - cos * left, cos * along - sin * left];
            moment += mass * (rate[0] * gx + rate[1] * gy);
        }
        if let Some(rod) = &self.rod {
            let arm = [
                dx * rod.along - dy * rod.left,
                dy * rod.along + dx * rod.left,
            ];
            let rate = [-ay - spin * arm[1], ax + spin * arm[0]];
            let bias_cg = [
                -ax - bias_spin * arm[1] - spin2 * arm[0],
                -ay + bias_spin * arm[0] - spin2 * arm[1],
            ];
            inertia += rod.mass * (rate[0] * rate[0] + rate[1] * rate[1]) + rod.inertia * spin2;
            bias += rod.mass * (bias_cg[0] * rate[0] + bias_cg[1] * rate[1])
                + rod.inertia * bias_spin * spin;
            moment += rod.mass * (rate[0] * gx + rate[1] * gy);
        }
        let x = ax + run;
        let v = slider_rate * omega;
        let now = Instant {
            t: state.t,
            theta: state.theta.value(),
            omega: omega.value(),
            x: x.value(),
            v: v.value(),
        };
        for load in &self.scene.torques {
            moment += value(load, false, omega, x, &now);
        }
        for load in &self.scene.forces {
            moment += value(load, true, v, x, &now) * slider_rate;
        }
        (moment - bias * squared) / inertia
    }
}

/// Requirement on the steps: they resolve a formula over time to rounding.
const SHOWN: PanelResolution = PanelResolution {
    nodes: 20,
    part: f64::EPSILON,
};

fn marks(load: &Load, t_end: f64) -> Vec<f64> {
    let Load::Expression(formula) = load else {
        return Vec::new();
    };
    if formula.reads() != Variables::T {
        return Vec::new();
    }
    let variation = |t: Interval, ellipse: f64| {
        Variation::of(formula.enclose(|_| Enclosed::variable(t, ellipse)))
    };
    partition(variation, Interval::new(0.0, t_end), SHOWN, 0.0)
}

fn is_exact(load: &Load) -> bool {
    matches!(
        load,
        Load::Constant(_) | Load::Viscous(_) | Load::Motor { .. } | Load::Spring { .. }
    )
}

/// Returns the value of a load at the speed of its own body.
pub fn value(
    load: &Load,
    on_slider: bool,
    speed: DoubleDouble,
    x: DoubleDouble,
    now: &Instant,
) -> DoubleDouble {
    match load {
        Load::Constant(value) => exactly(*value),
        Load::Viscous(coefficient) => -speed * *coefficient,
        Load::Motor {
            stall,
            no_load_speed,
        } => (DoubleDouble::ONE - speed / *no_load_speed) * *stall,
        Load::Spring { stiffness, rest } => -(x - *rest) * *stiffness,
        other => exactly(single(other, on_slider, now)),
    }
}
