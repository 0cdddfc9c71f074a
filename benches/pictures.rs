//! Times of pictures: the thesis's man ii in the drafted T-shirt (size M, edges of 15 mm), dressed by Hybrid-GS.
//!
//! `cargo bench --bench pictures` measures; `cargo bench --bench pictures -- --test` draws each once.

use std::sync::LazyLock;

use divan::Bencher;
use toile::body::Dimension;
use toile::body::{self, Body, Measurements, Sex};
use toile::geom::{DistanceField, TriMesh};
use toile::pattern::draft::Model;
use toile::pattern::{Garment, Style};
use toile::render::{self, Camera, Frame, Layer, Mapping, Material, Paint, Print, Scene, Texture, View};
use toile::sim::hybrid::{self, Params};
use toile::sim::{Silent, fabric};

fn main() {
    divan::main();
}

static BODY: LazyLock<Body> = LazyLock::new(|| {
    let measurements = Measurements::of(Sex::Male, 1.690)
        .with(Dimension::ChestGirth, 0.863)
        .with(Dimension::WaistGirth, 0.782)
        .with(Dimension::HipGirth, 0.914);
    body::build(&measurements).expect("a person that can be")
});
static SHIRT: LazyLock<Garment> = LazyLock::new(|| {
    let style = Style::read(&Model::Tshirt.drafts()[1].pieces, Model::Tshirt.seams(), "seams").expect("our own style");
    style.mesh(0.015).expect("it meshes")
});
static CLOTH: LazyLock<TriMesh> = LazyLock::new(|| {
    let field = DistanceField::build(&BODY.mesh, 0.005).expect("a closed mesh");
    let drape = hybrid::simulate(
        &BODY,
        &field,
        std::slice::from_ref(&*SHIRT),
        &fabric::library()[0],
        &Params::default(),
        &mut Silent,
    );
    TriMesh { positions: drape.expect("it can be dressed").positions, triangles: SHIRT.triangles.clone() }
});

/// Body and cloth, joined and lit.
fn scene(paint: Paint) -> Scene {
    let cloth = Layer::new(&CLOTH, Material::hybrid()).painted(paint);
    Scene::new(vec![Layer::new(&BODY.mesh, Material::form()), cloth]).expect("meshes that can be drawn")
}

fn four_views(scene: &Scene) {
    let frame = Frame::enclosing([&BODY.mesh, &*CLOTH], 0.8);
    for view in View::ALL {
        divan::black_box(render::render(scene, &Camera::new(view, frame), 800, 1000).expect("a picture"));
    }
}

/// Light that all views share.
#[divan::bench(sample_count = 10)]
fn light() -> Scene {
    LazyLock::force(&CLOTH);
    scene(Paint::Plain)
}

/// A lit scene from four sides, 800 x 1000 pixels each; with its light to take less than 0.5 s of one core.
#[divan::bench(sample_count = 10)]
fn views(bencher: Bencher) {
    let scene = scene(Paint::Plain);
    bencher.bench_local(|| four_views(&scene));
}

/// The same in a woven check.
#[divan::bench(sample_count = 10)]
fn views_textured(bencher: Bencher) {
    let woven = Mapping::Fabric { repeat_m: [0.04, 0.04] };
    let pieces: Vec<_> = SHIRT.pieces.iter().map(|piece| (piece.vertices.clone(), piece.grain, woven)).collect();
    let places = render::texture_coordinates(&SHIRT.rest, &pieces);
    let (textures, of) = (vec![Texture::gingham(Material::hybrid().front)], vec![0; SHIRT.triangles.len()]);
    let scene = scene(Paint::Printed(Print { textures, of, places }));
    bencher.bench_local(|| four_views(&scene));
}
