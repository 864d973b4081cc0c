//! Columns of a sweep.

use super::super::table::Cell;
use crate::scene::printable;
use crate::sweep::{self, Design, Sweep};

pub(super) fn header(sweep: &Sweep) -> Vec<String> {
    let mut all = vec!["design".to_owned()];
    all.extend(sweep.varied().iter().map(|one| one.column()));
    all.push("status".to_owned());
    all.extend(sweep.figures().iter().map(ToString::to_string));
    all.push("notes".to_owned());
    all
}

pub(super) fn cells(sweep: &Sweep, design: &Design) -> Vec<Cell> {
    let mut cells = vec![Cell::Number((design.index + 1) as f64)];
    for (varied, value) in sweep.varied().iter().zip(&design.values) {
        let number = value.number.filter(|_| varied.has_numbers());
        let text = || Cell::Text(printable(&value.text).into_owned());
        cells.push(number.map_or_else(text, Cell::Number));
    }
    cells.push(Cell::Text(design.outcome.name().to_owned()));
    cells.extend(
        sweep
            .figures()
            .iter()
            .map(|figure| match figure.cell(design) {
                sweep::Cell::Number(number) => Cell::Number(number),
                sweep::Cell::Word(word) => Cell::Text(word.to_owned()),
                sweep::Cell::Empty => Cell::EMPTY,
            }),
    );
    // A row is a line.
    let notes = design.notes.join("; ").replace(['\n', '\r'], " ");
    cells.push(Cell::Text(printable(&notes).into_owned()));
    cells
}
