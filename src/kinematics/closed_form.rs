//! Kinematics of one turn in closed form: from a scene to dead centres, extremes, named positions and rows.

use serde::Serialize;

use crate::error::Error;
use crate::mechanism::{Class, Extremes, Limits, Linkage, Pose};
pub use crate::mechanism::{DeadCentre, Located, NamedPosition};
use crate::scene::Scene;

/// Kinematics of a scene, from its lengths and speed.
#[derive(Clone, Debug, Serialize)]
pub struct Kinematics {
    /// Title of the scene.
    pub scene: String,
    /// Class of the mechanism.
    pub class: &'static str,
    /// Distance between the extreme slider positions, m.
    pub stroke_m: f64,
    /// Dead centres, by angle.
    pub dead_centres: Vec<DeadCentre>,
    /// Crank angle of the outward stroke in the sense of rotation, rad; none if the crank cannot turn fully.
    pub advance_rad: Option<f64>,
    /// Crank angle of the inward stroke, rad; none if the crank cannot turn fully.
    pub return_rad: Option<f64>,
    /// Advance angle over return angle; none if the crank cannot turn fully.
    pub time_ratio: Option<f64>,
    /// Least transmission angle over a turn, rad; 0 if the crank cannot turn fully.
    pub transmission_min_rad: f64,
    /// Largest velocity at constant speed, m/s; m/rad without a speed.
    pub velocity_max: Option<Located>,
    /// Smallest velocity at constant speed, m/s; m/rad without a speed.
    pub velocity_min: Option<Located>,
    /// Largest acceleration at constant speed, m/s²; m/rad² without a speed.
    pub acceleration_max: Option<Located>,
    /// Smallest acceleration at constant speed, m/s²; m/rad² without a speed.
    pub acceleration_min: Option<Located>,
    /// Crank speed of the values, rad/s; none: the values are per radian.
    pub speed_rad_per_s: Option<f64>,
    /// Reachable crank angles, rad; empty: all.
    pub reach_rad: Vec<[f64; 2]>,
    /// Dead centres and other named positions, by angle.
    pub positions: Vec<NamedPosition>,
    /// Warnings about the result.
    pub warnings: Vec<String>,
    #[serde(skip)]
    pub(super) linkage: Linkage,
}

/// Position at one crank angle; values that do not exist there are not finite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KinematicsRow {
    /// Crank angle θ, rad.
    pub theta: f64,
    /// Position and its derivatives by the crank angle.
    pub pose: Pose,
    /// Velocity (m/s) and acceleration (m/s²) of the slider, angular speed (rad/s, counter-clockwise) and acceleration
    /// (rad/s²) of the rod, at the scene's speed; none without a speed.
    pub rates: Option<[f64; 4]>,
}

/// Computes the closed-form kinematics of a scene.
///
/// # Errors
/// [`Error::Scene`] for impossible values.
///
/// ```
/// use slider_crank::scene::Scene;
/// let result = slider_crank::kinematics::kinematics(&Scene::duarte()).unwrap();
/// assert!((result.stroke_m - 0.094).abs() < 1e-16);
/// assert_eq!(result.time_ratio, Some(1.0));
/// ```
pub fn kinematics(scene: &Scene) -> Result<Kinematics, Error> {
    scene.check()?;
    Ok(of_checked(scene))
}

/// Computes the closed-form kinematics of a scene whose values are possible.
pub(crate) fn of_checked(scene: &Scene) -> Kinematics {
    let linkage = Linkage::new(&scene.geometry);
    let speed = scene.motion.speed;
    let limits = Limits::new(&linkage, speed);
    let extremes = Extremes::new(&linkage);
    let rate = if speed == 0.0 { 1.0 } else { speed };
    let scaled = |extreme: Located, factor: f64| Located {
        value: extreme.value * factor,
        ..extreme
    };
    let velocities = extremes.map(|e| {
        let pair = [scaled(e.velocity_min, rate), scaled(e.velocity_max, rate)];
        if rate < 0.0 { [pair[1], pair[0]] } else { pair }
    });
    let acceleration = |extreme| scaled(extreme, rate * rate);
    Kinematics {
        scene: scene.title.clone().unwrap_or_default(),
        class: limits.class.name(),
        stroke_m: limits.stroke,
        advance_rad: limits.advance,
        return_rad: limits.retreat,
        time_ratio: limits.time_ratio(),
        dead_centres: limits.dead_centres,
        transmission_min_rad: limits.transmission_min,
        velocity_max: velocities.map(|v| v[1]),
        velocity_min: velocities.map(|v| v[0]),
        acceleration_max: extremes.map(|e| acceleration(e.acceleration_max)),
        acceleration_min: extremes.map(|e| acceleration(e.acceleration_min)),
        speed_rad_per_s: (speed != 0.0).then_some(speed),
        positions: linkage.named_positions(),
        reach_rad: limits.reach,
        warnings: warnings(limits.class),
        linkage,
    }
}

/// Returns the warnings about one turn of a mechanism of a class.
pub(crate) fn warnings(class: Class) -> Vec<String> {
    let change_point =
        "the lengths make a change point: the mechanism can leave it on either branch";
    let limits =
        "velocity and acceleration grow without bound towards the limit positions of the crank";
    let said: &[&str] = match class {
        Class::RotatingCrank => &[],
        Class::ChangePoint => &[change_point, limits],
        Class::RotatingRod | Class::DoubleRocker => &[limits],
    };
    said.iter().map(|what| (*what).to_owned()).collect()
}

impl KinematicsRow {
    /// Returns x, v and a of the slider, m, m/s and m/s²; without a speed x, x' and x''.
    pub fn motion(&self) -> [f64; 3] {
        let Pose { x, dx, d2x, .. } = self.pose;
        self.rates.map_or([x, dx, d2x], |[v, a, ..]| [x, v, a])
    }
}

impl Kinematics {
    /// Returns the row at a crank angle, rad.
    pub fn row(&self, theta: f64) -> KinematicsRow {
        let pose = self.linkage.pose(theta);
        let s = self.linkage.s;
        KinematicsRow {
            theta,
            pose,
            rates: self.speed_rad_per_s.map(|speed| {
                [
                    pose.dx * speed,
                    pose.d2x * speed * speed,
                    -s * pose.dphi * speed,
                    -s * pose.d2phi * speed * speed,
                ]
            }),
        }
    }
}
