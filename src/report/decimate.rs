//! A bounded number of items, evenly spread over a sequence of unknown length.

/// One item of every n of a sequence, that of the largest weight; n doubles when the items get too many.
#[derive(Debug)]
pub(super) struct Thinned<T> {
    most: usize,
    weight: fn(&T) -> f64,
    kept: Vec<T>,
    seen: u64,
    stride: u64,
}

impl<T> Thinned<T> {
    /// At most `most` items will be kept, evenly spread.
    pub fn new(most: usize) -> Thinned<T> {
        Thinned::weighted(most, |_| 0.0)
    }

    /// At most `most` items will be kept, of neighbours the first one of the largest weight.
    pub fn weighted(most: usize, weight: fn(&T) -> f64) -> Thinned<T> {
        Thinned {
            most,
            weight,
            kept: Vec::new(),
            seen: 0,
            stride: 1,
        }
    }

    /// Takes an item; keeps it if it is one of the few.
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
        if self.kept.len() > self.most {
            self.halve();
        }
    }

    fn halve(&mut self) {
        let weight = self.weight;
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

    /// Every so many items are kept.
    pub fn stride(&self) -> u64 {
        self.stride
    }

    /// The items kept.
    pub fn kept(&self) -> &[T] {
        &self.kept
    }
}
