//! Reads mass properties from their own keys, or from density and box.

use super::read::Values;
use crate::scene::check::Check;
use crate::scene::number::{apart, show};
use crate::scene::{Crank, InertiaAbout, Rod, RodModel, Slider};

const BOX: [&str; 4] = ["density", "length", "width", "depth"];

/// Mass of a body, and the inertia of its box.
struct Solid {
    /// Mass, kg; 0 if none is given.
    mass: f64,
    /// Moment of inertia of the box about its centre, kg m².
    box_inertia: Option<f64>,
    /// Whether a key of the box is given, readable or not.
    boxed: bool,
}

fn solid(check: &mut Check, values: &Values) -> Solid {
    let stated = values.number("mass");
    let mut solid = Solid {
        mass: stated.unwrap_or(0.0),
        box_inertia: None,
        boxed: BOX.iter().any(|key| check.is_present(values, key)),
    };
    if !solid.boxed {
        return solid;
    }
    for key in BOX {
        check.missing(values, key, || {
            let what = format!("`{key}` is missing for the mass from density and box");
            [what, "give density, length, width and depth".to_owned()]
        });
        if let Some(value) = values.number(key).filter(|value| *value <= 0.0) {
            let what = format!("`{key}` is {}, which is not positive", show(value));
            check.add(values.field(key), what, "give the size of a real body");
        }
    }
    let sizes = BOX.map(|key| values.number(key).filter(|value| *value > 0.0));
    if let [Some(density), Some(length), Some(width), Some(depth)] = sizes {
        let from_box = density * length * width * depth;
        agree(check, values, "mass", from_box, "kg");
        solid.mass = stated.unwrap_or(from_box);
        solid.box_inertia = Some(solid.mass * (length * length + width * width) / 12.0);
    }
    solid
}

/// Checks that a value stated beside a box is that of the box, to one percent.
fn agree(check: &mut Check, values: &Values, key: &str, from_box: f64, unit: &str) {
    if let Some(stated) = values.number(key)
        && (stated - from_box).abs() > 0.01 * from_box.abs()
    {
        let (stated, from_box) = apart(stated, from_box);
        let what =
            format!("`{key}` is {stated} {unit}, but density and box give {from_box} {unit}");
        let help = format!("leave out `{key}`, or leave out density and box");
        check.add(values.field(key), what, help);
    }
}

impl Solid {
    /// Requires a mass if one of these keys is not zero; always, without keys.
    fn needs_mass(&self, check: &mut Check, values: &Values, keys: &[&str], why: &str) {
        let is_given = |key: &&str| values.number(key).is_some_and(|value| value != 0.0);
        if !self.boxed && (keys.is_empty() || keys.iter().any(is_given)) {
            check.missing(values, "mass", || {
                let help = "add mass = \"0.5 kg\", or density, length, width and depth";
                [format!("`mass` is missing{why}"), help.to_owned()]
            });
        }
    }

    /// Requires a key of a body that has a mass and no box.
    fn needs(&self, check: &mut Check, values: &Values, body: &str, key: &str, help: &str) {
        if self.mass != 0.0 && !self.boxed {
            check.missing(values, key, || {
                let mass = show(self.mass);
                let what = format!("the {body} has a mass of {mass} kg but no `{key}`");
                [what, help.to_owned()]
            });
        }
    }

    /// Returns the stated inertia, or that of the box about a point at the squared distance `squared` (m²) from it.
    fn inertia(&self, check: &mut Check, values: &Values, squared: f64) -> f64 {
        let central = self.box_inertia;
        let from_box = central.map(|central| central + self.mass * squared);
        if let Some(from_box) = from_box {
            agree(check, values, "inertia", from_box, "kg m2");
        }
        values.number("inertia").or(from_box).unwrap_or(0.0)
    }
}

pub(super) fn slider(check: &mut Check, values: &Values) -> Slider {
    let body = solid(check, values);
    body.needs_mass(check, values, &[], "");
    Slider { mass: body.mass }
}

pub(super) fn crank(check: &mut Check, values: &Values) -> Crank {
    let body = solid(check, values);
    let cg = values.number("cg").unwrap_or(0.0);
    let cg_lateral = values.number("cg_lateral").unwrap_or(0.0);
    let why = ": the crank has a centre of gravity away from O";
    body.needs_mass(check, values, &["cg", "cg_lateral"], why);
    let inertia = body.inertia(check, values, cg * cg + cg_lateral * cg_lateral);
    let help = "add inertia = \"... kg mm^2\" about O, or density, length, width and depth";
    body.needs(check, values, "body", "inertia", help);
    Crank {
        mass: body.mass,
        cg,
        cg_lateral,
        inertia,
    }
}

pub(super) fn rod(check: &mut Check, values: &Values, length: f64) -> Rod {
    let model = values.choice("model", RodModel::named).unwrap_or_default();
    let body = solid(check, values);
    if model != RodModel::Massless {
        let why = ": the rod has a centre of gravity or a moment of inertia";
        body.needs_mass(check, values, &["cg", "cg_lateral", "inertia"], why);
        let help = "add cg = \"... mm\", measured from the crank pin along the rod";
        body.needs(check, values, "rod", "cg", help);
    }
    let middle = if body.boxed { length / 2.0 } else { 0.0 };
    let cg = values.number("cg").unwrap_or(middle);
    let cg_lateral = values.number("cg_lateral").unwrap_or(0.0);
    let about = values.choice("inertia_about", InertiaAbout::named);
    let inertia_about = about.unwrap_or_default();
    let squared = match inertia_about {
        InertiaAbout::CrankPin => cg * cg + cg_lateral * cg_lateral,
        InertiaAbout::Cg => 0.0,
    };
    let inertia = body.inertia(check, values, squared);
    if matches!(model, RodModel::Rigid | RodModel::SpinOnly) {
        let help = "add inertia = \"... kg mm^2\" (see inertia_about), or density, length, width and depth";
        body.needs(check, values, "body", "inertia", help);
    }
    Rod {
        model,
        mass: body.mass,
        cg,
        cg_lateral,
        inertia,
        inertia_about,
    }
}
