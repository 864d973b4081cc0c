//! Random machines under narrow pulses, and their motion by an integration of its own: extrapolated midpoint steps (Gragg,
//! Bulirsch, Stoer) in pieces between the edges of the pulses, on each of which one formula holds.

use std::f64::consts::{PI, TAU};

/// Crank and rod, m, inertia of the crank, kg m², and mass of the slider, kg.
pub const MACHINE: [f64; 4] = [0.05, 0.15, 0.02, 0.6];

/// Numbers without pattern from a seed (splitmix64).
pub struct Chance(pub u64);

impl Chance {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let a = (self.0 ^ self.0 >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let b = (a ^ a >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        b ^ b >> 31
    }

    /// Between two numbers.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * (self.next() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Between two positive numbers, by order of magnitude.
    fn magnitude(&mut self, low: f64, high: f64) -> f64 {
        self.between(low.ln(), high.ln()).exp()
    }

    fn one_of<T: Copy>(&mut self, all: &[T]) -> T {
        all[(self.next() % all.len() as u64) as usize]
    }
}

/// What a pulse is a function of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Of {
    T,
    Theta,
    Omega,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    Gauss,
    Parabola,
    Tent,
    Box,
    Table,
}

/// A torque that is nothing but for a short while.
#[derive(Clone, Debug)]
pub struct Pulse {
    pub of: Of,
    pub shape: Shape,
    /// N m
    height: f64,
    centre: f64,
    /// Half of it is this wide.
    pub width: f64,
    /// Half turns, or a time, after which it comes again.
    pub half_turns: Option<u32>,
    period: Option<f64>,
}

impl Pulse {
    /// How far an argument is from the nearest of its centres.
    fn beside(&self, at: f64) -> f64 {
        match self.period {
            Some(period) => at - self.centre - period * ((at - self.centre) / period).round(),
            None => at - self.centre,
        }
    }

    /// Its edges beside its centre, in widths.
    fn edges(&self) -> &'static [f64] {
        match self.shape {
            Shape::Gauss => &[-6.0, -4.0, -2.0, -1.0, 0.0, 1.0, 2.0, 4.0, 6.0],
            Shape::Parabola | Shape::Box => &[-1.0, 1.0],
            Shape::Tent => &[-1.0, 0.0, 1.0],
            Shape::Table => &[-1.2, -1.0, 1.0, 1.2],
        }
    }

    /// The edges around an argument that goes forward or back, and the formula between them.
    fn piece(&self, at: f64, forward: bool) -> Piece {
        let nudge = (1e-9 * self.width).max(64.0 * f64::EPSILON * at.abs());
        let nudge = if forward { nudge } else { -nudge };
        let beside = self.beside(at + nudge);
        let origin = at + nudge - beside;
        let edges = self.edges();
        let index = edges.partition_point(|edge| edge * self.width <= beside);
        let ends = match self.period {
            Some(period) => {
                let (first, last) = (edges[0] * self.width, edges[edges.len() - 1] * self.width);
                [last - period, first + period]
            }
            None => [f64::NEG_INFINITY, f64::INFINITY],
        };
        let low = if index == 0 { ends[0] } else { edges[index - 1] * self.width };
        let high = edges.get(index).map_or(ends[1], |edge| edge * self.width);
        Piece {
            of: self.of,
            height: self.height,
            origin,
            width: self.width,
            // It begins at one of them, off by rounding.
            low: origin + low - nudge.max(0.0),
            high: origin + high - nudge.min(0.0),
            form: self.form(index, edges.len()),
        }
    }

    fn form(&self, index: usize, edges: usize) -> [f64; 3] {
        let outside = index == 0 || index == edges;
        match self.shape {
            Shape::Gauss => [f64::NAN; 3],
            _ if outside => [0.0; 3],
            Shape::Parabola => [1.0, 0.0, -1.0],
            Shape::Tent if index == 1 => [1.0, 1.0, 0.0],
            Shape::Tent => [1.0, -1.0, 0.0],
            Shape::Box => [1.0, 0.0, 0.0],
            Shape::Table if index == 1 => [6.0, 5.0, 0.0],
            Shape::Table if index == 2 => [1.0, 0.0, 0.0],
            Shape::Table => [6.0, -5.0, 0.0],
        }
    }

    /// Rows of its table, between two arguments at least.
    pub fn rows(&self, low: f64, high: f64) -> Vec<(f64, f64)> {
        let at = |edge: f64| self.centre + edge * self.width;
        let [first, last] = match self.period {
            Some(period) => [self.centre - 0.5 * period, self.centre + 0.5 * period],
            None => [low.min(at(-2.0)), high.max(at(2.0))],
        };
        let rows = [(-1.2, 0.0), (-1.0, self.height), (1.0, self.height), (1.2, 0.0)];
        let inner = rows.map(|(edge, value)| (at(edge), value));
        [&[(first, 0.0)], &inner[..], &[(last, 0.0)]].concat()
    }

    /// The period of its table.
    pub fn period(&self) -> Option<f64> {
        self.period
    }

    /// Its formula.
    pub fn formula(&self) -> String {
        let (centre, width) = (self.centre, self.width);
        let of = match self.of {
            Of::T => "t",
            Of::Theta => "theta",
            Of::Omega => "omega",
        };
        let beside = match (self.half_turns, self.period) {
            (Some(count), Some(period)) => {
                let half = 0.5 * period;
                let begin = centre - half;
                format!("(mod({of}-({begin:?}), {count}*pi)-{half:?})")
            }
            _ => format!("({of}-({centre:?}))"),
        };
        let shape = match self.shape {
            Shape::Gauss => format!("exp(-({beside}/{width:?})^2)"),
            Shape::Parabola => format!("max(0, 1-({beside}/{width:?})^2)"),
            Shape::Tent => format!("max(0, 1-abs({beside})/{width:?})"),
            Shape::Box | Shape::Table => {
                format!("step({beside}+{width:?})*step({width:?}-{beside})")
            }
        };
        format!("{:?}*{shape}", self.height)
    }
}

/// One formula of a pulse, between two edges.
struct Piece {
    of: Of,
    height: f64,
    origin: f64,
    width: f64,
    low: f64,
    high: f64,
    /// A polynomial of the distance from the centre in widths; none: the bell.
    form: [f64; 3],
}

impl Piece {
    fn of(&self, t: f64, [theta, omega]: [f64; 2]) -> f64 {
        match self.of {
            Of::T => t,
            Of::Theta => theta,
            Of::Omega => omega,
        }
    }

    fn value(&self, t: f64, state: [f64; 2]) -> f64 {
        let u = (self.of(t, state) - self.origin) / self.width;
        let [a, b, c] = self.form;
        self.height * if a.is_nan() { (-u * u).exp() } else { a + u * (b + u * c) }
    }

    /// How far beyond its edges the argument is, in widths; negative inside.
    fn beyond(&self, t: f64, state: [f64; 2]) -> f64 {
        let at = self.of(t, state);
        (self.low - at).max(at - self.high) / self.width
    }
}

/// A run of the machine.
#[derive(Clone, Debug)]
pub struct Case {
    pub pulses: Vec<Pulse>,
    /// N m
    pub torque: f64,
    /// N m s/rad
    pub viscous: f64,
    /// rad
    pub angle: f64,
    /// rad/s
    pub speed: f64,
    /// s
    pub duration: f64,
}

impl Case {
    /// A random one.
    pub fn random(chance: &mut Chance) -> Case {
        let speed = chance.magnitude(5.0, 100.0);
        let angle = chance.between(0.0, TAU);
        let turns = chance.between(1.0, 8.0);
        let duration = turns * TAU / speed;
        let energy = 0.5 * MACHINE[2] * speed * speed;
        let mut case = Case {
            pulses: Vec::new(),
            torque: chance.between(-0.15, 0.4) * energy / (turns * TAU),
            viscous: chance.between(0.0, 0.1) * MACHINE[2] / duration,
            angle,
            speed,
            duration,
        };
        for _ in 0..1 + chance.next() % 5 {
            let pulse = case.pulse(chance, turns, energy);
            case.pulses.push(pulse);
        }
        case
    }

    fn pulse(&self, chance: &mut Chance, turns: f64, energy: f64) -> Pulse {
        let of = chance.one_of(&[Of::T, Of::Theta, Of::Omega]);
        let shapes = [Shape::Gauss, Shape::Parabola, Shape::Tent, Shape::Box, Shape::Table];
        let shape = chance.one_of(&shapes);
        let share = chance.between(0.02, 0.3) * chance.one_of(&[1.0, 1.0, -0.3]);
        let (low, span, mut width) = match of {
            Of::T => (0.0, self.duration, self.duration * chance.magnitude(1e-5, 0.1)),
            Of::Theta => {
                let degrees = chance.magnitude(0.01, 30.0);
                (self.angle, turns * TAU, degrees.to_radians())
            }
            Of::Omega => {
                let span = 0.6 * self.speed;
                (0.8 * self.speed, span, span * chance.magnitude(1e-5, 0.1))
            }
        };
        width *= 0.5;
        let centre = chance.between(low, low + span);
        let again = of != Of::Omega && chance.between(0.0, 1.0) < 0.5;
        let half_turns = (again && of == Of::Theta).then(|| chance.one_of(&[1, 2, 3, 4, 6, 8]));
        let by_time = again && of == Of::T && shape == Shape::Table;
        let period = match half_turns {
            Some(count) => Some(f64::from(count) * PI),
            None => by_time.then(|| span * chance.between(0.2, 1.0)),
        };
        let mut times = 1.0;
        if let Some(period) = period {
            width = width.min(0.125 * period);
            times = (span / period).max(1.0);
        }
        let height = match of {
            Of::T => 0.5 * share * energy / (width * self.speed) / times,
            Of::Theta => 0.5 * share * energy / width / times,
            // It drives as the others do, so that the speed does not stay there.
            Of::Omega => self.torque * chance.between(0.5, 20.0),
        };
        Pulse {
            of,
            shape,
            height,
            centre,
            width,
            half_turns,
            period,
        }
    }

    /// Angle and speed at its end; none where the crank turns back, or its speed stays at a jump between torques that drive it
    /// there from both sides.
    pub fn reference(&self) -> Option<[f64; 2]> {
        let (mut t, mut state) = (0.0, [self.angle, self.speed]);
        let (mut rises, mut stays) = (true, 0);
        while t < self.duration {
            let forward = |of: Of| of != Of::Omega || rises;
            let pieces = self.pulses.iter().map(|pulse| {
                let at = match pulse.of {
                    Of::T => t,
                    Of::Theta => state[0],
                    Of::Omega => state[1],
                };
                pulse.piece(at, forward(pulse.of))
            });
            let pieces: Vec<Piece> = pieces.collect();
            let motion = Motion { case: self, pieces };
            let before = t;
            (t, state) = motion.run(t, state);
            rises = motion.slopes(t, state)[1] > 0.0;
            stays = if t - before > 1e-12 * self.duration { 0 } else { stays + 1 };
            if state[1] <= 0.0 || stays > 4 * self.pulses.len() {
                return None;
            }
        }
        Some(state)
    }
}

/// The motion on one piece of each pulse.
struct Motion<'a> {
    case: &'a Case,
    pieces: Vec<Piece>,
}

impl Motion<'_> {
    fn slopes(&self, t: f64, state: [f64; 2]) -> [f64; 2] {
        let [r, l, inertia, mass] = MACHINE;
        let [theta, omega] = state;
        let (sin, cos) = theta.sin_cos();
        let (sin_phi, dphi_by_cos) = (r * sin / l, r * cos / l);
        let cos_phi = (1.0 - sin_phi * sin_phi).sqrt();
        let dphi = dphi_by_cos / cos_phi;
        let d2phi = (sin_phi * dphi * dphi - sin_phi) / cos_phi;
        let dx = -r * sin - l * sin_phi * dphi;
        let d2x = -r * cos - l * (cos_phi * dphi * dphi + sin_phi * d2phi);
        let pulses: f64 = self.pieces.iter().map(|piece| piece.value(t, state)).sum();
        let torque = self.case.torque - self.case.viscous * omega + pulses;
        let force = torque - mass * dx * d2x * omega * omega;
        [omega, force / (inertia + mass * dx * dx)]
    }

    /// Until the first edge or the end of the run.
    fn run(&self, mut t: f64, mut state: [f64; 2]) -> (f64, [f64; 2]) {
        let until = self.case.duration;
        let mut h = 1e-3 * until;
        let mut to_extreme = false;
        loop {
            h = h.min(until - t).min(0.2 / state[1].abs());
            let (next, error) = self.step(t, state, h);
            if error.is_nan() || error > 1.0 {
                h *= 0.5;
                continue;
            }
            let beyond = |h: f64, state: [f64; 2]| {
                let all = self.pieces.iter().map(|piece| piece.beyond(t + h, state));
                all.fold(f64::NEG_INFINITY, f64::max)
            };
            let far = beyond(h, next);
            let extreme = |h: f64, state: [f64; 2]| self.slopes(t + h, state)[1];
            let turns = extreme(0.0, state) * extreme(h, next) < 0.0;
            if turns && !to_extreme {
                // The speed is monotone on each step, so that it passes no edge twice.
                let sign = extreme(h, next).signum();
                h = root(h, |h| sign * extreme(h, self.step(t, state, h).0));
                h = h.max(1e-9 * until);
                to_extreme = true;
                continue;
            }
            to_extreme = false;
            if far > 0.0 {
                let at = root(h, |h| beyond(h, self.step(t, state, h).0));
                return (t + at, self.step(t, state, at).0);
            }
            state = next;
            if t + h >= until {
                return (until, state);
            }
            t += h;
            h *= if error < 0.01 { 1.5 } else { 1.0 };
        }
    }

    /// A step of extrapolated midpoint rules, and its error in units of what is allowed.
    fn step(&self, t: f64, state: [f64; 2], h: f64) -> ([f64; 2], f64) {
        const COLUMNS: usize = 7;
        // Aitken's and Neville's scheme in the square of the length: row k from its plain rule on.
        let mut row = [[0.0; 2]; COLUMNS];
        let mut before = [0.0; 2];
        for k in 0..COLUMNS {
            let n = 2 * (k + 1);
            let last = row;
            row[0] = self.midpoint(t, state, h, n);
            for j in 1..=k {
                let ratio = ((k + 1) as f64 / (k + 1 - j) as f64).powi(2);
                row[j] = std::array::from_fn(|i| {
                    row[j - 1][i] + (row[j - 1][i] - last[j - 1][i]) / (ratio - 1.0)
                });
            }
            if k + 1 < COLUMNS {
                before = row[k];
            }
        }
        let best = row[COLUMNS - 1];
        // Increments: what is small beside the angle may be much of a narrow pulse.
        let off = |i: usize| (best[i] - before[i]).abs();
        let error = (off(0) / (2e-14 * best[0].abs())).max(off(1) / (2e-14 * (1.0 + state[1])));
        (std::array::from_fn(|i| state[i] + best[i]), error)
    }

    /// What the midpoint rule with n parts adds to the state.
    fn midpoint(&self, t: f64, state: [f64; 2], h: f64, n: usize) -> [f64; 2] {
        let part = h / n as f64;
        let moved = |from: [f64; 2], slopes: [f64; 2], by: f64| -> [f64; 2] {
            std::array::from_fn(|i| from[i] + by * slopes[i])
        };
        let slopes = |t: f64, by: [f64; 2]| self.slopes(t, moved(state, by, 1.0));
        let mut before = [0.0; 2];
        let mut here = moved(before, self.slopes(t, state), part);
        for k in 1..n {
            let next = moved(before, slopes(t + k as f64 * part, here), 2.0 * part);
            (before, here) = (here, next);
        }
        let end = moved(before, slopes(t + h, here), part);
        std::array::from_fn(|i| 0.5 * (here[i] + end[i]))
    }
}

/// Where a function that is negative at zero and positive at h vanishes.
fn root(h: f64, f: impl Fn(f64) -> f64) -> f64 {
    let (mut low, mut high) = (0.0, h);
    let (mut below, mut above) = (f(0.0), f(h));
    for k in 0..200 {
        let secant = (low * above - high * below) / (above - below);
        let halves = k % 3 == 2 || !(low..=high).contains(&secant);
        let at = if halves { 0.5 * (low + high) } else { secant };
        let value = f(at);
        if value < 0.0 {
            (low, below) = (at, value);
        } else {
            (high, above) = (at, value);
        }
        if high - low <= 4.0 * f64::EPSILON * h {
            break;
        }
    }
    high
}
