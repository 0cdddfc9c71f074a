//! Data of the page that compares simulators, ready for its template: numbers are texts, and pictures are data URLs.

use super::ReportError;
use super::chart::{Chart, ease_chart, time_chart};
use super::data::{Outcome, ReportData, Severity, TryOn, Verdict};
use super::evidence::EvidencePart;
use super::images::address;
use super::repeats::RepeatPart;
use super::runs::{Group, groups};
use super::text::{
    count, distinct, duration, finding_words, fit_glyph, fit_words, mean_sd, mm, number, signed, signed_mm,
    simulator_name,
};
use fit::{Basis, Ease, Finding, FitClass, Simulator, shown};

#[derive(askama::Template)]
#[template(path = "report.html")]
pub(super) struct Page<'a> {
    data: &'a ReportData,
    summary: String,
    tiles: Vec<Tile>,
    verdicts: Vec<Garment>,
    audit: Vec<Note>,
    subjects: Vec<Row>,
    subject_statistics: [Row; 2],
    drawings: Vec<Plan>,
    /// Limits of the fit classes, mm.
    tight_below: String,
    loose_above: String,
    ease: Vec<Matrix<'a>>,
    groups: Vec<Group>,
    evidence: Option<EvidencePart>,
    ease_chart: Option<Chart>,
    time_chart: Option<Chart>,
    repeats: Option<RepeatPart>,
    /// Address of the fit report, if there is one.
    fit: Option<&'a str>,
}

struct Tile {
    value: String,
    name: String,
}

struct Garment {
    name: String,
    cards: Vec<Card>,
}

struct Card {
    class: &'static str,
    glyph: &'static str,
    simulator: &'static str,
    basis: &'static str,
    /// Name of the finding in SQL, for programs that read the page.
    verdict: &'static str,
    finding: &'static str,
    rule_says: &'static str,
    effect: String,
    p: String,
    subjects: String,
    reason: String,
    would_settle: String,
}

struct Note {
    severity: Severity,
    text: String,
}

struct Row {
    name: String,
    note: String,
    values: Vec<String>,
}

/// A pattern drawing.
struct Plan {
    garment: String,
    size: String,
    address: String,
}

/// Ease of a garment by size and subject.
struct Matrix<'a> {
    garment: &'a str,
    subjects: &'a [String],
    rows: Vec<(String, Vec<Fit>)>,
}

/// One cell of an ease matrix.
struct Fit {
    class: &'static str,
    glyph: &'static str,
    ease: String,
    words: String,
    /// Deciding level, with the girths of pattern and body there.
    girths: String,
    /// Picture that a customer should see.
    shown: String,
}

impl<'a> Page<'a> {
    /// Follows the order of the page.
    pub fn charts(&mut self) -> impl Iterator<Item = &mut Chart> {
        let of_evidence = self.evidence.iter_mut().flat_map(EvidencePart::charts);
        let of_repeats = self.repeats.iter_mut().flat_map(|part| &mut part.charts);
        let of_groups = self.groups.iter_mut().flat_map(Group::charts);
        of_groups.chain(of_evidence).chain(&mut self.ease_chart).chain(&mut self.time_chart).chain(of_repeats)
    }

    /// `fit` is the address of the fit report.
    pub fn new(data: &'a ReportData, fit: Option<&'a str>) -> Result<Self, ReportError> {
        let pictures = data.runs.iter().flat_map(|r| r.views.iter().chain(r.maps.iter().map(|m| &m.picture)));
        let links = data.raw.iter().map(|l| &l.href).chain(pictures.map(|p| &p.file));
        if let Some(link) = links.into_iter().find(|l| l.contains(':') || l.starts_with('/')) {
            return Err(ReportError::Link(link.clone()));
        }
        let plan = |d: &super::data::Drawing| Plan {
            garment: d.garment.clone(),
            size: d.size.clone(),
            address: address("image/svg+xml", d.svg.as_bytes()),
        };
        Ok(Self {
            data,
            summary: summary(&data.runs),
            tiles: tiles(&data.runs),
            verdicts: verdicts(data),
            audit: audit(data),
            subjects: subjects(data),
            subject_statistics: subject_statistics(data),
            drawings: data.drawings.iter().map(plan).collect(),
            tight_below: number(data.cuts.tight_below_m * 1e3, 0),
            loose_above: number(data.cuts.loose_above_m * 1e3, 0),
            ease: matrices(data),
            groups: groups(&data.runs)?,
            evidence: EvidencePart::new(data)?,
            ease_chart: ease_chart(&data.runs, &data.cuts)?,
            time_chart: time_chart(&data.runs)?,
            repeats: RepeatPart::new(&data.runs)?,
            fit,
        })
    }
}

/// True if all runs come from published tables.
fn are_printed(runs: &[TryOn]) -> bool {
    runs.iter().all(|run| run.outcome == Outcome::Printed)
}

fn mean_ei(runs: &[TryOn], simulator: Simulator) -> Option<f64> {
    let (mean, _) =
        mean_sd(runs.iter().filter(|r| r.simulator == simulator).filter_map(|r| r.metrics(|_| true)).map(|m| m.ei));
    mean.is_finite().then_some(mean)
}

fn summary(runs: &[TryOn]) -> String {
    let garments = distinct(runs.iter().map(|r| r.garment.as_str())).join(", ");
    let subjects = distinct(runs.iter().map(|r| r.subject.as_str())).len();
    let converged = runs.iter().filter(|r| r.outcome == Outcome::Converged).count();
    if runs.is_empty() {
        return "No runs yet.".into();
    }
    let mut text = format!("{} of {garments} on {}; ", count(runs.len(), "run"), count(subjects, "subject"));
    text += &match converged {
        _ if are_printed(runs) => "as printed.".into(),
        all if all == runs.len() => "all converged.".into(),
        some => format!("{some} converged."),
    };
    for simulator in Simulator::ALL {
        if let Some(ei) = mean_ei(runs, simulator) {
            let name = simulator_name(simulator);
            text += &format!(" {name} is off the pattern by {} on average (mean EI {ei:.3}).", percent(ei));
        }
    }
    if subjects == 1 {
        text += " One subject tells nothing of other people.";
    }
    let error = |m: &super::data::Measured| (m.chi.chi() - 1.0).abs();
    let worst = runs
        .iter()
        .flat_map(|r| r.measured.iter().map(move |m| (r, m)))
        .filter(|(_, m)| m.chi.chi().is_finite())
        .max_by(|a, b| error(a.1).total_cmp(&error(b.1)));
    if let Some((run, m)) = worst {
        let (chi, no, name) = (m.chi.chi(), m.chi.no, &m.name);
        let (subject, simulator) = (&run.subject, simulator_name(run.simulator));
        text += &format!(" The greatest departure is #{no} {name}, chi {chi:.3}, on subject {subject} ({simulator}).");
    }
    text
}

fn percent(share: f64) -> String {
    format!("{} %", number(share * 100.0, 1))
}

fn tiles(runs: &[TryOn]) -> Vec<Tile> {
    let tile = |value: String, name: &str| Tile { value, name: name.into() };
    let converged = runs.iter().filter(|r| r.outcome == Outcome::Converged).count();
    let mut tiles = match are_printed(runs) {
        true => vec![tile(runs.len().to_string(), "drapes, as printed")],
        false => vec![tile(format!("{converged} / {}", runs.len()), "runs converged")],
    };
    for simulator in Simulator::ALL {
        if let Some(ei) = mean_ei(runs, simulator) {
            tiles.push(tile(format!("{ei:.3}"), &format!("mean EI, {}", simulator_name(simulator))));
        }
    }
    let chi = || runs.iter().flat_map(|r| &r.measured).map(|m| m.chi.chi());
    if chi().next().is_some() {
        let (low, high) = chi().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), c| (l.min(c), h.max(c)));
        tiles.push(tile(format!("{low:.3}–{high:.3}"), "range of chi"));
    }
    let done = || runs.iter().filter(|r| !matches!(r.outcome, Outcome::Failed(_) | Outcome::Printed));
    let (mean, _) = mean_sd(done().map(|r| r.wall_s));
    if mean.is_finite() {
        tiles.push(tile(duration(mean), "mean time of a run"));
        for simulator in Simulator::ALL {
            let depths = done().filter(|run| run.simulator == simulator).map(|run| run.penetration_max_m);
            if let Some(deepest) = depths.reduce(f64::max) {
                let name = format!("deepest in the body, {}", simulator_name(simulator));
                tiles.push(tile(format!("{} mm", mm(deepest)), &name));
            }
        }
    }
    tiles
}

/// A card for every garment and fit class. Without a finding of the study it follows the rule of the thesis.
fn verdicts(data: &ReportData) -> Vec<Garment> {
    let names =
        distinct(data.verdicts.iter().map(|v| v.garment.as_str()).chain(data.runs.iter().map(|r| r.garment.as_str())));
    let card_of = |name: &str, class: FitClass| {
        let given = data.verdicts.iter().find(|v| v.garment == name && v.class == class);
        card(given.unwrap_or(&by_rule(data, name, class)))
    };
    let classes = [FitClass::Tight, FitClass::Just, FitClass::Loose];
    names.iter().map(|n| Garment { name: (*n).into(), cards: classes.map(|c| card_of(n, c)).into() }).collect()
}

fn by_rule(data: &ReportData, garment: &str, class: FitClass) -> Verdict {
    let fits = |r: &&TryOn| r.garment == garment && r.ease.as_ref().is_some_and(|e| e.class == class);
    let subjects = distinct(data.runs.iter().filter(fits).map(|r| r.subject.as_str())).len();
    let ran = distinct(data.runs.iter().filter(fits).map(|r| simulator_name(r.simulator)));
    let why = match ran.as_slice() {
        [] => "No run of this study has this fit".into(),
        [only] => format!("Only {only} ran on this fit, so there is nothing to compare it with"),
        _ => "The study gives no verdict for this fit".to_owned(),
    };
    Verdict {
        garment: garment.into(),
        class,
        recommended: class.rule_says(),
        basis: Basis::Rule,
        finding: Finding::InsufficientEvidence,
        effect: None,
        interval: None,
        p_holm: None,
        subjects,
        reason: format!("{why}; the thesis's rule stands."),
        would_settle: "Runs of both simulators on the same subjects with this fit.".into(),
    }
}

fn card(verdict: &Verdict) -> Card {
    let effect = match (verdict.effect, verdict.interval) {
        (None, _) => "not measured".into(),
        (Some(mean), None) => signed(mean, 4),
        (Some(mean), Some((low, high))) => format!("{} ({} to {})", signed(mean, 4), signed(low, 4), signed(high, 4)),
    };
    Card {
        class: verdict.class.as_str(),
        glyph: fit_glyph(verdict.class),
        simulator: simulator_name(verdict.recommended),
        basis: match verdict.basis {
            Basis::Rule => "by the thesis's rule",
            Basis::Evidence => "by this study's evidence",
        },
        verdict: verdict.finding.as_str(),
        finding: finding_words(verdict.finding),
        rule_says: simulator_name(verdict.class.rule_says()),
        effect,
        p: verdict.p_holm.map_or_else(|| "too few subjects".into(), |p| number(p, 3)),
        subjects: count(verdict.subjects, "subject"),
        reason: verdict.reason.clone(),
        would_settle: verdict.would_settle.clone(),
    }
}

/// Failed and unconverged runs first, then the study's own notes.
fn audit(data: &ReportData) -> Vec<Note> {
    let of_run = |run: &TryOn| {
        let name = format!(
            "{} {}, subject {}, {}, {}",
            run.garment,
            run.size,
            run.subject,
            simulator_name(run.simulator),
            run.fabric
        );
        match &run.outcome {
            Outcome::Failed(why) => Some(Note { severity: Severity::Failure, text: format!("{name} failed: {why}") }),
            Outcome::NotConverged => {
                let residual = percent(run.residual);
                let text = format!(
                    "{name} did not converge (residual {residual} of a vertex's weight); it is shown and counted."
                );
                Some(Note { severity: Severity::Warning, text })
            }
            Outcome::Converged | Outcome::Printed => None,
        }
    };
    let given = data.audit.iter().map(|n| Note { severity: n.severity, text: n.text.clone() });
    let mut notes: Vec<Note> = data.runs.iter().filter_map(of_run).chain(given).collect();
    notes.sort_by_key(|n| n.severity as u8);
    notes
}

fn subjects(data: &ReportData) -> Vec<Row> {
    let table = &data.subjects;
    let cell = |value: Option<&Option<f64>>, decimals| number(value.copied().flatten().unwrap_or(f64::NAN), decimals);
    let row = |s: &super::data::Subject| Row {
        name: s.name.clone(),
        note: s.note.clone(),
        values: table.columns.iter().enumerate().map(|(k, c)| cell(s.values.get(k), c.decimals)).collect(),
    };
    table.rows.iter().map(row).collect()
}

fn subject_statistics(data: &ReportData) -> [Row; 2] {
    let table = &data.subjects;
    let statistics = |k: usize| mean_sd(table.rows.iter().filter_map(|s| s.values.get(k).copied().flatten()));
    let (means, sds) = table
        .columns
        .iter()
        .enumerate()
        .map(|(k, c)| (statistics(k), c.decimals))
        .map(|((mean, sd), decimals)| (number(mean, decimals), number(sd, decimals.max(1))))
        .unzip();
    [("mean", means), ("SD", sds)].map(|(name, values)| Row { name: name.into(), note: String::new(), values })
}

fn matrices(data: &ReportData) -> Vec<Matrix<'_>> {
    let recommended = |garment: &str, class: FitClass| {
        let given = data.verdicts.iter().find(|v| v.garment == garment && v.class == class);
        given.map_or_else(|| class.rule_says(), |verdict| verdict.recommended)
    };
    let fit = |garment: &str, ease: &Option<Ease>| match ease {
        Some(e) => Fit {
            class: e.class.as_str(),
            glyph: fit_glyph(e.class),
            ease: signed_mm(e.ease_m()),
            words: fit_words(e),
            girths: format!("{}: {} \u{2212} {}", e.level, mm(e.pattern_girth_m), mm(e.body_girth_m)),
            shown: format!("show: {}", shown(recommended(garment, e.class), e.is_undersized()).words()),
        },
        None => Fit {
            class: "unknown",
            glyph: "?",
            ease: "–".into(),
            words: "girth not known".into(),
            girths: String::new(),
            shown: String::new(),
        },
    };
    let row = |garment: &str, (size, cells): (&String, &Vec<Option<Ease>>)| {
        (size.clone(), cells.iter().map(|ease| fit(garment, ease)).collect())
    };
    data.ease
        .iter()
        .map(|m| Matrix {
            garment: &m.garment,
            subjects: &m.subjects,
            rows: m.sizes.iter().zip(&m.cells).map(|cells| row(&m.garment, cells)).collect(),
        })
        .collect()
}
