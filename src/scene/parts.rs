//! Geometry, gravity and friction.

/// Lengths and assembly of the mechanism.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Geometry {
    /// Crank length r, m.
    pub crank: f64,
    /// Connecting rod length l, m.
    pub rod: f64,
    /// Offset e, m: the slider moves along y = −e.
    pub offset: f64,
    /// Side of the crank pin on which the slider is assembled.
    pub branch: Branch,
}

/// Assembly branch: the sign s in x = r cos θ + s l cos φ.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Branch {
    /// Right branch, s = +1.
    #[default]
    Right,
    /// Left branch, s = −1.
    Left,
}

impl Branch {
    /// Returns the sign s, +1 or −1.
    pub fn sign(self) -> f64 {
        match self {
            Branch::Right => 1.0,
            Branch::Left => -1.0,
        }
    }
}

/// A uniform gravity field.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gravity {
    /// Strength, m/s².
    pub acceleration: f64,
    /// Angle of the gravity vector from +x, rad; −π/2 is down.
    pub direction: f64,
}

impl Gravity {
    /// Returns standard gravity, 9.80665 m/s² along −y.
    pub fn standard() -> Gravity {
        Gravity {
            acceleration: 9.80665,
            direction: -std::f64::consts::FRAC_PI_2,
        }
    }

    /// Returns the gravity vector, m/s²; exact for the four directions of the axes.
    pub fn vector(&self) -> [f64; 2] {
        let quarter = self.direction / std::f64::consts::FRAC_PI_2;
        let (sin, cos) = if quarter == quarter.round() && quarter.abs() < 1e9 {
            [(0.0, 1.0), (1.0, 0.0), (0.0, -1.0), (-1.0, 0.0)]
                [(quarter as i64).rem_euclid(4) as usize]
        } else {
            self.direction.sin_cos()
        };
        [self.acceleration * cos, self.acceleration * sin]
    }
}

/// Coulomb friction at the slider guide.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Friction {
    /// Kinetic coefficient, dimensionless.
    pub coefficient: f64,
    /// Static coefficient, dimensionless.
    pub static_coefficient: f64,
}
