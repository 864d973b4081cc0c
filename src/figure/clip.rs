//! Clipping of polylines to the unit square, the area between the axes, by Liang and Barsky.

/// Point (x, y), in units of the axes or pixels.
pub(super) type Place = (f64, f64);

/// Relative rounding error of positions and ticks, far below a pixel.
pub(super) const POSITION_ROUNDING: f64 = 1e-9;

/// Whether a point lies in the unit square.
pub(super) fn inside((x, y): Place) -> bool {
    let range = -POSITION_ROUNDING..=1.0 + POSITION_ROUNDING;
    range.contains(&x) && range.contains(&y)
}

/// Returns the pieces of a polyline inside the unit square; a point that is not finite breaks the line.
pub(super) fn pieces(points: &[Place]) -> Vec<Vec<Place>> {
    let mut pieces: Vec<Vec<Place>> = Vec::new();
    for run in points.split(|(x, y)| !(x + y).is_finite()) {
        if let [only] = run {
            pieces.extend(inside(*only).then(|| vec![*only]));
        }
        // Whether the next segment continues the last piece.
        let mut open = false;
        for pair in run.windows(2) {
            let part = cut(pair[0], pair[1]);
            match (part, pieces.last_mut()) {
                (None, _) => {}
                (Some((_, end)), Some(piece)) if open => piece.push(end),
                (Some((begin, end)), _) => pieces.push(vec![begin, end]),
            }
            open = part.is_some() && inside(pair[1]);
        }
    }
    pieces
}

/// Returns the part of a segment inside the unit square (Liang and Barsky).
fn cut(a: Place, b: Place) -> Option<(Place, Place)> {
    if inside(a) && inside(b) {
        return Some((a, b));
    }
    let (mut from, mut to) = (0.0f64, 1.0f64);
    for (start, end) in [(a.0, b.0), (a.1, b.1)] {
        let change = end - start;
        if change == 0.0 {
            if !(0.0..=1.0).contains(&start) {
                return None;
            }
            continue;
        }
        let (first, second) = (-start / change, (1.0 - start) / change);
        from = from.max(first.min(second));
        to = to.min(first.max(second));
    }
    let at = |s: f64| (a.0 + s * (b.0 - a.0), a.1 + s * (b.1 - a.1));
    (from < to).then(|| (at(from), at(to)))
}
