//! FEM-GS on whole garments: tables of docs/experiments/whole-garments.md.
//!
//! `cargo run --release -p examples --bin fem truth` prints what is left of the error of a loose T-shirt by mesh, fabric and rib;
//! `... fem growth [MM ...]` the cost of a T-shirt by the edge length of its mesh;
//! `... fem others PATTERNS BODIES [WORD ...]` other makers' patterns on scanned bodies, one line a pair whose name contains one of the words.

#![allow(clippy::print_stdout, reason = "an example speaks to whoever runs it")]

use std::error::Error;
use std::path::{Path, PathBuf};

use toile::body::Dimension;
use toile::body::{self, Body, Measurements, Sex};
use toile::geom::DistanceField;
use toile::measure;
use toile::pattern::draft::Model;
use toile::pattern::{Garment, Style, dxf, garmentcode, propose};
use toile::sim::fem::{self, Params};
use toile::sim::{Distortion, Drape, Fabric, Silent, fabric};
use toile::units::GRAVITY;

type Outcome<T = ()> = Result<T, Box<dyn Error>>;

/// Spacing of the distance field, m: that of studies.
const SPACING_M: f64 = 0.005;
/// Edge length of the meshes, m: likewise.
const EDGE_M: f64 = 0.015;
/// A rib as long as the neck's edge, added to the T-shirt's seam file.
const RIB: &str = "
[[reinforce]]
edges = [\"front.neck_left\", \"front.neck_right\", \"back.neck\"]
kind = \"rib\"
stiffness_n = 20.0
";

fn main() -> Outcome {
    let asked: Vec<String> = std::env::args().skip(1).collect();
    let asked: Vec<&str> = asked.iter().map(String::as_str).collect();
    match asked.as_slice() {
        ["truth"] => truth(),
        ["growth", edges @ ..] => growth(edges),
        ["others", patterns, bodies, words @ ..] => others(Path::new(patterns), Path::new(bodies), words),
        _ => Err("say truth, growth [MM ...] or others PATTERNS BODIES [WORD ...]".into()),
    }
}

/// A body with its distance field.
struct Dressed(Body, DistanceField);

impl Dressed {
    fn new(body: Body) -> Outcome<Self> {
        let field = DistanceField::build(&body.mesh, SPACING_M)?;
        Ok(Self(body, field))
    }

    fn slim() -> Outcome<Self> {
        let measurements = Measurements::of(Sex::Male, 1.690)
            .with(Dimension::Weight, 53.0)
            .with(Dimension::ChestGirth, 0.863)
            .with(Dimension::WaistGirth, 0.782)
            .with(Dimension::HipGirth, 0.914)
            .with(Dimension::NeckGirth, 0.378)
            .with(Dimension::AcrossShoulder, 0.429);
        Self::new(body::build(&measurements)?)
    }

    /// The drape of a style on meshes down to an edge length, and the finest of them.
    fn drape(&self, style: &Style, edge_m: f64, fabric: &Fabric) -> Outcome<(Garment, Drape)> {
        let meshes = fem::level_edges(edge_m).into_iter().map(|edge| style.mesh(edge));
        let mut meshes = meshes.collect::<Result<Vec<Garment>, _>>()?;
        let drape = fem::simulate(&self.0, &self.1, &meshes, fabric, &Params::default(), &mut Silent)?;
        Ok((meshes.pop().ok_or("no mesh")?, drape))
    }
}

fn of_library(name: &str) -> Outcome<Fabric> {
    Ok(fabric::library().into_iter().find(|fabric| fabric.name == name).ok_or("not in the library")?)
}

/// The drafted T-shirt in size L, with more in its seam file.
fn tshirt(more: &str) -> Outcome<Style> {
    let drafts = Model::Tshirt.drafts();
    let large = drafts.iter().find(|draft| draft.size.eq_ignore_ascii_case("l")).ok_or("no size L")?;
    let seams = [Model::Tshirt.seams(), more.as_bytes()].concat();
    Ok(Style::read(&large.pieces, &seams, "tshirt.seams.toml")?)
}

fn truth() -> Outcome {
    let body = Dressed::slim()?;
    let cotton = of_library("cotton_shirting_light")?;
    let stiff = Fabric {
        membrane_warp_n_m: 10.0 * cotton.membrane_warp_n_m,
        membrane_weft_n_m: 10.0 * cotton.membrane_weft_n_m,
        membrane_coupling_n_m: 10.0 * cotton.membrane_coupling_n_m,
        shear_n_m: 10.0 * cotton.shear_n_m,
        name: "ten times stiffer".to_owned(),
        ..cotton.clone()
    };
    println!("| fabric | edges mm | rib | neck chi | hem chi | back length chi | a strip that long | EI | residual |");
    println!("| --- | --- | --- | --- | --- | --- | --- | --- | --- |");
    let row = |fabric: &Fabric, edge_m: f64, more: &str| -> Outcome {
        let (garment, drape) = body.drape(&tshirt(more)?, edge_m, fabric)?;
        let chis = measure::measure(&garment, &drape.positions);
        let named = |word: &str| {
            let found = garment.measurements.iter().zip(&chis).find(|(m, _)| m.name.contains(word));
            found.map(|(_, chi)| chi.clone()).ok_or("no such measurement")
        };
        let (neck, hem, back) = (named("Neck")?, named("Hem")?, named("Back")?);
        let ei = measure::metrics(&chis).ok_or("no measurements")?.ei;
        println!(
            "| {} | {:.0} | {} | {:.4} | {:.4} | {:.4} | {:.4} | {ei:.4} | {:.3} |",
            fabric.name,
            1e3 * edge_m,
            if more.is_empty() { "" } else { "yes" },
            neck.chi(),
            hem.chi(),
            back.chi(),
            hanging(fabric, back.l2d_m),
            drape.residual
        );
        Ok(())
    };
    for edge_m in [0.020, 0.015, 0.010] {
        row(&cotton, edge_m, "")?;
    }
    row(&stiff, EDGE_M, "")?;
    row(&cotton, EDGE_M, RIB)?;
    for knit in ["interlock_tshirt", "rib_knit"] {
        let knit = of_library(knit)?;
        row(&knit, EDGE_M, "")?;
        row(&knit, EDGE_M, RIB)?;
    }
    Ok(())
}

/// Mean stretch of a strip that hangs freely along the warp, by the fabric's law: where `s` metres hang below, the pull is
/// `w g s = S(E) l` with the stretch `l` and `E = (l^2 - 1) / 2`.
fn hanging(fabric: &Fabric, length_m: f64) -> f64 {
    const STEPS: u32 = 200;
    let law = fabric.warp_law();
    let stretch = |pull: f64| {
        let (mut low, mut high) = (1.0, 3.0);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if law.stress(0.5 * (middle * middle - 1.0)) * middle < pull { low = middle } else { high = middle }
        }
        high
    };
    let below = (0..STEPS).map(|k| (f64::from(k) + 0.5) / f64::from(STEPS) * length_m);
    below.map(|s| stretch(fabric.density_kg_m2 * GRAVITY * s)).sum::<f64>() / f64::from(STEPS)
}

fn growth(edges: &[&str]) -> Outcome {
    let edges = if edges.is_empty() { &["14", "10", "7", "5"] } else { edges };
    let (body, cotton) = (Dressed::slim()?, of_library("cotton_shirting_light")?);
    let style = tshirt("")?;
    println!("| edges mm | vertices | steps | on the finest mesh | CPU s | growth | peak memory MB | residual |");
    println!("| --- | --- | --- | --- | --- | --- | --- | --- |");
    let mut last: Option<(f64, f64)> = None;
    for edge in edges {
        let start = cpu_s();
        let (_, drape) = body.drape(&style, 1e-3 * edge.parse::<f64>()?, &cotton)?;
        let (vertices, spent) = (drape.welded_vertices as f64, cpu_s() - start);
        let exponent = last.map_or(String::new(), |(v, s)| format!("{:.2}", (spent / s).ln() / (vertices / v).ln()));
        let finest = drape.history.iter().map(|step| step.level).max();
        let on_finest = drape.history.iter().filter(|step| Some(step.level) == finest).count();
        let (steps, residual, memory) = (drape.iterations, drape.residual, peak_memory_mb());
        println!(
            "| {edge} | {vertices} | {steps} | {on_finest} | {spent:.1} | {exponent} | {memory:.0} | {residual:.3} |"
        );
        last = Some((vertices, spent));
    }
    Ok(())
}

/// CPU time of this thread, s; 0 where the system does not tell.
fn cpu_s() -> f64 {
    let told = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap_or_default();
    told.split_whitespace().next().and_then(|ns| ns.parse::<f64>().ok()).unwrap_or(0.0) / 1e9
}

/// Most memory this process has had, MB; 0 where the system does not tell.
fn peak_memory_mb() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    let kilobytes = line.and_then(|rest| rest.split_whitespace().next()).and_then(|n| n.parse::<f64>().ok());
    kilobytes.unwrap_or(0.0) / 1024.0
}

/// Sizes of a nest that are taken.
const SIZES: [&str; 3] = ["28", "36", "44"];

fn others(patterns: &Path, bodies: &Path, words: &[&str]) -> Outcome {
    let cotton = of_library("cotton_shirting_light")?;
    let scans = files(bodies, &["obj", "ply"])?;
    if scans.is_empty() {
        return Err(format!("{}: found no body; accepted: a folder with .obj or .ply files", bodies.display()).into());
    }
    for path in scans {
        let scan = body::from_scan(&std::fs::read(&path)?, None, None)?;
        let body = Dressed::new(scan.into_body()?)?;
        for (name, style) in styles(patterns)? {
            let name = format!("{name} on {}", stem(&path));
            if words.is_empty() || words.iter().any(|word| name.contains(word)) {
                let told = style.and_then(|style| other(&body, &style, &cotton));
                println!("{name}: {}", told.unwrap_or_else(|error| format!("refused: {error}")));
            }
        }
    }
    Ok(())
}

/// What came of one pair.
fn other(body: &Dressed, style: &Style, cotton: &Fabric) -> Outcome<String> {
    let start = cpu_s();
    let (garment, drape) = body.drape(style, EDGE_M, cotton)?;
    let spent = cpu_s() - start;
    let ei = measure::metrics(&measure::measure(&garment, &drape.positions)).ok_or("no measurements")?.ei;
    let stretch = Distortion::of(&garment, &drape.positions)?.stretch;
    let [inside_mm, gap_mm] = [drape.penetration_max_m, drape.seam_gap_max_m].map(|m| 1e3 * m);
    let rests = if drape.converged { "at rest" } else { "NOT at rest" };
    Ok(format!(
        "EI {ei:.4}, {inside_mm:.2} mm inside, {} intersections, seams {gap_mm:.2} mm open, stretch {stretch:.3}, {} vertices, {} steps, {spent:.1} s, residual {:.4}, {rests}",
        drape.self_crossings, drape.welded_vertices, drape.iterations, drape.residual
    ))
}

/// Styles of a folder's DXF files, sewn as proposed, and of its GarmentCode specifications.
fn styles(folder: &Path) -> Outcome<Vec<(String, Outcome<Style>)>> {
    let mut found = Vec::new();
    for path in files(&folder.join("freesewing"), &["dxf"])? {
        let name = stem(&path);
        let file = dxf::read(&std::fs::read(&path)?, &name, None);
        let sizes = file.as_ref().map_or(0, |file| file.sizes().len());
        let wanted: Vec<Option<&str>> = if sizes > 1 { SIZES.map(Some).to_vec() } else { vec![None] };
        for size in wanted {
            let read = |file: &dxf::PatternFile| proposed(file, size, &name);
            let style = file.as_ref().map_err(|error| error.to_string().into()).and_then(read);
            found.push((size.map_or(name.clone(), |size| format!("{name}, {size}")), style));
        }
    }
    let mut specifications = files(&folder.join("garmentcode"), &["json"])?;
    specifications.extend(files(&folder.join("garmentcode/upstream"), &["json"])?);
    for path in specifications.into_iter().filter(|p| stem(p).ends_with("_specification")) {
        let name = stem(&path);
        let style = garmentcode::read(&std::fs::read(&path)?, &name).map(|file| measured(file.style()));
        found.push((name.trim_end_matches("_specification").to_owned(), style.map_err(Into::into)));
    }
    Ok(found)
}

fn proposed(file: &dxf::PatternFile, size: Option<&str>, name: &str) -> Outcome<Style> {
    let pieces = file.to_sew(size)?;
    let seams = propose::propose(&pieces).to_drape()?.toml(name);
    Ok(measured(Style::read(&pieces, seams.as_bytes(), "the proposal")?))
}

fn measured(mut style: Style) -> Style {
    if style.measurements.is_empty() {
        style.measure_openings_and_seams();
    }
    style
}

/// Files of a folder by extension, in the order of their names.
fn files(folder: &Path, extensions: &[&str]) -> Outcome<Vec<PathBuf>> {
    let entries = std::fs::read_dir(folder)?.collect::<Result<Vec<_>, _>>()?;
    let is_wanted = |path: &PathBuf| path.extension().is_some_and(|e| extensions.iter().any(|wanted| e == *wanted));
    let mut found: Vec<PathBuf> = entries.into_iter().map(|entry| entry.path()).filter(is_wanted).collect();
    found.sort();
    Ok(found)
}

fn stem(path: &Path) -> String {
    path.file_stem().unwrap_or_default().to_string_lossy().into_owned()
}
