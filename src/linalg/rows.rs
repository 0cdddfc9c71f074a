//! Counting sort of items by their rows, as for compressed sparse rows.

/// Sorts stably, by counting. Returns the start of each row and the number of items, and the `kept` values.
pub fn sorted_by_row<I, T: Copy + Default>(
    rows: usize,
    items: &[I],
    row: impl Fn(&I) -> usize,
    kept: impl Fn(&I) -> T,
) -> (Vec<u32>, Vec<T>) {
    let mut starts = vec![0; rows + 1];
    items.iter().for_each(|item| starts[row(item) + 1] += 1);
    for r in 0..rows {
        starts[r + 1] += starts[r];
    }
    let mut next = starts.clone();
    let mut sorted = vec![T::default(); items.len()];
    for item in items {
        let at = &mut next[row(item)];
        sorted[*at as usize] = kept(item);
        *at += 1;
    }
    (starts, sorted)
}
