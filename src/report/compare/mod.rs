//! Comparison of motions: interpolates them at the times of the first and returns differences by column.

mod motion;

use serde::Serialize;

use super::key_values::{Facts, fact, six};
use super::quantity::{Quantity, split};
use super::table::Table;
use super::text::NAME_WIDTH;
use super::{DefaultView, Report};
use crate::error::Error;
pub use motion::Motion;
use motion::TIME;

/// Motions at the times of the first, with their differences from it.
#[derive(Debug, Serialize)]
pub struct Comparison {
    /// Names of the scenes or files of the motions, in order.
    pub motions: Vec<String>,
    /// Number of compared times: those of the first motion that another one covers.
    pub rows: usize,
    /// Differences of each motion from the first, by column.
    pub differences: Vec<Difference>,
    /// Warnings about runs, times that are not common, and interpolation between rows.
    pub warnings: Vec<String>,
    #[serde(skip)]
    title: String,
    /// Compared times in words.
    #[serde(skip)]
    compared: String,
    #[serde(skip)]
    table: Table,
}

/// Difference of one column from the first motion, in SI units.
#[derive(Clone, Debug, Serialize)]
pub struct Difference {
    /// Column, with its unit.
    pub column: String,
    /// Name of the motion compared with the first.
    pub motion: String,
    /// Largest absolute difference.
    pub largest: f64,
    /// Time of the largest absolute difference, s.
    pub at_s: f64,
    /// Root mean square difference over the common times.
    pub rms: f64,
    /// Difference at the last common time.
    pub last: f64,
}

impl Comparison {
    /// Compares motions at the times of the first. Whole turns between angles at the first common time are removed.
    /// [`Error::Refused`] if motions have no column or no time in common.
    pub fn new(motions: &[Motion]) -> Result<Comparison, Error> {
        let [first, others @ ..] = motions else {
            return Err(Error::refused(
                "there is no motion",
                "give two scenes or files",
            ));
        };
        let times = first.times();
        let has = |other: &Motion, name: &str| other.table.numbers(name).is_some();
        let all_have = |name: &str| others.iter().all(|other| has(other, name));
        let shared = |name: &&str| *name != TIME && all_have(name);
        let columns: Vec<&str> = first.table.names().filter(shared).collect();
        let mut table = vec![(TIME.to_owned(), times.to_vec())];
        let mut differences = Vec::new();
        let mut warnings = Vec::new();
        for other in others {
            let (count, compared) = common(times, |t| other.covers(t));
            if count < times.len() {
                let name = &other.name;
                warnings.push(format!("{name} is compared only at {compared}"));
            }
        }
        let (rows, compared) = common(times, |t| others.iter().any(|other| other.covers(t)));
        for column in columns {
            let (base, unit) = split(column);
            let own = first.table.numbers(column).unwrap_or_default();
            table.push((format!("{base}_of_1{unit}"), own.to_vec()));
            for (number, other) in (2..).zip(others) {
                let (mut theirs, between) = other.at(column, times);
                let mut off: Vec<f64> = theirs.iter().zip(own).map(|(b, a)| b - a).collect();
                if unit == "_rad" {
                    let turns = whole_turns(&off);
                    for value in theirs.iter_mut().chain(&mut off) {
                        *value -= turns;
                    }
                }
                differences.extend(difference(column, &other.name, times, &off));
                if between && base == "theta" {
                    let name = &other.name;
                    warnings.push(format!(
                        "{name} has other times: cubics through four of its rows stand between them"
                    ));
                }
                table.push((format!("{base}_of_{number}{unit}"), theirs));
                table.push((format!("{base}_difference_{number}{unit}"), off));
            }
        }
        if differences.is_empty() {
            return Err(Error::refused(
                "the motions have no column in common at any time of the first",
                "compare scenes, rows of `simulate --out` or measured motions with overlapping times",
            ));
        }
        let names: Vec<String> = motions.iter().map(|motion| motion.name.clone()).collect();
        Ok(Comparison {
            title: names.join(", "),
            motions: names,
            rows,
            compared,
            differences,
            warnings,
            table: Table::of_numbers(table),
        })
    }
}

impl Report for Comparison {
    fn facts(&self) -> Facts {
        let mut facts = Facts::of(&self.title);
        for (number, name) in (1..).zip(&self.motions) {
            facts.add(format_args!("motion {number}"), name);
        }
        fact!(facts, "compared" => "at {}", self.compared);
        for found in &self.differences {
            let quantity = Quantity::of(&found.column);
            let shown = |value: f64| six(quantity.factor * value);
            let (largest, rms, last) = (shown(found.largest), shown(found.rms), shown(found.last));
            let (unit, at) = (&quantity.unit, six(found.at_s));
            let name = match self.motions.len() {
                2 => quantity.label.clone(),
                _ => format!("{} {}", found.motion, quantity.label),
            };
            let most = format!("differs by at most {largest} {unit} at {at} s");
            fact!(facts, name => "{most}, rms {rms}, at last {last}");
        }
        facts.warnings(&self.warnings);
        facts
    }

    fn text(&self) -> String {
        self.facts().lines(NAME_WIDTH)
    }

    fn table(&self) -> Table {
        self.table.clone()
    }

    /// Returns the plot of position and speed of crank and slider.
    fn default_view(&self) -> DefaultView<'_> {
        DefaultView {
            title: &self.title,
            show: "theta_of,theta_difference,omega_of,omega_difference,x_of,x_difference,v_of,v_difference",
            over: "t",
            columns: 2,
            ..DefaultView::default()
        }
    }
}

/// Returns the number of times of the first motion that are common with others, and those times in words.
fn common(times: &[f64], covers: impl Fn(f64) -> bool) -> (usize, String) {
    let common: Vec<f64> = times.iter().copied().filter(|t| covers(*t)).collect();
    let (count, all) = (common.len(), times.len());
    let words = match common[..] {
        _ if count == all => format!("the {all} times of motion 1"),
        [first, .., last] => {
            format!("{count} of the {all} times of motion 1, t = {first} to {last} s")
        }
        _ => format!("{count} of the {all} times of motion 1"),
    };
    (count, words)
}

/// Returns the whole turns (rad) in the first finite difference of two angles.
fn whole_turns(off: &[f64]) -> f64 {
    let first = off.iter().find(|value| value.is_finite());
    let turn = std::f64::consts::TAU;
    first.map_or(0.0, |off| turn * (off / turn).round())
}

fn difference(column: &str, motion: &str, times: &[f64], off: &[f64]) -> Option<Difference> {
    let known = || times.iter().zip(off).filter(|(_, off)| off.is_finite());
    let (at, largest) = known().max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))?;
    let count = known().count() as f64;
    Some(Difference {
        column: column.to_owned(),
        motion: motion.to_owned(),
        largest: largest.abs(),
        at_s: *at,
        rms: (known().map(|(_, off)| off * off).sum::<f64>() / count).sqrt(),
        last: *known().next_back()?.1,
    })
}
