//! Hermite interpolation between two points: cubic by values and slopes, quintic by second derivatives as well.

/// Returns value and slope at t of the cubic that has values and slopes at two times.
pub fn cubic(times: [f64; 2], ends: [[f64; 2]; 2], t: f64) -> [f64; 2] {
    let h = times[1] - times[0];
    let s = (t - times[0]) / h;
    let [[p, u], [q, v]] = ends;
    let mean = (q - p) / h;
    let (c, d) = (3.0 * mean - 2.0 * u - v, u + v - 2.0 * mean);
    [
        p + h * s * (u + s * (c + s * d)),
        u + s * (2.0 * c + 3.0 * s * d),
    ]
}

/// Quintic Hermite interpolation over s in [0, 1], as the change from the start.
#[derive(Clone, Copy, Debug)]
pub struct Quintic([f64; 5]);

/// Returns value and slope at t of the quintic with values, slopes and second derivatives at two times.
pub fn between(times: [f64; 2], ends: [[f64; 3]; 2], t: f64) -> [f64; 2] {
    let h = times[1] - times[0];
    let [begin, end] = ends.map(|[_, slope, second]| [h * slope, 0.5 * h * h * second]);
    let change = Quintic::new(begin, end, ends[1][0] - ends[0][0]);
    let [change, rate, _] = change.at((t - times[0]) / h);
    [ends[0][0] + change, rate / h]
}

impl Quintic {
    /// Interpolates between ends with a rate and half a second derivative each; `apart` is the change between the ends.
    pub fn new([v0, c0]: [f64; 2], [v1, c1]: [f64; 2], apart: f64) -> Quintic {
        let rise = apart - v0 - c0;
        let slope = v1 - v0 - 2.0 * c0;
        let bend = 2.0 * (c1 - c0);
        Quintic([
            v0,
            c0,
            10.0 * rise - 4.0 * slope + 0.5 * bend,
            -15.0 * rise + 7.0 * slope - bend,
            6.0 * rise - 3.0 * slope + 0.5 * bend,
        ])
    }

    /// Returns the change from the start, and first and second derivative over s.
    pub fn at(&self, s: f64) -> [f64; 3] {
        let [v0, c0, k3, k4, k5] = self.0;
        [
            s * (v0 + s * (c0 + s * (k3 + s * (k4 + s * k5)))),
            v0 + s * (2.0 * c0 + s * (3.0 * k3 + s * (4.0 * k4 + s * 5.0 * k5))),
            2.0 * c0 + s * (6.0 * k3 + s * (12.0 * k4 + s * 20.0 * k5)),
        ]
    }
}
