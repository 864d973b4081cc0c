//! Values that have been read, put together to a scene: defaults, boxes, loads.

use std::f64::consts::PI;
use std::path::Path;

use super::keys::{self, LoadKind, Section};
use super::load::{Load, Variable};
use super::read::{Reader, Values};
use super::table::{Interpolation, Table};
use super::unit::{self, Quantity};
use super::*;

type Tables = [(&'static Section, Values)];

/// The scene, unless its geometry is missing.
pub(super) fn scene(
    reader: &mut Reader,
    title: Option<String>,
    tables: &Tables,
    folder: &Path,
) -> Option<Scene> {
    let Some(geometry) = find(tables, "geometry") else {
        if !reader.problems.iter().any(|p| p.field == "geometry") {
            reader.problem(
                "geometry",
                "the scene has no [geometry]",
                "add [geometry] with crank = \"47 mm\" and rod = \"155.83 mm\"",
            );
        }
        return None;
    };
    let (length_r, length_l) = (geometry.number("crank"), geometry.number("rod"));
    let complete = length_r.is_some() && length_l.is_some();
    let mut scene = Scene::new(length_r.unwrap_or(1.0), length_l.unwrap_or(2.0));
    scene.title = title;
    scene.geometry.offset = geometry.number("offset").unwrap_or(0.0);
    if geometry.text("branch") == Some("left") {
        scene.geometry.branch = Branch::Left;
    }
    scene.crank = find(tables, "crank").map(|values| crank(reader, values));
    scene.rod = find(tables, "rod").map(|values| rod(reader, values, scene.geometry.rod));
    scene.slider = find(tables, "slider").map(|values| {
        let body = solid(reader, values, false);
        Slider { mass: body.mass }
    });
    scene.gravity = find(tables, "gravity").and_then(|values| {
        Some(Gravity {
            acceleration: values.number("acceleration")?,
            direction: values.number("direction").unwrap_or(-PI / 2.0),
        })
    });
    for (section, values) in tables {
        match section.name {
            "torque" => scene.torques.extend(load(
                reader,
                values,
                keys::TORQUES,
                Quantity::Torque,
                &scene.geometry,
                folder,
            )),
            "force" => scene.forces.extend(load(
                reader,
                values,
                keys::FORCES,
                Quantity::Force,
                &scene.geometry,
                folder,
            )),
            _ => {}
        }
    }
    scene.friction = find(tables, "friction").and_then(|values| {
        let coefficient = values.number("coefficient")?;
        Some(Friction {
            coefficient,
            static_coefficient: values.number("static_coefficient").unwrap_or(coefficient),
        })
    });
    scene.clearance = find(tables, "clearance").and_then(clearance);
    if let Some(values) = find(tables, "motion") {
        scene.motion = motion(values);
    }
    if let Some(values) = find(tables, "run") {
        scene.run = run(reader, values);
    }
    complete.then_some(scene)
}

fn find<'a>(tables: &'a Tables, name: &str) -> Option<&'a Values> {
    tables
        .iter()
        .find(|(section, _)| section.name == name)
        .map(|(_, values)| values)
}

/// Mass and moment of inertia about the centre, from the keys or from density and box.
struct Solid {
    mass: f64,
    box_inertia: Option<f64>,
}

fn solid(reader: &mut Reader, values: &Values, inertia_needed: bool) -> Solid {
    let keys = ["density", "length", "width", "depth"];
    let given = keys.map(|key| values.number(key));
    let stated = values.number("mass");
    let any_box = keys
        .iter()
        .any(|key| values.has(key) || reader.failed(&values.field(key)));
    let [Some(density), Some(length), Some(width), Some(depth)] = given else {
        if any_box {
            for key in keys {
                if !values.has(key) && !reader.failed(&values.field(key)) {
                    let what = format!("`{key}` is missing for the mass from density and box");
                    reader.problem(
                        &values.field(key),
                        what,
                        "give density, length, width and depth",
                    );
                }
            }
        } else if stated.is_none() && !inertia_needed && !reader.failed(&values.field("mass")) {
            let help = "add mass = \"0.5 kg\", or density, length, width and depth";
            reader.problem(&values.field("mass"), "`mass` is missing", help);
        }
        return Solid {
            mass: stated.unwrap_or(0.0),
            box_inertia: None,
        };
    };
    for (key, value) in keys.into_iter().zip([density, length, width, depth]) {
        if value <= 0.0 {
            let what = format!("`{key}` is {value}, which is not positive");
            reader.problem(&values.field(key), what, "give the size of a real body");
        }
    }
    let mass = density * length * width * depth;
    agree(reader, values, "mass", stated, mass, "kg");
    let mass = stated.unwrap_or(mass);
    Solid {
        mass,
        box_inertia: Some(mass * (length * length + width * width) / 12.0),
    }
}

/// What is stated beside a box must be what the box gives, to one percent.
fn agree(
    reader: &mut Reader,
    values: &Values,
    key: &str,
    stated: Option<f64>,
    computed: f64,
    unit: &str,
) {
    if let Some(stated) = stated
        && (stated - computed).abs() > 0.01 * computed.abs()
    {
        reader.problem(
            &values.field(key),
            format!("`{key}` is {stated} {unit}, but density and box give {computed} {unit}"),
            format!("leave out `{key}`, or leave out density and box"),
        );
    }
}

fn crank(reader: &mut Reader, values: &Values) -> Crank {
    let body = solid(reader, values, true);
    let cg = values.number("cg").unwrap_or(0.0);
    let cg_lateral = values.number("cg_lateral").unwrap_or(0.0);
    let stated = values.number("inertia");
    let computed = body
        .box_inertia
        .map(|central| central + body.mass * (cg * cg + cg_lateral * cg_lateral));
    if let Some(computed) = computed {
        agree(reader, values, "inertia", stated, computed, "kg m2");
    }
    needs_inertia(reader, values, body.mass, stated.or(computed), "about O");
    Crank {
        mass: body.mass,
        cg,
        cg_lateral,
        inertia: stated.or(computed).unwrap_or(0.0),
    }
}

fn needs_inertia(
    reader: &mut Reader,
    values: &Values,
    mass: f64,
    inertia: Option<f64>,
    about: &str,
) {
    let field = values.field("inertia");
    if mass != 0.0 && inertia.is_none() && !reader.failed(&field) {
        reader.problem(
            &field,
            format!("the body has a mass of {mass} kg but no `inertia`"),
            format!("add inertia = \"... kg mm^2\" {about}, or density, length, width and depth"),
        );
    }
}

fn rod(reader: &mut Reader, values: &Values, length: f64) -> Rod {
    let model = match values.text("model") {
        Some("two-mass") => RodModel::TwoMass,
        Some("spin-only") => RodModel::SpinOnly,
        Some("massless") => RodModel::Massless,
        _ => RodModel::Rigid,
    };
    let body = solid(reader, values, true);
    let cg_lateral = values.number("cg_lateral").unwrap_or(0.0);
    let boxed = body.box_inertia.is_some();
    let cg = values.number("cg").or(boxed.then_some(length / 2.0));
    let about = match values.text("inertia_about") {
        Some("crank-pin") => InertiaAbout::CrankPin,
        _ => InertiaAbout::Cg,
    };
    let field = values.field("cg");
    let heavy = body.mass != 0.0 && model != RodModel::Massless;
    if heavy && cg.is_none() && !reader.failed(&field) {
        let what = format!("the rod has a mass of {} kg but no `cg`", body.mass);
        reader.problem(
            &field,
            what,
            "add cg = \"... mm\", measured from the crank pin along the rod",
        );
    }
    let cg = cg.unwrap_or(0.0);
    let stated = values.number("inertia");
    let computed = body.box_inertia.map(|central| match about {
        InertiaAbout::Cg => central,
        InertiaAbout::CrankPin => central + body.mass * (cg * cg + cg_lateral * cg_lateral),
    });
    if let Some(computed) = computed {
        agree(reader, values, "inertia", stated, computed, "kg m2");
    }
    if matches!(model, RodModel::Rigid | RodModel::SpinOnly) {
        needs_inertia(
            reader,
            values,
            body.mass,
            stated.or(computed),
            "(see inertia_about)",
        );
    }
    Rod {
        model,
        mass: body.mass,
        cg,
        cg_lateral,
        inertia: stated.or(computed).unwrap_or(0.0),
        inertia_about: about,
    }
}

fn load(
    reader: &mut Reader,
    values: &Values,
    kinds: &[LoadKind],
    quantity: Quantity,
    geometry: &Geometry,
    folder: &Path,
) -> Option<Load> {
    let kind = values.text("kind")?;
    let kind = kinds.iter().find(|k| k.name == kind)?;
    for name in values.names().filter(|name| *name != "kind") {
        if !kind.keys.contains(&name) {
            let what = format!("`{name}` does not belong to kind \"{}\"", kind.name);
            let help = format!("kind \"{}\" has {}", kind.name, kind.keys.join(", "));
            reader.problem(&values.field(name), what, help);
        }
    }
    let mut complete = true;
    for name in &kind.keys[..kind.required] {
        if !values.has(name) {
            complete = false;
            if !reader.failed(&values.field(name)) {
                let what = format!("`{name}` is missing for kind \"{}\"", kind.name);
                reader.problem(&values.field(name), what, format!("add {name} = ..."));
            }
        }
    }
    if !complete {
        return None;
    }
    match kind.name {
        "constant" => constant(reader, values, quantity),
        "viscous" => values.number("coefficient").map(Load::Viscous),
        "motor" => Some(Load::Motor {
            stall: values.number("stall")?,
            no_load_speed: values.number("no_load_speed")?,
        }),
        "spring" => Some(Load::Spring {
            stiffness: values.number("stiffness")?,
            rest: values.number("rest")?,
        }),
        "expression" => expression(reader, values),
        "table" => {
            let of = Variable::named(values.text("of")?)?;
            table(reader, values, of, quantity, folder).map(Load::Table)
        }
        _ => {
            let pressure = table(reader, values, Variable::Theta, Quantity::Pressure, folder)?;
            let bore = values.number("bore")?;
            Some(Load::Gas {
                pressure,
                ambient: values.number("ambient").unwrap_or(101_325.0),
                area: PI * bore * bore / 4.0,
                towards_crank: -geometry.branch.sign(),
            })
        }
    }
}

fn constant(reader: &mut Reader, values: &Values, quantity: Quantity) -> Option<Load> {
    if let Some(number) = values.number("value") {
        return Some(Load::Constant(number));
    }
    match unit::parse(values.text("value")?, quantity) {
        Ok(number) => Some(Load::Constant(number)),
        Err(error) => {
            reader.problem(&values.field("value"), error.what, error.help);
            None
        }
    }
}

fn expression(reader: &mut Reader, values: &Values) -> Option<Load> {
    let Some(text) = values.text("value") else {
        let help = "write the formula in quotes, as value = \"2 - 0.01*omega\"";
        reader.problem(&values.field("value"), "the formula is not a text", help);
        return None;
    };
    match Expression::parse(text) {
        Ok(expression) => Some(Load::Expression(expression)),
        Err(error) => {
            let what = format!("in the formula: {}", error.what);
            reader.problem_in_text(
                &values.field("value"),
                error.at,
                text.len(),
                what,
                error.help,
            );
            None
        }
    }
}

fn table(
    reader: &mut Reader,
    values: &Values,
    of: Variable,
    quantity: Quantity,
    folder: &Path,
) -> Option<Table> {
    let interpolation = match values.text("interpolation") {
        Some("linear") => Interpolation::Linear,
        _ => Interpolation::Pchip,
    };
    let period = match (values.every("period"), of) {
        (None, _) => None,
        (Some(Every::Angle(period)), Variable::Theta)
        | (Some(Every::Time(period)), Variable::T) => Some(period),
        (Some(_), _) => {
            let what = format!("this period does not fit a table over {}", of.name());
            let help = "a table over theta repeats after an angle, one over t after a time";
            reader.problem(&values.field("period"), what, help);
            return None;
        }
    };
    let file = folder.join(values.text("file")?);
    match Table::read(&file, of, quantity, interpolation, period) {
        Ok(table) => Some(table),
        Err(what) => {
            let help = format!(
                "the file has two columns with units in the header, as `{} [unit],value [unit]`, and rising rows",
                of.name()
            );
            reader.problem(&values.field("file"), what, help);
            None
        }
    }
}

fn clearance(values: &Values) -> Option<Clearance> {
    Some(Clearance {
        joint: match values.text("joint")? {
            "wrist-pin" => Joint::WristPin,
            _ => Joint::CrankPin,
        },
        radial: values.number("radial")?,
        bearing_radius: values.number("bearing_radius"),
        young_modulus: values.number("young_modulus"),
        poisson_ratio: values.number("poisson_ratio"),
        restitution: values.number("restitution"),
        friction: values.number("friction"),
    })
}

fn motion(values: &Values) -> Motion {
    Motion {
        kind: match values.text("kind") {
            Some("constant-speed") => MotionKind::ConstantSpeed,
            _ => MotionKind::Free,
        },
        angle: values.number("angle").unwrap_or(0.0),
        speed: values.number("speed").unwrap_or(0.0),
    }
}

fn run(reader: &mut Reader, values: &Values) -> Run {
    let duration = values.number("duration").map(Extent::Duration);
    let revolutions = values.number("revolutions").map(Extent::Revolutions);
    if duration.is_some() && revolutions.is_some() {
        reader.problem(
            &values.field("revolutions"),
            "the run has both `duration` and `revolutions`",
            "keep one of them",
        );
    }
    Run {
        extent: duration.or(revolutions),
        output_every: values.every("output_every"),
        tolerance: values
            .number("tolerance")
            .unwrap_or(Run::default().tolerance),
    }
}
