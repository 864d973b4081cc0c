//! `--plot` and what it shows.

use std::path::PathBuf;

use clap::Args;

use super::streams::check_ending;
use crate::error::Error;
use crate::report::{ENDINGS, Picture, Shape, View};

/// Where a picture goes, and how large it is.
#[derive(Debug, Args)]
#[command(next_help_heading = "Picture")]
pub(super) struct Plot {
    /// Draws a picture to this file: SVG, PNG or PDF, as its name ends
    #[arg(long, value_name = "FILE")]
    pub plot: Option<PathBuf>,
    /// Width and height of the picture in mm, like 180x120
    #[arg(long, value_name = "WIDTHxHEIGHT", value_parser = shape, requires = "plot")]
    size: Option<Shape>,
}

/// What a picture of rows shows.
#[derive(Debug, Args)]
#[command(next_help_heading = "Picture")]
pub(super) struct PlotOfRows {
    #[command(flatten)]
    to: Plot,
    /// Columns in the picture, like x,v,torque or x:cm; the name of a column without its unit, or a word of it
    #[arg(long, value_name = "COLUMNS", value_delimiter = ',', requires = "plot")]
    show: Vec<String>,
    /// Column of the picture's horizontal axis, like theta
    #[arg(long, value_name = "COLUMN", requires = "plot")]
    over: Option<String>,
}

impl Plot {
    /// Size of the picture.
    pub fn size(&self) -> Option<Shape> {
        self.size
    }

    /// Opens the picture that may be asked for.
    ///
    /// # Errors
    /// [`Error::Refused`] if its ending is not one of a picture; [`Error::Write`].
    pub fn open(&self) -> Result<Option<Picture>, Error> {
        check_ending(self.plot.as_ref(), &ENDINGS)?;
        self.plot.as_deref().map(Picture::create).transpose()
    }
}

impl PlotOfRows {
    /// The file of the picture.
    pub fn path(&self) -> Option<&PathBuf> {
        self.to.plot.as_ref()
    }

    /// Opens the picture that may be asked for.
    ///
    /// # Errors
    /// [`Error::Refused`] if its ending is not one of a picture; [`Error::Write`].
    pub fn open(&self) -> Result<Option<Picture>, Error> {
        self.to.open()
    }

    /// What the picture shows.
    pub fn view(&self) -> View {
        View {
            show: self.show.clone(),
            over: self.over.clone(),
            size: self.to.size,
        }
    }
}

/// A size in mm, like `180x120`.
fn shape(text: &str) -> Result<Shape, String> {
    let help = "write width and height in mm, like 180x120";
    let (width, height) = text.split_once(['x', '×']).ok_or(help)?;
    let side = |text: &str| {
        let value = text.trim().trim_end_matches("mm").trim().parse::<f64>();
        value.ok().filter(|side| (10.0..=5000.0).contains(side))
    };
    match side(width).zip(side(height)) {
        Some((width, height)) => Ok(Shape { width, height }),
        None => Err(format!("{help}, from 10 to 5000")),
    }
}
