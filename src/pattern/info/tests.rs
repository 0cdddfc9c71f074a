use std::io::Write as _;

use flate2::Compression;
use flate2::write::DeflateEncoder;

use super::*;
use crate::draft::{TshirtSize, tshirt};
use crate::dxf;

const CSV: &str = "Piece,Quantity,Material,Role,Grain_deg,Interlining\n\
Front,1,Jersey,front,90,\nback,1,Jersey,back,,\n\"SLEEVE\",\"1,1\",\"Rib, fine\",sleeve_left,,fused\n";

fn shirt() -> PatternFile {
    dxf::read(&tshirt(TshirtSize::M).dxf(), "tshirt.dxf", None).expect("our own file")
}

fn told(bytes: &[u8]) -> Result<PatternFile, InfoError> {
    let mut pattern = shirt();
    pattern.pieces[0].grain = None;
    read(bytes, "pieces.csv")?.merge(&mut pattern)?;
    Ok(pattern)
}

fn text<'a>(piece: &'a Piece, key: &str) -> Option<&'a str> {
    piece.texts.iter().find(|(found, _)| found.eq_ignore_ascii_case(key)).map(|(_, value)| value.as_str())
}

fn check_shirt(pattern: &PatternFile) {
    let [front, back, sleeve] = &pattern.pieces[..] else { panic!("three pieces") };
    assert_eq!(
        (text(front, "Material"), text(back, "Role"), text(front, "Interlining")),
        (Some("Jersey"), Some("back"), None)
    );
    assert_eq!((sleeve.quantity.as_deref(), text(sleeve, "Material")), (Some("1,1"), Some("Rib, fine")));
    assert_eq!(text(sleeve, "Interlining"), Some("fused"));
    assert_eq!(sleeve.texts.iter().filter(|(key, _)| key == "Material").count(), 1);
    let [from, to] = front.grain.expect("from the table");
    assert!((to - from).x.abs() < 1e-12 && (to - from).y > 0.2);
    assert_eq!(back.grain, shirt().pieces[1].grain);
}

#[test]
fn a_table_tells_the_pieces() {
    check_shirt(&told(CSV.as_bytes()).expect("it fits"));
    let semicolons =
        CSV.replace("\"1,1\"", "1+1").replace("\"Rib, fine\"", "Rib").replace(',', ";").replace("1+1", "1,1");
    let pattern = told(semicolons.as_bytes()).expect("it fits");
    assert_eq!(pattern.pieces[2].quantity.as_deref(), Some("1,1"));
    let of_size = told(b"piece,size,fabric\nFRONT,M,twill\n").expect("it fits");
    assert_eq!(text(&of_size.pieces[0], "fabric"), Some("twill"));
}

#[test]
fn wrong_tables_are_refused_with_row_and_column() {
    let check = |bytes: &[u8], row: Option<usize>, column: Option<&str>, expect: &str| {
        let error = told(bytes).expect_err(expect);
        let told = error.to_string();
        assert!(told.contains(expect) && !error.accepted.is_empty(), "{told}");
        assert_eq!((error.row, error.column.as_deref()), (row, column), "{told}");
    };
    check(b"", None, None, "an empty table");
    check(b"part,quantity\nFRONT,1\n", Some(1), None, "columns part, quantity");
    check(b"piece,a,A\nFRONT,1,2\n", Some(1), None, "column `A` twice");
    check(
        b"piece,quantity\nFRONT,1\nCOLLAR,1\n",
        Some(3),
        Some("piece"),
        "piece `COLLAR`; accepted: one of FRONT, BACK",
    );
    check(b"piece,quantity\nFRONT,1\nfront,1\n", Some(3), Some("piece"), "again, first in row 2");
    check(b"piece,quantity\n\nFRONT,two\n", Some(3), Some("quantity"), "`two`");
    check(b"piece,grain_deg\nFRONT,up\n", Some(2), Some("grain_deg"), "`up`");
    check(b"piece,role\nFRONT,hood\n", Some(2), Some("role"), "`hood`; accepted: front, back");
    check(b"piece,size\nFRONT,XL\n", Some(2), Some("piece"), "piece `FRONT` of size `XL`");
    check(b"piece,quantity\nFRONT\n", Some(2), None, "1 cells, where the row of column names has 2; accepted: CSV");
    check(b"piece\r\n\r\n\xff\r\n", Some(3), None, "no UTF-8");
    check(b"piece,quantity\r\nFRONT,1\r\nBACK,two\r\n", Some(3), Some("quantity"), "`two`");
    check(b"piece,note,quantity\r\nFRONT,\"a\r\nb\",1\r\n\r\nBACK,,two\r\n", Some(5), Some("quantity"), "`two`");
    check(b"PK\x03\x04and no more", None, None, "cut off");
}

fn workbook(parts: &[(&str, String)]) -> Vec<u8> {
    let (mut bytes, mut central) = (Vec::new(), Vec::new());
    for (k, (name, text)) in parts.iter().enumerate() {
        let method: u16 = if k % 2 == 0 { 8 } else { 0 };
        let mut packed = text.as_bytes().to_vec();
        if method == 8 {
            let mut encoder = DeflateEncoder::new(Vec::new(), Compression::default());
            encoder.write_all(text.as_bytes()).expect("memory");
            packed = encoder.finish().expect("memory");
        }
        let offset = bytes.len() as u32;
        let sizes = [0_u32, packed.len() as u32, text.len() as u32].map(u32::to_le_bytes).concat();
        let head =
            |start: &[u8]| [start, &method.to_le_bytes(), &[0; 4], &sizes, &(name.len() as u16).to_le_bytes()].concat();
        bytes.extend([&head(b"PK\x03\x04\x14\0\0\0")[..], &[0; 2], name.as_bytes(), &packed].concat());
        let more = [&[0; 12][..], &offset.to_le_bytes(), name.as_bytes()].concat();
        central.extend([&head(b"PK\x01\x02\x14\0\x14\0\0\0")[..], &more].concat());
    }
    let at = bytes.len() as u32;
    let count = (parts.len() as u16).to_le_bytes();
    let end =
        [b"PK\x05\x06\0\0\0\0", &count[..], &count, &(central.len() as u32).to_le_bytes(), &at.to_le_bytes(), &[0; 2]];
    [bytes, central, end.concat()].concat()
}

fn excel() -> Vec<u8> {
    let mut rows = String::new();
    let mut shared: Vec<String> = Vec::new();
    let mut reader = csv::ReaderBuilder::new().has_headers(false).from_reader(CSV.as_bytes());
    for (r, record) in reader.records().enumerate() {
        rows += &format!("<row r=\"{}\">", r + 1);
        for (c, cell) in record.expect("CSV").iter().enumerate().filter(|(_, cell)| !cell.is_empty()) {
            let name = format!("{}{}", char::from(b'A' + c as u8), r + 1);
            rows += &match (cell.parse::<f64>(), c) {
                (Ok(_), _) => format!("<c r=\"{name}\"><v>{cell}</v></c>"),
                (Err(_), 2) => format!("<c r=\"{name}\" t=\"inlineStr\"><is><t>{cell}</t></is></c>"),
                _ => {
                    shared.push(format!("<si><r><t>{}</t></r><r><t>{}</t></r></si>", &cell[..1], &cell[1..]));
                    format!("<c r=\"{name}\" t=\"s\"><v>{}</v></c>", shared.len() - 1)
                }
            };
        }
        rows += "</row>";
    }
    let main = "xmlns=\"http://schemas.openxmlformats.org/spreadsheetml/2006/main\"";
    let relations = "xmlns:r=\"http://schemas.openxmlformats.org/officeDocument/2006/relationships\"";
    workbook(&[
        (
            "xl/workbook.xml",
            format!(
                "<workbook {main} {relations}><sheets><sheet name=\"a\" sheetId=\"7\" r:id=\"rId3\"/></sheets></workbook>"
            ),
        ),
        (
            "xl/_rels/workbook.xml.rels",
            "<Relationships><Relationship Id=\"rId3\" Target=\"worksheets/sheet7.xml\"/></Relationships>".to_owned(),
        ),
        ("xl/sharedStrings.xml", format!("<sst {main}>{}</sst>", shared.concat())),
        ("xl/worksheets/sheet7.xml", format!("<worksheet {main}><sheetData>{rows}</sheetData></worksheet>")),
    ])
}

#[test]
fn a_workbook_tells_the_same() {
    check_shirt(&told(&excel()).expect("it fits"));
}

proptest::proptest! {
    #![proptest_config(proptest::prelude::ProptestConfig::with_cases(256))]

    #[test]
    fn damaged_tables_never_panic(
        is_excel in proptest::bool::ANY,
        edits in proptest::collection::vec((0.0..1.0_f64, proptest::num::u8::ANY), 1..6),
        share in 0.5..1.0_f64,
    ) {
        let mut bytes = if is_excel { excel() } else { CSV.as_bytes().to_vec() };
        for (share, byte) in edits {
            let index = (share * bytes.len() as f64) as usize;
            bytes[index] = byte;
        }
        bytes.truncate((share * 2.0 * bytes.len() as f64) as usize);
        let _ = told(&bytes);
    }
}
