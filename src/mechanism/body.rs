//! Bodies: each enters the equation only through the path p(θ) of one of its points and its turn angle
//! ψ(θ), with two derivatives each.

use super::{Linkage, Pose};
use crate::scene::{RodModel, Scene};

/// Where the mass of a body sits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Body {
    /// Fixed to the crank: coordinates along O→A and to its left, m.
    OnCrank {
        /// kg
        mass: f64,
        /// m
        along: f64,
        /// m
        left: f64,
    },
    /// Fixed to the rod: coordinates of its centre of gravity from A along A→P and to its left, m;
    /// moment of inertia about it, kg m².
    OnRod {
        /// kg
        mass: f64,
        /// m
        along: f64,
        /// m
        left: f64,
        /// kg m²
        inertia: f64,
    },
    /// Fixed to the slider.
    OnSlider {
        /// kg
        mass: f64,
    },
}

/// Derivatives of a body's path and turn angle with respect to the crank angle.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Path {
    /// p', m/rad
    pub dp: [f64; 2],
    /// p'', m/rad²
    pub d2p: [f64; 2],
    /// ψ'
    pub dpsi: f64,
    /// ψ''
    pub d2psi: f64,
}

impl Path {
    /// Path of a point at (along, left) of the crank.
    pub fn on_crank(pose: &Pose, along: f64, left: f64) -> Path {
        let (sin, cos) = (pose.sin, pose.cos);
        Path {
            dp: [-along * sin - left * cos, along * cos - left * sin],
            d2p: [-along * cos + left * sin, -along * sin - left * cos],
            dpsi: 1.0,
            d2psi: 0.0,
        }
    }

    #[inline(always)]
    /// Path of a point at (along, left) of the rod: A plus the point in the rod's axes
    /// d = (s cos φ, −sin φ), n = (sin φ, s cos φ), which turn by ψ' = −s φ'.
    pub fn on_rod(linkage: &Linkage, pose: &Pose, along: f64, left: f64) -> Path {
        let s = linkage.s;
        let (dx, dy) = (s * pose.cos_phi, -pose.sin_phi);
        // The point from A, and the same turned by 90 degrees.
        let (gx, gy) = (along * dx - left * dy, along * dy + left * dx);
        let (dpsi, d2psi) = (-s * pose.dphi, -s * pose.d2phi);
        let (ax, ay) = (linkage.r * pose.cos, linkage.r * pose.sin);
        let squared = dpsi * dpsi;
        Path {
            dp: [-ay - dpsi * gy, ax + dpsi * gx],
            d2p: [
                -ax - d2psi * gy - squared * gx,
                -ay + d2psi * gx - squared * gy,
            ],
            dpsi,
            d2psi,
        }
    }

    /// Path of the end of an arm that turns: first and second derivative of its angle.
    pub(super) fn turning([x, y]: [f64; 2], [first, second]: [f64; 2]) -> Path {
        let squared = first * first;
        Path {
            dp: [-y * first, x * first],
            d2p: [-y * second - squared * x, x * second - squared * y],
            dpsi: first,
            d2psi: second,
        }
    }

    /// The path of what hangs on the end of this arm and turns as `arm` does.
    pub(super) fn carrying(&self, arm: &Path) -> Path {
        let sum = |a: [f64; 2], b: [f64; 2]| [a[0] + b[0], a[1] + b[1]];
        Path {
            dp: sum(self.dp, arm.dp),
            d2p: sum(self.d2p, arm.d2p),
            ..*arm
        }
    }

    /// Path of the slider.
    pub fn on_slider(pose: &Pose) -> Path {
        Path {
            dp: [pose.dx, 0.0],
            d2p: [pose.d2x, 0.0],
            dpsi: 0.0,
            d2psi: 0.0,
        }
    }
}

/// The bodies of a scene, sorted into what has inertia and what has weight. Only for the rod model
/// `spin-only` do the two differ.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Bodies {
    /// Constant part of M: crank inertia about O and masses fixed to the crank, kg m².
    pub crank_inertia: f64,
    /// Bodies whose part of M depends on the crank angle.
    pub moving: Vec<Body>,
    /// Bodies on which gravity acts.
    pub heavy: Vec<Body>,
}

impl Bodies {
    /// The bodies of a scene from which parts without strength were taken out.
    pub fn new(scene: &Scene) -> Bodies {
        let mut bodies = Bodies::default();
        let r = scene.geometry.crank;
        let mut slider_mass = scene.slider.map_or(0.0, |slider| slider.mass);
        if let Some(crank) = &scene.crank {
            bodies.crank_inertia = crank.inertia;
            if crank.mass != 0.0 {
                bodies.heavy.push(Body::OnCrank {
                    mass: crank.mass,
                    along: crank.cg,
                    left: crank.cg_lateral,
                });
            }
        }
        if let Some(rod) = &scene.rod {
            match rod.model {
                RodModel::Massless => {}
                RodModel::Rigid => {
                    let body = Body::OnRod {
                        mass: rod.mass,
                        along: rod.cg,
                        left: rod.cg_lateral,
                        inertia: rod.central_inertia().max(0.0),
                    };
                    bodies.moving.push(body);
                    bodies.heavy.push(body);
                }
                RodModel::TwoMass => {
                    let at_wrist_pin = rod.mass * rod.cg / scene.geometry.rod;
                    let at_crank_pin = rod.mass - at_wrist_pin;
                    bodies.crank_inertia += at_crank_pin * r * r;
                    bodies.heavy.push(Body::OnCrank {
                        mass: at_crank_pin,
                        along: r,
                        left: 0.0,
                    });
                    slider_mass += at_wrist_pin;
                }
                RodModel::SpinOnly => {
                    bodies.moving.push(Body::OnRod {
                        mass: 0.0,
                        along: 0.0,
                        left: 0.0,
                        inertia: rod.inertia,
                    });
                    bodies.heavy.push(Body::OnCrank {
                        mass: rod.mass,
                        along: scene.geometry.rod + rod.cg,
                        left: 0.0,
                    });
                }
            }
        }
        if slider_mass != 0.0 {
            let slider = Body::OnSlider { mass: slider_mass };
            bodies.moving.push(slider);
            bodies.heavy.push(slider);
        }
        bodies
    }

    /// Whether anything resists acceleration, in some position.
    pub fn have_inertia(&self) -> bool {
        let mut moving = self.moving.iter();
        self.crank_inertia != 0.0
            || moving.any(|body| match *body {
                Body::OnRod { mass, inertia, .. } => mass != 0.0 || inertia != 0.0,
                Body::OnCrank { mass, .. } | Body::OnSlider { mass } => mass != 0.0,
            })
    }
}
