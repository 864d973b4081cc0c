//! Torques and forces.

use std::f64::consts::PI;
use std::path::Path;

use super::keys_fit;
use crate::scene::keys;
use crate::scene::number;
use crate::scene::read::{Reader, Values};
use crate::scene::unit::{self, Quantity};
use crate::scene::{Branch, Every, Expression, Interpolation, Load, Problem, Table, Variable};

/// The load of one `[[torque]]` or `[[force]]`, unless it has a problem.
pub(super) fn load(
    reader: &mut Reader,
    values: &Values,
    branch: Branch,
    folder: &Path,
) -> Option<Load> {
    let (kinds, quantity) = match values.section.name {
        "torque" => (keys::TORQUES, Quantity::Torque),
        _ => (keys::FORCES, Quantity::Force),
    };
    let name = values.text("kind")?;
    let kind = kinds.iter().find(|kind| kind.name == name)?;
    keys_fit(reader, values, kind)?;
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
        "dry" => dry(reader, values, quantity, folder),
        "table" => {
            let of = Variable::named(values.text("of")?)?;
            table(reader, values, of, quantity, folder).map(Load::Table)
        }
        _ => gas(reader, values, branch, folder),
    }
}

fn constant(reader: &mut Reader, values: &Values, quantity: Quantity) -> Option<Load> {
    let text = values.text("value").or(values.bare("value"))?;
    match unit::uncertain(text, quantity) {
        Ok(number) => Some(Load::Constant(number.value)),
        Err(error) => {
            reader.problem(&values.field("value"), error.what, error.help);
            None
        }
    }
}

/// A load that opposes motion: the magnitude is a value or a table.
fn dry(reader: &mut Reader, values: &Values, quantity: Quantity, folder: &Path) -> Option<Load> {
    let magnitude = match (values.has("value"), values.has("file")) {
        (true, false) => {
            let tables = values
                .names()
                .filter(|name| !["kind", "value"].contains(name));
            for name in tables.collect::<Vec<_>>() {
                let what = format!("`{name}` belongs to a table, and the magnitude is `value`");
                reader.problem(
                    &values.field(name),
                    what,
                    "leave it out, or give `file` in place of `value`",
                );
            }
            constant(reader, values, quantity)?
        }
        (false, true) => {
            if !values.has("of") {
                let what = "`of` is missing: what the magnitude is a table of";
                reader.missing(values, "of", what, "add of = \"theta\"");
            }
            let of = Variable::named(values.text("of")?)?;
            Load::Table(table(reader, values, of, quantity, folder)?)
        }
        (both, _) => {
            let what = match both {
                true => "kind \"dry\" has both `value` and `file`",
                false => "`value` is missing for kind \"dry\"",
            };
            let help = "give its magnitude as value = \"0.5 N m\", or as a table with file and of";
            let help = match quantity {
                Quantity::Torque => help.to_owned(),
                _ => help.replace("N m", "N"),
            };
            if both
                || !reader.doubtful(&values.field("value"))
                    && !reader.doubtful(&values.field("file"))
            {
                reader.problem(&values.field("value"), what, help);
            }
            return None;
        }
    };
    Some(Load::Dry(Box::new(magnitude)))
}

fn expression(reader: &mut Reader, values: &Values) -> Option<Load> {
    let field = values.field("value");
    if let Some(digits) = values.bare("value") {
        let what = format!("`{digits}` is a number where the text of a formula is expected");
        let help = format!("write the formula in quotes, as value = \"{digits}\"");
        reader.problem(&field, what, help);
        return None;
    }
    let text = values.text("value")?;
    match Expression::parse(text) {
        Ok(expression) => Some(Load::Expression(expression)),
        Err(error) => {
            let what = format!("in the formula: {}", error.what);
            reader.problem_in_text(&field, text, error.at, what, error.help);
            None
        }
    }
}

fn gas(reader: &mut Reader, values: &Values, branch: Branch, folder: &Path) -> Option<Load> {
    let pressure = table(reader, values, Variable::Theta, Quantity::Pressure, folder);
    let bore = values.number("bore")?;
    if bore <= 0.0 {
        let problem = Problem::not_positive(&values.field("bore"), bore, "m");
        reader.problems.push(problem);
        return None;
    }
    Some(Load::Gas {
        pressure: pressure?,
        ambient: values.number("ambient").unwrap_or(101_325.0),
        area: PI * bore * bore / 4.0,
        towards_crank: -branch.sign(),
    })
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
    let period = match values.every("period") {
        Some(every) => Some(period(reader, &values.field("period"), every, of)?),
        None => None,
    };
    let file = folder.join(values.text("file")?);
    Table::read(&file, of, quantity, interpolation, period)
        .map_err(|error| reader.problem(&values.field(&error.field), error.what, error.help))
        .ok()
}

/// The period in the unit of the table's variable.
fn period(reader: &mut Reader, field: &str, every: Every, of: Variable) -> Option<f64> {
    let (value, shown) = match every {
        Every::Time(time) => (time, number::with_unit(time, "s")),
        Every::Angle(angle) => (angle, number::with_unit(angle.to_degrees(), "deg")),
    };
    if value <= 0.0 {
        let what = format!("the period is {shown}, which is not positive");
        let help = "give the period after which the table repeats, or leave it out";
        reader.problem(field, what, help);
        return None;
    }
    match (every, of) {
        (Every::Angle(_), Variable::Theta) | (Every::Time(_), Variable::T) => Some(value),
        _ => {
            let what = format!("this period does not fit a table over {}", of.name());
            let help = "a table over theta repeats after an angle, one over t after a time";
            reader.problem(field, what, help);
            None
        }
    }
}
