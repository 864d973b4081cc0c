//! Quantities measured over time, and options for reading a file of them.

use crate::scene::csv::cell;
use crate::scene::unit::Quantity;

named! {
    /// Quantity measured over time; the first of several in one file is the motion, the others stand beside it.
    pub enum Measured {
        /// Crank angle θ, rad.
        Theta = "theta",
        /// Angle at the crank pin between crank and rod, Duarte et al. (10), rad from 0 to π.
        Gamma = "gamma",
        /// Slider position x, m.
        X = "x",
        /// Crank speed ω, rad/s; the first sample has the crank angle of the scene's motion.
        Omega = "omega",
    }
}

impl Measured {
    /// Returns the SI unit.
    pub fn unit(self) -> &'static str {
        self.quantity().si()
    }

    /// Returns the quantity in words.
    pub(super) fn meaning(self) -> &'static str {
        match self {
            Measured::Theta => "the crank angle theta",
            Measured::Gamma => "the angle gamma at the crank pin",
            Measured::X => "the slider position x, counted from the crank pivot",
            Measured::Omega => "the crank speed omega",
        }
    }

    /// Returns the physical quantity.
    pub(crate) fn quantity(self) -> Quantity {
        match self {
            Measured::X => Quantity::Length,
            Measured::Omega => Quantity::AngularSpeed,
            Measured::Theta | Measured::Gamma => Quantity::Angle,
        }
    }
}

/// Content of a column beside time and motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Beside {
    /// Quantity of the motion measured by another sensor.
    Sensor(Measured),
    /// Known torque on the crank, N m.
    Torque,
    /// Known force on the slider, N.
    Force,
}

/// Values of a column beside time and motion, SI.
#[derive(Clone, Debug)]
pub struct BesideColumn {
    /// Content of the column.
    pub beside: Beside,
    /// One value for each sample; NaN where a sensor has none.
    pub values: Vec<f64>,
}

impl std::str::FromStr for Measured {
    type Err = String;

    fn from_str(text: &str) -> Result<Measured, String> {
        Measured::named(text)
            .ok_or_else(|| format!("`{text}` is none of theta, gamma, x and omega"))
    }
}

/// Options for reading a file of measured motion.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Reading {
    /// Names and units of the columns of a file without header, written like a header: `"t [s],theta [deg]"`.
    pub columns: Option<String>,
    /// Measured column, where the file has several.
    pub column: Option<Measured>,
    /// Column of the time by header or number, with its unit: `2[ms]`.
    pub time: Option<String>,
    /// Column of the motion, in the form of `time`.
    pub motion: Option<String>,
    /// Columns of known torques on the crank and known forces on the slider, in the form of `time`.
    pub known: Vec<String>,
    /// Encoder counts in a turn of the crank.
    pub counts_per_turn: Option<u32>,
    /// Reading of the slider position where the slider is at the crank pivot, m.
    pub x_zero: f64,
    /// Number of lines above the header.
    pub skip: usize,
    /// Whether numbers have decimal commas; columns are then separated by semicolon or tab.
    pub decimal_comma: bool,
    /// Texts or numbers in cells without a value, as `NaN`; `""` for empty cells. Without time or motion a row is a gap.
    pub missing: Vec<String>,
}

impl Reading {
    /// Whether a cell has one of the texts of `missing`, in any case, or the same number.
    pub(super) fn is_missing(&self, cell: &str) -> bool {
        let number = |text: &str| cell::parse(text, self.decimal_comma).ok();
        let is_same = |text: &str| number(text).is_some_and(|mark| number(cell) == Some(mark));
        let mut texts = self.missing.iter();
        texts.any(|text| text.eq_ignore_ascii_case(cell) || is_same(text))
    }
}
