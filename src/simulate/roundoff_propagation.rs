//! The spread of angle and speed, carried along the motion: what rounding does to a run grows and turns with it.

use super::state_transition::StateTransition;

/// Standard deviations of angle (rad) and speed (rad/s), in units of the last place, as two perturbations (angle, speed)
/// that have nothing to do with each other. Next to a limit, where all of them point along the motion for a while, what
/// is across it would be lost in variances.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Spread([[f64; 2]; 2]);

impl Spread {
    /// This one, or the one before where numbers have become too large.
    fn or(self, before: &Spread) -> Spread {
        let finite = self.0.iter().flatten().all(|size| size.is_finite());
        if finite { self } else { *before }
    }

    /// Of the angle, rad.
    pub fn angle(&self) -> f64 {
        self.0[0][0].hypot(self.0[1][0])
    }

    /// Of the speed, rad/s.
    pub fn speed(&self) -> f64 {
        self.0[0][1].hypot(self.0[1][1])
    }

    /// With errors of angle (rad) and speed (rad/s) that have nothing to do with it.
    pub fn plus(self, angle: f64, speed: f64) -> Spread {
        self.along(angle, 0.0).along(0.0, speed)
    }

    /// With an error of the acceleration (rad/s²) that lasts over a step of length h (s), at the end of the step.
    pub fn pushed(self, acceleration: f64, transition: &StateTransition, h: f64) -> Spread {
        let speed = transition[0][1] * acceleration;
        self.along(0.5 * h * speed, speed)
    }

    /// With errors of angle (rad) and speed (rad/s) that are one.
    pub fn along(self, angle: f64, speed: f64) -> Spread {
        // Rotated among each other until the angle is in the first alone, three perturbations are two.
        let [first, second] = self.0;
        let [first, second] = rotated(first, second);
        let [first, third] = rotated(first, [angle, speed]);
        Spread([first, [0.0, second[1].hypot(third[1])]]).or(&self)
    }

    /// With all of the speed times a factor.
    pub fn with_speed_times(self, factor: f64) -> Spread {
        Spread(self.0.map(|[angle, speed]| [angle, factor * speed])).or(&self)
    }

    /// After a transition.
    pub fn carried(self, [[c11, c12], [c21, c22]]: &StateTransition) -> Spread {
        let carried =
            |[angle, speed]: [f64; 2]| [c11 * angle + c12 * speed, c21 * angle + c22 * speed];
        Spread(self.0.map(carried)).or(&self)
    }
}

/// Two perturbations, rotated until the second has no angle.
fn rotated(a: [f64; 2], b: [f64; 2]) -> [[f64; 2]; 2] {
    let angle = a[0].hypot(b[0]);
    if angle == 0.0 {
        return [a, b];
    }
    let (cos, sin) = (a[0] / angle, b[0] / angle);
    [
        [angle, cos * a[1] + sin * b[1]],
        [0.0, cos * b[1] - sin * a[1]],
    ]
}

#[cfg(test)]
mod tests {
    use super::Spread;

    fn assert_close(value: f64, exact: f64) {
        assert!((value - exact).abs() < 1e-9 * exact, "{value}, not {exact}");
    }

    #[test]
    fn independent_errors_add_up_by_their_squares() {
        let spread = Spread::default().plus(3.0, 5.0).along(4.0, 12.0);
        assert_close(spread.angle(), 5.0);
        assert_close(spread.speed(), 13.0);
        let faster = spread.with_speed_times(2.0);
        assert_close(faster.speed(), 26.0);
    }

    /// A limit that is passed fast changes the speed a lot with the angle, and back again.
    #[test]
    fn what_is_small_beside_a_large_spread_is_kept() {
        let steep = |slope: f64| [[1.0, 0.0], [slope, 1.0]];
        let spread = Spread::default().plus(1.0, 3.0).carried(&steep(1e12));
        let back = spread.along(1e-3, 1e9).carried(&steep(-1e12));
        assert!((back.speed() - 3.0).abs() < 1e-3, "{back:?}");
        assert_close(back.angle(), 1f64.hypot(1e-3));
    }
}
