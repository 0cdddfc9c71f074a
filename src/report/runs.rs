//! Runs of one garment and size: pictures, tables, charts.

use super::ReportError;
use super::chart::{Chart, Metric, chi_chart, mean_sd_chart, metric_chart, residual_chart};
use super::data::{Measured, Outcome, TryOn, measurements};
use super::images::{Image, MapImage};
use super::text::{duration, fit_glyph, fit_words, mean_sd, mm, number, signed_mm, simulator_name};
use super::theme;

/// One garment in one size.
pub(super) struct Group {
    pub id: String,
    pub title: String,
    pub strips: Vec<Strip>,
    /// True if a run was simulated here, so that its course is known.
    pub course: bool,
    pub series: Vec<Series>,
    pub metrics: Vec<MetricsRow>,
    pub heat: Heat,
    /// Mean chi of each series; `None` for a single series.
    pub side_by_side: Option<Heat>,
    pub metric_charts: Vec<Chart>,
    pub residual_chart: Option<Chart>,
}

impl Group {
    /// Follows the order of the page.
    pub fn charts(&mut self) -> impl Iterator<Item = &mut Chart> {
        let of_series = self.series.iter_mut().flat_map(|s| [&mut s.chi_chart].into_iter().chain(&mut s.mean_chart));
        of_series.chain(&mut self.metric_charts).chain(&mut self.residual_chart)
    }
}

/// The pictures of one run.
pub(super) struct Strip {
    pub simulator: &'static str,
    pub title: String,
    pub class: &'static str,
    pub fit: String,
    pub status: String,
    pub failure: Option<String>,
    pub images: Vec<Image>,
    pub maps: Vec<MapImage>,
}

/// The runs of one simulator and fabric, with their measurements side by side.
pub(super) struct Series {
    pub title: String,
    pub subjects: Vec<String>,
    pub rows: Vec<ChiRow>,
    pub summary: Vec<(&'static str, Vec<String>)>,
    pub published: bool,
    pub chi_chart: Chart,
    pub mean_chart: Option<Chart>,
}

impl Series {
    /// Caption of the series' chart of chi.
    pub fn chi_words(&self) -> String {
        let published = if self.published { " Hollow marks are the published values." } else { "" };
        format!("{}: chi of each measurement and subject.{published}", self.title)
    }
}

pub(super) struct ChiRow {
    pub no: u32,
    pub name: String,
    pub kind: &'static str,
    pub free: bool,
    pub controlled: bool,
    pub l2d: String,
    pub cells: Vec<ChiCell>,
    pub mean: String,
    pub sd: String,
}

pub(super) struct ChiCell {
    pub l3d: String,
    pub chi: String,
    pub published: Option<String>,
    /// Value that the thesis prints in place of this one.
    pub misprint: Option<String>,
}

pub(super) struct MetricsRow {
    pub label: String,
    pub class: &'static str,
    pub fit: String,
    pub truth: Vec<String>,
    pub status: String,
    pub course: Vec<String>,
}

/// Table of chi with coloured cells: a row for each measurement, a column for each run or series.
pub(super) struct Heat {
    pub columns: Vec<String>,
    pub rows: Vec<(String, Vec<Option<HeatCell>>)>,
}

pub(super) struct HeatCell {
    pub chi: String,
    pub ground: String,
    pub ink: String,
}

impl HeatCell {
    fn new(chi: f64) -> Self {
        let (ground, ink) = theme::chi_cell(chi);
        Self { chi: number(chi, 3), ground: ground.hex(), ink: ink.hex() }
    }
}

/// Groups by garment and size, in the order of their first appearance.
pub(super) fn groups(runs: &[TryOn]) -> Result<Vec<Group>, ReportError> {
    let fabrics = super::text::distinct(runs.iter().map(|r| r.fabric.as_str())).len();
    let mut keys: Vec<(&str, &str)> = Vec::new();
    for run in runs {
        let key = (run.garment.as_str(), run.size.as_str());
        if !keys.contains(&key) {
            keys.push(key);
        }
    }
    keys.iter()
        .enumerate()
        .map(|(k, &(garment, size))| {
            let members: Vec<&TryOn> =
                runs.iter().filter(|r| (r.garment.as_str(), r.size.as_str()) == (garment, size)).collect();
            group(k, format!("{garment}, size {size}"), &members, fabrics > 1)
        })
        .collect()
}

fn group(index: usize, title: String, runs: &[&TryOn], name_fabric: bool) -> Result<Group, ReportError> {
    let place = |r: &TryOn| if name_fabric { format!("{}, {}", wearer(r), r.fabric) } else { wearer(r) };
    let places: Vec<String> = runs.iter().map(|r| place(r)).collect();
    let both = runs.iter().any(|r| r.simulator != runs[0].simulator);
    let labels: Vec<String> = runs
        .iter()
        .zip(&places)
        .map(|(r, place)| if both { format!("{place} {}", r.simulator.as_str()) } else { place.clone() })
        .collect();
    let recorded = runs.iter().any(|r| r.residuals.len() > 1);
    Ok(Group {
        id: format!("g{}", index + 1),
        strips: runs.iter().filter(|r| r.outcome != Outcome::Printed).map(|r| strip(r)).collect::<Result<_, _>>()?,
        course: runs.iter().any(|r| r.outcome != Outcome::Printed),
        series: series(&title, runs)?,
        side_by_side: side_by_side(runs),
        metrics: runs.iter().zip(&labels).map(|(r, label)| metrics_row(r, label)).collect(),
        heat: heat(runs, &labels),
        metric_charts: Metric::ALL
            .into_iter()
            .map(|metric| metric_chart(&title, metric, runs, &places))
            .collect::<Result<_, _>>()?,
        residual_chart: if recorded { Some(residual_chart(&title, runs, &labels)?) } else { None },
        title,
    })
}

/// Name of the subject, with the number of the repeat from the second on.
fn wearer(run: &TryOn) -> String {
    if run.repeat > 1 { format!("{}, repeat {}", run.subject, run.repeat) } else { run.subject.clone() }
}

/// Style class, and words.
fn fit(run: &TryOn) -> (&'static str, String) {
    run.ease.as_ref().map_or(("unknown", "fit unknown".into()), |e| {
        (e.class.as_str(), format!("{} {}, {} mm", fit_glyph(e.class), fit_words(e), signed_mm(e.ease_m())))
    })
}

fn status(run: &TryOn) -> String {
    match &run.outcome {
        Outcome::Converged => "✓ converged".into(),
        Outcome::NotConverged => "! not converged".into(),
        Outcome::Failed(_) => "✗ failed".into(),
        Outcome::Printed => "as printed".into(),
    }
}

fn strip(run: &TryOn) -> Result<Strip, ReportError> {
    let (class, fit) = fit(run);
    Ok(Strip {
        simulator: run.simulator.as_str(),
        title: format!("Subject {}, {}, {}", wearer(run), simulator_name(run.simulator), run.fabric),
        class,
        fit,
        status: status(run),
        failure: match &run.outcome {
            Outcome::Failed(why) => Some(why.clone()),
            Outcome::Converged | Outcome::NotConverged | Outcome::Printed => None,
        },
        images: run.views.iter().map(Image::new).collect::<Result<_, _>>()?,
        maps: run.maps.iter().map(MapImage::new).collect::<Result<_, _>>()?,
    })
}

/// Least number of runs whose spread is drawn. A standard deviation of two is their distance.
const SPREAD_OF: usize = 3;

fn series(title: &str, runs: &[&TryOn]) -> Result<Vec<Series>, ReportError> {
    let mut all = Vec::new();
    for (name, members) in by_series(runs) {
        let rows = measurements(&members);
        let title = format!("{title}, {name}");
        let subjects: Vec<String> = members.iter().map(|r| wearer(r)).collect();
        all.push(Series {
            chi_chart: chi_chart(&title, &members, &subjects)?,
            mean_chart: if members.len() >= SPREAD_OF { Some(mean_sd_chart(&title, &members)?) } else { None },
            rows: rows.iter().map(|m| chi_row(m, &members)).collect(),
            summary: summary(&members),
            published: members.iter().flat_map(|r| &r.measured).any(|m| m.published_chi.is_some()),
            subjects,
            title,
        });
    }
    Ok(all)
}

/// Groups the measured runs by simulator and fabric.
fn by_series<'a>(runs: &[&'a TryOn]) -> Vec<(String, Vec<&'a TryOn>)> {
    let mut all: Vec<(String, Vec<&TryOn>)> = Vec::new();
    for &run in runs.iter().filter(|r| !r.measured.is_empty()) {
        let name = format!("{}, {}", simulator_name(run.simulator), run.fabric);
        match all.iter_mut().find(|(n, _)| *n == name) {
            Some((_, members)) => members.push(run),
            None => all.push((name, vec![run])),
        }
    }
    all
}

/// `None` for a single series.
fn side_by_side(runs: &[&TryOn]) -> Option<Heat> {
    let all = by_series(runs);
    let mean = |members: &[&TryOn], no: u32| {
        let (mean, _) = mean_sd(members.iter().filter_map(|r| r.measurement(no)).map(|m| m.chi.chi()));
        mean.is_finite().then(|| HeatCell::new(mean))
    };
    let row = |m: &&Measured| {
        (format!("#{} {}", m.chi.no, m.name), all.iter().map(|(_, members)| mean(members, m.chi.no)).collect())
    };
    let rows = measurements(runs).iter().map(row).collect();
    (all.len() > 1).then(|| Heat { columns: all.iter().map(|(name, _)| name.clone()).collect(), rows })
}

fn chi_row(measured: &Measured, runs: &[&TryOn]) -> ChiRow {
    let no = measured.chi.no;
    let cell = |run: &&TryOn| match run.measurement(no) {
        Some(m) => ChiCell {
            l3d: mm(m.chi.l3d_m),
            chi: number(m.chi.chi(), 3),
            published: m.published_chi.map(|c| number(c, 3)),
            misprint: m.misprint.map(|c| number(c, 3)),
        },
        None => ChiCell { l3d: "–".into(), chi: "–".into(), published: None, misprint: None },
    };
    let (mean, sd) = mean_sd(runs.iter().filter_map(|r| r.measurement(no)).map(|m| m.chi.chi()));
    ChiRow {
        no,
        name: measured.name.clone(),
        kind: if measured.closed { "girth" } else { "length" },
        free: measured.free_edge,
        controlled: measured.controlled,
        l2d: mm(measured.chi.l2d_m),
        cells: runs.iter().map(cell).collect(),
        mean: number(mean, 3),
        sd: number(sd, 3),
    }
}

/// Rows below a table of chi: E, SD, EI, and EI without free edges or controlled measurements.
fn summary(runs: &[&TryOn]) -> Vec<(&'static str, Vec<String>)> {
    type Keep = fn(&Measured) -> bool;
    type Pick = fn(&fit::measure::Metrics) -> f64;
    let line = |keep: Keep, pick: Pick| -> Vec<String> {
        runs.iter().map(|r| r.metrics(keep).as_ref().map_or("–".into(), |m| number(pick(m), 3))).collect()
    };
    let mut rows: Vec<(&'static str, Vec<String>)> = vec![
        ("E (mean chi)", line(|_| true, |m| m.e_chi)),
        ("SD (n \u{2212} 1)", line(|_| true, |m| m.sd_chi)),
        ("EI (mean |chi \u{2212} 1|)", line(|_| true, |m| m.ei)),
    ];
    let any = |pick: fn(&Measured) -> bool| runs.iter().flat_map(|r| &r.measured).any(pick);
    if any(|m| m.free_edge) {
        rows.push(("EI without free edges", line(|m| !m.free_edge, |m| m.ei)));
    }
    if any(|m| m.controlled) {
        rows.push(("EI without controlled", line(|m| !m.controlled, |m| m.ei)));
    }
    rows
}

fn metrics_row(run: &TryOn, label: &str) -> MetricsRow {
    let (class, fit) = fit(run);
    let failed = matches!(run.outcome, Outcome::Failed(_) | Outcome::Printed);
    let with = |keep: fn(&Measured) -> bool| run.metrics(keep).map_or(f64::NAN, |m| m.ei);
    let all = run.metrics(|_| true);
    let unless_failed = |text: String| if failed { "–".into() } else { text };
    let truth = vec![
        all.as_ref().map_or("–".into(), |m| m.n.to_string()),
        number(all.as_ref().map_or(f64::NAN, |m| m.e_chi), 3),
        number(all.as_ref().map_or(f64::NAN, |m| m.sd_chi), 3),
        number(all.as_ref().map_or(f64::NAN, |m| m.ei), 3),
        number(with(|m| !m.free_edge), 3),
        number(with(|m| !m.controlled), 3),
        number(all.as_ref().map_or(f64::NAN, |m| m.max_abs_error), 3),
    ];
    let course = vec![
        unless_failed(number(run.residual * 100.0, 2)),
        unless_failed(mm(run.penetration_max_m)),
        unless_failed(mm(run.seam_gap_max_m)),
        unless_failed(run.iterations.to_string()),
        unless_failed(run.vertices.to_string()),
        unless_failed(run.faces.to_string()),
        unless_failed(duration(run.wall_s)),
    ];
    MetricsRow { label: label.into(), class, fit, truth, status: status(run), course }
}

fn heat(runs: &[&TryOn], labels: &[String]) -> Heat {
    let row = |m: &&Measured| {
        let cell = |run: &&TryOn| run.measurement(m.chi.no).map(|m| HeatCell::new(m.chi.chi()));
        (format!("#{} {}", m.chi.no, m.name), runs.iter().map(cell).collect())
    };
    Heat { columns: labels.to_vec(), rows: measurements(runs).iter().map(row).collect() }
}
