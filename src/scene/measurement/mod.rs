//! Measured motion: time with crank angle, crank-pin angle or slider position, sample by sample, checked.

mod columns;
mod heading;
mod listed;
mod measured;
mod read;
mod rows;
mod sample_file;
mod times;
mod unwrap;

use std::path::Path;

use super::csv::Column;
use super::csv::lines::{line_number, span};
use super::{Interpolation, Load, Problem, Problems, Scene, Table, Variable, text};
use crate::error::Error;
pub use measured::{Beside, BesideColumn, Measured, Reading};
use sample_file::SampleFile;
pub(crate) use unwrap::Unwrapped;

/// CSV text of the motion of Duarte et al. 2018 (11), sampled; see the comments in the file.
pub const DUARTE_MOTION: &str = include_str!("../../../data/duarte-motion.csv");

/// Samples of a motion, SI and radians, in the order of time.
#[derive(Clone, Debug)]
pub struct Measurement {
    measured: Measured,
    times: Vec<f64>,
    /// Times since `origin`, s, where `times` have lost digits or are rounded values of even times.
    elapsed: Option<Vec<f64>>,
    /// Time from which `elapsed` counts, s.
    origin: f64,
    /// Relative uncertainty of the sampling period that replaces rounded times; 0 for other times.
    period_uncertainty: f64,
    values: Vec<f64>,
    resolution: f64,
    /// Units of times and values in messages.
    time: Column,
    value: Column,
    beside: Vec<BesideColumn>,
    notes: Vec<String>,
    source: Option<SampleFile>,
}

impl Measurement {
    /// Creates samples from code: times (s) that rise strictly, and values (rad, m for the slider position).
    ///
    /// # Errors
    /// [`Problems`] with the samples at fault, counted from 1.
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

    /// Adds a column: a second sensor, or a known torque or force, one value for each sample, SI; NaN where a sensor has none.
    ///
    /// # Errors
    /// [`Problems`] for another number of values, for values that are not finite, and for a sensor of few values.
    pub fn with(mut self, beside: Beside, values: Vec<f64>) -> Result<Measurement, Problems> {
        self.beside.push(BesideColumn { beside, values });
        self.check_beside()?;
        Ok(self)
    }

    /// Returns the columns beside the motion: other sensors, known torques and forces.
    pub fn beside(&self) -> &[BesideColumn] {
        &self.beside
    }

    /// Whether the motion has other sensors.
    pub(crate) fn has_sensors_beside(&self) -> bool {
        let is_sensor = |column: &BesideColumn| matches!(column.beside, Beside::Sensor(_));
        self.beside.iter().any(is_sensor)
    }

    /// Returns a scene with the known torques and forces of the record, linear between the samples.
    ///
    /// # Errors
    /// [`Problems`] for a known torque or force over times that are equal in double precision.
    pub(crate) fn known_in(&self, scene: &Scene) -> Result<Scene, Problems> {
        let mut scene = scene.clone();
        for BesideColumn { beside, values } in &self.beside {
            let list = match beside {
                Beside::Sensor(_) => continue,
                Beside::Torque => &mut scene.torques,
                Beside::Force => &mut scene.forces,
            };
            let (times, interpolation) = (&self.times, Interpolation::Linear);
            let table = Table::new(Variable::T, times, values, interpolation, None);
            let table = table.map_err(|what| {
                let falls = times.windows(2).position(|pair| pair[1] <= pair[0]);
                let sample = falls.map_or(0, |before| before + 1);
                let what = format!("a known torque or force is no function of these times: {what}");
                let help = "times so far from zero are equal in double precision: let the time begin near 0";
                self.refused(vec![self.problem(sample, 0, what, help.to_owned())])
            });
            list.push(Load::Table(table?));
        }
        Ok(scene)
    }

    /// Creates samples without checks.
    fn raw(measured: Measured, times: Vec<f64>, values: Vec<f64>) -> Measurement {
        Measurement {
            measured,
            times,
            elapsed: None,
            origin: 0.0,
            period_uncertainty: 0.0,
            values,
            resolution: 0.0,
            time: Column::si("s"),
            value: Column::si(measured.unit()),
            beside: Vec::new(),
            notes: Vec::new(),
            source: None,
        }
    }

    /// Returns the motion of the built-in scene: the polynomial (11) of Duarte et al. 2018, sampled.
    pub fn duarte() -> Measurement {
        let file = Path::new("duarte-motion.csv");
        Measurement::parse(file, DUARTE_MOTION.to_owned(), &Reading::default())
            .unwrap_or_else(|problems| unreachable!("the built-in motion is right: {problems}"))
    }

    /// Reads a CSV file; `-` is standard input.
    ///
    /// # Errors
    /// [`Error::Read`] if the file cannot be read, [`Error::Scene`] with all problems of its text.
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
    /// [`Problems`] of the text, with lines and columns.
    pub fn parse(file: &Path, text: String, reading: &Reading) -> Result<Measurement, Problems> {
        let mut measurement = read::measurement(file, text, reading)?;
        measurement.count_from_first_row();
        measurement.check()?;
        Ok(measurement)
    }

    /// Returns the measured quantity.
    pub fn measured(&self) -> Measured {
        self.measured
    }

    /// Returns the times, s.
    pub fn times(&self) -> &[f64] {
        &self.times
    }

    /// Returns the times for a fit, s, since [`origin`](Self::origin); even times in place of their rounded values.
    pub fn elapsed(&self) -> &[f64] {
        self.elapsed.as_deref().unwrap_or(&self.times)
    }

    /// Returns the origin of the times for a fit, s: the time of the first row where times lose digits, or 0.
    pub fn origin(&self) -> f64 {
        self.origin
    }

    /// Returns the relative uncertainty of the sampling period that replaces rounded times; 0 for other times.
    pub fn period_uncertainty(&self) -> f64 {
        self.period_uncertainty
    }

    /// Returns the measured values, rad or m.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// Returns the number of samples.
    pub fn len(&self) -> usize {
        self.times.len()
    }

    /// Whether there is no sample; false for samples that were checked.
    pub fn is_empty(&self) -> bool {
        self.times.is_empty()
    }

    /// Returns the rounding step of the printed values, rad or m, the root mean square where larger values have fewer
    /// decimals; 0 for values from code.
    pub fn resolution(&self) -> f64 {
        self.resolution
    }

    /// True if the values are counts of an encoder, whose step is the resolution.
    pub fn is_counted(&self) -> bool {
        self.value.is_counts()
    }

    /// Returns notes for the user: choice of columns, encoding, gaps, replaced times, a record at rest.
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    /// Returns the name of the file, if the samples came from one.
    pub fn file(&self) -> Option<String> {
        let source = self.source.as_ref()?;
        Some(source.file.display().to_string())
    }

    /// Returns the place of a sample (from 0): `line 12` of the file, or `sample 11`.
    pub fn place(&self, sample: usize) -> String {
        match &self.source {
            Some(source) => format!("line {}", line_number(&source.text, source.row(sample))),
            None => format!("sample {}", sample + 1),
        }
    }

    /// Formats a value in the unit of its column, with the unit.
    pub fn shown(&self, value: f64) -> String {
        self.value.shown(value)
    }

    /// Creates a problem with the time (column 0) or the value (1) of a sample (from 0).
    fn problem(&self, sample: usize, column: usize, what: String, help: String) -> Problem {
        let name = ["time", self.measured.name()][column];
        let Some(source) = &self.source else {
            return Problem::new(&format!("{name}, {}", self.place(sample)), what, help);
        };
        let row = source.row(sample);
        let cell = source.dialect.cells(row).nth(source.at[column]);
        Problem::new(name, what, help).at(span(&source.text, cell.unwrap_or(row)))
    }

    /// Refuses the measured values of samples (from 0), each with its fault; the first 20 are named.
    ///
    /// # Errors
    /// [`Problems`] if there is one.
    pub fn refuse(
        &self,
        faults: impl Iterator<Item = (usize, String)>,
        help: &str,
    ) -> Result<(), Problems> {
        let problem = |(sample, what)| self.problem(sample, 1, what, help.to_owned());
        let list: Vec<Problem> = faults.take(20).map(problem).collect();
        match list.is_empty() {
            true => Ok(()),
            false => Err(self.refused(list)),
        }
    }

    fn refused(&self, list: Vec<Problem>) -> Problems {
        match &self.source {
            Some(source) => Problems::in_file(&source.file, &source.text, list),
            None => Problems::in_code(list),
        }
    }
}
