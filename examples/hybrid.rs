//! Hybrid-GS on the thesis's 54 pairs of subject and garment: the tables of docs/hybrid.md.
//!
//! `cargo run --release --example hybrid [pairs | pyramid | left-out | short] [WORD ...]` prints one of them, for the pairs whose line
//! (such as `tshirt S male-i`) contains one of the words. Bodies are built from `db/subjects.csv`, patterns are drafted.

#![allow(clippy::print_stdout, reason = "an example speaks to whoever runs it")]

use std::collections::BTreeMap;
use std::error::Error;

use toile::body::{self, Body, Measurements, Sex};
use toile::geom::{DistanceField, V3};
use toile::pattern::draft::Model;
use toile::pattern::{Garment, Style};
use toile::sim::hybrid::{self, Backend, Params, Phases, Sewn};
use toile::sim::{Monitor, Progress, fabric, quality};

/// Spacing of the distance field, m: that of studies.
const SPACING_M: f64 = 0.005;
/// Edge length of the meshes, m: likewise.
const EDGE_M: f64 = 0.015;

fn main() -> Result<(), Box<dyn Error>> {
    let asked: Vec<String> = std::env::args().skip(1).collect();
    let (what, words) = asked.split_first().map_or(("pairs", &[][..]), |(what, words)| (what.as_str(), words));
    let is_asked = |name: &str| words.is_empty() || words.iter().any(|word| name.contains(word.as_str()));
    let mut bodies = Bodies::default();
    for model in Model::ALL {
        for draft in model.drafts() {
            let garment = Style::read(&draft.pieces, model.seams(), "seams")?.mesh(EDGE_M)?;
            for subject in subjects().filter(|s| s[1] == sex(model)) {
                let name = format!("{} {} {}", model.as_str(), draft.size, subject[0]);
                if is_asked(&name) {
                    let dressed = bodies.of(&subject)?;
                    match what {
                        "left-out" => left_out(&name, dressed, &garment)?,
                        "short" => short(&name, dressed, &garment)?,
                        "pyramid" => pair(&name, dressed, &garment, Backend::Pyramid)?,
                        _ => pair(&name, dressed, &garment, Backend::Rigid)?,
                    }
                }
            }
        }
    }
    Ok(())
}

fn sex(model: Model) -> &'static str {
    if matches!(model, Model::Tshirt | Model::Trousers) { "male" } else { "female" }
}

/// Rows of the catalogue of subjects: name, sex, numbers.
fn subjects() -> impl Iterator<Item = Vec<&'static str>> {
    include_str!("../db/subjects.csv").lines().skip(1).map(|line| line.split(',').collect())
}

/// Bodies with their distance fields, built when they are first asked for.
#[derive(Default)]
struct Bodies(BTreeMap<String, (Body, DistanceField)>);

impl Bodies {
    fn of(&mut self, row: &[&str]) -> Result<&(Body, DistanceField), Box<dyn Error>> {
        if !self.0.contains_key(row[0]) {
            let number = |k: usize| row[k].parse::<f64>();
            let length = |k: usize| number(k).map(|mm| Some(mm / 1e3));
            let sex = if row[1] == "male" { Sex::Male } else { Sex::Female };
            let measurements = Measurements {
                weight_kg: Some(number(3)?),
                chest_girth_m: length(4)?,
                waist_girth_m: length(5)?,
                hip_girth_m: length(6)?,
                neck_girth_m: length(7)?,
                across_shoulder_m: length(8)?,
                ..Measurements::of(sex, number(2)? / 1e3)
            };
            let body = body::build(&measurements)?;
            let field = DistanceField::build(&body.mesh, SPACING_M)?;
            self.0.insert(row[0].to_owned(), (body, field));
        }
        Ok(&self.0[row[0]])
    }
}

/// CPU time when each phase was first heard of, s.
#[derive(Default)]
struct Watch(Vec<(&'static str, f64)>);

impl Monitor for Watch {
    fn progress(&mut self, progress: &Progress) {
        if self.0.last().is_none_or(|(phase, _)| *phase != progress.phase) {
            self.0.push((progress.phase, cpu_s()));
        }
    }
}

/// CPU time of this thread, s; 0 where the system does not tell.
fn cpu_s() -> f64 {
    let told = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap_or_default();
    told.split_whitespace().next().and_then(|ns| ns.parse::<f64>().ok()).unwrap_or(0.0) / 1e9
}

fn dress(
    (body, field): &(Body, DistanceField),
    garment: &Garment,
    params: &Params,
    watch: &mut Watch,
) -> Result<Phases, Box<dyn Error>> {
    Ok(hybrid::phases(body, field, garment, &fabric::library()[0], params, watch)?)
}

/// One line: EI, mean error of all edges and crossings after pop-up and drape; how far E ever goes back; flips; the deepest
/// point inside the body; CPU time.
fn pair(name: &str, dressed: &(Body, DistanceField), garment: &Garment, popup: Backend) -> Result<(), Box<dyn Error>> {
    let (start, mut watch) = (cpu_s(), Watch::default());
    let phases = dress(dressed, garment, &Params { popup, ..Params::default() }, &mut watch)?;
    let end = cpu_s();
    let drape = &phases.drape;
    let popup = &drape.earlier[1].positions;
    let sewn = Sewn::new(garment, popup);
    let crossing = |x: &[V3]| {
        let mut at = vec![V3::zeros(); sewn.x.len()];
        sewn.vertex_of.iter().zip(x).for_each(|(&v, p)| at[v] = *p);
        quality::self_crossings(&at, &sewn.triangles)
    };
    let errors: Vec<f64> = drape.history.iter().filter(|s| s.level < 2).map(|s| s.e_chi - 1.0).collect();
    let back = errors.windows(2).map(|e| if e[0] * e[1] < 0.0 { e[1].abs() } else { e[1].abs() - e[0].abs() });
    let off = chis(garment, &drape.positions).map(|c| (c - 1.0).abs()).zip(&garment.measurements);
    let (worst, of) = off.max_by(|a, b| a.0.total_cmp(&b.0)).map_or((0.0, ""), |(off, m)| (off, m.name.as_str()));
    println!(
        "{name:22} popup {:.4} {:.4} {:2}  drape {:.4} {:.4} {:2} max {worst:.4} {of:12.12}  flips {} back {:.5}  inside {:4.1} mm {}  {}",
        ei(garment, popup),
        edges_off(garment, popup),
        crossing(popup),
        ei(garment, &drape.positions),
        edges_off(garment, &drape.positions),
        drape.self_crossings,
        phases.mapped.flips,
        back.fold(0.0, f64::max),
        drape.penetration_max_m * 1e3,
        deepest(&dressed.0, garment, &drape.positions),
        times(start, &watch, end),
    );
    Ok(())
}

fn chis(garment: &Garment, x: &[V3]) -> impl Iterator<Item = f64> {
    garment.measurements.iter().map(|m| m.length_m(&garment.rest, x) / m.l2d_m)
}

fn ei(garment: &Garment, x: &[V3]) -> f64 {
    chis(garment, x).map(|chi| (chi - 1.0).abs()).sum::<f64>() / garment.measurements.len() as f64
}

/// Mean |chi - 1| over all mesh edges (5.10).
fn edges_off(garment: &Garment, x: &[V3]) -> f64 {
    let edges = || garment.triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
    let off = |[a, b]: [usize; 2]| ((x[a] - x[b]).norm() / (garment.rest[a] - garment.rest[b]).norm() - 1.0).abs();
    edges().map(off).sum::<f64>() / edges().count() as f64
}

/// Where the deepest vertex of each piece lies that is inside, mm.
fn deepest(body: &Body, garment: &Garment, x: &[V3]) -> String {
    let Ok(surface) = toile::geom::Surface::new(&body.mesh) else { return String::new() };
    let depth = |v: usize| -1e3 * surface.signed_distance(&x[v]);
    let deepest = garment.pieces.iter().map(|piece| {
        let v = piece.vertices.clone().max_by(|&a, &b| depth(a).total_cmp(&depth(b))).unwrap_or(0);
        let p = x[v] * 1e3;
        (piece.id.as_str(), depth(v), p)
    });
    let named: Vec<String> = deepest
        .filter(|(_, depth, _)| *depth > 1.0)
        .map(|(id, depth, p)| format!("{id} {depth:.0} at ({:.0} {:.0} {:.0})", p.x, p.y, p.z))
        .collect();
    named.join(", ")
}

/// Times of the phases, ms.
fn times(start: f64, watch: &Watch, end: f64) -> String {
    let ends: Vec<(&str, f64)> = watch.0.iter().copied().chain([("end", end)]).collect();
    let mut text = format!("ms: map {:.0}", 1e3 * (ends[0].1 - start));
    for pair in ends.windows(2) {
        text += &format!(" {} {:.0}", pair[0].0, 1e3 * (pair[1].1 - pair[0].1));
    }
    format!("{text} all {:.0}", 1e3 * (end - start))
}

/// Chi of each measurement when it alone is not controlled.
fn left_out(name: &str, dressed: &(Body, DistanceField), garment: &Garment) -> Result<(), Box<dyn Error>> {
    for (k, m) in garment.measurements.iter().enumerate() {
        let params = Params { uncontrolled: vec![m.no], ..Params::default() };
        let phases = dress(dressed, garment, &params, &mut Watch::default())?;
        let chi = chis(garment, &phases.drape.positions).nth(k).unwrap_or(f64::NAN);
        println!("{name:22} {:28} {chi:.4}", m.name);
    }
    Ok(())
}

/// What the garment lacks at each level, beside what its pattern lacks there, mm.
fn short(name: &str, dressed: &(Body, DistanceField), garment: &Garment) -> Result<(), Box<dyn Error>> {
    let phases = dress(dressed, garment, &Params::default(), &mut Watch::default())?;
    for closure in hybrid::closures(&dressed.0, garment, &phases.drape.positions) {
        let lacks = garment.fit_levels.iter().find(|l| l.level == closure.level);
        let pattern = lacks.map_or(String::new(), |l| format!("{:.1}", 1e3 * (closure.body_girth_m - l.girth_m)));
        println!("{name:22} {:9} lacks {:6.1} mm, pattern {pattern}", closure.level, 1e3 * closure.shortfall_m());
    }
    Ok(())
}
