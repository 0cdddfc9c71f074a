//! Stored runs, sweeps, study files and jobs as files, through the real program.

use super::durability::results;
use super::program::Place;

/// A coarse T-shirt on one man by Hybrid-GS, with more lines at the end of its study file.
fn place(more: &str) -> Place {
    let place = Place::new();
    place.hybrid_study("", &[("tee", 0.1, &["m"])], more);
    place
}

#[test]
fn a_sweep_is_run_and_its_runs_are_shown_compared_and_made_again() {
    let place = place("\n[[sweep]]\nfabric.density_kg_m2 = [0.3, 0.1]\nhybrid.relax.momentum = [0.85, 0.5]\n");
    place.toile("run . --workers 2 --no-report").ends_with(0);
    let expect = ["tee density_kg_m2=0.3 momentum=0.85,0.3,0.85", "tee density_kg_m2=0.3 momentum=0.5,0.3,0.5"];
    let swept = place.sql(
        "SELECT garment, a.value, b.value FROM v_sweep AS a JOIN v_sweep AS b USING (study, garment)
        WHERE a.parameter = 'fabric.density_kg_m2' AND b.parameter = 'hybrid.relax.momentum' ORDER BY a.value DESC, b.value DESC",
    );
    assert_eq!((swept.len(), &swept[..2]), (4, &expect.map(str::to_owned)[..]));
    assert_eq!(place.one("SELECT count(DISTINCT e_chi) FROM v_metrics"), "4", "every value matters");

    let shown = place.toile("run show 1 --json").ends_with(0).json();
    assert_eq!((&shown["status"], &shown["inputs"]["sim.hybrid.relax.momentum"]), (&"done".into(), &"0.85".into()));
    assert_eq!(shown["chi"].as_array().map(Vec::len), Some(27), "nine lengths, sewn, popped up and draped");
    assert!(shown["provenance"]["machine"].is_string() && shown["metrics"]["ei"].is_f64(), "{shown}");
    let text = place.toile("run show 1").ends_with(0).out;
    assert!(text.contains("Neck Opening") && text.contains("sim.hybrid.relax.momentum"), "{text}");

    let differ = place.toile("run diff 1 2 --json").ends_with(0).json();
    let inputs = differ["inputs"].as_array().expect("a list");
    let change = (&inputs[0]["input"], &inputs[0]["before"], &inputs[0]["after"]);
    assert_eq!((inputs.len(), change), (1, (&"sim.hybrid.relax.momentum".into(), &"0.85".into(), &"0.5".into())));
    assert!(differ["chi"].as_array().is_some_and(|chi| chi.iter().any(|row| row["same"] == false)));

    let again = place.toile("run rerun 2").ends_with(0);
    assert!(again.err.contains("the same to the last bit, 9 measurements"), "{}", again.err);
    let changed = "UPDATE chi SET l3d_mm = l3d_mm * 1.001 WHERE job_id = 2 AND measurement_no = 6";
    rusqlite::Connection::open(place.path("toile.sqlite")).expect("there").execute(changed, []).expect("valid");
    assert!(place.toile("run rerun 2").ends_with(3).err.contains("1 of 9 measurements differ"));
}

#[test]
fn jobs_as_files_give_the_same_bits_as_a_run_here() {
    let here = place("");
    let text = here.study_file();
    let text = text.replace("name = \"coarse\"", "name = \"coarse\"\nrepeats = 2");
    here.write("study.toml", &text);
    here.toile("run . --workers 1 --no-report").ends_with(0);
    let away = place("");
    away.write("study.toml", &text);
    let files = away.toile("job handout . -o jobs").ends_with(0).out;
    assert_eq!(files.lines().count(), 2);
    assert_eq!(away.one("SELECT count(*) FROM v_jobs WHERE status = 'queued'"), "2");
    for file in files.lines() {
        away.toile(&format!("job run {file} --db nowhere/none.sqlite")).ends_with(0);
    }
    assert!(!away.path("nowhere").exists(), "no database is needed");
    let merged = away.toile("job merge jobs").ends_with(0);
    assert!(merged.err.contains("2 results stored"), "{}", merged.err);
    assert_eq!(without_ease(&away), without_ease(&here));
    let before = results(&away);
    let again = away.toile("job merge jobs").ends_with(0);
    assert!(again.err.contains("0 results stored, 0 failed elsewhere, 2 were here"), "{}", again.err);
    assert_eq!(results(&away), before);

    let other = place("");
    let refused = other.toile(&format!("job merge {}", away.path("jobs").display())).ends_with(2);
    assert!(refused.err.contains("has no such job: tee m on ii of study coarse"), "{}", refused.err);
}

/// Results without the last table: ease is written with every result, and beforehand by a run here.
fn without_ease(place: &Place) -> Vec<Vec<Vec<rusqlite::types::Value>>> {
    let mut all = results(place);
    all.pop();
    all
}

#[test]
fn a_job_that_fails_elsewhere_is_failed_here_and_can_be_had_again() {
    let place = place("");
    let text = place.study_file();
    let text = text.replace("chest_girth_mm = 863", "chest_girth_mm = 600").replace("= 782", "= 1500");
    place.write("study.toml", text.replace("hip_girth_mm = 914", "hip_girth_mm = 650"));
    let file = place.toile("job handout . -o jobs").ends_with(0).out;
    let said = place.toile(&format!("job run {}", file.trim())).ends_with(4);
    assert!(said.err.contains("no adult has both"), "{}", said.err);
    assert!(place.toile("job merge jobs").ends_with(0).err.contains("1 failed elsewhere"));
    assert!(place.one("SELECT status || ': ' || error FROM v_jobs").contains("failed: body:"));
    place.toile("queue retry 1").ends_with(0);
    assert_eq!(place.one("SELECT status FROM v_jobs"), "queued");
}

#[test]
fn studies_are_started_checked_and_exported() {
    let place = Place::new();
    place.toile("study new dresses --style dress").ends_with(0);
    let said = place.toile("study check dresses").ends_with(0);
    assert!(said.err.contains("2 subjects, 1 garment, 4 simulations"), "{}", said.err);
    assert!(place.toile("study new dresses").ends_with(2).err.contains("there is a study"));
    let text = std::fs::read_to_string(place.path("dresses/study.toml")).expect("written");
    let sweep = "[[sweep]]\nfabrik = [\"denim\"]\nfem.ofset_mu = [0.4]\nedge_length_mm = [0.5]\nfabric = [\"felt\"]\n";
    place.write("dresses/study.toml", format!("{text}{sweep}"));
    let said = place.toile("study check dresses").ends_with(2);
    for says in
        ["no parameter `fabrik`", "did you mean `fem.offset_mu`?", "`edge_length_mm` is 0.5", "no fabric `felt`"]
    {
        assert!(said.err.contains(says), "{says}: {}", said.err);
    }
    assert_eq!(said.err.matches("study.toml:").count(), 4, "{}", said.err);
}

#[test]
fn a_style_of_the_catalogue_is_sewn_and_exported_with_its_files() {
    let place = place("");
    place.toile("style add shirt --seams patterns/tshirt.seams.toml --pattern S=patterns/tshirt-s.dxf M=patterns/tshirt-m.dxf")
        .ends_with(0);
    let text = place.study_file();
    let start = text.find("seams = ").expect("it names them");
    let end = text.find("fabric = ").expect("after the seams");
    let named = format!("{}style = \"shirt\"\n{}", &text[..start], &text[end..]);
    let sizes = named.find("sizes = ").expect("it has sizes");
    let rest = named[sizes..].find('\n').expect("a line") + sizes;
    place.write("named/study.toml", format!("{}sizes = [\"M\"]{}", &named[..sizes], &named[rest..]));
    let handed = place.toile("job handout named -o jobs").ends_with(0).out;
    place.toile("study export named -o out").ends_with(0);
    assert!(place.path("out/patterns/tshirt-m.dxf").exists() && !place.path("out/patterns/tshirt-s.dxf").exists());
    let again = place.toile("job handout out -o again --db other.sqlite").ends_with(0).out;
    assert_eq!(again.replace("again/", "jobs/"), handed, "the same inputs elsewhere");
    place.write(
        "named/study.toml",
        format!("{}sizes = [\"XL\"]{}", &named[..sizes], &named[rest..]).replace("shirt\"", "skirt\""),
    );
    let said = place.toile("study check named").ends_with(2);
    assert!(said.err.contains("no style in the catalogue `skirt`; did you mean `shirt`?"), "{}", said.err);
}

#[test]
fn a_population_stands_for_somebody_new() {
    let place = place("");
    let people = place.toile("study population --bodies 2 --sex m --people 200").ends_with(0).out;
    assert_eq!(people.matches("[[subject]]").count(), 2, "{people}");
    let text = place.study_file();
    let (start, end) = (text.find("[[subject]]").expect("one"), text.find("[[garment]]").expect("one"));
    place.write("study.toml", format!("{}{people}{}", &text[..start], &text[end..]));
    place.toile("run . --no-report --quiet").ends_with(0);
    let said = place.toile("study nearest coarse --sex m --stature-mm 1755 --chest-girth-mm 1050 --json").ends_with(0);
    assert!(said.err.contains("of coarse is nearest"), "{}", said.err);
    assert!(said.json()[0]["ei"].is_f64() && said.json()[0]["fit_class"].is_string(), "{}", said.out);
    let none = place.toile("study nearest coarse --sex f --stature-mm 1650").ends_with(2);
    assert!(none.err.contains("no subject of the study who is `female`"), "{}", none.err);
    place.toile("study sizes coarse -o sizes.svg").ends_with(0);
    let svg = std::fs::read_to_string(place.path("sizes.svg")).expect("written");
    assert!(svg.contains("m: 2, as meant for") && svg.matches("<title>").count() == 2, "{svg}");
    let check = |text: &str| assert!(svg.contains(&format!(">{text}</text>")), "{text}: {svg}");
    ["stature, mm", "chest girth, mm"].into_iter().for_each(check);
}

#[test]
fn jobs_keep_to_their_limits_and_results_do_not_depend_on_them() {
    let place = place("");
    let said = place.toile("run . --no-report --time-limit 0.01").ends_with(4);
    assert!(said.err.contains("limit: took longer than its time limit of 0.01 s"), "{}", said.err);
    let said = place.toile("run . --no-report --memory-limit 50").ends_with(4);
    assert!(said.err.contains("limit: needed more than its memory limit of 50 MB"), "{}", said.err);
    assert_eq!(place.one("SELECT status || ' ' || memory_limit_mb || ' ' || attempts FROM v_jobs"), "failed 50 1");
    place.toile("run . --no-report --time-limit 600 --memory-limit 4000 --quiet").ends_with(0);
    let limited = results(&place);
    let free = self::place("");
    free.toile("run . --no-report --quiet").ends_with(0);
    assert_eq!(limited, results(&free), "bit by bit");
    assert!(place.toile("run . --no-report").ends_with(0).err.contains("1 jobs, 0 to run"));
}

#[test]
fn groups_of_jobs_are_put_first_and_cancelled() {
    let place = place("\n[[sweep]]\nedge_length_mm = [60, 50]\n");
    place.toile("job handout . -o jobs").ends_with(0);
    place.toile("queue priority --to 3 --study coarse --garment tee_edge --quiet").ends_with(0);
    assert_eq!(place.one("SELECT max(priority) FROM v_jobs"), "0", "no garment of that name");
    place.toile("queue priority --to 3 2 --quiet").ends_with(0);
    assert!(place.toile("queue cancel --size m").ends_with(2).err.contains("--study"));
    place.toile("queue cancel --study coarse --size x --quiet").ends_with(0);
    place.toile("queue cancel --study coarse --size M --sim hybrid --quiet").ends_with(0);
    let jobs = place.sql("SELECT job_id, status, priority FROM v_jobs ORDER BY 1");
    assert_eq!(jobs, ["1,cancelled,0", "2,cancelled,3"]);
    place.toile("queue retry --study coarse --quiet").ends_with(0);
    place.toile("run . --workers 1 --no-report --quiet").ends_with(0);
    let first = "SELECT job_id FROM v_jobs ORDER BY started_at LIMIT 1";
    assert_eq!(place.one(first), "2", "it has priority");
}
