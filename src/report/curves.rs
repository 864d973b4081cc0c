//! Columns of rows as curves in aligned panels: which, over what, in which units and how large.

use super::columns::{Curve, base, curves, labelled};
use super::figure::{Axis, Figure, Shape, Sheet};
use super::quantity::split;
use super::table::Table;
use crate::error::Error;

/// What a picture of rows shows; what is not chosen is chosen by the command.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct View {
    /// Columns, by name with or without unit, or by a word of the name for all columns that have it first or last; `x:cm`
    /// is shown in cm.
    pub show: Vec<String>,
    /// Column of the horizontal axis.
    pub over: Option<String>,
    /// Width and height of the picture, mm.
    pub size: Option<Shape>,
}

/// What a command shows of its rows by itself.
pub(super) struct Shown<'a> {
    pub title: &'a str,
    pub show: &'a [&'a str],
    pub over: &'a str,
    /// Panels beside each other.
    pub columns: usize,
    /// Half the width of a band in standard errors.
    pub band: f64,
    /// Whether curves grow without bound towards dead centres, so that their bulk is shown.
    pub has_poles: bool,
    /// What is drawn beside the columns, unless columns are chosen.
    pub beside: Vec<Figure>,
}

impl Default for Shown<'_> {
    fn default() -> Self {
        Shown {
            title: "",
            show: &[],
            over: "theta",
            columns: 1,
            band: 0.0,
            has_poles: false,
            beside: Vec::new(),
        }
    }
}

impl View {
    /// Refuses what is no column of rows under this header (names with commas between them).
    ///
    /// # Errors
    /// [`Error::Refused`], with the columns there are.
    pub fn check(&self, header: &str) -> Result<(), Error> {
        let names: Vec<&str> = header.split(',').collect();
        for text in &self.show {
            curves(&names, text)?;
        }
        self.over
            .iter()
            .try_for_each(|over| base(&names, over).map(|_| ()))
    }

    /// Whether nothing was chosen to be shown.
    pub(super) fn is_default(&self) -> bool {
        self.show.is_empty() && self.over.is_none()
    }

    /// The chosen columns as SVG, those of one quantity in one panel.
    pub(super) fn svg(&self, table: &Table, shown: Shown<'_>) -> Result<String, Error> {
        let names: Vec<&str> = table.names().collect();
        let over = base(&names, self.over.as_deref().unwrap_or(shown.over))?;
        let mut chosen = Vec::new();
        if self.show.is_empty() {
            // A command shows what its rows have.
            let found = shown
                .show
                .iter()
                .filter_map(|text| curves(&names, text).ok());
            chosen.extend(found.flatten());
        }
        for text in &self.show {
            chosen.extend(curves(&names, text)?);
        }
        let mut panels: Vec<(String, Vec<Curve>)> = Vec::new();
        for curve in chosen {
            let key = format!("{} {}", curve.quantity.group, curve.quantity.unit);
            match panels.iter_mut().find(|(known, _)| *known == key) {
                Some((_, curves)) => curves.push(curve),
                None => panels.push((key, vec![curve])),
            }
        }
        let mut figures: Vec<Figure> = panels
            .into_iter()
            .map(|(_, curves)| panel(table, &over, &curves, &shown))
            .collect();
        let beside = if self.is_default() {
            shown.beside
        } else {
            Vec::new()
        };
        let is_aligned = beside.is_empty();
        figures.extend(beside);
        let columns = if figures.len() > 3 { shown.columns } else { 1 };
        if is_aligned {
            // Panels below each other share their horizontal axis.
            let above = figures.len().saturating_sub(columns);
            figures[..above]
                .iter_mut()
                .for_each(|figure| figure.x_axis().unlabelled());
        }
        let sheet = Sheet {
            title: shown.title,
            columns,
            size: self.size,
        };
        sheet.svg(&figures)
    }
}

/// Columns of one quantity, with their bands.
fn panel(table: &Table, over: &Curve, curves: &[Curve], shown: &Shown<'_>) -> Figure {
    let x: Vec<f64> = over.values(table).collect();
    let axis = |curve: &Curve| match &*curve.quantity.unit {
        "°" => Axis::degrees(curve.label()),
        _ => Axis::linear(curve.label()),
    };
    let [first, rest @ ..] = curves else {
        return Figure::new("", axis(over), Axis::linear(""));
    };
    let unit = &*first.quantity.unit;
    let mut label = match rest {
        [] => first.label(),
        _ => labelled(&first.quantity.group, unit),
    };
    let values = || curves.iter().flat_map(|curve| curve.values(table));
    let cut = if shown.has_poles {
        bulk(values())
    } else {
        None
    };
    if cut.is_some() {
        label.push_str(", peaks cut off");
    }
    let mut y_axis = match unit {
        "°" => Axis::degrees(label),
        _ => Axis::linear(label),
    };
    y_axis = y_axis.or(labelled("", unit).trim());
    if let Some((low, high)) = cut {
        y_axis = y_axis.range(low, high);
    }
    let mut figure = Figure::new("", axis(over), y_axis);
    for curve in curves {
        let band = band(table, curve, shown.band);
        let tells = !rest.is_empty() || band.is_some();
        let label = if tells { &curve.quantity.label } else { "" };
        let y: Vec<f64> = curve.values(table).collect();
        if let Some(band) = band {
            let points = x.iter().zip(band).map(|(x, [low, high])| (*x, low, high));
            figure = figure.band(label, points.collect());
        }
        let points = broken_at_poles(outlined(&x, &y), cut);
        figure = figure.line(label, points);
    }
    figure
}

/// Lower and upper edge at each row: what friction allows, or so many standard errors.
fn band(table: &Table, curve: &Curve, factor: f64) -> Option<Vec<[f64; 2]>> {
    let (name, unit) = split(&curve.name);
    let beside = |word: &str| table.numbers(&format!("{name}_{word}{unit}"));
    let scale = curve.quantity.factor;
    if let Some((low, high)) = beside("min").zip(beside("max")) {
        let edges = low.iter().zip(high);
        return Some(
            edges
                .map(|(low, high)| [low * scale, high * scale])
                .collect(),
        );
    }
    let values = curve.values(table).zip(beside("se")?);
    let edges = |(value, error): (f64, &f64)| {
        let half = factor * error * scale;
        [value - half, value + half]
    };
    Some(values.map(edges).collect())
}

/// Points that a curve needs; more are thinned out.
const POINTS: usize = 4000;

/// A curve through so few points that a picture stays small; the extremes of each piece are kept.
fn outlined(x: &[f64], y: &[f64]) -> Vec<(f64, f64)> {
    let piece = (4 * x.len()).div_ceil(POINTS).max(1);
    if piece <= 4 {
        return x.iter().copied().zip(y.iter().copied()).collect();
    }
    let mut points = Vec::new();
    for (x, y) in x.chunks(piece).zip(y.chunks(piece)) {
        let extreme = |values: &[f64]| {
            let order = |i: &usize, j: &usize| values[*i].total_cmp(&values[*j]);
            [
                (0..values.len()).min_by(order),
                (0..values.len()).max_by(order),
            ]
        };
        let mut kept: Vec<usize> = [extreme(x), extreme(y)]
            .into_iter()
            .flatten()
            .flatten()
            .collect();
        kept.sort_unstable();
        kept.dedup();
        points.extend(kept.into_iter().map(|i| (x[i], y[i])));
    }
    points
}

/// Part of the values at each end that may belong to poles.
const TAIL: f64 = 0.05;

/// The range of the bulk of values, if it is far less than their whole range: of the central ones, widened by their
/// range to both sides.
fn bulk(values: impl Iterator<Item = f64>) -> Option<(f64, f64)> {
    let mut values: Vec<f64> = values.filter(|value| value.is_finite()).collect();
    values.sort_unstable_by(f64::total_cmp);
    let last = values.len().checked_sub(1)?;
    let beyond = (TAIL * last as f64).round() as usize;
    let (low, high) = (values[beyond], values[last - beyond]);
    let room = high - low;
    let whole = values[last] - values[0];
    (whole > 4.0 * room).then(|| (values[0].max(low - room), values[last].min(high + room)))
}

/// A curve that leaves the range on one side and comes back on the other has a pole between.
fn broken_at_poles(points: Vec<(f64, f64)>, range: Option<(f64, f64)>) -> Vec<(f64, f64)> {
    let Some((low, high)) = range else {
        return points;
    };
    let mut broken: Vec<(f64, f64)> = Vec::with_capacity(points.len());
    for (x, y) in points {
        if let Some((_, before)) = broken.last()
            && (*before >= high && y <= low || *before <= low && y >= high)
        {
            broken.push((x, f64::NAN));
        }
        broken.push((x, y));
    }
    broken
}
