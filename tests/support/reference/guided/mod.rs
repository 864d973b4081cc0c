//! Motion with Coulomb friction, and past the limits of a rocker, in double-double arithmetic. Crank angle and rod
//! angle are both unknown, and so is the normal force of the guide, which keeps the wrist pin on its line. Unlike the
//! engines, this uses no coordinate of the configuration curve and no formula for the effect of friction.
//!
//! The rod points along (cos Φ, −sin Φ). With J = ∂(x, y)/∂(θ, Φ) of the wrist pin, N on the slider along +y and the
//! friction c N along +x: M (θ̈, Φ̈) − N (J_y + c J_x) = Q, J_y (θ̈, Φ̈) = −ÿ at θ̈ = Φ̈ = 0.

mod equations;

use std::cell::Cell;

use super::extended::Extended;
use super::extrapolation::{Change, Fineness, Pieces, State, follow};
use crate::support::exact::SinCos;
use equations::Equations;
use slider_crank::numeric::double_double::DoubleDouble;
use slider_crank::numeric::enclosure::Interval;
use slider_crank::scene::{Friction, Scene};

/// Number of state variables: time, θ, Φ and their rates.
const NUMBERS: usize = 5;
/// Number of margins: slider velocity, normal force, and the distance from jamming.
const MARGINS: usize = 3;

/// Number of times at which the end of a rest is looked for.
const PLACES: u32 = 20_000;

/// Mode of sliding: the signs of the slider velocity and of the normal force; none without friction.
type Mode = Option<(f64, f64)>;

/// Mechanism with its guide.
pub(super) struct Guided<'a> {
    extended: &'a Extended,
    friction: Option<Friction>,
    t_end: f64,
    /// Scale of the angular speeds, rad/s.
    pace: f64,
    /// Interval between two corners of the loads over time (s), on which the loads are smooth, also at its ends.
    between: Cell<Interval>,
}

/// Accuracy of a corner over time, relative to the run.
const AT_CORNER: f64 = 4.0 * f64::EPSILON;

impl<'a> Guided<'a> {
    /// Creates the mechanism of a scene, for a run to `t_end` (s).
    pub(super) fn new(scene: &Scene, extended: &'a Extended, t_end: f64) -> Guided<'a> {
        Guided {
            extended,
            friction: scene.reduced().friction,
            t_end,
            pace: scene.motion.speed.abs().max(1.0 / t_end),
            between: Cell::new(Interval::WHOLE),
        }
    }

    /// Returns time, crank angle and crank speed at the end of the run, and whether the equations end there; none if
    /// the end is not found.
    pub(super) fn end(
        &self,
        scene: &Scene,
        fineness: Fineness,
    ) -> Option<([DoubleDouble; 3], bool)> {
        let start = self.start(scene)?;
        let first = match self.friction {
            None => Change::Mode(None),
            Some(_) if start[3].value() == 0.0 => self.onwards(&start),
            Some(_) => {
                let equations = self.equations(&start);
                self.sliding(&equations, equations.v.value().signum())
            }
        };
        let (end, ends) = follow(self, start, first, self.t_end, fineness)?;
        Some(([end[0], end[1], end[3]], ends))
    }

    fn start(&self, scene: &Scene) -> Option<State<NUMBERS>> {
        let (r, l, e) = self.extended.lengths();
        let theta = DoubleDouble::from(scene.motion.angle);
        let (sin, cos) = theta.sin_cos();
        let height = sin * r + e;
        let side = scene.geometry.branch.sign();
        let rod_sin = height / l;
        let rod_cos = ((height + l) * (DoubleDouble::from(l) - height)).sqrt() * side / l;
        let rough = DoubleDouble::from(rod_sin.value().atan2(rod_cos.value()));
        let (near_sin, near_cos) = rough.sin_cos();
        let rod = rough + (rod_sin * near_cos - rod_cos * near_sin);
        let omega = DoubleDouble::from(scene.motion.speed);
        let spin = if scene.motion.speed == 0.0 {
            DoubleDouble::ZERO
        } else {
            omega * cos * r / (rod_cos * l)
        };
        let finite = rod.value().is_finite() && spin.value().is_finite();
        finite.then_some([DoubleDouble::ZERO, theta, rod, omega, spin])
    }

    fn friction_factor(&self, mode: Mode) -> f64 {
        let mu = self.friction.map_or(0.0, |friction| friction.coefficient);
        mode.map_or(0.0, |(velocity, normal)| -mu * velocity * normal)
    }

    /// Returns sliding in this direction of the slider, with the self-consistent sign of the normal force.
    fn sliding(&self, equations: &Equations, velocity: f64) -> Change<Mode> {
        let mu = self.friction.map_or(0.0, |friction| friction.coefficient);
        if equations.clear(mu).value() <= 0.0 {
            return Change::Ends;
        }
        let agrees =
            |normal: &f64| equations.solve(-mu * velocity * normal).1.value() * normal > 0.0;
        match [1.0, -1.0].into_iter().find(agrees) {
            Some(normal) => Change::Mode(Some((velocity, normal))),
            None => Change::Unknown,
        }
    }

    /// Returns the continuation where the slider has stopped.
    fn onwards(&self, y: &State<NUMBERS>) -> Change<Mode> {
        let Some(friction) = self.friction else {
            return Change::Mode(None);
        };
        self.between.set(Interval::WHOLE);
        let mut still = self.resting(y);
        let mut band = |t: f64| {
            still[0] = DoubleDouble::from(t);
            let equations = self.equations(&still);
            let (normal, held) = equations.hold();
            let left = friction.static_coefficient * normal.value().abs() - held.value().abs();
            (left, -held.value().signum(), equations)
        };
        let t = y[0].value();
        let (left, direction, equations) = band(t);
        if !left.is_finite() {
            return Change::Unknown;
        }
        if left < 0.0 {
            return self.sliding(&equations, direction);
        }
        let at = |k: u32| t + (self.t_end - t) * f64::from(k) / f64::from(PLACES);
        let Some(k) = (1..=PLACES).find(|k| band(at(*k)).0 < 0.0) else {
            return Change::Rest(None);
        };
        let (mut from, mut to) = (at(k - 1), at(k));
        while 0.5 * (from + to) > from && 0.5 * (from + to) < to {
            let middle = 0.5 * (from + to);
            if band(middle).0 < 0.0 {
                to = middle;
            } else {
                from = middle;
            }
        }
        let (_, direction, equations) = band(to);
        match self.sliding(&equations, direction) {
            Change::Mode(mode) => Change::Rest(Some((to, mode))),
            other => other,
        }
    }
}

/// Returns the larger of the angular speeds, rad/s.
fn fastest(y: &State<NUMBERS>) -> f64 {
    y[3].value().abs().max(y[4].value().abs())
}

impl Pieces<NUMBERS, MARGINS> for Guided<'_> {
    type Mode = Mode;

    fn rates(&self, mode: Mode, y: &State<NUMBERS>) -> State<NUMBERS> {
        let ([alpha, bend], _) = self.equations(y).solve(self.friction_factor(mode));
        [DoubleDouble::ONE, y[3], y[4], alpha, bend]
    }

    fn margins(&self, mode: Mode, y: &State<NUMBERS>) -> [DoubleDouble; MARGINS] {
        let (Some((velocity, normal)), Some(friction)) = (mode, self.friction) else {
            return [DoubleDouble::ONE; MARGINS];
        };
        let equations = self.equations(y);
        let force = equations.solve(self.friction_factor(mode)).1;
        [
            equations.v * velocity,
            force * normal,
            equations.clear(friction.coefficient),
        ]
    }

    fn change(&self, mode: Mode, which: usize, y: &State<NUMBERS>) -> Change<Mode> {
        let Some((velocity, normal)) = mode else {
            return Change::Unknown;
        };
        match which {
            // The slider stops while the crank turns on: dead centre.
            0 if fastest(y) > 1e-18 * self.pace => Change::Mode(Some((-velocity, normal))),
            0 => self.onwards(y),
            1 => Change::Mode(Some((velocity, -normal))),
            _ => Change::Ends,
        }
    }

    fn resting(&self, y: &State<NUMBERS>) -> State<NUMBERS> {
        let still = DoubleDouble::ZERO;
        [y[0], y[1], y[2], still, still]
    }

    fn next_time(&self, t: f64) -> f64 {
        let next = self.extended.next_corner(t);
        let beside = AT_CORNER * self.t_end;
        self.between.set(Interval::new(t + beside, next - beside));
        next
    }

    fn sizes(&self, y: &State<NUMBERS>) -> [f64; NUMBERS] {
        let pace = fastest(y).max(self.pace);
        [1.0, 1.0, 1.0, pace, pace]
    }
}
