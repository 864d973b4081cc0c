//! Detection of dips of a function between places where its values are known, by the parabola through three of them.

/// Whether a function with these values at three places in order may fall below zero between them although the values
/// do not.
///
/// True if the parabola through the three points has its lowest point between the outer ones and near zero. At the
/// nearest place the parabola lies above that point by at most a quarter of its sag: a lowest value of less than half
/// of the least of the three is always near.
pub fn may_dip(x: [f64; 3], y: [f64; 3]) -> bool {
    let slopes = [(y[1] - y[0]) / (x[1] - x[0]), (y[2] - y[1]) / (x[2] - x[1])];
    let bend = (slopes[1] - slopes[0]) / (x[2] - x[0]);
    if bend <= 0.0 {
        return false;
    }
    // The parabola: y0 + s0 (x − x0) + bend (x − x0)(x − x1).
    let lowest = 0.5 * (x[0] + x[1]) - 0.5 * slopes[0] / bend;
    if lowest <= x[0] || lowest >= x[2] {
        return false;
    }
    let (from, on) = (lowest - x[0], lowest - x[1]);
    let gap = (x[1] - x[0]).max(x[2] - x[1]);
    // Part of the sag over the wider gap below which the lowest value is near zero.
    let near = 0.25;
    y[0] + from * (slopes[0] + bend * on) < near * bend * gap * gap
}
