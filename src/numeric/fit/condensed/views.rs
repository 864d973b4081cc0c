//! Rows that stand for others, or for some of them.

use std::ops::Range;

use super::Rows;

impl Rows<'_> {
    /// These rows, and the same in ever fewer blocks as long as there are at least so many. For curves that are polynomials
    /// of degree NODES − 1 in each block they are the same problem.
    pub(in crate::numeric::fit) fn levels(&self, fewest: usize) -> Vec<Rows<'_>> {
        let mut levels = vec![self.borrowed()];
        while let Some(last) = levels.last()
            && last.ends.len() >= 2 * fewest
            && let Some(wide) = last.halved()
        {
            levels.push(wide);
        }
        levels
    }

    /// Some rows of samples as they are.
    pub(in crate::numeric::fit) fn part(&self, range: Range<usize>) -> Rows<'_> {
        let t = &self.t[range.clone()];
        Rows {
            t: t.into(),
            target: self.target[range.clone()].into(),
            weight: self.weight.as_ref().map(|weight| weight[range].into()),
            span: [t[0], t[t.len() - 1]],
            count: t.len(),
            left: 0.0,
            ends: Vec::new(),
            ..*self
        }
    }
}
