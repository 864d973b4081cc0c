//! Options for reading a file of measured motion.

use clap::Args;

use super::values::any_length;
use crate::scene::{Measured, Reading};

/// Options of all commands that read measured motion.
#[derive(Debug, Args)]
pub(super) struct ReadingArguments {
    /// The measured column, where the file has several: theta, gamma, x or omega
    #[arg(long, value_name = "NAME")]
    column: Option<Measured>,
    /// What the columns of a file without header are, like "t [s],theta [deg]"
    #[arg(long, value_name = "HEADER")]
    columns: Option<String>,
    /// The column of the time, by header or number, with its unit: "2[ms]"
    #[arg(long, value_name = "COL[UNIT]")]
    time: Option<String>,
    /// The column of the motion, by header or number, with its unit: "Winkel[deg]", "3[counts]"
    #[arg(long, value_name = "COL[UNIT]")]
    motion: Option<String>,
    /// A column of a known torque on the crank or force on the slider, by header or number, with its unit: "motor[N m]";
    /// it acts beside the loads of the scene. May be given several times
    #[arg(long, value_name = "COL[UNIT]")]
    known: Vec<String>,
    /// Counts of an encoder in a turn of the crank
    #[arg(long, value_name = "NUMBER", value_parser = clap::value_parser!(u32).range(1..))]
    counts_per_turn: Option<u32>,
    /// What the sensor of x shows where the slider is at the crank pivot, like "12.5 mm"
    #[arg(long, value_name = "LENGTH", value_parser = any_length, allow_hyphen_values = true)]
    x_zero: Option<f64>,
    /// Lines above the header
    #[arg(long, value_name = "NUMBER", default_value_t = 0)]
    skip: usize,
    /// What numbers have between units and tenths, point or comma; with comma, semicolons or tabs separate the columns
    #[arg(long, value_name = "MARK", default_value = "point", value_parser = ["point", "comma"])]
    decimal: String,
    /// What cells without a value contain, like NaN; "" for empty cells. Rows without time or motion are gaps then, and other
    /// sensors may have fewer values. May be given several times
    #[arg(long, value_name = "TEXT", allow_hyphen_values = true)]
    missing: Vec<String>,
}

impl ReadingArguments {
    pub fn reading(&self) -> Reading {
        Reading {
            columns: self.columns.clone(),
            column: self.column,
            time: self.time.clone(),
            motion: self.motion.clone(),
            known: self.known.clone(),
            counts_per_turn: self.counts_per_turn,
            x_zero: self.x_zero.unwrap_or(0.0),
            skip: self.skip,
            decimal_comma: self.decimal == "comma",
            missing: self.missing.clone(),
        }
    }
}
