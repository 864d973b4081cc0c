//! The motion of a run as a figure.

use std::f64::consts::TAU;

use super::decimate::Thinned;
use super::figure::{Axis, Figure, panels};
use super::page::{Origin, Page, Table};
use super::rows::{cells, header};
use super::text::facts;
use crate::error::Error;
use crate::scene::Scene;
use crate::simulate::{Energies, Row, Summary};

/// Rows for a figure, evenly thinned out where there are more than a figure can show.
#[derive(Debug)]
pub struct PlotRows(Thinned<Row>);

/// Of the area of one panel in two columns, so that a circle looks like one.
const WIDTH_OVER_HEIGHT: f64 = 1.65;

/// Most rows that are kept.
const MOST: usize = 100_000;

impl Default for PlotRows {
    fn default() -> PlotRows {
        PlotRows(Thinned::new(MOST))
    }
}

impl PlotRows {
    /// Takes a row.
    pub fn take(&mut self, row: &Row) {
        self.0.take(*row);
    }

    /// The rows by columns, with their energies.
    fn table(&self, scene: &Scene) -> Table {
        let rows = self.0.kept();
        let energies = Energies::of(scene);
        let mut names = rows.first().map_or(String::new(), header);
        if energies.is_some() {
            names.push_str(",kinetic_energy_j,potential_energy_j,whole_energy_j");
        }
        let mut table = Table::new(&names);
        table.stride = self.0.stride();
        for row in rows {
            let mut cells = cells(row);
            if let Some(energies) = &energies {
                let [kinetic, potential] = energies.at(row);
                cells.extend([kinetic, potential, kinetic + potential]);
            }
            table.push(cells);
        }
        table
    }

    /// The run as one page.
    ///
    /// # Errors
    /// [`Error::Write`].
    pub fn page(&self, summary: &Summary, scene: &Scene, origin: &Origin) -> Result<String, Error> {
        Page::new(origin, &facts(summary))
            .table(&self.table(scene))
            .mechanism(scene)
            .terms(summary)
            .events(&summary.events, summary.events_total)
            .html()
    }

    /// Slider motion over time, beside that of ideal joints where a joint is loose, with the contact force and
    /// the journal's path; else the crank's speed.
    ///
    /// # Errors
    /// [`Error::Refused`] if there is nothing to draw.
    pub fn to_svg(&self, summary: &Summary) -> Result<String, Error> {
        let end = self.0.kept().last().map_or(0.0, |row| row.t);
        let (scale, unit) = if end < 0.5 { (1e3, "ms") } else { (1.0, "s") };
        let over_time = |title: &str, axis: &str| {
            Figure::new(
                title,
                Axis::linear(format!("time [{unit}]")),
                Axis::linear(axis),
            )
        };
        let series = |value: &dyn Fn(&Row) -> f64| -> Vec<(f64, f64)> {
            self.0
                .kept()
                .iter()
                .map(|row| (scale * row.t, value(row)))
                .collect()
        };
        let loose = self.0.kept().iter().any(|row| row.clearance.is_some());
        let ideal = |row: &Row, index: usize| row.clearance.map_or(f64::NAN, |c| c.ideal[index]);
        type Column = fn(&Row) -> f64;
        let columns: [(&str, &str, f64, Column); 3] = [
            ("slider position", "x [mm]", 1e3, |row| row.x),
            ("slider velocity", "v [m/s]", 1.0, |row| row.v),
            ("slider acceleration", "a [m/s²]", 1.0, |row| row.a),
        ];
        let mut figures = Vec::new();
        for (index, (title, axis, factor, column)) in columns.into_iter().enumerate() {
            let mut figure = over_time(title, axis);
            let label = if loose { "with clearance" } else { "" };
            figure = figure.line(label, series(&|row| factor * column(row)));
            if loose {
                figure = figure.dashed("ideal joints", series(&|row| factor * ideal(row, index)));
            }
            figures.push(figure);
        }
        match &summary.clearance {
            Some(joint) => {
                let force = |row: &Row| row.clearance.map_or(f64::NAN, |c| c.force);
                figures.push(over_time("contact force", "F [N]").line("", series(&force)));
                let off = |row: &Row| 1e3 * (row.x - ideal(row, 0));
                figures.push(
                    over_time("slider position, off the ideal joint's", "x - x ideal [mm]")
                        .line("", series(&off)),
                );
                figures.push(self.orbit(1e3 * joint.radial_m));
            }
            None => figures
                .push(over_time("crank speed", "ω [rad/s]").line("", series(&|row| row.omega))),
        }
        panels(&summary.scene, &figures, 2)
    }

    /// Path of the journal's centre in the bearing, with the circle of the clearance, mm.
    fn orbit(&self, radial: f64) -> Figure {
        let path = self.0.kept().iter().filter_map(|row| row.clearance);
        let path: Vec<_> = path
            .map(|joint| (1e3 * joint.journal[0], 1e3 * joint.journal[1]))
            .collect();
        let reach = path
            .iter()
            .fold(radial, |most, (x, y)| most.max(x.hypot(*y)));
        let circle = (0..=180).map(|i| {
            let (sin, cos) = (f64::from(i) / 180.0 * TAU).sin_cos();
            (radial * cos, radial * sin)
        });
        let axis = |name: &str, most: f64| Axis::linear(name).range(-most, most);
        Figure::new(
            "path of the journal's centre in the bearing",
            axis("along x [mm]", 1.1 * WIDTH_OVER_HEIGHT * reach),
            axis("along y [mm]", 1.1 * reach),
        )
        .line("journal", path)
        .dashed("radial clearance", circle.collect())
    }
}
