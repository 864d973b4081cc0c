//! Common output options of commands, and the writing of results to the chosen files.

use std::path::PathBuf;

use clap::Args;

use serde::Serialize;

use super::streams::{Streams, check_extension, create, draw, fill, page};
use crate::error::Error;
use crate::figure::Shape;
use crate::report::{EXTENSIONS, Origin, Output, Report, View};

/// Where a picture goes, and how large it is.
#[derive(Debug, Args)]
pub(super) struct Plot {
    /// Draws a picture to this file: SVG, PNG or PDF, as its name ends
    #[arg(long, value_name = "FILE")]
    pub plot: Option<PathBuf>,
    /// Width and height of the picture in mm, like 180x120
    #[arg(long, value_name = "WIDTHxHEIGHT", value_parser = shape, requires = "plot")]
    pub size: Option<Shape>,
}

/// What a picture of rows shows.
#[derive(Debug, Args)]
pub(super) struct PlotOfRows {
    #[command(flatten)]
    pub to: Plot,
    /// Columns in the picture, like x,v,torque or x:cm; the name of a column without its unit, or a word of it
    #[arg(long, value_name = "COLUMNS", value_delimiter = ',', requires = "plot")]
    show: Vec<String>,
    /// Column of the picture's horizontal axis, like theta
    #[arg(long, value_name = "COLUMN", requires = "plot")]
    over: Option<String>,
}

impl Plot {
    /// Opens the picture, if asked for; its extension must be one of a picture.
    pub fn open(&self) -> Result<Option<Output>, Error> {
        check_extension(self.plot.as_ref(), &EXTENSIONS)?;
        create(self.plot.as_ref())
    }
}

impl PlotOfRows {
    /// Returns the chosen content of the picture.
    pub fn view(&self) -> View {
        View {
            show: self.show.clone(),
            over: self.over.clone(),
            size: self.to.size,
        }
    }
}

/// Where the results of a command with rows go.
#[derive(Debug, Args)]
pub(super) struct Outputs {
    /// Writes the rows as CSV to this file, `-` for standard output
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
    /// Writes the result as one HTML page to this file: key figures, curves, and the mechanism in motion if there is one
    #[arg(long, value_name = "FILE")]
    pub report: Option<PathBuf>,
    /// Prints the summary as one JSON object
    #[arg(long)]
    pub json: bool,
    #[command(flatten)]
    pub plot: PlotOfRows,
}

impl Outputs {
    /// Returns the checked streams of a command that reads the files `read` and also writes `others`.
    pub fn streams(
        &self,
        read: &[Option<&PathBuf>],
        others: &[Option<&PathBuf>],
    ) -> Result<Streams, Error> {
        let files = [self.plot.to.plot.as_ref(), self.report.as_ref()];
        let files = [others, &files].concat();
        Streams::new(read, self.out.as_ref(), &files, self.json)
    }

    /// Opens all requested outputs, before any is written.
    pub fn open(&self) -> Result<Targets, Error> {
        Ok(Targets {
            rows: create(self.out.as_ref())?,
            picture: self.plot.to.open()?,
            page: page(self.report.as_ref())?,
            view: self.plot.view(),
        })
    }
}

/// Open outputs of a command.
pub(super) struct Targets {
    pub rows: Option<Output>,
    pub picture: Option<Output>,
    pub page: Option<Output>,
    view: View,
}

impl Targets {
    /// Writes picture, rows and page of a result, and shows the summary.
    pub fn write(
        self,
        report: &impl Report,
        summary: &impl Serialize,
        origin: &Origin,
        streams: &Streams,
    ) -> Result<(), Error> {
        draw(self.picture, || report.figure(&self.view))?;
        self.rows.map_or(Ok(()), |output| report.csv(output))?;
        fill(self.page, || report.page(origin))?;
        streams.show(summary, || report.text())
    }
}

/// Parses a size in mm, like `180x120`.
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
