//! A bounded number of items, evenly spread over a sequence of unknown length.

/// Every n-th item of a sequence; n doubles when the items get too many.
#[derive(Debug)]
pub(super) struct Thinned<T> {
    most: usize,
    kept: Vec<T>,
    seen: u64,
    stride: u64,
}

impl<T> Thinned<T> {
    /// At most `most` items will be kept.
    pub fn new(most: usize) -> Thinned<T> {
        Thinned {
            most,
            kept: Vec::new(),
            seen: 0,
            stride: 1,
        }
    }

    /// Takes an item; keeps it if it is one of the few.
    pub fn take(&mut self, item: T) {
        if self.seen.is_multiple_of(self.stride) {
            self.kept.push(item);
        }
        self.seen += 1;
        if self.kept.len() > self.most {
            let mut index = 0;
            self.kept.retain(|_| {
                index += 1;
                index % 2 == 1
            });
            self.stride *= 2;
        }
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
