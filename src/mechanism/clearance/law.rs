//! Contact law: normal force between journal and bearing from penetration and penetration rate.

use crate::scene::{Clearance, ContactLaw, Problem, Problems};

/// Normal force F = K δ^1.5 (1 + D δ̇/δ̇₀), never negative: journal and bearing do not stick to each other.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct NormalForce {
    /// K, N/m^1.5
    pub stiffness: f64,
    /// D, dimensionless
    pub damping: f64,
}

impl NormalForce {
    /// Builds the law of a scene's joint.
    ///
    /// # Errors
    /// [`Problems`]: all values that the law needs and the scene lacks.
    pub fn new(clearance: &Clearance) -> Result<NormalForce, Problems> {
        let mut missing = Vec::new();
        let mut given = |value: Option<f64>, name: &str, example: &str| {
            value.unwrap_or_else(|| {
                missing.push(Problem::new(
                    &format!("clearance.{name}"),
                    format!("clearance.{name} is missing, and the contact force depends on it"),
                    format!("add {name} = {example} to [clearance], or use contact_law = \"massless-link\""),
                ));
                f64::NAN
            })
        };
        let bearing = given(clearance.bearing_radius, "bearing_radius", "\"10 mm\"");
        let modulus = given(clearance.young_modulus, "young_modulus", "\"207 GPa\"");
        let poisson = given(clearance.poisson_ratio, "poisson_ratio", "0.3");
        let restitution = given(clearance.restitution, "restitution", "0.9");
        if !missing.is_empty() {
            return Err(Problems::in_code(missing));
        }
        Ok(NormalForce {
            stiffness: hertz_stiffness(bearing, clearance.radial, modulus, poisson),
            damping: damping(clearance.law, restitution),
        })
    }

    /// Returns the force without damping, N, at a penetration (m) that is not negative.
    pub fn elastic(&self, depth: f64) -> f64 {
        self.stiffness * depth * depth.sqrt()
    }

    /// Returns a value with the sign of dF/dt of a positive force, at a penetration (m) with its first two derivatives.
    pub fn growth(&self, [depth, rate, acceleration]: [f64; 3], approach: f64) -> f64 {
        1.5 * rate * self.factor(rate, approach) + depth * self.damping * acceleration / approach
    }

    /// Returns the energy stored at a penetration (m), J.
    pub fn stored(&self, depth: f64) -> f64 {
        0.4 * self.stiffness * depth * depth * depth.max(0.0).sqrt()
    }

    /// Returns 1 + D δ̇/δ̇₀, the damping factor of the elastic force; below zero no force acts.
    pub fn factor(&self, rate: f64, approach: f64) -> f64 {
        1.0 + self.damping * rate / approach
    }
}

/// Returns the Hertz stiffness K, N/m^1.5, of two spheres, one hollow, of the same material: K = 4/(3·2σ)
/// √(R₁R₂/(R₁ − R₂)) with σ = (1 − ν²)/E (Lankarani and Nikravesh 1990, eq. 2; the hollow radius counts negative).
fn hertz_stiffness(bearing: f64, radial: f64, modulus: f64, poisson: f64) -> f64 {
    let compliance = (1.0 - poisson * poisson) / modulus;
    let journal = bearing - radial;
    2.0 / (3.0 * compliance) * (bearing * journal / radial).sqrt()
}

fn damping(law: ContactLaw, e: f64) -> f64 {
    match law {
        ContactLaw::LankaraniNikravesh => 0.75 * (1.0 - e * e),
        ContactLaw::HuntCrossley => 1.5 * (1.0 - e),
        ContactLaw::Flores => 1.6 * (1.0 - e) / e,
        ContactLaw::Gonthier => (1.0 - e * e) / e,
        ContactLaw::Hertz | ContactLaw::MasslessLink => 0.0,
    }
}
