//! Sizes from the smallest to the largest by their names.

/// Sizes by their number, or by their letters (XXS, 2XL), each with what follows in the order given; names of other kinds keep
/// the order given, after them.
pub(crate) fn sorted<'s>(sizes: &[&'s str]) -> Vec<&'s str> {
    let mut sizes = sizes.to_vec();
    sizes.sort_by(|a, b| rank(a).total_cmp(&rank(b)));
    sizes
}

/// What a size is sorted by.
fn rank(size: &str) -> f64 {
    let size = size.trim().to_ascii_uppercase();
    letters(&size).or_else(|| leading_number(&size)).unwrap_or(f64::INFINITY)
}

/// Rank of a letter size: M is 0, and each X adds one.
fn letters(size: &str) -> Option<f64> {
    let stem = size.trim_end_matches(['S', 'M', 'L']);
    let extra = match stem.strip_suffix('X') {
        None if stem.is_empty() => 0.0,
        None => return None,
        Some(before) if before.chars().all(|c| c == 'X') => 1.0 + before.len() as f64,
        Some(before) => before.parse::<f64>().ok()?,
    };
    match &size[stem.len()..] {
        "S" => Some(-1.0 - extra),
        "M" if extra == 0.0 => Some(0.0),
        "L" => Some(1.0 + extra),
        _ => None,
    }
}

fn leading_number(size: &str) -> Option<f64> {
    let digits = size.find(|c: char| !c.is_ascii_digit() && c != '.').unwrap_or(size.len());
    size[..digits].parse().ok()
}

#[cfg(test)]
mod tests {
    use super::sorted;

    #[test]
    fn sizes_are_sorted_as_they_are_hung() {
        let check = |given: &[&str], expect: &[&str]| assert_eq!(sorted(given), expect);
        check(&["L", "XXS", "M", "2XL", "S", "XS", "XL"], &["XXS", "XS", "S", "M", "L", "XL", "2XL"]);
        check(&["44", "28", "9.5", "36"], &["9.5", "28", "36", "44"]);
        check(&["36/R", "34/R", "tall"], &["34/R", "36/R", "tall"]);
        check(&["small", "base", ""], &["small", "base", ""]);
    }
}
