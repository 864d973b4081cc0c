//! How a file of measured motion is read.

use clap::Args;

use crate::scene::{Measured, Reading};

/// Options of all commands that read measured motion.
#[derive(Debug, Args)]
pub(super) struct ReadingArguments {
    /// The measured column, where the file has several: theta, gamma or x
    #[arg(long, value_name = "NAME")]
    column: Option<Measured>,
    /// What the columns of a file without header are, like "t [s],theta [deg]"
    #[arg(long, value_name = "HEADER")]
    columns: Option<String>,
    /// What numbers have between units and tenths, point or comma; with comma, semicolons or tabs separate the columns
    #[arg(long, value_name = "MARK", default_value = "point", value_parser = ["point", "comma"])]
    decimal: String,
}

impl ReadingArguments {
    pub fn reading(&self) -> Reading {
        Reading {
            columns: self.columns.clone(),
            column: self.column,
            decimal_comma: self.decimal == "comma",
        }
    }
}
