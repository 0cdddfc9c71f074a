//! Times of the phases of Hybrid-GS on the drafted T-shirt (size M, edges of 15 mm) and the thesis's man ii; body and distance
//! field are there before, as the cache has them.
//!
//! `cargo bench --bench hybrid` measures; `cargo bench --bench hybrid -- --test` runs each once.

use std::sync::LazyLock;

use divan::Bencher;
use toile::body::Dimension;
use toile::body::{self, Body, Measurements, Sex};
use toile::geom::DistanceField;
use toile::pattern::draft::Model;
use toile::pattern::{Garment, Role, Style};
use toile::sim::hybrid::form::Form;
use toile::sim::hybrid::mapping::{PATH_POINTS, can_touch};
use toile::sim::hybrid::path::{PathGraph, Taken};
use toile::sim::hybrid::{self, Params, Sewn, mapping};
use toile::sim::{Drape, Silent, fabric};

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
static FIELD: LazyLock<DistanceField> =
    LazyLock::new(|| DistanceField::build(&BODY.mesh, 0.005).expect("a closed mesh"));
static SHIRT: LazyLock<Garment> = LazyLock::new(|| {
    let style = Style::read(&Model::Tshirt.drafts()[1].pieces, Model::Tshirt.seams(), "seams").expect("our own style");
    style.mesh(0.015).expect("it meshes")
});

/// All phases, with so many steps of the drape.
fn dress(push_steps: u32, firm_steps: u32) -> Drape {
    let params = Params { push_steps, firm_steps, ..Params::default() };
    hybrid::simulate(&BODY, &FIELD, std::slice::from_ref(&*SHIRT), &fabric::library()[0], &params, &mut Silent)
        .expect("it can be dressed")
}

/// Features, segmentation and cross-parameterisation (table 5-3 and on).
#[divan::bench]
fn map(bencher: Bencher) {
    LazyLock::force(&SHIRT);
    bencher.bench(|| mapping::map(&BODY, &SHIRT).expect("it maps"));
}

/// Sewing and smoothing (tables 5-4 and 5-5).
#[divan::bench]
fn sew(bencher: Bencher) {
    let mapped = mapping::map(&BODY, &SHIRT).expect("it maps");
    bencher.bench(|| Sewn::new(&SHIRT, &mapped.positions));
}

/// Everything up to the pop-up (table 5-8), and a single step of the drape.
#[divan::bench]
fn until_popup(bencher: Bencher) {
    LazyLock::force(&FIELD);
    bencher.bench(|| dress(1, 0));
}

/// All four phases.
#[divan::bench]
fn whole(bencher: Bencher) {
    LazyLock::force(&FIELD);
    let Params { push_steps, firm_steps, .. } = Params::default();
    bencher.bench(|| dress(push_steps, firm_steps));
}

/// One path from hip to chest at the side: by plain Dijkstra, and restricted and directed (table 5-3).
#[divan::bench(args = ["full", "fast"])]
fn path(bencher: Bencher, search: &str) {
    let form = Form::hung(&BODY);
    let normals = form.mesh.triangle_normals();
    let graph = PathGraph::new(&form.mesh, PATH_POINTS);
    let end = |along: f64| graph.nearest(&form.trunk.at(&form.mesh, 3, along), |_| true).expect("a node");
    let (from, to) = (end(1.0), end(4.0));
    let allowed = |face: usize| can_touch(Role::Front, form.regions[face], &normals[face]);
    match search {
        "full" => bencher.bench(|| graph.shortest(from, to).expect("connected")),
        _ => bencher.bench(|| graph.shortest_within(from, to, allowed, &Taken::default()).expect("connected")),
    }
}
