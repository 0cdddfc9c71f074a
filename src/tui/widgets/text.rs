//! Numbers and words for screens: aligned, and never cut without a mark.

use ratatui::text::Span;

use fit::Simulator;
use spec::bodies::Sex;
use store::{JobProgress, JobRow, Status};
use wardrobe::SubjectRow;

pub fn width(text: &str) -> usize {
    Span::raw(text).width()
}

/// Text in exactly `columns` columns, left-aligned; a long text ends in `…`.
pub fn left(text: &str, columns: usize) -> String {
    let text = shortened(text, columns);
    let gap = columns - width(&text);
    format!("{text}{}", " ".repeat(gap))
}

/// Text in exactly `columns` columns, right-aligned; a long text ends in `…`.
pub fn right(text: &str, columns: usize) -> String {
    let text = shortened(text, columns);
    format!("{}{text}", " ".repeat(columns - width(&text)))
}

/// Text in at most `columns` columns.
pub fn shortened(text: &str, columns: usize) -> String {
    if width(text) <= columns {
        return text.to_owned();
    }
    let mut short = String::new();
    for letter in text.chars() {
        short.push(letter);
        if width(&short) + 1 > columns {
            short.pop();
            break;
        }
    }
    if columns == 0 {
        return short;
    }
    // Keeps whole words if that loses little.
    match short.rfind(' ') {
        Some(space) if space * 2 > short.len() => short.truncate(space),
        _ => {}
    }
    short.push('…');
    short
}

pub fn mm(metres: f64) -> String {
    format!("{:.1}", metres * 1000.0)
}

/// Number as it can be typed, exactly; small numbers have an exponent.
pub fn exact(value: f64) -> String {
    if value != 0.0 && value.abs() < 1e-3 { format!("{value:e}") } else { value.to_string() }
}

/// Name of a level, region or point in words.
pub fn words(name: &str) -> String {
    name.replace('_', " ")
}

/// Whole number with U+2212 as its minus sign.
pub fn whole(value: f64) -> String {
    format!("{value:.0}").replace('-', "−")
}

/// Ease in whole mm, with its sign.
pub fn ease_mm(metres: f64) -> String {
    format!("{:+.0}", metres * 1000.0)
}

/// Time, ms since 1970, as date and time (UTC): `2026-03-01 07:05`.
pub fn date(ms: i64) -> String {
    let (days, minutes) = (ms.div_euclid(86_400_000), ms.rem_euclid(86_400_000) / 60_000);
    // Years begin in March here, so that the leap day comes last; 146,097 days are 400 years.
    let (era, day) = ((days + 719_468).div_euclid(146_097), (days + 719_468).rem_euclid(146_097));
    let year = (day - day / 1_460 + day / 36_524 - day / 146_096) / 365;
    let of_year = day - (365 * year + year / 4 - year / 100);
    let month = (5 * of_year + 2) / 153;
    let (of_month, month) = (of_year - (153 * month + 2) / 5 + 1, if month < 10 { month + 3 } else { month - 9 });
    let year = year + 400 * era + i64::from(month <= 2);
    format!("{year:04}-{month:02}-{of_month:02} {:02}:{:02}", minutes / 60, minutes % 60)
}

/// Duration in at most six columns.
pub fn duration(ms: i64) -> String {
    let seconds = ms.max(0) / 1000;
    match seconds {
        0..=9 => format!("{:.1}s", ms.max(0) as f64 / 1000.0),
        10..=99 => format!("{seconds}s"),
        100..=5999 => format!("{}m{:02}s", seconds / 60, seconds % 60),
        _ => format!("{}h{:02}m", seconds / 3600, seconds / 60 % 60),
    }
}

pub fn sim(simulator: Simulator) -> &'static str {
    match simulator {
        Simulator::Fem => "FEM",
        Simulator::Hybrid => "HYB",
    }
}

pub fn sex(subject: &SubjectRow) -> &'static str {
    match subject.measurements.sex {
        Sex::Male => "male",
        Sex::Female => "female",
    }
}

pub fn status(status: Status) -> &'static str {
    match status {
        Status::NotConverged => "not at rest",
        other => other.as_str(),
    }
}

pub fn ei(value: f64) -> String {
    format!("{value:.4}")
}

pub fn progress(progress: &JobProgress) -> String {
    format!("{} {:.0}%", left(&progress.phase, 5), progress.fraction * 100.0)
}

/// Share, 0 to 1, as a bar of `columns` columns.
pub fn progress_bar(share: f64, columns: usize) -> String {
    const EIGHTHS: [&str; 8] = ["", "▏", "▎", "▍", "▌", "▋", "▊", "▉"];
    let eighths = (share.clamp(0.0, 1.0) * columns as f64 * 8.0) as usize;
    let bar = format!("{}{}", "█".repeat(eighths / 8), EIGHTHS[eighths % 8]);
    left(&bar, columns)
}

/// Departure of a chi from 1 as a bar to the left or right of a middle line. Each side has `side` columns for 5 %; `◀`
/// or `▶` ends a longer bar.
pub fn chi_bar(chi: f64, side: usize) -> String {
    let steps = (chi - 1.0) / 0.05 * side as f64;
    let length = (steps.abs().round() as usize).min(side);
    let is_beyond = steps.abs() > side as f64 + 0.5;
    let bar = |end: &str| {
        if is_beyond { format!("{}{end}", "━".repeat(length.saturating_sub(1))) } else { "━".repeat(length) }
    };
    if steps < 0.0 {
        let bar = if is_beyond { format!("◀{}", "━".repeat(length.saturating_sub(1))) } else { bar("") };
        format!("{}│{}", right(&bar, side), " ".repeat(side))
    } else {
        format!("{}│{}", " ".repeat(side), left(&bar("▶"), side))
    }
}

/// Departure of a chi from 1 in one column: within 1 %, up to 3 % above or below, or more.
pub fn chi_mark(chi: f64) -> &'static str {
    match chi - 1.0 {
        error if error.abs() <= 0.01 => "·",
        error if error > 0.03 => "⇑",
        error if error > 0.0 => "↑",
        error if error < -0.03 => "⇓",
        _ => "↓",
    }
}

/// Latest numbers that fit, as a line of eight heights; a number that is not finite leaves a gap.
pub fn sparkline(values: &[f64], columns: usize) -> String {
    const HEIGHTS: [char; 8] = ['▁', '▂', '▃', '▄', '▅', '▆', '▇', '█'];
    let shown = resampled(values, columns);
    let finite = shown.iter().copied().filter(|v| v.is_finite());
    let (low, high) = finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)));
    let height = |v: f64| match v {
        v if !v.is_finite() => ' ',
        _ if high <= low => HEIGHTS[0],
        v => HEIGHTS[((v - low) / (high - low) * 7.0).round() as usize],
    };
    shown.into_iter().map(height).collect()
}

/// At most `columns` of the values, evenly chosen; the last is always among them.
fn resampled(values: &[f64], columns: usize) -> Vec<f64> {
    let n = values.len();
    if n <= columns {
        return values.to_vec();
    }
    (1..=columns).map(|k| values[k * n / columns - 1]).collect()
}

pub fn why(job: &JobRow, paused: bool) -> String {
    let inside = job.inside();
    match job.status {
        Status::NotConverged if inside.is_some() => {
            format!("{}, {}", status(job.status), inside.unwrap_or_default())
        }
        Status::Done if inside.is_some() => inside.unwrap_or_default(),
        Status::Failed => job.error.clone().unwrap_or_else(|| "failed".into()),
        Status::NotConverged => status(job.status).into(),
        Status::Queued if paused => "study is paused".into(),
        Status::Queued => {
            let reason = job.error.clone().unwrap_or_else(|| "waits".into());
            if job.priority == 0 {
                reason
            } else {
                format!("{reason}, priority {:+}", job.priority).replace('-', "−")
            }
        }
        Status::Cancelled => "cancelled".into(),
        Status::Running if job.attempts > 1 => format!("attempt {}", job.attempts),
        Status::Running => "in work".into(),
        Status::Done => "converged".into(),
    }
}

pub fn zone(offset_ms: i64) -> String {
    let minutes = offset_ms / 60_000;
    let sign = if minutes < 0 { '−' } else { '+' };
    match (minutes.abs() / 60, minutes.abs() % 60) {
        (0, 0) => "UTC".to_owned(),
        (hours, 0) => format!("UTC{sign}{hours}"),
        (hours, minutes) => format!("UTC{sign}{hours}:{minutes:02}"),
    }
}

/// Text in lines of at most `columns` columns, broken at spaces, or within a word that is longer.
pub fn wrapped(text: &str, columns: usize) -> Vec<String> {
    let mut lines = vec![];
    for paragraph in text.lines() {
        let mut line = String::new();
        for word in paragraph.split_whitespace().flat_map(|word| broken(word, columns)) {
            if !line.is_empty() && width(&line) + 1 + width(&word) > columns {
                lines.push(std::mem::take(&mut line));
            }
            if !line.is_empty() {
                line.push(' ');
            }
            line.push_str(&word);
        }
        lines.push(line);
    }
    lines
}

fn broken(word: &str, columns: usize) -> Vec<String> {
    let mut pieces = vec![String::new()];
    for letter in word.chars() {
        if let Some(last) = pieces.last_mut() {
            if width(last) + width(letter.encode_utf8(&mut [0; 4])) <= columns.max(1) {
                last.push(letter);
            } else {
                pieces.push(letter.to_string());
            }
        }
    }
    pieces
}

/// Percentile as a mark on a line of `columns` columns, with the median in the middle.
pub fn place_bar(percentile: f64, columns: usize) -> String {
    if columns < 5 {
        return String::new();
    }
    let at = (percentile / 100.0 * (columns - 1) as f64).round() as usize;
    let middle = (columns - 1) / 2;
    (0..columns)
        .map(|k| {
            if k == at {
                '●'
            } else if k == middle {
                '┼'
            } else {
                '─'
            }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dates_are_those_of_the_calendar() {
        let check = |ms: i64, expect: &str| assert_eq!(date(ms), expect);
        check(0, "1970-01-01 00:00");
        check(951_782_400_000, "2000-02-29 00:00");
        check(1_700_000_000_000, "2023-11-14 22:13");
        check(1_709_251_199_000, "2024-02-29 23:59");
    }

    #[test]
    fn texts_keep_their_columns() {
        let check = |text: &str, columns, expect: &str| assert_eq!(left(text, columns), expect);
        check("tee", 5, "tee  ");
        check("shirt", 5, "shirt");
        check("shirts", 5, "shir…");
        check("sleeve opening girth", 15, "sleeve opening…");
        check("a pneumonoultramicroscopic", 12, "a pneumonou…");
        check("x", 0, "");
        check("衣服衣服", 5, "衣服…");
        assert_eq!(right("1.5", 5), "  1.5");
    }

    #[test]
    fn long_words_are_broken_and_nothing_is_lost() {
        let check = |text: &str, columns, expect: &[&str]| assert_eq!(wrapped(text, columns), expect, "{text}");
        check("in a/very/long/path here", 8, &["in", "a/very/l", "ong/path", "here"]);
        check("衣服衣服", 5, &["衣服", "衣服"]);
        check("ab", 0, &["a", "b"]);
        check("one\ntwo", 9, &["one", "two"]);
    }

    #[test]
    fn zones_are_told_from_utc() {
        let check = |hours: f64, expect: &str| assert_eq!(zone((hours * 3_600_000.0) as i64), expect);
        check(0.0, "UTC");
        check(2.0, "UTC+2");
        check(-3.5, "UTC−3:30");
    }

    #[test]
    fn durations_are_short() {
        let check = |ms, expect: &str| assert_eq!(duration(ms), expect);
        check(-5, "0.0s");
        check(1234, "1.2s");
        check(83_000, "83s");
        check(125_000, "2m05s");
        check(7_260_000, "2h01m");
    }

    #[test]
    fn chi_bars_point_to_the_side_and_say_when_they_are_cut() {
        let check = |chi, expect: &str| assert_eq!(chi_bar(chi, 4), expect, "{chi}");
        check(1.0, "    │    ");
        check(1.025, "    │━━  ");
        check(0.975, "  ━━│    ");
        check(1.05, "    │━━━━");
        check(1.3, "    │━━━▶");
        check(0.7, "◀━━━│    ");
    }

    #[test]
    fn chi_marks_agree_with_the_bands_of_the_colours() {
        let marks: Vec<&str> = [0.9, 0.98, 0.995, 1.0, 1.02, 1.2].into_iter().map(chi_mark).collect();
        assert_eq!(marks, ["⇓", "↓", "·", "·", "↑", "⇑"]);
    }

    #[test]
    fn sparklines_show_the_course_up_to_the_last_value() {
        assert_eq!(sparkline(&[0.0, 1.0], 8), "▁█");
        assert_eq!(sparkline(&[2.0, 2.0], 8), "▁▁");
        assert_eq!(sparkline(&[0.0, f64::NAN, 1.0], 8), "▁ █");
        let falling: Vec<f64> = (0..100).map(|k| f64::from(100 - k)).collect();
        assert_eq!(sparkline(&falling, 8).chars().last(), Some('▁'));
        assert_eq!(sparkline(&falling, 8).chars().count(), 8);
    }

    #[test]
    fn bars_fill_with_the_share() {
        assert_eq!(progress_bar(0.5, 4), "██  ");
        assert_eq!(progress_bar(2.0, 4), "████");
        assert_eq!(progress_bar(0.0, 4), "    ");
    }
}
