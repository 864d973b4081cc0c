//! Which columns of a data file hold the time and the motion, and in which units.

use std::f64::consts::TAU;

use super::headers::{Named, TIME};
use super::{Measured, Reading};
use crate::scene::number::counted;
use crate::scene::table::header;
use crate::scene::table::rows::Column;
use crate::scene::unit::{self, Quantity};

/// The columns of a data file.
#[derive(Clone, Debug)]
pub(super) struct Columns {
    pub measured: Measured,
    /// Positions of time and value.
    pub at: [usize; 2],
    pub time: Column,
    pub value: Column,
    /// What is subtracted from a value in SI.
    pub zero: f64,
    /// Whether the times are dates or hours of the day.
    pub is_clock: bool,
    /// How many columns there are.
    pub count: usize,
    /// How many there are, for messages.
    pub counted: String,
    pub decimal_comma: bool,
    /// What the reader should know.
    pub notes: Vec<String>,
}

/// A problem with a column, or with the header as a whole.
#[derive(Debug)]
pub(super) struct ColumnProblem {
    pub column: Option<usize>,
    pub what: String,
    pub help: String,
}

pub(super) const HELP: &str = "the header names the columns with their units, as `t [s],theta [deg]`, the motion theta, gamma or x; or say which they are, by name or number: --time \"1[s]\" --motion \"2[deg]\"; lines above the header: --skip 3";

pub(super) fn wrong(column: Option<usize>, what: impl Into<String>) -> ColumnProblem {
    let help = HELP.to_owned();
    ColumnProblem {
        column,
        what: what.into(),
        help,
    }
}

/// The only column that an option `COL[unit]` names by header or number, with the unit of the option; without it the only
/// column of a kind, if there is one.
fn choose(
    list: &[Named],
    option: &str,
    given: Option<&str>,
    is_it: impl Fn(&Named) -> bool,
) -> Result<Option<(usize, Named)>, ColumnProblem> {
    let (name, unit) = given.map_or(("", ""), |text| text.split_once('[').unwrap_or((text, "")));
    let name = name.trim();
    let number = name.parse::<usize>().ok();
    let is_it = |at: &usize| match (name, number) {
        ("", _) => is_it(&list[*at]),
        (_, Some(number)) => *at + 1 == number,
        _ => list[*at].raw.eq_ignore_ascii_case(name) || list[*at].name == name.to_lowercase(),
    };
    let mut found = (0..list.len()).filter(is_it);
    let (first, second) = (found.next(), found.next());
    if let (Some(first), Some(second)) = (first, second) {
        let what = format!(
            "there are two columns `{}` and `{}`",
            list[first].raw, list[second].raw
        );
        let help = format!("say which one it is: {option} \"{}\"", first + 1);
        return Err(ColumnProblem {
            help,
            ..wrong(Some(second), what)
        });
    }
    let Some(at) = first else {
        let names: Vec<&str> = list.iter().map(|column| column.raw.as_str()).collect();
        let what = format!(
            "{option}: no column is called `{name}`; there are `{}`",
            names.join("`, `")
        );
        return if name.is_empty() {
            Ok(None)
        } else {
            Err(wrong(None, what))
        };
    };
    let mut column = list[at].clone();
    if !unit.is_empty() {
        header::bare(unit).clone_into(&mut column.unit);
    }
    Ok(Some((at, column)))
}

/// Finds time and motion among the columns of a file.
pub(super) fn columns(list: &[Named], reading: &Reading) -> Result<Columns, ColumnProblem> {
    let none = |what: &str| match list {
        [one] => format!(
            "{what}; the header has one column, `{}`; columns are separated by comma, semicolon or tab",
            one.raw
        ),
        _ => what.to_owned(),
    };
    let is_time = |column: &Named| TIME.contains(&column.name.as_str());
    let Some((t, time)) = choose(list, "--time", reading.time.as_deref(), is_time)? else {
        return Err(wrong(
            None,
            none("no column holds the time: none is called t or time"),
        ));
    };
    let mut found = Vec::new();
    for measured in Measured::ALL {
        let is_it = |column: &Named| column.measured() == Some(measured);
        let is_wanted = reading.column.is_none_or(|wanted| wanted == measured);
        if is_wanted && (reading.motion.is_none() || found.is_empty()) {
            found.extend(choose(list, "--motion", reading.motion.as_deref(), is_it)?);
        }
    }
    let Some((at, column)) = found.first() else {
        let what = reading
            .column
            .map_or("theta, gamma or x".to_owned(), |wanted| {
                format!("`{}`", wanted.name())
            });
        return Err(wrong(None, none(&format!("no column is called {what}"))));
    };
    let (measured, value) = motion(*at, column, reading)?;
    let mut notes = Vec::new();
    if found.len() > 1 {
        let others: Vec<&str> = found[1..]
            .iter()
            .map(|(_, other)| other.name.as_str())
            .collect();
        notes.push(format!(
            "the motion is taken from the column {}; {} is not used",
            column.name,
            others.join(" and ")
        ));
    }
    if column.name != measured.name() {
        notes.push(format!(
            "the column `{}` is taken as {}",
            column.raw,
            measured.meaning()
        ));
    }
    if time.is_clock {
        notes.push("the times are those of a clock: t counts from the first row".to_owned());
    }
    let seconds = Column {
        factor: 1.0,
        unit: "s".to_owned(),
    };
    let who = match &reading.columns {
        Some(_) => "--columns",
        None if list.iter().all(|column| column.name.is_empty()) => "the first row",
        None => "the header",
    };
    Ok(Columns {
        measured,
        at: [t, *at],
        is_clock: time.is_clock,
        time: if time.is_clock {
            seconds
        } else {
            time.column(t, Quantity::Time, "--time")?
        },
        value,
        zero: reading.x_zero,
        count: list.len(),
        counted: format!("{who} has {}", counted(list.len(), "column")),
        decimal_comma: reading.decimal_comma,
        notes,
    })
}

/// What a column measures, and its unit.
fn motion(
    at: usize,
    column: &Named,
    reading: &Reading,
) -> Result<(Measured, Column), ColumnProblem> {
    let raw = &column.raw;
    let is_count = column.is_count() || column.unit.is_empty() && reading.counts_per_turn.is_some();
    let measured = reading.column.or_else(|| column.measured());
    let measured = measured.or_else(|| {
        if is_count {
            Some(Measured::Theta)
        } else {
            column.measured_by_unit()
        }
    });
    let fault = |what: String, help: &str| {
        Err(ColumnProblem {
            help: help.to_owned(),
            ..wrong(Some(at), what)
        })
    };
    let Some(measured) = measured else {
        let is_speed = unit::factor(&column.unit, Quantity::AngularSpeed).is_ok();
        return Err(wrong(
            Some(at),
            match is_speed {
                true => format!("`{raw}` is a speed, and the motion is theta, gamma or x"),
                false => format!("nothing says what `{raw}` is"),
            },
        ));
    };
    if reading.x_zero != 0.0 && measured != Measured::X {
        return fault(
            format!(
                "--x-zero belongs to x, and the motion is {}",
                measured.name()
            ),
            "leave it out",
        );
    }
    match (
        is_count && measured == Measured::Theta,
        reading.counts_per_turn,
    ) {
        (true, Some(counts)) => Ok((
            measured,
            Column {
                factor: TAU / f64::from(counts),
                unit: "counts".to_owned(),
            },
        )),
        (true, None) => fault(
            format!("`{raw}` are counts of an encoder"),
            "say how many there are in a turn: --counts-per-turn 1024",
        ),
        (false, Some(_)) => fault(
            format!(
                "--counts-per-turn belongs to counts, and the unit of `{raw}` is `{}`",
                column.unit
            ),
            "leave it out, or give the column of the counts: --motion \"2[counts]\"",
        ),
        (false, None) => Ok((
            measured,
            column.column(at, measured.quantity(), "--motion")?,
        )),
    }
}
