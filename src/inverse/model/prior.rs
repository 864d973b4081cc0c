//! Priors among which the likelihood chooses: the unknown of the equation of motion and its random process.

/// Largest order of a prior.
pub(in crate::inverse) const ORDERS: usize = 3;

/// State: θ, ω, u, then the derivatives of u, then g₁ and g₂.
pub(in crate::inverse) type State = [f64; 2 + ORDERS + 2];

/// Returns a state of θ, rad, ω, rad/s, and u, and of nothing beside.
pub(in crate::inverse) fn plain_state([theta, omega, unknown]: [f64; 3]) -> State {
    let mut state = State::default();
    [state[0], state[1], state[2]] = [theta, omega, unknown];
    state
}

/// Returns ω and ω|ω|.
pub(in crate::inverse) fn powers_of(omega: f64) -> [f64; 2] {
    [omega, omega * omega.abs()]
}

/// What is unknown and varies as an integrated Wiener process.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::inverse) enum Unknown {
    /// θ̈ itself: no mechanics.
    Acceleration,
    /// A torque on the crank beside the loads of the scene.
    Torque,
    /// A force on the slider beside the loads of the scene.
    Force,
}

/// A prior of the motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::inverse) struct Prior {
    pub unknown: Unknown,
    /// Number of integrations from the white noise to u: 1 (Wiener process) or more.
    pub order: usize,
    /// Number of powers of the speed that are parts of u beside that, with constants that are the last states: g₁ ω, then
    /// g₂ ω|ω|. With one or more the amplitudes of what repeats are straight lines over ω.
    pub powers: usize,
    /// Turns of the cycle in which a part of u repeats; 0 without such a part.
    pub cycle: u8,
    /// Harmonics of that part in a cycle: 1, 2, ... up to this one.
    pub harmonics: usize,
    /// Harmonics in a cycle beside those.
    pub high: High,
}

/// Numbers of high harmonics.
pub(in crate::inverse) type High = [Option<u16>; 4];

impl Prior {
    /// u as an integrated Wiener process, and nothing beside.
    pub const fn new(unknown: Unknown, order: usize) -> Prior {
        Prior {
            unknown,
            order,
            powers: 0,
            cycle: 0,
            harmonics: 0,
            high: [None; 4],
        }
    }

    /// This prior beside a part that repeats and is known.
    pub fn beside_known(self) -> Prior {
        Prior {
            powers: self.powers,
            ..Prior::new(self.unknown, self.order)
        }
    }

    /// This prior with twice the harmonics from the first one on.
    pub fn with_twice_the_harmonics(self) -> Prior {
        let harmonics = 2 * self.harmonics;
        let is_beside = |high: &u16| usize::from(*high) > harmonics;
        Prior {
            harmonics,
            high: self.high.map(|high| high.filter(is_beside)),
            ..self
        }
    }

    /// This prior of every turn with a cycle of two turns.
    pub fn over_two_turns(self) -> Prior {
        Prior {
            cycle: 2,
            harmonics: 2 * self.harmonics,
            high: self.high.map(|high| high.map(|number| 2 * number)),
            ..self
        }
    }

    /// Returns the numbers of the harmonics in the order of their coefficients: the high ones first.
    pub fn numbers(self) -> impl Iterator<Item = usize> + Clone {
        let high = self.high.into_iter().flatten().map(usize::from);
        high.chain(1..=self.harmonics)
    }

    /// Number of coefficients of what repeats.
    pub fn coefficients(self) -> usize {
        self.of_harmonic() * self.numbers().count()
    }

    /// Number of coefficients of each harmonic: of cos kθ and sin kθ, and of these times the speed.
    pub fn of_harmonic(self) -> usize {
        if self.powers > 0 { 4 } else { 2 }
    }

    /// Number of waves of its highest harmonic in a turn, but for the high ones.
    pub fn waves(self) -> f64 {
        self.harmonics as f64 / f64::from(self.cycle.max(1))
    }

    /// Whether the unknown is that of another prior, and follows the same powers of the speed.
    pub fn is_alike(self, other: Prior) -> bool {
        self.unknown == other.unknown && self.powers == other.powers
    }

    /// Whether so many passages of the crank tell it: a twice integrated process beside both powers takes what varies in time for a law
    /// where no speed comes again.
    pub fn is_told_in(self, passes: f64) -> bool {
        self.powers < 2 || self.order < ORDERS || passes >= 2.0
    }

    /// Number of states.
    pub fn states(self) -> usize {
        self.diffuse() + self.powers
    }

    /// Returns the part of u, N m, that follows a speed, rad/s, with the constants of a state, and its derivative by the speed.
    pub fn of_speed(self, state: &State, omega: f64) -> [f64; 2] {
        let constants = state.iter().skip(self.diffuse()).take(self.powers);
        let terms = constants
            .zip(powers_of(omega))
            .zip([1.0, 2.0 * omega.abs()]);
        terms.fold([0.0; 2], |[sum, slope], ((g, power), rate)| {
            [sum + g * power, slope + g * rate]
        })
    }

    /// Number of the states that may begin anywhere; those of the speed's powers are no larger than the torque makes likely.
    pub fn diffuse(self) -> usize {
        2 + self.order
    }

    /// Names the random term in words.
    pub fn name(self) -> String {
        let process = match self.order {
            1 => "a Wiener process",
            2 => "an integrated Wiener process",
            _ => "a twice integrated Wiener process",
        };
        let unknown = match self.unknown {
            Unknown::Acceleration if self.order == 3 => {
                return "angle with white crackle, without mechanics".to_owned();
            }
            Unknown::Acceleration => return "angle with white snap, without mechanics".to_owned(),
            Unknown::Torque => "torque",
            Unknown::Force => "force",
        };
        let repeats = match self.cycle {
            0 => None,
            1 => Some("repeats every turn"),
            _ => Some("repeats every two turns"),
        };
        let follows = match (self.powers, self.cycle) {
            (0, _) => None,
            (2, 0) => Some("follows the speed and its square"),
            _ => Some("follows the speed"),
        };
        let parts = Vec::from_iter(repeats.into_iter().chain(follows)).join(" and ");
        match parts.as_str() {
            "" => format!("{unknown} as {process}"),
            _ => format!("{unknown} that {parts}, and {process}"),
        }
    }
}

/// The prior without mechanics: a smoothing spline of degree seven in state-space form.
pub(in crate::inverse) const KINEMATIC: Prior = Prior::new(Unknown::Acceleration, 2);

/// The priors without mechanics, which are polynomials of degree order + 1 without process noise.
pub(in crate::inverse) const WITHOUT_MECHANICS: &[Prior] =
    &[KINEMATIC, Prior::new(Unknown::Acceleration, 3)];

/// A torque as a Wiener process.
pub(in crate::inverse) const TORQUE: Prior = Prior::new(Unknown::Torque, 1);

/// A torque in proportion to the speed, and a Wiener process.
pub(in crate::inverse) const FOLLOWING: Prior = Prior {
    powers: 1,
    ..TORQUE
};

/// A torque with parts in proportion to the speed and to its square, and a Wiener process.
pub(in crate::inverse) const QUADRATIC: Prior = Prior {
    powers: 2,
    ..TORQUE
};

/// Returns a prior with all orders.
const fn ladder(first: Prior) -> [Prior; ORDERS] {
    [
        first,
        Prior { order: 2, ..first },
        Prior { order: 3, ..first },
    ]
}

/// All priors without a part that repeats, in lists of priors that are alike.
pub(in crate::inverse) const LADDERS: [&[Prior]; 5] = [
    &ladder(Prior::new(Unknown::Force, 1)),
    &ladder(TORQUE),
    &ladder(FOLLOWING),
    &ladder(QUADRATIC),
    WITHOUT_MECHANICS,
];
