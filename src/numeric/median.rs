//! Median and range of a list of numbers.

/// Returns the median, the upper of two in the middle; none for an empty list.
pub fn median(numbers: impl IntoIterator<Item = f64>) -> Option<f64> {
    let mut list: Vec<f64> = numbers.into_iter().collect();
    let middle = list.len() / 2;
    (!list.is_empty()).then(|| *list.select_nth_unstable_by(middle, f64::total_cmp).1)
}

/// Returns the least and the greatest number; infinite of the wrong sign for an empty list.
pub fn range(numbers: &[f64]) -> (f64, f64) {
    let none = (f64::INFINITY, f64::NEG_INFINITY);
    let wider = |(low, high): (f64, f64), x: &f64| (low.min(*x), high.max(*x));
    numbers.iter().fold(none, wider)
}
