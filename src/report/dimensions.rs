//! Dimensions of the mechanism for drawings and the page.

use serde::Serialize;

use crate::scene::Scene;

/// Dimensions of the mechanism, m; body points as coordinates along the body and to the left of it.
#[derive(Debug, Serialize)]
pub(super) struct Dimensions {
    pub crank: f64,
    pub rod: f64,
    pub offset: f64,
    /// Branch sign, ±1.
    pub branch: f64,
    /// Centre of gravity of the crank, from its pivot; none without mass.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub crank_cg: Option<[f64; 2]>,
    /// Centre of gravity of the rod, from the crank pin; none without mass.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rod_cg: Option<[f64; 2]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    loose: Option<Loose>,
}

/// Loose joint with its radial clearance, m.
#[derive(Debug, Serialize)]
struct Loose {
    joint: String,
    radial: f64,
}

impl Dimensions {
    pub fn of(scene: &Scene) -> Dimensions {
        let geometry = &scene.geometry;
        let crank = scene.crank.filter(|crank| crank.mass > 0.0);
        let rod = scene.rod.filter(|rod| rod.mass > 0.0);
        Dimensions {
            crank: geometry.crank,
            rod: geometry.rod,
            offset: geometry.offset,
            branch: geometry.branch.sign(),
            crank_cg: crank.map(|crank| [crank.cg, crank.cg_lateral]),
            rod_cg: rod.map(|rod| [rod.cg, rod.cg_lateral]),
            loose: scene.clearance.as_ref().map(|clearance| Loose {
                joint: clearance.joint.name().replace('-', " "),
                radial: clearance.radial,
            }),
        }
    }
}
