//! The command line: exit codes, what goes to which stream, keys of the JSON that other programs read.

use std::collections::BTreeSet;
use std::path::Path;

use serde_json::Value;
use toile::cli;

use super::documents::calls;
use super::program::{Place, shared};

fn has_keys(object: &Value, keys: &[&str]) {
    let object = object.as_object().expect("an object");
    for key in keys {
        assert!(object.contains_key(*key), "no {key} among {:?}", object.keys().collect::<Vec<_>>());
    }
}

#[test]
fn every_command_explains_itself_and_touches_nothing() {
    let place = Place::new();
    let commands = calls(&cli::command(), &[]).into_iter().map(|call| call[1..].join(" "));
    let with_options = ["--version", "body build --json", "run --dry-run", "sql --readonly"].map(str::to_owned);
    for command in commands.chain(with_options) {
        let said = place.toile(&format!("{command} --help")).ends_with(0);
        assert!(!said.out.is_empty() && said.err.is_empty(), "{command}: {}", said.err);
        assert!(command == "--version" || said.out.contains("Usage: toile"), "{command}: {}", said.out);
    }
    let [long, asked] = ["run --help", "help run"].map(|words| place.toile(words).ends_with(0).out);
    assert_eq!(long, asked);
    assert!(!place.path("toile.sqlite").exists());
}

#[test]
fn the_laboratory_says_what_is_known_and_what_it_finds() {
    let place = Place::new();
    let found = place.toile("lab incline buckling --quiet --json").ends_with(0).json();
    let rows = found.as_array().expect("rows");
    assert_eq!(rows.iter().map(|row| row["experiment"].as_str()).collect::<BTreeSet<_>>().len(), 2);
    for row in rows {
        has_keys(row, &["experiment", "case", "quantity", "known", "found", "error", "of", "source"]);
        let most = if row["experiment"] == "incline" { 1.0 } else { 5.0 };
        assert!(row["error"].as_f64().is_some_and(|error| error.abs() <= most), "{row}");
    }
    let said = place.toile("lab levitation").ends_with(2);
    assert!(said.err.contains("levitation") && said.err.contains("cantilever"), "{}", said.err);
    assert!(!place.path("toile.sqlite").exists());
}

#[test]
fn wrong_usage_ends_with_2_and_says_what_would_be_right() {
    let place = Place::new();
    place.study(&[("tee", 0.1, &["m"])]);
    let check = |arguments: &str, says: &str| {
        let said = place.toile(arguments).ends_with(2);
        assert!(said.err.contains(says) && said.out.is_empty(), "{arguments}: {}{}", said.out, said.err);
    };
    check("rum .", "similar subcommand");
    check("run", "<STUDY>");
    check("run . --size xl", "no size `xl`; there are: m");
    check("run . --subject iii", "no subject `iii`");
    check("run . --sim hybird", "no simulator `hybird`");
    check("run . --workers 0", "1..=1024");
    check("run nowhere", "nowhere");
    check("run show 99", "no job `99`");
    check("job run study.toml", "study.toml: this is no job file");
    check("job merge study.toml", "study.toml: this is no result file");
    check("sql", "<QUERY|--list|--file <FILE>>");
    check("sql nonsense", "no saved query `nonsense`; there are: against_thesis, attention,");
    check("sql SELECT/nonsense", "syntax error");
    check("sql time", "did you mean `times`?");
    check("queue log 99", "no job `99`");
    check("report nothing", "no study `nothing`");
    check("subject add anna --sex f", "`stature_mm` is missing");
    check("subject add anna --sex f --stature-mm 165", "accepted: 1300 to 2200");
    check("subject edit ana --weight-kg 60", "no subject `ana`");
    check("subject import nowhere.csv", "nowhere.csv");
    check("style add tee --seams patterns/tshirt.seams.toml", "at least one pattern");
    check("size rm tee/S", "no size `tee/S`");
    check("fabric show cotton_shirting_ligth", "did you mean `cotton_shirting_light`?");
    check("body build --sex m --stature-mm 200 -o out", "`stature_mm` is 200; accepted: 1300 to 2200");
    check("body build --sex m -o out", "say --sex and --stature-mm");
    check("body build --scan body.obj --knee-girth-mm 380 -o out", "--knee-girth-mm does not go with --scan");
    check("body build --scan body.obj --inseam-mm 780 -o out", "--inseam-mm does not go with --scan");
    check("pattern mesh patterns/tshirt-m.dxf --seams patterns/tshirt.seams.toml --edge-length-mm -3", "-3");
    check("run . --readonly", "the workspace is open read-only");
}

#[test]
fn a_usage_line_shows_only_what_was_typed() {
    let place = Place::new();
    let check = |arguments: &str, is_typed: bool| {
        let said = place.toile(arguments).ends_with(2);
        assert!(said.err.contains("Usage: toile render"), "{}", said.err);
        assert_eq!(said.err.contains("--db <PATH>"), is_typed, "{arguments}: {}", said.err);
    };
    check("render 1 --view close-up --turn 15 -o x.png", false);
    check("render 1 -o x.png --vieww front", false);
    check("render 1 --view close-up --turn 15 -o x.png --db other.sqlite", true);
}

#[test]
fn options_may_be_shortened_while_they_are_told_apart() {
    let place = Place::new();
    place.toile("pattern draft tshirt --out drafted").ends_with(0);
    assert!(place.path("drafted/tshirt.seams.toml").exists());
    let said = place.toile("run . --s tee").ends_with(2);
    assert!(said.err.contains("unexpected argument '--s'"), "{}", said.err);
}

#[test]
fn the_catalogue_is_edited() {
    let place = Place::new();
    place.draft();
    let said = place.toile("subject add anna --sex f --stature-mm 1650 --waist-girth-mm 700").ends_with(0);
    let told: Vec<&str> = said.err.trim().lines().collect();
    assert!(said.out.is_empty() && told[0].starts_with("made a new database: "), "{told:?}");
    assert_eq!(told[1..], ["subject anna is added"]);
    let said = place.toile("subject edit anna --waist-girth-mm 720 --weight-kg 60").ends_with(0);
    assert_eq!(said.err.trim(), "subject anna has revision 2; results keep theirs");
    let shown = place.toile("subject show anna --json").ends_with(0).json();
    assert_eq!((&shown[0]["waist_girth_mm"], &shown[1]["waist_girth_mm"]), (&Value::from(700.0), &Value::from(720.0)));

    let mut command = place.command("sql --format csv");
    let table = command.arg("SELECT * FROM v_subjects WHERE is_latest").output().expect("it starts").stdout;
    place.write("people.csv", &table);
    let said = place.toile("subject import people.csv").ends_with(0);
    assert_eq!(said.err.lines().filter(|line| line.contains("is unchanged")).count(), 13);
    assert!(said.err.lines().all(|line| line.contains("is unchanged") || line.contains("is doubtful")), "{}", said.err);

    place.toile("style add tee --seams patterns/tshirt.seams.toml --pattern S=patterns/tshirt-s.dxf").ends_with(0);
    place.toile("size add tee/M --pattern patterns/tshirt-m.dxf").ends_with(0);
    assert_eq!(place.toile("size ls --json").ends_with(0).json().as_array().map(Vec::len), Some(2));
    let said = place.toile("style rm tee").ends_with(0);
    assert_eq!(said.err.trim(), "style tee is gone");
    place.toile("subject rm anna male-ii").ends_with(0);
    assert_eq!(place.toile("subject ls --json").ends_with(0).json().as_array().map(Vec::len), Some(11));
    assert_eq!(place.toile("subject ls --all --json").ends_with(0).json().as_array().map(Vec::len), Some(12));
}

#[test]
fn a_failed_check_ends_with_3() {
    let place = Place::new();
    place.draft();
    let good = "pattern check patterns/tshirt-m.dxf --seams patterns/tshirt.seams.toml";
    place.toile(good).ends_with(0);
    let seams = std::fs::read_to_string(place.path("patterns/tshirt.seams.toml")).expect("drafted");
    place.write("patterns/tshirt.seams.toml", seams.replace("SLEEVE", "SLEAVE"));
    let said = place.toile(good).ends_with(3);
    assert!(said.err.contains("tshirt.seams.toml") && said.err.contains("SLEAVE"), "{}", said.err);
    place.write("broken.sqlite", "this is not a database, whatever its name says; it is only some text\n");
    let said = place.toile("doctor --db broken.sqlite").ends_with(3);
    assert!(said.out.contains("FAILED") && said.out.contains("broken.sqlite"), "{}", said.out);
    place.toile("info --db broken.sqlite").ends_with(2);
}

#[test]
fn a_failed_job_ends_with_4() {
    let place = Place::new();
    place.study(&[("tee", 0.1, &["m"])]);
    let text = place.study_file();
    // Girths that a person can have, but not one person: found when the body is made.
    let text = text.replace("chest_girth_mm = 863", "chest_girth_mm = 600").replace("= 782", "= 1500");
    place.write("study.toml", text.replace("hip_girth_mm = 914", "hip_girth_mm = 650"));
    let said = place.toile("run .").ends_with(4);
    assert!(said.err.contains("job 1 failed: body:") && said.err.contains("no adult has both"), "{}", said.err);
    assert_eq!(place.one("SELECT status FROM v_jobs"), "failed");
}

#[test]
fn data_and_messages_go_to_different_streams() {
    let place = Place::new();
    place.draft();
    let mesh = "pattern check patterns/tshirt-m.dxf --seams patterns/tshirt.seams.toml";
    let said = place.toile(mesh).ends_with(0);
    assert!(said.out.contains("Neck Opening") && said.err.contains("9 measurements"), "{}{}", said.out, said.err);
    assert!(!said.out.contains("9 measurements"), "{}", said.out);
    assert!(place.toile(&format!("{mesh} --quiet")).ends_with(0).err.is_empty());
    let said = place.toile(&format!("{mesh} --json")).ends_with(0);
    assert_eq!(said.json().as_array().map(Vec::len), Some(9));
    let said = place.toile("sql --format csv").ends_with(2);
    assert!(said.out.is_empty());
}

#[test]
fn answers_have_no_colours_when_none_are_wanted() {
    let place = Place::new();
    for arguments in ["fabric ls", "info", "--help", "nonsense"] {
        let mut command = assert_cmd::Command::from_std(place.command(arguments));
        let output = command.env("NO_COLOR", "1").env("CLICOLOR_FORCE", "1").env("TERM", "xterm-256color").output();
        let output = output.expect("it starts");
        let bytes = [output.stdout, output.stderr].concat();
        assert!(!bytes.contains(&0x1b), "{arguments}: {}", String::from_utf8_lossy(&bytes));
    }
}

#[test]
fn formats_hold_the_same() {
    let place = Place::new();
    let sql = "SELECT fabric, density_kg_m2, NULL AS absent FROM v_fabrics ORDER BY fabric LIMIT 2";
    let ask = |format: &str| {
        place.write("q.sql", sql);
        place.toile(&format!("sql -f q.sql --format {format}")).ends_with(0)
    };
    let rows = ask("json").json();
    let csv = ask("csv").out;
    let mut lines = csv.lines();
    assert_eq!(lines.next(), Some("fabric,density_kg_m2,absent"));
    for (line, row) in lines.zip(rows.as_array().expect("rows")) {
        assert_eq!(line, format!("{},{},", row["fabric"].as_str().expect("a name"), row["density_kg_m2"]));
        assert!(row["absent"].is_null());
    }
    assert_eq!(ask("table").out.lines().count(), 4);
}

#[test]
fn sql_reads_and_never_writes() {
    let place = Place::new();
    place.toile("info").ends_with(0);
    let before = std::fs::read(place.path("toile.sqlite")).expect("there");
    for query in [
        "DELETE FROM fabric",
        "SELECT 1; DROP TABLE job",
        "UPDATE fabric SET density_kg_m2 = 1 RETURNING name",
        "CREATE TABLE mine (x)",
        "PRAGMA user_version = 99",
        "ATTACH 'other.sqlite' AS other",
        "VACUUM INTO 'copy.sqlite'",
    ] {
        let mut command = place.command("sql");
        let output = command.arg(query).output().expect("it starts");
        assert_eq!(output.status.code(), Some(2), "{query}");
        assert!(String::from_utf8_lossy(&output.stderr).starts_with("toile: sql:"), "{query}");
    }
    assert_eq!(std::fs::read(place.path("toile.sqlite")).expect("there"), before);
    assert!(!place.path("other.sqlite").exists() && !place.path("copy.sqlite").exists());
}

#[test]
fn every_question_in_the_documentation_is_answered() {
    let place = Place::new();
    place.toile("info").ends_with(0);
    let text = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/docs/sql.md")).expect("in the repository");
    let queries: Vec<&str> =
        text.split("```sql\n").skip(1).filter_map(|rest| Some(rest.split_once("```")?.0)).collect();
    assert_eq!(queries.len(), 9);
    for query in queries {
        let output = place.command("sql").arg(query).output().expect("it starts");
        assert!(output.status.success(), "{query}: {}", String::from_utf8_lossy(&output.stderr));
        // Chi is stored for every stage of Hybrid-GS: a question about both simulators has to say which it means.
        assert!(!query.contains("v_chi") || query.contains("'drape'") || query.contains("job_id = 1"), "{query}");
    }
}

#[test]
fn pattern_inspect_has_its_keys() {
    let place = Place::new();
    place.draft();
    let said = place.toile("pattern inspect patterns --json").ends_with(0);
    let reports = said.json();
    assert_eq!(reports.as_array().map(Vec::len), Some(3));
    let report = &reports[0];
    has_keys(report, &["file", "format", "units", "mm_per_unit", "pieces", "refused", "error"]);
    assert_eq!((&report["units"], &report["mm_per_unit"]), (&Value::from("mm"), &Value::from(1.0)));
    let piece = &report["pieces"][0];
    let keys = [
        "block",
        "name",
        "size",
        "quantity",
        "perimeter_mm",
        "area_mm2",
        "closed",
        "clockwise",
        "turn_points",
        "curve_points",
        "notches",
        "grain_mm",
        "internal_lines",
        "sew_area_mm2",
    ];
    has_keys(piece, &keys);
    let one = place.toile("pattern inspect patterns/tshirt-s.dxf --unit in --json").ends_with(0).json();
    let mm = place.toile("pattern inspect patterns/tshirt-s.dxf --json").ends_with(0).json();
    let length = |report: &Value| report[0]["pieces"][0]["perimeter_mm"].as_f64().expect("a number");
    assert!((length(&one) / length(&mm) - 25.4).abs() < 1e-9);
    let none = place.toile("pattern inspect patterns/tshirt-s.dxf --size XXL --json").ends_with(0).json();
    assert_eq!(none[0]["pieces"].as_array().map(Vec::len), Some(0));
}

#[test]
fn body_measure_has_its_keys_and_reads_what_was_asked_for() {
    let place = Place::new();
    let built = place.toile("body build --sex f --stature-mm 1650 --chest-girth-mm 900 -o built --json").ends_with(0);
    let said = place.toile("body measure built/body.obj --sex f --json").ends_with(0);
    let measured = said.json();
    let keys = [
        "stature_mm",
        "neck_girth_mm",
        "chest_girth_mm",
        "underbust_girth_mm",
        "waist_girth_mm",
        "hip_girth_mm",
        "thigh_girth_mm",
        "upper_arm_girth_mm",
        "across_shoulder_mm",
        "inseam_mm",
        "volume_l",
        "waist_level_mm",
        "hip_level_mm",
        "chest_level_mm",
    ];
    has_keys(&measured, &keys);
    for (key, asked) in [("stature_mm", 1650.0), ("chest_girth_mm", 900.0)] {
        let found = measured[key].as_f64().expect("a number");
        assert!((found / asked - 1.0).abs() < 0.02, "{key}: {found} for {asked}");
        let of_build = built.json()[key].as_f64().expect("a number");
        assert!((found - of_build).abs() < 1.0, "{key}: {found} in the file, {of_build} when built");
    }
    for name in ["body.obj", "body.png", "measurements.json"] {
        assert!(place.path("built").join(name).is_file(), "{name}");
    }
    let scanned = place.toile("body build --scan built/body.obj --sex f -o scanned --json").ends_with(0).json();
    let posed = place.toile("body pose built/body.obj --sex f --arm-deg 60 -o posed --json").ends_with(0).json();
    for body in [scanned, posed] {
        let (found, of_scan) = (&body["waist_girth_mm"], &measured["waist_girth_mm"]);
        let off = found.as_f64().zip(of_scan.as_f64()).map(|(a, b)| (a - b).abs());
        assert!(off.is_some_and(|off| off < 1.0), "{found} for {of_scan}");
    }
    for name in ["scanned/control.json", "scanned/body.png", "posed/body.obj"] {
        assert!(place.path(name).is_file(), "{name}");
    }
    assert!(!place.path("toile.sqlite").exists(), "no database is needed to measure");
}

#[test]
fn sample_patterns_are_read() {
    let Some(folder) = shared("patterns/valentina") else { return };
    let place = Place::new();
    let mut command = place.command("pattern inspect --json");
    let output = command.arg(&folder).output().expect("it starts");
    let reports: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let reports = reports.as_array().expect("files");
    assert!(!reports.is_empty() && reports.iter().all(|report| report["error"].is_null()));
}

#[test]
fn the_quickstart_is_in_the_program() {
    let place = Place::new();
    place.toile("study check quickstart").ends_with(0);
    let repository = Path::new(env!("CARGO_MANIFEST_DIR")).join("studies/quickstart");
    let written = place.path("studies/quickstart");
    for file in ["study.toml", "patterns/tshirt-s.dxf", "patterns/tshirt-l.dxf", "patterns/tshirt.seams.toml"] {
        let [ours, theirs] =
            [&repository, &written].map(|folder| std::fs::read(folder.join(file)).expect("it is there"));
        assert!(ours == theirs, "{file}");
    }
    // One that is edited stays as it is.
    std::fs::write(written.join("study.toml"), "name = \"mine\"\n").expect("writable");
    assert!(place.toile("study check quickstart").ends_with(2).err.contains("study.toml"));
}
