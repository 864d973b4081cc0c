//! Key figures of many designs.

use std::time::Instant;

use pyo3::prelude::*;
use pyo3::types::PyDict;
use slider_crank::error::Error;
use slider_crank::report::{
    self, MOST_PAGE_DESIGNS, SweepSummary, SweepSummaryOptions, SweepWriter, Table,
};
use slider_crank::scene::Varied;
use slider_crank::simulate::Options;
use slider_crank::sweep::{Figure, Goal, LatinHypercube, Sweep, SweepOptions};

use crate::call::{self, Call};
use crate::columns::arrays;
use crate::design::parsed;
use crate::errors::{raised, refused};
use crate::scene::{Scene, method_of};

/// A finished sweep.
#[pyclass(frozen)]
pub struct Designs {
    sweep: Sweep,
    rows: SweepSummaryOptions,
    summary: SweepSummary,
    scene: Py<Scene>,
}

/// What is asked of a sweep.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct Asked {
    vary: Vec<String>,
    figures: Vec<String>,
    least: Vec<String>,
    most: Vec<String>,
    sample: Option<u64>,
    seed: u64,
    percentiles: bool,
    motion: bool,
    reactions: bool,
    steady_state: bool,
    fluctuation: Option<f64>,
    estimate: bool,
    method: String,
    max_evaluations: Option<u64>,
}

impl Asked {
    fn goals(&self) -> PyResult<Vec<Goal>> {
        let least = parsed(&self.least)?.into_iter().map(Goal::least);
        let most = parsed(&self.most)?.into_iter().map(Goal::most);
        Ok(least.chain(most).collect())
    }

    /// But for the request to stop.
    fn options(&self, goals: &[Goal]) -> PyResult<SweepOptions> {
        let mut figures: Vec<Figure> = parsed(&self.figures)?;
        if !figures.is_empty() {
            let beside = goals.iter().map(|goal| goal.figure);
            let named = figures.clone();
            figures.extend(beside.filter(|figure| !named.contains(figure)));
        }
        let default = Options::default();
        Ok(SweepOptions {
            figures,
            sample: self.sample.map(|count| LatinHypercube {
                count,
                seed: self.seed,
            }),
            motion: self.motion,
            steady: self.steady_state,
            fluctuation: self.fluctuation,
            run: Options {
                method: method_of(&self.method)?,
                reactions: self.reactions,
                estimate: self.estimate,
                max_evaluations: self.max_evaluations.unwrap_or(default.max_evaluations),
                ..default
            },
        })
    }
}

/// Computes all designs: columns, and what they range over.
fn computed(
    sweep: &Sweep,
    asked: &SweepSummaryOptions,
) -> Result<(Option<Table>, SweepSummary), Error> {
    let begun = Instant::now();
    let mut writer = SweepWriter::new(None, sweep, [1, 1], asked)?;
    writer.compute(|_| ())?;
    let table = writer.table();
    Ok((table, writer.finish(begun.elapsed().as_secs_f64())?))
}

/// A sweep: its columns, its summary as JSON, and what makes its page.
#[pyfunction]
pub fn sweep<'py>(
    py: Python<'py>,
    scene: Py<Scene>,
    asked: Asked,
) -> PyResult<(Bound<'py, PyDict>, String, Designs)> {
    let this = scene.get();
    this.only_text("sweep").map_err(raised)?;
    let mut varied: Vec<Varied> = parsed(&asked.vary)?;
    if varied.is_empty() {
        varied = this.draft.tolerances();
    }
    let goals = asked.goals()?;
    let options = asked.options(&goals)?;
    let rows = SweepSummaryOptions {
        goals,
        percentiles: asked.percentiles,
        kept: Some(usize::MAX),
    };
    let (table, sweep, summary) = call::run(py, |call| {
        let options = stopping(options, call);
        let sweep = Sweep::new(this.draft.clone(), varied, options)?;
        let (table, summary) = computed(&sweep, &rows)?;
        Ok((table, sweep, summary))
    })?;
    let json = report::json(&summary).map_err(raised)?;
    let columns = match table {
        Some(table) => arrays(py, table)?,
        None => PyDict::new(py),
    };
    let designs = Designs {
        sweep,
        rows,
        summary,
        scene,
    };
    Ok((columns, json, designs))
}

fn stopping(mut options: SweepOptions, call: &Call) -> SweepOptions {
    options.run.stop = Some(call.stop.clone());
    options
}

#[pymethods]
impl Designs {
    /// The report page; the designs are computed once more.
    fn page(&self, py: Python<'_>) -> PyResult<String> {
        let count = self.sweep.len();
        if count > MOST_PAGE_DESIGNS {
            return Err(refused(
                format!("a page shows {MOST_PAGE_DESIGNS} designs at most, and these are {count}"),
                "use the columns",
            ));
        }
        let (table, _) = call::run(py, |_| computed(&self.sweep, &self.rows))?;
        let origin = self.scene.get().origin("sweep");
        let table = table.ok_or_else(|| refused("there are no designs", "vary a key"))?;
        report::sweep_page(&self.summary, &table, &origin).map_err(raised)
    }
}
