//! One turn as CSV, text and figure.

use std::f64::consts::PI;
use std::fmt::Write;

use super::Output;
use super::csv::{line, write_all};
use super::curves::{Shown, View};
use super::diagrams::{self, Diagram};
use super::key_values::{Facts, degrees, fact, given, six};
use super::page::{Origin, Page};
use super::rows::{REACTIONS, reactions};
use super::table::Table;
use super::text::{NAMES, extreme, kinematics};
use crate::error::Error;
use crate::kinematics::{ForceAnalysis, Located, OffsetExtremes, OneTurn, StrokeTorque, TurnRow};
use crate::scene::Scene;

const POSITION: &str =
    "theta_rad,x_m,dx_m_per_rad,d2x_m_per_rad2,phi_rad,dphi,d2phi,transmission_rad";
const RATES: &str = "v_m_per_s,a_m_per_s2,rod_omega_rad_per_s,rod_alpha_rad_per_s2";
const FORCES: &str = "crank_torque_nm,crank_inertia_x_n,crank_inertia_y_n,rod_inertia_x_n,rod_inertia_y_n,rod_inertia_couple_nm,slider_inertia_n,rod_axial_n,crank_tangential_n,crank_radial_n";
const FIRST_ORDER: &str = "a_first_order_m_per_s2,crank_torque_first_order_nm";

/// Writes the rows of `kinematics`, so many radians apart.
pub fn turn_rows(result: &OneTurn, every: f64, output: Output) -> Result<(), Error> {
    let rows: Vec<TurnRow> = result.rows(every).collect();
    write_all(output, &columns(result), &rows, |row, text| {
        line(values(row), text)
    })
}

/// One turn as one page.
///
/// # Errors
/// [`Error::Write`].
pub fn turn_page(
    result: &OneTurn,
    every: f64,
    scene: &Scene,
    origin: &Origin,
) -> Result<String, Error> {
    let mut diagrams = Vec::new();
    for diagram in Diagram::ALL {
        diagrams.extend(diagram.svg(result, scene, None)?);
    }
    Page::new(origin, &facts(result))
        .table(&turn_table(result, every))
        .mechanism(scene)
        .figures(diagrams)
        .html()
}

fn columns(result: &OneTurn) -> String {
    let moves = result.kinematics.speed_rad_per_s.is_some();
    let mut columns = vec![POSITION.to_owned()];
    columns.extend(moves.then(|| RATES.to_owned()));
    if result.forces.is_some() {
        columns.push(format!("{FORCES},{REACTIONS},{FIRST_ORDER}"));
    }
    if result.has_slopes() {
        for length in ["crank", "rod", "offset"] {
            columns.push(if moves {
                format!("x_by_{length},v_by_{length}_per_s,a_by_{length}_per_s2,crank_torque_by_{length}_n")
            } else {
                format!("x_by_{length},dx_by_{length}_per_rad,d2x_by_{length}_per_rad2")
            });
        }
    }
    let change = if moves {
        "x_change_m,v_change_m_per_s,a_change_m_per_s2"
    } else {
        "x_change_m,dx_change_m_per_rad,d2x_change_m_per_rad2"
    };
    columns.extend(result.changed.as_ref().map(|_| change.to_owned()));
    columns.join(",")
}

fn values(row: &TurnRow) -> Vec<f64> {
    let at = &row.kinematics;
    let mut values = vec![
        at.theta,
        at.x,
        at.dx,
        at.d2x,
        at.phi,
        at.dphi,
        at.d2phi,
        at.transmission,
    ];
    values.extend(at.rates.into_iter().flatten());
    if let Some(forces) = &row.forces {
        values.push(forces.torque);
        values.extend(forces.inertia.crank);
        values.extend(forces.inertia.rod);
        values.extend([
            forces.inertia.rod_couple,
            forces.inertia.slider,
            forces.rod_axial,
            forces.crank_tangential,
            forces.crank_radial,
        ]);
        values.extend(reactions(&forces.reactions));
        values.extend([forces.first_order_acceleration, forces.first_order_torque]);
    }
    for slope in row.slopes.iter().flatten() {
        values.extend([slope.x, slope.v, slope.a]);
        values.extend(slope.torque);
    }
    values.extend(row.change.into_iter().flatten());
    values
}

/// The lengths (m) that were chosen for a stroke.
pub fn sized(crank: f64, rod: f64) -> String {
    format!("sized: crank {} m, rod {} m", given(crank), given(rod))
}

/// What the lengths give, and what was asked for beside it.
pub fn turn(result: &OneTurn) -> String {
    let mut text = facts(result).lines(NAMES);
    if let Some(changed) = &result.changed {
        let changed = kinematics(changed).lines(NAMES);
        let _ = write!(text, "\nwith the changed lengths\n{changed}");
    }
    text
}

fn facts(result: &OneTurn) -> Facts {
    let mut facts = kinematics(&result.kinematics);
    if let Some(analysis) = &result.forces {
        forces(&mut facts, analysis);
    }
    if let Some(found) = &result.diagrams {
        diagrams::facts(&mut facts, found);
    }
    let unit = match result.kinematics.speed_rad_per_s {
        Some(_) => "m/s2",
        None => "m/rad2",
    };
    for with in &result.offsets {
        let name = format!("with offset {} m", given(with.offset_m));
        facts.add(name, offset(with, unit));
    }
    if let Some(check) = &result.loop_closure {
        fact!(
            facts,
            "Newton-Raphson",
            "from {} deg: {} to {} steps; {} angles on the scene's branch, {} on the other, {} without end",
            degrees(check.guess_rad),
            check.iterations_min,
            check.iterations_max,
            check.on_branch,
            check.on_other_branch,
            check.failed
        );
        let worst = check.worst_x_m;
        fact!(facts, "  off the closed form", "{worst:.1e} m");
    }
    facts
}

fn forces(facts: &mut Facts, analysis: &ForceAnalysis) {
    let masses = &analysis.masses;
    let rotating = six(masses.rotating_kg);
    fact!(facts, "rotating mass", "{rotating} kg at the crank pin");
    let reciprocating = six(masses.reciprocating_kg);
    fact!(
        facts,
        "reciprocating mass",
        "{reciprocating} kg at the wrist pin"
    );
    if analysis.cycle_turns > 1 {
        let turns = analysis.cycle_turns;
        fact!(
            facts,
            "forces",
            "over {turns} turns, the cycle of the loads"
        );
    }
    for (name, stroke) in [("outward", analysis.outward), ("inward", analysis.inward)] {
        if let Some(StrokeTorque { max, min }) = stroke {
            let [min, max] = [min, max].map(|found| extreme(&found, "N m"));
            let name = format!("torque, {name} stroke");
            fact!(facts, name, "{min} to {max}");
        }
    }
}

/// Stroke and extremes with another offset, the acceleration in this unit.
fn offset(with: &OffsetExtremes, unit: &str) -> String {
    let mut line = format!("stroke {} m", six(with.stroke_m));
    let mut add = |name: &str, found: Option<Located>, unit: &str| {
        if let Some(Located { value, theta_rad }) = found {
            let (value, angle) = (six(value), degrees(theta_rad));
            let _ = write!(line, "; {name} {value} {unit} at {angle} deg");
        }
    };
    add("largest acceleration", with.acceleration_max, unit);
    add("smallest", with.acceleration_min, unit);
    for (name, stroke) in [("outward", with.outward), ("inward", with.inward)] {
        add(&format!("{name} torque from"), stroke.map(|s| s.min), "N m");
        add("to", stroke.map(|s| s.max), "N m");
    }
    line
}

/// The rows by columns, so many radians apart, with the motion of the changed lengths beside that of the scene.
pub fn turn_table(result: &OneTurn, every: f64) -> Table {
    let mut names = columns(result);
    let moves = result.kinematics.speed_rad_per_s.is_some();
    if result.changed.is_some() {
        names.push_str(if moves {
            ",x_changed_m,v_changed_m_per_s,a_changed_m_per_s2"
        } else {
            ",x_changed_m,dx_changed_m_per_rad,d2x_changed_m_per_rad2"
        });
    }
    let mut table = Table::new(&names);
    for row in result.rows(every) {
        let at = &row.kinematics;
        let motion = match at.rates {
            Some([v, a, ..]) => [at.x, v, a],
            None => [at.x, at.dx, at.d2x],
        };
        let mut cells = values(&row);
        if let Some(change) = row.change {
            cells.extend(
                motion
                    .iter()
                    .zip(change)
                    .map(|(value, change)| value + change),
            );
        }
        table.push(cells);
    }
    table
}

/// Crank angle between the points of a figure, rad.
const SPACING: f64 = PI / 360.0;

/// What is to be seen over the crank angle, as SVG: by itself the slider's motion, with that of the changed lengths, and
/// the driving torque, exact and to first order.
///
/// # Errors
/// [`Error::Refused`] if a column is not there.
pub fn turn_figure(result: &OneTurn, view: &View) -> Result<String, Error> {
    let shown = Shown {
        title: &result.kinematics.scene,
        show: match result.kinematics.speed_rad_per_s {
            Some(_) => &[
                "x",
                "x_changed",
                "v",
                "v_changed",
                "a",
                "a_changed",
                "crank_torque",
                "crank_torque_first_order",
            ],
            None => &["x", "x_changed", "dx", "dx_changed", "d2x", "d2x_changed"],
        },
        ..Shown::default()
    };
    view.svg(&turn_table(result, SPACING), shown)
}
