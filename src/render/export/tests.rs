use super::*;
use geom::V3;

fn mesh() -> TriMesh {
    let positions = vec![V3::zeros(), V3::x(), V3::y(), V3::z()];
    TriMesh { positions, triangles: vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]] }
}

fn written(format: MeshFormat) -> Vec<u8> {
    let mesh = mesh();
    let places = [V2::zeros(), V2::x(), V2::y(), V2::new(1.0, 1.0)];
    let values = [1.0, 2.0, f64::NAN, 4.0];
    let colours = vec![Rgb(255, 0, 51); 4];
    let body = Part { name: "body", mesh: &mesh, colours: colours.clone(), places: None, values: None };
    let garment =
        Part { name: "garment", mesh: &mesh, colours, places: Some(&places), values: Some(("gap, mm", &values)) };
    format.write(&[body, garment])
}

#[test]
fn glb_is_what_the_standard_asks() {
    let file = written(MeshFormat::Glb);
    let word = |at: usize| u32::from_le_bytes(file[at..at + 4].try_into().expect("four bytes")) as usize;
    assert_eq!((&file[..4], word(4), word(8)), (&b"glTF"[..], 2, file.len()));
    let json_length = word(12);
    assert_eq!((&file[16..20], json_length % 4), (&b"JSON"[..], 0));
    let json: serde_json::Value = serde_json::from_slice(&file[20..20 + json_length]).expect("JSON");
    let numbers = 20 + json_length;
    assert_eq!((&file[numbers + 4..numbers + 8], word(numbers)), (&b"BIN\0"[..], file.len() - numbers - 8));
    assert_eq!(json["buffers"][0]["byteLength"], word(numbers));

    let garment = &json["meshes"][1]["primitives"][0];
    let accessor = |index: &serde_json::Value| &json["accessors"][index.as_u64().expect("an index") as usize];
    let positions = accessor(&garment["attributes"]["POSITION"]);
    assert_eq!(positions["count"], 4);
    assert_eq!(
        (&positions["min"], &positions["max"]),
        (&serde_json::json!([-1.0, 0.0, 0.0]), &serde_json::json!([0.0, 1.0, 1.0]))
    );
    for (name, count) in [("NORMAL", 4), ("COLOR_0", 4), ("TEXCOORD_0", 4), ("_VALUE", 4)] {
        assert_eq!(accessor(&garment["attributes"][name])["count"], count, "{name}");
    }
    assert_eq!(accessor(&garment["indices"])["count"], 12);
    assert_eq!(json["meshes"][1]["extras"]["_VALUE"], "gap, mm");
    for view in json["bufferViews"].as_array().expect("views") {
        assert_eq!(view["byteOffset"].as_u64().expect("an offset") % 4, 0);
    }
}

#[test]
fn obj_numbers_its_vertices_through_all_parts() {
    let file = String::from_utf8(written(MeshFormat::Obj)).expect("text");
    let lines = |start: &str| file.lines().filter(|line| line.starts_with(start)).collect::<Vec<_>>();
    assert_eq!((lines("o ").len(), lines("v ").len(), lines("vt ").len(), lines("f ").len()), (2, 8, 4, 8));
    assert_eq!(lines("v ")[1], "v 1.0000000 0.0000000 0.0000000 1.0000 0.0000 0.2000");
    assert_eq!((lines("f ")[0], lines("f ")[4]), ("f 1 3 2", "f 5/1 7/3 6/2"));
}

#[test]
fn ply_is_read_back() {
    use ply_rs_bw::ply::{DefaultElement, Property};
    let file = written(MeshFormat::Ply);
    let ply = ply_rs_bw::parser::Parser::<DefaultElement>::new().read_ply(&mut file.as_slice()).expect("a PLY file");
    let vertices = &ply.payload["vertex"];
    assert_eq!((vertices.len(), ply.payload["face"].len()), (8, 8));
    assert_eq!(vertices[5]["x"], Property::Float(1.0));
    assert_eq!((&vertices[5]["value"], &vertices[5]["part"]), (&Property::Float(2.0), &Property::UChar(1)));
    assert_eq!(vertices[5]["blue"], Property::UChar(51));
    assert!(matches!(vertices[0]["value"], Property::Float(value) if value.is_nan()));
    assert_eq!(ply.payload["face"][4]["vertex_indices"], Property::ListUInt(vec![4, 6, 5]));
}

#[test]
fn stl_holds_every_triangle_with_its_normal_and_colour() {
    let file = written(MeshFormat::Stl);
    assert_eq!(file.len(), 84 + 8 * 50);
    assert_eq!(u32::from_le_bytes(file[80..84].try_into().expect("four bytes")), 8);
    let normal = &file[84..96];
    assert_eq!(normal, [0.0_f32, 0.0, -1.0].map(f32::to_le_bytes).concat());
    let colour = u16::from_le_bytes([file[132], file[133]]);
    assert_eq!((colour >> 15, colour >> 10 & 31, colour >> 5 & 31, colour & 31), (1, 31, 0, 51 >> 3));
}
