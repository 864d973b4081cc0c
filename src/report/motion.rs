//! The motion of a run as a figure and as a page.

use std::f64::consts::TAU;

use super::curves::{Shown, View};
use super::decimate::Thinned;
use super::figure::{Axis, Figure};
use super::page::{Origin, Page};
use super::rows::{cells, header};
use super::steady::speed_figure;
use super::table::Table;
use super::text::facts;
use crate::error::Error;
use crate::scene::Scene;
use crate::simulate::{Energies, Row, Summary};

/// Rows for a figure, thinned out where there are more than a figure can show: the largest contact forces are kept.
#[derive(Debug)]
pub struct PlotRows {
    view: View,
    rows: Thinned<Row>,
}

/// Most rows that are kept.
const ROWS_KEPT: usize = 100_000;

impl PlotRows {
    /// No rows yet; what is to be seen of them.
    pub fn new(view: View) -> PlotRows {
        let force = |row: &Row| row.clearance.map_or(0.0, |joint| joint.force);
        PlotRows {
            view,
            rows: Thinned::weighted(ROWS_KEPT, force),
        }
    }

    /// Takes a row.
    ///
    /// # Errors
    /// [`Error::Refused`] at the first row if it has not the columns that are to be seen.
    pub fn take(&mut self, row: &Row) -> Result<(), Error> {
        if self.rows.kept().is_empty() {
            self.view.check(&columns(row))?;
        }
        self.rows.take(*row);
        Ok(())
    }

    /// The rows by columns, with their energies, and how far the slider is from where ideal joints would have it.
    fn table(&self, scene: &Scene) -> Table {
        let mut rows = self.rows.kept().to_vec();
        // States at steps come after the rows inside of the step.
        rows.sort_by(|one, other| one.t.total_cmp(&other.t));
        let energies = Energies::of(scene);
        let mut table = Table::new(&rows.first().map_or(String::new(), columns));
        table.stride = self.rows.stride();
        for row in &rows {
            let [kinetic, potential] = energies
                .as_ref()
                .map_or([f64::NAN; 2], |energies| energies.at(row));
            let mut cells = cells(row);
            cells.extend([kinetic, potential, kinetic + potential]);
            cells.extend(row.clearance.map(|joint| row.x - joint.ideal[0]));
            table.push(cells);
        }
        table
    }

    /// The run as one page.
    ///
    /// # Errors
    /// [`Error::Write`].
    pub fn page(&self, summary: &Summary, scene: &Scene, origin: &Origin) -> Result<String, Error> {
        let steady = summary
            .steady_state
            .as_ref()
            .map(speed_figure)
            .transpose()?;
        Page::new(origin, &facts(summary))
            .figures(steady.into_iter().collect())
            .table(&self.table(scene))
            .mechanism(scene)
            .terms(summary)
            .events(&summary.events, summary.events_total)
            .html()
    }

    /// What is to be seen as SVG: by itself the slider's motion over time, beside that of ideal joints where a joint is
    /// loose, with the contact force and the journal's path; else the crank's speed.
    ///
    /// # Errors
    /// [`Error::Refused`] if there is nothing to draw.
    pub fn to_svg(&self, summary: &Summary, scene: &Scene) -> Result<String, Error> {
        let short = self.rows.kept().last().is_some_and(|row| row.t < 0.5);
        let mut shown = Shown {
            title: &summary.scene,
            show: &["x", "v", "a", "omega"],
            over: if short { "t:ms" } else { "t" },
            columns: 2,
            ..Shown::default()
        };
        if let Some(joint) = &summary.clearance {
            shown.show = &[
                "x",
                "x_ideal",
                "v",
                "v_ideal",
                "a",
                "a_ideal",
                "contact_force",
                "slider_deviation",
            ];
            shown.beside = vec![self.orbit(1e3 * joint.radial_m)];
        }
        self.view.svg(&self.table(scene), shown)
    }

    /// Path of the journal's centre in the bearing, with the circle of the clearance, mm.
    fn orbit(&self, radial: f64) -> Figure {
        let path = self.rows.kept().iter().filter_map(|row| row.clearance);
        let path: Vec<_> = path
            .map(|joint| (1e3 * joint.journal[0], 1e3 * joint.journal[1]))
            .collect();
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
        .line("journal", path)
        .dashed("radial clearance", circle.collect())
    }
}

/// Names of the columns that are drawn of rows like this one.
fn columns(row: &Row) -> String {
    let mut names = header(row);
    names.push_str(",kinetic_energy_j,potential_energy_j,whole_energy_j");
    if row.clearance.is_some() {
        names.push_str(",slider_deviation_m");
    }
    names
}
