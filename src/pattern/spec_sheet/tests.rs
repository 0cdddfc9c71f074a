//! Sheets as buyers write them, beside drafted patterns.

use rust_xlsxwriter::{Format, Workbook as Writer, Worksheet, XlsxError};

use super::compared::{SpecLine, Verdict, lines};
use super::matching::{Matching, RowMatch, matched};
use super::*;
use crate::Style;
use crate::draft::Model;
use crate::pom::Measure;
use geom::units::mm;

/// Lengths in the sizes of a drafted style, mm.
struct Drafted(Vec<Style>);

impl Drafted {
    fn of(model: Model) -> Self {
        let style = |draft: crate::draft::Draft| Style::read(&draft.pieces, model.seams(), "seams").expect("our own");
        Self(model.drafts().into_iter().map(style).collect())
    }

    fn lengths(&self, measure: Measure) -> Vec<Option<f64>> {
        self.0.iter().map(|style| style.lengths_of(&[measure])[0].map(mm)).collect()
    }
}

const SIZES: [&str; 3] = ["S", "M", "L"];

fn read_sheet(bytes: &[u8], file: &str) -> Result<SpecSheet, SheetError> {
    read(bytes, file, &SIZES.map(str::to_owned), SheetAsked::default())
}

/// Expects the point of each row: empty for a row that is asked for.
fn check_sheet(bytes: &[u8], file: &str, model: Model, unit: Unit, expect: &[(&str, &str)]) -> Vec<SpecLine> {
    let sheet = read_sheet(bytes, file).expect("a sheet");
    assert_eq!(sheet.sizes, SIZES, "{file}");
    let drafted = Drafted::of(model);
    let flat = |measure| drafted.lengths(measure);
    let matching = matched(&sheet, &flat, &[]).expect("it is matched");
    assert_eq!(matching.unit.unit, unit, "{file}: {}", matching.unit.why);
    let found: Vec<(&str, String)> =
        sheet.rows.iter().zip(&matching.rows).map(|(row, found)| (&*row.code, name(found))).collect();
    let expect: Vec<(&str, String)> = expect.iter().map(|(code, point)| (*code, (*point).to_owned())).collect();
    assert_eq!(found, expect, "{file}: {:#?}", matching.rows);
    let matched = found.iter().filter(|(_, point)| !point.is_empty()).count();
    assert!(5 * matched >= 4 * found.len(), "{file}: {matched} of {} rows", found.len());
    lines(&sheet, &matching, &flat)
}

fn name(found: &RowMatch) -> String {
    if let RowMatch::Is(target, _) = found { target.to_string() } else { String::new() }
}

const INCHES: &str = "\
Style:,TS-1042,,Season:,SS27,,
Spec sheet - all measurements in inches,,,,,,
,,,,,,
POM,Description,Tol (+/-),S,M,L,Remarks
BODY,,,,,,
A,\"1/2 Chest - 1\"\" below armhole\",1/2,19 1/8,20 3/8,21 1/2,
B,\"Waist width - 17\"\" down from HPS\",1/2,19,20-1/4,21½,
C,Bottom sweep,1/2,\"19 1/8\"\"\",\"20 3/8\"\"\",\"21 1/2\"\"\",relaxed
D,Front body length from HPS,1/2,28 5/8,29 1/4,29 3/4,
E,C.B. length,1/2,27.75,28 3/8,28 7/8,
F,Across shoulder,3/8,17 7/8,18 5/8,19 1/4,
G,\"Across front - 5\"\" below high point shoulder\",3/8,15 7/8,16 5/8,17 3/8,
H,X-back (mid armhole),3/8,15 1/2,16 1/8,16 3/4,
I,Shoulder seam length,1/4,6 1/8,6 1/2,6 7/8,
SLEEVE,,,,,,
J,Sleeve length from shoulder,3/8,9 1/4,9 3/4,10 1/4,
K,\"Bicep 1\"\" below A/H\",1/4,8 1/8,8 1/2,9,
L,Sleeve opening,1/4,7,7 1/4,7 3/8,
M,Armhole curve,3/8,19 7/8,20 3/4,21 3/4,
NECK,,,,,,
N,Neck width (seam to seam),1/4,6 1/4,6 1/4,6 1/4,
O,Front neck drop - HPS to seam,1/8,6 7/8,7 1/8,7 3/8,
P,Back neck drop,1/8,7/8,7/8,7/8,
Q,Neck rib height,1/8,3/4,3/4,3/4,
R,Minimum neck stretched,,13,13 1/4,13 1/2,do not go under
Measure the garment flat and relaxed,,,,,,
";

fn inches() -> Vec<SpecLine> {
    let expect = [
        ("A", "half_chest"),
        ("B", "half_below_hps@431.8"),
        ("C", "half_hem"),
        ("D", "front_length"),
        ("E", "centre_back_length"),
        ("F", "across_shoulder"),
        ("G", "across_front_below_hps@127"),
        ("H", "across_back"),
        ("I", "shoulder"),
        ("J", "sleeve_length"),
        ("K", "half_bicep"),
        ("L", "half_cuff"),
        ("M", "armhole"),
        ("N", "neck_width"),
        ("O", "front_neck_drop"),
        ("P", "back_neck_drop"),
        ("Q", ""),
        ("R", ""),
    ];
    check_sheet(INCHES.as_bytes(), "tee.csv", Model::Tshirt, Unit::In, &expect)
}

fn write_rows(sheet: &mut Worksheet, from: u32, rows: &[(&[&str], &[f64])]) -> Result<(), XlsxError> {
    for (row, (texts, lengths)) in (from..).zip(rows) {
        for (column, text) in (0..).zip(*texts).filter(|(_, text)| !text.is_empty()) {
            sheet.write(row, column, *text)?;
        }
        for (column, length) in (texts.len() as u16..).zip(*lengths) {
            sheet.write(row, column, *length)?;
        }
    }
    Ok(())
}

/// Centimetres: a cover sheet, merged titles and notes, tolerances in two columns.
fn trousers() -> Result<Vec<u8>, XlsxError> {
    let mut book = Writer::new();
    book.add_worksheet().set_name("Cover")?.write(0, 0, "Style TR-7, measurements in the next sheet")?;
    let sheet = book.add_worksheet().set_name("Measurements")?;
    let format = Format::new();
    sheet.merge_range(0, 0, 0, 7, "TROUSERS TR-7 - SPECIFICATION", &format)?;
    sheet.merge_range(1, 0, 1, 7, "All measurements in cm. Measure flat, waist relaxed.", &format)?;
    let heads = ["Code", "Point of measure", "Tol +", "Tol -", "S", "M", "L", "Comments"];
    write_rows(sheet, 3, &[(&heads, &[])])?;
    sheet.merge_range(4, 0, 4, 7, "WAIST AND SEAT", &format)?;
    let rows: [(&[&str], &[f64]); 8] = [
        (&["1", "Waist circumference (relaxed)"], &[1.0, 1.0, 98.0, 100.0, 103.0]),
        (&["2", "Hip 8 cm above crotch"], &[1.5, 1.0, 102.0, 104.0, 107.0]),
        (&["3", "Hip width 18 cm below waist"], &[1.0, 1.0, 53.5, 55.0, 55.0]),
        (&["4", "Waistband height"], &[0.2, 0.2, 4.0, 4.0, 4.0]),
        (&["5", "Front rise (incl. waistband)"], &[0.5, 0.5, 24.0, 24.0, 25.0]),
        (&["6", "Back rise (incl. WB)"], &[0.5, 0.5, 35.5, 36.0, 37.5]),
        (&["", "see sketch 2 for the leg"], &[]),
        (&["7", "Inside leg"], &[1.0, 1.0, 72.0, 75.0, 79.0]),
    ];
    write_rows(sheet, 5, &rows)?;
    let legs: [(&[&str], &[f64]); 5] = [
        (&["8", "Outseam"], &[1.0, 1.0, 95.5, 98.5, 104.0]),
        (&["9", "1/2 Thigh 2.5 cm below crotch"], &[0.7, 0.7, 32.5, 33.5, 34.5]),
        (&["10", "1/2 Knee, 36cm from crotch"], &[0.7, 0.7, 24.0, 24.0, 25.0]),
        (&["11", "Leg opening"], &[0.5, 0.5, 22.0, 22.0, 24.0]),
        (&["12", "Fly length"], &[0.5, 0.5, 16.0, 16.0, 17.0]),
    ];
    write_rows(sheet, 13, &legs)?;
    sheet.merge_range(19, 0, 19, 7, "Shrinkage max. 3 %", &format)?;
    book.save_to_buffer()
}

/// T-shirt in German words: heads in two rows, a tolerance that merged cells share, no unit.
fn german() -> Result<Vec<u8>, XlsxError> {
    let mut book = Writer::new();
    let sheet = book.add_worksheet().set_name("Maßtabelle")?;
    let format = Format::new();
    sheet.merge_range(0, 0, 1, 6, "T-Shirt, Maße flach liegend gemessen", &format)?;
    sheet.merge_range(3, 0, 4, 0, "Nr.", &format)?;
    sheet.merge_range(3, 1, 4, 1, "Bezeichnung", &format)?;
    sheet.merge_range(3, 2, 4, 2, "Toleranz +/-", &format)?;
    sheet.merge_range(3, 3, 3, 5, "Größen", &format)?;
    write_rows(sheet, 4, &[(&["", "", "", "S", "M", "L"], &[])])?;
    let rows: [(&[&str], &[f64]); 11] = [
        (&["1", "1/2 Brustweite", ""], &[48.5, 51.5, 54.5]),
        (&["2", "1/2 Saumweite", ""], &[48.5, 51.5, 54.5]),
        (&["3", "Rückenlänge ab Schulter", ""], &[72.5, 74.0, 75.5]),
        (&["4", "Schulterbreite", "0,3"], &[15.5, 16.5, 17.5]),
        (&["5", "Ärmellänge", "0,5"], &[23.5, 25.0, 26.0]),
        (&["6", "1/2 Oberarmweite", "0,5"], &[20.5, 22.0, 23.0]),
        (&["7", "1/2 Ärmelsaum", "0,5"], &[18.0, 18.5, 19.0]),
        (&["8", "Armlochumfang", "1"], &[50.5, 52.5, 55.0]),
        (&["9", "Halstiefe vorne", "0,5"], &[17.5, 18.0, 18.5]),
        (&["10", "Gesamtlänge", "1"], &[72.5, 74.0, 75.5]),
        (&["11", "Taillenweite 43 ab Schulter", "1"], &[48.5, 51.5, 54.5]),
    ];
    write_rows(sheet, 5, &rows)?;
    sheet.merge_range(5, 2, 7, 2, "±1", &format)?;
    sheet.write(17, 0, "Änderungen vorbehalten")?;
    book.save_to_buffer()
}

#[test]
fn rows_of_three_sheets_are_matched_and_the_others_asked() {
    inches();
    let expect = [
        ("1", "2*half_waist"),
        ("2", "2*half_hip"),
        ("3", "half_below_waist@180"),
        ("4", ""),
        ("5", "front_rise"),
        ("6", "back_rise"),
        ("7", "inseam"),
        ("8", "outseam"),
        ("9", "half_thigh"),
        ("10", "half_below_fork@360"),
        ("11", "half_leg_opening"),
        ("12", ""),
    ];
    let found = check_sheet(&trousers().expect("written"), "tr-7.xlsx", Model::Trousers, Unit::Cm, &expect);
    assert_eq!((found[3].plus_mm, found[3].minus_mm), (Some(15.0), Some(10.0)), "of two columns");
    let expect = [
        ("1", "half_chest"),
        ("2", "half_hem"),
        ("3", "back_length"),
        ("4", "shoulder"),
        ("5", "sleeve_length"),
        ("6", "half_bicep"),
        ("7", "half_cuff"),
        ("8", "armhole"),
        ("9", "front_neck_drop"),
        ("10", ""),
        ("11", "half_below_hps@430"),
    ];
    let found = check_sheet(&german().expect("written"), "masse.xlsx", Model::Tshirt, Unit::Cm, &expect);
    assert_eq!([&found[0], &found[8], &found[9]].map(|line| line.plus_mm), [Some(10.0), Some(10.0), Some(3.0)]);
}

#[test]
fn deviations_are_those_by_hand() {
    let lines = inches();
    // Lengths of the draft less inches at 25.4 mm, and the verdict of the tolerance.
    let check = |code: &str, size: &str, spec_mm: f64, deviation_mm: f64, is_in: Option<bool>| {
        let line = lines.iter().find(|line| line.code == code && line.size == size).expect("a line");
        let off = line.deviation_mm.expect("a flat length") - deviation_mm;
        assert!((line.spec_mm - spec_mm).abs() < 1e-9 && off.abs() < 0.1, "{code} {size}: {line:?}");
        assert_eq!(line.verdict.map(|verdict| verdict == Verdict::In), is_in, "{code} {size}: {line:?}");
    };
    check("A", "S", 485.775, 487.05 - 485.775, Some(true));
    check("A", "L", 546.1, 547.05 - 546.1, Some(true));
    check("B", "M", 514.35, 517.05 - 514.35, Some(true));
    check("D", "M", 742.95, 741.96 - 742.95, Some(true));
    check("D", "L", 755.65, 756.96 - 755.65, Some(true));
    check("E", "S", 704.85, 704.96 - 704.85, Some(true));
    check("I", "M", 165.1, 166.01 - 165.1, Some(true));
    check("L", "L", 187.325, 188.27 - 187.325, Some(true));
    check("M", "L", 552.45, 551.55 - 552.45, Some(true));
    check("O", "S", 174.625, 704.96 + 22.0 - 550.76 - 174.625, Some(true));
    check("P", "S", 22.225, 22.0 - 22.225, Some(true));
    let judged = |flat_mm: f64, minus: Option<f64>, plus: f64| {
        let line = SpecLine {
            spec_mm: 500.0,
            flat_mm: Some(flat_mm),
            minus_mm: minus,
            plus_mm: Some(plus),
            ..SpecLine::default()
        };
        line.judged().verdict
    };
    assert_eq!(judged(506.0, Some(2.0), 5.0), Some(Verdict::Out));
    assert_eq!(judged(505.0, Some(2.0), 5.0), Some(Verdict::In));
    assert_eq!(judged(497.9, Some(2.0), 5.0), Some(Verdict::Out));
    assert_eq!(judged(500.0, None, 5.0), None);
    let steps: Vec<Option<f64>> = lines.iter().filter(|line| line.code == "A").map(|line| line.step_mm).collect();
    assert_eq!(steps[0], None);
    assert!((steps[1].expect("a step") - 31.75).abs() < 1e-9 && (steps[2].expect("a step") - 28.575).abs() < 1e-9);
}

fn one_row(description: &str, lengths: [f64; 3], head: &str) -> RowMatch {
    let text = format!("code,description,{head}S,M,L\nA,{description},{},{},{}\n", lengths[0], lengths[1], lengths[2]);
    let sheet = read_sheet(text.as_bytes(), "a.csv").expect("a sheet");
    let drafted = Drafted::of(Model::Tshirt);
    let flat = |measure| drafted.lengths(measure);
    let unit = SheetAsked { sheet: None, unit: Some(Unit::Cm) };
    let sheet = SpecSheet { unit: read(text.as_bytes(), "a.csv", &[], unit).expect("a sheet").unit, ..sheet };
    let Matching { mut rows, .. } = matched(&sheet, &flat, &[]).expect("matched");
    rows.remove(0)
}

#[test]
fn columns_are_found_among_others() {
    let check = |text: &str, sizes: &[&str], plus: Option<f64>, codes: &[&str]| {
        let sheet = read_sheet(text.as_bytes(), "a.csv").expect(text);
        let found: Vec<&str> = sheet.rows.iter().map(|row| row.code.as_str()).collect();
        assert_eq!(
            (&sheet.sizes[..], sheet.rows[0].plus, &found[..]),
            (&sizes.iter().map(ToString::to_string).collect::<Vec<_>>()[..], plus, codes),
            "{text}"
        );
    };
    check("description,S,M\nChest,20,21\n", &["S", "M"], None, &["r2"]);
    check("Ref,4711,,\n,,,\n#,Measurement,Grade,Size M\n1,Chest,1,20\n1,Hem,1,20\n", &["M"], None, &["1", "r5"]);
    check(",,Graded sizes,,Actual,\nPOM,Description,S,M,S,M\nA,Chest,20,21,19,20\n", &["S", "M"], None, &["A"]);
    check("No.;Description;Tol. (+);Tol. (-);36;38\nA;Chest;1,5;0,5;50,5;52\n", &["36", "38"], Some(1.5), &["A"]);
    check("Code,Point of Measure,Spec,Comments\nA,Chest,20,x\nB,see sketch,,\n", &["Spec"], None, &["A"]);
    check("pom,s,m\nChest,20,21\npom,s,m\nHem,20,21\n", &["s", "m"], None, &["r2", "r4"]);
}

#[test]
fn what_is_unsure_is_asked() {
    let check = |description: &str, lengths: [f64; 3], expect: Result<&str, &str>| match (
        one_row(description, lengths, ""),
        expect,
    ) {
        (RowMatch::Is(target, _), Ok(point)) => assert_eq!(target.to_string(), point, "{description}"),
        (RowMatch::Asked { why, .. }, Err(reason)) => assert!(why.contains(reason), "{description}: {why}"),
        (found, _) => panic!("{description}: {found:?}"),
    };
    check("Chest", [48.7, 51.7, 54.7], Ok("half_chest"));
    check("Chest", [97.4, 103.4, 109.4], Ok("2*half_chest"));
    check("Chest circumference", [97.4, 103.4, 109.4], Ok("2*half_chest"));
    check("Shoulder", [45.5, 47.0, 49.0], Ok("across_shoulder"));
    check("Shoulder", [15.5, 16.5, 17.5], Ok("shoulder"));
    check("Body length", [72.7, 74.2, 75.7], Ok("front_length"));
    check("Body length", [70.5, 72.0, 73.5], Ok("centre_back_length"));
    check("Armhole 1/2", [25.2, 26.4, 27.6], Ok("0.5*armhole"));
    check("1/2 armhole", [25.2, 26.4, 27.6], Ok("0.5*armhole"));
    check("Chest circumference", [48.7, 51.7, 54.7], Err("its words say half_chest, and its lengths do not fit"));
    check("Chest", [20.0, 20.0, 20.0], Err("do not fit"));
    check("Chest pocket width", [12.0, 12.0, 12.0], Err("not all of its words"));
    check("Inseam", [72.0, 74.0, 79.0], Err("inseam, which the pattern does not have"));
    check("Hem stretched", [60.0, 62.0, 64.0], Err("a stretched length is not measured"));
    check("Dots per inch", [1.0, 1.0, 1.0], Err("no point that is measured"));
}

#[test]
fn answers_are_taken_and_wrong_ones_refused() {
    let sheet = read_sheet(INCHES.as_bytes(), "tee.csv").expect("a sheet");
    let drafted = Drafted::of(Model::Tshirt);
    let flat = |measure| drafted.lengths(measure);
    let outcome = |answer: &str| -> Result<Vec<RowMatch>, String> {
        let answer = answer.parse()?;
        matched(&sheet, &flat, &[answer]).map(|found| found.rows).map_err(|error| error.to_string())
    };
    let row = |answer: &str, index: usize| name(&outcome(answer).expect("an answer")[index]);
    assert_eq!(row("a=2*half_chest", 0), "2*half_chest");
    assert_eq!(row("A=half_below_armhole@100", 0), "half_below_armhole@100");
    assert_eq!(outcome("Q=none").expect("an answer")[16], RowMatch::None);
    for (wrong, expect) in [
        ("Z=half_chest", "there is no row `Z`; accepted: one of A, B"),
        ("A=bust", "half_chest, half_waist"),
        ("A=half_below_armhole@far", "a distance of 0 to 2000 mm from one of half_below_armhole"),
        ("A", "CODE=POINT"),
    ] {
        let told = outcome(wrong).expect_err(wrong);
        assert!(told.contains(expect), "{wrong}: {told}");
    }
}

#[test]
fn a_unit_that_neither_words_nor_lengths_tell_is_asked() {
    let drafted = Drafted::of(Model::Tshirt);
    let flat = |measure| drafted.lengths(measure);
    let check = |lengths: [&str; 3], expect: Result<(Unit, &str), &str>| {
        let text = format!("code,description,S,M,L\nA,CB length,{}\n", lengths.join(","));
        let sheet = read_sheet(text.as_bytes(), "a.csv").expect("a sheet");
        match (matched(&sheet, &flat, &[]), expect) {
            (Ok(found), Ok((unit, why))) => {
                assert!(found.unit.unit == unit && found.unit.why.contains(why), "{:?}", found.unit);
            }
            (Err(error), Err(told)) => assert!(error.to_string().contains(told), "{error}"),
            (found, _) => panic!("{found:?}"),
        }
    };
    check(["70.5", "72", "73.5"], Ok((Unit::Cm, "no unit is written")));
    check(["705", "720", "735"], Ok((Unit::Mm, "no unit is written")));
    check(["27.75", "28.35", "28.9"], Ok((Unit::In, "no unit is written")));
    check(["27 3/4", "28 3/8", "28 7/8"], Ok((Unit::In, "fractions")));
    check(["44", "45", "46"], Err("a.csv: found no unit"));
}

#[test]
fn wrong_sheets_are_refused_with_their_cell() {
    let check = |text: &str, expect: &str| {
        let told = read_sheet(text.as_bytes(), "a.csv").expect_err(text).to_string();
        assert!(told.contains(expect), "{told}");
    };
    check("", "a.csv: found no table of lengths");
    check("a,b\n1,2\n", "a.csv: found no table of lengths");
    check("code,description,S,M\nA,Chest,20,2 x 2\nB,Hem,20,21\n", "a.csv, cell D2: found `2 x 2`; accepted: a length");
    check("code,description,tol,S\nA,Chest,much,20\n", "a.csv, cell C2: found `much`; accepted: a tolerance");
    check("code,description,S\nA,Chest,20\nB,Hem,46024\n", "a.csv, cell C3: found 46024, a date");
    check("PK\u{3}\u{4}", "a ZIP archive that is cut off");
    let book = trousers().expect("written");
    let asked = |sheet| read(&book, "b.xlsx", &[], SheetAsked { sheet: Some(sheet), unit: None });
    assert!(asked("measurements").is_ok());
    assert_eq!(
        asked("Sizes").expect_err("not there").to_string(),
        "b.xlsx: found no sheet `Sizes`; accepted: one of Cover, Measurements"
    );
}

proptest::proptest! {
    #![proptest_config(proptest::prelude::ProptestConfig::with_cases(128))]

    #[test]
    fn damaged_sheets_never_panic(
        edits in proptest::collection::vec((0.0..1.0_f64, proptest::num::u8::ANY), 1..9), share in 0.3..1.0_f64,
    ) {
        let mut bytes = INCHES.as_bytes().to_vec();
        for (share, byte) in edits {
            let index = (share * bytes.len() as f64) as usize;
            bytes[index] = byte;
        }
        bytes.truncate((share * 2.0 * bytes.len() as f64) as usize);
        let _ = read_sheet(&bytes, "a.csv");
    }
}
