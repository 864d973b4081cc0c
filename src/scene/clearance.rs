//! Clearance at a revolute joint, and its contact law.

/// Radial clearance at one revolute joint. The rod carries the bearing; the pin is the journal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Clearance {
    /// Joint that has the clearance.
    pub joint: Joint,
    /// Radial clearance, m: radius of the bearing minus radius of the journal.
    pub radial: f64,
    /// Bearing radius, m.
    pub bearing_radius: Option<f64>,
    /// Young's modulus of both materials, Pa.
    pub young_modulus: Option<f64>,
    /// Poisson's ratio of both materials, dimensionless.
    pub poisson_ratio: Option<f64>,
    /// Coefficient of restitution, dimensionless, 0 to 1.
    pub restitution: Option<f64>,
    /// Coefficient of friction in the contact; `None`: no friction.
    pub friction: Option<f64>,
    /// Law of the normal contact force.
    pub law: ContactLaw,
    /// Sliding speed, m/s, up to which friction grows linearly; Coulomb friction beyond.
    pub friction_threshold: f64,
    /// Least approach speed, m/s, in the divisor of a contact law; slower contacts count as beginning with this speed.
    pub least_approach_speed: f64,
    /// Initial distance of the journal's centre from the bearing's, m; `None`: 0, or for
    /// [`ContactLaw::MasslessLink`] the radial clearance.
    pub eccentricity: Option<f64>,
    /// Initial direction from the bearing's centre to the journal's, rad from +x; `None`: the direction in which the
    /// ideal joint would be loaded.
    pub eccentricity_angle: Option<f64>,
}

impl Clearance {
    /// Creates a radial clearance (m) at a joint, with the law of Lankarani and Nikravesh, friction threshold 0.01 m/s,
    /// least approach speed 1 mm/s, and without values for the contact.
    ///
    /// ```
    /// use slider_crank::scene::{Clearance, Joint};
    /// let clearance = Clearance {
    ///     bearing_radius: Some(0.01),
    ///     young_modulus: Some(207e9),
    ///     poisson_ratio: Some(0.3),
    ///     restitution: Some(0.9),
    ///     ..Clearance::new(Joint::WristPin, 0.5e-3)
    /// };
    /// assert_eq!(clearance.friction, None);
    /// ```
    pub fn new(joint: Joint, radial: f64) -> Clearance {
        Clearance {
            joint,
            radial,
            bearing_radius: None,
            young_modulus: None,
            poisson_ratio: None,
            restitution: None,
            friction: None,
            law: ContactLaw::default(),
            friction_threshold: 0.01,
            least_approach_speed: 1e-3,
            eccentricity: None,
            eccentricity_angle: None,
        }
    }
}

named! {
    /// A revolute joint of the connecting rod.
    pub enum Joint {
        /// Joint A of crank and rod.
        CrankPin = "crank-pin",
        /// Joint P of rod and slider.
        WristPin = "wrist-pin",
    }
}

named! {
    /// Law of the normal contact force F = K δ^1.5 (1 + D δ̇/δ̇₀), with the penetration δ and its rate δ̇₀ at the
    /// beginning of the contact. The laws differ in how D follows from the coefficient of restitution e.
    #[derive(Default)]
    pub enum ContactLaw {
        /// Lankarani and Nikravesh, J. Mech. Design 112 (1990) 369: D = 3(1 − e²)/4, for e near 1.
        #[default]
        LankaraniNikravesh = "lankarani-nikravesh",
        /// Hunt and Crossley, J. Appl. Mech. 42 (1975) 440: D = 3(1 − e)/2, for e near 1.
        HuntCrossley = "hunt-crossley",
        /// Flores, Machado, Silva and Martins, Multibody Syst. Dyn. 25 (2011) 357: D = 8(1 − e)/(5e).
        Flores = "flores",
        /// Gonthier, McPhee, Lange and Piedbœuf, Multibody Syst. Dyn. 11 (2004) 209: D = (1 − e²)/e.
        Gonthier = "gonthier",
        /// Hertz: D = 0, no energy loss at any restitution.
        Hertz = "hertz",
        /// Massless link: journal and bearing always in contact, their centres at the distance of the radial clearance.
        MasslessLink = "massless-link",
    }
}
