//! Lagrange equation at many instants or crank angles at once, in arrays that the compiler vectorises.

use multiversion::multiversion;

use super::load::instant;
use super::{CurveEquation, Equation, GuideForces, LoadValue, Normal, Sense, Terms};
use crate::numeric::LANES;
use crate::numeric::angle::Angle;
use crate::numeric::trigonometry::sin_cos;
use crate::scene::Instant;

/// Instants of one motion; all crank angles have the same whole turns.
#[derive(Clone, Copy, Debug)]
pub struct Instants<'a, const N: usize> {
    /// Times, s.
    pub t: &'a [f64; N],
    /// Loads of time alone at these times: [`super::Loads::of_times`].
    pub of_time: &'a [LoadValue; N],
    /// Whole turns to add to the crank angles.
    pub turns: f64,
    /// Crank angles, rad.
    pub theta: &'a [f64; N],
    /// Crank speeds, rad/s.
    pub omega: &'a [f64; N],
}

impl<const N: usize> Instants<'_, N> {
    /// Variables of the loads, from the positions at these instants.
    fn variables(&self, sides: &TermArrays<N>) -> [Instant; N] {
        std::array::from_fn(|i| {
            let angle = Angle::new(self.turns, self.theta[i]);
            let position = [sides.x[i], sides.dx[i]];
            instant(self.t[i], angle, self.omega[i], position)
        })
    }
}

/// Terms of the equation at N crank angles.
#[derive(Clone, Copy, Debug)]
pub struct TermArrays<const N: usize> {
    /// Slider position, m.
    pub x: [f64; N],
    /// x', m/rad.
    pub dx: [f64; N],
    /// M, kg m².
    pub m: [f64; N],
    /// ½ M', kg m²/rad.
    pub half_dm: [f64; N],
    /// V' of gravity, N m.
    pub dv: [f64; N],
}

impl<const N: usize> TermArrays<N> {
    const ZERO: TermArrays<N> = TermArrays {
        x: [0.0; N],
        dx: [0.0; N],
        m: [0.0; N],
        half_dm: [0.0; N],
        dv: [0.0; N],
    };

    #[inline(always)]
    fn take(&mut self, i: usize, terms: &Terms) {
        self.x[i] = terms.pose.x;
        self.dx[i] = terms.pose.dx;
        self.m[i] = terms.m;
        self.half_dm[i] = terms.half_dm;
        self.dv[i] = terms.dv;
    }

    /// Returns θ̈, rad/s², at instant `i` under a generalized force Q, N m.
    #[inline(always)]
    fn acceleration(&self, i: usize, q: f64, omega: f64) -> f64 {
        (q - self.dv[i] - self.half_dm[i] * omega * omega) / self.m[i]
    }
}

impl Equation {
    /// Computes θ̈ (rad/s²) and power (W) at N instants; equal to [`Equation::acceleration_and_power`] to rounding.
    pub fn accelerations<const N: usize>(
        &self,
        at: &Instants<'_, N>,
        alpha: &mut [f64; N],
        power: &mut [f64; N],
    ) {
        let sides = self.term_arrays(at.theta);
        let loads = self.loads();
        let now = at.variables(&sides);
        let called = loads.beside_time(&now);
        for i in 0..N {
            let (x, dx, omega) = (sides.x[i], sides.dx[i], at.omega[i]);
            let steady = loads.with_potential_at(x);
            let other = loads.damped(&now[i]).plus(at.of_time[i]).plus(called[i]);
            let spent = other.generalized(dx);
            alpha[i] = sides.acceleration(i, steady.generalized(dx) + spent, omega);
            power[i] = spent * omega;
        }
    }

    /// Computes positions and terms at N crank angles, rad.
    pub fn term_arrays<const N: usize>(&self, theta: &[f64; N]) -> TermArrays<N> {
        term_arrays(self, theta)
    }

    /// Calls `take` with the index and the terms of each of N crank angles, rad.
    #[inline(always)]
    fn each<const N: usize>(&self, theta: &[f64; N], mut take: impl FnMut(usize, &Terms)) {
        let (sin, cos) = sin_cos(theta);
        let linkage = self.linkage();
        if linkage.stays_far_from_limits() {
            for i in 0..N {
                let pose = linkage.pose_far_from_limits(sin[i], cos[i]);
                take(i, &self.terms_without_cases(pose));
            }
        } else {
            for i in 0..N {
                let pose = linkage.pose_at(sin[i], cos[i]);
                take(i, &self.terms_without_cases(pose));
            }
        }
    }

    /// Computes positions at the first `count` angles (rad); the other entries are zero.
    pub fn first_terms<const N: usize>(&self, theta: &[f64; N], count: usize) -> TermArrays<N> {
        first(self, theta, count, |_| ()).0
    }

    /// Computes positions at the first `count` angles (rad), and the guide's normal force; the other entries are zero.
    pub fn first_guided<const N: usize>(
        &self,
        theta: &[f64; N],
        count: usize,
    ) -> (TermArrays<N>, [Normal; N]) {
        first(self, theta, count, |at| self.normal_without_cases(at))
    }
}

impl CurveEquation {
    /// Whether q is the crank angle and far from limits: near them, sines that differ in the last place are other
    /// motions.
    pub fn may_be_batched(&self) -> bool {
        self.curve().is_crank_angle() && self.curve().linkage.stays_far_from_limits()
    }

    /// Computes θ̈ (rad/s²) at N instants of a crank whose slider slides with c = −μ sgn(v) sgn(N), against dry loads in
    /// these senses, and the power (W) of all that has no potential; equal to [`super::Free::sliding`] to rounding.
    pub fn accelerations<const N: usize>(
        &self,
        at: &Instants<'_, N>,
        (c, opposed): (f64, Sense),
        alpha: &mut [f64; N],
        power: &mut [f64; N],
    ) {
        let equation = &self.equation;
        let (sides, normals) = match c {
            0.0 => (equation.term_arrays(at.theta), [Normal::default(); N]),
            _ => equation.first_guided(at.theta, N),
        };
        let loads = self.loads();
        let now = at.variables(&sides);
        let called = loads.smooth_beside_time(&now);
        for i in 0..N {
            let (dx, omega, normal) = (sides.dx[i], at.omega[i], &normals[i]);
            let mut other = loads.damped(&now[i]).plus(at.of_time[i]).plus(called[i]);
            if loads.are_dry() {
                other = other.plus(loads.dry(&now[i], opposed));
            }
            let load = loads.with_potential_at(sides.x[i]).plus(other);
            let free = normal.place + normal.of_load(load) + normal.square * (omega * omega);
            let rubbed = GuideForces::rubbing(free, normal.force, c).friction * dx;
            alpha[i] = sides.acceleration(i, load.generalized(dx) + rubbed, omega);
            power[i] = (other.generalized(dx) + rubbed) * omega;
        }
    }
}

#[multiversion(targets("x86_64+avx2"))]
fn term_arrays<const N: usize>(equation: &Equation, theta: &[f64; N]) -> TermArrays<N> {
    let mut arrays = TermArrays::ZERO;
    equation.each(theta, |i, at| arrays.take(i, at));
    arrays
}

/// Computes positions at the first `count` angles (rad) and what `beside` takes from them; the other entries are zero.
#[multiversion(targets("x86_64+avx2"))]
fn first<const N: usize, T: Copy + Default>(
    equation: &Equation,
    theta: &[f64; N],
    count: usize,
    beside: impl Fn(&Terms) -> T,
) -> (TermArrays<N>, [T; N]) {
    let (mut all, mut of_all) = (TermArrays::ZERO, [T::default(); N]);
    for begin in (0..count).step_by(LANES) {
        let some: [f64; LANES] = std::array::from_fn(|i| theta[(begin + i).min(N - 1)]);
        let (mut at, mut of_some) = (TermArrays::<LANES>::ZERO, [T::default(); LANES]);
        equation.each(&some, |i, terms| {
            at.take(i, terms);
            of_some[i] = beside(terms);
        });
        for (i, j) in (begin..count).take(LANES).enumerate() {
            (all.x[j], all.dx[j], all.dv[j]) = (at.x[i], at.dx[i], at.dv[i]);
            (all.m[j], all.half_dm[j]) = (at.m[i], at.half_dm[i]);
            of_all[j] = of_some[i];
        }
    }
    (all, of_all)
}
