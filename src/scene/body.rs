//! Mass properties of crank, rod and slider.

/// Mass properties of the crank.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Crank {
    /// Mass, kg.
    pub mass: f64,
    /// Distance of the centre of gravity from O along the crank, m.
    pub cg: f64,
    /// Distance of the centre of gravity to the left of O→A, m.
    pub cg_lateral: f64,
    /// Moment of inertia about O, kg m².
    pub inertia: f64,
}

/// Mass properties of the connecting rod.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Rod {
    /// Model of the mass distribution.
    pub model: RodModel,
    /// Mass, kg.
    pub mass: f64,
    /// Distance of the centre of gravity from the crank pin along the rod, m.
    pub cg: f64,
    /// Distance of the centre of gravity to the left of A→P, m.
    pub cg_lateral: f64,
    /// Moment of inertia about the point `inertia_about`, kg m².
    pub inertia: f64,
    /// Reference point of `inertia`.
    pub inertia_about: InertiaAbout,
}

impl Rod {
    /// Returns the moment of inertia about the centre of gravity, kg m² (parallel axis theorem).
    pub fn central_inertia(&self) -> f64 {
        match self.inertia_about {
            InertiaAbout::Cg => self.inertia,
            InertiaAbout::CrankPin => {
                self.inertia - self.mass * (self.cg * self.cg + self.cg_lateral * self.cg_lateral)
            }
        }
    }
}

/// Reference point of the rod's moment of inertia.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum InertiaAbout {
    /// The centre of gravity.
    #[default]
    Cg,
    /// The crank pin A.
    CrankPin,
}

/// Model of the mass of the connecting rod.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum RodModel {
    /// A rigid body.
    #[default]
    Rigid,
    /// Two point masses at the pins that keep the centre of gravity (Obaseki & Alfred (31)-(36)).
    TwoMass,
    /// Spin energy only, and the potential as printed (Duarte et al. (7), (8)).
    SpinOnly,
    /// No mass.
    Massless,
}

/// Mass of the slider.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Slider {
    /// Mass, kg.
    pub mass: f64,
}
