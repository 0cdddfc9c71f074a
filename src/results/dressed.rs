//! Outcomes of the jobs of a study: a good drape, one with faults, or none.

use rusqlite::Row;
use serde::Serialize;

use engine::faults::drape_faults;
use fit::Simulator;
use pattern::size_order;
use store::{Result, Status, Store};

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Dressed {
    pub garment: String,
    pub size: String,
    pub subject: String,
    pub simulator: String,
    pub status: Status,
    pub faults: Vec<String>,
    pub refused: Option<String>,
    /// `None` without a drape.
    pub ei: Option<f64>,
    pub vertices: Option<i64>,
    /// Deepest penetration into the body. For Hybrid-GS this is no fault: it lets a garment that is too small lie
    /// inside.
    pub inside_mm: Option<f64>,
    /// Greatest excess of a body girth over that of the garment.
    pub shortfall_mm: Option<f64>,
    pub wall_ms: Option<i64>,
}

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Tally {
    pub simulator: String,
    pub ended: usize,
    pub good: usize,
    pub faulty: usize,
    pub refused: usize,
    pub mean_ei: Option<f64>,
    pub median_s: Option<f64>,
    pub slowest_s: Option<f64>,
}

/// Outcomes of the current jobs, sorted by names of garment and subject, then by size from the smallest.
pub fn dressed(store: &Store, study: &str) -> Result<Vec<Dressed>> {
    let sql = "SELECT job.garment, job.size, job.subject, job.simulator, job.status, job.error, job.wall_ms, m.ei,
            m.vertices, m.converged, m.residual, m.penetration_max_mm, m.self_crossings,
            (SELECT max(shortfall_mm) FROM v_gap WHERE v_gap.job_id = job.job_id)
        FROM v_jobs AS job LEFT JOIN v_metrics AS m USING (job_id)
        WHERE job.study = ? AND job.is_current
        ORDER BY job.garment, job.size, job.subject, job.simulator, job.repeat";
    let mut statement = store.reader.prepare_cached(sql)?;
    let mut rows = statement.query_map([study], dressed_row)?.collect::<rusqlite::Result<Vec<Dressed>>>()?;
    for garment in rows.chunk_by_mut(|a, b| a.garment == b.garment) {
        size_order::sort(garment, |job| &job.size);
    }
    Ok(rows)
}

fn dressed_row(row: &Row<'_>) -> rusqlite::Result<Dressed> {
    let status: String = row.get(4)?;
    let ei: Option<f64> = row.get(7)?;
    let simulator: String = row.get(3)?;
    let inside_mm: Option<f64> = row.get(11)?;
    let depth_mm = inside_mm.filter(|_| simulator == Simulator::Fem.as_str()).unwrap_or(0.0);
    let faults = match ei {
        Some(_) => drape_faults(row.get(9)?, row.get(10)?, depth_mm, row.get(12)?),
        None => Vec::new(),
    };
    let shortfall_mm: Option<f64> = row.get(13)?;
    Ok(Dressed {
        garment: row.get(0)?,
        size: row.get(1)?,
        subject: row.get(2)?,
        simulator,
        status: Status::from_name(&status).unwrap_or(Status::Failed),
        faults: faults.into_iter().map(|fault| fault.words).collect(),
        refused: row.get(5)?,
        ei,
        vertices: row.get(8)?,
        inside_mm,
        shortfall_mm: shortfall_mm.filter(|mm| *mm > 0.0),
        wall_ms: row.get(6)?,
    })
}

pub fn tally(all: &[Dressed]) -> Vec<Tally> {
    let mut simulators: Vec<&str> = all.iter().map(|job| job.simulator.as_str()).collect();
    simulators.sort_unstable();
    simulators.dedup();
    simulators.into_iter().map(|simulator| of_simulator(simulator, all)).collect()
}

fn of_simulator(simulator: &str, all: &[Dressed]) -> Tally {
    let ended: Vec<&Dressed> = all.iter().filter(|job| job.simulator == simulator && job.status.is_final()).collect();
    let eis: Vec<f64> = ended.iter().filter_map(|job| job.ei).collect();
    let faulty = ended.iter().filter(|job| !job.faults.is_empty()).count();
    let mut times: Vec<i64> = ended.iter().filter_map(|job| job.wall_ms).collect();
    times.sort_unstable();
    let seconds = |ms: &i64| *ms as f64 / 1e3;
    Tally {
        simulator: simulator.to_owned(),
        ended: ended.len(),
        good: eis.len() - faulty,
        faulty,
        refused: ended.len() - eis.len(),
        mean_ei: (!eis.is_empty()).then(|| eis.iter().sum::<f64>() / eis.len() as f64),
        median_s: times.get(times.len() / 2).map(seconds),
        slowest_s: times.last().map(seconds),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tally_counts_what_ended_and_how() {
        let job = |faults: &[&str], ei: Option<f64>, status, wall_ms| Dressed {
            garment: "g".into(),
            size: "one".into(),
            subject: "s".into(),
            simulator: "fem".into(),
            status,
            faults: faults.iter().map(|fault| (*fault).to_owned()).collect(),
            refused: None,
            ei,
            vertices: None,
            inside_mm: None,
            shortfall_mm: None,
            wall_ms,
        };
        let all = [
            job(&[], Some(0.01), Status::Done, Some(1000)),
            job(&["crosses"], Some(0.03), Status::Done, Some(3000)),
            job(&[], None, Status::Failed, Some(2000)),
            job(&[], None, Status::Queued, None),
        ];
        let [fem] = &tally(&all)[..] else { panic!("one simulator") };
        assert_eq!((fem.ended, fem.good, fem.faulty, fem.refused), (3, 1, 1, 1));
        assert_eq!((fem.mean_ei, fem.median_s, fem.slowest_s), (Some(0.02), Some(2.0), Some(3.0)));
        assert!(tally(&[]).is_empty());
    }
}
