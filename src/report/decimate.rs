//! Decimation: keeps a bounded number of items, evenly spread over a sequence of unknown length.

/// One item of each block of `stride` items, with the largest weight; the stride doubles beyond `most` items.
#[derive(Debug)]
pub(super) struct Decimated<T> {
    most: usize,
    weight: fn(&T) -> f64,
    /// Items kept.
    pub kept: Vec<T>,
    seen: u64,
    /// Number of items per item kept.
    pub stride: u64,
}

impl<T> Decimated<T> {
    /// Starts an empty selection of at most `most` items, evenly spread.
    pub fn new(most: usize) -> Decimated<T> {
        Decimated::weighted(most, |_| 0.0)
    }

    /// Starts an empty selection of at most `most` items, in each block the first one of the largest weight.
    pub fn weighted(most: usize, weight: fn(&T) -> f64) -> Decimated<T> {
        Decimated {
            most,
            weight,
            kept: Vec::new(),
            seen: 0,
            stride: 1,
        }
    }

    /// Takes an item; keeps it if it begins a block or outweighs the item kept of its block.
    pub fn take(&mut self, item: T) {
        let weight = self.weight;
        let begins = self.seen.is_multiple_of(self.stride);
        self.seen += 1;
        match self.kept.last_mut() {
            Some(last) if !begins => {
                if weight(&item) > weight(last) {
                    *last = item;
                }
            }
            _ => self.kept.push(item),
        }
        if self.kept.len() <= self.most {
            return;
        }
        let mut index = 0;
        self.kept.dedup_by(|next, last| {
            index += 1;
            let second = index % 2 == 1;
            if second && weight(next) > weight(last) {
                std::mem::swap(next, last);
            }
            second
        });
        self.stride *= 2;
    }
}
