use crate::export::export_study;
use crate::file::*;
use crate::patterns::Unit;
use body::{Dimension, Sex};
use store::files::write_files;

fn known() -> Known {
    let male_ii = Measurements::of(Sex::Male, 1.69).with(Dimension::Weight, 53.0).with(Dimension::ChestGirth, 0.863);
    let cotton = Fabric {
        name: "cotton_shirting_light".into(),
        density_kg_m2: 0.1036,
        thickness_m: 0.2e-3,
        membrane_warp_n_m: 3800.0,
        membrane_weft_n_m: 2400.0,
        membrane_coupling_n_m: 0.0,
        shear_n_m: 97.0,
        bending_warp_nm: 5e-6,
        bending_weft_nm: 4e-6,
        friction_body: 0.31,
        friction_self: 0.5,
        source: "test".into(),
        stretched: None,
    };
    Known {
        subjects: [("male-ii".to_owned(), male_ii.into())].into(),
        fabrics: [("cotton_shirting_light".to_owned(), cotton)].into(),
        ..Known::default()
    }
}

fn load(text: &str) -> std::result::Result<Study, String> {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("tee-s.dxf"), "dxf").expect("writable");
    std::fs::write(folder.path().join("tee.json"), "{}").expect("writable");
    std::fs::write(folder.path().join("tee.seams.toml"), "seams").expect("writable");
    let path = folder.path().join("study.toml");
    std::fs::write(&path, text).expect("writable");
    let prefix = format!("{}/", folder.path().display());
    Study::load(&path, &known()).map_err(|error| error.to_string().replace(&prefix, ""))
}

const GOOD: &str = r#"
name = "tops"
[[subject]]
id = "ii"
like = "male-ii"
[[subject]]
id = "x"
sex = "female"
stature_mm = 1650
[[garment]]
name = "tee"
seams = "tee.seams.toml"
fabric = "cotton_shirting_light"
sizes = [{ name = "S", pattern = "tee-s.dxf" }]
"#;

#[test]
fn a_good_file_is_read_with_its_inputs() {
    let study = load(GOOD).expect("good");
    assert_eq!((study.name.as_str(), study.repeats, study.simulators.as_slice()), ("tops", 1, &[Simulator::Fem][..]));
    assert_eq!(study.subjects.iter().map(|s| s.id.as_str()).collect::<Vec<_>>(), ["ii", "x"]);
    assert_eq!(&*study.garments[0].sizes[0].pattern.bytes, b"dxf");
}

#[test]
fn every_problem_is_told_at_once_with_its_line() {
    let told = load(
        r#"
nam = "tops"
simulators = ["fem", "fen"]
edge_length_mm = "15"
fit = { tight_below_mm = 120 }
[[subject]]
id = "ii"
like = "male-i1"
[[subject]]
id = "ii"
sex = "man"
stature_mm = 17
[[garment]]
name = "tee"
seams = "tee.seam.toml"
fabric = "cotton_shirting_ligth"
sizes = [{ name = "S", patern = "tee-s.dxf" }]
"#,
    );
    insta::assert_snapshot!(told.expect_err("bad"));
}

/// Two garments of two sizes each, and a third of one size, with an outfit.
fn layered(outfit: &str) -> String {
    let sizes = |names: &[&str]| {
        let one = |name: &&str| format!("{{ name = \"{name}\", pattern = \"tee-s.dxf\" }}");
        names.iter().map(one).collect::<Vec<_>>().join(", ")
    };
    let garment = |name: &str, names: &[&str]| {
        let sizes = sizes(names);
        format!(
            "[[garment]]\nname = \"{name}\"\nseams = \"tee.seams.toml\"\nfabric = \"cotton_shirting_light\"\nsizes = [{sizes}]\n"
        )
    };
    let subject = "[[subject]]\nid = \"ii\"\nlike = \"male-ii\"\n";
    let garments = [garment("shirt", &["S", "M"]), garment("jacket", &["M", "L"]), garment("scarf", &["one"])].concat();
    format!("simulators = [\"fem\", \"hybrid\"]\n{subject}{garments}[[outfit]]\nname = \"office\"\n{outfit}\n")
}

#[test]
fn an_outfit_is_a_garment_a_layer_in_the_sizes_that_are_worn_together() {
    let check = |outfit: &str, expect: &[&str]| {
        let study = load(&layered(outfit)).expect("good");
        let jobs = crate::jobs(&study);
        let of_outfit: Vec<String> = jobs
            .iter()
            .filter_map(|job| {
                let worn = job.outfit.as_ref()?;
                let after = job.schedule.after.join(" ");
                Some(format!("{} {} {} of {} after {after}", job.garment, job.size, worn.layer, worn.layers.len()))
            })
            .collect();
        assert_eq!(of_outfit, expect, "{outfit}");
        // Ids are the same for all layers of an outfit in one size.
        let ids: BTreeSet<String> = jobs.iter().filter_map(|job| Some(job.outfit.as_ref()?.id())).collect();
        assert_eq!(ids.len() * study.layers.len(), of_outfit.len());
    };
    check(
        "layers = [\"shirt\", \"jacket\"]",
        &["office shirt M 0 of 2 after ", "office jacket M 1 of 2 after office shirt"],
    );
    check(
        "layers = [\"scarf\", \"shirt\"]\nsizes = [\"one\", \"S\"]",
        &["office scarf one 0 of 2 after ", "office shirt S 1 of 2 after office scarf"],
    );
}

#[test]
fn an_outfit_that_cannot_be_worn_is_told_of() {
    let check = |outfit: &str, says: &str| {
        let told = load(&layered(outfit)).expect_err("bad");
        assert!(told.contains(says), "{told}");
    };
    check("", "`layers` is missing");
    check("layers = [\"shirt\"]", "outfit office: 1 layers; accepted: 2 to 5 different garments");
    check("layers = [\"shirt\", \"shirt\"]", "2 layers; accepted: 2 to 5 different garments");
    check("layers = [\"shirt\", \"jackett\"]", "did you mean `jacket`?");
    check("layers = [\"shirt\", \"scarf\"]", "`sizes` is missing");
    check("layers = [\"shirt\", \"scarf\"]\nsizes = [\"S\"]", "one size of each layer: S, M of shirt; one of scarf");
    check("layers = [\"shirt\", \"jacket\"]\nsubjects = [\"iii\"]", "subject who wears all layers");
    check("layers = [\"shirt\", \"jacket\"]\nsize = \"M\"", "`size`");
}

#[test]
fn broken_toml_names_its_line() {
    insta::assert_snapshot!(load("name = \"a\"\n[[subject]\nid = 1\n").expect_err("bad"));
}

#[test]
fn only_a_studys_subject_may_be_named() {
    let told = |text: &str| {
        let problems = parse::measurements_file(Path::new("anna.toml"), text).expect_err("no sex");
        Problem::listing(&problems)
    };
    assert!(load(&GOOD.replace("like = \"male-ii\"", "stature_mm = 1700")).expect_err("no sex").contains("`like`"));
    let told = told("stature_mm = 1700");
    assert!(told.contains("`sex` is missing") && !told.contains("like"), "{told}");
}

#[test]
fn a_file_of_one_entry_needs_no_header() {
    let anna = "id = \"anna\"\nsex = \"female\"\nstature_mm = 1650\n";
    let knit = "name = \"knit\"\ndensity_kg_m2 = 0.2\nthickness_mm = 0.6\nmembrane_warp_n_m = 100\nmembrane_weft_n_m = 60\n\
                shear_n_m = 30\nbending_warp_nm = 1e-6\nbending_weft_nm = 1e-6\nfriction_body = 0.3\nfriction_self = 0.5\n";
    let path = Path::new("one.toml");
    for text in [anna.to_owned(), format!("[[subject]]\n{anna}")] {
        let found = parse::measurements_file(path, &text).expect("a good subject");
        assert_eq!((found.sex, found.stature_m()), (Sex::Female, geom::units::from_mm(1650.0)));
    }
    for text in [knit.to_owned(), format!("[[fabric]]\n{knit}"), format!("{knit}source = \"own\"\n")] {
        let found = parse::fabric_file(path, &text).expect("a good fabric");
        assert_eq!((found.name.as_str(), found.thickness_m), ("knit", geom::units::from_mm(0.6)));
    }
    let check = |text: &str, says: &str| {
        let told = Problem::listing(&parse::fabric_file(path, text).expect_err("wrong"));
        assert!(told.contains(says), "{told}");
    };
    check(&knit.replace("thickness_mm", "thickness_m"), "thickness_mm");
    check(
        &format!("[[fabric]]\n{knit}[[fabric]]\n{}", knit.replace("knit", "other")),
        "2 entries of [[fabric]]; accepted: one",
    );
    check("fabric = []\n", "0 entries of [[fabric]]; accepted: one");
    check("", "name");
}

#[test]
fn a_subject_may_be_a_scan() {
    let folder = tempfile::tempdir().expect("a folder");
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).expect("writable");
    write("tee-s.dxf", "dxf");
    write("tee.seams.toml", "seams");
    let asked = &known().subjects["male-ii"].measurements;
    let body = body::build(asked).expect("an ordinary man");
    write("ii.obj", &body::write_obj(&body.mesh));
    let load = |subject: &str| {
        let at = GOOD.find("like").expect("a subject");
        let end = at + GOOD[at..].find('\n').expect("a line");
        write("study.toml", &[&GOOD[..at], subject, &GOOD[end..]].concat());
        Study::load(folder.path(), &known())
    };
    let study = load("scan = \"ii.obj\"\nsex = \"male\"").expect("a scan of a man");
    let subject = &study.subjects[0];
    assert!((subject.person.measurements.stature_m() - asked.stature_m()).abs() < 2e-3, "{subject:?}");
    let chest = subject.person.measurements.get(Dimension::ChestGirth).expect("measured");
    assert!((chest - 0.863).abs() < 3e-3, "{chest}");
    let jobs = crate::jobs(&study);
    let hash = |name: &str| jobs[0].inputs.iter().find(|(key, _)| *key == name).map(|(_, value)| value.to_owned());
    let scan = subject.person.scan.as_ref().expect("a scan");
    assert_eq!(hash("subject.ii.scan"), Some(scan.file.hash()));
    let told = |subject: &str| load(subject).expect_err("bad").to_string();
    assert!(told("scan = \"i.obj\"").contains("did you mean `ii.obj`?"));
    assert!(told("scan = \"ii.obj\"\nstature_mm = 1700").contains("`stature_mm` beside `scan`"));
    assert!(told("scan = \"ii.obj\"\nunit = \"mm\"").contains("is the unit right?"));
    assert!(told("scan = \"tee-s.dxf\"").contains("no faces"));
}

#[test]
fn the_quickstart_is_a_good_study() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../studies/quickstart");
    let study = Study::load(&folder, &known()).expect("good");
    assert_eq!(crate::jobs(&study).len(), 12);
}

#[test]
fn garments_are_worn_by_the_subjects_they_name() {
    let wearers = |subjects: &str| {
        let text = GOOD.replace("name = \"tee\"", &format!("name = \"tee\"\nsubjects = {subjects}"));
        load(&text).map(|study| study.garments[0].subjects.join(" "))
    };
    assert_eq!(wearers("[\"x\"]").as_deref(), Ok("x"));
    assert_eq!(load(GOOD).expect("good").garments[0].subjects, ["ii", "x"]);
    let refused = |subjects: &str, message: &str| assert_eq!(wearers(subjects).expect_err("bad"), message);
    let twice = "study.toml:12:18: garment tee: subject `x` is named twice";
    let unknown = "study.toml:12:23: no [[subject]] with the id `i`; there are: ii, x";
    refused("[\"x\", \"x\", \"i\"]", &format!("{twice}\n{unknown}"));
    refused("[]", "study.toml:12:12: garment tee: nobody wears it; name subjects, or leave `subjects` out for all");
    refused("\"x\"", "study.toml:12:12: garment tee: `subjects` must be a list of texts, found string");
}

#[test]
fn a_seam_file_is_needed_unless_the_pattern_holds_seams() {
    let without = GOOD.replace("seams = \"tee.seams.toml\"\n", "");
    let expect = "study.toml:10:1: garment tee: `seams` is missing; give the file that says how its pieces are sewn, or a \
        `style` of the catalogue";
    assert_eq!(load(&without).expect_err("bad"), expect);
    // Any file will do: what is in it is read later.
    let json = load(&without.replace("tee-s.dxf", "tee.json")).expect("good");
    assert_eq!((json.garments[0].seams.is_none(), json.garments[0].sizes.len()), (true, 1));
}

proptest::proptest! {
    #[test]
    fn no_text_makes_the_reader_panic(edits in proptest::collection::vec((0usize..GOOD.len(), "[\\[\\]{}=\"a-z0-9.\n -]{0,3}"), 1..6)) {
        let mut text = GOOD.to_owned();
        for (at, insert) in edits {
            let at = (0..=at.min(text.len())).rev().find(|&at| text.is_char_boundary(at)).unwrap_or(0);
            let end = (at + insert.len()).min(text.len());
            text.replace_range(at..end, &insert);
        }
        let problems = parse::study(Path::new("study.toml"), &text, &known()).err().unwrap_or_default();
        for problem in problems {
            proptest::prop_assert!(problem.line.is_some_and(|line| line <= text.lines().count() + 1), "{problem}");
        }
    }
}

#[test]
fn schedules_are_read_and_circles_refused() {
    let two = |more: &str| {
        let over = GOOD[GOOD.find("[[garment]]").expect("there")..].replace("\"tee\"", "\"over\"");
        load(&format!("time_limit_s = 60\n{GOOD}{over}{more}"))
    };
    let check = |more: &str, says: &str| {
        let told = two(more).expect_err("wrong");
        assert!(told.contains(says), "{told}");
    };
    check("after = [\"over\"]", "no [[garment]] before this one `over`");
    check("after = [\"tea\"]", "did you mean `tee`?");
    check("time_limit_s = 0", "`time_limit_s` is 0; accepted: 0.001 to 2592000");
    check("memory_limit_mb = 1", "`memory_limit_mb` is 1; accepted: 50 to 4000000");
    check("priority = 1e6", "`priority` is 1000000; accepted: -1000 to 1000");
    let sweep = "[[sweep]]\ngarments = [\"tee\"]\nedge_length_mm = [20, 15]\n";
    let study = two(&format!("after = [\"tee\"]\npriority = 2\nmemory_limit_mb = 500\n{sweep}")).expect("good");
    let [plain, over] = [&study.garments[0], study.garments.last().expect("three")].map(|garment| &garment.schedule);
    assert_eq!(over.after, ["tee edge_length_mm=20", "tee edge_length_mm=15"]);
    assert_eq!((over.priority, over.limits), (2, Limits { time_s: Some(60.0), memory_mb: Some(500) }));
    assert_eq!((plain.after.len(), plain.limits.time_s), (0, Some(60.0)));
    let own =
        two("time_limit_s = 20").expect("good").garments.into_iter().map(|garment| garment.schedule.limits.time_s);
    assert_eq!(own.collect::<Vec<_>>(), [Some(60.0), Some(20.0)], "a garment's own limit before that of the study");
    let mut study = study;
    study.limit(Limits { time_s: Some(5.0), memory_mb: None });
    assert_eq!(study.garments[2].schedule.limits, Limits { time_s: Some(5.0), memory_mb: Some(500) });
}

#[test]
fn a_subject_stands_in_the_poses_that_it_names() {
    let subjects = |keys: &str| {
        let text = GOOD.replacen("like = \"male-ii\"", &format!("like = \"male-ii\"\n{keys}"), 1);
        load(&text).map(|study| study.subjects)
    };
    let found = subjects("poses = [\"arms_15\", \"arms_60+legs_8\"]").expect("they can be stood in");
    let names: Vec<&str> = found.iter().map(|subject| subject.id.as_str()).collect();
    assert_eq!(names, ["ii arms_15", "ii arms_60+legs_8", "x"]);
    let girth = |k: usize| found[k].person.body().expect("a body").girths.get(Dimension::ChestGirth);
    assert!(found[0].person.pose != found[1].person.pose && girth(0) == girth(1), "the trunk stays as it is");
    let text = GOOD.replacen("like = \"male-ii\"", "like = \"male-ii\"\nposes = [\"arms_15\", \"arms_60\"]", 1);
    let worn = |names: &str| {
        let worn = text.replacen("[[garment]]", &format!("[[garment]]\nsubjects = [{names}]"), 1);
        load(&worn).expect("they are there").garments[0].subjects.join(", ")
    };
    assert_eq!(worn("\"ii\""), "ii arms_15, ii arms_60");
    assert_eq!(worn("\"ii arms_60\", \"x\""), "ii arms_60, x");
    // A single pose does not change the name.
    let one = subjects("pose = \"arms_60\"").expect("a pose");
    assert_eq!(
        (one[0].id.as_str(), one[0].person.pose.map(|pose| pose.to_string())),
        ("ii", Some("arms_60".to_owned()))
    );
    let check = |pose: &str| {
        let told = subjects(&format!("pose = \"{pose}\"")).expect_err("no pose");
        assert!(told.contains(&format!("pose `{pose}`; accepted: arms_5 to arms_90, legs_0 to legs_30")), "{told}");
    };
    ["arms", "arms_120", "wings_3", "arms_x", "", "arms_30+"].into_iter().for_each(check);
}

#[test]
fn a_subject_has_the_figures_that_it_names() {
    let subject = |keys: &str| {
        let text = GOOD.replacen("sex = \"female\"", &format!("sex = \"female\"\n{keys}"), 1);
        load(&text).map(|study| study.subjects[1].person.clone())
    };
    let plain = subject("").expect("a person");
    assert!(plain.figures.is_empty());
    let found = subject("figure = [\"flat_seat\", \"round_back=12\"]").expect("figures");
    assert_eq!(found.figures.to_string(), "flat_seat=15 round_back=12");
    assert_ne!(found.body().expect("a body").mesh, plain.body().expect("a body").mesh);
    let check = |keys: &str, words: &str| {
        let told = subject(keys).expect_err("no figure");
        assert!(told.contains("subject x: figure") && told.contains(words), "{told}");
    };
    check("figure = [\"flat_saet\"]", "accepted: flat_seat, prominent_seat");
    check("figure = [\"flat_seat=90\"]", "slight, medium, strong, or above 0 to 30 mm");
    check("thigh_girth_mm = 560\nfigure = [\"full_thigh\"]", "`thigh_girth_mm` is given");
    let like = GOOD.replacen("like = \"male-ii\"", "like = \"male-ii\"\nfigure = [\"sway_back\"]", 1);
    assert_eq!(load(&like).expect("a study").subjects[0].person.figures.to_string(), "sway_back=12");
}

#[test]
fn a_garment_is_carried_from_the_pose_in_which_it_is_put_on() {
    let read = |keys: &str| load(&GOOD.replacen("like = \"male-ii\"", &format!("like = \"male-ii\"\n{keys}"), 1));
    let study = read("poses = [\"arms_15\", \"arms_60\", \"step_10\"]\ncarried_from = \"arms_15\"").expect("a study");
    let from = |subject: &Subject| subject.carried_from.map(|pose| pose.to_string()).unwrap_or_default();
    let found: Vec<_> = study.subjects.iter().map(|subject| (subject.id.clone(), from(subject))).collect();
    let expect = [("ii arms_15", ""), ("ii arms_60", "arms_15"), ("ii arms_15+step_10", "arms_15"), ("x", "")];
    assert_eq!(found, expect.map(|(id, from)| (id.to_owned(), from.to_owned())));

    let jobs = crate::jobs(&study);
    let of_subject = |id: &str| jobs.iter().filter(move |job| job.subject == id).collect::<Vec<_>>();
    assert!(of_subject("ii arms_60").iter().all(|job| job.simulator == Simulator::Fem), "friction carries it");
    // The drape that is carried is exactly that of a job in the first pose.
    let (dressed, carried) = (of_subject("ii arms_15"), of_subject("ii arms_60"));
    let before = carried[0].dressed.as_ref().expect("it is put on first");
    let alone = dressed.iter().find(|job| job.simulator == Simulator::Fem).expect("by FEM-GS");
    assert_eq!(before.inputs, alone.inputs);
    assert_ne!(carried[0].inputs, alone.inputs);

    let told = read("carried_from = \"arms_15\"").expect_err("nowhere to go");
    assert!(told.contains("`carried_from` without a pose to carry to"), "{told}");
    let one = read("pose = \"arms_60\"\ncarried_from = \"arms_15\"").expect("a study");
    assert_eq!(one.subjects[0].dressed().map(|subject| subject.id).as_deref(), Some("ii arms_15"));
}

#[test]
fn a_pattern_in_any_unit_is_read_and_exported() {
    for unit in Unit::ALL.map(Unit::as_str) {
        let study = load(&format!("{GOOD}unit = \"{unit}\"\n")).expect("a unit of patterns");
        let folder = tempfile::tempdir().expect("a folder");
        write_files(folder.path(), &export_study(&study)).expect("writable");
        let again = Study::load(folder.path(), &known()).expect("a good study");
        assert_eq!([&study, &again].map(|study| study.garments[0].unit.as_deref()), [Some(unit); 2]);
    }
    let told = load(&format!("{GOOD}unit = \"yard\"\n")).expect_err("no unit of patterns");
    assert!(told.contains("unit `yard`; accepted: mm, cm, in, m"), "{told}");
}

#[test]
fn sizes_of_one_file_are_those_that_it_holds() {
    let drafts = pattern::draft::Model::Tshirt.drafts();
    let pieces: Vec<_> = drafts.iter().flat_map(|draft| draft.pieces.clone()).collect();
    let nest = pattern::dxf::write_pieces(&pieces, &[], pattern::dxf::Standard::Aama);
    let one = drafts[0].dxf();
    let check = |sizes: &str, expected: &[&str]| {
        let folder = tempfile::tempdir().expect("a folder");
        let write = |name: &str, bytes: &[u8]| std::fs::write(folder.path().join(name), bytes).expect("writable");
        write("nest.dxf", &nest);
        write("one.dxf", &one);
        write("tee.seams.toml", b"seams");
        let (before, _) = GOOD.split_once("sizes = ").expect("there");
        write("study.toml", format!("{before}sizes = [{sizes}]\n").as_bytes());
        let told = match Study::load(&folder.path().join("study.toml"), &known()) {
            Ok(_) => String::new(),
            Err(error) => error.to_string(),
        };
        assert_eq!(told.lines().count(), expected.len(), "{sizes}: {told}");
        expected.iter().for_each(|text| assert!(told.contains(text), "{sizes}: {told}"));
    };
    let sizes_of = |file: &str, names: &[&str]| {
        let size = |name: &&str| format!("{{ name = \"{name}\", pattern = \"{file}\" }}");
        names.iter().map(size).collect::<Vec<_>>().join(", ")
    };
    check(&sizes_of("nest.dxf", &["S", "M", "L"]), &[]);
    check(
        &sizes_of("nest.dxf", &["S", "XS"]),
        &["garment tee: size `XS` is none of nest.dxf; accepted: one of S, M, L"],
    );
    check(&sizes_of("nest.dxf", &["S", "s"]), &["size `s` is a second name of one size of nest.dxf"]);
    check(&sizes_of("one.dxf", &["S"]), &[]);
    let only = "is one of 2 of one.dxf, which holds one size; accepted: a file a size, or one that holds them all";
    check(&sizes_of("one.dxf", &["S", "M"]), &[&format!("size `S` {only}"), &format!("size `M` {only}")]);
}
