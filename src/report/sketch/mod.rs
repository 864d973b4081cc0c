//! The mechanism to scale at an angle: as SVG, as DXF, and in motion as GIF.

mod drawing;
mod dxf;
mod gif;
mod svg;

pub(super) use drawing::Drawing;
pub use gif::animation;

use crate::scene::Scene;

/// The mechanism of a scene, to be drawn at any angle.
#[derive(Debug)]
pub struct Sketch {
    drawing: Drawing,
    title: String,
}

/// Crank angle, rad, and slider position, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// rad
    pub theta: f64,
    /// m
    pub x: f64,
}

/// A part of the drawing; places in m.
#[derive(Clone, Copy, Debug)]
enum Part {
    Line {
        ends: [[f64; 2]; 2],
        layer: Layer,
    },
    Circle {
        centre: [f64; 2],
        radius: f64,
        layer: Layer,
    },
}

/// What a part stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Layer {
    Crank,
    Rod,
    Slider,
    Joint,
    CentreOfGravity,
    /// Guide, path of the crank pin, dead centres.
    Ground,
}

impl Layer {
    fn name(self) -> &'static str {
        match self {
            Layer::Crank => "CRANK",
            Layer::Rod => "ROD",
            Layer::Slider => "SLIDER",
            Layer::Joint => "JOINTS",
            Layer::CentreOfGravity => "CENTRES_OF_GRAVITY",
            Layer::Ground => "GROUND",
        }
    }
}

/// Left, right, lowest and highest place, m.
#[derive(Clone, Copy, Debug)]
struct Extent {
    left: f64,
    right: f64,
    low: f64,
    high: f64,
}

impl Sketch {
    /// Of the mechanism of a scene.
    pub fn of(scene: &Scene) -> Sketch {
        Sketch {
            drawing: Drawing::of(scene),
            title: scene.title.clone().unwrap_or_default(),
        }
    }

    /// Half the height of the slider, m.
    fn size(&self) -> f64 {
        let Drawing { crank, rod, .. } = self.drawing;
        (0.12 * crank).max(0.03 * (crank + rod))
    }

    /// Slider positions at the dead centres that exist, m.
    fn dead_centres(&self) -> impl Iterator<Item = f64> {
        let Drawing {
            crank,
            rod,
            offset,
            branch,
            ..
        } = self.drawing;
        let lengths = [rod + crank, rod - crank].into_iter();
        let exist = lengths.filter(move |length| *length > 0.0 && *length >= offset.abs());
        exist.map(move |length| branch * (length * length - offset * offset).sqrt())
    }

    /// What a drawing of these poses needs.
    fn extent(&self, poses: &[Pose]) -> Extent {
        let Drawing { crank, offset, .. } = self.drawing;
        let room = 3.0 * self.size();
        let places = || poses.iter().map(|pose| pose.x).chain(self.dead_centres());
        Extent {
            left: places().fold(-crank, f64::min) - room,
            right: places().fold(crank, f64::max) + room,
            low: (-crank).min(-offset) - room,
            high: crank.max(-offset) + room,
        }
    }

    /// The parts at a pose, those that lie below others first.
    fn parts(&self, pose: Pose, extent: Extent) -> Vec<Part> {
        let Drawing {
            crank,
            rod,
            offset,
            crank_cg,
            rod_cg,
            ..
        } = self.drawing;
        let size = self.size();
        let (sin, cos) = pose.theta.sin_cos();
        let pin = [crank * cos, crank * sin];
        let wrist = [pose.x, -offset];
        let line = |from: [f64; 2], to: [f64; 2], layer| Part::Line {
            ends: [from, to],
            layer,
        };
        let circle = |centre, radius, layer| Part::Circle {
            centre,
            radius,
            layer,
        };
        let square = |x: f64, layer| {
            let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
            let corner = move |k: usize| {
                let [right, up] = corners[k % 4];
                [x + right * size, -offset + up * size]
            };
            (0..4).map(move |k| line(corner(k), corner(k + 1), layer))
        };
        let mut parts = vec![
            line(
                [extent.left, -offset],
                [extent.right, -offset],
                Layer::Ground,
            ),
            circle([0.0, 0.0], crank, Layer::Ground),
        ];
        parts.extend(self.dead_centres().flat_map(|x| square(x, Layer::Ground)));
        parts.push(line(pin, wrist, Layer::Rod));
        parts.push(line([0.0, 0.0], pin, Layer::Crank));
        parts.extend(square(pose.x, Layer::Slider));
        parts.extend([[0.0, 0.0], pin, wrist].map(|at| circle(at, 0.35 * size, Layer::Joint)));
        let along = [(wrist[0] - pin[0]) / rod, (wrist[1] - pin[1]) / rod];
        let marks = [
            crank_cg.map(|cg| placed([0.0, 0.0], [cos, sin], cg)),
            rod_cg.map(|cg| placed(pin, along, cg)),
        ];
        let marks = marks.into_iter().flatten();
        parts.extend(marks.map(|at| circle(at, 0.25 * size, Layer::CentreOfGravity)));
        parts
    }
}

/// A point of a body: from its origin, along its axis and to the left of it.
fn placed(origin: [f64; 2], along: [f64; 2], at: [f64; 2]) -> [f64; 2] {
    [
        origin[0] + at[0] * along[0] - at[1] * along[1],
        origin[1] + at[0] * along[1] + at[1] * along[0],
    ]
}
