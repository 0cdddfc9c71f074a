//! Numbers of fixed inputs through each stage, with the versions that they were made by.
//!
//! Stored results are served for as long as the version of their stage is the same. So an output that changes while its
//! version does not is an error, and `tests/golden.tsv` is what it is seen by.

use std::collections::BTreeMap;

use serde_json::{Value, to_value};
use toile::body::{self, Dimension, Measurements, Sex, write_obj};
use toile::geom::{DistanceField, V3};
use toile::pattern::{Garment, Style, source};
use toile::sim::{self, Silent, fabric, fem, hybrid};
use toile::spec::bodies;
use toile::spec::patterns::Model;
use toile::store::files::SourceFile;

use super::readers::Readers;
use super::tree::{root, text};

/// Where the numbers stand: stage, versions, name, value.
const FILE: &str = "tests/golden.tsv";

/// Edge length of the finest meshes, m.
const EDGE_M: f64 = 0.04;

/// A number that a stage gives.
struct Number {
    stage: &'static str,
    name: String,
    value: f64,
}

/// Difference that counts, over the value: what another machine rounds otherwise does not, though a drape makes more of it.
fn tolerance(stage: &str) -> f64 {
    if matches!(stage, "fem" | "hybrid") { 1e-4 } else { 1e-8 }
}

/// Adds the numbers of a tree, each with a weight of its place, so that an exchange is seen.
fn sum(tree: &Value, place: &mut usize, total: &mut f64) {
    match tree {
        Value::Number(number) => {
            *place += 1;
            *total += number.as_f64().unwrap_or_default() * (1 + *place % 97) as f64;
        }
        Value::Array(list) => list.iter().for_each(|tree| sum(tree, place, total)),
        Value::Object(fields) => fields.values().for_each(|tree| sum(tree, place, total)),
        _ => {}
    }
}

/// All numbers, stage by stage.
#[derive(Default)]
struct Numbers(Vec<Number>);

impl Numbers {
    fn add(&mut self, stage: &'static str, name: impl Into<String>, value: f64) {
        self.0.push(Number { stage, name: name.into(), value });
    }

    /// Adds count and weighted sum of all numbers of something.
    fn add_digest(&mut self, stage: &'static str, name: &str, of: serde_json::Result<Value>) {
        let (mut place, mut total) = (0, 0.0);
        sum(&of.expect("plain"), &mut place, &mut total);
        self.add(stage, format!("{name}: numbers"), place as f64);
        self.add(stage, format!("{name}: sum"), total);
    }

    /// A body as it is built, posed and read as a scan, and distances from it.
    fn add_body(&mut self, name: &str, measurements: &Measurements) -> body::Body {
        let built = body::build(measurements).expect("somebody");
        self.add_digest("body", name, to_value(&built));
        for dimension in [Dimension::ChestGirth, Dimension::WaistGirth, Dimension::HipGirth, Dimension::Inseam] {
            self.add("body", format!("{name}: {dimension:?} m"), built.girths.get(dimension).expect("measured"));
        }
        let posed = bodies::pose_body(&built, "arms_30".parse().expect("a pose")).expect("it can stand so");
        self.add_digest("body", &format!("{name} with its arms at 30 degrees"), to_value(&posed));
        let file = SourceFile { name: "scan.obj".to_owned(), bytes: write_obj(&built.mesh).into_bytes().into() };
        let scan = bodies::read_scan(&file, None, None).expect("whole");
        self.add_digest("scan", name, to_value(&scan.girths));
        let field = DistanceField::build(&built.mesh, 0.02).expect("closed");
        let at = |k: u32| V3::new(0.03 * f64::from(k % 7) - 0.1, 0.02 * f64::from(k % 11) - 0.1, 0.015 * f64::from(k));
        for k in [20, 50, 80, 100] {
            self.add("field", format!("{name}: distance {k} m"), field.value_and_gradient(&at(k)).0);
        }
        built
    }

    /// Meshes of a drafted size that was written as DXF and read again, coarse to fine.
    fn add_meshes(&mut self, name: &str, model: Model, size: usize) -> Vec<Garment> {
        let read = source::read(&model.drafts()[size].dxf(), "draft.dxf", None).expect("just written");
        let style =
            Style::read(&read.to_sew(None).expect("whole"), model.seams(), "draft.seams.toml").expect("it fits");
        let mesh = |edge_m: f64| style.mesh(edge_m).expect("it can be meshed");
        let meshes: Vec<Garment> = fem::level_edges(EDGE_M).into_iter().map(mesh).collect();
        self.add_digest("mesh", name, to_value(meshes.last()));
        for measurement in &style.measurements {
            self.add("mesh", format!("{name}: {} m", measurement.name), measurement.l2d_m);
        }
        meshes
    }

    fn add_drapes(&mut self, name: &str, body: &body::Body, meshes: &[Garment]) {
        let field = DistanceField::build(&body.mesh, 0.01).expect("closed");
        let cloth = fabric::library().into_iter().find(|cloth| cloth.name == "cotton_shirting_light").expect("there");
        let on = (body, &field, meshes, &cloth);
        let drapes: [(_, sim::Drape); 2] = [
            ("fem", fem::simulate(on.0, on.1, on.2, on.3, &fem::Params::default(), &mut Silent).expect("worn")),
            (
                "hybrid",
                hybrid::simulate(on.0, on.1, on.2, on.3, &hybrid::Params::default(), &mut Silent).expect("worn"),
            ),
        ];
        let finest = meshes.last().expect("one at least");
        for (stage, drape) in drapes {
            for measurement in &finest.measurements {
                let length_m = measurement.length_m(&finest.rest, &drape.positions);
                self.add(stage, format!("{name}: {} m", measurement.name), length_m);
            }
            let middle: V3 = drape.positions.iter().sum::<V3>() / drape.positions.len() as f64;
            self.add(stage, format!("{name}: mean height m"), middle.z);
            self.add(stage, format!("{name}: depth from the middle m"), middle.y.abs() + 1.0);
        }
    }

    fn all() -> Self {
        let mut numbers = Self::default();
        let man = Measurements::of(Sex::Male, 1.76).with(Dimension::ChestGirth, 0.96).with(Dimension::HipGirth, 1.0);
        let woman = Measurements::of(Sex::Female, 1.65).with(Dimension::WaistGirth, 0.72);
        let [man, woman] = [("man", man), ("woman", woman)].map(|(name, of)| numbers.add_body(name, &of));
        for (name, model, size, body) in [
            ("T-shirt S", Model::Tshirt, 0, &man),
            ("trousers M", Model::Trousers, 1, &man),
            ("dress", Model::Dress, 0, &woman),
        ] {
            let meshes = numbers.add_meshes(name, model, size);
            numbers.add_drapes(name, body, &meshes);
        }
        numbers
    }
}

/// Versions that results of each stage are keyed by, beside their inputs.
pub fn versions() -> BTreeMap<&'static str, String> {
    const STUDY: &str = r#"
simulators = ["fem", "hybrid"]
[[subject]]
id = "y"
scan = "y.obj"
sex = "male"
[[garment]]
name = "a"
seams = "patterns/tshirt.seams.toml"
fabric = "poplin"
sizes = [{ name = "S", pattern = "patterns/tshirt-s.dxf" }]
"#;
    let mut readers = Readers::new();
    readers.write_scan("y.obj", 1.7);
    let jobs = readers.plan(STUDY);
    let input = |job: usize, name: &str| {
        let found = jobs[job].inputs.iter().find(|(input, _)| *input == name);
        let value = found.unwrap_or_else(|| panic!("no input {name}")).1;
        value.chars().take(8).collect::<String>()
    };
    let simulator = |job: usize| format!("{} {}", input(job, "sim.version"), input(job, "sim.parameters"));
    [
        ("body", input(0, "body.version")),
        ("scan", input(0, "subject.y.scan_version")),
        ("field", input(0, "field.version")),
        ("mesh", input(0, "mesh.version")),
        ("fem", simulator(0)),
        ("hybrid", simulator(1)),
    ]
    .into()
}

#[test]
fn what_a_stage_gives_changes_with_its_version_alone() {
    let (numbers, versions) = (Numbers::all().0, versions());
    let file = text(&root().join(FILE));
    let mut known: BTreeMap<(&str, &str), (&str, f64)> = BTreeMap::new();
    for line in file.lines().skip(1) {
        let cells: Vec<&str> = line.split('\t').collect();
        known.insert((cells[0], cells[2]), (cells[1], cells[3].parse().expect("a number")));
    }
    let mut told = Vec::new();
    for Number { stage, name, value } in &numbers {
        let Some((version, before)) = known.get(&(*stage, name.as_str())) else { continue };
        let is_other = (value - before).abs() > tolerance(stage) * before.abs();
        if is_other && *version == versions[stage] {
            told.push(format!("{stage} {version}: {name} was {before} and is {value}"));
        }
    }
    assert!(
        told.is_empty(),
        "results of these versions are stored, and would be served: raise them in spec::versions\n{}",
        told.join("\n")
    );
    let mut lines = vec!["stage\tversion\tnumber\tvalue".to_owned()];
    lines.extend(numbers.iter().map(|Number { stage, name, value }| {
        let kept = known.get(&(*stage, name.as_str())).filter(|(version, _)| *version == versions[stage]);
        format!("{stage}\t{}\t{name}\t{}", versions[stage], kept.map_or(*value, |(_, before)| *before))
    }));
    let now = lines.join("\n") + "\n";
    if std::env::var_os("TOILE_BLESS").is_some() {
        std::fs::write(root().join(FILE), &now).expect("writable");
    } else {
        assert!(
            now == file,
            "versions or inputs have changed: TOILE_BLESS=1 cargo test --test it golden writes {FILE}"
        );
    }
}
