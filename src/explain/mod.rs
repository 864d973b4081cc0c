//! Takes a scene, returns its plan, its equation with numbers, and the terms of the equation at one crank angle.

mod friction;

use serde::Serialize;

pub use friction::FrictionAt;
use friction::friction_at;

use crate::error::Error;
use crate::mechanism::{Equation, single};
use crate::plan::{Method, Plan};
use crate::scene::{LoadOf, RodModel, Scene};

/// Result of [`explain`].
#[derive(Clone, Debug, Serialize)]
pub struct Explanation {
    /// Title of the scene.
    pub scene: String,
    /// Engines, coordinate, events and terms.
    pub plan: Plan,
    /// Lines of the equation with the scene's numbers, SI and radians.
    pub equation: Vec<String>,
    /// Sign conventions.
    pub conventions: Vec<&'static str>,
    /// Terms at the requested crank angle, if one was requested.
    pub at: Option<TermsAt>,
}

/// Terms of the equation at one crank angle, at the initial speed of the scene and t = 0.
#[derive(Clone, Debug, Serialize)]
pub struct TermsAt {
    /// Crank angle, rad
    pub theta_rad: f64,
    /// Crank speed at which loads are evaluated, rad/s
    pub omega_rad_per_s: f64,
    /// Slider position x, m
    pub x_m: f64,
    /// Derivative x' = dx/dθ, m/rad
    pub dx_m_per_rad: f64,
    /// Effective inertia M, kg m²
    pub m_kg_m2: f64,
    /// Half the derivative of the effective inertia, ½ M', kg m²/rad
    pub half_dm_kg_m2_per_rad: f64,
    /// Derivative V' of the potential energy, N m
    pub dv_nm: f64,
    /// Loads with their parts of Q.
    pub loads: Vec<LoadAt>,
    /// Generalized force Q of the loads, N m
    pub q_nm: f64,
    /// Angular acceleration θ̈ with friction, rad/s²; none where the inertia vanishes or the guide jams
    pub alpha_rad_per_s2: Option<f64>,
    /// Crank torque beside the loads that keeps this speed without friction, N m
    pub holding_torque_nm: f64,
    /// Effect of friction at the guide and of dry loads; none without both.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub friction: Option<FrictionAt>,
}

/// Value of one load and its part of Q.
#[derive(Clone, Debug, Serialize)]
pub struct LoadAt {
    /// Key, like `torque[1]`, and description.
    pub name: String,
    /// Torque, N m, or force, N
    pub value: f64,
    /// Part of Q, N m
    pub q_nm: f64,
}

const CONVENTIONS: [&str; 5] = [
    "crank pivot O = (0, 0); crank angle theta counter-clockwise from +x; crank pin A = r (cos theta, sin theta)",
    "the slider P moves along y = -e; sin phi = (e + r sin theta)/l; x = r cos theta + s l cos phi",
    "s = +1 on the branch \"right\", -1 on \"left\"",
    "force F and position x of the slider positive along +x; torque and omega positive counter-clockwise",
    "a dash is d/dtheta, a dot d/dt",
];

/// Explains a scene; `at` is a crank angle, rad, for the terms.
///
/// # Errors
/// Errors of [`Plan::new`]; [`Error::Refused`] for an angle out of reach, or at which a load has no value.
pub fn explain(scene: &Scene, method: Method, at: Option<f64>) -> Result<Explanation, Error> {
    let plan = Plan::new(scene, method)?;
    let equation = Equation::new(scene);
    Ok(Explanation {
        scene: scene.title.clone().unwrap_or_default(),
        plan,
        equation: written_out(&scene.reduced()),
        conventions: CONVENTIONS.to_vec(),
        at: at
            .map(|theta| terms_at(scene, &equation, theta))
            .transpose()?,
    })
}

fn terms_at(scene: &Scene, equation: &Equation, theta: f64) -> Result<TermsAt, Error> {
    let terms = equation.terms(theta);
    let (pose, omega) = (&terms.pose, scene.motion.speed);
    if !pose.is_regular() {
        return Err(Error::refused(
            format!(
                "the mechanism has no position at crank angle {theta} rad, or is at its limit there"
            ),
            "give an angle that `kinematics` shows as reachable",
        ));
    }
    let now = pose.instant(0.0, theta, omega);
    let mut loads = Vec::new();
    for of in scene.loads() {
        let value = single(of.load, of.key.on_slider, &now);
        let name = format!("{}: {}", of.key, of.load);
        if !value.is_finite() {
            return Err(Error::refused(
                format!(
                    "{name}: it has no finite value at theta = {theta} rad, omega = {omega} rad/s, t = 0"
                ),
                "give another angle, or check the range of its table or the domain of its formula",
            ));
        }
        let arm = if of.key.on_slider { pose.dx } else { 1.0 };
        loads.push(LoadAt {
            name,
            value,
            q_nm: value * arm,
        });
    }
    let (alpha, friction) = match friction_at(scene, equation, theta)? {
        Some((alpha, friction)) => (alpha, Some(friction)),
        None => (Some(equation.acceleration(0.0, theta, omega)), None),
    };
    Ok(TermsAt {
        theta_rad: theta,
        omega_rad_per_s: omega,
        x_m: pose.x,
        dx_m_per_rad: pose.dx,
        m_kg_m2: terms.m,
        half_dm_kg_m2_per_rad: terms.half_dm,
        dv_nm: terms.dv,
        q_nm: loads.iter().fold(0.0, |sum, load| sum + load.q_nm),
        loads,
        alpha_rad_per_s2: alpha.filter(|alpha| alpha.is_finite()),
        holding_torque_nm: equation.driving_torque(0.0, theta, omega, 0.0),
        friction,
    })
}

/// Returns the equation and its parts with numbers, without parts that the scene does not have.
fn written_out(scene: &Scene) -> Vec<String> {
    let geometry = &scene.geometry;
    let (r, l, e) = (geometry.crank, geometry.rod, geometry.offset);
    let mut lines = vec!["M theta.. + 1/2 M' theta.^2 + V' = Q".to_owned()];
    let mut inertia = Vec::new();
    let mut potential = Vec::new();
    let gravity = scene.gravity.map(|gravity| gravity.vector());
    if let Some(crank) = &scene.crank {
        inertia.push(format!("{} (crank about O)", crank.inertia));
        if crank.mass != 0.0 {
            potential.push(format!("{} g.p_crank", crank.mass));
        }
    }
    if let Some(rod) = &scene.rod {
        match rod.model {
            RodModel::Rigid => {
                inertia.push(format!(
                    "{} |p_rod'|^2 + {} phi'^2 (rod)",
                    rod.mass,
                    short(rod.central_inertia())
                ));
                potential.push(format!("{} g.p_rod", rod.mass));
            }
            RodModel::TwoMass => {
                let wrist = short(rod.mass * rod.cg / l);
                let crank = short(rod.mass - wrist);
                inertia.push(format!("{crank} r^2 + {wrist} x'^2 (rod at its pins)"));
                potential.push(format!("{crank} g.A + {wrist} g.P"));
            }
            RodModel::SpinOnly => {
                inertia.push(format!("{} phi'^2 (rod, spin only)", rod.inertia));
                potential.push(format!(
                    "{} g.({} (cos theta, sin theta))",
                    rod.mass,
                    short(l + rod.cg)
                ));
            }
            RodModel::Massless => {}
        }
    }
    if let Some(slider) = &scene.slider {
        inertia.push(format!("{} x'^2 (slider)", slider.mass));
        potential.push(format!("{} g.P", slider.mass));
    }
    lines.push(format!("M = {}", joined(&inertia)));
    match gravity {
        Some([gx, gy]) if !potential.is_empty() => {
            lines.push(format!(
                "V = -({}), g = ({gx}, {gy})",
                potential.join(" + ")
            ));
        }
        _ => lines.push("V = 0".to_owned()),
    }
    let arm = |of: &LoadOf<'_>| if of.key.on_slider { " x'" } else { "" };
    let work = scene.loads().map(|of| format!("[{}]{}", of.load, arm(&of)));
    lines.push(format!("Q = {}", joined(&work.collect::<Vec<_>>())));
    let s = geometry.branch.sign();
    lines.push(format!("r = {r}, l = {l}, e = {e}, s = {s:+}"));
    lines
}

/// Rounds a computed value to 12 significant digits, which removes rounding noise.
fn short(value: f64) -> f64 {
    let shown = format!("{value:.11e}");
    shown.parse().unwrap_or(value)
}

fn joined(parts: &[String]) -> String {
    match parts {
        [] => "0".to_owned(),
        _ => parts.join(" + "),
    }
}
