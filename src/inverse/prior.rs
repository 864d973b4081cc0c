//! Priors among which the likelihood chooses: the unknown of the equation of motion and its random process.

/// Largest order of a prior.
pub(super) const ORDERS: usize = 3;

/// State: θ, ω, u, then the derivatives of u, or g.
pub(super) type State = [f64; 2 + ORDERS];

/// What is unknown and varies as an integrated Wiener process.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Unknown {
    /// θ̈ itself: no mechanics.
    Acceleration,
    /// A torque on the crank beside the loads of the scene.
    Torque,
    /// A force on the slider beside the loads of the scene.
    Force,
}

/// A prior of the motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Prior {
    pub unknown: Unknown,
    /// Number of integrations from the white noise to u: 1 (Wiener process) or more.
    pub order: usize,
    /// Whether g ω with an unknown constant g is a part of u beside that: g is the last state. The amplitudes of what repeats
    /// are then straight lines over ω.
    pub follows_speed: bool,
    /// Turns of the cycle in which a part of u repeats; 0 without such a part.
    pub cycle: u8,
    /// Harmonics of that part in a cycle.
    pub harmonics: usize,
}

impl Prior {
    /// u as an integrated Wiener process, and nothing beside.
    pub const fn new(unknown: Unknown, order: usize) -> Prior {
        Prior {
            unknown,
            order,
            follows_speed: false,
            cycle: 0,
            harmonics: 0,
        }
    }

    /// This prior beside a part that repeats and is known.
    pub fn beside_known(self) -> Prior {
        Prior {
            cycle: 0,
            harmonics: 0,
            ..self
        }
    }

    /// Number of coefficients of what repeats.
    pub fn coefficients(self) -> usize {
        self.of_harmonic() * self.harmonics
    }

    /// Number of coefficients of each harmonic: of cos kθ and sin kθ, and of these times the speed.
    pub fn of_harmonic(self) -> usize {
        if self.follows_speed { 4 } else { 2 }
    }

    /// Number of states.
    pub fn states(self) -> usize {
        2 + self.order + usize::from(self.follows_speed)
    }

    /// Returns g of a state, N m s; 0 without.
    pub fn by_speed(self, state: &State) -> f64 {
        match self.follows_speed {
            true => state[2 + self.order],
            false => 0.0,
        }
    }

    /// Names the random term in words.
    pub fn name(self) -> &'static str {
        match (self.cycle, self.follows_speed) {
            (0, false) => match (self.unknown, self.order) {
                (Unknown::Acceleration, 3) => "angle with white crackle, without mechanics",
                (Unknown::Acceleration, _) => "angle with white snap, without mechanics",
                (Unknown::Torque, 3) => "torque as a twice integrated Wiener process",
                (Unknown::Torque, 1) => "torque as a Wiener process",
                (Unknown::Torque, _) => "torque as an integrated Wiener process",
                (Unknown::Force, 1) => "force as a Wiener process",
                (Unknown::Force, _) => "force as an integrated Wiener process",
            },
            (0, true) => "torque that follows the speed, and a Wiener process",
            (1, false) => "torque that repeats every turn, and a Wiener process",
            (1, true) => {
                "torque that repeats every turn and follows the speed, and a Wiener process"
            }
            (_, false) => "torque that repeats every two turns, and a Wiener process",
            (_, true) => {
                "torque that repeats every two turns and follows the speed, and a Wiener process"
            }
        }
    }
}

/// The prior without mechanics: a smoothing spline of degree seven in state-space form.
pub(super) const KINEMATIC: Prior = Prior::new(Unknown::Acceleration, 2);

/// The priors without mechanics, which are polynomials of degree order + 1 without process noise.
pub(super) const WITHOUT_MECHANICS: &[Prior] = &[KINEMATIC, Prior::new(Unknown::Acceleration, 3)];

/// A torque as a Wiener process.
pub(super) const TORQUE: Prior = Prior::new(Unknown::Torque, 1);

/// The torque of computed samples, in which a force is smoother than its prior.
pub(super) const SMOOTH: Prior = Prior::new(Unknown::Torque, 3);

/// A torque in proportion to the speed, and a Wiener process.
pub(super) const FOLLOWING: Prior = Prior {
    follows_speed: true,
    ..TORQUE
};

/// All priors without a part that repeats, in lists of one unknown.
pub(super) const LADDERS: [&[Prior]; 4] = [
    &[Prior::new(Unknown::Force, 1), Prior::new(Unknown::Force, 2)],
    &[TORQUE, Prior::new(Unknown::Torque, 2), SMOOTH],
    &[FOLLOWING],
    WITHOUT_MECHANICS,
];
