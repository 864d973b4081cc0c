//! Coulomb friction at the guide of a crank that turns: the slider reverses at the dead centres only.

use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

use crate::engine::angle::{State, Table};
use crate::mechanism::{
    Arms, Curve, CurveEquation, Equation, GuideForces, LoadValue, Loads, Normal,
};
use crate::numeric::angle::Angle;
use crate::numeric::enclosure::Interval;
use crate::scene::{Instant, Scene};

/// Within this part of the crank length x' has no sign.
const AT_DEAD_CENTRE: f64 = 1e-12;
/// How far beside an angle signs show and slopes are taken, rad.
pub(super) const BESIDE: f64 = 1e-6;

#[derive(Debug)]
pub(super) struct Sliding {
    equation: CurveEquation,
    /// Kinetic coefficient.
    mu: f64,
    jams: AtomicBool,
}

/// What loads do to the guide at one position of a panel.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Grip {
    /// dN/dτ, 1/m
    torque: f64,
    /// dN/dF
    force: f64,
    /// What friction drives the crank with for one newton of N without friction, N m/N.
    grip: f64,
}

/// The guide at the points of a panel.
#[derive(Clone, Copy, Debug)]
pub(super) struct Guide<'a> {
    /// x', m/rad
    pub dx: &'a [f64],
    pub normals: &'a [Normal],
    /// sgn(ω) sgn(N)
    pub signs: f64,
}

impl Grip {
    /// The part of a load in the normal force without friction, N.
    pub fn pressed(&self, load: LoadValue) -> f64 {
        self.torque * load.torque + self.force * load.force
    }

    /// What friction by it drives the crank with, N m.
    pub fn rubbed(&self, load: LoadValue) -> f64 {
        self.grip * self.pressed(load)
    }
}

/// A position as the loads see it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spot {
    /// x (m) and x' (m/rad).
    pub at: [f64; 2],
    /// Zero without friction.
    pub grip: Grip,
}

impl Spot {
    /// States as loads see them.
    #[inline]
    pub fn instants<const N: usize>(at: &[State<'_, Spot>; N]) -> [Instant; N] {
        let mut instants = [Instant::default(); N];
        for (instant, at) in instants.iter_mut().zip(at) {
            let [x, dx] = at.place.at;
            *instant = Instant {
                t: at.t,
                theta: at.angle.radians(),
                omega: at.speed,
                x,
                v: dx * at.speed,
            };
        }
        instants
    }
}

impl Sliding {
    /// The guide of a scene; none without friction.
    pub fn new(scene: &Scene, equation: &Equation) -> Option<Sliding> {
        scene.friction?;
        let constrained = CurveEquation::new(scene, Curve::on_crank(equation.linkage()));
        let friction = constrained.friction()?;
        Some(Sliding {
            equation: constrained,
            mu: friction.coefficient,
            jams: AtomicBool::new(false),
        })
    }

    /// The equation with the force of the guide.
    pub fn equation(&self) -> &CurveEquation {
        &self.equation
    }

    /// Whether a position was met at which rigid bodies jam.
    pub fn jams(&self) -> bool {
        self.jams.load(Relaxed)
    }

    /// Adds friction to the table of a panel between two dead centres; `of_place`: the loads of the position alone.
    pub fn tabulate(
        &self,
        Guide { dx, normals, signs }: Guide<'_>,
        loads: &Loads,
        of_place: &[LoadValue],
        table: &mut Table<Spot>,
    ) {
        // At the ends of a panel x' is rounding.
        let c = -self.mu * signs * dx[dx.len() / 2].signum();
        let [torque, force] = loads.dampings();
        let mut switch = table.switch.take().unwrap_or_default();
        for (i, normal) in normals.iter().enumerate() {
            let grip = normal.grip(c);
            self.jams.fetch_or(grip.is_none(), Relaxed);
            let grip = Grip {
                torque: normal.torque,
                force: normal.force,
                grip: grip.unwrap_or(f64::NAN),
            };
            let force = force * dx[i];
            let damping = LoadValue { torque, force };
            switch.place[i] = normal.place + grip.pressed(of_place[i]);
            switch.rate[i] = -grip.pressed(damping);
            switch.square[i] = normal.square;
            switch.force[i] = grip.grip * normal.square;
            table.push[i] += grip.grip * switch.place[i];
            table.damping[i] += grip.rubbed(damping);
            if let Some(spot) = table.places.get_mut(i) {
                spot.grip = grip;
            }
        }
        table.switch = Some(switch);
    }

    /// What friction at most drives the crank with, N m, for a load of one, at the ends and the middle of a range of angles
    /// (rad): the points of a panel show what the linkage does between them.
    pub fn arms(&self, angle: Interval) -> Arms {
        let at = |theta: f64| {
            let normal = self.equation.across(theta).normal();
            let grip = |c| normal.grip(c).unwrap_or(f64::INFINITY).abs();
            let most = grip(self.mu).max(grip(-self.mu));
            Arms {
                torque: normal.torque * most,
                force: normal.force * most,
            }
        };
        [angle.low, angle.middle(), angle.high]
            .map(at)
            .into_iter()
            .fold(Arms::default(), Arms::larger)
    }

    /// θ̈ (rad/s²) and the forces of the guide; none at rest.
    pub fn state(&self, t: f64, angle: Angle, omega: f64) -> (f64, GuideForces) {
        if omega == 0.0 {
            return (0.0, GuideForces::default());
        }
        let free = self.equation.free(t, angle, omega);
        let crank = self.equation.curve().linkage().r;
        let mut dx = free.velocity(1.0);
        if dx.abs() < AT_DEAD_CENTRE * crank {
            // At a dead centre it is that before it, but at the start.
            let way = BESIDE.copysign(if t == 0.0 { omega } else { -omega });
            dx = self.equation.curve().place(angle.rest + way).dx;
        }
        let sgn_v = (dx * omega).signum();
        free.sliding(free.opposing(self.mu, sgn_v))
    }
}
