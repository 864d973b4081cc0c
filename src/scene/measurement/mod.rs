//! Measured motion: time and crank angle, crank-pin angle or slider position, sample by sample.

mod clock;
mod columns;
mod even;
mod headers;
mod lines;
mod listed;
mod number;
mod read;
mod rows;
mod source;

use std::path::Path;

use super::{Problem, Problems, text};
use crate::error::Error;
use crate::scene::unit::Quantity;
use rows::check_rows;
use source::Source;

/// The motion of Duarte et al. 2018 (11), sampled; see the comments in the file.
pub const DUARTE_MOTION: &str = include_str!("../../../data/duarte-motion.csv");

/// Fewest samples of a motion.
const LEAST_ROWS: usize = 6;

/// What was measured beside the time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Measured {
    /// Crank angle θ, rad.
    Theta,
    /// Angle at the crank pin between crank and rod, Duarte et al. (10), rad from 0 to π.
    Gamma,
    /// Slider position x, m.
    X,
}

impl Measured {
    /// All of them; of several in one file the first is taken.
    pub const ALL: [Measured; 3] = [Measured::Theta, Measured::Gamma, Measured::X];

    /// Its name in headers.
    pub fn name(self) -> &'static str {
        match self {
            Measured::Theta => "theta",
            Measured::Gamma => "gamma",
            Measured::X => "x",
        }
    }

    /// The SI unit.
    pub fn unit(self) -> &'static str {
        match self {
            Measured::X => "m",
            _ => "rad",
        }
    }

    /// What it is, in words.
    fn meaning(self) -> &'static str {
        match self {
            Measured::Theta => "the crank angle theta",
            Measured::Gamma => "the angle gamma at the crank pin",
            Measured::X => "the slider position x, counted from the crank pivot",
        }
    }

    fn quantity(self) -> Quantity {
        match self {
            Measured::X => Quantity::Length,
            _ => Quantity::Angle,
        }
    }
}

impl std::str::FromStr for Measured {
    type Err = String;

    fn from_str(text: &str) -> Result<Measured, String> {
        let found = Measured::ALL.into_iter().find(|kind| kind.name() == text);
        found.ok_or_else(|| format!("`{text}` is none of theta, gamma and x"))
    }
}

/// How a file of measured motion is read.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Reading {
    /// Names and units of the columns of a file without header, written like a header: `"t [s],theta [deg]"`.
    pub columns: Option<String>,
    /// The measured column, where the file has several.
    pub column: Option<Measured>,
    /// The column of the time by its header or its number, with its unit: `2[ms]`.
    pub time: Option<String>,
    /// The column of the motion, as that of the time.
    pub motion: Option<String>,
    /// Counts of an encoder in a turn of the crank.
    pub counts_per_turn: Option<u32>,
    /// What a slider position shows where the slider is at the crank pivot, m.
    pub x_zero: f64,
    /// Lines above the header.
    pub skip: usize,
    /// Whether numbers have decimal commas; columns are then separated by semicolon or tab.
    pub decimal_comma: bool,
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
        let mut measurement = Measurement {
            measured,
            times,
            elapsed: None,
            origin: 0.0,
            spacing: 0.0,
            values,
            resolution: 0.0,
            notes: Vec::new(),
            source: None,
        };
        check_rows(&mut measurement)?;
        Ok(measurement)
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
        check_rows(&mut measurement)?;
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
            Some(source) => format!("line {}", source.line(sample)),
            None => format!("sample {}", sample + 1),
        }
    }

    /// A value in the unit of its column, with the unit.
    pub fn shown(&self, value: f64) -> String {
        let (factor, unit) = match &self.source {
            Some(source) => (source.value.factor, source.value.unit.as_str()),
            None => (1.0, self.measured.unit()),
        };
        super::number::with_unit(value / factor, unit)
    }

    /// Problems with the measured values of some samples (from 0): what is wrong and what would be right.
    pub fn problems(&self, list: Vec<(usize, String, String)>) -> Problems {
        let list = list.into_iter().map(|(sample, what, help)| {
            let field = match &self.source {
                Some(_) => self.measured.name().to_owned(),
                None => format!("{}, {}", self.measured.name(), self.place(sample)),
            };
            let mut problem = Problem::new(&field, what, help);
            problem.span = self.source.as_ref().map(|s| s.value_span(sample));
            problem
        });
        let list = list.collect();
        match &self.source {
            Some(source) => Problems::in_file(&source.file, &source.text, list),
            None => Problems::in_code(list),
        }
    }
}
