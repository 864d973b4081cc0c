//! The legend below the axes.

use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::marks::{self, Place, marker, path};
use super::page::{Area, EDGE, FINE, Failure, TEXT, fitted, font, line_height, text_width};
use super::{Figure, Look, Series};

/// Width of the sample of a series, pixels.
const SAMPLE: i32 = 30;

/// Free space after an entry, pixels.
const GAP: i32 = 24;

/// Height of a row, pixels.
pub(super) fn row_height() -> i32 {
    line_height(TEXT) + 4
}

/// The legend: rows of entries that fit beside each other.
pub(super) struct Legend<'f> {
    pub(super) rows: Vec<Vec<(usize, Vec<&'f Series>, String)>>,
    width: i32,
}

impl<'f> Legend<'f> {
    pub(super) fn new(figure: &'f Figure, width: i32) -> Legend<'f> {
        let mut entries: Vec<(usize, Vec<&Series>, String)> = Vec::new();
        for (index, series) in figure.numbered() {
            let same =
                |(_, of, _): &&mut (usize, Vec<&Series>, String)| of[0].label == series.label;
            match entries.iter_mut().find(same) {
                _ if series.label.is_empty() => (),
                Some((_, of, _)) => of.push(series),
                None => {
                    let most = width - 2 * EDGE - SAMPLE - GAP;
                    entries.push((index, vec![series], fitted(&series.label, most)));
                }
            }
        }
        let mut rows: Vec<Vec<_>> = Vec::new();
        let mut left = 0;
        for entry in entries {
            let needed = entry_width(&entry.2);
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
            let needed: i32 = row.iter().map(|(_, _, label)| entry_width(label)).sum();
            let mut x = (self.width - needed) / 2;
            let y = (y + row_height() / 2) * FINE;
            for (index, series, label) in row {
                for one in series {
                    sample(area, *index, one, (x * FINE, y))?;
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

fn sample<'a>(
    area: &Area<'a>,
    index: usize,
    series: &Series,
    (x, y): Place,
) -> Result<(), Failure<'a>> {
    let (colour, end, half) = (
        marks::colour(series.look, index),
        x + SAMPLE * FINE,
        5 * FINE,
    );
    if series.look == Look::Band {
        let corners = vec![
            (x, y - half),
            (end, y - half),
            (end, y + half),
            (x, y + half),
        ];
        return marks::filled(area, corners, colour);
    }
    if series.look != Look::Points {
        let dashed = matches!(series.look, Look::Dashed | Look::VerticalMark);
        path(area, vec![(x, y), (end, y)], colour, dashed)?;
    }
    if matches!(series.look, Look::Points | Look::LineWithPoints) {
        marker(area, index, ((x + end) / 2, y), colour)?;
    }
    Ok(())
}
