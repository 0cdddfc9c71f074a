//! The catalogue as a user changes it, on a real database.

use body::{Dimension, Measurements, Sex};
use spec::patterns;
use std::path::PathBuf;
use store::{Store, files};

use super::*;
use geom::units::from_mm;
use store::files::SourceFile;
use store::{Access, sql};

struct Bench {
    folder: tempfile::TempDir,
    store: Store,
}

impl Bench {
    fn new() -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        let store = open(&folder.path().join("toile.sqlite"), false).expect("a new database");
        Self { folder, store }
    }

    fn write(&self, name: &str, text: &str) -> PathBuf {
        let path = self.folder.path().join(name);
        std::fs::write(&path, text).expect("writable");
        path
    }

    fn subject(&mut self, mode: Mode, name: &str, given: &[(&str, &str)]) -> std::result::Result<Deed, String> {
        let given: Vec<Given> = given.iter().map(|(key, text)| ((*key).to_owned(), (*text).to_owned())).collect();
        save_subject(&mut self.store, mode, name, &given).map(|saved| saved.deed).map_err(|error| error.to_string())
    }

    /// Imports a file; an error without the folder's name.
    fn import(&mut self, part: Part, name: &str, text: &str) -> std::result::Result<Vec<(String, Deed)>, String> {
        let path = self.write(name, text);
        let prefix = format!("{}/", self.folder.path().display());
        match import(&mut self.store, part, &[path], Strictness::AllOrNone) {
            Ok(done) => Ok(done.saved.into_iter().map(|saved| (saved.name, saved.deed)).collect()),
            Err(error) => Err(error.to_string().replace(&prefix, "")),
        }
    }

    fn one(&self, sql: &str) -> String {
        sql::query(&self.store, sql)
            .expect("valid")
            .rows
            .iter()
            .flatten()
            .map(ToString::to_string)
            .collect::<Vec<_>>()
            .join(",")
    }
}

const ANNA: [(&str, &str); 3] = [("sex", "f"), ("stature_mm", "1650"), ("waist_girth_mm", "700")];

#[test]
fn an_edit_is_a_revision_and_known_content_is_current_again() {
    let mut bench = Bench::new();
    assert_eq!(bench.subject(Mode::Add, "anna", &ANNA), Ok(Deed::Added));
    assert_eq!(bench.subject(Mode::Edit, "anna", &[("waist_girth_mm", "720")]), Ok(Deed::Revised));
    assert_eq!(bench.subject(Mode::Edit, "anna", &[("waist_girth_mm", "720")]), Ok(Deed::Unchanged));
    assert_eq!(bench.one("SELECT waist_girth_mm FROM v_subjects WHERE subject = 'anna' ORDER BY revision"), "700,720");
    assert_eq!(bench.subject(Mode::Edit, "anna", &[("waist_girth_mm", "700")]), Ok(Deed::Restored));
    assert_eq!(
        subject(&bench.store, "anna").expect("there").measurements.get(Dimension::WaistGirth),
        Some(from_mm(700.0))
    );
    assert_eq!(bench.one("SELECT revision FROM v_subjects WHERE subject = 'anna' AND is_latest"), "1");
}

#[test]
fn names_that_are_taken_unknown_or_odd_are_refused() {
    let mut bench = Bench::new();
    let mut check = |mode, name: &str, expected: &str| {
        let error = bench.subject(mode, name, &ANNA).expect_err(name);
        assert!(error.contains(expected), "{error}");
    };
    check(Mode::Add, "male-ii", "there is a subject `male-ii` already; edit it, or take another name");
    check(Mode::Edit, "male-iv2", "did you mean `male-iv`?");
    check(Mode::Add, "", "1 to 64 characters");
    check(Mode::Add, "a/b", "no `/`");
    check(Mode::Add, "anna ", "no space at either end");
}

#[test]
fn bodies_that_cannot_be_are_refused_and_rare_ones_are_told() {
    let mut bench = Bench::new();
    let error = bench.subject(Mode::Add, "anna", &[("sex", "f"), ("stature_mm", "165"), ("hip_girth_mm", "x")]);
    let error = error.expect_err("too small");
    assert!(
        error.starts_with("subject anna: `stature_mm` is 165; accepted: 1300 to 2200; `hip_girth_mm` is `x`"),
        "{error}"
    );
    let rare = [("sex", "f"), ("stature_mm", "1450")].map(|(key, text)| (key.to_owned(), text.to_owned()));
    let saved = save_subject(&mut bench.store, Mode::Add, "small", &rare).expect("possible");
    let [doubt] = saved.doubts.as_slice() else { panic!("{:?}", saved.doubts) };
    assert!(doubt.starts_with("stature_mm = 1450 is doubtful: percentile 0.2"), "{doubt}");
}

#[test]
fn what_is_built_in_gives_way_to_edits_for_good() {
    let mut bench = Bench::new();
    let path = bench.store.path().to_owned();
    assert_eq!(bench.subject(Mode::Edit, "male-ii", &[("stature_mm", "1700")]), Ok(Deed::Revised));
    let removed = remove(&mut bench.store, Part::Subject, "male-iv").expect("there");
    assert_eq!(removed.to_string(), "subject male-iv is hidden; it is built in");
    drop(bench.store);
    let store = open(&path, false).expect("there");
    assert_eq!(subject(&store, "male-ii").expect("there").measurements.stature_m(), 1.7);
    let names: Vec<String> = subjects(&store).expect("readable").into_iter().map(|row| row.name).collect();
    assert_eq!(names.len(), 11);
    assert!(!names.contains(&"male-iv".to_owned()));
}

#[test]
fn removed_entries_can_be_added_again() {
    let mut bench = Bench::new();
    bench.subject(Mode::Add, "anna", &ANNA).expect("new");
    assert_eq!(remove(&mut bench.store, Part::Subject, "anna").expect("there").to_string(), "subject anna is gone");
    assert_eq!(bench.one("SELECT count(*) FROM subject WHERE name = 'anna'"), "0");
    assert!(remove(&mut bench.store, Part::Subject, "anna").is_err());
    remove(&mut bench.store, Part::Subject, "male-ii").expect("there");
    assert!(bench.subject(Mode::Edit, "male-ii", &ANNA).expect_err("removed").contains("no subject"));
    assert_eq!(bench.subject(Mode::Add, "male-ii", &ANNA), Ok(Deed::Added));
}

#[test]
fn tables_are_imported_wholly_or_not_at_all() {
    let mut bench = Bench::new();
    let good = "\u{feff}name;sex;stature_mm;weight_kg;is_latest\nanna;f;1650;;1\nbo;m;1800;80;1\n";
    let done = bench.import(Part::Subject, "people.csv", good).expect("good");
    assert_eq!(done, [("anna".to_owned(), Deed::Added), ("bo".to_owned(), Deed::Added)]);
    let again = bench.import(Part::Subject, "people.csv", &good.replace("1650", "1660")).expect("good");
    assert_eq!(again.iter().map(|(_, deed)| *deed).collect::<Vec<_>>(), [Deed::Revised, Deed::Unchanged]);

    // Headings may be in words and in other units.
    let inches = "Name,Sex,Stature (cm),Chest Girth [in],weight_lb\ndora,f,165.5,36,132\n";
    bench.import(Part::Subject, "people.csv", inches).expect("good");
    let read = |key: &str| bench.one(&format!("SELECT {key} FROM subject WHERE name = 'dora'"));
    assert_eq!((read("stature_mm").as_str(), read("chest_girth_mm").as_str()), ("1655", "914.4"));
    let fractions = "name,sex,stature_in,chest_girth_in,hip_girth_cm\nerna,f,65,35 1/2,\"97,5\"\n";
    bench.import(Part::Subject, "people.csv", fractions).expect("good");
    let read = |key: &str| bench.one(&format!("SELECT {key} FROM subject WHERE name = 'erna'"));
    assert_eq!((read("chest_girth_mm").as_str(), read("hip_girth_mm").as_str()), ("901.7", "975"));
    let far = "name,sex,stature_in,chest_girth_in\ncleo,f,99,wide\n";
    assert_eq!(
        bench.import(Part::Subject, "people.csv", far).expect_err("bad"),
        "people.csv:2: column 3: `stature_in` is 99; accepted: 51.18 to 86.61\n\
         people.csv:2: column 4: `chest_girth_in` is `wide`, which is no number; accepted: 23.62 to 66.93"
    );

    let bad = "name,sex,stature_mm,waist_girth_mm\ncleo,f,1650,700\ndan,x,1.8,\ncleo,f,1660,710\neve,f,1650\n\"f/g\",f,1650,700\n";
    let error = bench.import(Part::Subject, "people.csv", bad).expect_err("bad");
    insta::assert_snapshot!(error);
    assert_eq!(bench.one("SELECT count(*) FROM subject WHERE name = 'cleo'"), "0");
    let error = bench.import(Part::Subject, "people.csv", "nam,sex,hight_mm,sex\n").expect_err("bad");
    insta::assert_snapshot!(error);
    let empty = bench.import(Part::Subject, "people.csv", "name,sex,stature_mm\n").expect_err("empty");
    assert_eq!(empty, "people.csv: no subject in it");
    assert!(bench.import(Part::Subject, "people.txt", "").expect_err("no format").contains("accepted: CSV"));
}

#[test]
fn study_files_are_imported_and_their_lines_told() {
    let mut bench = Bench::new();
    let text = "[[subject]]\nid = \"ii\"\nlike = \"male-ii\"\n\n[[subject]]\nid = \"anna\"\nsex = \"female\"\nstature_mm = 1650\n";
    let done = bench.import(Part::Subject, "study.toml", text).expect("good");
    assert_eq!(done.iter().map(|(name, _)| name.as_str()).collect::<Vec<_>>(), ["ii", "anna"]);
    let error = bench.import(Part::Subject, "study.toml", &text.replace("1650", "165")).expect_err("bad");
    assert_eq!(error, "study.toml:8:14: subject anna: `stature_mm` is 165; accepted: 1300 to 2200");

    let cloth = "[[fabric]]\nname = \"poplin\"\ndensity_kg_m2 = 0.1\nthickness_mm = 0.2\nmembrane_warp_n_m = 3000\nmembrane_weft_n_m = 2000\nshear_n_m = 90\nbending_warp_nm = 5e-6\nbending_weft_nm = 4e-6\nfriction_body = 0.3\nfriction_self = 0.5\n";
    bench.import(Part::Fabric, "cloth.toml", cloth).expect("good");
    let like =
        save_fabric(&mut bench.store, Mode::Add, "poplin_2", Some("poplin"), &[("shear_n_m".into(), "120".into())]);
    assert_eq!(like.expect("possible").deed, Deed::Added);
    assert_eq!(bench.one("SELECT shear_n_m, density_kg_m2 FROM v_fabrics WHERE fabric = 'poplin_2'"), "120,0.1");
    let stiff =
        save_fabric(&mut bench.store, Mode::Edit, "poplin", None, &[("membrane_coupling_n_m".into(), "3000".into())]);
    assert!(stiff.expect_err("not elastic").to_string().contains("below 2449.5"));
}

#[test]
fn what_follows_from_the_numbers_of_a_fabric_is_told_beside_them() {
    let mut bench = Bench::new();
    let told = |bench: &Bench, name: &str| {
        let sql = format!("SELECT * FROM v_fabrics WHERE fabric = '{name}' AND is_latest");
        let table = with_bending(sql::query(&bench.store, &sql).expect("valid"));
        let first = table.columns.iter().position(|column| column == "stands_for").expect("there");
        table.rows[0][first..].iter().map(ToString::to_string).collect::<Vec<_>>().join("; ")
    };
    let check = |bench: &Bench, name: &str, expect: &str| assert_eq!(told(bench, name), expect, "{name}");
    check(&bench, "denim_raw", "class; ; 25.4; 21.2; p75; p75; 14.9 to 30.3; 12.2 to 22.3");
    check(&bench, "cotton_broad", "one cloth; membrane, shear; 21.2; 21.2; p81; >p90; ; ");
    check(&bench, "interlock_tshirt", "one cloth; ; 14.7; 12.5; p21; p17; ; ");
    check(&bench, "thesis_10", "model; ; 1.7; 1.7; <p10; <p10; ; ");
    // An entry that somebody has changed counts as theirs, even under a built-in name.
    let given = [("bending_warp_nm".to_owned(), "1e-4".to_owned())];
    save_fabric(&mut bench.store, Mode::Edit, "denim_raw", None, &given).expect("possible");
    check(&bench, "denim_raw", "; ; 29.4; 21.2; p88; p75; ; ");
}

#[test]
fn a_style_is_stored_with_sizes_that_can_be_sewn() {
    let mut bench = Bench::new();
    let folder = bench.folder.path().to_owned();
    files::write_files(&folder, &patterns::drafted(patterns::Model::Tshirt)).expect("writable");
    let given = |sizes: &[(&str, &str)]| StyleGiven {
        seams: Some(folder.join("tshirt.seams.toml")),
        patterns: sizes.iter().map(|(size, file)| (Some((*size).to_owned()), folder.join(file))).collect(),
        ..StyleGiven::default()
    };
    let saved = save_style(&mut bench.store, Mode::Add, "tee", &given(&[("S", "tshirt-s.dxf"), ("M", "tshirt-m.dxf")]));
    assert_eq!(saved.expect("sewable").len(), 3);
    assert_eq!(bench.one("SELECT size FROM v_sizes WHERE style = 'tee' AND is_latest ORDER BY size"), "M,S");

    let broken = bench.write("broken.seams.toml", "[[piece]]\nblock = \"none\"\n");
    let given_broken = StyleGiven { seams: Some(broken), ..StyleGiven::default() };
    let error = save_style(&mut bench.store, Mode::Edit, "tee", &given_broken).expect_err("not sewable").to_string();
    assert!(error.contains("size S: ") && error.contains("size M: "), "{error}");

    let pattern = |file: &str| StyleGiven { patterns: vec![(None, folder.join(file))], ..StyleGiven::default() };
    let added = save_size(&mut bench.store, Mode::Add, "tee/L", &pattern("tshirt-l.dxf")).expect("sewable");
    assert_eq!((added.name.as_str(), added.deed), ("tee/L", Deed::Added));
    // Double sizes have a slash of their own.
    let added = save_size(&mut bench.store, Mode::Add, "tee/L/XL", &pattern("tshirt-l.dxf")).expect("sewable");
    assert_eq!(added.name, "tee/L/XL");
    assert_eq!(bench.one("SELECT count(*) FROM v_sizes WHERE style = 'tee' AND size = 'L/XL'"), "1");
    assert!(save_size(&mut bench.store, Mode::Add, "none/L", &pattern("tshirt-l.dxf")).is_err());
    assert!(save_size(&mut bench.store, Mode::Edit, "tee/XL", &pattern("tshirt-l.dxf")).is_err());
    remove(&mut bench.store, Part::Style, "tee").expect("there");
    assert_eq!(bench.one("SELECT (SELECT count(*) FROM style) + (SELECT count(*) FROM size)"), "0");
}

#[test]
fn revisions_of_an_earlier_schema_become_current() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("toile.sqlite");
    drop(open(&path, false).expect("a new database"));
    let connection = store::open(&path, Access::Write).expect("there");
    connection.execute_batch("DELETE FROM catalogue_entry").expect("valid");
    let migration = include_str!("../../../db/migrations/0005_catalogue.sql");
    let fill =
        migration.split(';').find(|sql| sql.contains("INSERT INTO catalogue_entry")).expect("it fills the table");
    connection.execute_batch(fill).expect("valid");
    drop(connection);
    let store = open(&path, false).expect("there");
    assert_eq!(subjects(&store).expect("readable").len(), 12);
}

#[test]
fn styles_without_a_seam_file_hold_their_seams_or_have_them_proposed() {
    let mut bench = Bench::new();
    let files = pattern::draft::Model::Tshirt.files();
    for (name, bytes) in &files {
        std::fs::write(bench.folder.path().join(name), bytes).expect("writable");
    }
    let dxf = files.iter().map(|(name, _)| name).find(|name| name.ends_with("s.dxf")).expect("a size S");
    let seams = files.iter().map(|(name, _)| name).find(|name| name.ends_with(".toml")).expect("seams");
    let folder = bench.folder.path().to_owned();
    let given = |size: &str, file: &str| StyleGiven {
        patterns: vec![(Some(size.to_owned()), folder.join(file))],
        ..StyleGiven::default()
    };
    let refused = save_style(&mut bench.store, Mode::Add, "tee", &given("S", dxf)).expect_err("no seams");
    assert!(refused.to_string().contains("a seam file (or --propose) unless"), "{refused}");
    let proposed = StyleGiven { is_proposed: true, ..given("S", dxf) };
    save_style(&mut bench.store, Mode::Add, "tee", &proposed).expect("its pieces are known");
    let found = sizes(&bench.store).expect("readable");
    assert!(found.len() == 1 && found[0].unconfirmed >= 8 && found[0].seam_file.as_deref() == Some("tee.seams.toml"));
    let own = SourceFile::read(&folder.join(seams)).expect("readable");
    let saved = save_seams(&mut bench.store, "tee", &own).expect("they fit");
    assert_eq!((saved[0].deed, saved[0].revision), (Deed::Revised, 2));
    let found = sizes(&bench.store).expect("readable");
    assert_eq!((found[0].unconfirmed, found[0].style_revision), (0, 2));
    let piece = workpiece(&bench.store, found[0].key).expect("stored");
    assert_eq!(piece.seams.as_ref().map(|file| &file.bytes), Some(&own.bytes));

    let style = piece.seams.as_ref().map(|seams| patterns::read_style(&piece.pattern, Some(seams), Some("S"), None));
    let style = style.expect("it has seams").expect("they fit");
    let json = serde_json::to_vec(&pattern::garmentcode::document(&style)).expect("JSON");
    std::fs::write(folder.join("tee.json"), json).expect("writable");
    save_style(&mut bench.store, Mode::Add, "coded", &given("one", "tee.json")).expect("it holds its seams");
    let found = sizes(&bench.store).expect("readable");
    let row = found.iter().find(|row| row.style == "coded").expect("stored");
    assert!(row.seam_file.is_none());
    let laid = workpiece(&bench.store, row.key).and_then(|piece| piece.laid_out()).expect("it reads");
    assert!(laid.desk.pieces.len() == style.pieces.len() && laid.desk.seams.len() >= style.seams.len());
    save_size(&mut bench.store, Mode::Add, "coded/two", &given("two", "tee.json")).expect("it holds its seams");
}

#[test]
fn good_rows_are_taken_where_they_are_asked_for_and_the_others_told() {
    let mut bench = Bench::new();
    let text = "name,sex,stature_mm\nanna,f,1650\ndan,x,1800\nbo,m,1.8\n";
    let path = bench.write("people.csv", text);
    let mut taken = |strictness| import(&mut bench.store, Part::Subject, std::slice::from_ref(&path), strictness);
    assert!(taken(Strictness::AllOrNone).is_err());
    let Imported { saved, left_out } = taken(Strictness::GoodRows).expect("a good row");
    assert_eq!(saved.iter().map(|saved| saved.name.as_str()).collect::<Vec<_>>(), ["anna"]);
    assert_eq!(left_out.iter().map(|problem| problem.line).collect::<Vec<_>>(), [Some(3), Some(4)]);
    // Nothing is imported if no row is good, or if the heading is not.
    let path = bench.write("bad.csv", "name,sex,stature_mm\ndan,x,1800\n");
    assert!(import(&mut bench.store, Part::Subject, &[path], Strictness::GoodRows).is_err());
    let path = bench.write("odd.csv", "name,sex,hight\nanna,f,1650\n");
    assert!(import(&mut bench.store, Part::Subject, &[path], Strictness::GoodRows).is_err());
}

#[test]
fn a_scan_is_a_subject_that_is_the_mesh_itself() {
    let mut bench = Bench::new();
    let body = spec::bodies::build_body(&Measurements::of(Sex::Male, 1.75)).expect("a body");
    let path = bench.write("bo.obj", &spec::bodies::write_obj(&body.mesh));
    let done =
        import(&mut bench.store, Part::Subject, std::slice::from_ref(&path), Strictness::AllOrNone).expect("a scan");
    assert_eq!(
        done.saved.iter().map(|saved| (saved.name.as_str(), saved.deed)).collect::<Vec<_>>(),
        [("bo", Deed::Added)]
    );
    let told =
        |notes: &[String]| notes.iter().map(|note| note.split(' ').next().unwrap_or_default().to_owned()).collect();
    let words: Vec<String> = told(&done.saved[0].notes);
    assert_eq!(words, ["unit", "measured"], "what was guessed");
    let limbs = "SELECT forearm_girth_mm > 200, wrist_girth_mm > 100, arm_length_mm > 500, calf_girth_mm > 300
        FROM v_subjects WHERE subject = 'bo'";
    assert_eq!(bench.one(limbs), "1,1,1,1");
    let given = ScanGiven { file: path, unit: None, sex: Some(Sex::Male) };
    let again = save_scan(&mut bench.store, Mode::Edit, "bo", &given).expect("the same scan");
    assert_eq!((again.deed, told(&again.notes)), (Deed::Unchanged, vec!["unit".to_owned()]));
    assert_eq!(bench.one("SELECT scan, revision FROM v_subjects WHERE subject = 'bo'"), "bo.obj,1");
    let person = subject(&bench.store, "bo").expect("there");
    assert!((person.measurements.stature_m() - 1.75).abs() < 0.01 && person.scan.is_some());
    let worn = person.body().expect("it wears garments");
    let chest = |body: &body::Body| body.girths.measurements(Sex::Male).get(Dimension::ChestGirth);
    assert!(chest(&worn).zip(chest(&body)).is_some_and(|(a, b)| (a - b).abs() < 2e-3));
    let refused = bench.subject(Mode::Edit, "bo", &[("waist_girth_mm", "700")]).expect_err("it is measured");
    assert!(refused.contains("its body is a scan"), "{refused}");
    let table = "name,sex,stature_mm,scan\nbo,m,1750,bo.obj\n";
    let told = bench.import(Part::Subject, "people.csv", table).expect_err("its scan would be lost");
    assert!(told.contains("its `scan` is in no table"), "{told}");
    // A study may name the subject; its export holds the mesh.
    let text = "[[subject]]\nid = \"x\"\nlike = \"bo\"\n";
    let done = bench.import(Part::Subject, "study.toml", text).expect("good");
    assert_eq!(done[0].1, Deed::Added);
    assert_eq!(bench.one("SELECT count(DISTINCT mesh) FROM scan"), "1");
}

#[test]
fn a_scan_without_feet_is_no_subject() {
    let mut bench = Bench::new();
    let mut mesh = spec::bodies::build_body(&Measurements::of(Sex::Female, 1.65)).expect("a body").mesh;
    let positions = &mesh.positions;
    mesh.triangles.retain(|triangle| triangle.iter().all(|&i| positions[i].z > 0.1));
    let path = bench.write("f.obj", &spec::bodies::write_obj(&mesh));
    let given = ScanGiven { file: path, unit: None, sex: Some(Sex::Female) };
    let refused = save_scan(&mut bench.store, Mode::Add, "f", &given).expect_err("nobody stands so").to_string();
    assert!(refused.contains("f.obj: a foot is missing") && refused.contains("--stature-mm"), "{refused}");
}

#[test]
fn what_is_hidden_is_said_to_be_hidden() {
    let mut bench = Bench::new();
    remove(&mut bench.store, Part::Subject, "male-ii").expect("built in");
    let told = subject(&bench.store, "male-ii").expect_err("hidden").to_string();
    assert!(told.contains("it is hidden") && told.contains("toile subject add"), "{told}");
    let text = "[[subject]]\nid = \"x\"\nlike = \"male-ii\"\n";
    let told = bench.import(Part::Subject, "study.toml", text).expect_err("hidden");
    assert!(told.contains("it is hidden"), "{told}");
}
