//! Finds the columns of a data file that hold time, motion and the quantities beside it, and their units.

use std::f64::consts::TAU;
use std::ops::Range;

use super::{Beside, Measured, Reading};
use crate::scene::Problem;
use crate::scene::csv::Column;
use crate::scene::csv::header::{self, Header};
use crate::scene::unit::{self, Quantity};

/// Header names of the time, in lower case.
const TIME: [&str; 6] = ["t", "time", "zeit", "temps", "tiempo", "elapsed time"];

/// Header names of measured quantities, beside [`Measured::name`].
const WORDS: [(&str, Measured); 14] = [
    ("crank angle", Measured::Theta),
    ("crankangle", Measured::Theta),
    ("angle", Measured::Theta),
    ("kurbelwinkel", Measured::Theta),
    ("winkel", Measured::Theta),
    ("crank pin angle", Measured::Gamma),
    ("slider position", Measured::X),
    ("position", Measured::X),
    ("crank speed", Measured::Omega),
    ("speed", Measured::Omega),
    ("rotational speed", Measured::Omega),
    ("angular speed", Measured::Omega),
    ("angular velocity", Measured::Omega),
    ("drehzahl", Measured::Omega),
];

/// Units, and names without a unit, of a column of encoder counts.
const COUNTS: [&str; 5] = ["count", "counts", "pulses", "ticks", "increments"];

/// Largest number of columns read from a file; the cells of a row are kept in arrays of this size.
pub(super) const MOST_COLUMNS: usize = 8;

const HELP: &str = "the header names the columns with their units, as `t [s],theta [deg]`, the motion theta, gamma, x or omega; or say which they are, by name or number: --time \"1[s]\" --motion \"2[deg]\"; lines above the header: --skip 3";

/// Whether a word marks a column of encoder counts.
pub(super) fn is_count(word: &str) -> bool {
    COUNTS.contains(&word.to_lowercase().as_str())
}

/// Column as it stands in a file.
#[derive(Clone, Debug)]
pub(super) struct Named {
    /// Position, from 0.
    pub at: usize,
    /// Header as written, or the number of the column.
    pub raw: String,
    /// Name in lower case and unit as written; empty if there is none.
    pub header: Header,
    /// Byte range of its header in the file.
    pub span: Option<Range<usize>>,
}

impl Named {
    /// Whether the column holds encoder counts.
    fn is_count(&self) -> bool {
        let Header { name, unit } = &self.header;
        is_count(if unit.is_empty() { name } else { unit })
    }

    /// Returns the quantity that the name of the column states.
    fn named(&self) -> Option<Measured> {
        let names = Measured::ALL.map(|measured| (measured.name(), measured));
        let mut words = names.iter().chain(&WORDS);
        let found = words.find(|(word, _)| *word == self.header.name);
        let is_angle = || unit::factor(&self.header.unit, Quantity::Angle).is_ok();
        match found {
            // An encoder shows a position, too.
            Some(("position", _)) if is_angle() || self.is_count() => Some(Measured::Theta),
            Some((_, measured)) => Some(*measured),
            None => self.is_count().then_some(Measured::Theta),
        }
    }

    /// Returns the quantity that the unit of the column suggests; an angle, which may be theta or gamma, is theta.
    fn by_unit(&self, reading: &Reading) -> Option<Measured> {
        let has = |quantity| unit::factor(&self.header.unit, quantity).is_ok();
        if has(Quantity::Angle) || self.header.unit.is_empty() && reading.counts_per_turn.is_some()
        {
            Some(Measured::Theta)
        } else if has(Quantity::AngularSpeed) {
            Some(Measured::Omega)
        } else {
            has(Quantity::Length).then_some(Measured::X)
        }
    }

    fn wrong(&self, what: String, help: impl Into<String>) -> Problem {
        Problem::new("header", what, help).at(self.span.clone())
    }

    /// Returns the unit of the column, which must be one of `quantity`.
    fn column(&self, quantity: Quantity, option: &str) -> Result<Column, Problem> {
        let mut header = self.header.clone();
        if header.name.is_empty() {
            header.name.clone_from(&self.raw);
        }
        header.into_column(quantity).map_err(|what| {
            let unit = quantity.usual_unit();
            let help = format!("{HELP}; or here: {option} \"{}[{unit}]\"", self.at + 1);
            self.wrong(what, help)
        })
    }
}

/// Finds the column that option `COL[unit]` names by header or number, with that unit; without a name, by `is_it`.
fn choose(
    list: &[Named],
    option: &str,
    given: Option<&str>,
    is_it: impl Fn(&Named) -> bool,
) -> Result<Option<Named>, Problem> {
    let (name, unit) = given.map_or(("", ""), |text| text.split_once('[').unwrap_or((text, "")));
    let name = name.trim();
    let is_it = |column: &&Named| match (name, name.parse::<usize>()) {
        ("", _) => is_it(column),
        (_, Ok(number)) => column.at + 1 == number,
        _ => column.raw.eq_ignore_ascii_case(name) || column.header.name == name.to_lowercase(),
    };
    let found: Vec<&Named> = list.iter().filter(is_it).collect();
    match found[..] {
        [] if name.is_empty() => Ok(None),
        [] => {
            let names: Vec<&str> = list.iter().map(|column| column.raw.as_str()).collect();
            let names = names.join("`, `");
            let what = format!("{option}: no column is called `{name}`; there are `{names}`");
            Err(Problem::new("header", what, HELP))
        }
        [one] => {
            let mut column = one.clone();
            if !unit.is_empty() {
                header::bare(unit).clone_into(&mut column.header.unit);
            }
            Ok(Some(column))
        }
        [first, second, ..] => {
            let what = format!("there are two columns `{}` and `{}`", first.raw, second.raw);
            let help = format!("say which one it is: {option} \"{}\"", first.at + 1);
            Err(second.wrong(what, help))
        }
    }
}

/// Columns of time and motion of a data file, and those beside them.
#[derive(Clone, Debug)]
pub(super) struct Columns {
    pub measured: Measured,
    /// Positions of the time and the other columns, from 0.
    pub at: Vec<usize>,
    pub time: Column,
    /// Motion, then the columns beside it.
    pub others: Vec<(Beside, Column)>,
    /// Notes for the user.
    pub notes: Vec<String>,
}

impl Columns {
    /// Finds time and motion among the columns of a file.
    pub fn find(list: &[Named], reading: &Reading) -> Result<Columns, Problem> {
        let none = |what: String| {
            let one = match list {
                [one] => format!(
                    "; the header has one column, `{}`; columns are separated by comma, semicolon or tab",
                    one.raw
                ),
                _ => String::new(),
            };
            Problem::new("header", what + &one, HELP)
        };
        let is_time = |column: &Named| TIME.contains(&column.header.name.as_str());
        let time = choose(list, "--time", reading.time.as_deref(), is_time)?;
        let time = time
            .ok_or_else(|| none("no column holds the time: none is called t or time".to_owned()))?;
        let mut found = Vec::new();
        for measured in Measured::ALL {
            // A speed serves where nothing shows the position.
            let is_wanted = match reading.column {
                None => measured != Measured::Omega || found.is_empty(),
                Some(wanted) => wanted == measured,
            };
            if is_wanted && (reading.motion.is_none() || found.is_empty()) {
                let is_it = |column: &Named| column.named() == Some(measured);
                found.extend(choose(list, "--motion", reading.motion.as_deref(), is_it)?);
            }
        }
        let Some(column) = found.first() else {
            let wanted = reading.column.map(|wanted| format!("`{}`", wanted.name()));
            let wanted = wanted.unwrap_or("theta, gamma, x or omega".to_owned());
            return Err(none(format!("no column is called {wanted}")));
        };
        let mut at = vec![time.at];
        at.extend(found.iter().map(|sensor| sensor.at));
        let sensors = found.iter().map(|sensor| motion(sensor, reading));
        let sensors: Vec<(Measured, Column)> = sensors.collect::<Result<_, _>>()?;
        let measured = sensors[0].0;
        if reading.x_zero != 0.0 && !sensors.iter().any(|sensor| sensor.0 == Measured::X) {
            let what = format!("--x-zero belongs to x, and the motion is {measured}");
            return Err(column.wrong(what, "leave it out"));
        }
        let beside = |(measured, unit)| (Beside::Sensor(measured), unit);
        let mut others: Vec<(Beside, Column)> = sensors.into_iter().map(beside).collect();
        for option in &reading.known {
            let Some(known) = choose(list, "--known", Some(option), |_| false)? else {
                return Err(none("--known names no column".to_owned()));
            };
            let is_torque = unit::factor(&known.header.unit, Quantity::Torque).is_ok();
            let (kind, quantity) = match is_torque {
                true => (Beside::Torque, Quantity::Torque),
                false => (Beside::Force, Quantity::Force),
            };
            at.push(known.at);
            others.push((kind, known.column(quantity, "--known")?));
        }
        if at.len() > MOST_COLUMNS {
            let what = format!("{} columns are to be read", at.len());
            return Err(none(format!("{what}, and {MOST_COLUMNS} are the most")));
        }
        let mut notes = Vec::new();
        let name = &column.header.name;
        if found.len() > 1 {
            let names = found[1..].iter().map(|other| other.header.name.as_str());
            let names = names.collect::<Vec<_>>().join(" and ");
            notes.push(format!(
                "the motion is taken from the column {name}, and {names} beside it by a noise of its own (--column takes one alone)"
            ));
        }
        if name != measured.name() {
            let meaning = measured.meaning();
            notes.push(format!("the column `{}` is taken as {meaning}", column.raw));
        }
        Ok(Columns {
            measured,
            at,
            time: time.column(Quantity::Time, "--time")?,
            others,
            notes,
        })
    }
}

/// Returns the quantity that a column measures, and its unit.
fn motion(column: &Named, reading: &Reading) -> Result<(Measured, Column), Problem> {
    let (raw, unit) = (&column.raw, &column.header.unit);
    let measured = reading.column.or_else(|| column.named());
    let Some(measured) = measured.or_else(|| column.by_unit(reading)) else {
        return Err(column.wrong(format!("nothing says what `{raw}` is"), HELP));
    };
    let counts = reading.counts_per_turn;
    let is_count = column.is_count() || unit.is_empty() && counts.is_some();
    match (is_count && measured == Measured::Theta, counts) {
        (true, Some(counts)) => {
            let factor = TAU / f64::from(counts);
            let unit = "counts".to_owned();
            Ok((measured, Column { factor, unit }))
        }
        (true, None) => Err(column.wrong(
            format!("`{raw}` are counts of an encoder"),
            "say how many there are in a turn: --counts-per-turn 1024",
        )),
        (false, Some(_)) if measured == Measured::Theta => Err(column.wrong(
            format!("--counts-per-turn belongs to counts, and the unit of `{raw}` is `{unit}`"),
            "leave it out, or give the column of the counts: --motion \"2[counts]\"",
        )),
        (false, _) => Ok((measured, column.column(measured.quantity(), "--motion")?)),
    }
}
