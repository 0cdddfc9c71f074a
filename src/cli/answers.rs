//! `toile sql`, `toile audit` and `toile ease`: queries of the database.

use std::io::{IsTerminal, Read};
use std::sync::atomic::AtomicBool;

use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::iterator::Signals;

use super::args::{Audit as AuditArguments, AuditCommand, Format, Sql, StudyPath};
use super::context::{Context, project_folder};
use super::progress::Ongoing;
use super::{CliError, End, Outcome, output, wardrobe};
use geom::units::mm;
use results::{Finding, audit};
use store::{EaseRow, StudyError, Table, Value, read, saved_queries, saved_query, sql};

const FORMATS: [(&str, Format); 5] = [
    ("csv", Format::Csv),
    ("json", Format::Json),
    ("parquet", Format::Parquet),
    ("xlsx", Format::Xlsx),
    ("txt", Format::Table),
];

/// Ctrl-C ends a query.
pub fn sql(context: &Context, arguments: &Sql) -> Outcome {
    let project = project_folder().map(|project| project.join("db").join("queries"));
    if arguments.list {
        let saved = saved_queries(project.as_deref())?.into_iter();
        let rows = saved.map(|saved| vec![Value::Text(saved.name), Value::Text(saved.about)]);
        context.print(&Table::new(["name", "what it asks"], rows))?;
        return Ok(End::Done);
    }
    let query = match (&arguments.query, &arguments.file) {
        (Some(name), _) if is_name(name) => saved_query(project.as_deref(), name)?,
        (Some(query), _) => query.clone(),
        (None, Some(file)) if file.as_os_str() == "-" => {
            let mut text = String::new();
            std::io::stdin().read_to_string(&mut text)?;
            text
        }
        (None, Some(file)) => {
            std::fs::read_to_string(file).map_err(|source| StudyError::Io { path: file.clone(), source })?
        }
        (None, None) => return Err(CliError::Usage("no query; give one, or a file with -f".into())),
    };
    let format = match &arguments.output {
        Some(path) => output::kind_or(path, arguments.format, &FORMATS)?,
        None => arguments.format.unwrap_or(if context.json { Format::Json } else { Format::Table }),
    };
    let is_binary = matches!(format, Format::Parquet | Format::Xlsx);
    if is_binary && arguments.output.is_none() && std::io::stdout().is_terminal() {
        return Err(CliError::Usage("a binary file is not for a terminal; give a file with -o".into()));
    }
    let store = context.store()?;
    let interrupter = sql::interrupter(&store);
    let mut signals = Signals::new([SIGINT, SIGTERM])?;
    let handle = signals.handle();
    let ongoing = Ongoing::new("", context.quiet || arguments.output.is_none());
    let answer = std::thread::scope(|scope| {
        scope.spawn(move || signals.forever().for_each(|_| interrupter.interrupt()));
        let go_on = AtomicBool::new(false);
        let answer = sql::answer(&store, &query, usize::MAX, &go_on, &mut |read| {
            ongoing.tell("", format_args!("{read} rows so far"));
        });
        handle.close();
        answer
    })?;
    let answer = answer.table;
    ongoing.end();
    let bytes = output::encoded(&answer, format)?;
    match &arguments.output {
        None => output::bytes(&bytes)?,
        Some(path) => std::fs::write(path, bytes).map_err(|source| StudyError::Io { path: path.clone(), source })?,
    }
    Ok(End::Done)
}

/// True if a query is a single word, which no SQL is: then it is the name of a saved query.
fn is_name(query: &str) -> bool {
    query.chars().all(|c| c.is_alphanumeric() || matches!(c, '_' | '-')) && !query.is_empty()
}

/// Findings on a study make the exit code 3. The errors of the thesis are known and do not.
pub fn audit(context: &Context, arguments: &AuditArguments) -> Outcome {
    let path = match (&arguments.command, &arguments.study) {
        (Some(AuditCommand::Garments(arguments)), _) => return wardrobe::audit(context, arguments),
        (None, Some(path)) => path,
        (None, None) => return Err(CliError::Usage("no study; give its name".into())),
    };
    let store = context.store()?;
    let name = path.to_string_lossy();
    let is_study = read::studies(&store)?.iter().any(|study| study.name == name);
    let of_thesis = name == "thesis-published" || (name == "thesis" && !is_study);
    let audit = if of_thesis {
        audit::audit_thesis(&store)?
    } else {
        audit::audit_study(&store, &context.study_name(&store, path)?)?
    };
    context.print(&Finding::table(&audit.findings))?;
    let found = audit.findings.len();
    context.say(format_args!("{} numbers and statements checked, {found} findings", audit.recomputed));
    Ok(if of_thesis || found == 0 { End::Done } else { End::CheckFailed })
}

/// Row of `toile ease`. Only the level that decides has a fit class, since the thesis defines classes for chest and
/// hip. `toile fit` judges the other levels.
fn ease_row(ease: EaseRow) -> Vec<Value> {
    let tenth = |length_m: f64| output::tenths(mm(length_m));
    let mark = |holds: bool| Value::Text(if holds { "yes" } else { "" }.to_owned());
    let class = if ease.decides { ease.fit.class.as_str() } else { "" };
    vec![
        Value::Text(ease.garment),
        Value::Text(ease.size),
        Value::Text(ease.subject),
        Value::Text(ease.level),
        tenth(ease.pattern_girth_m),
        tenth(ease.body_girth_m),
        tenth(ease.fit.ease_m),
        Value::Text(class.to_owned()),
        mark(ease.fit.undersized),
        mark(ease.decides && ease.fit.borderline),
    ]
}

pub fn ease(context: &Context, arguments: &StudyPath) -> Outcome {
    let (store, name) = context.eased(&arguments.study)?;
    let columns = [
        "garment",
        "size",
        "subject",
        "level",
        "pattern_girth_mm",
        "body_girth_mm",
        "ease_mm",
        "fit_class",
        "undersized",
        "borderline",
    ];
    let rows = read::ease(&store, &name)?.into_iter().map(ease_row);
    let table = Table::new(columns, rows);
    if context.json {
        let quoted = name.replace('\'', "''");
        let exact = sql::query(&store, &format!("SELECT * FROM v_ease WHERE study = '{quoted}'"))?;
        output::json(&output::rows(&exact))?;
    } else {
        context.print(&table)?;
    }
    if table.rows.is_empty() {
        context.say(NO_EASE);
        return Ok(End::CheckFailed);
    }
    Ok(End::Done)
}

pub const NO_EASE: &str = "no ease is known: the roles of the pieces show no girth; `toile pattern seam role` sets a role, and a seam file \
     may name the line of a level ([fit.chest], docs/reference.md)";

#[cfg(test)]
mod tests {
    use super::*;
    use fit::FitClass;
    use store::FitCell;

    #[test]
    fn only_the_level_that_decides_has_a_class() {
        let check = |ease_mm: f64, class: FitClass, decides: bool, expect: [&str; 3]| {
            let ease_m = 1e-3 * ease_mm;
            let [garment, size, subject, level] = ["top", "40", "a", "wrist"].map(str::to_owned);
            let row = EaseRow {
                garment,
                size,
                subject,
                level,
                pattern_girth_m: 0.9 + ease_m,
                body_girth_m: 0.9,
                decides,
                fit: FitCell { ease_m, class, undersized: ease_m < 0.0, borderline: (40.0..50.0).contains(&ease_mm) },
            };
            let told: Vec<String> = ease_row(row)[7..].iter().map(Value::to_string).collect();
            assert_eq!(told, expect, "{ease_mm}, {decides}");
        };
        check(41.0, FitClass::Tight, true, ["tight", "", "yes"]);
        check(41.0, FitClass::Tight, false, ["", "", ""]);
        check(-7.0, FitClass::Tight, false, ["", "yes", ""]);
        check(211.0, FitClass::Loose, true, ["loose", "", ""]);
    }
}
