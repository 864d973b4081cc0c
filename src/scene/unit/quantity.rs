//! What the values of a scene measure.

use super::symbol::{self, Dimension};

/// What a value of a scene file measures; fixes the units it may have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// m
    Length,
    /// kg
    Mass,
    /// kg m²
    Inertia,
    /// rad
    Angle,
    /// rad/s
    AngularSpeed,
    /// m/s²
    Acceleration,
    /// s
    Time,
    /// N
    Force,
    /// N m
    Torque,
    /// N m s/rad
    RotaryDamping,
    /// N s/m
    LinearDamping,
    /// N/m
    Stiffness,
    /// Pa
    Pressure,
    /// kg/m³
    Density,
    /// m/s
    Velocity,
    /// no dimension
    Number,
}

impl Quantity {
    fn facts(self) -> (&'static str, Dimension, &'static str) {
        match self {
            Self::Length => ("a length", [1, 0, 0, 0], "\"47 mm\", \"0.047 m\", \"2 in\""),
            Self::Mass => ("a mass", [0, 1, 0, 0], "\"0.86 kg\", \"860 g\", \"1.9 lb\""),
            Self::Inertia => (
                "a moment of inertia",
                [2, 1, 0, 0],
                "\"5807.55 kg mm^2\", \"0.0058 kg m^2\"",
            ),
            Self::Angle => (
                "an angle",
                [0, 0, 0, 1],
                "\"40 deg\", \"0.7 rad\", \"2 rev\"",
            ),
            Self::AngularSpeed => (
                "an angular speed",
                [0, 0, -1, 1],
                "\"200 rpm\", \"100 rad/s\", \"30 deg/s\"",
            ),
            Self::Acceleration => ("an acceleration", [1, 0, -2, 0], "\"9.80665 m/s^2\""),
            Self::Time => ("a time", [0, 0, 1, 0], "\"1 s\", \"5 ms\", \"2 min\""),
            Self::Force => ("a force", [1, 1, -2, 0], "\"-200 N\", \"5 kN\", \"10 lbf\""),
            Self::Torque => (
                "a torque",
                [2, 1, -2, 0],
                "\"2 N m\", \"250 N mm\", \"1 lbf ft\"",
            ),
            Self::RotaryDamping => (
                "a torque per angular speed",
                [2, 1, -1, -1],
                "\"0.02 N m s/rad\"",
            ),
            Self::LinearDamping => ("a force per velocity", [0, 1, -1, 0], "\"15 N s/m\""),
            Self::Stiffness => ("a stiffness", [0, 1, -2, 0], "\"2 kN/m\", \"3 N/mm\""),
            Self::Pressure => ("a pressure", [-1, 1, -2, 0], "\"10 bar\", \"101325 Pa\""),
            Self::Density => (
                "a density",
                [-3, 1, 0, 0],
                "\"7800 kg/m^3\", \"7.8 g/cm^3\"",
            ),
            Self::Velocity => ("a velocity", [1, 0, -1, 0], "\"2 m/s\""),
            Self::Number => ("a number", [0; 4], "0.1, 1e-10"),
        }
    }

    /// Symbols of its units beside those made of several.
    pub(super) fn symbols(self) -> Vec<&'static str> {
        symbol::symbols(self.facts().1).collect()
    }

    /// The quantity in words, with its article.
    pub fn name(self) -> &'static str {
        self.facts().0
    }

    /// Accepted spellings, for error messages and the schema.
    pub fn examples(self) -> &'static str {
        self.facts().2
    }

    /// The SI unit as names of columns have it; empty for numbers.
    #[cfg(feature = "cli")]
    pub(in crate::scene) fn column(self) -> &'static str {
        match self {
            Self::Length => "m",
            Self::Mass => "kg",
            Self::Inertia => "kg_m2",
            Self::Angle => "rad",
            Self::AngularSpeed => "rad_per_s",
            Self::Acceleration => "m_per_s2",
            Self::Time => "s",
            Self::Force => "n",
            Self::Torque => "nm",
            Self::RotaryDamping => "nm_s_per_rad",
            Self::LinearDamping => "n_s_per_m",
            Self::Stiffness => "n_per_m",
            Self::Pressure => "pa",
            Self::Density => "kg_per_m3",
            Self::Velocity => "m_per_s",
            Self::Number => "",
        }
    }

    /// The SI unit as scene files have it; empty for numbers.
    pub(in crate::scene) fn si(self) -> &'static str {
        match self {
            Self::Length => "m",
            Self::Mass => "kg",
            Self::Inertia => "kg m^2",
            Self::Angle => "rad",
            Self::AngularSpeed => "rad/s",
            Self::Acceleration => "m/s^2",
            Self::Time => "s",
            Self::Force => "N",
            Self::Torque => "N m",
            Self::RotaryDamping => "N m s/rad",
            Self::LinearDamping => "N s/m",
            Self::Stiffness => "N/m",
            Self::Pressure => "Pa",
            Self::Density => "kg/m^3",
            Self::Velocity => "m/s",
            Self::Number => "",
        }
    }

    /// Radians are a dimension only where leaving them out could be a mistake:
    /// `N m s` is as good as `N m s/rad`.
    pub(super) fn accepts(self, found: Dimension) -> bool {
        let want = self.facts().1;
        found == want || (self == Self::RotaryDamping && found[..3] == want[..3] && found[3] == 0)
    }
}
