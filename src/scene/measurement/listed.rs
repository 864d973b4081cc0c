//! Of many problems of one kind the first are listed, and the rest counted.

use crate::scene::Problem;
use crate::scene::number::counted;

/// Problems of one kind that are listed; all are counted.
pub(super) const MOST_LISTED: usize = 3;

/// Lists a problem, unless enough like it are listed.
pub(super) fn list(problems: &mut Vec<Problem>, problem: Problem) {
    let alike = |other: &&Problem| other.field == problem.field && other.help == problem.help;
    if problems.iter().filter(alike).count() < MOST_LISTED {
        problems.push(problem);
    }
}

/// How many problems there are beside those that are listed, if any.
pub(super) fn more(count: usize, text: &str) -> Option<Problem> {
    (count > 0).then(|| {
        let what = format!("{} more like these", counted(count, "problem"));
        let mut last = Problem::new("", what, "repair the data, or take the rows out");
        last.span = Some(text.len()..text.len());
        last
    })
}
