//! Evidence of a study, judged from its results and stored for `v_recommendation`.

use rusqlite::{Connection, Row, named_params, params};

use crate::columns::fit_class;
use crate::error::Result;
use crate::transaction::lightly;
use fit::{self, Cell, Errors, Evidence, Pair};
use geom::units::from_mm;

/// Cases with converged results of both simulators, a row for each measurement; repeats are averaged.
const PAIRS: &str = "
    WITH error AS (
        SELECT chi.garment, chi.size, chi.subject, chi.simulator, measurement_no, measurement, is_free_edge, is_controlled,
            abs(chi - 1) AS error
        FROM v_chi AS chi JOIN v_metrics AS metrics USING (job_id)
        WHERE chi.study = :study AND stage = 'drape' AND converged
    )
    SELECT garment, size, subject, fit_class, ease_mm, measurement_no, min(measurement),
        avg(error) FILTER (WHERE simulator = 'fem') AS fem, avg(error) FILTER (WHERE simulator = 'hybrid') AS hybrid,
        max(is_free_edge), max(is_controlled)
    FROM v_pair JOIN error USING (garment, size, subject)
    WHERE study = :study
    GROUP BY garment, size, subject, measurement_no
    HAVING fem IS NOT NULL AND hybrid IS NOT NULL
    ORDER BY garment, size, subject, measurement_no";

const CELLS: &str = "SELECT DISTINCT garment, fit_class FROM v_ease WHERE study = :study AND decides ORDER BY 1, 2";

struct Judged {
    evidence: Evidence,
    basis: Basis,
}

/// Fingerprint of the pairs of a study, to tell whether they changed.
struct Basis {
    pairs: i64,
    /// Sum over all pairs of the difference of EI and of the ease in mm.
    checksum: f64,
}

/// Judges the results of a study where they changed since the last time. Other connections may write meanwhile; the
/// view hides evidence whose basis is not that of the present results.
pub fn update(connection: &mut Connection, study: &str) -> Result<()> {
    let reading = connection.transaction()?;
    let judged = if is_judged(&reading, study)? { None } else { Some(judge(&reading, study)?) };
    drop(reading);
    judged.map_or(Ok(()), |judged| lightly(connection, |transaction| keep(transaction, study, &judged)))
}

pub fn refresh(connection: &Connection, study: &str) -> Result<()> {
    keep(connection, study, &judge(connection, study)?)
}

/// True if the stored evidence of a study was judged from its present results, for all its garments and fit classes.
fn is_judged(connection: &Connection, study: &str) -> Result<bool> {
    let kept =
        "SELECT count(*) FROM evidence JOIN study USING (study_id) WHERE name = ? AND pairs = ? AND checksum = ?";
    let Basis { pairs, checksum } = basis(connection, study)?;
    let kept: i64 = connection.prepare_cached(kept)?.query_row(params![study, pairs, checksum], |row| row.get(0))?;
    Ok(kept == cells(connection, study)?.len() as i64)
}

fn basis(connection: &Connection, study: &str) -> Result<Basis> {
    let sql = "SELECT count(*), total(d_ei) + total(ease_mm) FROM v_pair WHERE study = ?";
    Ok(connection
        .prepare_cached(sql)?
        .query_row([study], |row| Ok(Basis { pairs: row.get(0)?, checksum: row.get(1)? }))?)
}

fn judge(connection: &Connection, study: &str) -> Result<Judged> {
    let evidence = fit::judge(&cells(connection, study)?, &stored_pairs(connection, study)?);
    Ok(Judged { evidence, basis: basis(connection, study)? })
}

fn keep(connection: &Connection, study: &str, judged: &Judged) -> Result<()> {
    connection
        .prepare_cached("DELETE FROM evidence WHERE study_id = (SELECT study_id FROM study WHERE name = ?)")?
        .execute([study])?;
    let mut statement = connection.prepare_cached(
        "INSERT INTO evidence
        SELECT study_id, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10, ?11, ?12, ?13, ?14, ?15, ?16 FROM study WHERE name = ?1",
    )?;
    for answer in &judged.evidence.answers {
        let estimate = answer.analysis.estimate;
        let interval = estimate.and_then(|e| e.interval);
        statement.execute(params![
            study,
            answer.garment,
            answer.class.as_str(),
            answer.finding.as_str(),
            estimate.map(|e| e.mean),
            interval.map(|i| i.0),
            interval.map(|i| i.1),
            estimate.and_then(|e| e.size),
            estimate.map(|e| e.p),
            answer.p_holm,
            estimate.and_then(|e| e.p_equivalence),
            answer.analysis.subjects.len() as i64,
            answer.reason,
            answer.would_settle,
            judged.basis.pairs,
            judged.basis.checksum
        ])?;
    }
    Ok(())
}

/// Judges every study of a database, after a migration that made the views anew.
pub(crate) fn refresh_all(connection: &Connection) -> Result<()> {
    let mut statement = connection.prepare("SELECT name FROM study ORDER BY name")?;
    let names: Vec<String> = statement.query_map([], |row| row.get(0))?.collect::<rusqlite::Result<_>>()?;
    names.iter().try_for_each(|name| refresh(connection, name))
}

pub(super) fn cells(connection: &Connection, study: &str) -> Result<Vec<Cell>> {
    let mut statement = connection.prepare_cached(CELLS)?;
    let cell = |row: &Row<'_>| Ok(Cell { garment: row.get(0)?, class: fit_class(row, 1)? });
    let cells = statement.query_map(named_params! { ":study": study }, cell)?.collect::<rusqlite::Result<_>>()?;
    Ok(cells)
}

pub(super) fn stored_pairs(connection: &Connection, study: &str) -> Result<Vec<Pair>> {
    let mut statement = connection.prepare_cached(PAIRS)?;
    let mut rows = statement.query(named_params! { ":study": study })?;
    let mut pairs: Vec<Pair> = Vec::new();
    while let Some(row) = rows.next()? {
        let errors = Errors {
            no: row.get(5)?,
            name: row.get(6)?,
            fem: row.get(7)?,
            hybrid: row.get(8)?,
            free_edge: row.get(9)?,
            controlled: row.get(10)?,
        };
        let (garment, size, subject): (String, String, String) = (row.get(0)?, row.get(1)?, row.get(2)?);
        match pairs.last_mut() {
            Some(last) if (&last.garment, &last.size, &last.subject) == (&garment, &size, &subject) => {
                last.errors.push(errors);
            }
            _ => {
                let (class, ease_m) = (fit_class(row, 3)?, from_mm(row.get(4)?));
                pairs.push(Pair { garment, size, subject, class, ease_m, errors: vec![errors] });
            }
        }
    }
    Ok(pairs)
}
