//! What is measured beside the time, and how a file of it is read.

use crate::scene::unit::Quantity;

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
    /// All quantities; of several in one file the first is that of the record, and the others stand beside it.
    pub const ALL: [Measured; 3] = [Measured::Theta, Measured::Gamma, Measured::X];

    /// Name in headers.
    pub fn name(self) -> &'static str {
        match self {
            Measured::Theta => "theta",
            Measured::Gamma => "gamma",
            Measured::X => "x",
        }
    }

    /// The SI unit.
    pub fn unit(self) -> &'static str {
        self.quantity().si()
    }

    /// What it is, in words.
    pub(super) fn meaning(self) -> &'static str {
        match self {
            Measured::Theta => "the crank angle theta",
            Measured::Gamma => "the angle gamma at the crank pin",
            Measured::X => "the slider position x, counted from the crank pivot",
        }
    }

    pub(super) fn quantity(self) -> Quantity {
        match self {
            Measured::X => Quantity::Length,
            _ => Quantity::Angle,
        }
    }
}

/// What a column holds beside time and motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Beside {
    /// Another measured quantity of the motion.
    Sensor(Measured),
    /// A torque on the crank that is known, N m.
    Torque,
    /// A force on the slider that is known, N.
    Force,
}

/// Values of a column beside time and motion, SI.
#[derive(Clone, Debug)]
pub struct BesideColumn {
    /// What it holds.
    pub beside: Beside,
    /// One value for each sample.
    pub values: Vec<f64>,
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
    /// Columns of torques on the crank and forces on the slider that are known, as that of the time.
    pub known: Vec<String>,
    /// Counts of an encoder in a turn of the crank.
    pub counts_per_turn: Option<u32>,
    /// What a slider position shows where the slider is at the crank pivot, m.
    pub x_zero: f64,
    /// Lines above the header.
    pub skip: usize,
    /// Whether numbers have decimal commas; columns are then separated by semicolon or tab.
    pub decimal_comma: bool,
}
