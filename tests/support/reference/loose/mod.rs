//! Mechanism with a loose joint in double-double arithmetic: rod and slider by virtual work, the contact force along
//! the relative velocity of journal and bearing at the contact point. The engine uses Newton-Euler equations about the
//! pinned end instead.

mod equations;

use super::extended::Extended;
use super::extrapolation::{Change, Fineness, Pieces, State, follow};
use equations::solved;
use slider_crank::mechanism::{LooseMechanism, LooseState, NormalForce};
use slider_crank::numeric::double_double::DoubleDouble;
use slider_crank::scene::{Clearance, ContactLaw, MotionKind, Rod, RodModel, Scene};

/// Number of state variables: time, θ, ψ, x and their rates.
pub(super) const NUMBERS: usize = 7;
/// Number of margins: of the depth, of the damping factor, and of the sliding speed.
const MARGINS: usize = 3;

/// Contact mode of journal and bearing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Mode {
    /// No contact.
    Apart,
    /// Contact.
    Touch {
        /// Approach speed at the start of the contact, m/s.
        approach: DoubleDouble,
        /// Whether the contact transmits force.
        presses: bool,
        /// Friction regime: proportional to the sliding speed (0), or Coulomb's in one direction or the other (±1).
        slides: f64,
    },
}

/// Mechanism with its loose joint.
pub(super) struct Loose<'a> {
    extended: &'a Extended,
    clearance: Clearance,
    force: NormalForce,
    start: LooseState,
    /// Crank angle at the start with its whole turns, rad.
    angle: f64,
    driven: bool,
    /// Scales of a speed and of an angular speed.
    pace: f64,
}

impl<'a> Loose<'a> {
    /// Creates the mechanism of a scene; none for a massless link, for friction at the guide, and for a scene that
    /// cannot be computed.
    pub(super) fn new(scene: &Scene, extended: &'a Extended) -> Option<Loose<'a>> {
        let reduced = scene.reduced();
        let clearance = reduced.clearance?;
        let rigid = |rod: &Rod| rod.model == RodModel::Rigid;
        if reduced.friction.is_some()
            || clearance.law == ContactLaw::MasslessLink
            || !reduced.rod.as_ref().is_some_and(rigid)
        {
            return None;
        }
        let mechanism = LooseMechanism::new(&reduced, clearance).ok()?;
        Some(Loose {
            extended,
            clearance,
            force: NormalForce::new(&clearance).ok()?,
            start: mechanism.start(scene).ok()?,
            angle: scene.motion.angle,
            driven: scene.motion.kind == MotionKind::ConstantSpeed,
            pace: scene.motion.speed.abs().max(1.0),
        })
    }

    /// Returns the state at the end; none if it is not found. A journal that starts at the wall is not supported.
    pub(super) fn end(&self, t_end: f64, fineness: Fineness) -> Option<State<NUMBERS>> {
        let s = &self.start;
        let start = [s.t, self.angle, s.psi, s.x, s.omega, s.spin, s.v].map(DoubleDouble::from);
        let gap = self.clearance.radial - self.meeting(&start).distance.value();
        if gap <= 1e-9 * self.clearance.radial {
            return None;
        }
        let (end, ends) = follow(self, start, Change::Mode(Mode::Apart), t_end, fineness)?;
        (!ends).then_some(end)
    }

    /// Returns the friction regime at a sliding speed.
    fn slides(&self, rate: DoubleDouble) -> f64 {
        let most = self.clearance.friction_threshold;
        if self.clearance.friction.unwrap_or(0.0) == 0.0 || rate.value().abs() < most {
            0.0
        } else {
            rate.value().signum()
        }
    }
}

impl Pieces<NUMBERS, MARGINS> for Loose<'_> {
    type Mode = Mode;

    fn rates(&self, mode: Mode, y: &State<NUMBERS>) -> State<NUMBERS> {
        let (mut m, mut q) = self.equations(mode, y);
        if self.driven {
            // Prescribed speed: θ̈ = 0, whatever torque this takes.
            m[0] = [DoubleDouble::ONE, DoubleDouble::ZERO, DoubleDouble::ZERO];
            q[0] = DoubleDouble::ZERO;
        }
        let [alpha, spin, a] = solved(m, q);
        [DoubleDouble::ONE, y[4], y[5], y[6], alpha, spin, a]
    }

    fn margins(&self, mode: Mode, y: &State<NUMBERS>) -> [DoubleDouble; MARGINS] {
        let meeting = self.meeting(y);
        let depth = meeting.distance - self.clearance.radial;
        let one = DoubleDouble::ONE;
        match mode {
            Mode::Apart => [-depth, one, one],
            Mode::Touch {
                approach,
                presses,
                slides,
            } => {
                let factor = meeting.closing_rate / approach * self.force.damping + 1.0;
                let most = self.clearance.friction_threshold;
                let rate = meeting.sliding_rate;
                let sliding = if self.clearance.friction.unwrap_or(0.0) == 0.0 {
                    one
                } else if slides == 0.0 {
                    // Squares are smooth where the speed is zero.
                    one - rate * rate / most / most
                } else {
                    rate * slides / most - 1.0
                };
                [depth, if presses { factor } else { -factor }, sliding]
            }
        }
    }

    fn change(&self, mode: Mode, which: usize, y: &State<NUMBERS>) -> Change<Mode> {
        let meeting = self.meeting(y);
        Change::Mode(match (mode, which) {
            (Mode::Apart, _) => {
                let least = self.clearance.least_approach_speed;
                Mode::Touch {
                    approach: if meeting.closing_rate.value() > least {
                        meeting.closing_rate
                    } else {
                        DoubleDouble::from(least)
                    },
                    presses: true,
                    slides: self.slides(meeting.sliding_rate),
                }
            }
            (Mode::Touch { .. }, 0) => Mode::Apart,
            (
                Mode::Touch {
                    approach,
                    presses,
                    slides,
                },
                1,
            ) => Mode::Touch {
                approach,
                presses: !presses,
                slides,
            },
            (
                Mode::Touch {
                    approach,
                    presses,
                    slides,
                },
                _,
            ) => Mode::Touch {
                approach,
                presses,
                slides: if slides == 0.0 {
                    meeting.sliding_rate.value().signum()
                } else {
                    0.0
                },
            },
        })
    }

    fn next_time(&self, t: f64) -> f64 {
        self.extended.next_corner(t)
    }

    fn sizes(&self, _: &State<NUMBERS>) -> [f64; NUMBERS] {
        let (r, ..) = self.extended.lengths();
        let angle = (self.clearance.radial / r).min(1.0);
        let length = angle * r;
        [
            1.0,
            angle,
            angle,
            length,
            angle * self.pace,
            angle * self.pace,
            length * self.pace,
        ]
    }
}
