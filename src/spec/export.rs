//! Export of a study: a study file with all files that it names, to repeat the study elsewhere.

use std::collections::BTreeMap;
use std::fmt::Write;

use crate::fields::{FABRIC_NUMBERS, MEASUREMENTS, millimetres, sex_name};
use crate::file::{GarmentEntry, ScanFile, Study, Subject};
use crate::job;
use crate::schedule::Schedule;
use fit::target::{Intended, Target};
use geom::units::mm;
use sim::Fabric;
use store::files::SourceFile;

impl Study {
    pub fn jobs(&self) -> usize {
        job::jobs(self).len()
    }
}

/// Returns the files that repeat a study elsewhere. The study file names nothing of the catalogue, so each job keeps
/// its inputs; patterns and scans lie beside it.
pub fn export_study(study: &Study) -> Vec<(String, Vec<u8>)> {
    let mut files: Files = BTreeMap::new();
    let mut text = "# Written by `toile study export`.\n\n".to_owned();
    let simulators: Vec<&str> = study.simulators.iter().map(|simulator| simulator.as_str()).collect();
    // Writing into a `String` does not fail, here and below.
    let _ = writeln!(
        text,
        "name = {}\nsimulators = {}\nrepeats = {}",
        quoted(&study.name),
        list(&simulators),
        study.repeats
    );
    let (tight, loose) = (mm(study.cuts.tight_below_m), mm(study.cuts.loose_above_m));
    let _ = writeln!(text, "fit = {{ tight_below_mm = {tight}, loose_above_mm = {loose} }}");
    for subject in &study.subjects {
        write_subject(&mut text, &mut files, subject);
    }
    let mut fabrics: BTreeMap<&str, &Fabric> = BTreeMap::new();
    for garment in &study.garments {
        write_garment(&mut text, &mut files, garment);
        fabrics.insert(&garment.fabric.name, &garment.fabric);
    }
    for fabric in fabrics.into_values() {
        let _ = writeln!(text, "\n[[fabric]]\nname = {}\nsource = {}", quoted(&fabric.name), quoted(&fabric.source));
        for field in FABRIC_NUMBERS.iter() {
            if let Some(number) = field.get(fabric) {
                let _ = writeln!(text, "{} = {number:?}", field.key);
            }
        }
    }
    files.insert("study.toml".to_owned(), text.into_bytes());
    files.into_iter().collect()
}

/// Contents of files by path within the folder.
pub type Files = BTreeMap<String, Vec<u8>>;

fn write_subject(text: &mut String, files: &mut Files, subject: &Subject) {
    let _ = writeln!(
        text,
        "\n[[subject]]\nid = {}\nsex = \"{}\"",
        quoted(&subject.id),
        sex_name(&subject.person.measurements)
    );
    let poses = [("pose", subject.person.pose), ("carried_from", subject.carried_from)];
    for (key, pose) in poses {
        let _ = pose.map(|pose| writeln!(text, "{key} = \"{pose}\""));
    }
    if let Some(ScanFile { file, unit }) = &subject.person.scan {
        let _ = writeln!(text, "scan = {}", quoted(&place(files, "scans", file)));
        if let Some(unit) = unit {
            let _ = writeln!(text, "unit = \"{}\"", unit.name());
        }
        return;
    }
    for field in MEASUREMENTS.iter() {
        if let Some(value) = field.get(&subject.person.measurements) {
            let _ = writeln!(text, "{} = {value:?}", field.key);
        }
    }
}

fn write_garment(text: &mut String, files: &mut Files, garment: &GarmentEntry) {
    let _ = writeln!(text, "\n[[garment]]\nname = {}", quoted(&garment.name));
    if garment.style != garment.name {
        let _ = writeln!(text, "style = {}", quoted(&garment.style));
    }
    let wearers: Vec<&str> = garment.subjects.iter().map(String::as_str).collect();
    let _ = writeln!(text, "subjects = {}\nfabric = {}", list(&wearers), quoted(&garment.fabric.name));
    let _ = writeln!(text, "edge_length_mm = {:?}", millimetres(garment.edge_length_m));
    if let Some(unit) = &garment.unit {
        let _ = writeln!(text, "unit = {}", quoted(unit));
    }
    if let Some(seams) = &garment.seams {
        let _ = writeln!(text, "seams = {}", quoted(&place(files, "patterns", seams)));
    }
    text.push_str("sizes = [\n");
    for size in &garment.sizes {
        let pattern = quoted(&place(files, "patterns", &size.pattern));
        let _ = writeln!(text, "    {{ name = {}, pattern = {pattern} }},", quoted(&size.name));
    }
    text.push_str("]\n");
    for (name, value) in garment.parameters.iter() {
        let _ = writeln!(text, "parameters.{name} = {value}");
    }
    let Target { intended, own_m, .. } = &garment.target;
    if *intended != Intended::default() {
        let _ = writeln!(text, "intended_fit = \"{}\"", intended.as_str());
    }
    for (level, [least, most]) in own_m {
        let _ = writeln!(text, "target_ease_mm.{level} = [{:?}, {:?}]", millimetres(*least), millimetres(*most));
    }
    let Schedule { priority, after, limits } = &garment.schedule;
    if *priority != 0 {
        let _ = writeln!(text, "priority = {priority}");
    }
    if !after.is_empty() {
        let _ = writeln!(text, "after = {}", list(&after.iter().map(String::as_str).collect::<Vec<_>>()));
    }
    if let Some(seconds) = limits.time_s {
        let _ = writeln!(text, "time_limit_s = {seconds:?}");
    }
    if let Some(megabytes) = limits.memory_mb {
        let _ = writeln!(text, "memory_limit_mb = {megabytes}");
    }
}

/// Puts a file, or the files of a folder, below `folder` under its own name, since the name is an input of results.
/// Where another file has this name already, goes one folder deeper. Returns the path.
pub fn place(files: &mut Files, folder: &str, source: &SourceFile) -> String {
    let mut folder = folder.to_owned();
    loop {
        let path = format!("{folder}/{}", source.name);
        let parts: Vec<(String, Vec<u8>)> = if source.name.ends_with('/') {
            source.parts().into_iter().map(|part| (format!("{path}{}", part.name), part.bytes.to_vec())).collect()
        } else {
            vec![(path.clone(), source.bytes.to_vec())]
        };
        if parts.iter().all(|(path, bytes)| files.get(path).is_none_or(|there| there == bytes)) {
            files.extend(parts);
            return path;
        }
        folder.push_str("/other");
    }
}

/// Quotes a text for TOML.
pub(crate) fn quoted(text: &str) -> String {
    toml::Value::from(text).to_string()
}

/// Writes texts as a list of TOML.
pub(crate) fn list(texts: &[&str]) -> String {
    format!("[{}]", texts.iter().map(|text| quoted(text)).collect::<Vec<_>>().join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_of_one_name_do_not_overwrite_each_other() {
        let mut files = Files::new();
        let source = |text: &str| SourceFile { name: "s.dxf".into(), bytes: text.as_bytes().into() };
        assert_eq!(place(&mut files, "patterns", &source("one")), "patterns/s.dxf");
        assert_eq!(place(&mut files, "patterns", &source("two")), "patterns/other/s.dxf");
        assert_eq!(place(&mut files, "patterns", &source("one")), "patterns/s.dxf");
        assert_eq!(files.len(), 2);
    }
}
