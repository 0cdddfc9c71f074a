//! E, SD and EI of chapter 6, and the summaries of the subjects.

use crate::audit::ratios::as_computed;
use crate::audit::rounding::{mean, prints_as, variance};
use crate::audit::tables::{Metric, SUBJECTS, Sized, Summary, Tables};
use crate::audit::{Audit, Finding, three};
use fit::Simulator;

/// Upper bound of the number of measurements of a style of the thesis.
const MOST_MEASUREMENTS: usize = 16;
/// Error of a metric that comes from the rounding of the printed lengths.
const BLUR: f64 = 1e-4;

pub(super) fn check(tables: &Tables) -> Audit {
    let instead = stand_in(tables);
    let mut findings: Vec<Finding> = tables.metrics.iter().flat_map(|metric| row(tables, metric, instead)).collect();
    findings.extend(deviation(tables));
    findings.extend(missing(tables));
    Audit { recomputed: tables.metrics.len() * 7, findings }
}

/// Ratios of a metric's garment on a subject, as they were computed for the tables: wrong ones included.
fn ratios(tables: &Tables, metric: &Metric, subject: usize) -> Vec<f64> {
    tables.table(&metric.of, metric.simulator).into_iter().map(|row| as_computed(row, subject)).collect()
}

/// A metric by its definition: (6.2); (6.3), but with root and divisor n - 1; (6.4).
fn value(metric: &str, chis: &[f64]) -> f64 {
    match metric {
        "E" => mean(chis),
        "SD" => variance(chis, 1.0).sqrt(),
        _ => mean(&errors(chis)),
    }
}

fn row(tables: &Tables, metric: &Metric, instead: Option<usize>) -> Vec<Finding> {
    let place = |at: &str| {
        format!("table {}, {} of {} ({}), {at}", metric.table, metric.metric, metric.of, metric.simulator.as_str())
    };
    let cell = |subject: usize| {
        let chis = ratios(tables, metric, subject);
        let printed = metric.printed[subject];
        let recomputed = value(&metric.metric, &chis);
        (!prints_as(recomputed, printed, BLUR)).then(|| Finding {
            kind: "metric",
            place: place(SUBJECTS[subject]),
            stated: three(printed),
            recomputed: three(recomputed),
            says: explain(metric, &chis, printed, instead),
        })
    };
    let mut findings: Vec<Finding> = (0..6).filter_map(cell).collect();
    if !findings.is_empty() {
        let mended: Vec<f64> = (0..6).map(|s| value(&metric.metric, &ratios(tables, metric, s))).collect();
        findings.push(Finding {
            kind: "metric",
            place: place("average"),
            stated: three(metric.average),
            recomputed: three(mean(&mended)),
            says: "the mean of the printed six, wrong ones included".into(),
        });
    }
    let average = mean(&metric.printed);
    // The thesis averages unrounded numbers, so two roundings lie between its average and the mean of the printed ones.
    if (average - metric.average).abs() > 0.001 {
        findings.push(Finding {
            kind: "metric",
            place: place("average"),
            stated: three(metric.average),
            recomputed: three(average),
            says: "not the mean of the six numbers beside it".into(),
        });
    }
    findings
}

/// Index of the one measurement whose error is printed in place of most of the wrong EI.
fn stand_in(tables: &Tables) -> Option<usize> {
    let mut votes = [0; MOST_MEASUREMENTS];
    for metric in tables.metrics.iter().filter(|metric| metric.metric == "EI") {
        for subject in 0..6 {
            let errors = errors(&ratios(tables, metric, subject));
            if prints_as(mean(&errors), metric.printed[subject], BLUR) {
                continue;
            }
            for (votes, error) in votes.iter_mut().zip(&errors) {
                *votes += usize::from(prints_as(*error, metric.printed[subject], 0.0));
            }
        }
    }
    let most = votes.iter().copied().max().filter(|most| *most > 0)?;
    votes.iter().position(|n| *n == most)
}

fn errors(chis: &[f64]) -> Vec<f64> {
    chis.iter().map(|chi| (chi - 1.0).abs()).collect()
}

fn explain(metric: &Metric, chis: &[f64], printed: f64, instead: Option<usize>) -> String {
    let errors = errors(chis);
    if metric.metric == "EI" {
        if let Some(k) = instead.filter(|&k| errors.get(k).is_some_and(|error| prints_as(*error, printed, BLUR))) {
            return format!(
                "this is |chi - 1| of measurement #{} alone, not the mean over all {}",
                k + 1,
                errors.len()
            );
        }
        if prints_as(errors.iter().sum(), printed, BLUR * errors.len() as f64) {
            return format!("this is the sum over the {} measurements, not their mean", errors.len());
        }
    }
    "another number comes out".into()
}

/// SD by equation (6.3) as printed: divisor n, no root.
fn deviation(tables: &Tables) -> Option<Finding> {
    let printed = tables.metrics.iter().filter(|metric| metric.metric == "SD");
    let cells: Vec<(f64, Vec<f64>)> =
        printed.flat_map(|metric| (0..6).map(|s| (metric.printed[s], ratios(tables, metric, s)))).collect();
    let as_printed = cells.iter().filter(|(sd, chis)| prints_as(variance(chis, 0.0), *sd, 0.0)).count();
    let sample = cells.iter().filter(|(sd, chis)| prints_as(variance(chis, 1.0).sqrt(), *sd, BLUR)).count();
    (as_printed < cells.len()).then(|| Finding {
        kind: "equation",
        place: "equation (6.3)".into(),
        stated: format!("fits {as_printed} of {} printed SD", cells.len()),
        recomputed: format!("sample SD fits {sample} of {}", cells.len()),
        says: "printed without its root and with divisor n; the tables follow the sample SD, n - 1".into(),
    })
}

/// Metrics that the text places in its tables, where they are missing.
fn missing(tables: &Tables) -> Vec<Finding> {
    let mut findings = Vec::new();
    for of in tables.garments() {
        for simulator in [Simulator::Fem, Simulator::Hybrid] {
            let is_there = |name: &&str| {
                tables.metrics.iter().any(|m| m.of == of && m.simulator == simulator && m.metric == *name)
            };
            let (there, absent): (Vec<&str>, Vec<&str>) = ["E", "SD", "EI"].into_iter().partition(is_there);
            if !absent.is_empty() {
                findings.push(Finding {
                    kind: "missing",
                    place: format!("{of} ({})", simulator.as_str()),
                    stated: if there.is_empty() { "nothing".to_owned() } else { there.join(", ") },
                    recomputed: "E, SD, EI".into(),
                    says: format!("the text does not contain {}", absent.join(", ")),
                });
            }
        }
    }
    findings
}

/// Mean and SD of the subjects (Tables 6-3, 6-4), and the sex in the captions.
pub(super) fn subjects(tables: &Tables) -> Audit {
    let mut findings: Vec<Finding> = tables.summaries.iter().flat_map(|summary| statistics(tables, summary)).collect();
    let miscaptioned = tables.summaries.iter().filter(|s| s.captioned != s.sex && s.statistic == "mean");
    findings.extend(miscaptioned.map(|summary| Finding {
        kind: "caption",
        place: format!("table {}", summary.table),
        stated: format!("{} subjects", summary.captioned),
        recomputed: format!("{} subjects", summary.sex),
        says: "the caption names the other sex: the numbers are those of these subjects".into(),
    }));
    findings.extend(heading(tables));
    Audit { recomputed: tables.summaries.len() * 5, findings }
}

/// Checks Table 6-13, headed as the T-shirt's size S: the E that it prints are those of another size.
fn heading(tables: &Tables) -> Option<Finding> {
    let printed: Vec<&Metric> = tables.metrics.iter().filter(|m| m.table == "6-13" && m.metric == "E").collect();
    let fits = |size: &str| {
        let fits = |metric: &Metric, subject: usize| {
            let of = Sized { size: size.into(), ..metric.of.clone() };
            let e = mean(&ratios(tables, &Metric { of, ..metric.clone() }, subject));
            prints_as(e, metric.printed[subject], BLUR)
        };
        printed.iter().map(|metric| (0..6).filter(|&subject| fits(metric, subject)).count()).sum::<usize>()
    };
    let (headed, other) = (fits("s"), fits("l"));
    (headed < other).then(|| Finding {
        kind: "caption",
        place: "table 6-13".into(),
        stated: format!("t-shirt S: {headed} of {} E fit", 6 * printed.len()),
        recomputed: format!("t-shirt L: {other} of {} E fit", 6 * printed.len()),
        says: "the heading names another size: the numbers are those of L".into(),
    })
}

fn statistics(tables: &Tables, summary: &Summary) -> Vec<Finding> {
    let names = ["chest", "waist", "hip", "across shoulder", "neck"];
    let wrong = (0..5).filter_map(|k| {
        let sex = summary.sex.as_str();
        let own = tables.subjects.iter().filter(|(known, _)| known == sex);
        let values: Vec<f64> = own.map(|(_, numbers)| numbers[k]).collect();
        let recomputed = if summary.statistic == "mean" { mean(&values) } else { variance(&values, 1.0).sqrt() };
        ((recomputed - summary.numbers[k]).abs() > 0.0051).then(|| Finding {
            kind: "metric",
            place: format!("table {}, {} of {}", summary.table, summary.statistic, names[k]),
            stated: format!("{:.2}", summary.numbers[k]),
            recomputed: format!("{recomputed:.2}"),
            says: "another number comes out of the six subjects".into(),
        })
    });
    wrong.collect()
}
