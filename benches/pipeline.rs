//! Times of the stages a simulation goes through, on the drafted T-shirt and the first subject of the quickstart.
//!
//! `cargo bench` measures; `cargo bench -- --test` runs each once, to see that it still works.

use std::sync::LazyLock;

use divan::Bencher;
use toile::advice::{Question, chance};
use toile::body::{self, Body, Dimension, Measurements, Sex};
use toile::engine::{RunOptions, run};
use toile::fit::Draw;
use toile::fit::coverage::{Asked, Asks, Bound, Search};
use toile::geom::{DistanceField, TriMesh, shapes};
use toile::measure;
use toile::pattern::{Garment, Handle, Style, draft, dxf};
use toile::render::{self, Camera, Frame, Layer, Material, Scene, View};
use toile::sim::contact::Skin;
use toile::sim::fem::response::{Lying, Response, sewn};
use toile::sim::fem::{self, Params};
use toile::sim::{Drape, Fabric, Silent, fabric, laboratory};
use toile::store::sql;
use toile::wardrobe::catalogue;
use toile::wardrobe::seams::pattern_files::{Beside, inspect};

fn main() {
    divan::main();
}

/// Edge length of the mesh that results are on, m.
const FINE_M: f64 = 0.015;
/// Edge length of a mesh that drapes in a moment, m.
const COARSE_M: f64 = 0.040;
/// Edges of the dress's mesh, m.
const DRESS_M: f64 = 0.0065;
/// Spacing of the distance field, m.
const SPACING_M: f64 = 0.005;

fn subject() -> Measurements {
    Measurements::of(Sex::Male, 1.690)
        .with(Dimension::Weight, 53.0)
        .with(Dimension::ChestGirth, 0.863)
        .with(Dimension::WaistGirth, 0.782)
        .with(Dimension::HipGirth, 0.914)
        .with(Dimension::NeckGirth, 0.378)
        .with(Dimension::AcrossShoulder, 0.429)
}

static BODY: LazyLock<Body> = LazyLock::new(|| body::build(&subject()).expect("a person that can be"));
static FIELD: LazyLock<DistanceField> =
    LazyLock::new(|| DistanceField::build(&BODY.mesh, SPACING_M).expect("a closed mesh"));
/// Bytes of the drafted T-shirt in size M, and of its seam file.
static FILES: LazyLock<[Vec<u8>; 2]> =
    LazyLock::new(|| drafted(draft::Model::Tshirt, ["tshirt-m.dxf", "tshirt.seams.toml"]));
static STYLE: LazyLock<Style> = LazyLock::new(|| style(&FILES));

fn drafted(model: draft::Model, wanted: [&str; 2]) -> [Vec<u8>; 2] {
    let files = model.files();
    wanted.map(|wanted| {
        let file = files.iter().find(|(name, _)| name == wanted);
        file.unwrap_or_else(|| panic!("no {wanted} is drafted")).1.clone()
    })
}

fn style([pattern, seams]: &[Vec<u8>; 2]) -> Style {
    let file = dxf::read(pattern, "drafted.dxf", None).expect("our own file");
    Style::read(&file.to_sew(None).expect("one size"), seams, "drafted.seams.toml").expect("our own seams")
}

static CLOTH: LazyLock<Fabric> = LazyLock::new(|| {
    fabric::library().into_iter().find(|fabric| fabric.name == "cotton_shirting_light").expect("in the library")
});

/// Meshes of the levels of a simulation, coarse to fine.
fn meshes(edge_m: f64) -> Vec<Garment> {
    fem::level_edges(edge_m).into_iter().map(|edge| STYLE.mesh(edge).expect("it meshes")).collect()
}

/// The mesh that results are on.
fn finest(garments: &[Garment]) -> &Garment {
    garments.last().expect("a level")
}

/// Listens to nothing.
fn drape(garments: &[Garment]) -> Drape {
    drape_from(Params::default(), garments)
}

fn drape_from(params: Params, garments: &[Garment]) -> Drape {
    fem::simulate(&BODY, &FIELD, garments, &CLOTH, &params, &mut Silent).expect("it drapes")
}

#[divan::bench]
fn body_build() -> Body {
    body::build(divan::black_box(&subject())).expect("a person that can be")
}

/// How probable it is that three sizes fit a subject: 36 bodies and 500 draws.
#[divan::bench(sample_count = 5)]
fn chance_of_fit(bencher: Bencher) {
    let folder = tempfile::tempdir().expect("a folder");
    let store = catalogue::open(&folder.path().join("toile.sqlite"), false).expect("a new database");
    let quickstart = concat!(env!("CARGO_MANIFEST_DIR"), "/studies/quickstart");
    let study = run::load_study(&store, quickstart.as_ref()).expect("a good study");
    let question = Question {
        garment: None,
        subject: Some("ii".to_owned()),
        size: None,
        draws: 500,
        seed: 1,
        error_factor: 1.0,
        tolerance_mm: 6.0,
        fem: 0,
    };
    bencher.bench_local(|| chance(&study, &question).expect("it can be told"));
}

#[divan::bench]
fn body_measure() -> body::Girths {
    body::measure(divan::black_box(&BODY.mesh), Some(Sex::Male)).expect("a standing person")
}

#[divan::bench(sample_count = 10)]
fn distance_field() -> DistanceField {
    DistanceField::build(divan::black_box(&BODY.mesh), SPACING_M).expect("a closed mesh")
}

#[divan::bench]
fn dxf_read() -> dxf::PatternFile {
    dxf::read(divan::black_box(&FILES[0]), "tshirt-m.dxf", None).expect("our own file")
}

/// A nest of 15 sizes of the drafted T-shirt, written by the program's own writer.
fn nest() -> Vec<u8> {
    let file = dxf::read(&FILES[0], "tshirt-m.dxf", None).expect("our own file");
    let size = |k: u32| {
        let grow = 0.9 + 0.015 * f64::from(k);
        file.pieces.iter().map(move |piece| {
            let mut piece = piece.clone();
            let name = 30 + 2 * k;
            (piece.block, piece.size) = (format!("{}_{name}", piece.block), Some(name.to_string()));
            let notches = piece.notches.iter_mut().map(|notch| &mut notch.at);
            let points = piece.outline.iter_mut().chain(&mut piece.turn_points).chain(&mut piece.curve_points);
            points.chain(notches).chain(piece.grain.iter_mut().flatten()).for_each(|point| *point *= grow);
            piece
        })
    };
    dxf::write_pieces(&(0..15).flat_map(size).collect::<Vec<_>>(), &file.texts, dxf::Standard::Aama)
}

/// Opening one size of a nest of 15; to take less than 100 ms.
#[divan::bench]
fn dxf_read_nest_of_15(bencher: Bencher) {
    let bytes = nest();
    bencher.bench_local(|| {
        let file = dxf::read(divan::black_box(&bytes), "nest.dxf", None).expect("our own file");
        assert_eq!(file.sizes().len(), 15);
        file.to_sew(Some("44")).expect("the size is there")
    });
}

/// Every sample pattern that lies beside the checkout, on one core; to take less than 2 s.
#[divan::bench(sample_count = 5)]
fn read_all_samples(bencher: Bencher) {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/patterns");
    bencher.bench_local(|| match inspect(divan::black_box(&folder), &Beside::default()) {
        Ok(reports) => reports.len(),
        // Without the folder there is nothing to time.
        Err(_) => 0,
    });
}

/// Three even sizes of five knobs sought for as many people as `toile grade` draws. Each knob has a start and a step.
#[divan::bench(sample_count = 3, sample_size = 1)]
fn size_search(bencher: Bencher) {
    const KNOBS: usize = 5;
    let mut random = Draw::new(1);
    let middles: Vec<[f64; KNOBS]> = (0..2000)
        .map(|_| {
            let large = 40.0 * random.normal();
            std::array::from_fn(|_| large + 15.0 * random.normal())
        })
        .collect();
    let asked = |size: usize, knob: usize, middle: f64| {
        let mut per_step = vec![0.0; 2 * KNOBS];
        (per_step[knob], per_step[KNOBS + knob]) = (1.0, size as f64);
        Asked { per_step, band: [middle - 20.0, middle + 20.0] }
    };
    let person = |size: usize, middles: &[f64; KNOBS]| -> Asks {
        (0..KNOBS).map(|knob| asked(size, knob, middles[knob])).collect()
    };
    let asks: Vec<Vec<Asks>> =
        (0..3).map(|size| middles.iter().map(|middles| person(size, middles)).collect()).collect();
    let bound = |parameter: usize| {
        let mut weights = vec![0.0; 2 * KNOBS];
        weights[parameter] = 1.0;
        Bound { weights, between: if parameter < KNOBS { [-150.0, 150.0] } else { [5.0, 80.0] } }
    };
    let bounds: Vec<Bound> = (0..2 * KNOBS).map(bound).collect();
    let habits: Vec<Vec<f64>> = (1..KNOBS)
        .map(|knob| (0..2 * KNOBS).map(|k| f64::from(i8::from(k == KNOBS + knob) - i8::from(k == KNOBS))).collect())
        .collect();
    let search = Search { asks: &asks, bounds: &bounds, habits: &habits, price: 0.2 };
    let start = [[-40; KNOBS], [40; KNOBS]].concat();
    bencher.bench_local(|| divan::black_box(&search).best(std::slice::from_ref(&start), 1));
}

#[divan::bench]
fn mesh_15_mm() -> Garment {
    STYLE.mesh(divan::black_box(FINE_M)).expect("it meshes")
}

#[divan::bench(args = [40, 15], sample_count = 3, sample_size = 1)]
fn fem_drape(bencher: Bencher, edge_mm: u32) {
    let garments = meshes(f64::from(edge_mm) * 1e-3);
    LazyLock::force(&FIELD);
    bencher.bench_local(|| drape(divan::black_box(&garments)));
}

/// A drape brought wholly to rest, and what one handle of its pattern moves.
#[divan::bench(sample_count = 3, sample_size = 1)]
fn drape_answers(bencher: Bencher) {
    const TAKEN_M: f64 = 1e-4;
    let garments = meshes(0.04);
    let (garment, positions) = (finest(&garments), drape(&garments).positions);
    let (skin, params) = (Skin::new(&BODY.mesh).ok(), Params::default());
    let fabric: &Fabric = &CLOTH;
    let cloth = sewn(garment, fabric).expect("triangles with areas");
    let lying = Lying {
        skin: skin.as_ref(),
        field: &FIELD,
        floor_m: fem::floor_m(&BODY),
        garment,
        fabric,
        params: &params,
        is_held: false,
    };
    bencher.bench_local(|| {
        let response = Response::of(lying, &cloth, &positions).expect("it lies");
        let taken = |by_m: f64| STYLE.moved_mesh(garment, Handle::Hem, by_m).expect("it has a hem");
        response.rates([&taken(-TAKEN_M), &taken(TAKEN_M)], 2.0 * TAKEN_M).expect("it is held")
    });
}

/// T-shirts of about 5, 10, 20 and 40 thousand sewn vertices, each from five starts that differ a little, since the steps that one takes
/// are chance: `cargo bench -- --ignored`.
#[divan::bench(args = [14, 10, 7, 5], sample_count = 5, sample_size = 1, ignore)]
fn fem_drape_growth(bencher: Bencher, edge_mm: u32) {
    let garments = meshes(f64::from(edge_mm) * 1e-3);
    LazyLock::force(&FIELD);
    bencher.with_inputs(starts()).bench_local_values(|params| drape_from(params, divan::black_box(&garments)));
}

/// A dress of about 20 thousand sewn vertices, from five such starts: `cargo bench -- --ignored`.
#[divan::bench(sample_count = 5, sample_size = 1, ignore)]
fn fem_drape_dress(bencher: Bencher) {
    let wearer = Measurements::of(Sex::Female, 1.650)
        .with(Dimension::Weight, 54.0)
        .with(Dimension::ChestGirth, 0.919)
        .with(Dimension::WaistGirth, 0.779)
        .with(Dimension::HipGirth, 0.973);
    let body = body::build(&wearer).expect("a person that can be");
    let field = DistanceField::build(&body.mesh, SPACING_M).expect("a closed mesh");
    let dress = style(&drafted(draft::Model::Dress, ["dress-one.dxf", "dress.seams.toml"]));
    let garments: Vec<Garment> =
        fem::level_edges(DRESS_M).into_iter().map(|edge| dress.mesh(edge).expect("it meshes")).collect();
    let dress_on = |params: Params| fem::simulate(&body, &field, &garments, &CLOTH, &params, &mut Silent);
    bencher.with_inputs(starts()).bench_local_values(|params| dress_on(params).expect("it drapes"));
}

/// Starts that differ a little, the placed one first.
fn starts() -> impl FnMut() -> Params {
    let mut seeds = 0..;
    move || Params { seed: seeds.next().unwrap_or_default(), ..Params::default() }
}

/// A square metre of cloth, 71 x 71 vertices, over a sphere of 0.3 m, to a residual of 1 %.
#[divan::bench(sample_count = 3, sample_size = 1)]
fn sheet_over_sphere(bencher: Bencher) {
    let field = DistanceField::build(&shapes::sphere(0.3, 64), 0.01).expect("a closed sphere");
    let cloth = laboratory::isotropic(0.2, 500.0, 1e-5);
    bencher.bench_local(|| laboratory::drape::over_sphere(divan::black_box(&cloth), &field).expect("a sound mesh"));
}

#[divan::bench]
fn measure_drape(bencher: Bencher) {
    let garments = meshes(COARSE_M);
    let drape = drape(&garments);
    bencher.bench_local(|| measure::measure(finest(&garments), divan::black_box(&drape.positions)));
}

#[divan::bench(sample_count = 10)]
fn render_front(bencher: Bencher) {
    let garments = meshes(COARSE_M);
    let cloth = TriMesh { positions: drape(&garments).positions, triangles: finest(&garments).triangles.clone() };
    bencher.bench_local(|| {
        let layers = vec![Layer::new(&BODY.mesh, Material::form()), Layer::new(&cloth, Material::fem())];
        let scene = Scene::new(layers).expect("meshes that can be drawn");
        let frame = Frame::enclosing([&BODY.mesh, &cloth], 0.8);
        render::render(&scene, &Camera::new(View::Front, frame), 800, 1000).expect("a picture")
    });
}

/// Reading all results of a study of six coarse drapes, as the workbench does.
#[divan::bench]
fn sql_results(bencher: Bencher) {
    let folder = tempfile::tempdir().expect("a folder");
    let mut store = catalogue::open(&folder.path().join("toile.sqlite"), false).expect("a new database");
    let project = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut study = run::load_study(&store, &project.join("studies/quickstart")).expect("the quickstart is right");
    study.garments.iter_mut().for_each(|garment| garment.edge_length_m = COARSE_M);
    study.subjects.truncate(1);
    run::start(&mut store, &study, &RunOptions::default()).expect("queued").join().expect("the database works");
    bencher.bench_local(|| {
        let chi = sql::query(&store, "SELECT * FROM v_chi WHERE stage = 'drape'").expect("a view");
        assert_eq!(chi.rows.len(), 54);
        sql::query(&store, "SELECT * FROM v_metrics").expect("a view")
    });
}
