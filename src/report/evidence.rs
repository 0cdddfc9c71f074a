//! Section of the page on the cases that both simulators draped: statistics, differences with intervals, crossovers,
//! and sensitivity to single measurements.

use super::ReportError;
use super::chart::{Chart, Difference, crossover_chart, difference_chart};
use super::data::ReportData;
use super::text::{fit_glyph, number, signed};
use fit::{Analysis, Pair, crossover, rule_score};

pub(super) struct EvidencePart {
    pub statistics: Vec<Statistic>,
    pub differences: Option<Chart>,
    pub crossovers: Vec<Crossing>,
    /// Charts, one for each garment, of the difference with each measurement left out in turn.
    pub without: Vec<Chart>,
    /// Differences without free edges and without controlled measurements.
    pub told_apart: Vec<ToldApart>,
    /// Success rate of the rule of the thesis, in words.
    pub rule: String,
}

/// A row of statistics.
pub(super) struct Statistic {
    pub name: String,
    /// Style class of the fit; empty for all fits together.
    pub class: &'static str,
    pub fit: String,
    pub cells: Vec<String>,
}

/// A chart of cases against ease, with its conclusion.
pub(super) struct Crossing {
    pub chart: Chart,
    pub words: String,
}

/// Differences of a garment, with all measurements or without some.
pub(super) struct ToldApart {
    pub name: String,
    pub what: String,
    pub cells: Vec<String>,
}

impl EvidencePart {
    /// `None` without a case that both simulators draped.
    pub fn new(data: &ReportData) -> Result<Option<Self>, ReportError> {
        let Some(evidence) = data.evidence.as_ref().filter(|_| !data.pairs.is_empty()) else { return Ok(None) };
        let of_answers = evidence.answers.iter().filter(|answer| answer.analysis.cases > 0).map(|answer| {
            let fit = format!("{} {}", fit_glyph(answer.class), answer.class.as_str());
            let regret = answer.regret.map_or_else(dash, |[own, constant]| format!("{own:.4} / {constant:.4}"));
            let cells = cells(&answer.analysis, answer.p_holm, regret);
            Statistic { name: answer.garment.clone(), class: answer.class.as_str(), fit, cells }
        });
        let of_garments = evidence.garments.iter().map(|all_fits| Statistic {
            name: all_fits.garment.clone(),
            class: "",
            fit: "all fits".into(),
            cells: cells(&all_fits.analysis, all_fits.p_holm, dash()),
        });
        let mut without = Vec::new();
        let mut told_apart = Vec::new();
        for all_fits in &evidence.garments {
            without.extend(without_chart(&all_fits.garment, &all_fits.analysis)?);
            told_apart.extend(told(&all_fits.garment, &all_fits.analysis));
        }
        let score = rule_score(&data.pairs);
        Ok(Some(Self {
            statistics: of_answers.chain(of_garments).collect(),
            differences: differences(data)?,
            crossovers: crossings(data)?,
            without,
            told_apart,
            rule: format!(
                "The thesis's rule, FEM-GS for loose fits and Hybrid-GS for tight ones, names the simulator with the lower EI \
                 in {} of {} loose or tight cases.",
                score.right, score.of
            ),
        }))
    }

    /// Follows the order of the page.
    pub fn charts(&mut self) -> impl Iterator<Item = &mut Chart> {
        self.differences.iter_mut().chain(self.crossovers.iter_mut().map(|c| &mut c.chart)).chain(&mut self.without)
    }
}

fn dash() -> String {
    "–".into()
}

/// Cells of a row: subjects, cases, mean, interval, effect size, p, p after Holm, p of equivalence, cases with the
/// lower EI, regret.
fn cells(analysis: &Analysis, p_holm: Option<f64>, regret: String) -> Vec<String> {
    let estimate = analysis.estimate.as_ref();
    let p = |p: Option<f64>| p.map_or_else(dash, |p| if p < 0.001 { "< 0.001".into() } else { number(p, 3) });
    let interval = estimate.and_then(|e| e.interval);
    vec![
        analysis.subjects.len().to_string(),
        analysis.cases.to_string(),
        estimate.map_or_else(dash, |e| signed(e.mean, 4)),
        interval.map_or_else(dash, |(low, high)| format!("{} to {}", signed(low, 4), signed(high, 4))),
        estimate.and_then(|e| e.size).map_or_else(dash, |size| signed(size, 2)),
        p(estimate.map(|e| e.p)),
        p(p_holm),
        p(estimate.and_then(|e| e.p_equivalence)),
        format!("{} / {}", analysis.wins[0], analysis.wins[1]),
        regret,
    ]
}

fn differences(data: &ReportData) -> Result<Option<Chart>, ReportError> {
    let Some(evidence) = &data.evidence else { return Ok(None) };
    let row = |label: String, analysis: &Analysis| {
        let estimate = analysis.estimate?;
        let label = format!("{label} ({})", analysis.subjects.len());
        Some(Difference { label, mean: estimate.mean, interval: estimate.interval })
    };
    let answers = evidence
        .answers
        .iter()
        .filter_map(|answer| row(format!("{}, {}", answer.garment, answer.class.as_str()), &answer.analysis));
    let garments = evidence.garments.iter().filter_map(|all| row(format!("{}, all fits", all.garment), &all.analysis));
    let rows: Vec<Difference> = answers.chain(garments).collect();
    Ok(if rows.is_empty() { None } else { Some(difference_chart(&data.title, "differences", &rows, None)?) })
}

/// Charts for all garments together and, if there are several, for each.
fn crossings(data: &ReportData) -> Result<Vec<Crossing>, ReportError> {
    let garments = super::text::distinct(data.pairs.iter().map(|pair| pair.garment.as_str()));
    let each = if garments.len() > 1 { garments } else { vec![] };
    let mut all = Vec::new();
    for garment in [None].into_iter().chain(each.into_iter().map(Some)) {
        let pairs: Vec<&Pair> =
            data.pairs.iter().filter(|pair| garment.is_none_or(|name| name == pair.garment)).collect();
        let found = crossover(&pairs);
        let title = garment.unwrap_or("all garments");
        if let Some(chart) = crossover_chart(title, &pairs, found.as_ref(), &data.cuts)? {
            let place = found.map_or_else(|| "too few subjects, or one ease".to_owned(), |found| found.to_string());
            all.push(Crossing {
                chart,
                words: format!("{title}: EI difference of every case against its ease. Crossover: {place}."),
            });
        }
    }
    Ok(all)
}

fn without_chart(name: &str, analysis: &Analysis) -> Result<Option<Chart>, ReportError> {
    let row =
        |rest: &fit::Without| Difference { label: format!("without {}", rest.what), mean: rest.mean, interval: None };
    let rows: Vec<Difference> = analysis.without.iter().map(row).collect();
    let whole = analysis.estimate.map(|estimate| estimate.mean);
    Ok(if rows.is_empty() { None } else { Some(difference_chart(name, "without", &rows, whole)?) })
}

/// Rows of a garment: with all measurements, without free edges, without controlled measurements.
fn told(name: &str, analysis: &Analysis) -> Vec<ToldApart> {
    let row = |what: String, mean: f64, [fem, hybrid]: [usize; 2]| ToldApart {
        name: name.to_owned(),
        what,
        cells: vec![signed(mean, 4), fem.to_string(), hybrid.to_string()],
    };
    let all = analysis.estimate.map(|e| row("all measurements".into(), e.mean, analysis.wins));
    let rest = analysis.told_apart.iter().map(|rest| row(format!("without {}", rest.what), rest.mean, rest.wins));
    let mut rows: Vec<ToldApart> = all.into_iter().chain(rest).collect();
    if analysis.is_circular() {
        let what =
            format!("all {} measurements are set by a simulator: nothing is left without them", analysis.controlled);
        rows.push(ToldApart { name: name.to_owned(), what, cells: vec![dash(), dash(), dash()] });
    }
    rows
}
