//! Hybrid-GS on the thesis's 54 pairs of subject and garment: the tables of docs/hybrid.md.
//!
//! `cargo run --release -p examples --bin hybrid [pairs | pyramid | left-out | short] [WORD ...]` prints one of them, for the pairs whose line
//! (such as `tshirt S male-i`) contains one of the words. Bodies are built from `db/subjects.csv`, patterns are drafted.
//! `... --bin hybrid times` sets the times of the phases beside those of the thesis, and `paths` the fast path search beside
//! the full one.

#![allow(clippy::print_stdout, reason = "an example speaks to whoever runs it")]

use std::collections::BTreeMap;
use std::error::Error;

use toile::body::Dimension;
use toile::body::{self, Body, Measurements, Region, Sex};
use toile::geom::{DistanceField, Surface, V3};
use toile::pattern::draft::Model;
use toile::pattern::{Garment, Role, Style};
use toile::sim::hybrid::form::Form;
use toile::sim::hybrid::mapping::{self, PATH_POINTS, can_touch};
use toile::sim::hybrid::path::{PathGraph, Taken};
use toile::sim::hybrid::{self, Backend, Params, Phases, Sewn};
use toile::sim::laboratory::sheets::noise;
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
    let slim = subjects().find(|s| s[0] == "male-ii").ok_or("no such subject")?;
    match what {
        "times" => return side_by_side(bodies.of(&slim)?),
        "paths" => return paths(&bodies.of(&slim)?.0),
        _ => {}
    }
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
            let measurements = Measurements::of(sex, number(2)? / 1e3)
                .with(Dimension::Weight, number(3)?)
                .with(Dimension::ChestGirth, length(4)?)
                .with(Dimension::WaistGirth, length(5)?)
                .with(Dimension::HipGirth, length(6)?)
                .with(Dimension::NeckGirth, length(7)?)
                .with(Dimension::AcrossShoulder, length(8)?);
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
    Ok(hybrid::phases(body, field, std::slice::from_ref(garment), &fabric::library()[0], params, watch)?)
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
        phases.mapped.as_ref().map_or(0, |mapped| mapped.flips),
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
    let Ok(surface) = Surface::new(&body.mesh) else { return String::new() };
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

/// The fast path search beside the full one: pairs of points on the front of the chest, where it looks forward more than to the
/// side.
fn paths(body: &Body) -> Result<(), Box<dyn Error>> {
    const PAIRS: usize = 500;
    let form = Form::hung(body);
    let normals = form.mesh.triangle_normals();
    let graph = PathGraph::new(&form.mesh, PATH_POINTS);
    let is_front = |&f: &usize| form.regions[f] == Region::Chest && normals[f].y > normals[f].x.abs();
    let ends: Vec<usize> =
        (0..graph.len()).filter(|&n| !graph.faces(n).is_empty() && graph.faces(n).iter().all(is_front)).collect();
    let pick = |r: &f64| ends[(((r + 1.0) / 2.0 * ends.len() as f64) as usize).min(ends.len() - 1)];
    for seed in 1..=4 {
        let pairs: Vec<Vec<usize>> = noise(2 * PAIRS, seed).chunks(2).map(|r| r.iter().map(pick).collect()).collect();
        let start = cpu_s();
        let full: Vec<_> = pairs.iter().map(|p| graph.shortest(p[0], p[1])).collect();
        let middle = cpu_s();
        let allowed = |face: usize| can_touch(Role::Front, form.regions[face], &normals[face]);
        let fast: Vec<_> =
            pairs.iter().map(|p| graph.shortest_within(p[0], p[1], allowed, &Taken::default())).collect();
        let times = [middle - start, cpu_s() - middle].map(|s| 1e3 * s / PAIRS as f64);
        let length = |path: &Option<Vec<usize>>| path.as_ref().map_or(f64::INFINITY, |path| graph.length(path));
        let same = full.iter().zip(&fast).filter(|(a, b)| a == b || (length(a) - length(b)).abs() < 1e-12).count();
        println!(
            "seed {seed}, {} points: {same} of {PAIRS} the same, full {:.2} ms, fast {:.2} ms, {:.1} times faster",
            ends.len(),
            times[0],
            times[1],
            times[0] / times[1]
        );
    }
    Ok(())
}

/// CPU time that something takes on average, ms.
fn timed<T>(mut work: impl FnMut() -> T) -> f64 {
    const TIMES: u32 = 200;
    let start = cpu_s();
    for _ in 0..TIMES {
        std::hint::black_box(work());
    }
    1e3 * (cpu_s() - start) / f64::from(TIMES)
}

/// CPU time at the end of every step, s.
#[derive(Default)]
struct Steps(Vec<(&'static str, f64)>);

impl Monitor for Steps {
    fn progress(&mut self, progress: &Progress) {
        self.0.push((progress.phase, cpu_s()));
    }
}

/// Times of the phases for the T-shirt M beside those of the thesis (tables 5-3, 5-4, 5-5 and 5-8), CPU ms.
fn side_by_side(dressed: &(Body, DistanceField)) -> Result<(), Box<dyn Error>> {
    println!("| table | what | thesis, ms | Toile, CPU ms |\n| --- | --- | --- | --- |");
    path_times(&dressed.0)?;
    let style = Style::read(&Model::Tshirt.drafts()[1].pieces, Model::Tshirt.seams(), "seams")?;
    let coarse = style.mesh(0.029)?;
    let mapped = mapping::map(&dressed.0, &coarse)?;
    let sewn = Sewn::new(&coarse, &mapped.positions);
    let pairs: usize = coarse.seams.iter().map(|seam| seam.pairs.len()).sum();
    let ms = timed(|| Sewn::new(&coarse, &mapped.positions));
    let [vertices, seams] = [sewn.x.len(), coarse.seams.len()];
    println!(
        "| 5-4 | sewing: 1,147 vertices, 12 seams, 324 pairs; here {vertices}, {seams}, {pairs} | 720 | {ms:.2} |"
    );
    for (iterations, thesis) in [(50, 16), (100, 17), (150, 18), (200, 19)] {
        let ms = timed(|| sewn.clone().smooth(iterations));
        println!("| 5-5 | smoothing, {iterations} iterations | {thesis} | {ms:.2} |");
    }
    let fine = style.mesh(0.014)?;
    let (mut steps, start) = (Steps::default(), cpu_s());
    let params = Params::default();
    let phases = hybrid::phases(
        &dressed.0,
        &dressed.1,
        std::slice::from_ref(&fine),
        &fabric::library()[0],
        &params,
        &mut steps,
    )?;
    let since = |at: f64| 1e3 * (at - start);
    let last = |phase: &str| steps.0.iter().rfind(|(p, _)| *p == phase).map_or(start, |(_, at)| *at);
    let popup: Vec<f64> = steps.0.iter().filter(|(p, _)| *p == "popup").map(|(_, at)| at - last("sew")).collect();
    for (step, thesis) in [(1, "1210"), (5, "7780"), (10, "15890"), (popup.len(), "")] {
        println!("| 5-8 | pop-up up to step {step} | {thesis} | {:.0} |", 1e3 * popup[step - 1]);
    }
    println!("| | onto the body and sewing | | {:.0} |", since(last("sew")));
    println!("| | drape | | {:.0} |", 1e3 * (last("drape") - last("popup")));
    let vertices = phases.drape.welded_vertices;
    println!("| | all, {vertices} vertices | 2 to 3 minutes | {:.0} |", since(cpu_s()));
    Ok(())
}

/// The searches of table 5-3: the full one and the fast one.
fn path_times(body: &Body) -> Result<(), Box<dyn Error>> {
    let (hung, legs) = (Form::hung(body), Form::legs(body));
    let forward = |line: &i32| hung.trunk.at(&hung.mesh, *line, 1.0).y;
    let foremost = (0..24).max_by(|a, b| forward(a).total_cmp(&forward(b))).unwrap_or(0);
    let rearmost = (0..24).min_by(|a, b| forward(a).total_cmp(&forward(b))).unwrap_or(0);
    let searches = [
        ("arm line", &hung, &hung.arms[0], 0, Role::SleeveRight, [379, 28]),
        ("front line", &hung, &hung.trunk, foremost, Role::Front, [386, 125]),
        ("leg line", &legs, &legs.legs[0], 0, Role::LegFrontRight, [389, 79]),
        ("back line", &hung, &hung.trunk, rearmost, Role::Back, [434, 160]),
    ];
    for (what, form, tube, line, role, thesis) in searches {
        let normals = form.mesh.triangle_normals();
        let graph = PathGraph::new(&form.mesh, PATH_POINTS);
        let node = |along: f64| graph.nearest(&tube.at(&form.mesh, line, along), |_| true).ok_or("no node");
        let (from, to) = (node(0.0)?, node(tube.end())?);
        let allowed = |face: usize| can_touch(role, form.regions[face], &normals[face]);
        let full = timed(|| graph.shortest(from, to));
        let fast = timed(|| graph.shortest_within(from, to, allowed, &Taken::default()));
        println!("| 5-3 | {what}: full search, fast search | {}, {} | {full:.2}, {fast:.2} |", thesis[0], thesis[1]);
    }
    Ok(())
}
