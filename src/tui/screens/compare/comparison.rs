//! Comparison of runs, measurement by measurement, with its conclusions.

use std::collections::BTreeMap;

use crate::messages::snapshot::Compared;
use crate::widgets::text;
use fit::Simulator;
use store::{ChiRow, JobRow, RecommendationRow};

/// Most runs in a comparison.
pub const MOST: usize = 6;
/// Least difference between chi of two runs that counts: half of the third decimal.
const DIFFERS: f64 = 0.0005;
/// Difference of EI below which runs are equally good in practice, as for recommendations.
const MARGIN: f64 = 0.01;

/// One measurement of all compared runs.
#[derive(Clone, Debug, PartialEq)]
pub struct ComparisonRow {
    pub no: u32,
    pub name: String,
    /// Pattern length in the first run with the measurement.
    pub l2d_m: f64,
    /// Chi of each run; `None` for a run without the measurement.
    pub chi: Vec<Option<f64>>,
}

impl ComparisonRow {
    /// Text to which the filter applies: what its line shows.
    pub fn words(&self) -> String {
        let chi: Vec<String> = self.chi.iter().flatten().map(|chi| format!("{chi:.3}")).collect();
        format!("#{} {} {} {}", self.no, self.name, text::mm(self.l2d_m), chi.join(" "))
    }

    pub fn differs(&self) -> bool {
        let first = self.chi[0];
        self.chi.iter().any(|chi| match (first, chi) {
            (Some(a), Some(b)) => (a - b).abs() >= DIFFERS,
            (a, b) => a.is_some() != b.is_some(),
        })
    }

    /// Index of the run whose chi is nearest to 1; `None` where several are.
    pub fn nearest(&self) -> Option<usize> {
        let error = |k: usize| self.chi[k].map_or(f64::INFINITY, |chi| (chi - 1.0).abs());
        let best = (0..self.chi.len()).min_by(|a, b| error(*a).total_cmp(&error(*b)))?;
        let is_alone = (0..self.chi.len()).all(|k| k == best || error(k) - error(best) >= DIFFERS);
        (is_alone && self.chi.len() > 1).then_some(best)
    }
}

/// Labels of runs: the parts of their names that are not the same in all.
pub fn labels(jobs: &[&JobRow]) -> Vec<String> {
    let parts: [fn(&JobRow) -> String; 5] = [
        |job| job.study.clone(),
        |job| job.garment.clone(),
        |job| job.size.clone(),
        |job| job.subject.clone(),
        |job| text::sim(job.simulator).to_owned(),
    ];
    let telling: Vec<_> = parts.iter().filter(|part| jobs.iter().any(|job| part(job) != part(jobs[0]))).collect();
    let label = |job: &&JobRow| {
        let words: Vec<String> = telling.iter().map(|part| part(job)).collect();
        if words.is_empty() { format!("#{}", job.id) } else { words.join(" ") }
    };
    let labels: Vec<String> = jobs.iter().map(label).collect();
    let is_twice = |label: &String| labels.iter().filter(|other| *other == label).count() > 1;
    labels
        .iter()
        .zip(jobs)
        .map(|(label, job)| if is_twice(label) { format!("{label} #{}", job.id) } else { label.clone() })
        .collect()
}

/// Measurements of all runs, each run at its last stage, matched by number and name.
pub fn comparison_rows(runs: &[Compared]) -> Vec<ComparisonRow> {
    let mut found: Vec<ComparisonRow> = Vec::new();
    for (k, run) in runs.iter().enumerate() {
        for row in last_stage(&run.chi) {
            let at = found.iter().position(|known| known.no == row.no && known.name == row.name).unwrap_or_else(|| {
                found.push(ComparisonRow {
                    no: row.no,
                    name: row.name.clone(),
                    l2d_m: row.l2d_m,
                    chi: vec![None; runs.len()],
                });
                found.len() - 1
            });
            found[at].chi[k] = Some(row.chi());
        }
    }
    found
}

fn last_stage(chi: &[ChiRow]) -> impl Iterator<Item = &ChiRow> {
    let last = ["drape", "popup", "sewn"].into_iter().find(|stage| chi.iter().any(|row| row.stage == *stage));
    chi.iter().filter(move |row| Some(row.stage.as_str()) == last)
}

/// Conclusions, in sentences, the most important first.
pub fn verdict(runs: &[Compared], recommended: Option<&RecommendationRow>) -> Vec<String> {
    let jobs: Vec<&JobRow> = runs.iter().map(|run| &run.job).collect();
    let names = labels(&jobs);
    let mut said = Vec::new();
    said.push(truest(runs, &names));
    let rows = comparison_rows(runs);
    let won = |k: usize| rows.iter().filter(|row| row.nearest() == Some(k)).count();
    let wins: Vec<String> = names.iter().enumerate().map(|(k, name)| format!("{name} {}", won(k))).collect();
    let ties = rows.iter().filter(|row| row.nearest().is_none()).count();
    if !rows.is_empty() {
        said.push(format!("nearest to 1, of {} measurements: {}, even {ties}", rows.len(), wins.join(", ")));
    }
    for (run, name) in runs.iter().zip(&names) {
        said.extend(run.job.inside().map(|words| format!("{name} lies {words} the body: cloth could not")));
    }
    let restored = runs.iter().zip(&names).filter(|(run, _)| run.chi.iter().any(|row| row.is_controlled));
    let restored: Vec<&str> = restored.map(|(_, name)| name.as_str()).collect();
    if !restored.is_empty() && restored.len() < runs.len() {
        said.push(format!("{} restores these lengths by construction: its EI flatters it", restored.join(", ")));
    }
    if let Some(row) = recommended {
        let class = row.class.as_str();
        said.push(format!(
            "for {class} fits of {}: {}, by {} ({})",
            row.garment,
            row.recommended.as_str(),
            row.basis,
            row.reason
        ));
    }
    said
}

/// Sentence on both simulators over all sizes and subjects of a garment that both have draped: mean EI, and how often
/// each has the less. `None` for fewer than two of them.
pub fn of_study(jobs: &[JobRow], of: &JobRow) -> Option<String> {
    let is_it = |job: &&JobRow| job.study == of.study && job.garment == of.garment && job.is_current;
    let mut pairs: BTreeMap<(&str, &str, u32), [Option<f64>; 2]> = BTreeMap::new();
    for job in jobs.iter().filter(is_it) {
        let pair = pairs.entry((&job.size, &job.subject, job.repeat)).or_default();
        pair[usize::from(job.simulator == Simulator::Hybrid)] = job.ei;
    }
    let pairs: Vec<[f64; 2]> = pairs.into_values().filter_map(|[fem, hybrid]| Some([fem?, hybrid?])).collect();
    let count = pairs.len();
    let mean = |k: usize| pairs.iter().map(|pair| pair[k]).sum::<f64>() / count as f64;
    let less = |k: usize| pairs.iter().filter(|pair| pair[k] < pair[1 - k]).count();
    (count > 1).then(|| {
        let told = |k: usize, name: &str| format!("{name} {:.4} (less in {})", mean(k), less(k));
        format!("all {count} pairs of {}: mean EI {}, {}", of.garment, told(0, "FEM"), told(1, "HYB"))
    })
}

/// Names the run with the least EI, or the runs that are equally good in practice.
fn truest(runs: &[Compared], names: &[String]) -> String {
    let mut ranked: Vec<(&str, f64)> =
        runs.iter().zip(names).filter_map(|(run, name)| Some((name.as_str(), run.metrics.as_ref()?.ei))).collect();
    ranked.sort_by(|a, b| a.1.total_cmp(&b.1));
    let list = |runs: &[(&str, f64)]| {
        let words: Vec<String> = runs.iter().map(|(name, ei)| format!("{name} {ei:.4}")).collect();
        words.join(", ")
    };
    let [(best, least), (_, next), ..] = ranked[..] else {
        return "fewer than two of these runs have a result yet".to_owned();
    };
    let (near, far) = ranked.split_at(ranked.partition_point(|(_, ei)| ei - least < MARGIN));
    match (near, far) {
        (_, []) => format!("no practical difference: EI {}, less than {MARGIN} apart", list(near)),
        ([_], _) => format!("{best} is truest: EI {least:.4}, {:.4} less than the next; {}", next - least, list(far)),
        _ => format!("truest, less than {MARGIN} apart: EI {}; then {}", list(near), list(far)),
    }
}

/// Names of inputs in which runs differ from the first, without the hash of default parameters, which differs between
/// simulators.
pub fn differing_inputs(runs: &[Compared]) -> Vec<String> {
    let Some((first, rest)) = runs.split_first() else { return vec![] };
    let mut names: Vec<String> = rest
        .iter()
        .flat_map(|run| run.inputs.changes_since(&first.inputs))
        .map(|change| change.name)
        .filter(|name| name != "sim.parameters")
        .collect();
    names.sort();
    names.dedup();
    names
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_is_alone_or_nobody() {
        let row = |chi: &[Option<f64>]| ComparisonRow { no: 1, name: "Hem".into(), l2d_m: 1.0, chi: chi.to_vec() };
        let check = |chi: &[Option<f64>], nearest, differs| {
            assert_eq!((row(chi).nearest(), row(chi).differs()), (nearest, differs), "{chi:?}");
        };
        check(&[Some(1.02), Some(0.99)], Some(1), true);
        check(&[Some(1.01), Some(0.99)], None, true);
        check(&[Some(1.0), Some(1.0001)], None, false);
        check(&[Some(1.2), None], Some(0), true);
        check(&[Some(1.2)], None, false);
    }
}
