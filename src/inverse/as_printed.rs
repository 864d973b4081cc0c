//! Slider force as printed by Duarte, Valencia and Obregon (2018), beside the complete one.

use super::row::InverseRow;
use crate::error::Error;
use crate::mechanism::Equation;
use crate::scene::{Crank, Rod, RodModel, Scene, Slider};

/// Slider force of an in-line mechanism, by the paper's energies and by equation (9) as printed.
///
/// Equation (7) of the paper omits the translation of the rod, and (8) puts its centre of gravity at another height:
/// the rod model `spin-only`. Equation (9) has in addition a slider speed that contradicts (5), and a minus in place of
/// a plus in the slider's centrifugal term.
#[derive(Debug)]
pub struct AsPrinted {
    spin_only: Equation,
    l2: f64,
    l3: f64,
    crank: Crank,
    rod: Rod,
    slider: Slider,
    gravity: f64,
    friction: bool,
}

impl AsPrinted {
    /// Creates the forces of a scene with crank, rod and slider, without offset, on the right branch.
    ///
    /// # Errors
    /// [`Error::Refused`] for other scenes.
    pub fn new(scene: &Scene) -> Result<AsPrinted, Error> {
        let geometry = &scene.geometry;
        let in_line = geometry.offset == 0.0 && geometry.branch.sign() > 0.0;
        let (Some(crank), Some(rod), Some(slider), true) =
            (scene.crank, scene.rod, scene.slider, in_line)
        else {
            return Err(Error::refused(
                "the equation of Duarte et al. is one of a crank, a rod and a slider in line with the pivot, on the right branch",
                "leave --as-printed out, or use a scene like the built-in one",
            ));
        };
        let mut spin_only = scene.clone();
        spin_only.rod = Some(Rod {
            model: RodModel::SpinOnly,
            ..rod
        });
        Ok(AsPrinted {
            spin_only: Equation::new(&spin_only),
            l2: geometry.crank,
            l3: geometry.rod,
            crank,
            rod,
            slider,
            gravity: scene.gravity.map_or(0.0, |gravity| gravity.acceleration),
            friction: scene.reduced().friction.is_some(),
        })
    }

    /// Returns a warning for the summary if the scene has friction, which the printed equations lack.
    pub fn warning(&self) -> Option<String> {
        self.friction.then(|| {
            "the equations of Duarte et al. have no friction: the printed forces are the whole force on the slider, the friction of the guide included".to_owned()
        })
    }

    /// Returns the slider force, N, of a row by the paper's energies, and by (9) as printed; none if the row has no
    /// force.
    pub fn forces(&self, row: &InverseRow) -> Option<[f64; 2]> {
        row.slider_force?;
        let terms = self.spin_only.terms(row.theta);
        let load = self.spin_only.load(row.t, row.theta, row.omega);
        let torque = self
            .spin_only
            .generalized_force(&terms, row.omega, row.alpha)
            - load.torque;
        let printed = (self.left_side(row) - load.torque) / terms.pose.dx;
        Some([torque / terms.pose.dx, printed])
    }

    /// Returns the left side of (9), N m.
    fn left_side(&self, row: &InverseRow) -> f64 {
        let (l2, l3) = (self.l2, self.l3);
        let (sin, cos) = row.theta.sin_cos();
        let (i2, i3, m4) = (self.crank.inertia, self.rod.inertia, self.slider.mass);
        let low = l3 - l2 * sin;
        let high = l3 + l2 * sin;
        let both = high * low;
        let of_alpha = i2
            + i3 * (l2 * cos).powi(2) / both
            + m4 * (l2 * sin).powi(2) * (l3 * l3 - l2 * l2).powi(2) / (both * both);
        let of_omega = m4 * l2 * l2 * cos * sin * (l3 - l2).powi(2) * both * (l3 + l2).powi(2)
            / both.powi(3)
            - i3 * l2 * l2 * (l3 * l3 - l2 * l2) * (2.0 * sin * cos) / (2.0 * both * both);
        let weight = self.crank.mass * self.crank.cg + self.rod.mass * (l3 + self.rod.cg);
        of_alpha * row.alpha + of_omega * row.omega * row.omega + self.gravity * cos * weight
    }
}
