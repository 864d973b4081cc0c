//! Report of one turn in closed form: kinematics, forces, sensitivities and diagrams.

use std::fmt::Write;

use super::curves::CURVE_STEP;
use super::diagrams::{self, Diagram};
use super::key_values::{Facts, fact, given, six};
use super::rows::{REACTIONS, reactions};
use super::text::{NAME_WIDTH, extreme, kinematics};
use super::{DefaultView, Report, Table, View};
use crate::error::Error;
use crate::kinematics::{OneTurn, StrokeTorque, TurnRow};
use crate::scene::Scene;

const POSITION: &str =
    "theta_rad,x_m,dx_m_per_rad,d2x_m_per_rad2,phi_rad,dphi,d2phi,transmission_rad";
const RATES: &str = "v_m_per_s,a_m_per_s2,rod_omega_rad_per_s,rod_alpha_rad_per_s2";
const FORCES: &str = "crank_torque_nm,crank_inertia_x_n,crank_inertia_y_n,rod_inertia_x_n,rod_inertia_y_n,rod_inertia_couple_nm,slider_inertia_n,rod_axial_n,crank_tangential_n,crank_radial_n";
const FIRST_ORDER: &str = "a_first_order_m_per_s2,crank_torque_first_order_nm";

/// Report of one turn of a scene.
#[derive(Clone, Copy)]
pub struct TurnReport<'a> {
    /// Result of the analysis.
    pub result: &'a OneTurn,
    /// Scene of the analysis.
    pub scene: &'a Scene,
    /// Crank angle between rows, rad.
    pub every: f64,
    /// Diagram of the picture; none for columns of the rows.
    pub diagram: Option<Diagram>,
}

impl TurnReport<'_> {
    fn moves(&self) -> bool {
        self.result.kinematics.speed_rad_per_s.is_some()
    }

    /// Returns the CSV header; derivatives of the slider position are by time if the crank turns, else by its angle.
    fn columns(&self) -> String {
        let result = self.result;
        let derivatives = if self.moves() {
            [("x", "m"), ("v", "m_per_s"), ("a", "m_per_s2")]
        } else {
            [("x", "m"), ("dx", "m_per_rad"), ("d2x", "m_per_rad2")]
        };
        let mut columns = vec![POSITION.to_owned()];
        columns.extend(self.moves().then(|| RATES.to_owned()));
        if result.forces.is_some() {
            columns.push(format!("{FORCES},{REACTIONS},{FIRST_ORDER}"));
        }
        for length in ["crank", "rod", "offset"] {
            if result.has_slopes {
                // A derivative by a length has one factor m less in its unit.
                let name = |(name, unit): (&str, &str)| {
                    format!("{name}_by_{length}{}", unit.trim_start_matches('m'))
                };
                columns.extend(derivatives.map(name));
                let torque = self.moves();
                columns.extend(torque.then(|| format!("crank_torque_by_{length}_n")));
            }
        }
        if result.changed.is_some() {
            for word in ["change", "changed"] {
                columns.extend(derivatives.map(|(name, unit)| format!("{name}_{word}_{unit}")));
            }
        }
        columns.join(",")
    }
}

impl Report for TurnReport<'_> {
    fn facts(&self) -> Facts {
        let result = self.result;
        let mut facts = kinematics(&result.kinematics);
        forces(&mut facts, result);
        if let Some(found) = &result.diagrams {
            diagrams::facts(&mut facts, found);
        }
        facts
    }

    /// Returns the facts, followed by those of the changed lengths, if given.
    fn text(&self) -> String {
        let mut text = self.facts().lines(NAME_WIDTH);
        if let Some(changed) = &self.result.changed {
            let changed = kinematics(changed).lines(NAME_WIDTH);
            let _ = write!(text, "\nwith the changed lengths\n{changed}");
        }
        text
    }

    /// Returns the rows; for changed lengths with their change of the motion and the changed motion (not in CSV).
    fn table(&self) -> Table {
        let rows = self.result.rows(self.every).map(|row| values(&row));
        let mut table = Table::filled(&self.columns(), rows);
        table.plot_only_columns = if self.result.changed.is_some() { 3 } else { 0 };
        table
    }

    /// Returns the plot of slider motion, also with changed lengths, and driving torque, exact and first-order.
    fn default_view(&self) -> DefaultView<'_> {
        DefaultView {
            title: &self.result.kinematics.scene,
            show: match self.moves() {
                true => "x,x_changed,v,v_changed,a,a_changed,crank_torque,crank_torque_first_order",
                false => "x,x_changed,dx,dx_changed,d2x,d2x_changed",
            },
            over: "theta",
            scene: Some(self.scene),
            ..DefaultView::default()
        }
    }

    fn figure(&self, view: &View) -> Result<String, Error> {
        let Some(diagram) = self.diagram else {
            let every = CURVE_STEP;
            return view.svg(&TurnReport { every, ..*self }.table(), self.default_view());
        };
        let svg = diagram.svg(self.result, self.scene, view.size)?;
        svg.ok_or_else(|| {
            let help = match diagram {
                Diagram::PressureVolume => "the scene needs a load of the kind gas",
                _ => "the crank has to turn fully",
            };
            Error::refused(format!("there is no {} diagram", diagram.name()), help)
        })
    }

    fn page_figures(&self) -> Result<Vec<String>, Error> {
        let svg = |diagram: Diagram| diagram.svg(self.result, self.scene, None).transpose();
        Diagram::ALL.into_iter().filter_map(svg).collect()
    }
}

fn values(row: &TurnRow) -> Vec<f64> {
    let (at, rates) = (&row.kinematics.pose, row.kinematics.rates);
    let mut values = vec![row.kinematics.theta, at.x, at.dx, at.d2x];
    values.extend([at.phi(), at.dphi, at.d2phi, at.transmission()]);
    values.extend(rates.into_iter().flatten());
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
    if let Some(change) = row.change {
        let before = row.kinematics.motion();
        values.extend(change);
        values.extend([0, 1, 2].map(|i| before[i] + change[i]));
    }
    values
}

/// Returns the text of the lengths (m) chosen for a stroke.
pub fn sized(crank: f64, rod: f64) -> String {
    format!("sized: crank {} m, rod {} m", given(crank), given(rod))
}

fn forces(facts: &mut Facts, result: &OneTurn) {
    let Some(analysis) = &result.forces else {
        return;
    };
    let masses = &analysis.masses;
    let [rotating, reciprocating] = [masses.rotating_kg, masses.reciprocating_kg].map(six);
    fact!(facts, "rotating mass" => "{rotating} kg at the crank pin");
    fact!(facts, "reciprocating mass" => "{reciprocating} kg at the wrist pin");
    let turns = analysis.cycle_turns;
    if turns > 1 {
        fact!(facts, "forces" => "over {turns} turns, the cycle of the loads");
    }
    for (name, stroke) in [("outward", analysis.outward), ("inward", analysis.inward)] {
        if let Some(StrokeTorque { max, min }) = stroke {
            let [min, max] = [min, max].map(|found| extreme(&found, "N m"));
            let name = format!("torque, {name} stroke");
            fact!(facts, name => "{min} to {max}");
        }
    }
}
