//! Where a list changes, near its beginning.

/// How many entries, from the first on, are as asked, where none is after one that is not: looked for in steps that double.
pub fn leading<T>(list: &[T], asked: impl Fn(&T) -> bool) -> usize {
    let (mut from, mut step) = (0, 1);
    while let Some(entry) = list.get(from + step - 1)
        && asked(entry)
    {
        from += step;
        step *= 2;
    }
    let end = list.len().min(from + step - 1);
    from + list[from..end].partition_point(asked)
}

#[cfg(test)]
mod tests {
    use super::leading;

    #[test]
    fn as_many_as_there_are() {
        for length in 0..40 {
            let list: Vec<usize> = (0..length).collect();
            for count in 0..=length {
                assert_eq!(leading(&list, |entry| *entry < count), count);
            }
        }
    }
}
