//! Limits long lists of problems: lists the first of each kind and counts the rest.

use crate::scene::Problem;
use crate::scene::number::counted;

/// Largest number of problems of one kind that are listed; they show what the others are.
const MOST_LISTED: usize = 3;

/// Problems, of which the first of each kind are listed and all are counted.
#[derive(Default)]
pub(super) struct Listed {
    list: Vec<Problem>,
    count: usize,
}

impl Listed {
    pub fn push(&mut self, problem: Problem) {
        self.count += 1;
        self.list(problem);
    }

    /// Adds faults of one kind; `problem` describes those that are listed.
    pub fn push_alike<T>(
        &mut self,
        mut faults: impl Iterator<Item = T>,
        problem: impl Fn(T) -> Problem,
    ) {
        for fault in faults.by_ref().take(MOST_LISTED) {
            self.push(problem(fault));
        }
        self.count += faults.count();
    }

    fn list(&mut self, problem: Problem) {
        let alike = |other: &&Problem| other.help == problem.help && name(other) == name(&problem);
        if self.list.iter().filter(alike).count() < MOST_LISTED {
            self.list.push(problem);
        }
    }

    pub fn join(&mut self, other: Listed) {
        self.count += other.count;
        for problem in other.list {
            self.list(problem);
        }
    }

    /// Returns the listed problems, then the number of the others at the end of the text; none if there is no problem.
    pub fn refused(self, text: &str) -> Option<Vec<Problem>> {
        let mut list = self.list;
        let rest = self.count - list.len();
        if rest > 0 {
            let what = format!("{} more like these", counted(rest, "problem"));
            let last = Problem::new("", what, "repair the data, or take the rows out");
            list.push(last.at(text.len()..text.len()));
        }
        (!list.is_empty()).then_some(list)
    }
}

/// Returns the field without the sample, which the field of a problem in data from code contains.
fn name(problem: &Problem) -> &str {
    problem.field.split(',').next().unwrap_or_default()
}
