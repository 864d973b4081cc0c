//! The formulas as they are printed, right or wrong.

use super::{CRANK, ROD, SPEED};

/// The printed formulas at one crank angle and offset.
#[derive(Clone, Copy, Debug)]
pub struct Printed {
    /// Offset e, m.
    pub e: f64,
    /// Crank angle, rad.
    pub theta: f64,
    /// Equivalent rotating mass m2, kg.
    pub m2: f64,
    /// Equivalent reciprocating mass m3, kg.
    pub m3: f64,
}

impl Printed {
    /// e + k sin θ
    pub fn u(&self) -> f64 {
        self.e + CRANK * self.theta.sin()
    }

    /// c² − (e + k sin θ)², to a power.
    pub fn root(&self, power: f64) -> f64 {
        (ROD * ROD - self.u().powi(2)).powf(power)
    }

    pub fn alpha(&self) -> f64 {
        (self.u() / ROD).asin()
    }

    /// (8)
    pub fn x(&self) -> f64 {
        CRANK * self.theta.cos() + self.root(0.5)
    }

    /// (10)
    pub fn s(&self) -> f64 {
        CRANK + ROD - CRANK * self.theta.cos() + self.root(0.5)
    }

    /// (12); (13) is ω times it.
    pub fn ds(&self) -> f64 {
        CRANK * self.theta.sin() + CRANK * self.theta.cos() * self.u() / self.root(0.5)
    }

    /// k (k cos 2θ − e sin θ) of (18) and (20).
    pub fn tilt(&self) -> f64 {
        CRANK * (CRANK * (2.0 * self.theta).cos() - self.e * self.theta.sin())
    }

    /// The last numerator of (18) and (20).
    pub fn square(&self) -> f64 {
        (CRANK * self.theta.cos() * self.u()).powi(2)
    }

    /// (18)
    pub fn dv2(&self) -> f64 {
        -SPEED * (self.tilt() / self.root(1.5) + self.square() / self.root(2.5))
    }

    /// (20), in SI.
    pub fn acceleration(&self) -> f64 {
        SPEED * (self.dv2() - SPEED * CRANK * self.theta.cos())
    }

    /// (20) with the exponents 1/2 and 3/2: the second derivative of x.
    pub fn acceleration_mended(&self) -> f64 {
        let inner = self.tilt() / self.root(0.5) + self.square() / self.root(1.5);
        -SPEED * SPEED * (CRANK * self.theta.cos() + inner)
    }

    /// (27)
    pub fn rod_speed(&self) -> f64 {
        SPEED * CRANK * self.theta.cos() / self.root(0.5)
    }

    /// (30), with the sign of its second term.
    pub fn rod_acceleration(&self, sign: f64) -> f64 {
        let cos = self.theta.cos();
        SPEED
            * SPEED
            * (-CRANK * self.theta.sin() / self.root(0.5)
                + sign * CRANK * CRANK * cos * cos * self.u() / self.root(1.5))
    }

    /// (37a)
    pub fn crank_force(&self) -> f64 {
        self.m2 * SPEED * SPEED * CRANK
    }

    /// (40)
    pub fn tangential(&self) -> f64 {
        self.crank_force() * (self.alpha() + self.theta).tan()
    }

    /// (41)
    pub fn rod_force(&self) -> f64 {
        self.crank_force() / (self.alpha() + self.theta).cos()
    }

    /// (42b)
    pub fn slider_inertia(&self) -> f64 {
        let sin = self.theta.sin();
        let middle = CRANK * (CRANK - 2.0 * CRANK * sin * sin - sin) / self.root(0.5);
        let last = self.square() / self.root(1.5);
        self.m3 * SPEED * SPEED * (CRANK * self.theta.cos() + middle - last)
    }

    /// (46b) for a slider acceleration.
    pub fn inertia(&self, acceleration: f64) -> f64 {
        -(self.crank_force() * self.theta.cos() + self.m3 * acceleration)
    }

    /// (47)
    pub fn crank_torque(&self) -> f64 {
        -CRANK * self.crank_force() * self.theta.cos()
    }

    /// (48) for a slider acceleration.
    pub fn torque(&self, acceleration: f64) -> f64 {
        CRANK * self.inertia(acceleration) * self.alpha().tan()
    }
}

/// (52), m/s², of a mechanism of lengths k and c at a speed.
pub fn existing_acceleration([k, c]: [f64; 2], speed: f64, theta: f64) -> f64 {
    -k * speed * speed * (theta.cos() + k / c * (2.0 * theta).cos())
}

/// (53), N m.
pub fn existing_torque(m3: f64, [k, c]: [f64; 2], speed: f64, theta: f64) -> f64 {
    let ratio = k / c;
    m3 * k
        * k
        * speed
        * speed
        * (ratio * theta.sin() / 4.0
            - (2.0 * theta).sin() / 2.0
            - 3.0 * ratio * (3.0 * theta).sin() / 4.0)
}
