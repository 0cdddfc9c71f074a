//! What is copied, and how it reaches the user's clipboard.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;

use super::action::Screen;
use super::compare;
use super::state::State;
use super::text;
use study::bodies::Measurements;
use study::{FABRIC_NUMBERS, Field, JobRow, MEASUREMENTS};

/// The text that stands for what is selected, tab-separated, and what it is.
#[must_use]
pub fn selection(state: &State) -> Option<(String, &'static str)> {
    match state.nav.screen {
        Screen::Results => chi_table(state).map(|table| (table, "the table of measurements")),
        Screen::Subjects => subject_line(state).map(|line| (line, "the subject")),
        Screen::Fabrics => fabric_line(state).map(|line| (line, "the fabric")),
        Screen::Styles => seam_table(state).map(|table| (table, "the table of seams")),
        Screen::Compare => contrast_table(state).map(|table| (table, "the comparison")),
        Screen::Sql => sheet_row(state).map(|rows| (rows, "the row")),
        Screen::Reports => state.report().map(|row| (row.page.display().to_string(), "the path")),
        Screen::Study | Screen::Jobs => job_line(state).map(|line| (line, "the job")),
    }
}

fn job_line(state: &State) -> Option<String> {
    let job = state.job()?;
    let ei = job.ei.map_or(String::new(), |ei| format!("{ei:.6}"));
    Some(format!(
        "{}\t{}\t{}\t{}\t{}\t{}\t{}\t{ei}\t{}",
        job.id,
        job.study,
        job.garment,
        job.size,
        job.subject,
        job.simulator.as_str(),
        job.status.as_str(),
        job.error.as_deref().unwrap_or_default()
    ))
}

fn subject_line(state: &State) -> Option<String> {
    let subject = state.subject()?;
    let value = |field: &Field<Measurements>| field.get(&subject.measurements).map_or(String::new(), |v| v.to_string());
    let values: Vec<String> = MEASUREMENTS.iter().map(value).collect();
    Some(format!("{}\t{}\t{}", subject.name, text::sex(subject), values.join("\t")))
}

fn fabric_line(state: &State) -> Option<String> {
    let fabric = &state.fabric()?.fabric;
    let values = FABRIC_NUMBERS.iter().map(|field| field.get(fabric).map_or(String::new(), |value| value.to_string()));
    Some(format!("{}\t{}\t{}", fabric.name, values.collect::<Vec<_>>().join("\t"), fabric.source))
}

fn seam_table(state: &State) -> Option<String> {
    let desk = &state.laid()?.ok()?.out.desk;
    let names = |chain: &[(usize, usize)]| {
        let name = |(piece, edge): &(usize, usize)| {
            let piece = &desk.pieces[*piece];
            let edge = &piece.edges[*edge];
            format!("{}.{}", piece.id, edge.name.clone().unwrap_or_else(|| edge.number.to_string()))
        };
        chain.iter().map(name).collect::<Vec<_>>().join("+")
    };
    let mut table = String::from("seam\ta\tb\ta_mm\tb_mm\tconfidence\n");
    for seam in &desk.seams {
        let confidence = seam.confidence.map_or(String::new(), |confidence| confidence.to_string());
        let (a, b) = (names(&seam.a), names(&seam.b));
        table += &format!("{}\t{a}\t{b}\t{:.1}\t{:.1}\t{confidence}\n", seam.name, seam.a_mm, seam.b_mm);
    }
    Some(table)
}

fn contrast_table(state: &State) -> Option<String> {
    let jobs: Vec<&JobRow> = state.compared().iter().map(|run| &run.job).collect();
    if jobs.is_empty() {
        return None;
    }
    let mut table = format!("no\tmeasurement\tl2d_mm\t{}\n", compare::labels(&jobs).join("\t"));
    for row in state.contrasts() {
        let chi = row.chi.iter().map(|chi| chi.map_or(String::new(), |chi| format!("{chi:.6}"))).collect::<Vec<_>>();
        table += &format!("{}\t{}\t{}\t{}\n", row.no, row.name, text::mm(row.l2d_m), chi.join("\t"));
    }
    Some(table)
}

fn sheet_row(state: &State) -> Option<String> {
    let sheet = state.sql.sheet.as_ref().filter(|sheet| sheet.len() > 0)?;
    Some(sheet.copied(std::iter::once(sheet.row)))
}

fn chi_table(state: &State) -> Option<String> {
    let rows = state.chi();
    if rows.is_empty() {
        return None;
    }
    let mut table = String::from("no\tmeasurement\tl2d_mm\tl3d_mm\tchi\n");
    for row in rows {
        let (l2d, l3d) = (text::mm(row.l2d_m), text::mm(row.l3d_m));
        table += &format!("{}\t{}\t{l2d}\t{l3d}\t{:.6}\n", row.no, row.name, row.chi());
    }
    Some(table)
}

/// The control sequence that puts a text on the clipboard of the terminal, wherever that runs (OSC 52).
#[must_use]
pub fn osc52(text: &str) -> String {
    format!("\x1b]52;c;{}\x07", STANDARD.encode(text))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clipboard_sequence() {
        assert_eq!(osc52("toile"), "\x1b]52;c;dG9pbGU=\x07");
    }
}
