//! A mechanism with its loads, and its images: mirrored, rotated by half a turn, in other units, in reversed time.

use std::f64::consts::PI;

use slider_crank::scene::{
    Branch, Crank, Expression, Friction, Gravity, Interpolation, Load, Rod, Scene, Slider, Table,
    Variable,
};

/// Transformation of a mechanism, under which its motion must transform likewise.
#[derive(Clone, Copy, Debug)]
pub struct Image {
    /// Reflection at the x axis.
    pub mirrored: bool,
    /// Rotation by half a turn about the crank pivot.
    pub turned: bool,
    /// Factors of the units of length, mass and time.
    pub length: f64,
    pub mass: f64,
    pub time: f64,
    /// End time of a reversal, at which loads at t become those at this time minus t; none without reversal.
    pub backwards: Option<f64>,
}

impl Image {
    pub const SAME: Image = Image {
        mirrored: false,
        turned: false,
        length: 1.0,
        mass: 1.0,
        time: 1.0,
        backwards: None,
    };

    pub const MIRRORED: Image = Image {
        mirrored: true,
        ..Image::SAME
    };
    pub const TURNED: Image = Image {
        turned: true,
        ..Image::SAME
    };

    fn sense(&self) -> f64 {
        if self.mirrored { -1.0 } else { 1.0 }
    }

    fn along(&self) -> f64 {
        if self.turned { -1.0 } else { 1.0 }
    }

    fn turn(&self) -> f64 {
        if self.turned { PI } else { 0.0 }
    }

    fn inertia(&self) -> f64 {
        self.mass * self.length * self.length
    }

    /// Returns crank angle and speed in the image.
    pub fn state(&self, theta: f64, omega: f64) -> (f64, f64) {
        (
            self.sense() * theta + self.turn(),
            self.sense() * omega / self.time,
        )
    }

    fn argument(&self, of: Variable, at: f64) -> f64 {
        match of {
            Variable::T => self.time * self.backwards.map_or(at, |end| end - at),
            Variable::Theta => self.state(at, 0.0).0,
            _ => unreachable!("tables over time and angle only"),
        }
    }
}

/// Load; formulas depend on T, THETA and OMEGA.
#[derive(Clone, Debug)]
pub enum Act {
    Formula(String),
    Table {
        of: Variable,
        rows: Vec<(f64, f64)>,
        interpolation: Interpolation,
        period: Option<f64>,
    },
    Spring {
        stiffness: f64,
        rest: f64,
    },
    Viscous(f64),
}

impl Act {
    fn load(&self, image: &Image, on_slider: bool) -> Load {
        let energy = image.inertia() / (image.time * image.time);
        let factor = if on_slider {
            image.along() * energy / image.length
        } else {
            image.sense() * energy
        };
        match self {
            Act::Formula(text) => {
                let t = match image.backwards {
                    Some(end) => format!("({end} - t)"),
                    None => format!("(t/{})", image.time),
                };
                let (sense, turn) = (image.sense(), image.turn());
                let text = text
                    .replace("THETA", &format!("({sense})*(theta - {turn})"))
                    .replace("OMEGA", &format!("({})*omega", sense * image.time))
                    .replace('T', &t);
                Load::Expression(
                    Expression::parse(&format!("({factor})*({text})")).expect("a formula"),
                )
            }
            Act::Table {
                of,
                rows,
                interpolation,
                period,
            } => {
                let moved = rows
                    .iter()
                    .map(|(at, value)| (image.argument(*of, *at), factor * value));
                let mut moved: Vec<_> = moved.collect();
                moved.sort_by(|a, b| a.0.total_cmp(&b.0));
                let (arguments, values): (Vec<_>, Vec<_>) = moved.into_iter().unzip();
                let period = period.map(|_| arguments[arguments.len() - 1] - arguments[0]);
                Load::Table(
                    Table::new(*of, &arguments, &values, *interpolation, period).expect("a table"),
                )
            }
            Act::Spring { stiffness, rest } => Load::Spring {
                stiffness: stiffness * image.mass / (image.time * image.time),
                rest: rest * image.along() * image.length,
            },
            Act::Viscous(coefficient) => Load::Viscous(coefficient * image.inertia() / image.time),
        }
    }
}

/// Mechanism with lengths, bodies, loads and start.
#[derive(Clone, Debug)]
pub struct Setting {
    pub lengths: [f64; 3],
    pub branch: Branch,
    bodies: [f64; 7],
    /// m/s²
    pub gravity: f64,
    pub start: (f64, f64),
    pub duration: f64,
    pub torques: Vec<Act>,
    pub forces: Vec<Act>,
    pub friction: Option<Friction>,
}

impl Setting {
    /// Creates a mechanism at rest without loads. `bodies`: crank inertia in kg by its length squared; mass of the rod,
    /// position of its centre of gravity along and beside it in rod lengths, its gyration in rod lengths squared; mass
    /// of the slider; direction of gravity.
    pub fn new(lengths: [f64; 3], branch: Branch, bodies: [f64; 7]) -> Setting {
        Setting {
            lengths,
            branch,
            bodies,
            gravity: 0.0,
            start: (0.0, 0.0),
            duration: 0.0,
            torques: Vec::new(),
            forces: Vec::new(),
            friction: None,
        }
    }

    /// The scene of an image.
    pub fn scene(&self, image: &Image) -> Scene {
        let [r, l, e] = self.lengths.map(|length| length * image.length);
        let [inertia, rod, along, beside, gyration, slider, direction] = self.bodies;
        let (theta, omega) = image.state(self.start.0, self.start.1);
        let mut scene = Scene::new(r, l)
            .offset(image.sense() * image.along() * e)
            .branch(match (self.branch, image.turned) {
                (Branch::Right, false) | (Branch::Left, true) => Branch::Right,
                _ => Branch::Left,
            })
            .crank(Crank {
                inertia: inertia * image.mass * r * r,
                ..Crank::default()
            })
            .rod(Rod {
                mass: rod * image.mass,
                cg: along * l,
                cg_lateral: image.sense() * beside * l,
                inertia: gyration * rod * image.mass * l * l,
                ..Rod::default()
            })
            .slider(Slider {
                mass: slider * image.mass,
            })
            .gravity(Gravity {
                acceleration: self.gravity * image.length / (image.time * image.time),
                direction: image.sense() * direction + image.turn(),
            })
            .start(theta, omega)
            .duration(self.duration * image.time);
        scene.friction = self.friction;
        for act in &self.torques {
            scene = scene.torque(act.load(image, false));
        }
        for act in &self.forces {
            scene = scene.force(act.load(image, true));
        }
        scene
    }
}
