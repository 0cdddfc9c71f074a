//! `toile doctor` and `toile info`.

use super::context::{Context, project_folder};
use super::{End, Outcome};
use geom::units::mm;
use results::{Check, checks};
use store::{INSIDE_M, Status, Table, Value, read};

/// Exit code 3 if a check fails.
pub fn doctor(context: &Context) -> Outcome {
    let found: Vec<Check> = checks(&context.db, context.readonly);
    let text = |text: &str| Value::Text(text.to_owned());
    let rows = found.iter().map(|check| {
        vec![text(if check.passed { "ok" } else { "FAILED" }), text(check.name), Value::Text(check.found.clone())]
    });
    let columns = ["result", "check", "found"];
    context.print(&Table::new(columns, rows))?;
    Ok(if found.iter().all(|check| check.passed) { End::Done } else { End::CheckFailed })
}

pub fn info(context: &Context) -> Outcome {
    let store = context.store()?;
    let mut rows = vec![
        ("version".to_owned(), env!("CARGO_PKG_VERSION").to_owned()),
        ("database".to_owned(), context.db.display().to_string()),
        (
            "project".to_owned(),
            project_folder().map_or_else(|| "none".to_owned(), |folder| folder.display().to_string()),
        ),
    ];
    for study in read::studies(&store)? {
        let counts = Status::ALL.into_iter().filter(|&status| study.count(status) > 0);
        let counts: Vec<String> = counts.map(|status| format!("{} {}", study.count(status), status.as_str())).collect();
        let paused = if study.paused { ", paused" } else { "" };
        let inside = match read::inside(&store, &study.name)? {
            0 => String::new(),
            inside => format!(", {inside} more than {:.0} mm inside the body", mm(INSIDE_M)),
        };
        rows.push((
            format!("study {}", study.name),
            format!("{}{inside}{paused}; {}", counts.join(", "), study.path.display()),
        ));
    }
    let rows = rows.into_iter().map(|(name, value)| vec![Value::Text(name), Value::Text(value)]);
    context.print(&Table::new(["what", "value"], rows))?;
    Ok(End::Done)
}
