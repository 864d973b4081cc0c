//! The drawing as DXF of AutoCAD R12: lines and circles in mm, a layer for each body.

use std::fmt::Write;

use super::{Part, Pose, Sketch};

impl Sketch {
    /// The mechanism at a pose.
    pub fn dxf(&self, pose: Pose) -> String {
        let mut dxf = String::from(
            "0\nSECTION\n2\nHEADER\n9\n$ACADVER\n1\nAC1009\n0\nENDSEC\n0\nSECTION\n2\nENTITIES\n",
        );
        let mm = |[x, y]: [f64; 2]| [1e3 * x, 1e3 * y];
        for part in self.parts(pose, self.extent(&[pose])) {
            let _ = match part {
                Part::Line { ends, layer } => {
                    let ([x1, y1], [x2, y2]) = (mm(ends[0]), mm(ends[1]));
                    let layer = layer.name();
                    writeln!(
                        dxf,
                        "0\nLINE\n8\n{layer}\n10\n{x1}\n20\n{y1}\n11\n{x2}\n21\n{y2}"
                    )
                }
                Part::Circle {
                    centre,
                    radius,
                    layer,
                } => {
                    let ([x, y], layer) = (mm(centre), layer.name());
                    let radius = 1e3 * radius;
                    writeln!(dxf, "0\nCIRCLE\n8\n{layer}\n10\n{x}\n20\n{y}\n40\n{radius}")
                }
            };
        }
        dxf.push_str("0\nENDSEC\n0\nEOF\n");
        dxf
    }
}
