//! Ng: static forces with friction, equations (1)-(11), (A1)-(A3), tables 1 and 2. This module computes the values
//! without formula: the equilibrium, and the calibration line of table 1.

use super::formulas::{PaperFormulas, files};
use super::paper::Paper;
use super::quantities::{self, MechanismQuantities};
use crate::error::Error;
use crate::mechanism::friction_from_tilt;
use crate::numeric::line_fit::LineFit;
use crate::scene::{Load, Scene};
use crate::statics::{StaticsOptions, statics};

pub(super) fn formulas() -> Result<PaperFormulas, Error> {
    let symbols = PaperFormulas::new(Paper::Ng, files!("ng"))?;
    let [k, c, torque] = symbols.numbers(["k", "c", "torque"])?;
    let friction = friction_from_tilt(std::f64::consts::FRAC_PI_4);
    let held = |torque: f64| -> Result<MechanismQuantities, Error> {
        let scene = Scene::new(k, c).torque(Load::Constant(torque));
        let options = StaticsOptions {
            friction: Some(friction),
            ..StaticsOptions::default()
        };
        let statics = statics(&scene, &options)?;
        let mut held = MechanismQuantities::new(scene);
        held.statics = Some(statics);
        Ok(held)
    };
    let mechanisms = vec![
        ("described", held(torque)?),
        ("doubled", held(2.0 * torque)?),
    ];
    let calibration = symbols.column("table 1", "strain")?;
    let line = LineFit::new(&calibration);
    let about_zero = LineFit::r_squared_about_zero(&calibration);
    let of_tables = move |name: &str, _: f64| match name {
        "friction" => Some(friction),
        "r_squared" => line.and_then(|line| line.r_squared),
        "r_squared_about_zero" => about_zero,
        "strain_at_zero" => line.map(|line| line.intercept),
        "strain_per_newton" => line.map(|line| line.slope),
        _ => None,
    };
    Ok(symbols.with(quantities::of(mechanisms, of_tables)))
}
