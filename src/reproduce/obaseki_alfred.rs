//! Obaseki and Alfred 2020: offset slider-crank at constant speed, equations (1)-(53), tables 1 to 3. This module
//! computes the values without formula: the mechanisms, and the lengths for a stroke.

use super::formulas::{PaperFormulas, files};
use super::paper::Paper;
use super::quantities::{self, MechanismQuantities};
use crate::error::Error;
use crate::mechanism::size_from_stroke;
use crate::scene::{Crank, Rod, RodModel, Scene, Slider};

/// Returns the engine of table 1 with another offset, m, uniform crank and rod, and the rod as two masses, (31)-(33).
fn engine(symbols: &PaperFormulas, offset: f64) -> Result<Scene, Error> {
    let names = ["k", "c", "m_crank", "m_rod", "m_slider", "w"];
    let [k, c, crank, rod, slider, speed] = symbols.numbers(names)?;
    Ok(Scene::new(k, c)
        .offset(offset)
        .crank(Crank {
            mass: crank,
            cg: 0.5 * k,
            cg_lateral: 0.0,
            inertia: crank * k * k / 3.0,
        })
        .rod(Rod {
            model: RodModel::TwoMass,
            mass: rod,
            cg: 0.5 * c,
            inertia: rod * c * c / 12.0,
            ..Rod::default()
        })
        .slider(Slider { mass: slider })
        .constant_speed(0.0, speed))
}

pub(super) fn formulas() -> Result<PaperFormulas, Error> {
    let symbols = PaperFormulas::new(Paper::ObasekiAlfred, files!("obaseki-alfred"))?;
    let [k2, c2] = symbols.numbers(["k2", "c2"])?;
    let two_mass = engine(&symbols, 0.02)?;
    let mut rigid = two_mass.clone();
    rigid.rod = rigid.rod.map(|rod| Rod {
        model: RodModel::Rigid,
        ..rod
    });
    let mechanisms = vec![
        ("engine", MechanismQuantities::new(two_mass)),
        ("rigid", MechanismQuantities::new(rigid)),
        ("e10", MechanismQuantities::new(engine(&symbols, 0.01)?)),
        ("e0", MechanismQuantities::new(engine(&symbols, 0.0)?)),
        ("tested", MechanismQuantities::new(Scene::new(k2, c2))),
    ];
    let (crank, rod) = size_from_stroke(0.08, 1.6, 0.0)?;
    let number = move |name: &str, _: f64| match name {
        "sized_crank" => Some(crank),
        "sized_rod" => Some(rod),
        _ => None,
    };
    Ok(symbols.with(quantities::of(mechanisms, number)))
}
