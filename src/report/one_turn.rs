//! One turn as CSV, text and figure.

use std::fmt::Write;

use super::csv::{line, write_all};
use super::key_values::{Facts, degrees, fact, given, six};
use super::page::{Origin, Page, Table};
use super::rows::{REACTIONS, reactions};
use super::text::{NAMES, extreme, kinematics};
use super::{Axis, Figure, Output, panels};
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
    let mut table = Table::new(&columns(result));
    for row in result.rows(every) {
        table.push(values(&row));
    }
    Page::new(origin, &facts(result))
        .table(&table)
        .mechanism(scene)
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

/// Slider position, velocity and acceleration over the crank angle, with those of the changed lengths, and
/// the driving torque, exact and to first order.
pub fn turn_figure(result: &OneTurn) -> Result<String, Error> {
    let moves = result.kinematics.speed_rad_per_s.is_some();
    let quantities = if moves {
        [
            "slider position [m]",
            "slider velocity [m/s]",
            "slider acceleration [m/s2]",
        ]
    } else {
        ["slider position [m]", "x' [m/rad]", "x'' [m/rad2]"]
    };
    let rows: Vec<TurnRow> = result.rows(1f64.to_radians()).collect();
    let of = |value: &dyn Fn(&TurnRow) -> f64| -> Vec<(f64, f64)> {
        let point = |row: &TurnRow| (row.kinematics.theta.to_degrees(), value(row));
        rows.iter().map(point).collect()
    };
    let angle = || Axis::degrees("crank angle θ [°]").range(0.0, 360.0 * f64::from(result.turns()));
    let mut figures: Vec<Figure> = quantities
        .into_iter()
        .enumerate()
        .map(|(i, name)| {
            let motion = move |row: &TurnRow| match row.kinematics.rates {
                Some([v, a, ..]) => [row.kinematics.x, v, a][i],
                None => [row.kinematics.x, row.kinematics.dx, row.kinematics.d2x][i],
            };
            let figure = Figure::new("", angle(), Axis::linear(name));
            match result.changed {
                None => figure.line("", of(&motion)),
                Some(_) => {
                    let changed =
                        move |row: &TurnRow| motion(row) + row.change.map_or(f64::NAN, |c| c[i]);
                    figure
                        .line("scene", of(&motion))
                        .dashed("changed lengths", of(&changed))
                }
            }
        })
        .collect();
    if result.forces.is_some() {
        let value = |row: &TurnRow, first: bool| {
            row.forces.map_or(f64::NAN, |forces| {
                if first {
                    forces.first_order_torque
                } else {
                    forces.torque
                }
            })
        };
        figures.push(
            Figure::new("", angle(), Axis::linear("driving torque [N m]"))
                .line("exact", of(&|row| value(row, false)))
                .dashed(
                    "reciprocating mass, first order",
                    of(&|row| value(row, true)),
                ),
        );
    }
    panels(&result.kinematics.scene, &figures, 1)
}
