//! Colours and markers of series, told apart by colour-blind readers and in grey.

use plotters::element::DashedPathElement;
use plotters::prelude::*;

use super::page::{Area, FINE, Failure};
use super::{Look, Numbered};

/// Okabe and Ito's colours without yellow, which is hard to see on white; dark ones first.
const COLOURS: [RGBColor; 7] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(0, 0, 0),
    RGBColor(230, 159, 0),
    RGBColor(86, 180, 233),
];

/// Colour of vertical marks.
const GREY: RGBColor = RGBColor(110, 110, 110);

/// Corners of the markers in units of their size; none: a circle. Their number and that of the colours
/// have no common factor, so that many series differ in one or the other.
const SHAPES: [&[(f64, f64)]; 5] = [
    &[],
    &[(-0.9, -0.9), (0.9, -0.9), (0.9, 0.9), (-0.9, 0.9)],
    &[(0.0, -1.2), (1.1, 0.8), (-1.1, 0.8)],
    &[(0.0, -1.3), (1.3, 0.0), (0.0, 1.3), (-1.3, 0.0)],
    &[(0.0, 1.2), (1.1, -0.8), (-1.1, -0.8)],
];

/// Radius of a marker, pixels.
const RADIUS: f64 = 3.2;

/// Length of dashes and of the gaps between them, pixels: of the lines of a panel one after the other, of its dashed
/// series from the last on.
const STROKES: [Option<(i32, i32)>; 4] = [None, Some((15, 4)), Some((3, 3)), Some((7, 4))];

/// A place on the fine grid.
pub(super) type Place = (i32, i32);

/// The colour of a series by its number.
pub(super) fn colour(look: Look, index: usize) -> RGBColor {
    match look {
        Look::VerticalMark => GREY,
        _ => COLOURS[index % COLOURS.len()],
    }
}

/// Dashes and gaps of the stroke of a series, pixels; none of a line that is drawn through.
pub(super) fn dashes(of: &Numbered) -> Option<(i32, i32)> {
    match of.series.look {
        Look::Dashed => STROKES[STROKES.len() - 1 - of.line % (STROKES.len() - 1)],
        Look::VerticalMark => STROKES[STROKES.len() - 1],
        Look::Line => STROKES[of.line % STROKES.len()],
        _ => None,
    }
}

pub(super) fn marker<'a>(
    area: &Area<'a>,
    index: usize,
    (x, y): Place,
    colour: RGBColor,
) -> Result<(), Failure<'a>> {
    let size = RADIUS * f64::from(FINE);
    let corners = SHAPES[index % SHAPES.len()];
    if corners.is_empty() {
        return area.draw(&Circle::new((x, y), size as i32, colour.filled()));
    }
    let corners = corners
        .iter()
        .map(|(right, down)| (x + (right * size) as i32, y + (down * size) as i32));
    area.draw(&Polygon::new(corners.collect::<Vec<_>>(), colour.filled()))
}

pub(super) fn path<'a>(
    area: &Area<'a>,
    places: Vec<Place>,
    colour: RGBColor,
    dashes: Option<(i32, i32)>,
) -> Result<(), Failure<'a>> {
    let stroke = colour.stroke_width((1.7 * f64::from(FINE)) as u32);
    match dashes {
        Some((dash, gap)) => {
            let (dash, gap) = (dash * FINE, gap * FINE);
            area.draw(&DashedPathElement::new(places, dash, gap, stroke))
        }
        None => area.draw(&PathElement::new(places, stroke)),
    }
}

pub(super) fn filled<'a>(
    area: &Area<'a>,
    corners: Vec<Place>,
    colour: RGBColor,
) -> Result<(), Failure<'a>> {
    area.draw(&Polygon::new(corners, colour.mix(0.25)))
}
