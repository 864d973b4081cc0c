//! Layout of a sheet: aligned panels under a common title, as SVG.

use super::layout::LAYOUT;
use super::panel;
use super::svg::Svg;
use super::words::{escaped, line_height, wrapped};
use super::{Figure, PIXELS_PER_INCH, Shape};
use crate::error::Error;

/// Returns figures as SVG, in rows of `columns` figures (0 counts as 1), under a common title; equal figures give equal
/// texts. By default each figure has its usual size; refused if the size is too small for the figures.
pub fn sheet(
    title: &str,
    columns: usize,
    size: Option<Shape>,
    figures: &[Figure],
) -> Result<String, Error> {
    let columns = columns.clamp(1, figures.len().max(1));
    let across = columns as f64;
    let pixels_per_mm = PIXELS_PER_INCH / 25.4;
    let asked = size.map(|size| {
        let pixels = |mm: f64| (pixels_per_mm * mm).round();
        (pixels(size.width), pixels(size.height))
    });
    let (panel, least) = (LAYOUT.panel, LAYOUT.least_panel);
    let width = asked.map_or(panel.0, |(width, _)| (width / across).floor());
    let head = wrapped(title, LAYOUT.title, width * across - 40.0);
    let above = match head.len() {
        0 => 0.0,
        lines => line_height(LAYOUT.title) * lines as f64 + 14.0,
    };
    let texts = figures.chunks(columns).map(|row| {
        let heights = row.iter().map(|one| panel::height_of_texts(one, width));
        heights.fold(0.0, f64::max).ceil()
    });
    let texts: Vec<f64> = texts.collect();
    let fixed = (above + texts.iter().sum::<f64>()).ceil();
    let rows = texts.len().max(1) as f64;
    let inner = asked.map_or(panel.1, |(_, height)| ((height - fixed) / rows).floor());
    if width < least.0 || inner < least.1 {
        let least = [least.0 * across, least.1 * rows + fixed];
        let [width, height] = least.map(|pixels| (pixels / pixels_per_mm).ceil());
        return Err(Error::refused(
            format!("the picture is too small for {} panels", figures.len()),
            format!("a size of at least {width} x {height} mm, or fewer columns"),
        ));
    }
    // One width for all panels aligns their axes.
    let y_areas = figures.iter().map(|one| panel::y_area(one, inner));
    let y_area = y_areas.fold(0.0, f64::max);
    let mut svg = Svg::default();
    svg.lines((0.5 * width * across, 8.0), LAYOUT.title, &head);
    let mut top = above;
    for (row, texts) in figures.chunks(columns).zip(&texts) {
        let size = (width, inner + texts);
        for (figure, column) in row.iter().zip(0..) {
            let corner = (f64::from(column) * width, top);
            panel::panel(&mut svg, figure, corner, size, y_area);
        }
        top += size.1;
    }
    let (wide, high) = (width * across, top.ceil().max(1.0));
    let size = match size {
        Some(size) => format!("width=\"{}mm\" height=\"{}mm\"", size.width, size.height),
        None => format!("width=\"{wide}\" height=\"{high}\""),
    };
    let (title, shown) = (escaped(title), escaped(&described(figures)));
    Ok(format!(
        "<svg {size} viewBox=\"0 0 {wide} {high}\" role=\"img\" font-family=\"sans-serif\" stroke-linejoin=\"round\" \
         xmlns=\"http://www.w3.org/2000/svg\">\n<title>{title}</title>\n<desc>{shown}</desc>\n\
         <rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n{}</svg>\n",
        svg.0
    ))
}

/// Returns the description of the sheet for screen readers.
fn described(figures: &[Figure]) -> String {
    let shown = figures.iter().map(|figure| {
        let titled = if figure.title.is_empty() { "" } else { ": " };
        let (x, y) = (&figure.x.label, &figure.y.label);
        format!("{}{titled}{y} over {x}", figure.title)
    });
    shown.collect::<Vec<_>>().join("; ")
}
