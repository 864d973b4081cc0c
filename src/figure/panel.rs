//! Layout and drawing of one panel: title, axes with ticks, series, legend.

use super::axis::{Scale, Tick};
use super::clip::{Place, inside, pieces};
use super::layout::LAYOUT;
use super::svg::Svg;
use super::words::{fitted, line_height, width, wrapped};
use super::{Figure, Series, SeriesStyle};

/// Entry of the legend: label, cut to fit, and its series.
type Entry<'f> = (String, Vec<&'f Series>);

fn entry_width(label: &str) -> f64 {
    LAYOUT.sample + width(label, LAYOUT.text) + LAYOUT.entry_gap
}

/// Returns the height of a legend of this many rows, pixels.
fn legend_height(rows: usize) -> f64 {
    rows as f64 * (line_height(LAYOUT.text) + 4.0)
}

/// Returns the width of a panel of width `room` between its edges, pixels.
fn inner_width(room: f64) -> f64 {
    room - 2.0 * LAYOUT.edge_space
}

/// Returns the entries of the legend, in rows that fit into the width `room`, pixels.
fn legend(figure: &Figure, room: f64) -> Vec<Vec<Entry<'_>>> {
    let mut entries: Vec<Entry> = Vec::new();
    let labelled = |series: &&Series| !series.label.is_empty() && !series.points.is_empty();
    for series in figure.series.iter().filter(labelled) {
        let known = |(_, of): &&mut Entry| of[0].label == series.label;
        match entries.iter_mut().find(known) {
            Some((_, of)) => of.push(series),
            None => {
                let room = inner_width(room) - LAYOUT.sample - LAYOUT.entry_gap;
                let label = fitted(&series.label, room);
                entries.push((label, vec![series]));
            }
        }
    }
    let mut rows: Vec<Vec<Entry>> = Vec::new();
    let mut left = 0.0;
    for entry in entries {
        let needed = entry_width(&entry.0);
        match rows.last_mut() {
            Some(row) if needed <= left => row.push(entry),
            _ => {
                left = inner_width(room);
                rows.push(vec![entry]);
            }
        }
        left -= needed;
    }
    rows
}

fn title(figure: &Figure, room: f64) -> Vec<String> {
    wrapped(&figure.title, LAYOUT.title, inner_width(room))
}

/// Returns the height that title and legend add to a panel of width `room`, pixels.
pub(super) fn height_of_texts(figure: &Figure, room: f64) -> f64 {
    let lines = title(figure, room).len() as f64;
    lines * line_height(LAYOUT.title) + legend_height(legend(figure, room).len())
}

/// Returns the height of label and ticks of the x axis, pixels.
fn x_area(figure: &Figure) -> f64 {
    let lines = if figure.x.label.is_empty() { 1.0 } else { 2.0 };
    lines * line_height(LAYOUT.text) + 20.0
}

fn widest(ticks: &[Tick]) -> f64 {
    let widths = ticks.iter().map(|tick| width(&tick.label, LAYOUT.text));
    widths.fold(0.0, f64::max)
}

fn y_ticks(scale: &Scale, figure: &Figure, height: f64) -> Vec<Tick> {
    scale.ticks(((height - x_area(figure)) / LAYOUT.tick_distance).max(2.0) as usize)
}

fn y_scale(figure: &Figure) -> Scale {
    Scale::new(&figure.y, figure.values(|(_, low, high)| [low, high]))
}

/// Returns the width of label and ticks of the y axis, in a panel of `height`, pixels.
pub(super) fn y_area(figure: &Figure, height: f64) -> f64 {
    widest(&y_ticks(&y_scale(figure), figure, height)) + line_height(LAYOUT.text) + 22.0
}

/// Draws a panel: upper left corner, width and height with texts, and width `y_area` of the y axis, pixels.
pub(super) fn panel(
    svg: &mut Svg,
    figure: &Figure,
    (left, top): Place,
    (room, height): Place,
    y_area: f64,
) {
    let titles = title(figure, room);
    let edge = LAYOUT.edge_space;
    svg.lines((left + 0.5 * room, top + edge), LAYOUT.title, &titles);
    let legend = legend(figure, room);
    let mut y = top + height - 0.5 * edge - legend_height(legend.len());
    let high = top + edge + titles.len() as f64 * line_height(LAYOUT.title) + 6.0;
    let corner = (left + edge + y_area, high);
    let size = (
        room - y_area - edge - LAYOUT.right_space,
        y - high - x_area(figure),
    );
    axes(svg, figure, corner, size, y_area);
    for row in legend {
        let needed: f64 = row.iter().map(|(label, _)| entry_width(label)).sum();
        let mut x = left + 0.5 * (room - needed);
        y += 0.5 * legend_height(1);
        for (label, of) in row {
            of.iter().for_each(|series| svg.sample((x, y), series));
            let begin = (x + LAYOUT.sample + LAYOUT.sample_gap, y);
            svg.text(begin, "start", LAYOUT.text, 0.0, &label);
            x += entry_width(&label);
        }
        y += 0.5 * legend_height(1);
    }
}

/// Draws axes and series: upper left corner, width and height of the area between the axes, pixels.
fn axes(svg: &mut Svg, figure: &Figure, (left, high): Place, (long, tall): Place, y_area: f64) {
    let mut x = Scale::new(&figure.x, figure.values(|(x, _, _)| [x, x]));
    let mut y = y_scale(figure);
    if figure.is_equal {
        let per_pixel = (x.length() / long).max(y.length() / tall);
        x.lengthen(per_pixel * long);
        y.lengthen(per_pixel * tall);
    }
    let (right, low) = (left + long, high + tall);
    let place = |(u, v): Place| (left + u * long, low - v * tall);
    // The largest number of ticks whose labels fit.
    let fits =
        |ticks: &Vec<Tick>| ticks.len() as f64 * (widest(ticks) + LAYOUT.tick_label_gap) <= long;
    let mut fewer = (2..=10).rev().map(|most| x.ticks(most));
    for tick in fewer.find(fits).unwrap_or_default() {
        let (x, _) = place((tick.at, 0.0));
        svg.segment((x, low), (x, high), "#DEDEDE");
        svg.segment((x, low), (x, low + LAYOUT.tick), "black");
        svg.text((x, low + 14.0), "middle", LAYOUT.text, 0.0, &tick.label);
    }
    for tick in y_ticks(&y, figure, tall + x_area(figure)) {
        let (_, y) = place((0.0, tick.at));
        svg.segment((left, y), (right, y), "#DEDEDE");
        svg.segment((left - LAYOUT.tick, y), (left, y), "black");
        svg.text((left - 9.0, y), "end", LAYOUT.text, 0.0, &tick.label);
    }
    svg.segment((left, low), (right, low), "black");
    svg.segment((left, low), (left, high), "black");
    let middle = place((0.5, 0.5));
    if !figure.x.label.is_empty() {
        let label = figure.x.label_within(long + LAYOUT.right_space);
        svg.text((middle.0, low + 34.0), "middle", LAYOUT.text, 0.0, &label);
    }
    if !figure.y.label.is_empty() {
        let label = figure.y.label_within(tall);
        let x = left - y_area + 0.5 * line_height(LAYOUT.text);
        svg.text((x, middle.1), "middle", LAYOUT.text, -90.0, &label);
    }
    if figure.values(|(_, low, high)| [low, high]).all(f64::is_nan) {
        svg.text(middle, "middle", LAYOUT.text, 0.0, "nothing to show");
    }
    // Bands lie under lines, lines under points.
    for layer in 0..3 {
        for series in &figure.series {
            draw(svg, layer, series, &x, &y, place);
        }
    }
}

/// Draws the part of a series in a layer: 0 bands and marks, 1 lines, 2 points.
fn draw(
    svg: &mut Svg,
    layer: u32,
    series: &Series,
    x: &Scale,
    y: &Scale,
    place: impl Fn(Place) -> Place,
) {
    let points = series.points.iter();
    let positions = points.map(|&(a, b, _)| (x.position(a), y.position(b)));
    match (layer, series.style) {
        (0, SeriesStyle::Band) => {
            let points = series.points.iter();
            let edges =
                points.map(|&(a, low, high)| (x.position(a), y.clamped(low), y.clamped(high)));
            let edges: Vec<_> = edges.collect();
            let seen =
                |&(x, low, high): &(f64, f64, f64)| inside((x, 0.0)) && (low + high).is_finite();
            for run in edges.split(|edge| !seen(edge)).filter(|run| run.len() > 1) {
                let low = run.iter().map(|&(x, low, _)| place((x, low)));
                let high = run.iter().rev().map(|&(x, _, high)| place((x, high)));
                svg.band(low.chain(high).collect(), series.colour());
            }
        }
        (0, SeriesStyle::VerticalMark) => {
            let marks = positions.map(|(x, _)| x).filter(|x| inside((*x, 0.0)));
            marks.for_each(|x| svg.curve([place((x, 0.0)), place((x, 1.0))], series));
        }
        (1, SeriesStyle::Line | SeriesStyle::Dashed | SeriesStyle::LineWithPoints) => {
            for piece in pieces(&positions.collect::<Vec<_>>()) {
                match piece[..] {
                    // A line through one point cannot be seen.
                    [only] => svg.marker(place(only), series),
                    _ => svg.curve(piece.into_iter().map(&place), series),
                }
            }
        }
        (2, SeriesStyle::Points | SeriesStyle::LineWithPoints) => positions
            .filter(|at| inside(*at))
            .for_each(|at| svg.marker(place(at), series)),
        _ => {}
    }
}
