//! Gupta, section 2.3 and figures 14 to 16: 1 mm of clearance at the crank pin B, by simulation.
//!
//! The paper gives the clearance alone. Assumptions: radial clearance, steel, bearing radius 10 mm, restitution 0.9,
//! dry friction 0.05.

use std::f64::consts::TAU;

use crate::error::Error;
use crate::scene::{Every, Scene};
use crate::simulate::{Options, Row, simulate_rows};

/// Crank speeds by name, rpm: high, normal, low.
const SPEEDS: [(&str, f64); 3] = [("rpm400", 400.0), ("rpm300", 300.0), ("rpm30", 30.0)];

/// One turn at each of [`SPEEDS`], a row for each degree.
pub(super) struct LooseTurns([Vec<Row>; 3]);

impl LooseTurns {
    /// Simulates the second turn at each speed: in the turn before, the journal reaches the wall.
    pub fn new() -> Result<LooseTurns, Error> {
        let options = Options {
            estimate: false,
            ..Options::default()
        };
        let text = include_str!("../../data/gupta-clearance-300rpm.toml");
        let scene = Scene::parse("gupta-clearance-300rpm.toml".as_ref(), text)?;
        let scene = scene.revolutions(2.0);
        let scene = scene.output_every(Every::Angle(1f64.to_radians()));
        let mut turns = LooseTurns([const { Vec::new() }; 3]);
        for ((_, speed), rows) in SPEEDS.iter().zip(&mut turns.0) {
            let scene = scene.clone().constant_speed(0.0, speed * TAU / 60.0);
            simulate_rows(&scene, &options, rows)?;
            rows.retain(|row| row.theta >= (1.0 - 1e-9) * TAU);
        }
        Ok(turns)
    }

    /// Returns a quantity by the name SPEED_QUANTITY, at a crank angle, rad; lengths, m, of the largest effect of the
    /// clearance on the slider position, and of its largest distance from the position at 400 rpm.
    pub fn value(&self, name: &str, theta: f64) -> Option<f64> {
        let (speed, quantity) = name.split_once('_')?;
        let turn = SPEEDS.iter().position(|(known, _)| *known == speed)?;
        let rows = &self.0[turn];
        let row = rows.get(theta.to_degrees().round() as usize)?;
        let ideal = row.clearance?.ideal;
        let largest = |of: &mut dyn Iterator<Item = f64>| of.fold(0.0, |most, x| x.abs().max(most));
        Some(match quantity {
            "x" => row.x,
            "v" => row.v,
            "a" => row.a,
            "ideal_x" => ideal[0],
            "ideal_v" => ideal[1],
            "ideal_a" => ideal[2],
            "effect" => {
                let offs = rows.iter().map(|row| Some(row.x - row.clearance?.ideal[0]));
                largest(&mut offs.flatten())
            }
            "off" => largest(&mut rows.iter().zip(&self.0[0]).map(|(a, b)| a.x - b.x)),
            _ => return None,
        })
    }
}
