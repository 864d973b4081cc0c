//! Report of a forward run: rows with energies, plots of the motion, orbit of a loose joint.

use std::f64::consts::TAU;

use super::curves::View;
use super::decimate::Decimated;
use super::key_values::Facts;
use super::rows::{MOST_PLOT_ROWS, cells, header};
use super::run::{self, speed_figure};
use super::table::Table;
use super::{DefaultView, Report};
use crate::error::Error;
use crate::figure::{Axis, Figure};
use crate::scene::Scene;
use crate::simulate::{Energies, Row, Summary};

/// Rows for a figure, at most 100 000; thinning keeps the largest contact forces.
#[derive(Debug)]
pub struct PlotRows {
    view: View,
    rows: Decimated<Row>,
}

impl PlotRows {
    /// Starts without rows; `view` selects the columns to draw.
    pub fn new(view: View) -> PlotRows {
        let force = |row: &Row| row.clearance.map_or(0.0, |joint| joint.force);
        PlotRows {
            view,
            rows: Decimated::weighted(MOST_PLOT_ROWS, force),
        }
    }

    /// Takes a row, and keeps it if its block has no row of larger contact force. The first row is refused if it lacks
    /// columns of the view.
    pub fn take(&mut self, row: &Row) -> Result<(), Error> {
        if self.rows.kept.is_empty() {
            self.view.check(&columns(row))?;
        }
        self.rows.take(*row);
        Ok(())
    }
}

/// Forward run with rows for pictures and text.
pub struct RunReport<'a> {
    /// Summary of the run.
    pub summary: &'a Summary,
    /// Scene of the run.
    pub scene: &'a Scene,
    /// Rows for picture and page.
    pub plot: &'a PlotRows,
    /// Rows for the text.
    pub preview: &'a [Row],
}

impl RunReport<'_> {
    fn rows(&self) -> &[Row] {
        &self.plot.rows.kept
    }

    /// Returns the path of the journal centre in the bearing and the clearance circle of radius `radial`, mm.
    fn orbit(&self, radial: f64) -> Figure {
        let path = self.rows().iter().filter_map(|row| row.clearance);
        let path = path.map(|joint| (1e3 * joint.journal[0], 1e3 * joint.journal[1]));
        let circle = (0..=180).map(|i| {
            let (sin, cos) = (f64::from(i) / 180.0 * TAU).sin_cos();
            (radial * cos, radial * sin)
        });
        Figure::new(
            "path of the journal's centre in the bearing",
            Axis::linear("along x [mm]"),
            Axis::linear("along y [mm]"),
        )
        .equal()
        .line("journal", path.collect())
        .dashed("radial clearance", circle.collect())
    }
}

impl Report for RunReport<'_> {
    fn facts(&self) -> Facts {
        run::run(self.summary)
    }

    fn text(&self) -> String {
        let text = self.facts().lines(17);
        match self.preview {
            [] => text,
            rows => text + "\n" + &run::table(rows),
        }
    }

    /// Returns the rows with kinetic, potential and total energy, and the deviation of the slider from ideal joints.
    fn table(&self) -> Table {
        let mut rows = self.rows().to_vec();
        // States inside a step arrive after all rows due in the step, out of order in time.
        rows.sort_by(|one, other| one.t.total_cmp(&other.t));
        let energies = Energies::of(self.scene);
        let with_derived = |row: &Row| {
            let energies = energies.as_ref().map(|energies| energies.at(row));
            let [kinetic, potential] = energies.unwrap_or([f64::NAN; 2]);
            let mut cells = cells(row);
            cells.extend([kinetic, potential, kinetic + potential]);
            cells.extend(row.clearance.map(|joint| row.x - joint.ideal[0]));
            cells
        };
        let header = rows.first().map_or(String::new(), columns);
        let mut table = Table::filled(&header, rows.iter().map(with_derived));
        table.stride = self.plot.rows.stride;
        table
    }

    /// Returns the plot of the slider motion and crank speed over time; for a loose joint, of the slider motion beside
    /// that of ideal joints, the contact force and the journal path.
    fn default_view(&self) -> DefaultView<'_> {
        let short = self.rows().last().is_some_and(|row| row.t < 0.5);
        let default = DefaultView {
            title: &self.summary.scene,
            show: "x,v,a,omega",
            over: if short { "t:ms" } else { "t" },
            columns: 2,
            scene: Some(self.scene),
            run: Some(self.summary),
            ..DefaultView::default()
        };
        let Some(joint) = &self.summary.clearance else {
            return default;
        };
        DefaultView {
            show: "x,x_ideal,v,v_ideal,a,a_ideal,contact_force,slider_deviation",
            extra_figures: vec![self.orbit(1e3 * joint.radial_m)],
            ..default
        }
    }

    fn page_figures(&self) -> Result<Vec<String>, Error> {
        let steady = self.summary.steady_state.iter();
        steady.map(speed_figure).collect()
    }
}

/// Returns the CSV header of rows like this one, with the derived columns.
fn columns(row: &Row) -> String {
    let mut names = header(row) + ",kinetic_energy_j,potential_energy_j,whole_energy_j";
    if row.clearance.is_some() {
        names.push_str(",slider_deviation_m");
    }
    names
}
