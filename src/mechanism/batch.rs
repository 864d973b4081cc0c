//! The equation at many instants at once.

use super::lagrange::forward;
use super::{Equation, Inertia, LoadValue, Normal, Pose, Terms};
use crate::numeric::angle::Angle;
use crate::numeric::trigonometry::sin_cos;

/// Instants of one motion. All angles share their whole turns.
#[derive(Clone, Copy, Debug)]
pub struct Instants<'a, const N: usize> {
    /// s
    pub t: &'a [f64; N],
    /// The loads of time alone at these times: [`super::Loads::of_time`].
    pub of_time: &'a [LoadValue; N],
    /// Whole turns beside the crank angles.
    pub turns: f64,
    /// Crank angles, rad.
    pub theta: &'a [f64; N],
    /// rad/s
    pub omega: &'a [f64; N],
}

/// What the terms of the equation are at N crank angles.
#[derive(Clone, Copy, Debug)]
pub struct Positions<const N: usize> {
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

impl<const N: usize> Positions<N> {
    fn zero() -> Positions<N> {
        let [x, dx, m, half_dm, dv] = [[0.0; N]; 5];
        Positions {
            x,
            dx,
            m,
            half_dm,
            dv,
        }
    }

    #[inline(always)]
    fn take(&mut self, i: usize, Terms { pose, inertia, dv }: &Terms) {
        self.x[i] = pose.x;
        self.dx[i] = pose.dx;
        self.m[i] = inertia.m;
        self.half_dm[i] = inertia.half_dm;
        self.dv[i] = *dv;
    }
}

impl Equation {
    /// θ̈ (rad/s²) at N instants, and the power (W) of the loads without a potential, as
    /// [`Equation::acceleration_and_power`] gives them one by one, to rounding.
    pub fn accelerations<const N: usize>(
        &self,
        at: &Instants<'_, N>,
        alpha: &mut [f64; N],
        power: &mut [f64; N],
    ) {
        let sides = self.positions(at.theta);
        let loads = self.loads();
        for i in 0..N {
            let (x, dx, omega) = (sides.x[i], sides.dx[i], at.omega[i]);
            let angle = Angle::new(at.turns, at.theta[i]);
            let steady = loads.with_potential_at(x);
            let spent = loads.without_potential_beside(at.of_time[i], at.t[i], angle, omega, x, dx);
            let spent = spent.torque + spent.force * dx;
            let inertia = Inertia {
                m: sides.m[i],
                half_dm: sides.half_dm[i],
            };
            let q = steady.torque + steady.force * dx + spent;
            alpha[i] = forward(&inertia, sides.dv[i], q, omega);
            power[i] = spent * omega;
        }
    }

    /// Positions and terms at N crank angles, rad.
    #[inline]
    pub fn positions<const N: usize>(&self, theta: &[f64; N]) -> Positions<N> {
        let (sin, cos) = sin_cos(theta);
        let linkage = self.linkage();
        if linkage.stays_far_from_limits() {
            self.sides(|i| linkage.pose_far_from_limits(sin[i], cos[i]))
        } else {
            self.sides(|i| linkage.pose_at(sin[i], cos[i]))
        }
    }

    /// Positions at the first `count` angles (rad), with the normal force at the guide; what is beyond is zero.
    pub fn first_guided<const N: usize>(
        &self,
        theta: &[f64; N],
        count: usize,
    ) -> (Positions<N>, [Normal; N]) {
        const LANES: usize = 4;
        let mut all = Positions::zero();
        let mut normals = [Normal::default(); N];
        let (terms, normal) = (self.terms_without_cases(), self.normal_without_cases());
        let linkage = self.linkage();
        let far = linkage.stays_far_from_limits();
        for begin in (0..count).step_by(LANES) {
            let some: [f64; LANES] = std::array::from_fn(|i| theta[(begin + i).min(N - 1)]);
            let (sin, cos) = sin_cos(&some);
            let of_guide: [(Terms, Normal); LANES] = if far {
                std::array::from_fn(|i| {
                    let at = terms(linkage.pose_far_from_limits(sin[i], cos[i]));
                    (at, normal(&at))
                })
            } else {
                std::array::from_fn(|i| {
                    let at = terms(linkage.pose_at(sin[i], cos[i]));
                    (at, normal(&at))
                })
            };
            for (i, j) in (begin..count).take(LANES).enumerate() {
                let (at, normal) = &of_guide[i];
                all.take(j, at);
                normals[j] = *normal;
            }
        }
        (all, normals)
    }

    /// Positions at the first `count` angles; what is beyond is zero.
    pub fn first_positions<const N: usize>(&self, theta: &[f64; N], count: usize) -> Positions<N> {
        const LANES: usize = 4;
        let mut all = Positions::zero();
        for begin in (0..count).step_by(LANES) {
            let some = std::array::from_fn(|i| theta[(begin + i).min(N - 1)]);
            let at: Positions<LANES> = self.positions(&some);
            for (i, j) in (begin..count).take(LANES).enumerate() {
                all.x[j] = at.x[i];
                all.dx[j] = at.dx[i];
                all.m[j] = at.m[i];
                all.half_dm[j] = at.half_dm[i];
                all.dv[j] = at.dv[i];
            }
        }
        all
    }

    #[inline(always)]
    fn sides<const N: usize>(&self, pose: impl Fn(usize) -> Pose) -> Positions<N> {
        let mut sides = Positions::zero();
        let terms = self.terms_without_cases();
        for i in 0..N {
            sides.take(i, &terms(pose(i)));
        }
        sides
    }
}
