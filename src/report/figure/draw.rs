//! One panel: title, axes, series, legend.

use std::ops::Range;

use plotters::coord::ranged1d::{KeyPointHint, NoDefaultFormatting, Ranged, ValueFormatter};
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::clip::{inside, pieces};
use super::legend::{self, Legend};
use super::marks::{self, Place, marker, path};
use super::page::{
    self, Area, EDGE, FINE, Failure, TEXT, TITLE, font, line_height, text_width, wrapped,
};
use super::scale::{Scale, Tick};
use super::{Figure, Look, Numbered, Series};

/// Free space on the right of the axes, pixels; it holds half a tick label.
const RIGHT: i32 = 34;

/// Least distance between ticks of the y axis, pixels.
const TICK_DISTANCE: i32 = 34;

/// What a title and a legend add to the height of a panel, pixels.
pub(super) fn height_of_texts(figure: &Figure, width: i32) -> i32 {
    let title = wrapped(&figure.title, TITLE, width - 2 * EDGE).len() as i32;
    let legend = Legend::new(figure, width).rows.len() as i32;
    title * line_height(TITLE) + legend * legend::row_height()
}

pub(super) fn panel<'a>(
    area: &Area<'a>,
    figure: &Figure,
    (width, height): (i32, i32),
    y_area: i32,
) -> Result<(), Failure<'a>> {
    let title = wrapped(&figure.title, TITLE, width - 2 * EDGE);
    page::write_lines(area, &title, TITLE, (width / 2, EDGE))?;
    let legend = Legend::new(figure, width);
    let top = EDGE + title.len() as i32 * line_height(TITLE) + 6;
    let bottom = height - EDGE / 2 - legend.rows.len() as i32 * legend::row_height();
    let axes = area
        .clone()
        .shrink((0, top * FINE), (width * FINE, (bottom - top) * FINE));
    series(&axes, figure, (width, bottom - top), y_area)?;
    legend.draw(area, bottom)
}

/// An axis as the library sees it: places from 0 to 1, with our ticks.
struct Ticked(Vec<Tick>);

impl Ranged for Ticked {
    type FormatOption = NoDefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, (low, high): (i32, i32)) -> i32 {
        low + (value * f64::from(high - low)).round() as i32
    }

    fn key_points<Hint: KeyPointHint>(&self, _: Hint) -> Vec<f64> {
        self.0.iter().map(|tick| tick.at).collect()
    }

    fn range(&self) -> Range<f64> {
        0.0..1.0
    }
}

impl ValueFormatter<f64> for Ticked {
    fn format_ext(&self, value: &f64) -> String {
        let tick = self.0.iter().find(|tick| tick.at == *value);
        tick.map_or(String::new(), |tick| tick.label.clone())
    }
}

/// Height of the label and ticks of the x axis, pixels.
fn x_area(figure: &Figure) -> i32 {
    let lines = if figure.x.label.is_empty() { 1 } else { 2 };
    lines * line_height(TEXT) + 20
}

fn widest(ticks: &[Tick]) -> i32 {
    let widths = ticks.iter().map(|tick| text_width(&tick.label, TEXT));
    widths.max().unwrap_or(0)
}

/// Most ticks of the y axis in a panel of a height in pixels.
fn rows(figure: &Figure, height: i32) -> usize {
    ((height - x_area(figure)) / TICK_DISTANCE).max(2) as usize
}

/// The y axis of a panel of a height in pixels, with its ticks.
fn y_axis(figure: &Figure, height: i32) -> (Scale, Vec<Tick>) {
    let scale = Scale::new(&figure.y, figure.values(|(_, low, high)| [low, high]));
    let ticks = scale.ticks(rows(figure, height));
    (scale, ticks)
}

/// Width of the label and the ticks of the y axis in a panel of a height in pixels.
pub(super) fn y_area(figure: &Figure, height: i32) -> i32 {
    widest(&y_axis(figure, height).1) + line_height(TEXT) + 22
}

fn series<'a>(
    area: &Area<'a>,
    figure: &Figure,
    size: (i32, i32),
    y_area: i32,
) -> Result<(), Failure<'a>> {
    let mut x = Scale::new(&figure.x, figure.values(|(x, _, _)| [x, x]));
    let (mut y, mut y_ticks) = y_axis(figure, size.1);
    let length = size.0 - y_area - EDGE - RIGHT;
    if figure.is_equal {
        let height = size.1 - x_area(figure);
        let [width, height] = [length, height].map(f64::from);
        let per_pixel = (x.length() / width).max(y.length() / height);
        x.lengthen(per_pixel * width);
        y.lengthen(per_pixel * height);
        y_ticks = y.ticks(rows(figure, size.1));
    }
    // As many ticks as their labels leave room for.
    let x_ticks = (2..=10)
        .rev()
        .map(|most| x.ticks(most))
        .find(|ticks| ticks.len() as i32 * (widest(ticks) + 16) <= length)
        .unwrap_or_default();

    let mut chart = ChartBuilder::on(area)
        .margin_left(EDGE * FINE)
        .margin_right(RIGHT * FINE)
        .x_label_area_size(x_area(figure) * FINE)
        .y_label_area_size(y_area * FINE)
        .build_cartesian_2d(Ticked(x_ticks), Ticked(y_ticks))?;
    let mut mesh = chart.configure_mesh();
    mesh.bold_line_style(RGBColor(222, 222, 222).stroke_width(FINE as u32))
        .light_line_style(TRANSPARENT)
        .axis_style(BLACK.stroke_width(FINE as u32))
        .set_all_tick_mark_size(5 * FINE)
        .label_style(font(TEXT))
        .axis_desc_style(font(TEXT));
    if !figure.x.label.is_empty() {
        mesh.x_desc(figure.x.label_within(length + RIGHT));
    }
    if !figure.y.label.is_empty() {
        mesh.y_desc(figure.y.label_within(size.1 - x_area(figure)));
    }
    mesh.draw()?;
    let inner = chart.plotting_area().strip_coord_spec();
    Canvas { area: inner, x, y }.series(figure)
}

/// The area between the axes.
struct Canvas<'a> {
    area: Area<'a>,
    x: Scale,
    y: Scale,
}

impl<'a> Canvas<'a> {
    fn series(&self, figure: &Figure) -> Result<(), Failure<'a>> {
        if figure.is_empty() {
            let (width, height) = self.area.dim_in_pixel();
            let centre = Pos::new(HPos::Center, VPos::Center);
            let middle = (width as i32 / 2, height as i32 / 2);
            let text = Text::new("nothing to show", middle, font(TEXT).pos(centre));
            self.area.draw(&text)?;
        }
        // Bands lie under lines, lines under points.
        for layer in 0..3 {
            for numbered in figure.numbered() {
                self.layer(layer, &numbered)?;
            }
        }
        Ok(())
    }

    fn layer(&self, layer: u32, numbered: &Numbered) -> Result<(), Failure<'a>> {
        let (series, index) = (numbered.series, numbered.colour);
        let colour = marks::colour(series.look, index);
        let dashes = marks::dashes(numbered);
        match (layer, series.look) {
            (0, Look::Band) => self.band(series, colour),
            (0, Look::VerticalMark) => {
                let x = self.x.position(series.points[0].0);
                if inside((x, 0.0)) {
                    let ends = vec![self.place((x, 0.0)), self.place((x, 1.0))];
                    path(&self.area, ends, colour, dashes)?;
                }
                Ok(())
            }
            (1, Look::Line | Look::Dashed | Look::LineWithPoints) => {
                for piece in pieces(&self.positions(series)) {
                    let places: Vec<_> = piece.into_iter().map(|at| self.place(at)).collect();
                    match places[..] {
                        // A line through one point cannot be seen.
                        [only] => marker(&self.area, index, only, colour)?,
                        _ => path(&self.area, places, colour, dashes)?,
                    }
                }
                Ok(())
            }
            (2, Look::Points | Look::LineWithPoints) => {
                let positions = self.positions(series);
                for at in positions.into_iter().filter(|at| inside(*at)) {
                    marker(&self.area, index, self.place(at), colour)?;
                }
                Ok(())
            }
            _ => Ok(()),
        }
    }

    /// A band as pieces between two neighbouring points, joined while it has a place on the axes.
    fn band(&self, series: &Series, colour: RGBColor) -> Result<(), Failure<'a>> {
        let points: Vec<_> = series
            .points
            .iter()
            .map(|&(x, low, high)| {
                let y = |value| self.y.clamped(value);
                (self.x.position(x), y(low), y(high))
            })
            .collect();
        let seen = |(x, low, high): &(f64, f64, f64)| inside((*x, 0.0)) && (low + high).is_finite();
        for run in points.split(|point| !seen(point)) {
            let low = run.iter().map(|&(x, low, _)| self.place((x, low)));
            let high = run.iter().rev().map(|&(x, _, high)| self.place((x, high)));
            if run.len() > 1 {
                marks::filled(&self.area, low.chain(high).collect(), colour)?;
            }
        }
        Ok(())
    }

    fn positions(&self, series: &Series) -> Vec<(f64, f64)> {
        let points = series.points.iter();
        points
            .map(|&(x, y, _)| (self.x.position(x), self.y.position(y)))
            .collect()
    }

    fn place(&self, (x, y): (f64, f64)) -> Place {
        let (width, height) = self.area.dim_in_pixel();
        let along = |part: f64, length: u32| (part * f64::from(length)).round() as i32;
        (along(x, width), along(1.0 - y, height))
    }
}
