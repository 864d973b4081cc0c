//! Loop closure by the Newton-Raphson method, as in Gupta's script: a check that shares nothing with the closed form.

use super::Linkage;

/// Result of the iteration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Closure {
    /// Angle of the rod as seen from the slider, from +x, rad.
    pub theta3: f64,
    /// Slider position, m.
    pub x: f64,
    /// Newton-Raphson steps.
    pub iterations: u32,
}

impl Linkage {
    /// Solves r cos θ − l cos θ₃ − x = 0, e + r sin θ − l sin θ₃ = 0 (Gupta (2), (3)) for θ₃ and x from a guess, until
    /// the norm of the two is at most `tolerance` (m). The solution may lie on either branch, on the left one where
    /// cos θ₃ > 0; none where the Jacobian is singular, with the rod guessed normal to the guide, or after a hundred
    /// steps without convergence.
    pub fn close_loop(&self, theta: f64, guess: (f64, f64), tolerance: f64) -> Option<Closure> {
        let Linkage { r, l, e, .. } = *self;
        let (mut theta3, mut x) = guess;
        for iterations in 0..=100 {
            let (sin3, cos3) = theta3.sin_cos();
            let f1 = r * theta.cos() - l * cos3 - x;
            let f2 = e + r * theta.sin() - l * sin3;
            if f1.hypot(f2) <= tolerance {
                return Some(Closure {
                    theta3,
                    x,
                    iterations,
                });
            }
            // [l sin θ₃, −1; −l cos θ₃, 0] (δ, ξ) = −(f1, f2).
            let step = f2 / (l * cos3);
            theta3 += step;
            x += f1 + l * sin3 * step;
        }
        None
    }
}
