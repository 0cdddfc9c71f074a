//! Helpers for the tests of the simulators: finite differences, garments with lapels, panels given by their corners.

use serde_json::{Value, json};

use crate::{Drape, Fabric, Stage};
use geom::{V2, V3};
use pattern::draft::Model;
use pattern::piece::Piece;
use pattern::style::EdgeRef;
use pattern::{Garment, Role, Style, garmentcode};

/// Numbers all differ, so that a test shows where two are interchanged.
pub fn fabric() -> Fabric {
    Fabric {
        name: "test".into(),
        density_kg_m2: 0.15,
        thickness_m: 3e-4,
        membrane_warp_n_m: 800.0,
        membrane_weft_n_m: 500.0,
        membrane_coupling_n_m: 120.0,
        shear_n_m: 90.0,
        bending_warp_nm: 8e-6,
        bending_weft_nm: 5e-6,
        friction_body: 0.3,
        friction_self: 0.5,
        source: "test".into(),
        stretched: None,
    }
}

/// At rest without faults and without cloth.
pub fn drape() -> Drape {
    Drape {
        stage: Stage::Drape,
        converged: true,
        iterations: 1,
        residual: 0.0,
        penetration_max_m: 0.0,
        seam_gap_max_m: 0.0,
        self_crossings: 0,
        braced_n: None,
        is_stuck: false,
        welded_vertices: 1,
        positions: Vec::new(),
        history: Vec::new(),
        earlier: Vec::new(),
        kept: None,
    }
}

/// Asserts that `forces` is the negative gradient of `energy`, by central differences of step `h`. The tolerance is
/// `relative` times the greatest force.
pub fn check_forces(energy: impl Fn(&[V3]) -> f64, forces: &[V3], x: &[V3], h: f64, relative: f64) {
    let scale = forces.iter().map(|f| f.norm()).fold(0.0, f64::max);
    for i in 0..x.len() {
        for k in 0..3 {
            let energy_at = |d: f64| {
                let mut moved = x.to_vec();
                moved[i][k] += d;
                energy(&moved)
            };
            let expected = -(energy_at(h) - energy_at(-h)) / (2.0 * h);
            let error = (forces[i][k] - expected).abs();
            assert!(error <= relative * scale, "vertex {i} axis {k}: {} for {expected}", forces[i][k]);
        }
    }
}

/// Smallest drafted T-shirt with a collar on its back neck and a lapel on either side of its V, folded outwards where
/// `is_folded`, else continuing the cloth.
pub fn lapelled(edge_m: f64, is_folded: bool) -> Garment {
    const WIDE_M: f64 = 0.06;
    let mut pieces = Model::Tshirt.drafts()[0].pieces.clone();
    let plain = Style::read(&pieces, Model::Tshirt.seams(), "seams").expect("a style");
    let length_m = |piece: &str, name: &str| {
        let piece = plain.pieces.iter().position(|known| known.id == piece).expect("it has one");
        let edge =
            plain.pieces[piece].edges.iter().position(|edge| edge.name.as_deref() == Some(name)).expect("it has one");
        plain.edge(EdgeRef { piece, edge }).line.length()
    };
    let (side, behind) = (length_m("front", "neck_left"), length_m("back", "neck"));
    let mut add = |block: &str, outline: &[[f64; 2]]| {
        let outline: Vec<V2> = outline.iter().map(|[x, y]| V2::new(*x, *y)).collect();
        pieces.push(Piece { block: block.to_owned(), turn_points: outline.clone(), outline, ..Piece::default() });
    };
    add("LAPEL", &[[0.0, 0.0], [side, 0.0], [0.0, WIDE_M]]);
    add("COLLAR", &[[0.0, 0.0], [behind, 0.0], [behind, WIDE_M], [0.0, WIDE_M]]);
    let piece = |id: &str, block: &str, more: &str, edges: &str| {
        format!(
            "[piece.{id}]\nblock = \"{block}\"\nrole = \"other\"\n{more}\n[piece.{id}.edges]\nlow = [0, 1]\n{edges}\n"
        )
    };
    let seam = |a: &str, b: &str, is_folded: bool| {
        format!("[[seam]]\nname = \"{a}\"\na = [\"{a}\"]\nb = [\"{b}\"]\nsame_direction = {is_folded}\n")
    };
    let more = [
        "\n".to_owned(),
        piece("lapel_left", "LAPEL", "", "end = [2, 0]"),
        piece("lapel_right", "LAPEL", "mirror = true", "end = [2, 0]"),
        piece("collar", "COLLAR", "", "left = [1, 2]\nright = [3, 0]"),
        seam("lapel_left.low", "front.neck_left", is_folded),
        seam("lapel_right.low", "front.neck_right", is_folded),
        seam("collar.low", "back.neck", is_folded),
        seam("collar.left", "lapel_left.end", false),
        seam("collar.right", "lapel_right.end", false),
    ];
    let style = Style::read(&pieces, &[Model::Tshirt.seams(), more.concat().as_bytes()].concat(), "seams");
    style.expect("a style").mesh(edge_m).expect("a mesh")
}

/// Centimetres. Edges are straight, except for those in `curved`.
pub fn panel(corners: &[[f64; 2]], [x, z]: [f64; 2], curved: &[(usize, Value)]) -> Value {
    let edge = |k: usize| {
        let mut edge = json!({ "endpoints": [k, (k + 1) % corners.len()] });
        if let Some((_, curvature)) = curved.iter().find(|(at, _)| *at == k) {
            edge["curvature"] = curvature.clone();
        }
        edge
    };
    let edges: Vec<Value> = (0..corners.len()).map(edge).collect();
    json!({ "translation": [x, 0, z], "rotation": [0, 0, 0], "vertices": corners, "edges": edges })
}

/// Panel and index of the edge.
pub fn stitch(one: (&str, usize), other: (&str, usize)) -> Value {
    let side = |(panel, edge): (&str, usize)| json!({ "panel": panel, "edge": edge });
    json!([side(one), side(other)])
}

pub fn sewn(panels: &Value, stitches: &[Value], role: impl Fn(&str) -> Role) -> Garment {
    let document = json!({
        "pattern": { "panels": panels, "stitches": stitches },
        "properties": { "curvature_coords": "relative", "units_in_meter": 100 }
    });
    let read = garmentcode::read(document.to_string().as_bytes(), "garment").expect("a specification");
    let mut garment = read.style().mesh(0.04).expect("a mesh");
    for piece in &mut garment.pieces {
        piece.role = role(&piece.id);
    }
    garment
}

pub fn skirt_role(id: &str) -> Role {
    if id.starts_with("back") { Role::SkirtBack } else { Role::SkirtFront }
}

/// Skirt of half circles: each tier has a front and a back of some inner radius (cm), 30 cm long.
pub fn tiered(radii: &[f64]) -> Garment {
    let (mut panels, mut stitches) = (json!({}), Vec::new());
    let arc = |radius: f64, sweep: u8| json!({ "type": "circle", "params": [radius, 0, sweep] });
    for (tier, &inner) in radii.iter().enumerate() {
        let outer = inner + 30.0;
        let corners = [[-outer, 0.0], [outer, 0.0], [inner, 0.0], [-inner, 0.0]];
        let [front, back] = ["front", "back"].map(|side| format!("{side}_{tier}"));
        for side in [&front, &back] {
            panels[side] = panel(&corners, [0.0, 0.0], &[(0, arc(outer, 1)), (2, arc(inner, 0))]);
        }
        if tier + 1 < radii.len() {
            stitches.push(stitch((&front, 0), (&format!("front_{}", tier + 1), 2)));
            stitches.push(stitch((&back, 0), (&format!("back_{}", tier + 1), 2)));
        }
        stitches.push(stitch((&front, 1), (&back, 3)));
        stitches.push(stitch((&front, 3), (&back, 1)));
    }
    sewn(&panels, &stitches, skirt_role)
}
