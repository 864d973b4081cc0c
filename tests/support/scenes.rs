//! Random scene files over the scenes that more than one engine serves.

use std::f64::consts::{FRAC_PI_2, TAU};
use std::fmt::Write;
use std::fs;
use std::path::Path;

/// Number of random numbers that define a scene.
pub const DRAWS: usize = 96;

/// Random numbers in [0, 1) that define a scene.
pub struct Draws(std::vec::IntoIter<f64>);

/// Lengths and motion by which loads are scaled.
struct Sizes {
    r: f64,
    l: f64,
    offset: f64,
    mass: f64,
    inertia: f64,
    speed: f64,
}

impl Draws {
    pub fn new(numbers: Vec<f64>) -> Draws {
        Draws(numbers.into_iter())
    }

    fn next(&mut self) -> f64 {
        self.0.next().expect("enough numbers for a scene")
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.next()
    }

    fn magnitude(&mut self, low: f64, high: f64) -> f64 {
        self.between(low.ln(), high.ln()).exp()
    }

    fn chance(&mut self, part: f64) -> bool {
        self.next() < part
    }

    fn sign(&mut self) -> f64 {
        if self.chance(0.5) { -1.0 } else { 1.0 }
    }

    fn below(&mut self, count: usize) -> usize {
        (self.next() * count as f64) as usize
    }

    /// Returns the text of a scene file; its tables are those of [`write_tables`].
    pub fn scene(mut self) -> String {
        let mut text = String::new();
        let (mut sizes, turns_fully) = self.geometry(&mut text);
        self.bodies(&mut text, &mut sizes);
        self.gravity(&mut text, &sizes);
        for _ in 0..self.below(4) {
            self.load(&mut text, &sizes);
        }
        self.run(&mut text, &sizes, turns_fully);
        text
    }

    /// Writes the lengths: cranks that turn fully, some of them barely, and some that do not.
    fn geometry(&mut self, text: &mut String) -> (Sizes, bool) {
        let r = self.magnitude(5e-3, 1.0);
        let turns_fully = !self.chance(0.15);
        let none = self.chance(0.2);
        let aside = self.sign() * r * self.magnitude(1e-3, 2.0);
        let room = match self.below(10) {
            0 => self.magnitude(1e-10, 1e-3),
            1 => self.magnitude(1e-3, 0.1),
            _ => self.magnitude(0.1, 8.0),
        };
        let (l, offset) = if turns_fully {
            let offset = if none { 0.0 } else { aside };
            (r + offset.abs() + room * r, offset)
        } else {
            let l = r * self.magnitude(0.3, 3.0);
            (l, aside.signum() * self.between(0.0, 0.95) * (r + l))
        };
        let branch = if self.chance(0.5) { "left" } else { "right" };
        let lengths = format!("crank = \"{r:e} m\"\nrod = \"{l:e} m\"\noffset = \"{offset:e} m\"");
        writeln!(text, "[geometry]\n{lengths}\nbranch = \"{branch}\"").unwrap();
        let sizes = Sizes {
            r,
            l,
            offset,
            mass: self.magnitude(0.05, 20.0),
            inertia: 0.0,
            speed: self.sign() * self.magnitude(0.5, 300.0),
        };
        (sizes, turns_fully)
    }

    /// Writes the bodies: a few cranks without inertia, and all models of the rod.
    fn bodies(&mut self, text: &mut String, sizes: &mut Sizes) {
        let Sizes { r, l, mass, .. } = *sizes;
        let bare = self.chance(0.06);
        if !bare {
            let (along, left) = (self.between(-1.0, 1.0) * r, self.between(-0.5, 0.5) * r);
            let about_cg = mass * r * r * self.magnitude(0.02, 2.0);
            let inertia = about_cg + mass * (along * along + left * left);
            let cg = format!("cg = \"{along:e} m\"\ncg_lateral = \"{left:e} m\"");
            writeln!(
                text,
                "[crank]\nmass = \"{mass:e} kg\"\n{cg}\ninertia = \"{inertia:e} kg m^2\""
            )
            .unwrap();
            sizes.inertia += inertia;
        }
        let rod = mass * self.between(0.02, 1.5);
        let inside = self.between(0.0, 1.0) * l;
        let spin = rod * l * l * self.between(0.02, 0.3);
        match self.below(6) {
            0 => {}
            1 => writeln!(
                text,
                "[rod]\nmodel = \"two-mass\"\nmass = \"{rod:e} kg\"\ncg = \"{inside:e} m\""
            )
            .unwrap(),
            2 => writeln!(
                text,
                "[rod]\nmodel = \"spin-only\"\nmass = \"{rod:e} kg\"\ncg = \"{inside:e} m\"\ninertia = \"{spin:e} kg m^2\""
            )
            .unwrap(),
            _ => {
                let along = self.between(-0.3, 1.3) * l;
                let left = self.between(-0.3, 0.3) * l;
                let about_pin = spin + rod * (along * along + left * left);
                writeln!(
                    text,
                    "[rod]\nmass = \"{rod:e} kg\"\ncg = \"{along:e} m\"\ncg_lateral = \"{left:e} m\"\ninertia = \"{about_pin:e} kg m^2\"\ninertia_about = \"crank-pin\""
                )
                .unwrap();
            }
        }
        sizes.inertia += 0.6 * rod * r * r;
        if bare || self.chance(0.9) {
            let slider = mass * self.between(0.05, 1.5);
            writeln!(text, "[slider]\nmass = \"{slider:e} kg\"").unwrap();
            sizes.inertia += 0.5 * slider * r * r;
        }
    }

    /// Returns a torque scaled by its work relative to the kinetic energy.
    fn torque(&mut self, sizes: &Sizes) -> f64 {
        0.5 * sizes.inertia * sizes.speed.powi(2) * self.magnitude(3e-3, 1.0)
    }

    fn gravity(&mut self, text: &mut String, sizes: &Sizes) {
        if self.chance(0.5) {
            return;
        }
        let g = if self.chance(0.5) {
            9.80665
        } else {
            self.torque(sizes) / (sizes.mass * sizes.r)
        };
        let direction = self.between(-7.0, 7.0);
        writeln!(
            text,
            "[gravity]\nacceleration = \"{g:e} m/s^2\"\ndirection = \"{direction:e} rad\""
        )
        .unwrap();
    }

    fn load(&mut self, text: &mut String, sizes: &Sizes) {
        let Sizes { r, speed, .. } = *sizes;
        let stronger = if self.chance(0.15) { 3.0 } else { 0.4 };
        let torque = self.torque(sizes) * stronger;
        let force = torque / r;
        let w = speed.abs();
        let loss = 0.3 * torque / w;
        let slider_loss = loss / (r * r);
        let s = self.sign();
        let rate = w * self.between(0.2, 3.0);
        let rest = self.between(-3.0, 3.0) * r;
        let way = if s > 0.0 { "linear" } else { "pchip" };
        let expression = |formula: String| format!("kind = \"expression\"\nvalue = \"{formula}\"");
        let table = |file: &str, of: &str, period: &str| {
            format!(
                "kind = \"table\"\nfile = \"{file}\"\nof = \"{of}\"\nperiod = \"{period}\"\ninterpolation = \"{way}\""
            )
        };
        let (on, load) = match self.below(18) {
            0 => (
                "torque",
                format!("kind = \"constant\"\nvalue = \"{:e} N m\"", s * torque),
            ),
            1 => (
                "force",
                format!("kind = \"constant\"\nvalue = \"{:e} N\"", s * force),
            ),
            2 => (
                "torque",
                format!("kind = \"viscous\"\ncoefficient = \"{loss:e} N m s/rad\""),
            ),
            3 => (
                "force",
                format!("kind = \"viscous\"\ncoefficient = \"{slider_loss:e} N s/m\""),
            ),
            4 => (
                "torque",
                format!(
                    "kind = \"motor\"\nstall = \"{:e} N m\"\nno_load_speed = \"{:e} rad/s\"",
                    torque.copysign(speed),
                    1.3 * speed
                ),
            ),
            5 => (
                "force",
                format!(
                    "kind = \"spring\"\nstiffness = \"{:e} N/m\"\nrest = \"{rest:e} m\"",
                    force / r
                ),
            ),
            6 => (
                "torque",
                expression(format!("{:e} * sin(2*theta + 0.3)", s * torque)),
            ),
            7 => (
                "force",
                expression(format!("{:e} * cos(theta)^3", s * force)),
            ),
            8 => (
                "force",
                expression(format!("{:e} * x * exp(-x/{r:e})", s * force / r)),
            ),
            9 => (
                "torque",
                expression(format!("-{:e} * omega * abs(omega)", loss / w)),
            ),
            10 => (
                "force",
                expression(format!("-{:e} * v^3", slider_loss / (w * r).powi(2))),
            ),
            11 => ("force", expression(format!("{force:e} * sin({rate:e}*t)"))),
            12 => (
                "torque",
                expression(format!("{torque:e} * cos({rate:e}*t + theta)")),
            ),
            13 => ("torque", table("turn.csv", "theta", "360 deg")),
            14 => ("torque", table("time.csv", "t", "2 s")),
            // Differs from turn to turn.
            15 => (
                "torque",
                expression(format!("{:e} * sin(theta/2)", s * torque)),
            ),
            16 => (
                "force",
                expression(format!(
                    "{:e} * tanh(x/{r:e}) * (1 + 0.3*sin(theta))",
                    s * force
                )),
            ),
            _ => (
                "force",
                format!(
                    "kind = \"gas\"\nfile = \"cycle.csv\"\nbore = \"{:e} m\"\nperiod = \"720 deg\"",
                    (force / 1e6).sqrt()
                ),
            ),
        };
        writeln!(text, "[[{on}]]\n{load}").unwrap();
    }

    /// Writes start and extent: from a fraction of a turn to some hundred turns at the first speed; some starts at
    /// rest.
    fn run(&mut self, text: &mut String, sizes: &Sizes, turns_fully: bool) {
        let turns = if self.chance(0.04) {
            self.magnitude(20.0, 300.0)
        } else {
            self.magnitude(0.1, 8.0)
        };
        let duration = turns * TAU / sizes.speed.abs();
        let speed = if self.chance(0.1) { 0.0 } else { sizes.speed };
        let mut angle = match self.below(6) {
            0 => self.sign() * (FRAC_PI_2 + self.magnitude(1e-9, 0.1)),
            1 => 0.0,
            2 => self.between(-300.0, 300.0),
            _ => self.between(-7.0, 7.0),
        };
        // Move to the next reachable angle, where |sin(theta)| is small enough.
        let Sizes { r, l, offset, .. } = *sizes;
        while !turns_fully && (offset + r * angle.sin()).abs() > 0.98 * l {
            angle += 0.01;
        }
        let tolerance = 10f64.powf(self.between(-12.0, -6.0));
        writeln!(
            text,
            "[motion]\nangle = \"{angle:e} rad\"\nspeed = \"{speed:e} rad/s\"\n[run]\nduration = \"{duration:e} s\"\ntolerance = {tolerance:e}"
        )
        .unwrap();
    }
}

/// Writes a torque over a turn, a pressure over two turns and a torque over time into a folder.
pub fn write_tables(folder: &Path) {
    let rows = |header: &str, count: u32, step: f64, value: &dyn Fn(f64) -> f64| {
        let row = |i: u32| {
            let at = f64::from(i) * step;
            format!("{at},{:.4}\n", value(at))
        };
        header.to_owned() + "\n" + &(0..=count).map(row).collect::<String>()
    };
    let wave = |turns: f64| {
        let angle = TAU * turns;
        angle.sin() - 0.7 * (3.0 * angle).cos() + 0.1
    };
    // Combustion peak, once in two turns.
    let bell = |degrees: f64| 1.0 + 20.0 * (-((degrees - 380.0) / 40.0).powi(2)).exp();
    let tables = [
        (
            "turn.csv",
            rows("theta [deg],torque [N m]", 12, 30.0, &|x| wave(x / 360.0)),
        ),
        ("cycle.csv", rows("theta [deg],p [bar]", 48, 15.0, &bell)),
        (
            "time.csv",
            rows("t [s],torque [N m]", 20, 0.1, &|t| wave(t / 2.0)),
        ),
    ];
    for (name, text) in tables {
        fs::write(folder.join(name), text).expect("a table");
    }
}
