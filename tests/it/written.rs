//! Files that are written: none outside of its folder, none over another, each of the format that its name says. Tables
//! that are read: problems at their true lines.

use std::collections::BTreeSet;

use super::program::{Place, files};
use super::report::between;

/// A study of coarse T-shirts on one man, a garment with one size for each of some names.
fn study(place: &Place, name: &str, garments: &[(&str, &str)]) {
    place.draft();
    let mut text = format!(
        "name = {name:?}\nedge_length_mm = 60\nsimulators = [\"hybrid\"]\n[[subject]]\nid = \"a/b\"\nsex = \"male\"\nstature_mm = 1690\n\
         chest_girth_mm = 863\n"
    );
    for (garment, size) in garments {
        text += &format!(
            "[[garment]]\nname = {garment:?}\nseams = \"patterns/tshirt.seams.toml\"\nfabric = \"poplin\"\n\
             sizes = [{{ name = {size:?}, pattern = \"patterns/tshirt-m.dxf\" }}]\n"
        );
    }
    place.write("study.toml", text);
}

#[test]
fn a_report_keeps_to_its_folder_whatever_its_parts_are_called() {
    let place = Place::new();
    study(&place, "my 上衣", &[("上衣", "2X"), ("衬衫", "2X"), ("../tee", "/../../../../OUTSIDE")]);
    let before = files(&place.path("."));
    place.toile("--db a/b/c.sqlite run .").ends_with(0);
    let mut after = files(&place.path("."));
    after.retain(|file| !before.contains(file) && !file.starts_with("a/b/c.sqlite"));
    let report = "a/b/reports/my 上衣/";
    let outside: Vec<&String> = after.iter().filter(|file| !file.starts_with(report)).collect();
    assert!(outside.is_empty(), "{outside:?}");
    let written: BTreeSet<&str> = after.iter().filter_map(|file| file.strip_prefix(report)).collect();
    for file in [
        "pictures/try-on-上衣-2X.jpg",
        "pictures/try-on-衬衫-2X.jpg",
        "pictures/try-on-tee-OUTSIDE.jpg",
        "pattern-衬衫-2X.svg",
        "charts/上衣-size-2x-ei.png",
        "charts/衬衫-size-2x-ei.svg",
    ] {
        assert!(written.contains(file), "{file} of {written:?}");
    }
    // What a page links to is there, and nothing is linked for two garments.
    let mut linked = Vec::new();
    for page in ["index.html", "compare.html"] {
        let page = std::fs::read_to_string(place.path(report).join(page)).expect("a page");
        linked.extend(between(&page, "href=\"", "\"").filter(|link| !link.starts_with('#')).map(str::to_owned));
    }
    for link in &linked {
        assert!(written.contains(link.as_str()), "{link} of {written:?}");
    }
    let charts: Vec<&String> = linked.iter().filter(|link| link.starts_with("charts/")).collect();
    assert_eq!(charts.iter().collect::<BTreeSet<_>>().len(), charts.len(), "{charts:?}");
}

#[test]
fn a_study_is_called_as_its_folder_may_be() {
    let place = Place::new();
    let check = |name: &str, code: i32| {
        study(&place, name, &[("tee", "m")]);
        place.toile("study check .").ends_with(code).err
    };
    for good in ["mine", "T-shirt, 2nd try", "上衣", "a: b"] {
        check(good, 0);
    }
    for bad in ["../../../OUT", "/tmp/x", "a\\b", "..", "", " ", "a\nb"] {
        let told = check(bad, 2);
        let found = format!("study.toml:1:8: study: `name` is {bad:?}; accepted: a name that a folder may have");
        assert!(told.contains(&found), "{bad:?}: {told}");
    }
}

#[test]
fn a_file_has_the_format_of_its_ending() {
    let place = Place::new();
    place.draft();
    place.write("q.sql", "SELECT 1 AS x, '=1+2' AS y");
    let before = files(&place.path("."));
    let shirt = "patterns/tshirt-m.dxf";
    let check = |arguments: &str, accepted: &str| {
        let told = place.toile(arguments).ends_with(2).err;
        assert!(told.contains(&format!("accepted: {accepted}")), "{arguments}: {told}");
    };
    check("sql -f q.sql -o x.ods", "X.csv, X.json, X.parquet, X.xlsx or X.txt");
    check("sql -f q.sql -o x", "X.csv, X.json, X.parquet, X.xlsx or X.txt");
    check("sql -f q.sql --format csv -o x.parquet", "X.csv");
    check("sql -f q.sql --format parquet -o x.dat", "X.parquet");
    check("export 1 -o x.fbx", "X.glb, X.obj, X.ply or X.stl");
    check("export 1 --format glb -o x.obj", "X.glb");
    check("render 1 -o x.jpg", "X.png");
    check("render 1 -o x.apng", "X.png");
    check("render 1 --turntable 4 -o x.gif", "X.png or X.apng");
    check("section . -o x.pdf", "X.svg or X.png");
    check("chance . -o x.pdf", "X.svg or X.png");
    check("study sizes . -o x.png", "X.svg");
    check(&format!("pattern sheet {shirt} -o x.png"), "X.svg");
    check(&format!("pattern pom {shirt} -o x.pdf"), "X.csv, X.xlsx or X.svg");
    check(&format!("pattern features {shirt} -o x.csv"), "X.json");
    check(&format!("pattern propose {shirt} -o x.json"), "X.toml");
    check(&format!("pattern convert {shirt} -o x.svg"), "X.dxf or X.json");
    check(&format!("pattern convert {shirt} --with-rul -o x.json"), "X.dxf");
    check(&format!("pattern sew {shirt} --body a.toml -o x.svg"), "X.png");
    check("job run j.json -o x.csv", "X.json");
    for folder in [
        "report . -o x.pdf",
        "alter . --subject a --size m -o x.dxf",
        "grade . -o x.xlsx",
        "pattern draft -o x.dxf",
        "body build --sex m --stature-mm 1760 -o x.obj",
        "study export . -o x.toml",
        "job handout . -o x.json",
        &format!("try --body a.toml --pattern {shirt} -o x.PNG"),
        "audit garments . --bodies . -o x.json",
    ] {
        let told = place.toile(folder).ends_with(2).err;
        assert!(told.contains("found a name of a file; accepted: a folder"), "{folder}: {told}");
    }
    let mut after = files(&place.path("."));
    after.retain(|file| !before.contains(file) && !file.starts_with("toile.sqlite"));
    assert!(after.is_empty(), "{after:?}");
}

#[test]
fn rows_are_written_in_the_format_of_the_file() {
    let place = Place::new();
    place.write("q.sql", "SELECT 1 AS x, '=1+2' AS y");
    let check = |arguments: &str, file: &str, begins: &[u8]| {
        place.toile(&format!("sql -f q.sql {arguments} -o {file}")).ends_with(0);
        let bytes = std::fs::read(place.path(file)).expect("it is written");
        assert!(bytes.starts_with(begins), "{arguments} {file}: {}", String::from_utf8_lossy(&bytes));
    };
    check("", "x.csv", b"x,y\n1,'=1+2\n");
    check("", "x.JSON", b"[\n  {\n    \"x\": 1,\n    \"y\": \"=1+2\"");
    check("", "x.parquet", b"PAR1");
    check("", "x.xlsx", b"PK");
    check("", "x.txt", " x   y\n──".as_bytes());
    check("--format csv", "y.csv", b"x,y\n");
    check("--format csv", "y", b"x,y\n");
    check("--json", "z.csv", b"x,y\n");
}

#[test]
fn a_table_says_its_true_lines() {
    let place = Place::new();
    let rows = ["name,sex,stature_mm", "anna,f,1650", "ben,m,165", "carl,m,1750"];
    let table = |rows: &[&str], end: &str| rows.join(end) + end;
    let check = |name: &str, text: String, line: usize| {
        place.write(name, text);
        let told = place.toile(&format!("subject import {name}")).ends_with(2).err;
        let found = format!("{name}:{line}: column 3: `stature_mm` is 165; accepted: ");
        assert!(told.contains(&found), "{told}");
    };
    let [head, good, bad, last] = rows;
    for (name, end) in [("lf.csv", "\n"), ("crlf.csv", "\r\n"), ("cr.csv", "\r")] {
        check(name, table(&rows, end), 3);
        check(name, table(&["", head, "", "", good, ",,", bad, last], end), 7);
        check(name, table(&[head, &format!("\"anna{end}\",f,1650"), bad, last], end), 4);
    }
    place.write("crlf.csv", table(&rows, "\r\n"));
    let told = place.toile("subject import --good-rows crlf.csv").ends_with(3).err;
    assert!(told.contains("left out: crlf.csv:3: ") && told.contains("anna") && told.contains("carl"), "{told}");
}

#[test]
fn names_that_look_like_formulas_come_back_as_they_were() {
    let place = Place::new();
    let names = ["=1+2", "@home", "+49 170", "-left", "'=1", "plain"];
    let cells = ["'=1+2", "'@home", "'+49 170", "'-left", "''=1", "plain"];
    let rows = cells.map(|cell| format!("{cell};f;1651\n"));
    place.write("people.csv", format!("name;sex;stature_mm\n{}", rows.concat()));
    place.toile("subject import people.csv").ends_with(0);
    let ours = "SELECT * FROM v_subjects WHERE is_latest AND stature_mm = 1651";
    place.write("ours.sql", ours);
    place.toile("sql -f ours.sql -o again.csv").ends_with(0);
    let text = std::fs::read_to_string(place.path("again.csv")).expect("written");
    for cell in cells {
        assert!(text.lines().any(|line| line.split(',').any(|found| found == cell)), "{cell}: {text}");
    }
    let another = Place::new();
    another.write("again.csv", text);
    another.toile("subject import again.csv").ends_with(0);
    another.write("ours.sql", ours);
    let rows = another.toile("sql -f ours.sql --format json").ends_with(0).json();
    let found: BTreeSet<&str> =
        rows.as_array().expect("rows").iter().filter_map(|row| row["subject"].as_str()).collect();
    assert_eq!(found, BTreeSet::from(names));
}
