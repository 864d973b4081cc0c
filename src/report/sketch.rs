//! Drawings of the mechanism to scale: SVG and DXF of one pose, animated GIF of several.

use std::fmt::Write;

use super::Output;
use super::dimensions::Dimensions;
use super::picture::{failed, pixels};
use crate::error::Error;
use crate::figure::escaped;
use crate::kinematics::of_checked;
use crate::scene::Scene;
use ::gif::{Encoder, Frame, Repeat};

/// Mechanism of a scene, to be drawn in any pose.
#[derive(Debug)]
pub struct Sketch {
    dimensions: Dimensions,
    title: String,
    /// Slider positions at the dead centres, m.
    dead_centres: Vec<f64>,
}

/// Pose of the mechanism.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// Crank angle, rad.
    pub theta: f64,
    /// Slider position, m.
    pub x: f64,
}

/// Graphic element: line between two points or circle of centre and radius, m.
enum Element {
    Line([f64; 2], [f64; 2]),
    Circle([f64; 2], f64),
}

/// Returns the SVG style of a DXF layer; the ground is the guide, the path of the crank pin, and the slider at the dead
/// centres.
fn style(layer: &str) -> &'static str {
    match layer {
        "ROD" => r##"stroke="#0072b2" stroke-width="5" stroke-linecap="round""##,
        "CRANK" => r##"stroke="#333" stroke-width="7" stroke-linecap="round""##,
        "SLIDER" => r##"stroke="#333" stroke-width="2" stroke-linecap="round""##,
        "JOINTS" => r##"fill="white" stroke="#333" stroke-width="2""##,
        "CENTRES_OF_GRAVITY" => r##"fill="#d55e00" stroke="#333" stroke-width="1""##,
        _ => r##"fill="none" stroke="#999" stroke-width="1" stroke-dasharray="5 4""##,
    }
}

/// Visible rectangle of the plane, m.
#[derive(Clone, Copy)]
struct Window {
    left: f64,
    right: f64,
    low: f64,
    high: f64,
}

impl Window {
    /// Returns the scale, pixels per metre, and width and height of the drawing, pixels.
    fn scale(self) -> (f64, [f64; 2]) {
        let width = 640.0;
        let scale = width / (self.right - self.left);
        let height = (scale * (self.high - self.low)).ceil() + 40.0;
        (scale, [width, height])
    }
}

impl Sketch {
    /// Returns the sketch of the mechanism of a scene.
    pub fn of(scene: &Scene) -> Sketch {
        let centres = of_checked(scene).dead_centres.into_iter();
        Sketch {
            dimensions: Dimensions::of(scene),
            title: scene.title.clone().unwrap_or_default(),
            dead_centres: centres.map(|centre| centre.x).collect(),
        }
    }

    /// Returns half the height of the slider, m.
    fn size(&self) -> f64 {
        let Dimensions { crank, rod, .. } = self.dimensions;
        (0.12 * crank).max(0.03 * (crank + rod))
    }

    /// Returns the rectangle that holds the mechanism in all poses.
    fn window(&self, poses: impl Iterator<Item = Pose>) -> Window {
        let Dimensions { crank, offset, .. } = self.dimensions;
        let room = 3.0 * self.size();
        let places = poses
            .map(|pose| pose.x)
            .chain(self.dead_centres.iter().copied());
        let (left, right) = places.fold((-crank, crank), |(left, right), x| {
            (left.min(x), right.max(x))
        });
        Window {
            left: left - room,
            right: right + room,
            low: (-crank).min(-offset) - room,
            high: crank.max(-offset) + room,
        }
    }

    /// Returns the graphic elements of a pose with their DXF layers, in drawing order from back to front.
    fn elements(&self, pose: Pose, window: Window) -> Vec<(&'static str, Element)> {
        let Dimensions {
            crank, rod, offset, ..
        } = self.dimensions;
        let size = self.size();
        let (sin, cos) = pose.theta.sin_cos();
        let (pivot, pin, wrist) = ([0.0, 0.0], [crank * cos, crank * sin], [pose.x, -offset]);
        let square = |x: f64, layer| {
            let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
            let corner = move |k: usize| {
                let [right, up] = corners[k % 4];
                [x + right * size, -offset + up * size]
            };
            (0..4).map(move |k| (layer, Element::Line(corner(k), corner(k + 1))))
        };
        let guide = Element::Line([window.left, -offset], [window.right, -offset]);
        let mut elements = vec![("GROUND", guide), ("GROUND", Element::Circle(pivot, crank))];
        let centres = self.dead_centres.iter();
        elements.extend(centres.flat_map(|x| square(*x, "GROUND")));
        elements.push(("ROD", Element::Line(pin, wrist)));
        elements.push(("CRANK", Element::Line(pivot, pin)));
        elements.extend(square(pose.x, "SLIDER"));
        elements.extend([pivot, pin, wrist].map(|at| ("JOINTS", Element::Circle(at, 0.35 * size))));
        let along = [(wrist[0] - pin[0]) / rod, (wrist[1] - pin[1]) / rod];
        let (crank_cg, rod_cg) = (self.dimensions.crank_cg, self.dimensions.rod_cg);
        let crank_cg = crank_cg.map(|cg| placed(pivot, [cos, sin], cg));
        let rod_cg = rod_cg.map(|cg| placed(pin, along, cg));
        let marks = crank_cg.into_iter().chain(rod_cg);
        elements.extend(marks.map(|at| ("CENTRES_OF_GRAVITY", Element::Circle(at, 0.25 * size))));
        elements
    }

    /// Returns the mechanism in a pose as SVG.
    pub fn svg(&self, pose: Pose) -> String {
        self.frame(pose, self.window([pose].into_iter()), "")
    }

    /// Returns the mechanism in a pose as SVG, in a rectangle common to several poses, with a note below.
    fn frame(&self, pose: Pose, window: Window, note: &str) -> String {
        let (scale, [width, height]) = window.scale();
        let at = |[x, y]: [f64; 2]| (scale * (x - window.left), scale * (window.high - y) + 20.0);
        let (title, note) = (escaped(&self.title), escaped(note));
        let mut svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\" \
             role=\"img\">\n<title>{title}</title>\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n"
        );
        for (layer, element) in self.elements(pose, window) {
            let look = style(layer);
            let _ = match element {
                Element::Line(from, to) => {
                    let ((x1, y1), (x2, y2)) = (at(from), at(to));
                    writeln!(
                        svg,
                        "<line x1=\"{x1:.2}\" y1=\"{y1:.2}\" x2=\"{x2:.2}\" y2=\"{y2:.2}\" {look}/>"
                    )
                }
                Element::Circle(centre, radius) => {
                    let ((x, y), r) = (at(centre), scale * radius);
                    writeln!(
                        svg,
                        "<circle cx=\"{x:.2}\" cy=\"{y:.2}\" r=\"{r:.2}\" {look}/>"
                    )
                }
            };
        }
        for (y, words) in [(16.0, title), (height - 6.0, note)] {
            let _ = writeln!(
                svg,
                "<text x=\"8\" y=\"{y}\" font-family=\"sans-serif\" font-size=\"13\">{words}</text>"
            );
        }
        svg + "</svg>\n"
    }

    /// Returns the mechanism in a pose as DXF of AutoCAD R12: lines and circles in mm, a layer for each body.
    pub fn dxf(&self, pose: Pose) -> String {
        let mut dxf = String::from(
            "0\nSECTION\n2\nHEADER\n9\n$ACADVER\n1\nAC1009\n0\nENDSEC\n0\nSECTION\n2\nENTITIES\n",
        );
        let mm = |[x, y]: [f64; 2]| [1e3 * x, 1e3 * y];
        let window = self.window([pose].into_iter());
        for (layer, element) in self.elements(pose, window) {
            let _ = match element {
                Element::Line(from, to) => {
                    let ([x1, y1], [x2, y2]) = (mm(from), mm(to));
                    writeln!(
                        dxf,
                        "0\nLINE\n8\n{layer}\n10\n{x1}\n20\n{y1}\n11\n{x2}\n21\n{y2}"
                    )
                }
                Element::Circle(centre, radius) => {
                    let ([x, y], r) = (mm(centre), 1e3 * radius);
                    writeln!(dxf, "0\nCIRCLE\n8\n{layer}\n10\n{x}\n20\n{y}\n40\n{r}")
                }
            };
        }
        dxf + "0\nENDSEC\n0\nEOF\n"
    }
}

/// Returns the point of a body with coordinates `at`, along the axis `along` (unit vector) and to the left of it, m.
fn placed(origin: [f64; 2], along: [f64; 2], at: [f64; 2]) -> [f64; 2] {
    [
        origin[0] + at[0] * along[0] - at[1] * along[1],
        origin[1] + at[0] * along[1] + at[1] * along[0],
    ]
}

/// Writes the mechanism in motion as an endless GIF: one frame per pose, with a note below, shown for `hundredths` of
/// a second.
pub fn animation(
    sketch: &Sketch,
    frames: &[(Pose, String)],
    hundredths: u16,
    mut output: Output,
) -> Result<(), Error> {
    let window = sketch.window(frames.iter().map(|(pose, _)| *pose));
    let (_, sides) = window.scale();
    let [width, height] = sides.map(|side| side.min(65_535.0) as u16);
    // Colour quantisation from 1 (finest) to 30; a drawing has few colours.
    let quantisation_speed = 20;
    let mut bytes = Vec::new();
    let mut encoder = Encoder::new(&mut bytes, width, height, &[]).map_err(failed)?;
    encoder.set_repeat(Repeat::Infinite).map_err(failed)?;
    for (pose, note) in frames {
        let mut rgba = pixels(&sketch.frame(*pose, window, note), 1.0)?.take();
        let mut frame = Frame::from_rgba_speed(width, height, &mut rgba, quantisation_speed);
        frame.delay = hundredths;
        encoder.write_frame(&frame).map_err(failed)?;
    }
    drop(encoder);
    output.write(&bytes)?;
    output.finish()
}
