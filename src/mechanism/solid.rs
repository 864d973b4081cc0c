//! Mass properties of plates from a flat shape, its depth and its density.

use std::f64::consts::TAU;

/// Plane shape, symmetric to both axes, as area and second moments about its centre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shape {
    /// Area, m².
    pub area: f64,
    /// Second moment along the length, ∫ x², m⁴.
    pub along: f64,
    /// Second moment across the length, ∫ y², m⁴.
    pub across: f64,
}

/// Mass and principal moments of inertia about the centre of gravity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MassProperties {
    /// Mass, kg.
    pub mass: f64,
    /// Moment of inertia about the normal of the shape, kg m²: the one that counts in the plane of the mechanism.
    pub normal: f64,
    /// Moment of inertia about the axis across the length, in the plane, kg m².
    pub across: f64,
    /// Moment of inertia about the length, kg m².
    pub along: f64,
}

impl Shape {
    /// Returns a rectangle of a length and a width, m.
    pub fn rectangle(length: f64, width: f64) -> Shape {
        let area = length * width;
        Shape {
            area,
            along: area * length * length / 12.0,
            across: area * width * width / 12.0,
        }
    }

    /// Returns a link between two pins `length` apart with half-round ends of diameter `width`, m, each drawn as half
    /// of a regular polygon of `corners` corners, an even number, as drawing programs approximate a round end.
    pub fn polygon_ended(length: f64, width: f64, corners: u32) -> Shape {
        let (half, radius) = (0.5 * length, 0.5 * width);
        let side = TAU / f64::from(corners);
        let end = |sign: f64| {
            (0..=corners / 2).map(move |i| {
                let (sin, cos) = (f64::from(i) * side).sin_cos();
                [sign * (half + radius * sin), sign * -radius * cos]
            })
        };
        let outline: Vec<[f64; 2]> = end(1.0).chain(end(-1.0)).collect();
        Shape::polygon(&outline)
    }

    /// Returns the shape inside an outline of points (m), counter-clockwise around the centre.
    pub fn polygon(outline: &[[f64; 2]]) -> Shape {
        let mut shape = Shape {
            area: 0.0,
            along: 0.0,
            across: 0.0,
        };
        for (i, [ax, ay]) in outline.iter().enumerate() {
            let [bx, by] = outline[(i + 1) % outline.len()];
            let cross = ax * by - bx * ay;
            shape.area += cross / 2.0;
            shape.along += cross * (ax * ax + ax * bx + bx * bx) / 12.0;
            shape.across += cross * (ay * ay + ay * by + by * by) / 12.0;
        }
        shape
    }

    /// Returns the plate of this shape, of a depth (m) and a density (kg/m³).
    pub fn plate(&self, depth: f64, density: f64) -> MassProperties {
        let per_area = depth * density;
        let mass = self.area * per_area;
        let thick = mass * depth * depth / 12.0;
        MassProperties {
            mass,
            normal: per_area * (self.along + self.across),
            across: per_area * self.along + thick,
            along: per_area * self.across + thick,
        }
    }
}
