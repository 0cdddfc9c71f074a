use std::collections::BTreeMap;

use super::*;
use crate::draft::{TSHIRT_SEAMS, TshirtSize, tshirt};
use geom::polyline::signed_area;

fn style(size: TshirtSize) -> Style {
    Style::read(&tshirt(size).pieces, TSHIRT_SEAMS, "tshirt.seams.toml").expect("the drafted style is whole")
}

fn garments() -> impl Iterator<Item = (Style, Garment)> {
    let lengths = [0.012, 0.020, 0.040];
    TshirtSize::ALL
        .into_iter()
        .flat_map(move |size| lengths.map(|h| (style(size), style(size).mesh(h).expect("it meshes"))))
}

#[test]
fn triangles_are_near_equilateral_counter_clockwise_and_fill_the_outline() {
    for (style, garment) in garments() {
        let quality = MeshQuality::of(&garment).expect("there are triangles");
        let h = garment.edge_length_m;
        assert!(quality.min_angle_deg > 25.0, "{} at {h}: {quality:?}", garment.size);
        assert!(quality.min_edge_m > 0.5 * h && quality.max_edge_m < 1.6 * h, "{} at {h}: {quality:?}", garment.size);
        assert!((quality.mean_edge_m / h - 1.0).abs() < 0.06, "{} at {h}: {quality:?}", garment.size);
        for (piece, drawn) in garment.pieces.iter().zip(&style.pieces) {
            let areas =
                garment.triangles[piece.triangles.clone()].iter().map(|t| signed_area(&t.map(|v| garment.rest[v])));
            let areas: Vec<f64> = areas.collect();
            assert!(areas.iter().all(|&area| area > 0.1 * h * h), "{} at {h}", piece.id);
            // Chords cut the curves of the drawn outline by less than a hundredth of its area.
            let drawn_area = signed_area(&drawn.outline());
            assert!((areas.iter().sum::<f64>() / drawn_area - 1.0).abs() < 0.01, "{} at {h}", piece.id);
        }
    }
}

#[test]
fn triangles_come_in_the_order_of_their_last_vertices() {
    for (_, garment) in garments() {
        let order = |t: &[usize; 3]| t[0].max(t[1]).max(t[2]);
        assert!(garment.triangles.is_sorted_by_key(order), "{} at {}", garment.size, garment.edge_length_m);
    }
}

#[test]
fn named_edges_run_counter_clockwise_round_the_whole_piece() {
    let (style, garment) = garments().next().expect("a garment");
    for (piece, drawn) in garment.pieces.iter().zip(&style.pieces) {
        let edges: Vec<&Vec<usize>> = drawn
            .edges
            .iter()
            .map(|edge| &piece.edges[edge.name.as_ref().expect("the T-shirt names all edges")])
            .collect();
        let mut outline = Vec::new();
        for (k, edge) in edges.iter().enumerate() {
            assert_eq!(edge.last(), edges[(k + 1) % edges.len()].first(), "{}", piece.id);
            outline.extend(edge[..edge.len() - 1].iter().map(|&vertex| garment.rest[vertex]));
        }
        assert!(signed_area(&outline) > 0.0);
        assert!(edges.iter().flat_map(|edge| edge.iter()).all(|vertex| piece.vertices.contains(vertex)));
    }
}

#[test]
fn seam_partners_match_length_by_length() {
    for (_, garment) in garments() {
        for seam in &garment.seams {
            for ends in seam.pairs.windows(2) {
                let step = |side: usize| (garment.rest[ends[1][side]] - garment.rest[ends[0][side]]).norm();
                let [a, b] = [step(0), step(1)];
                let is_joint = ends[0][0] == ends[1][0] || ends[0][1] == ends[1][1];
                assert!(is_joint || (a / b - 1.0).abs() < 0.08, "{} at {}: {a} {b}", seam.name, garment.edge_length_m);
            }
        }
    }
}

#[test]
fn seams_weld_consistently_where_they_meet() {
    for (_, garment) in garments() {
        // Smallest vertex of each welded group, found by repeated relabelling.
        let mut label: Vec<usize> = (0..garment.rest.len()).collect();
        loop {
            let before = label.clone();
            for &[a, b] in garment.seams.iter().flat_map(|seam| &seam.pairs) {
                let least = label[a].min(label[b]);
                (label[a], label[b]) = (least, least);
            }
            if before == label {
                break;
            }
        }
        let mut groups: BTreeMap<usize, usize> = BTreeMap::new();
        label.iter().for_each(|&least| *groups.entry(least).or_default() += 1);
        let of_size = |size: usize| groups.values().filter(|&&count| count == size).count();
        // Two underarms join front, back and both ends of a sleeve; two shoulder points join front, back and cap.
        assert_eq!((of_size(4), of_size(3), groups.values().filter(|&&count| count > 4).count()), (2, 2, 0));
        let sewn_edges =
            ["side_right", "side_left", "shoulder_right", "shoulder_left", "armhole_right", "armhole_left"];
        for (edge, piece) in sewn_edges.iter().flat_map(|edge| [(edge, 0), (edge, 1)]) {
            let vertices = &garment.pieces[piece].edges[*edge];
            assert!(vertices.iter().all(|&v| groups[&label[v]] >= 2), "{edge} of {}", garment.pieces[piece].id);
        }
    }
}

#[test]
fn measurements_add_up_to_their_pattern_length() {
    for (style, garment) in garments() {
        for measurement in &garment.measurements {
            let arcs: f64 = measurement.runs.iter().flat_map(|run| &run.arc_m).sum();
            assert!((arcs - measurement.l2d_m).abs() < 1e-6, "#{}: {arcs} for {}", measurement.no, measurement.l2d_m);
            for run in &measurement.runs {
                assert_eq!(run.points.len(), run.arc_m.len() + 1);
                for (ends, arc) in run.points.windows(2).zip(&run.arc_m) {
                    let chord = (ends[1].at_rest(&garment.rest) - ends[0].at_rest(&garment.rest)).norm();
                    assert!(chord > 0.0 && chord <= arc + 1e-9, "#{}: chord {chord}, arc {arc}", measurement.no);
                }
            }
        }
        let free: Vec<u32> = garment.measurements.iter().filter(|m| m.is_free_edge).map(|m| m.no).collect();
        assert_eq!(free, [1, 2, 6]);
        assert_eq!(garment.fit_levels.len(), 1);
        assert!((garment.fit_levels[0].girth_m - style.measurements[0].l2d_m).abs() < 1e-6);
    }
}

#[test]
fn edge_lengths_out_of_range_are_refused() {
    for edge_length in [0.0, -0.01, f64::NAN, 1e-4, 0.5] {
        let error = style(TshirtSize::S).mesh(edge_length).expect_err("out of range");
        assert!(matches!(error, MeshError::EdgeLength { .. }), "{error}");
    }
}

#[test]
fn meshing_is_deterministic() {
    assert_eq!(style(TshirtSize::M).mesh(0.02), style(TshirtSize::M).mesh(0.02));
}

/// True if the outline forces a bad triangle: by a sharp corner, a short side, or a strip too narrow for a vertex
/// inside.
fn is_forced(garment: &Garment, triangle: [usize; 3]) -> bool {
    let h = garment.edge_length_m;
    let sides_of = |t: &[usize; 3]| [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]];
    let mut count: BTreeMap<[usize; 2], usize> = BTreeMap::new();
    for side in garment.triangles.iter().flat_map(sides_of) {
        *count.entry([side[0].min(side[1]), side[0].max(side[1])]).or_default() += 1;
    }
    let boundary: Vec<[usize; 2]> = count.into_iter().filter(|(_, n)| *n == 1).map(|(side, _)| side).collect();
    let length = |side: &[usize; 2]| (garment.rest[side[1]] - garment.rest[side[0]]).norm();
    let is_on = |vertex: usize| boundary.iter().any(|side| side.contains(&vertex));
    let has_short = |vertex: usize| boundary.iter().any(|side| side.contains(&vertex) && length(side) < 0.5 * h);
    let inner_angle = |vertex: usize| {
        let angle_of = |t: &[usize; 3]| {
            let k = t.iter().position(|&v| v == vertex)?;
            let [p, q, r] = [t[k], t[(k + 1) % 3], t[(k + 2) % 3]].map(|v| garment.rest[v]);
            Some((q - p).angle(&(r - p)).to_degrees())
        };
        garment.triangles.iter().filter_map(angle_of).sum::<f64>()
    };
    triangle.iter().all(|&vertex| is_on(vertex))
        || triangle.iter().any(|&vertex| has_short(vertex) || (is_on(vertex) && inner_angle(vertex) < 45.0))
}

/// Names an arbitrary edge of each piece. Meshes are good where the outline allows it.
#[test]
fn pieces_of_other_programs_mesh() {
    let mut angles = Vec::new();
    let mut unforced: Vec<String> = Vec::new();
    for folder in ["freesewing", "valentina", "garmentcode", "jblockcreator"] {
        let path = format!("{}/../../../shared/patterns/{folder}", env!("CARGO_MANIFEST_DIR"));
        let Ok(entries) = std::fs::read_dir(&path) else {
            eprintln!("skipped: {path} is not here");
            return;
        };
        let files = entries.map(|entry| entry.expect("it can be listed").path());
        for file in files.filter(|p| p.extension().is_some_and(|e| e == "dxf")) {
            let bytes = std::fs::read(&file).expect("it can be read");
            for piece in crate::dxf::read(&bytes, "a.dxf", None).expect("it reads").pieces {
                let seams =
                    format!("name = ''\n[piece.p]\nblock = '{}'\nrole = 'front'\nedges.e = [0, 1]", piece.block);
                let name = format!("{} {}", file.file_name().unwrap_or_default().to_string_lossy(), piece.block);
                let style = Style::read(&[piece], seams.as_bytes(), "a.toml").expect("it is a style");
                let garment = style.mesh(0.015).unwrap_or_else(|error| panic!("{name}: {error}"));
                let angle = MeshQuality::of(&garment).expect("there are triangles").min_angle_deg;
                angles.push(angle);
                let is_bad = |t: &&[usize; 3]| triangulate::min_angle(t.map(|v| garment.rest[v])).to_degrees() < 20.0;
                let bad: Vec<&[usize; 3]> = garment.triangles.iter().filter(is_bad).collect();
                let free = bad.iter().filter(|triangle| !is_forced(&garment, ***triangle)).count();
                if free > 0 {
                    unforced.push(format!("{name}: {free} of {} triangles, least angle {angle:.1}", bad.len()));
                }
            }
        }
    }
    angles.sort_by(f64::total_cmp);
    let share = |below: f64| angles.iter().filter(|&&angle| angle < below).count();
    eprintln!(
        "{} pieces; least angle below 5: {}, 10: {}, 20: {}, 25: {} pieces; median {:.1} degrees; not forced: {unforced:#?}",
        angles.len(),
        share(5.0),
        share(10.0),
        share(20.0),
        share(25.0),
        angles[angles.len() / 2]
    );
    assert!(unforced.is_empty(), "{unforced:#?}");
}

#[test]
fn a_garment_without_some_pieces_is_the_rest_of_it() {
    let garment = style(TshirtSize::M).mesh(0.03).expect("it meshes");
    let back = garment.pieces.iter().position(|piece| piece.id == "back").expect("it has one");
    let (rest, kept) = garment.without(&[back]);
    assert_eq!((rest.pieces.len(), rest.rest.len()), (garment.pieces.len() - 1, kept.len()));
    assert!(rest.rest.iter().zip(&kept).all(|(p, &v)| *p == garment.rest[v]));
    for piece in &rest.pieces {
        let whole = garment.pieces.iter().find(|other| other.id == piece.id).expect("it was there");
        let there = |triangle: &[usize; 3]| triangle.map(|v| kept[v]);
        let triangles = rest.triangles[piece.triangles.clone()].iter().map(there);
        assert!(triangles.eq(garment.triangles[whole.triangles.clone()].iter().copied()), "{}", piece.id);
        assert!(piece.vertices.clone().map(|v| kept[v]).eq(whole.vertices.clone()), "{}", piece.id);
        for (name, edge) in &piece.edges {
            assert_eq!(&edge.iter().map(|&v| kept[v]).collect::<Vec<_>>(), &whole.edges[name], "{}.{name}", piece.id);
        }
    }
    // Sleeves keep their underarm and the front half of their armhole.
    let names: Vec<&str> = rest.seams.iter().map(|seam| seam.name.as_str()).collect();
    assert!(names.iter().all(|name| !name.contains("side") && !name.contains("shoulder")), "{names:?}");
    let pairs = |garment: &Garment| garment.seams.iter().map(|seam| seam.pairs.len()).sum::<usize>();
    assert!(pairs(&rest) > 0 && pairs(&rest) < pairs(&garment));
    let is_pair = |[a, b]: &[usize; 2]| garment.seams.iter().any(|seam| seam.pairs.contains(&[kept[*a], kept[*b]]));
    assert!(rest.seams.iter().flat_map(|seam| &seam.pairs).all(is_pair));
}

#[test]
fn a_mesh_that_nothing_could_be_done_with_is_not_begun() {
    let mut style = style(TshirtSize::S);
    for edge in style.pieces.iter_mut().flat_map(|piece| &mut piece.edges) {
        edge.line = edge.line.mapped(|p| p * 100.0);
    }
    let error = style.mesh(0.015).expect_err("a giant's").to_string();
    assert!(error.contains("thousand triangles") && error.contains("is the unit of the pattern right?"), "{error}");
}
