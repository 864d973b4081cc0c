//! Reads the claims of a paper from three built-in CSV files, and evaluates the formulas: expressions as in loads, with
//! two more kinds of names, symbols of the paper and quantities of the mechanism. `slope_SYMBOL` is the derivative of a
//! symbol by the crank angle, `largest_SYMBOL` its largest size in a turn.

use std::collections::BTreeMap;

use super::entry::{Entry, Printed, Verdict};
use super::paper::Paper;
use crate::error::Error;
use crate::figure::{Axis, Figure};
use crate::numeric::{angle, difference, maximum};
use crate::scene::{Expression, Instant};

/// Recomputed figure of a paper.
#[derive(Clone, Debug, PartialEq)]
pub struct Drawing {
    /// Name of the paper.
    pub paper: &'static str,
    /// Name of the figure in file names.
    pub name: String,
    /// Title.
    pub title: String,
    /// Plots of the figure, in order.
    pub plots: Vec<Figure>,
}

/// Function from the name of a quantity and the crank angle (rad) to its value; none for unknown names.
pub(super) type Quantities = Box<dyn Fn(&str, f64) -> Option<f64>>;

/// CSV texts of a paper, by column:
pub(super) struct Files {
    /// Symbols: symbol,formula,source; a formula uses symbols above it and the variables theta and t.
    pub symbols: &'static str,
    /// Claims: place,what,unit,at,printed,range,ours,verdict,condition,conditional
    pub claims: &'static str,
    /// Figures: figure,title,x_axis,y_axis,from,to,steps,theta,style,label,formula; theta as formula of the abscissa t;
    /// in place of a formula `PLACE: WHAT` for the printed numbers of the claims that begin so, over their `at`
    pub figures: &'static str,
}

/// Returns the built-in CSV texts of a paper, by its name in `data/papers`.
macro_rules! files {
    ($paper:literal) => {
        $crate::reproduce::formulas::Files {
            symbols: include_str!(concat!("../../data/papers/", $paper, "-symbols.csv")),
            claims: include_str!(concat!("../../data/papers/", $paper, ".csv")),
            figures: include_str!(concat!("../../data/papers/", $paper, "-figures.csv")),
        }
    };
}
pub(super) use files;

/// Paper whose formulas can be evaluated. Data and formulas that cannot be read are [`Error::Refused`].
pub(super) struct PaperFormulas {
    paper: Paper,
    symbols: BTreeMap<String, Expression>,
    claims: Vec<[String; 10]>,
    figures: Vec<[String; 11]>,
    quantities: Quantities,
}

/// Returns the records of a CSV table after its header, `N` fields each.
fn records<const N: usize>(text: &'static str) -> Result<Vec<[String; N]>, Error> {
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    reader
        .deserialize::<Vec<String>>()
        .map(|record| {
            let fields = record.map_err(|e| wrong(&e.to_string(), "a table of a paper"))?;
            let count = fields.len();
            let fields = fields.try_into();
            fields.map_err(|_| wrong(&format!("{count} fields"), &format!("{N} fields")))
        })
        .collect()
}

fn wrong(found: &str, wanted: &str) -> Error {
    Error::refused(
        format!("data of a paper: {found} in place of {wanted}"),
        "mend data/papers",
    )
}

impl PaperFormulas {
    /// Reads the tables of a paper and the formulas of its symbols.
    pub fn new(paper: Paper, files: Files) -> Result<PaperFormulas, Error> {
        let mut formulas = PaperFormulas {
            paper,
            symbols: BTreeMap::new(),
            claims: records(files.claims)?,
            figures: records(files.figures)?,
            quantities: Box::new(|_, _| None),
        };
        for [symbol, formula, _] in records(files.symbols)? {
            let expression = formulas.read(&formula, 0.0)?;
            formulas.symbols.insert(symbol, expression);
        }
        Ok(formulas)
    }

    /// Sets the quantities of the mechanism.
    pub fn with(self, quantities: Quantities) -> PaperFormulas {
        PaperFormulas { quantities, ..self }
    }

    fn read(&self, formula: &str, theta: f64) -> Result<Expression, Error> {
        let symbol = |name: &str| self.symbols.get(name).cloned();
        let slope = |name: &str| {
            let of = symbol(name.strip_prefix("slope_")?)?;
            let at = |theta| of.value(&now(0.0, theta));
            // With this step, rad, truncation and rounding errors are each about 1e-12 of the value.
            let step = 1e-3;
            Some(difference::slope(at, theta, step))
        };
        let largest = |name: &str| {
            let of = symbol(name.strip_prefix("largest_")?)?;
            let size = |theta| of.value(&now(0.0, theta)).abs();
            let grid: Vec<f64> = angle::turn(1f64.to_radians()).collect();
            let peaks = maximum::peaks(size, &grid).into_iter();
            Some(peaks.map(|(_, peak)| peak).fold(size(0.0), f64::max))
        };
        let number = |name: &str| {
            let ours = || (self.quantities)(name, theta);
            slope(name).or_else(|| largest(name)).or_else(ours)
        };
        let named = |name: &str| symbol(name).or_else(|| number(name).map(Expression::constant));
        Expression::parse_with(formula, &named).map_err(|error| wrong(formula, &error.what))
    }

    /// Returns the value of a formula at a crank angle, rad.
    pub fn value(&self, formula: &str, theta: f64) -> Result<f64, Error> {
        self.value_at(formula, &now(theta, theta))
    }

    fn value_at(&self, formula: &str, at: &Instant) -> Result<f64, Error> {
        Ok(self.read(formula, at.theta)?.value(at))
    }

    /// Returns the values of constant symbols or formulas.
    pub fn numbers<const N: usize>(&self, names: [&str; N]) -> Result<[f64; N], Error> {
        let mut values = [0.0; N];
        for (value, name) in values.iter_mut().zip(names) {
            *value = self.value(name, 0.0)?;
        }
        Ok(values)
    }

    /// Returns every printed number and formula with the computed value.
    pub fn entries(&self) -> Result<Vec<Entry>, Error> {
        self.claims.iter().map(|claim| self.entry(claim)).collect()
    }

    fn entry(&self, claim: &[String; 10]) -> Result<Entry, Error> {
        let [
            place,
            what,
            unit,
            at,
            printed,
            range,
            ours,
            verdict,
            condition,
            conditional,
        ] = claim;
        let t = self.value(if at.is_empty() { "0" } else { at }, 0.0)?;
        // A symbol `angle` converts to radians, for papers in degrees.
        let angle = self.symbols.get("angle");
        let at = now(t, angle.map_or(t, |angle| angle.value(&now(t, t))));
        let value = |formula: &str| self.value_at(formula, &at);
        let optional = |formula: &str| match formula {
            "" => Ok(None),
            formula => value(formula).map(Some),
        };
        let printed = match (printed.strip_prefix('='), range.split_once("..")) {
            (Some(formula), _) => Printed::Formula(value(formula)?),
            (None, Some((least, most))) => Printed::between(printed, [value(least)?, value(most)?]),
            (None, None) => {
                let number = printed.parse().map_err(|_| wrong(printed, "a number"))?;
                Printed::number(printed, number)
            }
        };
        let (expected, cut) = match verdict.as_str() {
            "reproduces" => (Verdict::Reproduces, false),
            "only if" => (Verdict::OnlyIf, false),
            "only if, cut" => (Verdict::OnlyIf, true),
            "cannot" => (Verdict::Cannot, false),
            other => return Err(wrong(other, "a verdict")),
        };
        let (ours, conditional) = (optional(ours)?, optional(conditional)?);
        let verdict = printed.verdict(ours, conditional, cut);
        // An unneeded condition is dropped.
        let needs_condition = verdict != Verdict::Reproduces;
        Ok(Entry {
            paper: self.paper.name(),
            place: place.clone(),
            what: what.clone(),
            unit: unit.clone(),
            printed: printed.text(),
            ours,
            conditional: conditional.filter(|_| needs_condition),
            condition: match needs_condition {
                true => condition.clone(),
                false => String::new(),
            },
            verdict,
            expected,
        })
    }

    /// Returns a column of a printed table, as (abscissa, printed number) of each row.
    pub fn column(&self, table: &str, column: &str) -> Result<Vec<(f64, f64)>, Error> {
        let wanted = |[place, what, ..]: &&[String; 10]| place == table && what.starts_with(column);
        let rows = self.claims.iter().filter(wanted);
        rows.map(|[_, _, _, at, printed, ..]| Ok((self.value(at, 0.0)?, self.value(printed, 0.0)?)))
            .collect()
    }

    /// Returns every figure.
    pub fn drawings(&self) -> Result<Vec<Drawing>, Error> {
        let figures = self.figures.chunk_by(|one, next| one[0] == next[0]);
        figures.map(|curves| self.drawing(curves)).collect()
    }

    /// Returns the figure of some curves; neighbours with equal axes share a plot.
    fn drawing(&self, curves: &[[String; 11]]) -> Result<Drawing, Error> {
        let plots = curves.chunk_by(|one, next| one[2..4] == next[2..4]);
        let plots = plots.map(|curves| {
            let [x, y] = [2, 3].map(|axis| Axis::linear(&curves[0][axis]));
            let mut curves = curves.iter();
            curves.try_fold(Figure::new("", x, y), |plot, curve| self.drawn(plot, curve))
        });
        let plots = plots.collect::<Result<_, Error>>()?;
        let [name, title, ..] = &curves[0];
        let number = name.replace("figure-0", "figure ").replace('-', " ");
        Ok(Drawing {
            paper: self.paper.name(),
            name: name.clone(),
            title: format!("{}, {number}: {title}", self.paper.authors()),
            plots,
        })
    }

    fn drawn(&self, plot: Figure, curve: &[String; 11]) -> Result<Figure, Error> {
        let [.., from, to, steps, theta, style, label, formula] = curve;
        let points = match formula.split_once(": ") {
            Some((place, what)) => self.column(place, what)?,
            None => self.points(formula, [from, to, steps], theta)?,
        };
        match style.as_str() {
            "line" => Ok(plot.line(label, points)),
            "dashed" => Ok(plot.dashed(label, points)),
            "points" => Ok(plot.points(label, points)),
            _ => Err(wrong(style, "a style")),
        }
    }

    /// Returns the values of a formula at `steps` + 1 abscissas.
    fn points(
        &self,
        formula: &str,
        range: [&str; 3],
        theta: &str,
    ) -> Result<Vec<(f64, f64)>, Error> {
        let [from, to, steps] = self.numbers(range)?;
        let theta = self.read(theta, 0.0)?;
        let point = |i: u32| {
            let t = from + (to - from) * f64::from(i) / steps;
            let at = now(t, theta.value(&now(t, t)));
            Ok((t, self.value_at(formula, &at)?))
        };
        (0..=steps as u32).map(point).collect()
    }
}

fn now(t: f64, theta: f64) -> Instant {
    Instant {
        t,
        theta,
        ..Instant::default()
    }
}
