//! Reference arithmetic and random mechanisms, independent of the library: truncated Taylor series in numbers of about
//! 31 digits, and the loop closure from first principles.

// Each test file uses only a part of this module.
#![allow(dead_code)]

pub mod alike;
pub mod exact;
pub mod image;
pub mod instrument;
pub mod judged;
pub mod machines;
pub mod newton;
pub mod pulses;
pub mod random;
pub mod reference;
pub mod rubbing;
pub mod run;
pub mod scenes;
pub mod seed;

use exact::{Dd, Jet};
use slider_crank::scene::{Branch, Geometry, InertiaAbout, Rod};

/// Returns the lengths of a mechanism as a geometry.
pub fn geometry(crank: f64, rod: f64, offset: f64, branch: Branch) -> Geometry {
    Geometry {
        crank,
        rod,
        offset,
        branch,
    }
}

/// Point of the plane along a motion.
pub type Point = [Jet; 2];

/// Mechanism at a crank angle, every quantity as a series in the angle.
pub struct Exact {
    /// Crank pin.
    pub a: Point,
    /// Wrist pin.
    pub p: Point,
    /// Unit vector from crank pin to wrist pin.
    pub axis: Point,
    /// sin φ and cos φ.
    pub sin_phi: Jet,
    pub cos_phi: Jet,
    /// φ'
    pub dphi: Jet,
    crank_axis: Point,
}

impl Exact {
    /// Places the crank pin on its circle, and the wrist pin on y = −e at distance l, on the side of the branch.
    pub fn new(g: &Geometry, theta: f64) -> Exact {
        let (sin, cos) = Jet::sin_cos(theta);
        let (r, l, e) = (Jet::from(g.crank), Jet::from(g.rod), Jet::from(g.offset));
        let a = [r * cos, r * sin];
        let drop = e + a[1];
        let reach = (l * l - drop * drop).sqrt();
        let p = [a[0] + Jet::from(g.branch.sign()) * reach, -e];
        let (sin_phi, cos_phi) = (drop / l, reach / l);
        Exact {
            axis: [(p[0] - a[0]) / l, (p[1] - a[1]) / l],
            dphi: cos_phi * sin_phi.derivative() - sin_phi * cos_phi.derivative(),
            crank_axis: [cos, sin],
            a,
            p,
            sin_phi,
            cos_phi,
        }
    }

    /// Returns a point fixed to the crank: along O→A, and to the left of it.
    pub fn on_crank(&self, along: f64, left: f64) -> Point {
        frame(&self.crank_axis, along, left)
    }

    /// Returns a point fixed to the rod: along A→P, and to the left of it.
    pub fn on_rod(&self, along: f64, left: f64) -> Point {
        let from_a = frame(&self.axis, along, left);
        [self.a[0] + from_a[0], self.a[1] + from_a[1]]
    }

    /// Returns ψ' of the rod, from its direction.
    pub fn dpsi(&self) -> Jet {
        let [x, y] = self.axis;
        x * y.derivative() - y * x.derivative()
    }
}

fn frame(axis: &Point, along: f64, left: f64) -> Point {
    let (along, left) = (Jet::from(along), Jet::from(left));
    [
        along * axis[0] - left * axis[1],
        along * axis[1] + left * axis[0],
    ]
}

/// Returns the rod's moment of inertia about its centre of gravity.
pub fn central_inertia(rod: &Rod) -> Dd {
    let about_cg = Dd::from(rod.inertia);
    match rod.inertia_about {
        InertiaAbout::Cg => about_cg,
        InertiaAbout::CrankPin => {
            let (mass, along, left) = (
                Dd::from(rod.mass),
                Dd::from(rod.cg),
                Dd::from(rod.cg_lateral),
            );
            about_cg - mass * (along * along + left * left)
        }
    }
}

/// Sizes of the terms of each derivative, as the scale of rounding.
pub struct Sizes {
    pub dphi: f64,
    pub d2phi: f64,
    pub d3phi: f64,
    pub x: f64,
    pub dx: f64,
    pub d2x: f64,
    pub d3x: f64,
}

impl Sizes {
    pub fn new(g: &Geometry, exact: &Exact) -> Sizes {
        let (r, u) = (g.crank, g.offset.abs() + g.crank);
        let w = g.rod * exact.cos_phi.value();
        let dphi = exact.dphi.value().abs();
        let d2phi = (u * dphi * dphi + r) / w;
        let d3phi = (3.0 * u * dphi * d2phi + r * (1.0 + dphi * dphi)) / w;
        Sizes {
            dphi,
            d2phi,
            d3phi,
            x: r + w,
            dx: r + u * dphi,
            d2x: r + r * dphi + u * d2phi,
            d3x: r + 2.0 * r * d2phi + r * dphi + u * d3phi,
        }
    }
}

/// Returns the factor by which W = l cos φ magnifies a rounding of e + r sin θ.
pub fn condition(g: &Geometry, theta: f64) -> f64 {
    let w = g.rod * Exact::new(g, theta).cos_phi.value();
    1.0 + (g.crank + g.offset.abs()) * g.rod / (w * w)
}

/// Fails unless `got` is `want` to within `tolerance` times `size`.
#[track_caller]
pub fn close(what: &str, got: f64, want: f64, size: f64, tolerance: f64) {
    let error = (got - want).abs() / size;
    assert!(
        error <= tolerance || got == want,
        "{what}: {got:e} instead of {want:e}, off by {error:e} of {size:e}, allowed {tolerance:e}"
    );
}
