//! The `[[subject]]` tables of a study file: measurements, a name of the catalogue, or a scan.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use toml::Spanned;

use crate::entry::{Entry, keys};
use crate::fields::sex;
use crate::file::reader::{Place, Reader};
use crate::file::values::{lookup, numbers, source, unique};
use crate::file::{Person, Placed, ScanFile, Subject};
use body::{BodyError, Figures, LengthUnit, Measurements, Pose, Sex};
use store::files::SourceFile;

/// End of a message where a subject may name an entry of the catalogue instead.
const OR_NAMED: &str = ", or name a catalogue entry with `like`";

pub(super) fn subjects(
    reader: &mut Reader<'_>,
    top: &Place<'_>,
    folder: &Path,
    known: &BTreeMap<String, Person>,
) -> Vec<Placed<Subject>> {
    let accepted =
        [&["id", "like", "scan", "unit", "pose", "poses", "carried_from", "figure"], &keys::<Measurements>()[..]]
            .concat();
    let mut subjects = Vec::new();
    let mut ids = BTreeSet::new();
    for mut place in reader.tables(top, "subject", "subject") {
        reader.only(&place, &accepted);
        let Some(id) = reader.need_text(&place, "id", "its name in results") else { continue };
        unique(reader, &mut ids, &id, "subject");
        place.name = format!("subject {}", id.get_ref());
        let found = match (reader.text(&place, "like"), reader.text(&place, "scan")) {
            (Some(name), _) => {
                alone(reader, &place, &["id", "like", "pose", "poses", "carried_from", "figure"]);
                lookup(reader, known, &name, "subject in the catalogue").cloned()
            }
            (None, Some(file)) => {
                alone(reader, &place, &["id", "scan", "sex", "unit", "pose", "poses", "carried_from"]);
                scanned(reader, &place, &file, folder)
            }
            (None, None) => measurements(reader, &place, OR_NAMED).map(Person::from),
        };
        let pose = reader.text(&place, "pose").and_then(|name| pose(reader, &place, &name));
        let found = found.map(|person| Person { pose: pose.or(person.pose), ..person });
        let figures = reader.texts(&place, "figure").unwrap_or_default();
        let found = found.map(|person| figured(reader, &place, person, &figures));
        let poses = poses(reader, &place);
        let from = reader.text(&place, "carried_from").and_then(|name| self::pose(reader, &place, &name));
        if from.is_some() && poses.is_empty() && found.as_ref().is_some_and(|person| person.pose.is_none()) {
            let message = format!(
                "{}: `carried_from` without a pose to carry to; accepted: `pose` or `poses` beside it",
                place.name
            );
            reader.problem(&id.span(), message);
        }
        subjects.extend(found.into_iter().flat_map(|person| posed(id.get_ref(), &person, &poses, from)).map(
            |subject| {
                let name = subject.id.clone();
                reader.placed(&id.span(), &name, subject)
            },
        ));
    }
    subjects
}

fn figured(reader: &mut Reader<'_>, place: &Place<'_>, person: Person, texts: &[Spanned<&str>]) -> Person {
    let Some(first) = texts.first() else { return person };
    if person.scan.is_some() {
        let message =
            format!("{}: `figure` of a scan, which has its own; accepted: it beside measurements", place.name);
        reader.problem(&first.span(), message);
        return person;
    }
    let read = Figures::read(texts.iter().map(|text| *text.get_ref()));
    match read.and_then(|figures| figures.check(&person.measurements).map(|()| figures)) {
        Ok(figures) => Person { figures, ..person },
        Err(error) => {
            reader.problem(&first.span(), format!("{}: {error}", place.name));
            person
        }
    }
}

fn poses(reader: &mut Reader<'_>, place: &Place<'_>) -> Vec<Pose> {
    let names = reader.texts(place, "poses").unwrap_or_default();
    names.iter().filter_map(|name| pose(reader, place, name)).collect()
}

fn pose(reader: &mut Reader<'_>, place: &Place<'_>, name: &Spanned<&str>) -> Option<Pose> {
    let read = name.get_ref().parse();
    read.map_err(|error: BodyError| reader.problem(&name.span(), format!("{}: {error}", place.name))).ok()
}

/// A subject in each of `poses`, named after them; the subject unchanged where there are none. With `from`, garments
/// are put on in the pose `from` and carried into the others.
fn posed(id: &str, person: &Person, poses: &[Pose], from: Option<Pose>) -> Vec<Subject> {
    let reached = |pose: &Pose| from.map_or(*pose, |from| from.then(*pose));
    let in_pose = |id: String, pose: Option<Pose>| {
        let carried_from = from.filter(|from| pose != Some(*from));
        Subject { id, person: Person { pose, ..person.clone() }, carried_from }
    };
    if poses.is_empty() {
        return vec![in_pose(id.to_owned(), person.pose.as_ref().map(reached))];
    }
    poses.iter().map(reached).map(|pose| in_pose(format!("{id} {pose}"), Some(pose))).collect()
}

/// Reports keys that do not go together with `like` or a scan.
fn alone(reader: &mut Reader<'_>, place: &Place<'_>, accepted: &[&str]) {
    if let Some(key) = place.table.keys().find(|key| !accepted.contains(&key.get_ref().as_ref())) {
        let message = format!("{}: `{}` beside `{}`; give one or the other", place.name, key.get_ref(), accepted[1]);
        reader.problem(&key.span(), message);
    }
}

fn scanned(reader: &mut Reader<'_>, place: &Place<'_>, file: &Spanned<&str>, folder: &Path) -> Option<Person> {
    let sex = reader.text(place, "sex").and_then(|word| sex_of(reader, place, &word));
    let unit = reader.text(place, "unit").and_then(|text| {
        let unit = LengthUnit::ALL.into_iter().find(|unit| unit.name() == *text.get_ref());
        if unit.is_none() {
            let accepted = LengthUnit::ALL.map(LengthUnit::name).join(", ");
            reader.problem(&text.span(), format!("{}: unit `{}`; accepted: {accepted}", place.name, text.get_ref()));
        }
        unit
    });
    let scan = ScanFile { file: source(reader, place, file, folder, SourceFile::read)?, unit };
    let problem = |error| reader.problem(&file.span(), format!("{}: {error}", place.name));
    scan.read(sex).map(|read| read.person).map_err(problem).ok()
}

/// `or` ends the message about a missing sex.
pub(super) fn measurements(reader: &mut Reader<'_>, place: &Place<'_>, or: &str) -> Option<Measurements> {
    let word = reader.need_text(place, "sex", &format!("\"male\" or \"female\"{or}"));
    let sex = word.and_then(|word| sex_of(reader, place, &word));
    let measurements = numbers(reader, place, Measurements::blank(""), "millimetres, as in `toile subject ls`");
    let mut measurements = measurements?;
    measurements.sex = sex?;
    Some(measurements)
}

fn sex_of(reader: &mut Reader<'_>, place: &Place<'_>, word: &Spanned<&str>) -> Option<Sex> {
    sex(word.get_ref()).map_err(|problem| reader.problem(&word.span(), format!("{}: {problem}", place.name))).ok()
}
