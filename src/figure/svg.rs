//! SVG writer: text, lines, bands and markers, distinguishable for colour-blind readers and in grey.

use std::fmt::Write;

use super::clip::Place;
use super::layout::LAYOUT;
use super::words::{escaped, line_height};
use super::{Series, SeriesStyle};

/// Palette of Okabe and Ito without yellow, which is hard to see on white; dark colours first.
const COLOURS: [&str; 7] = [
    "#0072B2", "#D55E00", "#009E73", "#CC79A7", "#000000", "#E69F00", "#56B4E9",
];

/// Colour of vertical marks.
const GREY: &str = "#6E6E6E";

/// Corners of the markers, in units of their radius; a circle if empty. The numbers of markers and colours are coprime,
/// which makes many series differ in one or the other.
const SHAPES: [&[Place]; 5] = [
    &[],
    &[(-0.9, -0.9), (0.9, -0.9), (0.9, 0.9), (-0.9, 0.9)],
    &[(0.0, -1.2), (1.1, 0.8), (-1.1, 0.8)],
    &[(0.0, -1.3), (1.3, 0.0), (0.0, 1.3), (-1.3, 0.0)],
    &[(0.0, 1.2), (1.1, -0.8), (-1.1, -0.8)],
];

/// Dash patterns, pixels: lines use them in order, dashed series from the last back to the second.
const STROKES: [&str; 4] = ["none", "15 4", "3 3", "7 4"];

/// SVG elements written so far; coordinates in pixels.
#[derive(Default)]
pub(super) struct Svg(pub String);

impl Svg {
    /// Writes a line of text, rotated `turn` degrees clockwise about its anchor point.
    pub fn text(&mut self, (x, y): Place, anchor: &str, size: f64, turn: f64, words: &str) {
        let turned = match turn {
            0.0 => String::new(),
            turn => format!(" transform=\"rotate({turn} {x:.2} {y:.2})\""),
        };
        let (base, words) = (y + 0.35 * size, escaped(words));
        let _ = writeln!(
            self.0,
            "<text x=\"{x:.2}\" y=\"{base:.2}\" font-size=\"{size}\" text-anchor=\"{anchor}\"{turned}>{words}</text>"
        );
    }

    /// Writes centred lines of text, from the height `top` downwards.
    pub fn lines(&mut self, (x, top): Place, size: f64, lines: &[String]) {
        for (line, k) in lines.iter().zip(0..) {
            let y = top + (f64::from(k) + 0.5) * line_height(size);
            self.text((x, y), "middle", size, 0.0, line);
        }
    }

    fn shape(&mut self, kind: &str, places: impl IntoIterator<Item = Place>, look: &str) {
        let _ = write!(self.0, "<{kind} points=\"");
        // Curves have many points; this buffer is faster than the formatter.
        let mut buffer = zmij::Buffer::new();
        let mut put = |value: f64, end: char| {
            self.0
                .push_str(buffer.format((100.0 * value).round() / 100.0));
            self.0.push(end);
        };
        for (x, y) in places {
            put(x, ',');
            put(y, ' ');
        }
        let _ = writeln!(self.0, "\" {look}/>");
    }

    pub fn segment(&mut self, (x1, y1): Place, (x2, y2): Place, colour: &str) {
        let _ = writeln!(
            self.0,
            "<path d=\"M{x1:.2} {y1:.2}L{x2:.2} {y2:.2}\" stroke=\"{colour}\"/>"
        );
    }

    pub fn band(&mut self, corners: Vec<Place>, colour: &str) {
        let look = format!("fill=\"{colour}\" fill-opacity=\"0.25\"");
        self.shape("polygon", corners, &look);
    }

    pub fn curve(&mut self, places: impl IntoIterator<Item = Place>, series: &Series) {
        let dashes = match series.style {
            SeriesStyle::Dashed => STROKES[STROKES.len() - 1 - series.stroke % (STROKES.len() - 1)],
            SeriesStyle::VerticalMark => STROKES[STROKES.len() - 1],
            SeriesStyle::Line => STROKES[series.stroke % STROKES.len()],
            _ => STROKES[0],
        };
        let colour = series.colour();
        let look = format!(
            "fill=\"none\" stroke=\"{colour}\" stroke-width=\"1.7\" stroke-dasharray=\"{dashes}\""
        );
        self.shape("polyline", places, &look);
    }

    pub fn marker(&mut self, (x, y): Place, series: &Series) {
        let radius = LAYOUT.marker_radius;
        let fill = format!("fill=\"{}\"", series.colour());
        match SHAPES[series.colour % SHAPES.len()] {
            [] => {
                let _ = writeln!(
                    self.0,
                    "<circle cx=\"{x:.2}\" cy=\"{y:.2}\" r=\"{radius}\" {fill}/>"
                );
            }
            corners => {
                let places = corners.iter();
                let places = places.map(|(right, down)| (x + radius * right, y + radius * down));
                self.shape("polygon", places, &fill);
            }
        }
    }

    /// Draws the sample of a series in the legend.
    pub fn sample(&mut self, (x, y): Place, series: &Series) {
        let (middle, end) = ((x + 0.5 * LAYOUT.sample, y), x + LAYOUT.sample);
        match series.style {
            SeriesStyle::Band => {
                let (low, high) = (y + 5.0, y - 5.0);
                let corners = vec![(x, high), (end, high), (end, low), (x, low)];
                self.band(corners, series.colour());
            }
            SeriesStyle::Points => self.marker(middle, series),
            look => {
                self.curve([(x, y), (end, y)], series);
                if look == SeriesStyle::LineWithPoints {
                    self.marker(middle, series);
                }
            }
        }
    }
}

impl Series {
    pub(super) fn colour(&self) -> &'static str {
        match self.style {
            SeriesStyle::VerticalMark => GREY,
            _ => COLOURS[self.colour % COLOURS.len()],
        }
    }
}
