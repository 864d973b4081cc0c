//! The sheet: panels under a common title, and text on it.

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::draw;
use super::{Figure, Sheet};
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

/// A figure and where it stands, pixels.
struct Place<'a> {
    figure: &'a Figure,
    left: i32,
    top: i32,
    width: i32,
    height: i32,
    /// Room for the ticks and the label of the y axis, alike for all, so that the panels are aligned.
    y_area: i32,
}

/// Least width and height of the area between the axes with its ticks, pixels.
const LEAST: (i32, i32) = (150, 100);

/// Pixels to the millimetre: 96 to the inch.
const PER_MM: f64 = 96.0 / 25.4;

pub(super) fn svg(sheet: &Sheet, figures: &[Figure]) -> Result<String, Error> {
    let columns = sheet.columns.clamp(1, figures.len().max(1));
    let asked = sheet.size.map(|size| {
        let [width, height] = [size.width, size.height].map(|mm| (PER_MM * mm).round() as i32);
        (width, height)
    });
    let width = asked.map_or(PANEL.0, |(width, _)| width / columns as i32);
    let head = wrapped(sheet.title, TITLE, width * columns as i32 - 40);
    let above = if head.is_empty() {
        0
    } else {
        line_height(TITLE) * head.len() as i32 + 14
    };
    let texts: Vec<i32> = figures
        .chunks(columns)
        .map(|row| {
            row.iter()
                .map(|figure| draw::height_of_texts(figure, width))
                .max()
        })
        .map(Option::unwrap_or_default)
        .collect();
    let rows = texts.len().max(1) as i32;
    let inner = asked.map_or(PANEL.1, |(_, height)| {
        (height - above - texts.iter().sum::<i32>()) / rows
    });
    if width < LEAST.0 || inner < LEAST.1 {
        let [least_width, least_height] = [
            LEAST.0 * columns as i32,
            LEAST.1 * rows + above + texts.iter().sum::<i32>(),
        ]
        .map(|pixels| (f64::from(pixels) / PER_MM).ceil());
        return Err(Error::refused(
            format!("the picture is too small for {} panels", figures.len()),
            format!("a size of at least {least_width} x {least_height} mm, or fewer columns"),
        ));
    }
    let y_area = figures
        .iter()
        .map(|figure| draw::y_area(figure, inner))
        .max();
    let mut places = Vec::new();
    let mut top = above;
    for (row, texts) in figures.chunks(columns).zip(&texts) {
        let height = inner + texts;
        for (column, figure) in row.iter().enumerate() {
            places.push(Place {
                figure,
                left: column as i32 * width,
                top,
                width,
                height,
                y_area: y_area.unwrap_or(0),
            });
        }
        top += height;
    }
    let size = (width * columns as i32, top.max(1));
    let mut text = String::new();
    on_sheet(&mut text, size, &head, &places).map_err(|error| Error::Write {
        target: "figure".to_owned(),
        source: std::io::Error::other(error),
    })?;
    // The figure has its size in pixels or millimetres; the fine grid stays inside the view box.
    let fine = format!("width=\"{}\" height=\"{}\"", size.0 * FINE, size.1 * FINE);
    let plain = match sheet.size {
        Some(size) => format!("width=\"{}mm\" height=\"{}mm\"", size.width, size.height),
        None => format!("width=\"{}\" height=\"{}\"", size.0, size.1),
    };
    let text = text.replacen(&fine, &format!("{plain} role=\"img\""), 1);
    Ok(text.replacen('>', &format!(">\n{}", description(sheet, figures)), 1))
}

/// What screen readers say of the sheet.
fn description(sheet: &Sheet, figures: &[Figure]) -> String {
    let shown = figures.iter().map(|figure| {
        let titled = if figure.title.is_empty() { "" } else { ": " };
        let (x, y) = (&figure.x.label, &figure.y.label);
        format!("{}{titled}{y} over {x}", figure.title)
    });
    let shown = shown.collect::<Vec<_>>().join("; ");
    let (title, shown) = (escaped(sheet.title), escaped(&shown));
    format!("<title>{title}</title>\n<desc>{shown}</desc>")
}

/// A text in XML, without control characters, as it has none.
pub(in crate::report) fn escaped(text: &str) -> String {
    let plain: String = text.chars().filter(|c| !c.is_control()).collect();
    let text = plain.replace('&', "&amp;");
    text.replace('<', "&lt;").replace('>', "&gt;")
}

fn on_sheet(
    text: &mut String,
    size: (i32, i32),
    head: &[String],
    places: &[Place<'_>],
) -> Result<(), String> {
    let fine = ((size.0 * FINE) as u32, (size.1 * FINE) as u32);
    let sheet = SVGBackend::with_string(text, fine).into_drawing_area();
    let draw = || -> Result<(), Failure<'_>> {
        sheet.fill(&WHITE)?;
        write_lines(&sheet, head, TITLE, (size.0 / 2, 8))?;
        for place in places {
            let [left, top, width, height] =
                [place.left, place.top, place.width, place.height].map(|pixels| pixels * FINE);
            let area = sheet.clone().shrink((left, top), (width, height));
            draw::panel(
                &area,
                place.figure,
                (place.width, place.height),
                place.y_area,
            )?;
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

pub(super) const fn line_height(size: i32) -> i32 {
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
        while !word.is_empty() && text_width(&word, size) > width {
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
