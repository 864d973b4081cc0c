//! Obaseki and Alfred 2020: offset slider-crank at constant speed, equations (1)-(53), tables 1 to 3. This module
//! computes the values without formula: their grid of 1 ms, and the largest torque by the sentence above (48).

use std::f64::consts::TAU;

use super::formulas::{PaperFormulas, files};
use super::quantities::{self, MechanismQuantities};
use crate::error::Error;
use crate::mechanism::{Linkage, size_from_stroke};
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
    let symbols = PaperFormulas::new(files!("obaseki-alfred"))?;
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
    let (first, last) = sign_changes(&symbols)?;
    let (crank, rod) = size_from_stroke(0.08, 1.6, 0.0)?;
    let mut numbers = vec![
        ("first_ms".to_owned(), first),
        ("last_ms".to_owned(), last),
        ("sized_crank".to_owned(), crank),
        ("sized_rod".to_owned(), rod),
    ];
    for (name, offset) in [("e20", 0.02), ("e10", 0.01), ("e0", 0.0)] {
        let [inward, outward] = perpendicular(&symbols, offset)?;
        numbers.push((format!("assumed_inward_{name}"), inward));
        numbers.push((format!("assumed_outward_{name}"), outward));
    }
    let number = move |name: &str, _: f64| {
        let found = numbers.iter().find(|(known, _)| known == name);
        found.map(|(_, value)| *value)
    };
    Ok(symbols.with(quantities::of(mechanisms, number)))
}

/// Returns the last samples, ms, before the first two sign changes of the slider velocity (13), e = 0, 1 ms grid.
fn sign_changes(symbols: &PaperFormulas) -> Result<(f64, f64), Error> {
    let [speed] = symbols.numbers(["w"])?;
    let mut last = Vec::new();
    let mut before = f64::NAN;
    for ms in 1..=30 {
        let velocity = symbols.value("ds_e0", speed * f64::from(ms) * 1e-3)?;
        if before * velocity < 0.0 {
            last.push(f64::from(ms - 1));
        }
        before = velocity;
    }
    match last.as_slice() {
        [first, second, ..] => Ok((*first, *second)),
        _ => Err(Error::refused("(13) does not change its sign", "mend (13)")),
    }
}

/// Returns the largest k F_i sin theta (N m) of the inward and outward stroke by the sentence above (48), with exact
/// accelerations and the centre of gravity of the rod at a third of its length from the crank pin.
fn perpendicular(symbols: &PaperFormulas, offset: f64) -> Result<[f64; 2], Error> {
    let names = ["k", "w", "m_crank", "m_rod", "m_slider"];
    let [k, w, crank, rod, slider] = symbols.numbers(names)?;
    let (m2, m3) = (2.0 / 3.0 * rod + 0.5 * crank, rod / 3.0 + slider);
    let linkage = Linkage::new(&engine(symbols, offset)?.geometry);
    let mut found = [0.0f64; 2];
    // Far closer than the 2 % to which the figure is read.
    let points_of_turn = 36_000;
    for i in 0..points_of_turn {
        let theta = TAU * f64::from(i) / f64::from(points_of_turn);
        let pose = linkage.pose(theta);
        let inertia = -(m2 * w * w * k * theta.cos() + m3 * (pose.d2x * w * w));
        let stroke = &mut found[usize::from(pose.dx > 0.0)];
        *stroke = stroke.max((k * inertia * pose.sin).abs());
    }
    Ok(found)
}
