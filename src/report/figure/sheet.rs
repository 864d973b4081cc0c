//! Layout of a sheet: aligned panels under a common title, as SVG.

use super::panel;
use super::svg::Svg;
use super::words::{TITLE, escaped, line_height, wrapped};
use super::{Figure, PIXELS_PER_INCH, Sheet};
use crate::error::Error;

/// Default width and height of a panel, pixels, without title and legend.
const PANEL: (f64, f64) = (680.0, 420.0);

/// Minimum width and height of a panel, pixels, without title and legend.
const LEAST_PANEL: (f64, f64) = (150.0, 100.0);

/// Pixels per millimetre.
const PER_MM: f64 = PIXELS_PER_INCH / 25.4;

impl Sheet<'_> {
    /// Returns the figures as SVG; equal figures give equal texts.
    ///
    /// # Errors
    /// [`Error::Refused`] if the sheet is too small for the figures.
    pub fn svg(&self, figures: &[Figure]) -> Result<String, Error> {
        let columns = self.columns.clamp(1, figures.len().max(1));
        let across = columns as f64;
        let asked = self.size.map(|size| {
            let [width, height] = [size.width, size.height].map(|mm| (PER_MM * mm).round());
            (width, height)
        });
        let width = asked.map_or(PANEL.0, |(width, _)| (width / across).floor());
        let head = wrapped(self.title, TITLE, width * across - 40.0);
        let above = match head.len() {
            0 => 0.0,
            lines => line_height(TITLE) * lines as f64 + 14.0,
        };
        let texts = figures.chunks(columns).map(|row| {
            let heights = row.iter().map(|one| panel::height_of_texts(one, width));
            heights.fold(0.0, f64::max).ceil()
        });
        let texts: Vec<f64> = texts.collect();
        let fixed = (above + texts.iter().sum::<f64>()).ceil();
        let rows = texts.len().max(1) as f64;
        let inner = asked.map_or(PANEL.1, |(_, height)| ((height - fixed) / rows).floor());
        if width < LEAST_PANEL.0 || inner < LEAST_PANEL.1 {
            let least = [LEAST_PANEL.0 * across, LEAST_PANEL.1 * rows + fixed];
            let [width, height] = least.map(|pixels| (pixels / PER_MM).ceil());
            return Err(Error::refused(
                format!("the picture is too small for {} panels", figures.len()),
                format!("a size of at least {width} x {height} mm, or fewer columns"),
            ));
        }
        // One width for all panels aligns their axes.
        let y_areas = figures.iter().map(|one| panel::y_area(one, inner));
        let y_area = y_areas.fold(0.0, f64::max);
        let mut svg = Svg::default();
        svg.lines((0.5 * width * across, 8.0), TITLE, &head);
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
        let size = match self.size {
            Some(size) => format!("width=\"{}mm\" height=\"{}mm\"", size.width, size.height),
            None => format!("width=\"{wide}\" height=\"{high}\""),
        };
        let (title, shown) = (escaped(self.title), escaped(&described(figures)));
        Ok(format!(
            "<svg {size} viewBox=\"0 0 {wide} {high}\" role=\"img\" font-family=\"sans-serif\" stroke-linejoin=\"round\" \
             xmlns=\"http://www.w3.org/2000/svg\">\n<title>{title}</title>\n<desc>{shown}</desc>\n\
             <rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n{}</svg>\n",
            svg.0
        ))
    }
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
