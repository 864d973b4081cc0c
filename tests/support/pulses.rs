//! Random machines under narrow pulses, and an independent integration of their motion: extrapolated midpoint rule
//! (Gragg, Bulirsch, Stoer) in pieces between the edges of the pulses, on each of which one formula holds.

use std::f64::consts::{PI, TAU};

/// Crank length and rod length, m, crank inertia, kg m², and slider mass, kg.
pub const MACHINE: [f64; 4] = [0.05, 0.15, 0.02, 0.6];

/// Pseudo-random numbers from a seed (splitmix64).
pub struct Chance(pub u64);

impl Chance {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let a = (self.0 ^ self.0 >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let b = (a ^ a >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        b ^ b >> 31
    }

    /// Returns a number uniformly distributed between two numbers.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * (self.next() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Returns a number log-uniformly distributed between two positive numbers.
    fn magnitude(&mut self, low: f64, high: f64) -> f64 {
        self.between(low.ln(), high.ln()).exp()
    }

    fn one_of<T: Copy>(&mut self, all: &[T]) -> T {
        all[(self.next() % all.len() as u64) as usize]
    }
}

/// Variable of a pulse.
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

/// Torque that is nonzero for a short while only.
#[derive(Clone, Debug)]
pub struct Pulse {
    pub of: Of,
    pub shape: Shape,
    /// Height, N m.
    height: f64,
    centre: f64,
    /// Half-width, in units of the variable.
    pub width: f64,
    /// Period over the angle, in half turns.
    pub half_turns: Option<u32>,
    period: Option<f64>,
}

impl Pulse {
    /// Returns the signed distance of an argument from the nearest centre.
    fn beside(&self, at: f64) -> f64 {
        match self.period {
            Some(period) => at - self.centre - period * ((at - self.centre) / period).round(),
            None => at - self.centre,
        }
    }

    /// Returns the edges relative to the centre, in widths.
    fn edges(&self) -> &'static [f64] {
        match self.shape {
            Shape::Gauss => &[-6.0, -4.0, -2.0, -1.0, 0.0, 1.0, 2.0, 4.0, 6.0],
            Shape::Parabola | Shape::Box => &[-1.0, 1.0],
            Shape::Tent => &[-1.0, 0.0, 1.0],
            Shape::Table => &[-1.2, -1.0, 1.0, 1.2],
        }
    }

    /// Returns the formula of the pulse at an argument that moves forward or back, with its edges.
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
        let low = if index == 0 {
            ends[0]
        } else {
            edges[index - 1] * self.width
        };
        let high = edges.get(index).map_or(ends[1], |edge| edge * self.width);
        Piece {
            of: self.of,
            height: self.height,
            start: at - origin,
            width: self.width,
            // The motion starts at one of the edges, up to rounding.
            low: low - nudge.max(0.0),
            high: high - nudge.min(0.0),
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

    /// Returns the rows of the pulse's table, at least between two arguments.
    pub fn rows(&self, low: f64, high: f64) -> Vec<(f64, f64)> {
        let at = |edge: f64| self.centre + edge * self.width;
        let [first, last] = match self.period {
            Some(period) => [self.centre - 0.5 * period, self.centre + 0.5 * period],
            None => [low.min(at(-2.0)), high.max(at(2.0))],
        };
        let rows = [
            (-1.2, 0.0),
            (-1.0, self.height),
            (1.0, self.height),
            (1.2, 0.0),
        ];
        let inner = rows.map(|(edge, value)| (at(edge), value));
        [&[(first, 0.0)], &inner[..], &[(last, 0.0)]].concat()
    }

    /// Returns the period of the pulse's table.
    pub fn period(&self) -> Option<f64> {
        self.period
    }

    /// Returns the formula of the pulse.
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

/// One formula of a pulse, valid between two edges.
struct Piece {
    of: Of,
    height: f64,
    /// Argument at which the motion enters the piece, from the centre of the pulse, like the edges.
    start: f64,
    width: f64,
    low: f64,
    high: f64,
    /// Polynomial in the distance from the centre in widths; NaN for the Gaussian bell.
    form: [f64; 3],
}

impl Piece {
    /// Returns the argument, from the centre of the pulse.
    fn of(&self, moved: &Moved) -> f64 {
        self.start
            + match self.of {
                Of::T => moved.t,
                Of::Theta => moved.theta,
                Of::Omega => moved.omega,
            }
    }

    fn value(&self, moved: &Moved) -> f64 {
        let u = self.of(moved) / self.width;
        let [a, b, c] = self.form;
        self.height
            * if a.is_nan() {
                (-u * u).exp()
            } else {
                a + u * (b + u * c)
            }
    }

    /// Returns the distance of the argument beyond the edges, in widths; negative inside.
    fn beyond(&self, moved: &Moved) -> f64 {
        let at = self.of(moved);
        (self.low - at).max(at - self.high) / self.width
    }
}

/// Run of the machine.
#[derive(Clone, Debug)]
pub struct Case {
    pub pulses: Vec<Pulse>,
    /// Constant torque, N m.
    pub torque: f64,
    /// Viscous coefficient, N m s/rad.
    pub viscous: f64,
    /// Start angle, rad.
    pub angle: f64,
    /// Start speed, rad/s.
    pub speed: f64,
    /// Duration, s.
    pub duration: f64,
}

impl Case {
    /// Draws a random case.
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
        let shapes = [
            Shape::Gauss,
            Shape::Parabola,
            Shape::Tent,
            Shape::Box,
            Shape::Table,
        ];
        let shape = chance.one_of(&shapes);
        let share = chance.between(0.02, 0.3) * chance.one_of(&[1.0, 1.0, -0.3]);
        let (low, span, mut width) = match of {
            Of::T => (
                0.0,
                self.duration,
                self.duration * chance.magnitude(1e-5, 0.1),
            ),
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
            // The pulse has the sign of the constant torque, so that the speed does not stay at it.
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

    /// Returns angle and speed at the end; none where the crank turns back, or the speed stays at a jump between
    /// torques that drive it there from both sides.
    pub fn reference(&self) -> Option<[f64; 2]> {
        let mut at = Moved {
            t: 0.0,
            theta: self.angle,
            omega: self.speed,
        };
        /// Number of pieces above which the speed is taken to stay at an edge.
        const MOST_PIECES: u32 = 5000;
        let mut rises = true;
        for _ in 0..MOST_PIECES {
            let forward = |of: Of| of != Of::Omega || rises;
            let pieces = self.pulses.iter().map(|pulse| {
                let argument = match pulse.of {
                    Of::T => at.t,
                    Of::Theta => at.theta,
                    Of::Omega => at.omega,
                };
                pulse.piece(argument, forward(pulse.of))
            });
            let pieces = pieces.collect();
            let motion = Motion {
                case: self,
                start: at,
                pieces,
            };
            let moved = motion.run();
            rises = motion.slopes(&moved)[1] > 0.0;
            at = at.plus(moved);
            if at.omega <= 0.0 {
                return None;
            }
            if at.t >= self.duration {
                return Some([at.theta, at.omega]);
            }
        }
        None
    }
}

/// Time, angle and speed, or their changes on a piece: changes are kept apart because small ones would round in large
/// numbers.
#[derive(Clone, Copy, Debug)]
struct Moved {
    t: f64,
    theta: f64,
    omega: f64,
}

impl Moved {
    const NOT: Moved = Moved {
        t: 0.0,
        theta: 0.0,
        omega: 0.0,
    };

    fn plus(self, more: Moved) -> Moved {
        Moved {
            t: self.t + more.t,
            theta: self.theta + more.theta,
            omega: self.omega + more.omega,
        }
    }
}

/// Motion on one piece of each pulse.
struct Motion<'a> {
    case: &'a Case,
    start: Moved,
    pieces: Vec<Piece>,
}

/// Trial step: increments, and the error in units of the allowed error.
struct Tried {
    added: Moved,
    error: f64,
}

impl Motion<'_> {
    fn slopes(&self, moved: &Moved) -> [f64; 2] {
        let [r, l, inertia, mass] = MACHINE;
        let Moved { theta, omega, .. } = self.start.plus(*moved);
        let (sin, cos) = theta.sin_cos();
        let (sin_phi, dphi_by_cos) = (r * sin / l, r * cos / l);
        let cos_phi = (1.0 - sin_phi * sin_phi).sqrt();
        let dphi = dphi_by_cos / cos_phi;
        let d2phi = (sin_phi * dphi * dphi - sin_phi) / cos_phi;
        let dx = -r * sin - l * sin_phi * dphi;
        let d2x = -r * cos - l * (cos_phi * dphi * dphi + sin_phi * d2phi);
        let pulses: f64 = self.pieces.iter().map(|piece| piece.value(moved)).sum();
        let torque = self.case.torque - self.case.viscous * omega + pulses;
        let force = torque - mass * dx * d2x * omega * omega;
        [omega, force / (inertia + mass * dx * dx)]
    }

    /// Integrates to the first edge or to the end of the run; returns the changes.
    fn run(&self) -> Moved {
        let until = self.case.duration - self.start.t;
        let after = |moved: Moved, h: f64| moved.plus(self.step(&moved, h).added);
        let beyond = |moved: Moved| {
            let all = self.pieces.iter().map(|piece| piece.beyond(&moved));
            all.fold(f64::NEG_INFINITY, f64::max)
        };
        let mut moved = Moved::NOT;
        let mut longest = 1e-3 * self.case.duration;
        loop {
            let speed = self.start.omega + moved.omega;
            let mut h = longest.min(until - moved.t).min(0.2 / speed.abs());
            let mut tried = self.step(&moved, h);
            while tried.error > 1.0 || tried.error.is_nan() {
                h *= 0.5;
                longest = h;
                tried = self.step(&moved, h);
            }
            if tried.error < 0.01 {
                longest *= 1.5;
            }
            let [from, to] = [moved, moved.plus(tried.added)].map(|at| self.slopes(&at)[1]);
            if from * to < 0.0 {
                // The speed is monotone on each step, so that no edge is passed twice.
                let shorter = root(h, |h| to.signum() * self.slopes(&after(moved, h))[1]);
                h = shorter.max(1e-9 * self.case.duration).min(h);
            }
            let leaves = beyond(after(moved, h)) > 0.0;
            if leaves {
                h = root(h, |h| beyond(after(moved, h)));
            }
            tried = self.step(&moved, h);
            if tried.error > 1.0 {
                // The longer step missed a bell.
                longest = 0.5 * h;
                continue;
            }
            let next = moved.plus(tried.added);
            if leaves {
                return next;
            }
            moved = next;
            if moved.t >= until {
                return moved;
            }
        }
    }

    /// Makes a step by the extrapolated midpoint rule.
    fn step(&self, moved: &Moved, h: f64) -> Tried {
        const COLUMNS: usize = 7;
        // Aitken-Neville scheme in the square of the step length: row k begins with its plain midpoint rule.
        let mut row = [[0.0; 2]; COLUMNS];
        let mut before = [0.0; 2];
        for k in 0..COLUMNS {
            let n = 2 * (k + 1);
            let last = row;
            row[0] = self.midpoint(moved, h, n);
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
        // Compare increments: a change small beside the angle may be large for a narrow pulse.
        let off = |i: usize| (best[i] - before[i]).abs();
        let speed = self.start.omega + moved.omega;
        Tried {
            added: Moved {
                t: h,
                theta: best[0],
                omega: best[1],
            },
            error: (off(0) / (2e-14 * best[0].abs())).max(off(1) / (2e-14 * (1.0 + speed))),
        }
    }

    /// Returns the increment of the state by the midpoint rule with n parts.
    fn midpoint(&self, moved: &Moved, h: f64, n: usize) -> [f64; 2] {
        let part = h / n as f64;
        let slopes = |k: usize, by: [f64; 2]| {
            self.slopes(&moved.plus(Moved {
                t: k as f64 * part,
                theta: by[0],
                omega: by[1],
            }))
        };
        let ahead = |from: [f64; 2], slopes: [f64; 2], by: f64| -> [f64; 2] {
            std::array::from_fn(|i| from[i] + by * slopes[i])
        };
        let mut before = [0.0; 2];
        let mut here = ahead(before, slopes(0, before), part);
        for k in 1..n {
            let next = ahead(before, slopes(k, here), 2.0 * part);
            (before, here) = (here, next);
        }
        let end = ahead(before, slopes(n, here), part);
        std::array::from_fn(|i| 0.5 * (here[i] + end[i]))
    }
}

/// Returns the root of a function that is negative at zero and positive at h.
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
