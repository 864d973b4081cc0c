//! The legend below the axes.

use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::marks::{self, Place, marker, path};
use super::page::{Area, EDGE, FINE, Failure, TEXT, fitted, font, line_height, text_width};
use super::{Figure, Look, Numbered};

/// Width of the sample of a series, pixels.
const SAMPLE: i32 = 30;

/// Free space after an entry, pixels.
const GAP: i32 = 24;

/// Height of a row, pixels.
pub(super) fn row_height() -> i32 {
    line_height(TEXT) + 4
}

/// Series of one label, and the label as it fits.
pub(super) struct Entry<'f> {
    series: Vec<Numbered<'f>>,
    label: String,
}

/// The legend: rows of entries that fit beside each other.
pub(super) struct Legend<'f> {
    pub(super) rows: Vec<Vec<Entry<'f>>>,
    width: i32,
}

impl<'f> Legend<'f> {
    pub(super) fn new(figure: &'f Figure, width: i32) -> Legend<'f> {
        let mut entries: Vec<Entry> = Vec::new();
        for numbered in figure.numbered() {
            let label = &numbered.series.label;
            let known = |entry: &&mut Entry| entry.series[0].series.label == *label;
            match entries.iter_mut().find(known) {
                _ if label.is_empty() || numbered.series.points.is_empty() => (),
                Some(entry) => entry.series.push(numbered),
                None => {
                    let most = width - 2 * EDGE - SAMPLE - GAP;
                    let label = fitted(label, most);
                    entries.push(Entry {
                        series: vec![numbered],
                        label,
                    });
                }
            }
        }
        let mut rows: Vec<Vec<_>> = Vec::new();
        let mut left = 0;
        for entry in entries {
            let needed = entry_width(&entry.label);
            match rows.last_mut() {
                Some(row) if needed <= left => row.push(entry),
                _ => {
                    left = width - 2 * EDGE;
                    rows.push(vec![entry]);
                }
            }
            left -= needed;
        }
        Legend { rows, width }
    }

    pub(super) fn draw<'a>(&self, area: &Area<'a>, top: i32) -> Result<(), Failure<'a>> {
        let left_centre = Pos::new(HPos::Left, VPos::Center);
        for (row, y) in self.rows.iter().zip((top..).step_by(row_height() as usize)) {
            let needed: i32 = row.iter().map(|entry| entry_width(&entry.label)).sum();
            let mut x = (self.width - needed) / 2;
            let y = (y + row_height() / 2) * FINE;
            for Entry { series, label } in row {
                for one in series {
                    sample(area, one, (x * FINE, y))?;
                }
                let at = ((x + SAMPLE + 6) * FINE, y);
                let style = font(TEXT).pos(left_centre);
                area.draw(&Text::new(label.clone(), at, style))?;
                x += entry_width(label);
            }
        }
        Ok(())
    }
}

fn entry_width(label: &str) -> i32 {
    SAMPLE + text_width(label, TEXT) + GAP
}

fn sample<'a>(area: &Area<'a>, of: &Numbered, (x, y): Place) -> Result<(), Failure<'a>> {
    let look = of.series.look;
    let colour = marks::colour(look, of.colour);
    let (end, half) = (x + SAMPLE * FINE, 5 * FINE);
    if look == Look::Band {
        let corners = vec![
            (x, y - half),
            (end, y - half),
            (end, y + half),
            (x, y + half),
        ];
        return marks::filled(area, corners, colour);
    }
    if look != Look::Points {
        path(area, vec![(x, y), (end, y)], colour, marks::dashes(of))?;
    }
    if matches!(look, Look::Points | Look::LineWithPoints) {
        marker(area, of.colour, ((x + end) / 2, y), colour)?;
    }
    Ok(())
}
