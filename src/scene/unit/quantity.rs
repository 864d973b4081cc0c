//! Physical quantities of the values in a scene.

use super::symbol::Dimension;

/// Name of a quantity, its dimension, its SI unit in scene files, and usual spellings.
struct Properties(&'static str, Dimension, &'static str, &'static str);

/// Declares all quantities with their properties.
macro_rules! quantities {
    ($($quantity:ident: $name:literal, $dimension:expr, $si:literal, $examples:literal;)*) => {
        /// Physical quantity of a value in a scene file, which determines the units it may have.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum Quantity {
            $(#[doc = concat!("Written like ", $examples, ".")] $quantity,)*
        }

        impl Quantity {
            fn properties(self) -> Properties {
                match self {
                    $(Quantity::$quantity => Properties($name, $dimension, $si, $examples),)*
                }
            }
        }
    };
}

quantities! {
    Length: "a length", [1, 0, 0, 0], "m", "\"47 mm\", \"0.047 m\", \"2 in\"";
    Mass: "a mass", [0, 1, 0, 0], "kg", "\"0.86 kg\", \"860 g\", \"1.9 lb\"";
    Inertia: "a moment of inertia", [2, 1, 0, 0], "kg m^2", "\"5807.55 kg mm^2\", \"0.0058 kg m^2\"";
    Angle: "an angle", [0, 0, 0, 1], "rad", "\"40 deg\", \"0.7 rad\", \"2 rev\"";
    AngularSpeed: "an angular speed", [0, 0, -1, 1], "rad/s", "\"200 rpm\", \"100 rad/s\", \"30 deg/s\"";
    Acceleration: "an acceleration", [1, 0, -2, 0], "m/s^2", "\"9.80665 m/s^2\"";
    Time: "a time", [0, 0, 1, 0], "s", "\"1 s\", \"5 ms\", \"2 min\"";
    Force: "a force", [1, 1, -2, 0], "N", "\"-200 N\", \"5 kN\", \"10 lbf\"";
    Torque: "a torque", [2, 1, -2, 0], "N m", "\"2 N m\", \"250 N mm\", \"1 lbf ft\"";
    RotaryDamping: "a torque per angular speed", [2, 1, -1, -1], "N m s/rad", "\"0.02 N m s/rad\"";
    LinearDamping: "a force per velocity", [0, 1, -1, 0], "N s/m", "\"15 N s/m\"";
    Stiffness: "a stiffness", [0, 1, -2, 0], "N/m", "\"2 kN/m\", \"3 N/mm\"";
    Pressure: "a pressure", [-1, 1, -2, 0], "Pa", "\"10 bar\", \"101325 Pa\"";
    Density: "a density", [-3, 1, 0, 0], "kg/m^3", "\"7800 kg/m^3\", \"7.8 g/cm^3\"";
    Velocity: "a velocity", [1, 0, -1, 0], "m/s", "\"2 m/s\"";
    Energy: "an energy", [2, 1, -2, 0], "J", "\"50 J\", \"2 kJ\"";
    Power: "a power", [2, 1, -3, 0], "W", "\"500 W\", \"2 kW\"";
    Number: "a number", [0, 0, 0, 0], "", "0.1, 1e-10";
}

impl Quantity {
    /// Returns the exponents of metre, kilogram, second and radian.
    pub(super) fn dimension(self) -> Dimension {
        self.properties().1
    }

    /// Returns the quantity in words, with its article.
    pub fn name(self) -> &'static str {
        self.properties().0
    }

    /// Returns accepted spellings, for error messages and the schema.
    pub fn examples(self) -> &'static str {
        self.properties().3
    }

    /// Returns the unit of the first accepted spelling.
    pub(in crate::scene) fn usual_unit(self) -> &'static str {
        let first = self.examples().split('"').nth(1).unwrap_or_default();
        first.split_once(' ').map_or("", |(_, unit)| unit)
    }

    /// Returns the SI unit in the form of scene files; empty for numbers.
    pub(crate) fn si(self) -> &'static str {
        self.properties().2
    }

    /// Returns the name of a column of values in SI units: a number has no unit.
    #[cfg(feature = "cli")]
    pub(crate) fn column(self, name: &str) -> String {
        let unit = self.si().to_lowercase().replace("n m", "nm");
        let unit = unit.replace('^', "").replace('/', "_per_");
        format!("{name} {unit}").trim_end().replace(' ', "_")
    }

    /// Whether `found` is the dimension of this quantity. Radians count only where leaving them out could be a mistake:
    /// `N m s` is as good as `N m s/rad`.
    pub(super) fn accepts(self, found: Dimension) -> bool {
        let want = self.dimension();
        found == want || (self == Self::RotaryDamping && found[..3] == want[..3] && found[3] == 0)
    }
}
