//! Standard diagrams of a cycle at constant speed: turning moment, indicator diagram, polar load diagrams of pins and
//! bearings, orders, first-order balance.

use super::curves::CURVE_STEP;
use super::key_values::{Facts, degrees, fact, six};
use crate::error::Error;
use crate::figure::{Axis, Figure, Shape, sheet};
use crate::kinematics::{Diagrams, OneTurn, Order, TurnRow};
use crate::scene::{Load, Scene};
use crate::simulate::Reactions;

named! {
    /// Diagram of forces over a cycle at constant speed.
    pub enum Diagram {
        /// Driving torque, its mean, and the areas between them.
        TurningMoment = "turning-moment",
        /// Pressure over swept volume.
        PressureVolume = "pressure-volume",
        /// Loads on crank pin and crank bearing in the crank frame, on crank bearing and wrist pin in the fixed frame.
        Polar = "polar",
        /// Amplitudes of shaking force and driving torque by order.
        Orders = "orders",
        /// Shaking force, without and with the counterweight.
        Balance = "balance",
    }
}

impl Diagram {
    /// Returns the diagram as SVG; none if the scene lacks the load or cycle it shows. Refused if it does not fit into
    /// `size`.
    pub fn svg(
        self,
        result: &OneTurn,
        scene: &Scene,
        size: Option<Shape>,
    ) -> Result<Option<String>, Error> {
        let Some(diagrams) = &result.diagrams else {
            return Ok(None);
        };
        let rows: Vec<TurnRow> = result.rows(CURVE_STEP).collect();
        let figures = match self {
            Diagram::TurningMoment => vec![turning_moment(diagrams, &rows)],
            Diagram::PressureVolume => pressures(scene, &rows),
            Diagram::Polar => polar(&rows),
            Diagram::Orders => orders(&diagrams.orders),
            Diagram::Balance => vec![balance(diagrams, result, &rows)],
        };
        if figures.is_empty() {
            return Ok(None);
        }
        let columns = if figures.len() > 2 { 2 } else { 1 };
        sheet(&result.kinematics.scene, columns, size, &figures).map(Some)
    }
}

/// Adds the key figures of the diagrams.
pub(super) fn facts(facts: &mut Facts, diagrams: &Diagrams) {
    let moment = &diagrams.turning_moment;
    let (mean, work) = (six(moment.mean_nm), six(moment.work_j));
    let fluctuation = six(moment.fluctuation_j);
    fact!(facts, "mean torque" => "{mean} N m, {work} J a cycle; energy fluctuates by {fluctuation} J");
    if let Some(indicated) = &diagrams.indicated {
        let (work, power) = (six(indicated.work_j), six(indicated.power_w));
        let pressure = six(1e-5 * indicated.mean_effective_pressure_pa);
        let volume = six(1e6 * indicated.swept_volume_m3);
        fact!(facts, "indicated work" =>
            "{work} J a cycle, {power} W; mean effective pressure {pressure} bar over {volume} cm3");
    }
    let balance = &diagrams.balance;
    let (moment, angle) = (six(balance.counterweight_kg_m), degrees(balance.angle_rad));
    let part = balance.part;
    fact!(facts, "counterweight" =>
        "{moment} kg m at {angle} deg from the crank, for {part} of the reciprocating mass");
    let [before, after] = [balance.largest_n, balance.largest_left_n].map(six);
    let [forward, left] = [balance.forward_n, balance.forward_left_n].map(six);
    let backward = six(balance.backward_n);
    fact!(facts, "  shaking force" => "at most {before} N, with it {after} N");
    fact!(facts, "  first order" =>
        "{forward} N with the crank, {left} N with the counterweight; {backward} N against it");
}

fn turning_moment(diagrams: &Diagrams, rows: &[TurnRow]) -> Figure {
    let moment = &diagrams.turning_moment;
    let mean = moment.mean_nm;
    let torque = |row: &TurnRow| row.forces.map_or(f64::NAN, |forces| forces.torque);
    let angle = |row: &TurnRow| row.kinematics.theta.to_degrees();
    let area = rows.iter().map(|row| (angle(row), mean, torque(row)));
    let above = format!("energy; it fluctuates by {} J", six(moment.fluctuation_j));
    let line =
        |of: &dyn Fn(&TurnRow) -> f64| rows.iter().map(|row| (angle(row), of(row))).collect();
    Figure::new(
        "turning moment",
        Axis::degrees("crank angle θ [°]"),
        Axis::linear("driving torque [N m]"),
    )
    .line("driving torque", line(&torque))
    .line(format!("mean {} N m", six(mean)), line(&|_| mean))
    .band(above, area.collect())
}

/// Returns one indicator diagram per gas load of the scene.
fn pressures(scene: &Scene, rows: &[TurnRow]) -> Vec<Figure> {
    let distances = rows.iter().map(|row| row.kinematics.pose.x.abs());
    let far = distances.fold(0.0, f64::max);
    let figure = |load: &Load| {
        let Load::Gas { pressure, area, .. } = load else {
            return None;
        };
        let points = rows.iter().map(|row| {
            let volume = area * (far - row.kinematics.pose.x.abs());
            (1e6 * volume, 1e-5 * pressure.value(row.kinematics.theta))
        });
        let across = Axis::linear("swept volume [cm³]");
        let figure = Figure::new("indicator diagram", across, Axis::linear("pressure [bar]"));
        Some(figure.line("", points.collect()))
    };
    scene.forces.iter().filter_map(figure).collect()
}

fn polar(rows: &[TurnRow]) -> Vec<Figure> {
    let figure = |what: &str, turns: bool, of: fn(&Reactions) -> [f64; 2]| {
        let [how, along, across] = match turns {
            true => [
                "turning with the crank",
                "along the crank [N]",
                "across it [N]",
            ],
            false => ["at rest", "along x [N]", "along y [N]"],
        };
        let title = format!("{what}, {how}");
        let points = rows.iter().filter_map(|row| {
            let [x, y] = of(&row.forces?.reactions);
            // Components along the crank and a quarter turn ahead of it, or along x and y.
            let angle = if turns { row.kinematics.theta } else { 0.0 };
            let (sin, cos) = angle.sin_cos();
            Some((x * cos + y * sin, y * cos - x * sin))
        });
        Figure::new(title, Axis::linear(along), Axis::linear(across))
            .equal()
            .line("", points.collect())
            .points("", vec![(0.0, 0.0)])
    };
    let bearing = "force on the crank at its bearing";
    vec![
        figure("force on the rod at the crank pin", true, |f| f.crank_pin),
        figure(bearing, true, |f| f.crank_bearing),
        figure(bearing, false, |f| f.crank_bearing),
        figure("force on the slider at the wrist pin", false, |f| {
            f.wrist_pin
        }),
    ]
}

/// Returns a stem plot of amplitudes (order, amplitude).
pub(super) fn stems(label: &str, ends: impl Iterator<Item = (f64, f64)>) -> Figure {
    let stems = ends.flat_map(|(k, size)| [(k, 0.0), (k, size), (f64::NAN, size)]);
    let axis = Axis::linear("order, times a turn");
    Figure::new("", axis, Axis::linear(label)).line("", stems.collect())
}

fn orders(orders: &[Order]) -> Vec<Figure> {
    let of = |label: &str, value: fn(&Order) -> f64| {
        let ends = orders.iter().map(|order| (order.order, value(order)));
        stems(label, ends)
    };
    vec![
        of("shaking force, along x [N]", |order| order.shaking_x_n),
        of("shaking force, along y [N]", |order| order.shaking_y_n),
        of("shaking moment [N m]", |order| order.shaking_moment_nm),
        of("driving torque [N m]", |order| order.torque_nm),
    ]
}

fn balance(diagrams: &Diagrams, result: &OneTurn, rows: &[TurnRow]) -> Figure {
    let balance = &diagrams.balance;
    let forces = result.forces.as_ref();
    let speed = forces.map_or(0.0, |forces| forces.speed_rad_per_s);
    let size = balance.counterweight_kg_m * speed * speed;
    let force = |row: &TurnRow, part: f64| {
        let shaking = row.forces.map(|forces| forces.reactions.shaking);
        let [x, y] = shaking.unwrap_or([f64::NAN; 2]);
        let (sin, cos) = (row.kinematics.theta + balance.angle_rad).sin_cos();
        (x + part * size * cos, y + part * size * sin)
    };
    let with = format!("with {} kg m", six(balance.counterweight_kg_m));
    let line = |part: f64| rows.iter().map(|row| force(row, part)).collect();
    Figure::new(
        "shaking force over the cycle",
        Axis::linear("along x [N]"),
        Axis::linear("along y [N]"),
    )
    .equal()
    .line("without counterweight", line(0.0))
    .line(with, line(1.0))
}
