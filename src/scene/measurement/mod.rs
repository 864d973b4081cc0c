//! Measured motion: time and crank angle, crank-pin angle or slider position, sample by sample.

mod columns;
mod digits;
mod heading;
mod listed;
mod measured;
mod read;
mod rows;
mod times;

use std::path::{Path, PathBuf};

use super::csv::Column;
use super::csv::lines::{Dialect, line_number, span};
use super::{Interpolation, Load, Problem, Problems, Scene, Table, Variable, text};
use crate::error::Error;
pub use measured::{Beside, BesideColumn, Measured, Reading};

/// The motion of Duarte et al. 2018 (11), sampled; see the comments in the file.
pub const DUARTE_MOTION: &str = include_str!("../../../data/duarte-motion.csv");

/// The file that samples came from, which finds their lines and cells for messages.
#[derive(Clone, Debug)]
struct Source {
    file: PathBuf,
    text: String,
    /// Where the rows of numbers begin, and how they divide.
    dialect: Dialect,
    /// Positions of time and value in a row, from 0.
    at: [usize; 2],
    time: Column,
    value: Column,
}

impl Source {
    fn row(&self, sample: usize) -> &str {
        let mut rows = self.dialect.rows(&self.text);
        rows.nth(sample).unwrap_or_default()
    }
}

/// Samples of a motion, SI and radians, in the order of time.
#[derive(Clone, Debug)]
pub struct Measurement {
    measured: Measured,
    times: Vec<f64>,
    /// Times since `origin`, s, where the times themselves have lost digits.
    elapsed: Option<Vec<f64>>,
    /// s
    origin: f64,
    /// Part by which the time between samples may be off that are taken as even.
    spacing: f64,
    values: Vec<f64>,
    resolution: f64,
    beside: Vec<BesideColumn>,
    notes: Vec<String>,
    source: Option<Source>,
}

impl Measurement {
    /// Samples of code: times (s) that rise strictly, and values (rad, m for the slider position).
    ///
    /// # Errors
    /// [`Problems`]: what is wrong, with the sample, counted from 1.
    ///
    /// ```
    /// use slider_crank::scene::{Measured, Measurement};
    /// let times: Vec<f64> = (0..20).map(|i| 0.01 * f64::from(i)).collect();
    /// let angles = times.iter().map(|t| 3.0 * t + t * t).collect();
    /// let motion = Measurement::new(Measured::Theta, times, angles).unwrap();
    /// assert_eq!(motion.len(), 20);
    /// ```
    pub fn new(
        measured: Measured,
        times: Vec<f64>,
        values: Vec<f64>,
    ) -> Result<Measurement, Problems> {
        let mut measurement = Measurement::raw(measured, times, values);
        measurement.check()?;
        Ok(measurement)
    }

    /// These samples with another column: a second sensor, or a torque or force that is known, one value for each sample, SI.
    ///
    /// # Errors
    /// [`Problems`]: other numbers of values, or values that are not finite.
    pub fn with(mut self, beside: Beside, values: Vec<f64>) -> Result<Measurement, Problems> {
        self.beside.push(BesideColumn { beside, values });
        self.check_beside()?;
        Ok(self)
    }

    /// What was measured or is known beside the motion.
    pub fn beside(&self) -> &[BesideColumn] {
        &self.beside
    }

    /// Whether the motion has other sensors.
    pub(crate) fn has_sensors_beside(&self) -> bool {
        let is_sensor = |column: &BesideColumn| matches!(column.beside, Beside::Sensor(_));
        self.beside.iter().any(is_sensor)
    }

    /// A scene with the torques and forces that the record knows: between the samples a straight line.
    pub(crate) fn known_in(&self, scene: &Scene) -> Scene {
        let mut scene = scene.clone();
        for BesideColumn { beside, values } in &self.beside {
            let times = &self.times;
            let table = || Table::new(Variable::T, times, values, Interpolation::Linear, None);
            match (beside, table()) {
                (Beside::Torque, Ok(table)) => scene = scene.torque(Load::Table(table)),
                (Beside::Force, Ok(table)) => scene = scene.force(Load::Table(table)),
                _ => {}
            }
        }
        scene
    }

    /// Samples as they are.
    fn raw(measured: Measured, times: Vec<f64>, values: Vec<f64>) -> Measurement {
        Measurement {
            measured,
            times,
            elapsed: None,
            origin: 0.0,
            spacing: 0.0,
            values,
            resolution: 0.0,
            beside: Vec::new(),
            notes: Vec::new(),
            source: None,
        }
    }

    /// The motion that belongs to the built-in scene: the polynomial (11) of Duarte et al. 2018, sampled.
    pub fn duarte() -> Measurement {
        let file = Path::new("duarte-motion.csv");
        Measurement::parse(file, DUARTE_MOTION.to_owned(), &Reading::default())
            .unwrap_or_else(|problems| unreachable!("the built-in motion is right: {problems}"))
    }

    /// Reads a CSV file; `-` is standard input.
    ///
    /// # Errors
    /// [`Error::Read`] if the file cannot be read, [`Error::Scene`] with all that is wrong with it.
    pub fn load(file: impl AsRef<Path>, reading: &Reading) -> Result<Measurement, Error> {
        let file = file.as_ref();
        let (text, encoding) = text::decoded_from_any(text::bytes(file)?).map_err(|what| {
            let help = "save the data as plain CSV text in UTF-8";
            Problems::in_file(file, "", vec![Problem::new("", what, help)])
        })?;
        let mut measurement = Measurement::parse(file, text, reading)?;
        let note = encoding.map(|name| format!("the file is not UTF-8; it is read as {name}"));
        measurement.notes.extend(note);
        Ok(measurement)
    }

    /// Reads the text of a CSV file; `file` is its name in messages.
    ///
    /// # Errors
    /// [`Problems`]: all that is wrong, with lines and columns.
    pub fn parse(file: &Path, text: String, reading: &Reading) -> Result<Measurement, Problems> {
        let mut measurement = read::measurement(file, text, reading)?;
        measurement.count_from_first_row();
        measurement.check()?;
        Ok(measurement)
    }

    /// What was measured.
    pub fn measured(&self) -> Measured {
        self.measured
    }

    /// Times, s.
    pub fn times(&self) -> &[f64] {
        &self.times
    }

    /// Times for a fit, s: they count from [`origin`](Self::origin) where times so far from zero would lose digits.
    pub fn elapsed(&self) -> &[f64] {
        self.elapsed.as_deref().unwrap_or(&self.times)
    }

    /// The time from which times for a fit count, s: that of the first row where times lose digits, or 0.
    pub fn origin(&self) -> f64 {
        self.origin
    }

    /// Part by which times for a fit may be stretched: that to which rounded times tell the time between even samples.
    pub fn time_uncertainty(&self) -> f64 {
        self.spacing
    }

    /// Measured values, rad or m.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// Number of samples.
    pub fn len(&self) -> usize {
        self.times.len()
    }

    /// Whether there is no sample; never so for samples that were checked.
    pub fn is_empty(&self) -> bool {
        self.times.is_empty()
    }

    /// The step to which the digits of the values round them, rad or m, a root mean square where larger values have fewer
    /// decimals; 0 for values of code.
    pub fn resolution(&self) -> f64 {
        self.resolution
    }

    /// What the reader should know: columns not taken, gaps.
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    /// Name of the file, if the samples came from one.
    pub fn file(&self) -> Option<String> {
        let source = self.source.as_ref()?;
        Some(source.file.display().to_string())
    }

    /// Where a sample (from 0) is: `line 12` of the file, or `sample 11`.
    pub fn place(&self, sample: usize) -> String {
        match &self.source {
            Some(source) => format!("line {}", line_number(&source.text, source.row(sample))),
            None => format!("sample {}", sample + 1),
        }
    }

    /// A value in the unit of its column, with the unit.
    pub fn shown(&self, value: f64) -> String {
        match &self.source {
            Some(source) => source.value.shown(value),
            None => Column::si(self.measured.unit()).shown(value),
        }
    }

    /// A problem with the time (0) or the value (1) of a sample (from 0).
    fn problem(&self, sample: usize, column: usize, what: String, help: String) -> Problem {
        let name = ["time", self.measured.name()][column];
        let Some(source) = &self.source else {
            return Problem::new(&format!("{name}, {}", self.place(sample)), what, help);
        };
        let row = source.row(sample);
        let cell = source.dialect.cells(row).nth(source.at[column]);
        Problem::new(name, what, help).at(span(&source.text, cell.unwrap_or(row)))
    }

    /// Problems with the measured values of some samples (from 0): what is wrong and what would be right.
    pub fn problems(&self, list: Vec<(usize, String, String)>) -> Problems {
        let problem = |(sample, what, help)| self.problem(sample, 1, what, help);
        self.refused(list.into_iter().map(problem).collect())
    }

    fn refused(&self, list: Vec<Problem>) -> Problems {
        match &self.source {
            Some(source) => Problems::in_file(&source.file, &source.text, list),
            None => Problems::in_code(list),
        }
    }
}
