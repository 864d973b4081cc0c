//! Gupta, section 2.3 and figures 14 to 16: 1 mm of clearance at the crank pin B, by simulation.
//!
//! The paper gives the clearance alone. Assumptions: radial clearance, steel, bearing radius 10 mm, restitution 0.9,
//! dry friction 0.05.

use std::f64::consts::TAU;

use super::drawing::{Drawing, Plot, Series, Style};
use super::entry::{Entry, Printed};
use crate::error::Error;
use crate::scene::{Clearance, Every, Joint, Rod, Scene, Slider};
use crate::simulate::{Options, Row, simulate_rows};

/// Crank speeds, rpm: high, normal, low.
const SPEEDS: [f64; 3] = [400.0, 300.0, 30.0];
fn scene(speed: f64) -> Scene {
    let mut scene = Scene::new(0.14, 0.31)
        .offset(0.06)
        .rod(Rod {
            mass: 1.56,
            cg: 0.155,
            inertia: 14_559.334_82e-6,
            ..Rod::default()
        })
        .slider(Slider { mass: 1.95 })
        .constant_speed(0.0, speed * TAU / 60.0)
        .output_every(Every::Angle(1f64.to_radians()));
    scene.clearance = Some(Clearance {
        bearing_radius: Some(0.01),
        young_modulus: Some(207e9),
        poisson_ratio: Some(0.3),
        restitution: Some(0.9),
        friction: Some(0.05),
        ..Clearance::new(Joint::CrankPin, 1e-3)
    });
    scene
}

/// Simulates the turn shown at each speed, its crank angle from 0; returns comparisons with the paper, and its figures.
pub(super) fn results() -> Result<(Vec<Entry>, Vec<Drawing>), Error> {
    let options = Options {
        estimate: false,
        ..Options::default()
    };
    // In the turn before, the journal reaches the wall.
    let before = 1.0;
    let turn = |speed: &f64| {
        let mut rows: Vec<Row> = Vec::new();
        let scene = scene(*speed).revolutions(before + 1.0);
        simulate_rows(&scene, &options, &mut rows)?;
        rows.retain(|row| row.theta >= (before - 1e-9) * TAU);
        rows.iter_mut().for_each(|row| row.theta -= before * TAU);
        Ok(rows)
    };
    let turns: Vec<_> = SPEEDS.iter().map(turn).collect::<Result<_, Error>>()?;
    Ok((entries(&turns), drawings(&turns)))
}

fn entries(turns: &[Vec<Row>]) -> Vec<Entry> {
    let ideal = |row: &Row| row.clearance.map_or(f64::NAN, |joint| joint.ideal[0]);
    let all = || turns[0].iter().map(ideal);
    let stroke = all().fold(f64::MIN, f64::max) - all().fold(f64::MAX, f64::min);
    let little = |what: String, words: &str, offs: &mut dyn Iterator<Item = f64>| {
        let off = offs.fold(0.0, |most: f64, off| match off.is_nan() {
            true => off,
            false => most.max(off.abs()),
        });
        // 1 % of the stroke, about the line width of a figure.
        let printed = Printed::between(words, [0.0, 1.0]);
        Entry {
            place: "2.3, figure 14".to_owned(),
            what,
            unit: "% of stroke".to_owned(),
            ..Entry::judged(printed, Some(100.0 * off / stroke), None, false)
        }
    };
    let mut entries = Vec::new();
    for (speed, turn) in SPEEDS.iter().zip(turns) {
        let what = format!("effect of the clearance on the position, {speed} rpm");
        let mut offs = turn.iter().map(|row| row.x - ideal(row));
        entries.push(little(what, "very little", &mut offs));
    }
    for (speed, turn) in SPEEDS[1..].iter().zip(&turns[1..]) {
        let what = format!("position at 400 rpm, off that at {speed} rpm");
        let mut offs = turns[0].iter().zip(turn).map(|(high, low)| high.x - low.x);
        entries.push(little(what, "remains the same", &mut offs));
    }
    entries
}

fn drawings(turns: &[Vec<Row>]) -> Vec<Drawing> {
    let names = ["Displacement", "Velocity", "Acceleration"];
    let axes = [
        "slider position [m]",
        "slider velocity [m/s]",
        "slider acceleration [m/s2]",
    ];
    let figure = |(i, name): (usize, &str)| {
        let plots = SPEEDS.iter().zip(turns).map(|(speed, rows)| {
            let series = |label: String, style: Style, value: &dyn Fn(&Row) -> f64| {
                let point = |row: &Row| (row.theta.to_degrees(), value(row));
                let points = rows.iter().map(point).collect();
                Series {
                    label,
                    style,
                    points,
                }
            };
            let moved = |row: &Row| [row.x, row.v, row.a][i];
            let ideal = |row: &Row| row.clearance.map_or(f64::NAN, |joint| joint.ideal[i]);
            Plot {
                x: "crank angle [deg]".to_owned(),
                y: axes[i].to_owned(),
                series: vec![
                    series(format!("1 mm, {speed} rpm"), Style::Line, &moved),
                    series("without clearance".to_owned(), Style::Dashed, &ideal),
                ],
            }
        });
        Drawing::new(
            &format!("figure-{}", 14 + i),
            &format!("{name} of the slider with clearance"),
            plots.collect(),
        )
    };
    names.into_iter().enumerate().map(figure).collect()
}
