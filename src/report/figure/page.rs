//! The sheet: panels under a common title, and text on it.

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::Figure;
use super::draw;
use crate::error::Error;

/// The library draws on whole pixels. It is given this many for each pixel of the figure, so that curves
/// are smooth.
pub(super) const FINE: i32 = 8;

/// Width and height of a panel, pixels. The legend is added to the height.
const PANEL: (i32, i32) = (680, 420);

/// Free space at the edges, pixels.
pub(super) const EDGE: i32 = 10;

/// Sizes of the fonts, pixels.
pub(super) const TITLE: i32 = 17;
pub(super) const TEXT: i32 = 13;

pub(super) type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
pub(super) type Failure<'a> = DrawingAreaErrorKind<<SVGBackend<'a> as DrawingBackend>::ErrorType>;

pub(super) fn svg(title: &str, figures: &[Figure], columns: usize) -> Result<String, Error> {
    let columns = columns.min(figures.len()).max(1) as i32;
    let width = PANEL.0 * columns;
    let head = wrapped(title, TITLE, width - 40);
    let mut top = if head.is_empty() {
        0
    } else {
        line_height(TITLE) * head.len() as i32 + 14
    };
    let mut places = Vec::new();
    for row in figures.chunks(columns as usize) {
        let inner = |figure: &Figure| PANEL.1 + draw::height_of_texts(figure, PANEL.0);
        let height = row.iter().map(inner).max().unwrap_or(PANEL.1);
        for (column, figure) in row.iter().enumerate() {
            places.push((figure, column as i32 * PANEL.0, top, height));
        }
        top += height;
    }
    let size = (width, top.max(1));
    let mut text = String::new();
    on_sheet(&mut text, size, &head, &places).map_err(|error| Error::Write {
        target: "figure".to_owned(),
        source: std::io::Error::other(error),
    })?;
    // The figure has its size in pixels; the fine grid stays inside the view box.
    let fine = format!("width=\"{}\" height=\"{}\"", size.0 * FINE, size.1 * FINE);
    let plain = format!("width=\"{}\" height=\"{}\"", size.0, size.1);
    Ok(text.replacen(&fine, &plain, 1))
}

fn on_sheet(
    text: &mut String,
    size: (i32, i32),
    head: &[String],
    places: &[(&Figure, i32, i32, i32)],
) -> Result<(), String> {
    let fine = ((size.0 * FINE) as u32, (size.1 * FINE) as u32);
    let sheet = SVGBackend::with_string(text, fine).into_drawing_area();
    let draw = || -> Result<(), Failure<'_>> {
        sheet.fill(&WHITE)?;
        write_lines(&sheet, head, TITLE, (size.0 / 2, 8))?;
        for (figure, left, top, height) in places {
            let area = sheet
                .clone()
                .shrink((left * FINE, top * FINE), (PANEL.0 * FINE, height * FINE));
            draw::panel(&area, figure, (PANEL.0, *height))?;
        }
        sheet.present()
    };
    draw().map_err(|error| error.to_string())
}

/// Writes lines below each other, centred at a place given in pixels.
pub(super) fn write_lines<'a>(
    area: &Area<'a>,
    lines: &[String],
    size: i32,
    (x, mut y): (i32, i32),
) -> Result<(), Failure<'a>> {
    let style = font(size).pos(Pos::new(HPos::Center, VPos::Top));
    for line in lines {
        area.draw(&Text::new(
            line.clone(),
            (x * FINE, y * FINE),
            style.clone(),
        ))?;
        y += line_height(size);
    }
    Ok(())
}

/// Text of a size in pixels; the library makes it smaller by 1.24.
pub(super) fn font(size: i32) -> TextStyle<'static> {
    TextStyle::from(("sans-serif", f64::from(size * FINE) * 1.24)).color(&BLACK)
}

pub(super) fn line_height(size: i32) -> i32 {
    size * 5 / 4
}

/// Width of a text in pixels, rather too wide than too narrow: the fonts of the reader are not known.
pub(super) fn text_width(text: &str, size: i32) -> i32 {
    let ems: f64 = text
        .chars()
        .map(|c| match c {
            'i' | 'j' | 'l' | '.' | ',' | ':' | ';' | '\'' | '|' | '!' | ' ' => 0.36,
            'm' | 'w' | 'M' | 'W' | '@' | '%' => 1.0,
            c if c.is_uppercase() => 0.75,
            c if c.is_ascii() => 0.64,
            _ => 1.0,
        })
        .sum();
    (ems * f64::from(size)).ceil() as i32
}

/// A text broken between words so that its lines fit; a longer word is cut. Control characters become
/// spaces, as XML has none.
pub(super) fn wrapped(text: &str, size: i32, width: i32) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split(|c: char| c.is_whitespace() || c.is_control()) {
        let mut word = word.to_owned();
        while text_width(&word, size) > width {
            word.pop();
        }
        match lines.last_mut() {
            _ if word.is_empty() => (),
            Some(line) if text_width(&format!("{line} {word}"), size) <= width => {
                line.push(' ');
                line.push_str(&word);
            }
            _ => lines.push(word),
        }
    }
    lines
}

/// As much of a label as fits in one line.
pub(super) fn fitted(label: &str, width: i32) -> String {
    let mut lines = wrapped(label, TEXT, width).into_iter();
    lines.next().unwrap_or_default()
}
