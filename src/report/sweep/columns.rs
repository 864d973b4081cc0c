//! Columns of a sweep.

use super::super::csv::shortest;
use crate::scene::printable;
use crate::sweep::{Cell, Design, Sweep};

pub(super) fn header(sweep: &Sweep) -> Vec<String> {
    let mut all = vec!["design".to_owned()];
    all.extend(sweep.varied().iter().map(|one| one.column()));
    all.push("status".to_owned());
    all.extend(sweep.figures().iter().map(ToString::to_string));
    all.push("notes".to_owned());
    all
}

pub(super) fn cells(sweep: &Sweep, design: &Design) -> Vec<String> {
    let mut cells = vec![(design.index + 1).to_string()];
    for (varied, value) in sweep.varied().iter().zip(&design.values) {
        let number = value.number.filter(|_| varied.has_numbers());
        cells.push(number.map_or_else(|| printable(&value.text).into_owned(), shortest));
    }
    cells.push(design.outcome.name().to_owned());
    cells.extend(
        sweep
            .figures()
            .iter()
            .map(|figure| match figure.cell(design) {
                Cell::Number(number) => shortest(number),
                Cell::Word(word) => word.to_owned(),
                Cell::Empty => String::new(),
            }),
    );
    // A row is a line.
    let notes = design.notes.join("; ").replace(['\n', '\r'], " ");
    cells.push(printable(&notes).into_owned());
    cells
}
