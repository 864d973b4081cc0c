//! Command `reproduce`: recomputes the numbers and figures of the four papers.

use std::path::{Path, PathBuf};

use clap::Args;

use super::streams::Streams;
use super::watch::say;
use crate::error::Error;
use crate::figure::sheet;
use crate::report::{self, Output, ReproductionSummary};
use crate::reproduce::{Paper, Reproduction, reproduce};

#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// obaseki-alfred, gupta, ng or duarte; without it all four
    #[arg(value_parser = paper)]
    paper: Option<Paper>,
    /// Folder for the table and for every figure as CSV and SVG; made if it does not exist
    #[arg(long, value_name = "FOLDER")]
    out: Option<PathBuf>,
    /// Prints everything as one JSON object
    #[arg(long)]
    json: bool,
}

fn paper(name: &str) -> Result<Paper, String> {
    Paper::named(name).ok_or_else(|| format!("the papers are {}", Paper::NAMES.join(", ")))
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Error> {
    let all = || Paper::ALL.to_vec();
    let papers = arguments.paper.map_or_else(all, |paper| vec![paper]);
    let result = reproduce(&papers)?;
    if let Some(folder) = &arguments.out {
        let files = write_files(folder, &result)?;
        say(&format!("{files} files written to {}", folder.display()));
    }
    let streams = Streams::new(&[], None, &[], arguments.json)?;
    let summary = ReproductionSummary::new(&result);
    streams.show(&summary, || report::reproduction(&result))?;
    match result.surprises().count() {
        0 => Ok(()),
        count => Err(Error::Incomplete(format!(
            "{count} verdicts are not the known ones"
        ))),
    }
}

fn write_files(folder: &Path, result: &Reproduction) -> Result<usize, Error> {
    std::fs::create_dir_all(folder).map_err(Error::write(folder.display()))?;
    let write = |name: String, text: String| Output::create(&folder.join(name))?.text(&text);
    write("numbers.csv".to_owned(), report::reproduction_csv(result))?;
    for drawing in &result.drawings {
        let name = report::file_name(drawing);
        write(format!("{name}.csv"), report::drawing_csv(drawing))?;
        let svg = sheet(&drawing.title, 2, None, &drawing.plots)?;
        write(format!("{name}.svg"), svg)?;
    }
    Ok(1 + 2 * result.drawings.len())
}
