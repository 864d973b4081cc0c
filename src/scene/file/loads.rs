//! Reads torques and forces.

use std::f64::consts::PI;
use std::path::Path;

use super::read::Values;
use crate::scene::check::Check;
use crate::scene::number::with_unit;
use crate::scene::unit::{self, Quantity};
use crate::scene::{Every, Expression, Interpolation, Load, Table, Variable};

/// Reads the load of one `[[torque]]` or `[[force]]`; none if it has a problem.
pub(super) fn load(check: &mut Check, values: &Values) -> Option<Load> {
    let quantity = match values.section.name {
        "torque" => Quantity::Torque,
        _ => Quantity::Force,
    };
    let kind = values.text("kind")?;
    check_keys(check, values, kind)?;
    match kind {
        "constant" => constant(check, values, quantity),
        "viscous" => values.number("coefficient").map(Load::Viscous),
        "motor" => Some(Load::Motor {
            stall: values.number("stall")?,
            no_load_speed: values.number("no_load_speed")?,
        }),
        "spring" => Some(Load::Spring {
            stiffness: values.number("stiffness")?,
            rest: values.number("rest")?,
        }),
        "expression" => expression(check, values),
        "dry" => Some(Load::Dry(Box::new(magnitude(check, values, quantity)?))),
        "table" => {
            let of = values.choice("of", Variable::named)?;
            table(check, values, of, quantity).map(Load::Table)
        }
        _ => gas(check, values),
    }
}

/// Reports the keys that the kind needs and the table lacks, and keys of other kinds; none if a needed key is missing.
pub(super) fn check_keys(check: &mut Check, values: &Values, kind: &str) -> Option<()> {
    let section = values.section;
    let kind = section.kinds().iter().find(|one| one.name == kind)?;
    for name in values.names().filter(|name| *name != "kind") {
        if !kind.keys.contains(&name) {
            let what = format!("`{name}` does not belong to kind \"{}\"", kind.name);
            let help = format!("kind \"{}\" has {}", kind.name, kind.keys.join(", "));
            check.add(values.field(name), what, help);
        }
    }
    let required = &kind.keys[..kind.required];
    for key in required.iter().filter_map(|name| section.key(name)) {
        check.missing(values, key.name, || {
            let what = format!("`{}` is missing for kind \"{}\"", key.name, kind.name);
            [what, format!("add {}", key.example())]
        });
    }
    required.iter().all(|name| values.has(name)).then_some(())
}

fn constant(check: &mut Check, values: &Values, quantity: Quantity) -> Option<Load> {
    let text = values.text("value").or(values.bare("value"))?;
    let number = unit::uncertain(text, quantity);
    let number = number.map_err(|error| check.add(values.field("value"), error.what, error.help));
    Some(Load::Constant(number.ok()?.value))
}

/// Reads the magnitude of a dry load: a value or a table.
fn magnitude(check: &mut Check, values: &Values, quantity: Quantity) -> Option<Load> {
    match (values.has("value"), values.has("file")) {
        (false, true) => {
            check.missing(values, "of", || {
                let what = "`of` is missing: what the magnitude is a table of";
                [what.to_owned(), "add of = \"theta\"".to_owned()]
            });
            let of = values.choice("of", Variable::named)?;
            table(check, values, of, quantity).map(Load::Table)
        }
        (true, false) => {
            let of_table = |name: &&str| !["kind", "value"].contains(name);
            for name in values.names().filter(of_table) {
                let what = format!("`{name}` belongs to a table, and the magnitude is `value`");
                let help = "leave it out, or give `file` in place of `value`";
                check.add(values.field(name), what, help);
            }
            constant(check, values, quantity)
        }
        (both, _) => {
            let fields = ["value", "file"].map(|key| values.field(key));
            if both || check.has_no_problem(&fields) {
                let what = match both {
                    true => "kind \"dry\" has both `value` and `file`",
                    false => "`value` is missing for kind \"dry\"",
                };
                let unit = quantity.si();
                let help = format!(
                    "give its magnitude as value = \"0.5 {unit}\", or as a table with file and of"
                );
                check.add(&fields[0], what, help);
            }
            None
        }
    }
}

fn expression(check: &mut Check, values: &Values) -> Option<Load> {
    let field = values.field("value");
    if let Some(digits) = values.bare("value") {
        let what = format!("`{digits}` is a number where the text of a formula is expected");
        let help = format!("write the formula in quotes, as value = \"{digits}\"");
        check.add(&field, what, help);
        return None;
    }
    let text = values.text("value")?;
    let wrong = match Expression::parse(text) {
        Ok(expression) => return Some(Load::Expression(expression)),
        Err(wrong) => wrong,
    };
    let what = format!("in the formula: {}", wrong.what);
    check.add_in_text(&field, text, wrong.at, what, wrong.help);
    None
}

/// Reads a gas force, directed as on the right branch; the scene, whose branch may change, directs it.
fn gas(check: &mut Check, values: &Values) -> Option<Load> {
    let pressure = table(check, values, Variable::Theta, Quantity::Pressure);
    let bore = values.number("bore")?;
    if bore <= 0.0 {
        check.positive(values.field("bore"), bore, "m");
        return None;
    }
    Some(Load::Gas {
        pressure: pressure?,
        ambient: values.number("ambient").unwrap_or(101_325.0),
        area: PI * bore * bore / 4.0,
        towards_crank: -1.0,
    })
}

fn table(check: &mut Check, values: &Values, of: Variable, quantity: Quantity) -> Option<Table> {
    let interpolation = values.choice("interpolation", Interpolation::named);
    let interpolation = interpolation.unwrap_or_default();
    let period = match values.every("period") {
        Some(every) => Some(period(check, &values.field("period"), every, of)?),
        None => None,
    };
    let scene = check.places.0.as_ref().map(|source| source.file.as_path());
    let folder = scene.and_then(Path::parent).unwrap_or(Path::new(""));
    let file = folder.join(values.text("file")?);
    let table = Table::read(&file, of, quantity, interpolation, period);
    let table =
        table.map_err(|error| check.add(values.field(&error.field), error.what, error.help));
    table.ok()
}

/// Returns the period in the SI unit of the table's variable, if it fits the variable.
fn period(check: &mut Check, field: &str, every: Every, of: Variable) -> Option<f64> {
    let (value, shown) = match every {
        Every::Time(time) => (time, with_unit(time, "s")),
        Every::Angle(angle) => (angle, with_unit(angle.to_degrees(), "deg")),
    };
    if value <= 0.0 {
        let what = format!("the period is {shown}, which is not positive");
        let help = "give the period after which the table repeats, or leave it out";
        check.add(field, what, help);
        return None;
    }
    match (every, of) {
        (Every::Angle(_), Variable::Theta) | (Every::Time(_), Variable::T) => Some(value),
        _ => {
            let what = format!("this period does not fit a table over {}", of.name());
            let help = "a table over theta repeats after an angle, one over t after a time";
            check.add(field, what, help);
            None
        }
    }
}
