use super::*;
use crate::testing::{ascii_ply, ascii_stl, binary_ply, binary_stl};
use proptest::prelude::*;

/// Four-sided prism 1.7 m high, in metres, z up.
fn block() -> TriMesh {
    let positions = vec![V3::zeros(), V3::new(0.3, 0.0, 0.0), V3::new(0.0, 0.2, 0.0), V3::new(0.1, 0.1, 1.7)];
    TriMesh { positions, triangles: vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]] }
}

fn scaled(mesh: &TriMesh, factor: f64) -> TriMesh {
    TriMesh { positions: mesh.positions.iter().map(|p| p * factor).collect(), triangles: mesh.triangles.clone() }
}

#[test]
fn every_format_and_unit_gives_the_same_body() {
    let check = |bytes: &[u8], unit| {
        let imported = import(bytes, None).expect("a good file");
        assert_eq!(imported.unit, unit);
        assert_eq!(imported.mesh.triangles.len(), 4);
        assert_eq!(imported.mesh.positions.len(), 4);
        assert!((imported.mesh.volume() - block().volume()).abs() < 1e-7);
    };
    check(write_obj(&scaled(&block(), 1000.0)).as_bytes(), LengthUnit::Millimetre);
    check(write_obj(&scaled(&block(), 100.0)).as_bytes(), LengthUnit::Centimetre);
    check(&ascii_stl(&block()), LengthUnit::Metre);
    check(&binary_stl(&scaled(&block(), 1000.0)), LengthUnit::Millimetre);
    check(&ascii_ply(&block()), LengthUnit::Metre);
    check(&binary_ply(&scaled(&block(), 100.0)), LengthUnit::Centimetre);
    check(write_obj(&scaled(&block(), 10.0)).as_bytes(), LengthUnit::Decimetre);
    check(write_obj(&scaled(&block(), 1.0 / 0.0254)).as_bytes(), LengthUnit::Inch);
}

fn glb() -> Vec<u8> {
    glb_of(&block())
}

fn glb_of(mesh: &TriMesh) -> Vec<u8> {
    let mut data: Vec<u8> = Vec::new();
    for p in &mesh.positions {
        [p.x, p.z, -p.y].into_iter().for_each(|c| data.extend((c as f32 / 2.0).to_le_bytes()));
    }
    let places = data.len();
    mesh.triangles.iter().flatten().for_each(|index| data.extend((*index as u16).to_le_bytes()));
    let json = serde_json::json!({
        "asset": { "version": "2.0" }, "scene": 0, "scenes": [{ "nodes": [0] }],
        "nodes": [{ "scale": [2.0, 2.0, 2.0], "children": [1] }, { "mesh": 0 }],
        "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0 }, "indices": 1 }] }],
        "accessors": [
            { "bufferView": 0, "componentType": 5126, "count": mesh.positions.len(), "type": "VEC3", "min": [0, 0, -1], "max": [1, 1, 1] },
            { "bufferView": 1, "componentType": 5123, "count": 3 * mesh.triangles.len(), "type": "SCALAR" }
        ],
        "bufferViews": [
            { "buffer": 0, "byteLength": places }, { "buffer": 0, "byteOffset": places, "byteLength": 6 * mesh.triangles.len() }
        ],
        "buffers": [{ "byteLength": data.len() }]
    });
    let mut json = json.to_string().into_bytes();
    json.resize(json.len().next_multiple_of(4), b' ');
    data.resize(data.len().next_multiple_of(4), 0);
    let chunk = |kind: &[u8], bytes: &[u8]| [&(bytes.len() as u32).to_le_bytes()[..], kind, bytes].concat();
    let body = [chunk(b"JSON", &json), chunk(b"BIN\0", &data)].concat();
    [b"glTF", &2u32.to_le_bytes()[..], &(body.len() as u32 + 12).to_le_bytes()[..], &body].concat()
}

#[test]
fn a_glb_is_read_where_its_nodes_put_it() {
    let imported = import(&glb(), None).expect("a good file");
    assert_eq!((imported.unit, imported.mesh.triangles.len()), (LengthUnit::Metre, 4));
    assert!((imported.mesh.volume() - block().volume()).abs() < 1e-6);
    assert!(imported.notes.iter().any(|note| note.contains("y up")), "{:?}", imported.notes);
}

#[test]
fn vertices_of_two_charts_are_joined() {
    // Every triangle has corners of its own, as along the border of charts.
    let whole = block();
    let positions: Vec<V3> = whole.triangles.iter().flatten().map(|&i| whole.positions[i]).collect();
    let charts = TriMesh { triangles: (0..4).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect(), positions };
    let joined = import(&glb_of(&charts), None).expect("a good file").mesh;
    assert_eq!((joined.positions.len(), joined.triangles.len()), (4, 4));
    assert!((joined.volume() - whole.volume()).abs() < 1e-6);
}

#[test]
fn a_damaged_glb_is_refused_without_a_panic() {
    let whole = glb();
    for end in 0..whole.len() {
        let _ = import(&whole[..end], None);
    }
    for at in 12..whole.len() {
        for byte in [0, 0x30, 0x39, 0x7f, 0xff] {
            let mut damaged = whole.clone();
            damaged[at] = byte;
            let _ = import(&damaged, None);
        }
    }
}

#[test]
fn turned_and_inverted_bodies_are_righted_and_said() {
    let mut mesh = block();
    for p in &mut mesh.positions {
        *p = V3::new(-p.x, p.z, p.y);
    }
    mesh.triangles.iter_mut().for_each(|triangle| triangle.reverse());
    let imported = import(write_obj(&mesh).as_bytes(), Some(LengthUnit::Metre)).expect("a good file");
    assert!(imported.mesh.volume() > 0.0);
    assert!((imported.mesh.bounds().expect("vertices").1.z - 1.7).abs() < 1e-6);
    assert_eq!(imported.notes.len(), 2, "{:?}", imported.notes);
}

#[test]
fn names_and_comments_of_an_obj_may_be_in_any_code_page() {
    let plain = write_obj(&scaled(&block(), 1000.0));
    let noted = plain.replace("\nf ", " # x\nf ").replace("\nv ", " 0.5 0.5 0.5\nv ");
    let faces = noted.find("\nf ").expect("faces");
    let (before, after) = noted.split_at(faces);
    let textured: String = after
        .lines()
        .map(|line| match line.strip_prefix("f ") {
            Some(rest) => {
                format!("f {}\n", rest.split(' ').map(|corner| format!("{corner}/9/9")).collect::<Vec<_>>().join(" "))
            }
            None => format!("{line}\n"),
        })
        .collect();
    let named = b"# Gr\xfc\xdfe\nmtllib K\xf6rper.mtl\no K\xf6rper\n";
    let bytes = [&named[..], before.as_bytes(), b"\ng R\xfccken\nusemtl Haut\n", textured.as_bytes()].concat();
    assert_eq!(read(&bytes).expect("a mesh"), read(plain.as_bytes()).expect("a mesh"));
}

#[test]
fn broken_files_are_refused_with_their_place() {
    let check = |bytes: &[u8], needle: &str| {
        let error = import(bytes, None).expect_err("a broken file").to_string();
        assert!(error.contains(needle), "{error}");
    };
    check(b"v 0 0 0\nv 1 zero 0\nf 1 2 1\n", "line 2");
    check(b"solid x\nfacet\nouter loop\nvertex 1 2\nendloop\n", "line 4");
    check(b"ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n1\n", "vertex 1");
    check(b"", "no faces");
    check(write_obj(&scaled(&block(), 5.0)).as_bytes(), "no adult");
}

#[test]
fn stl_is_told_from_its_bytes_and_damage_has_its_place() {
    let good = binary_stl(&scaled(&block(), 1000.0));
    let named = |bytes: &[u8]| [b"solid made by a scanner ", &bytes[24..]].concat();
    let check = |bytes: &[u8], places: &[&str]| {
        let error = import(bytes, None).expect_err("damaged").to_string();
        assert!(places.iter().all(|place| error.contains(place)), "{error}");
    };
    assert_eq!(import(&named(&good), None).expect("a good file").mesh.triangles.len(), 4);
    for bytes in [good.clone(), named(&good)] {
        check(&bytes[..bytes.len() - 60], &["STL, facet 3", "4 facets are announced, the file has 2"]);
        check(&[&bytes[..], &[0; 60]].concat(), &["STL, facet 5", "the file has 5"]);
        check(&bytes[..84], &["STL, facet 1", "the file has 0"]);
    }
    let text = ascii_stl(&block());
    let twice = [&text[..], &ascii_stl(&scaled(&block(), 1.1))].concat();
    assert_eq!(read(&twice).expect("two solids").triangles.len(), 8);
    let half = String::from_utf8(text).expect("text").replacen("endloop", "", 1);
    let cut = &half[..half.rfind("vertex").expect("a vertex")];
    check(cut.as_bytes(), &["STL, end of file", "fewer than three vertices"]);
}

proptest! {
    #[test]
    fn no_bytes_make_an_importer_fail(head in "(ply\nformat ascii 1.0\n|solid |v 1 2 3\nf |)", tail in proptest::collection::vec(any::<u8>(), 0..400)) {
        let mut bytes = head.into_bytes();
        bytes.extend(tail);
        let _ = import(&bytes, None);
        bytes.resize(bytes.len().max(84), 0);
        bytes[83] = 0;
        let _ = import(&bytes, None);
    }

    #[test]
    fn obj_round_trip(numbers in proptest::collection::vec(-2.0..2.0_f64, 12)) {
        let mut mesh = block();
        for (i, (p, n)) in mesh.positions.iter_mut().zip(numbers.chunks_exact(3)).enumerate() {
            // Apart by more than their spread, so that no two vertices become one.
            *p = V3::new(n[0] + 5.0 * i as f64, n[1], n[2]);
        }
        let back = read(write_obj(&mesh).as_bytes()).expect("our own file");
        // Vertices may come in another order: the triangles' corners are compared.
        let corners = |mesh: &TriMesh| mesh.triangles.iter().flatten().map(|&i| mesh.positions[i]).collect::<Vec<_>>();
        for (a, b) in corners(&mesh).iter().zip(corners(&back)) {
            prop_assert!((a - b).norm() < 5e-6);
        }
    }
}
