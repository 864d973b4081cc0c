//! Plots columns of a table as curves in aligned panels: choice of columns, units, bands, thinning and poles.

use std::f64::consts::PI;

use super::default_view::DefaultView;
use super::key_values::rounded;
use super::quantity::{Quantity, base, curves, split};
use super::table::Table;
use crate::error::Error;
use crate::figure::{Axis, Figure, Shape, sheet};

/// User's choice of the content of a picture of rows; the command supplies defaults.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct View {
    /// Columns, by name with or without unit, or by the first or last words of the name for all columns that have them;
    /// `x:cm` is shown in cm.
    pub show: Vec<String>,
    /// Column of the horizontal axis.
    pub over: Option<String>,
    /// Width and height of the picture, mm.
    pub size: Option<Shape>,
}

impl View {
    /// Refuses names that are no columns of this CSV header, with a list of its columns.
    pub fn check(&self, header: &str) -> Result<(), Error> {
        let names: Vec<&str> = header.split(',').collect();
        for text in &self.show {
            curves(&names, text)?;
        }
        match &self.over {
            Some(over) => base(&names, over).map(|_| ()),
            None => Ok(()),
        }
    }

    /// Whether neither columns nor horizontal axis are chosen.
    pub(super) fn is_default(&self) -> bool {
        self.show.is_empty() && self.over.is_none()
    }

    /// Returns the chosen columns as figures, columns of one group and unit in one panel.
    pub(super) fn figures(
        &self,
        table: &Table,
        default: &DefaultView<'_>,
    ) -> Result<Vec<Figure>, Error> {
        let names: Vec<&str> = table.names().collect();
        let over = base(&names, self.over.as_deref().unwrap_or(default.over))?;
        let mut chosen = Vec::new();
        for text in &self.show {
            chosen.extend(curves(&names, text)?);
        }
        if self.show.is_empty() {
            // Default columns may be missing from the rows.
            let found = default.show.split(',');
            let found = found.filter_map(|text| curves(&names, text).ok());
            chosen.extend(found.flatten());
        }
        let mut panels: Vec<Vec<Quantity>> = Vec::new();
        for curve in chosen {
            let alike = |panel: &&mut Vec<Quantity>| {
                panel[0].group == curve.group && panel[0].unit == curve.unit
            };
            match panels.iter_mut().find(alike) {
                Some(panel) => panel.push(curve),
                None => panels.push(vec![curve]),
            }
        }
        let drawn = |curves: &Vec<Quantity>| panel(table, &over, curves, default);
        Ok(panels.iter().map(drawn).collect())
    }

    /// Returns the chosen columns as SVG.
    pub(super) fn svg(&self, table: &Table, default: DefaultView<'_>) -> Result<String, Error> {
        let mut figures = self.figures(table, &default)?;
        let columns = if figures.len() > 3 {
            default.columns
        } else {
            1
        };
        if self.is_default() && !default.extra_figures.is_empty() {
            figures.extend(default.extra_figures);
        } else {
            // Panels in a column share their horizontal axis: only the lowest is labelled.
            let above = figures.len().saturating_sub(columns.max(1));
            let above = figures[..above].iter_mut();
            above.for_each(|figure| figure.x.label.clear());
        }
        sheet(default.title, columns, self.size, &figures)
    }
}

impl Quantity {
    /// Returns the values in the displayed unit.
    pub fn values<'a>(&self, table: &'a Table) -> impl Iterator<Item = f64> + use<'a> {
        let factor = self.factor;
        let values = table.numbers(&self.name).unwrap_or_default();
        values.iter().map(move |value| factor * value)
    }
}

/// Returns the label of an axis, with its unit.
fn labelled(words: &str, unit: &str) -> String {
    match unit {
        "" => words.to_owned(),
        unit => format!("{words} [{unit}]"),
    }
}

/// Returns the axis of a quantity, with its unit.
pub(super) fn axis(words: &str, unit: &str) -> Axis {
    let label = labelled(words, unit);
    match unit {
        "°" => Axis::degrees(label),
        _ => Axis::linear(label),
    }
}

/// Draws columns of one quantity, with their bands, over the column `over`.
fn panel(table: &Table, over: &Quantity, curves: &[Quantity], default: &DefaultView<'_>) -> Figure {
    let x: Vec<f64> = over.values(table).collect();
    let first = &curves[0];
    let is_alone = curves.len() == 1;
    let words = if is_alone { &first.label } else { &first.group };
    let mut up = axis(words, &first.unit).or(labelled("", &first.unit).trim());
    let values = || curves.iter().flat_map(|curve| curve.values(table));
    let cut = default.has_poles.then(|| bulk(values())).flatten();
    if let Some((low, high)) = cut {
        up.label.push_str(", peaks cut off");
        up = up.range(low, high);
    }
    let across = axis(&over.label, &over.unit);
    let mut figure = Figure::new("", across, up);
    for curve in curves {
        let mut label = match is_alone {
            true => String::new(),
            false => curve.label.clone(),
        };
        if let Some((told, edges)) = band(table, curve, default.band) {
            figure = figure.band(&told, outlined_band(&x, &edges));
            label = told;
        }
        let y: Vec<f64> = curve.values(table).collect();
        figure = figure.line(&label, broken_at_poles(outlined(&x, &y), cut));
    }
    figure
}

/// Returns the label of a curve with a band, and lower and upper edge at each row: columns `min` and `max`, or
/// +-`factor` standard errors (column `se`). The label tells the median half-width of an error, often too narrow to see.
fn band(table: &Table, curve: &Quantity, factor: f64) -> Option<(String, Vec<[f64; 2]>)> {
    let (name, unit) = split(&curve.name);
    let beside = |word: &str| table.numbers(&format!("{name}_{word}{unit}"));
    let (label, scale) = (&curve.label, curve.factor);
    if let Some((low, high)) = beside("min").zip(beside("max")) {
        let edges = low.iter().zip(high).map(|(a, b)| [a * scale, b * scale]);
        return Some((label.clone(), edges.collect()));
    }
    let halves: Vec<f64> = beside("se")?.iter().map(|se| factor * se * scale).collect();
    let edges = curve.values(table).zip(&halves);
    let edges = edges.map(|(value, half)| [value - half, value + half]);
    let mut sorted: Vec<f64> = halves.iter().copied().filter(|h| h.is_finite()).collect();
    sorted.sort_unstable_by(f64::total_cmp);
    let label = match sorted.get(sorted.len() / 2) {
        Some(half) => format!(
            "{label}, band +- {} {} at the median",
            rounded(*half, 2),
            curve.unit
        ),
        None => label.clone(),
    };
    Some((label, edges.collect()))
}

/// Thins a band to about [`CURVE_POINTS`] points (x, low, high): keeps the extremes of each piece.
fn outlined_band(x: &[f64], edges: &[[f64; 2]]) -> Vec<(f64, f64, f64)> {
    let piece = x.len().div_ceil(CURVE_POINTS).max(1);
    let pieces = x.chunks(piece).zip(edges.chunks(piece));
    let points = pieces.map(|(x, edges)| {
        let low = edges.iter().map(|edge| edge[0]).fold(f64::NAN, f64::min);
        let high = edges.iter().map(|edge| edge[1]).fold(f64::NAN, f64::max);
        (x[0], low, high)
    });
    points.collect()
}

/// Crank angle between points of a drawn curve, rad: half a degree, about a pixel of a turn.
pub(super) const CURVE_STEP: f64 = PI / 360.0;

/// Maximum number of points of a curve, about, several per pixel of a panel; curves with more are thinned.
pub(super) const CURVE_POINTS: usize = 4000;

/// Thins a curve to about [`CURVE_POINTS`]: keeps the extremes of x and y of each piece.
fn outlined(x: &[f64], y: &[f64]) -> Vec<(f64, f64)> {
    let piece = (4 * x.len()).div_ceil(CURVE_POINTS).max(1);
    if piece <= 4 {
        return x.iter().copied().zip(y.iter().copied()).collect();
    }
    let pieces = x.chunks(piece).zip(y.chunks(piece));
    let points = pieces.flat_map(|(x, y)| {
        let order = |of: &'_ [f64], i: usize, j: usize| of[i].total_cmp(&of[j]);
        let rows = || 0..x.len();
        let mut kept: Vec<usize> = [x, y]
            .into_iter()
            .flat_map(|of| {
                let least = rows().min_by(|i, j| order(of, *i, *j));
                [least, rows().max_by(|i, j| order(of, *i, *j))]
            })
            .flatten()
            .collect();
        kept.sort_unstable();
        kept.dedup();
        kept.into_iter().map(move |i| (x[i], y[i]))
    });
    points.collect()
}

/// Returns the range of the central values, without those that may belong to poles, widened by its width on both sides;
/// none unless the full range exceeds four times that width.
fn bulk(values: impl Iterator<Item = f64>) -> Option<(f64, f64)> {
    let mut values: Vec<f64> = values.filter(|value| value.is_finite()).collect();
    values.sort_unstable_by(f64::total_cmp);
    let last = values.len().checked_sub(1)?;
    let share_at_each_end = 0.05;
    let beyond = (share_at_each_end * last as f64).round() as usize;
    let (low, high) = (values[beyond], values[last - beyond]);
    let room = high - low;
    let whole = values[last] - values[0];
    (whole > 4.0 * room).then(|| (values[0].max(low - room), values[last].min(high + room)))
}

/// Breaks a curve (NaN) where it leaves the range on one side and returns on the other, across a pole.
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
