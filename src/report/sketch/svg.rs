//! The drawing as SVG.

use std::fmt::Write;

use super::{Extent, Layer, Part, Pose, Sketch};
use crate::report::figure::escaped;

/// Width of the drawing, pixels.
const WIDTH: f64 = 640.0;

impl Sketch {
    /// The mechanism at a pose.
    pub fn svg(&self, pose: Pose) -> String {
        self.frame(pose, self.extent(&[pose]), "")
    }

    /// The mechanism at a pose, in a frame that may be shared by others, with a note below.
    pub(super) fn frame(&self, pose: Pose, extent: Extent, note: &str) -> String {
        let scale = WIDTH / (extent.right - extent.left);
        let height = (scale * (extent.high - extent.low)).ceil() + 40.0;
        let at = |[x, y]: [f64; 2]| (scale * (x - extent.left), scale * (extent.high - y) + 20.0);
        let mut svg = String::new();
        let title = escaped(&self.title);
        let _ = write!(
            svg,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{WIDTH}\" height=\"{height}\" viewBox=\"0 0 {WIDTH} {height}\" \
             role=\"img\">\n<title>{title}</title>\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n"
        );
        for part in self.parts(pose, extent) {
            let _ = match part {
                Part::Line {
                    ends: [from, to],
                    layer,
                } => {
                    let ((x1, y1), (x2, y2)) = (at(from), at(to));
                    let look = look(layer);
                    writeln!(
                        svg,
                        "<line x1=\"{x1:.2}\" y1=\"{y1:.2}\" x2=\"{x2:.2}\" y2=\"{y2:.2}\" {look}/>"
                    )
                }
                Part::Circle {
                    centre,
                    radius,
                    layer,
                } => {
                    let ((cx, cy), r, look) = (at(centre), scale * radius, look(layer));
                    writeln!(
                        svg,
                        "<circle cx=\"{cx:.2}\" cy=\"{cy:.2}\" r=\"{r:.2}\" {look}/>"
                    )
                }
            };
        }
        let text = |y: f64, words: &str| {
            format!(
                "<text x=\"8\" y=\"{y}\" font-family=\"sans-serif\" font-size=\"13\">{words}</text>\n"
            )
        };
        svg.push_str(&text(16.0, &title));
        svg.push_str(&text(height - 6.0, &escaped(note)));
        svg.push_str("</svg>\n");
        svg
    }
}

fn look(layer: Layer) -> &'static str {
    match layer {
        Layer::Ground => {
            "fill=\"none\" stroke=\"#999\" stroke-width=\"1\" stroke-dasharray=\"5 4\""
        }
        Layer::Rod => "stroke=\"#0072b2\" stroke-width=\"5\" stroke-linecap=\"round\"",
        Layer::Crank => "stroke=\"#333\" stroke-width=\"7\" stroke-linecap=\"round\"",
        Layer::Slider => "stroke=\"#333\" stroke-width=\"2\" stroke-linecap=\"round\"",
        Layer::Joint => "fill=\"white\" stroke=\"#333\" stroke-width=\"2\"",
        Layer::CentreOfGravity => "fill=\"#d55e00\" stroke=\"#333\" stroke-width=\"1\"",
    }
}
