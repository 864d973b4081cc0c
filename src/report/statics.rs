//! Reports of static equilibrium over a turn, and of the calibration of a force sensor.

use super::curves::CURVE_STEP;
use super::key_values::{Facts, fact, given, six, text_table, with_error};
use super::quantity::{Quantity, split};
use super::text::{NAME_WIDTH, extreme, place};
use super::{DefaultView, Report, Table, View};
use crate::error::Error;
use crate::scene::Scene;
use crate::statics::{Calibration, StaticAnalysis, StaticsRow};

/// Report of static equilibrium over one turn.
#[derive(Clone, Copy)]
pub struct StaticsReport<'a> {
    /// Result of the analysis.
    pub result: &'a StaticAnalysis,
    /// Scene of the analysis.
    pub scene: &'a Scene,
    /// Crank angle between rows, rad.
    pub every: f64,
    /// Whether to write velocity ratio and crank pin angle to the CSV file.
    pub details: bool,
}

impl StaticsReport<'_> {
    /// Returns the column of the unknown load.
    fn sought(&self) -> Quantity {
        Quantity::of(match self.result.sought {
            "crank-torque" => "crank_torque_nm",
            _ => "slider_force_n",
        })
    }
}

impl Report for StaticsReport<'_> {
    fn facts(&self) -> Facts {
        let result = self.result;
        let Quantity { label, unit, .. } = self.sought();
        let mut facts = Facts::of(&result.scene);
        facts.add("class", result.class);
        fact!(facts, "sought" => "{label} beside the other loads");
        facts.add("friction coefficient", given(result.friction));
        for found in &result.least {
            facts.add("least", extreme(found, &unit));
        }
        for found in &result.least_with_friction {
            facts.add("least with friction", extreme(found, &unit));
        }
        for position in &result.positions {
            facts.add(position.kind, place(position));
        }
        facts.warnings(&result.warnings);
        facts
    }

    /// Returns the facts, and a table at multiples of 15 deg.
    fn text(&self) -> String {
        let Quantity { label, unit, .. } = self.sought();
        let header =
            format!("theta [deg],{label} [{unit}],from,to,side thrust [N],transmission [deg]");
        let rows = self.result.rows(15f64.to_radians()).map(|row| {
            let [_, value, min, max, thrust, transmission, ..] = cells(&row);
            let degrees = transmission.to_degrees();
            let shown = [value, min, max, thrust, degrees].map(|value| match value.is_finite() {
                true => format!("{value:.5}"),
                false => "-".to_owned(),
            });
            let theta = format!("{:.0}", row.theta.to_degrees());
            [theta].into_iter().chain(shown)
        });
        let table = text_table(&[11, 18, 14, 14, 16, 19], &header, rows);
        self.facts().lines(NAME_WIDTH) + "\n" + &table
    }

    fn table(&self) -> Table {
        let sought = self.sought().name;
        let (base, unit) = split(&sought);
        let header = format!(
            "theta_rad,{sought},{base}_min{unit},{base}_max{unit},side_thrust_n,transmission_rad,self_locking,velocity_ratio,crank_pin_angle_rad"
        );
        let rows = self.result.rows(self.every).map(|row| cells(&row));
        let mut table = Table::filled(&header, rows);
        table.plot_only_columns = if self.details { 0 } else { 2 };
        table
    }

    /// Returns the plot of the unknown load with its friction band, and the side thrust.
    fn default_view(&self) -> DefaultView<'_> {
        DefaultView {
            title: &self.result.scene,
            show: "slider_force,crank_torque,side_thrust",
            over: "theta",
            has_poles: true,
            scene: Some(self.scene),
            ..DefaultView::default()
        }
    }

    fn figure(&self, view: &View) -> Result<String, Error> {
        let every = CURVE_STEP;
        view.svg(
            &StaticsReport { every, ..*self }.table(),
            self.default_view(),
        )
    }
}

fn cells(row: &StaticsRow) -> [f64; 9] {
    let cell = |value: Option<f64>| value.unwrap_or(f64::NAN);
    let band = row.balance.band;
    [
        row.theta,
        cell(band.map(|band| band.value)),
        cell(band.and_then(|band| band.min)),
        cell(band.and_then(|band| band.max)),
        cell(row.balance.side_thrust),
        row.transmission,
        f64::from(u8::from(row.balance.self_locking)),
        row.velocity_ratio,
        row.crank_pin_angle,
    ]
}

/// Returns the calibration line, its statistics, and the forces of the readings, as text.
pub fn calibration(result: &Calibration) -> String {
    let mut facts = Facts::of("");
    let fit = &result.fit;
    let shown = |value: f64, se: Option<f64>| match se {
        Some(se) => with_error(value, se, ""),
        None => six(value),
    };
    facts.add("points", fit.points);
    let slope = shown(fit.slope, fit.slope_se);
    fact!(facts, "slope" => "{slope} per N");
    facts.add("intercept", shown(fit.intercept, fit.intercept_se));
    if let Some(r_squared) = fit.r_squared {
        facts.add("R squared", given(r_squared));
    }
    for measured in &result.forces {
        let force = shown(measured.force_n, measured.force_se_n);
        let reading = given(measured.reading);
        fact!(facts, "force" => "{force} N for a reading of {reading}");
    }
    facts.warnings(&result.warnings);
    facts.lines(12)
}
