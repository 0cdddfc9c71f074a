//! Order of sizes by their names, from the smallest to the largest.

/// Sorts stably by number, or by letters (XXS, 2XL). A double size (S/M) counts as its first. Other names come last.
pub fn sort<T>(sized: &mut [T], name: impl Fn(&T) -> &str) {
    sized.sort_by(|a, b| rank(name(a)).total_cmp(&rank(name(b))));
}

/// True if names are equal but for case, or have the same letters (XXL, 2XL).
pub fn is_same(name: &str, other: &str) -> bool {
    let [name, other] = [name, other].map(|name| name.trim().to_ascii_uppercase());
    name == other || letters(&name).is_some_and(|rank| letters(&other) == Some(rank))
}

fn rank(size: &str) -> f64 {
    let size = size.trim().to_ascii_uppercase();
    let first = size.split(|c: char| !c.is_ascii_alphanumeric()).next().unwrap_or_default();
    letters(first).or_else(|| leading_number(&size)).unwrap_or(f64::INFINITY)
}

/// 0 for M, one step for S or L, one more for each X.
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

/// Reads a fraction, too, as in `34 1/2`.
fn leading_number(size: &str) -> Option<f64> {
    let digits = size.find(|c: char| !c.is_ascii_digit() && c != '.').unwrap_or(size.len());
    let number: f64 = size[..digits].parse().ok()?;
    let fraction = match size[digits..].trim() {
        "¼" | "1/4" => 0.25,
        "½" | "1/2" => 0.5,
        "¾" | "3/4" => 0.75,
        _ => 0.0,
    };
    Some(number + fraction)
}

#[cfg(test)]
mod tests {
    use super::{is_same, sort};

    #[test]
    fn one_size_may_have_two_names() {
        let check = |name: &str, other: &str, expect: bool| assert_eq!(is_same(name, other), expect, "{name}, {other}");
        check("m", "M", true);
        check("XXL", "2XL", true);
        check("38", "38", true);
        check("", "", true);
        check("", "M", false);
        check("38", "40", false);
        check("XL", "2XL", false);
    }

    #[test]
    fn sizes_are_sorted_as_they_are_hung() {
        let check = |given: &[&str], expect: &[&str]| {
            let mut sizes = given.to_vec();
            sort(&mut sizes, |size| size);
            assert_eq!(sizes, expect);
        };
        check(&["L", "XXS", "M", "2XL", "S", "XS", "XL"], &["XXS", "XS", "S", "M", "L", "XL", "2XL"]);
        check(&["44", "28", "9.5", "36"], &["9.5", "28", "36", "44"]);
        check(&["12", "8", "10"], &["8", "10", "12"]);
        check(&["36/R", "34/R", "tall"], &["34/R", "36/R", "tall"]);
        check(&["L/XL", "XS/S", "S/M"], &["XS/S", "S/M", "L/XL"]);
        check(&["34 1/2", "34", "33 1/2"], &["33 1/2", "34", "34 1/2"]);
        check(&["15½", "15", "14½", "32/34", "30/34"], &["14½", "15", "15½", "30/34", "32/34"]);
        check(&["small", "base", ""], &["small", "base", ""]);
    }
}
