//! Mass properties, from their own keys or from density and box.

use crate::scene::number::{apart, show};
use crate::scene::read::{Reader, Values};
use crate::scene::{Crank, InertiaAbout, Rod, RodModel, Slider};

const BOX: [&str; 4] = ["density", "length", "width", "depth"];

/// What mass and box say of a body.
struct Solid {
    /// kg
    mass: Option<f64>,
    /// Moment of inertia of the box about its centre, kg m².
    box_inertia: Option<f64>,
    /// Whether a part of the box is given, be it right or wrong.
    boxed: bool,
}

fn solid(reader: &mut Reader, values: &Values) -> Solid {
    let stated = values.number("mass");
    let boxed = BOX.iter().any(|key| reader.met(values, key));
    let mut solid = Solid {
        mass: stated,
        box_inertia: None,
        boxed,
    };
    if !boxed {
        return solid;
    }
    for key in BOX {
        let what = format!("`{key}` is missing for the mass from density and box");
        let help = "give density, length, width and depth";
        reader.missing(values, key, what, help);
        if let Some(value) = values.number(key).filter(|value| *value <= 0.0) {
            let what = format!("`{key}` is {}, which is not positive", show(value));
            reader.problem(&values.field(key), what, "give the size of a real body");
        }
    }
    let sizes = BOX.map(|key| values.number(key).filter(|value| *value > 0.0));
    if let [Some(density), Some(length), Some(width), Some(depth)] = sizes {
        let mass = density * length * width * depth;
        agree(reader, values, "mass", mass, "kg");
        let mass = stated.unwrap_or(mass);
        solid.mass = Some(mass);
        solid.box_inertia = Some(mass * (length * length + width * width) / 12.0);
    }
    solid
}

/// What is stated beside a box must be what the box gives, to one percent.
fn agree(reader: &mut Reader, values: &Values, key: &str, from_box: f64, unit: &str) {
    if let Some(stated) = values.number(key)
        && (stated - from_box).abs() > 0.01 * from_box.abs()
    {
        let (stated, from_box) = apart(stated, from_box);
        reader.problem(
            &values.field(key),
            format!("`{key}` is {stated} {unit}, but density and box give {from_box} {unit}"),
            format!("leave out `{key}`, or leave out density and box"),
        );
    }
}

impl Solid {
    fn needs_mass(&self, reader: &mut Reader, values: &Values, why: &str) {
        if self.mass.is_none() && !self.boxed {
            let what = format!("`mass` is missing{why}");
            let help = "add mass = \"0.5 kg\", or density, length, width and depth";
            reader.missing(values, "mass", what, help);
        }
    }

    /// The inertia that is stated or the one of the box; a body with mass has one.
    fn inertia(
        &self,
        reader: &mut Reader,
        values: &Values,
        from_box: Option<f64>,
        needed: bool,
        about: &str,
    ) -> f64 {
        if let Some(from_box) = from_box {
            agree(reader, values, "inertia", from_box, "kg m2");
        }
        let mass = self.mass.unwrap_or(0.0);
        if needed && mass != 0.0 && !self.boxed {
            reader.missing(
                values,
                "inertia",
                format!("the body has a mass of {} kg but no `inertia`", show(mass)),
                format!(
                    "add inertia = \"... kg mm^2\" {about}, or density, length, width and depth"
                ),
            );
        }
        values.number("inertia").or(from_box).unwrap_or(0.0)
    }
}

fn is_given(values: &Values, key: &str) -> bool {
    values.number(key).is_some_and(|value| value != 0.0)
}

pub(super) fn slider(reader: &mut Reader, values: &Values) -> Slider {
    let body = solid(reader, values);
    body.needs_mass(reader, values, "");
    Slider {
        mass: body.mass.unwrap_or(0.0),
    }
}

pub(super) fn crank(reader: &mut Reader, values: &Values) -> Crank {
    let body = solid(reader, values);
    let cg = values.number("cg").unwrap_or(0.0);
    let cg_lateral = values.number("cg_lateral").unwrap_or(0.0);
    if is_given(values, "cg") || is_given(values, "cg_lateral") {
        let why = ": the crank has a centre of gravity away from O";
        body.needs_mass(reader, values, why);
    }
    let mass = body.mass.unwrap_or(0.0);
    let from_box = body
        .box_inertia
        .map(|central| central + mass * (cg * cg + cg_lateral * cg_lateral));
    Crank {
        mass,
        cg,
        cg_lateral,
        inertia: body.inertia(reader, values, from_box, true, "about O"),
    }
}

pub(super) fn rod(reader: &mut Reader, values: &Values, length: f64) -> Rod {
    let model = match values.text("model") {
        Some("two-mass") => RodModel::TwoMass,
        Some("spin-only") => RodModel::SpinOnly,
        Some("massless") => RodModel::Massless,
        _ => RodModel::Rigid,
    };
    let about = match values.text("inertia_about") {
        Some("crank-pin") => InertiaAbout::CrankPin,
        _ => InertiaAbout::Cg,
    };
    let body = solid(reader, values);
    let mass = body.mass.unwrap_or(0.0);
    if model != RodModel::Massless {
        let keys = ["cg", "cg_lateral", "inertia"];
        if keys.into_iter().any(|key| is_given(values, key)) {
            let why = ": the rod has a centre of gravity or a moment of inertia";
            body.needs_mass(reader, values, why);
        }
        if mass != 0.0 && !body.boxed {
            reader.missing(
                values,
                "cg",
                format!("the rod has a mass of {} kg but no `cg`", show(mass)),
                "add cg = \"... mm\", measured from the crank pin along the rod",
            );
        }
    }
    let middle = if body.boxed { length / 2.0 } else { 0.0 };
    let cg = values.number("cg").unwrap_or(middle);
    let cg_lateral = values.number("cg_lateral").unwrap_or(0.0);
    let from_box = body.box_inertia.map(|central| match about {
        InertiaAbout::Cg => central,
        InertiaAbout::CrankPin => central + mass * (cg * cg + cg_lateral * cg_lateral),
    });
    let needed = matches!(model, RodModel::Rigid | RodModel::SpinOnly);
    Rod {
        model,
        mass,
        cg,
        cg_lateral,
        inertia: body.inertia(reader, values, from_box, needed, "(see inertia_about)"),
        inertia_about: about,
    }
}
