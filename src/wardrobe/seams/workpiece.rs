//! A size of a style whose seams are worked on: its pattern, and the text of its seam file.

use std::path::{Path, PathBuf};

use crate::error::WardrobeError;
use crate::seams::desk::{Desk, SURE, confidences, confirmed, hold_for};
use crate::seams::rework::Reworked;
use crate::seams::step::SeamStep;
use crate::seams::undecided::Undecided;
use geom::units::mm;
use pattern::check::{self, Finding, FindingKind};
use pattern::propose::{self, Answers, Question};
use pattern::seam_edit::{Sizes, edited};
use pattern::seams::{DEFAULT_LENGTH_TOLERANCE_MM, SeamFile};
use pattern::style::Style;
use spec::patterns::{self, Nest, SizePieces, Unit};
use store::files::SourceFile;
use store::{InOrigin, Origin, Problem, Result, StudyError};

/// Start of a line with a question that a person must answer.
const QUESTION: &str = "# ASK: ";
/// Start of a line with a question that is settled: a person has said that the file is right as it is.
const SETTLED: &str = "# SETTLED: ";
/// Start of a line with a question that a person has answered.
const ANSWERED: &str = "# ANSWERED: ";

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Workpiece {
    pub pattern: SourceFile,
    /// `None` where the pattern holds its seams, or where there is none yet.
    pub seams: Option<SourceFile>,
    pub size: String,
    /// Unit of the pattern, where its file names none.
    pub unit: Option<Unit>,
}

/// A measurement on the pieces.
#[derive(Clone, Debug, PartialEq)]
pub struct DeskLength {
    /// Number by which tables and drawings name it (`#1`).
    pub no: u32,
    pub name: String,
    pub l2d_mm: f64,
}

#[derive(Clone, Debug, PartialEq)]
pub struct LaidOut {
    /// Unconfirmed proposed seams have their confidence.
    pub desk: Desk,
    /// Measurements of the seam file, in its order.
    pub lengths: Vec<DeskLength>,
    /// Open questions: those of a proposal, unsure seams, and findings of a check.
    pub undecided: Vec<Undecided>,
    pub answered: usize,
    /// Difference in length between the sides of a seam above which a check reports it.
    pub tolerance_mm: f64,
}

impl Workpiece {
    /// `size` is `None` for the sample size.
    pub fn open(pattern: &Path, seams: Option<&Path>, size: Option<&str>, unit: Option<Unit>) -> Result<Self> {
        let (pattern, seams) = (SourceFile::read_pattern(pattern)?, seams.map(SourceFile::read).transpose()?);
        let size = match size {
            Some(size) => size.to_owned(),
            None => Nest::read(&pattern, unit)?.sample_size().to_owned(),
        };
        Ok(Self { pattern, seams, size, unit })
    }

    pub fn laid_out(&self) -> Result<LaidOut> {
        let style = patterns::read_style(&self.pattern, self.seams.as_ref(), Some(&self.size), self.unit)?;
        let mut desk = Desk::of(&style);
        let (mut undecided, mut answered, mut tolerance_mm) = (vec![], 0, DEFAULT_LENGTH_TOLERANCE_MM);
        if let Some((file, text)) = self.seams.as_ref().zip(self.text()).filter(|_| !self.pattern.holds_seams()) {
            for (seam, confidence) in desk.seams.iter_mut().zip(confidences(&text)) {
                seam.confidence = confidence;
            }
            let asked: Vec<Question> = marked(&text, QUESTION).collect();
            // If the proposal has a question about a seam, no second question asks about its confidence.
            let is_new = |seam: &usize| {
                let name = &desk.seams[*seam].name;
                !asked.iter().any(|question| question.text.split_once(": ").is_some_and(|(about, _)| about == name))
            };
            undecided.extend((0..desk.seams.len()).filter(is_new).filter_map(|seam| Undecided::unsure(&desk, seam)));
            let entries = SeamFile::parse(&file.bytes, &file.name).origin(Origin::Pattern)?;
            let drawn = self.drawn(&entries, &desk)?;
            undecided.splice(0..0, asked.into_iter().map(|question| Undecided::asked(&desk, &drawn, question)));
            answered = marked(&text, ANSWERED).count();
            tolerance_mm = entries.length_tolerance_mm;
            let found = self.findings(&style)?;
            // A piece that the file does not name is left out on purpose, so it raises no question.
            let is_left_out = |finding: &&Finding| finding.kind == FindingKind::UnusedPiece;
            desk.left_out = found.iter().filter(is_left_out).map(|finding| finding.place.clone()).collect();
            let unsewn: Vec<usize> = (0..desk.pieces.len()).filter(|piece| desk.is_unsewn(*piece)).collect();
            undecided.extend(unsewn.iter().map(|piece| Undecided::unsewn(&desk, *piece)));
            // The edges of a piece without a role raise questions once it has one.
            let is_of_unsewn = |finding: &&Finding| {
                let is_on = |piece: &usize| finding.place.starts_with(&format!("{}.", desk.pieces[*piece].id));
                finding.kind == FindingKind::FreeEdge && unsewn.iter().any(is_on)
            };
            let is_open =
                |finding: &&Finding| finding.kind.is_of_seams() && !is_left_out(finding) && !is_of_unsewn(finding);
            undecided.extend(found.iter().filter(is_open).map(|finding| Undecided::found(&desk, finding)));
        }
        let length =
            |m: &pattern::style::StyleMeasurement| DeskLength { no: m.no, name: m.name.clone(), l2d_mm: mm(m.l2d_m) };
        let lengths = style.measurements.iter().map(length).collect();
        Ok(LaidOut { desk, lengths, undecided, answered, tolerance_mm })
    }

    /// Pieces of the desk, each by its names in the pattern file.
    fn drawn(&self, entries: &SeamFile, desk: &Desk) -> Result<Vec<(String, usize)>> {
        let pieces = patterns::pieces(&self.pattern, Some(&self.size), self.unit)?;
        let mut drawn = Vec::new();
        for (k, piece) in desk.pieces.iter().enumerate() {
            let Some(entry) = entries.piece.get(&piece.id) else { continue };
            let own = pieces.iter().filter(|piece| piece.block == entry.block || piece.name == entry.block);
            let names = std::iter::once(&entry.block).chain(own.map(|piece| &piece.name));
            drawn.extend(names.map(|name| (name.clone(), k)));
        }
        drawn.sort_by(|(name, k), (other, j)| (k, name).cmp(&(j, other)));
        drawn.dedup();
        Ok(drawn)
    }

    /// Fails where the pattern holds its own seams.
    pub fn after(&self, step: &SeamStep) -> Result<SourceFile> {
        let pattern = || self.pattern.name.clone();
        if self.pattern.holds_seams() {
            return Err(WardrobeError::HoldsSeams { pattern: pattern() }.into());
        }
        if let SeamStep::Propose(style) = step {
            return self.proposed(style);
        }
        if let SeamStep::Written(file) = step {
            let pieces = patterns::pieces(&self.pattern, Some(&self.size), self.unit)?;
            Style::read(&pieces, &file.bytes, &file.name).origin(Origin::Pattern)?;
            return Ok(file.clone());
        }
        let missing = || WardrobeError::NoSeamFile { pattern: pattern() };
        let (file, text) = self.seams.as_ref().zip(self.text()).ok_or_else(missing)?;
        let text = match step {
            SeamStep::Edit(edit) => {
                self.with_sizes(|sizes| edited(&text, &file.name, sizes, edit).origin(Origin::Pattern))?
            }
            SeamStep::Confirm(seam) => confirmed(&text, |name, _| name == seam)
                .ok_or_else(|| WardrobeError::NoSeam { file: file.name.clone(), seam: seam.clone() })?,
            SeamStep::ConfirmSure => confirmed(&text, |_, confidence| confidence.is_some_and(|sure| sure >= SURE))
                .ok_or_else(|| WardrobeError::NoneSure { file: file.name.clone(), percent: 100.0 * SURE })?,
            SeamStep::Answer { question, choice } => self.answered(&text, question, *choice)?,
            SeamStep::Decide(question) => {
                let kept = settled(&text, question);
                if kept == text {
                    return Err(WardrobeError::NotAsked { question: question.clone() }.into());
                }
                kept
            }
            SeamStep::Propose(_) | SeamStep::Written(_) => text,
        };
        Ok(SourceFile { name: file.name.clone(), bytes: text.into_bytes().into() })
    }

    /// Calls `act` with the pieces of all sizes that can be sewn.
    fn with_sizes<T>(&self, act: impl FnOnce(&Sizes<'_>) -> Result<T>) -> Result<T> {
        let nest = Nest::read(&self.pattern, self.unit)?;
        let (pieces, others) = (nest.pieces(&self.size)?, nest.others(&self.size));
        let others: Vec<_> = others.into_iter().filter_map(|other| Some((other.size, other.pieces.ok()?))).collect();
        act(&Sizes { name: &self.size, pieces: &pieces, others: &others })
    }

    /// Proposes a seam file, checked on all sizes of the pattern.
    pub fn proposed(&self, style: &str) -> Result<SourceFile> {
        self.proposed_for(style, Nest::read(&self.pattern, self.unit)?.others(&self.size))
    }

    /// Proposes a seam file as [`Workpiece::proposed`] does, checked on the sizes `others`.
    pub(crate) fn proposed_for(&self, style: &str, others: Vec<SizePieces>) -> Result<SourceFile> {
        self.proposed_with_answers(style, others, &Answers::new())
    }

    /// Confirmed seams that are proposed again stay confirmed.
    fn answered(&self, text: &str, question: &str, choice: usize) -> Result<String> {
        let asked: Vec<Question> = marked(text, QUESTION).chain(marked(text, ANSWERED)).collect();
        let known = asked.iter().find(|asked| asked.text == question);
        if known.is_none_or(|known| choice >= known.choices.len()) {
            let accepted: Vec<String> = asked.iter().map(Question::to_string).collect();
            return Err(WardrobeError::Answer {
                question: question.to_owned(),
                letter: Question::letter(choice),
                accepted: accepted.join("; or "),
            }
            .into());
        }
        let given = marked(text, ANSWERED).filter_map(|answered| Some((answered.text, answered.taken?)));
        let before: Answers = given.collect();
        let mut answers = before.clone();
        answers.insert(question.to_owned(), choice);
        let file = self.seams.as_ref().map_or("", |file| file.name.as_str());
        let entries = |text: &str| SeamFile::parse(text.as_bytes(), file).origin(Origin::Pattern);
        let old = entries(text)?;
        let proposed = |answers| {
            let others = Nest::read(&self.pattern, self.unit)?.others(&self.size);
            let proposed = self.proposed_with_answers(&old.name, others, answers)?;
            Ok::<_, StudyError>(String::from_utf8_lossy(&proposed.bytes).into_owned())
        };
        let rework = Reworked { proposed: &proposed(&before)?, own: text, file };
        let again = self.with_sizes(|sizes| rework.done_again(proposed(&answers)?, sizes))?;
        let new = entries(&again)?;
        let confirmed_before = old.seam.iter().zip(confidences(text)).filter(|(_, confidence)| confidence.is_none());
        let proposed_again = confirmed_before.filter(|(seam, _)| new.seam.contains(seam));
        let kept: Vec<&str> = proposed_again.map(|(seam, _)| seam.name.as_str()).collect();
        let again = confirmed(&again, |name, _| kept.contains(&name)).unwrap_or(again);
        let before: Vec<String> = marked(text, SETTLED).map(|question| question.to_string()).collect();
        Ok(before.iter().fold(again, |again, question| settled(&again, question)))
    }

    fn proposed_with_answers(&self, style: &str, others: Vec<SizePieces>, answers: &Answers) -> Result<SourceFile> {
        let pieces = patterns::pieces(&self.pattern, Some(&self.size), self.unit)?;
        let mut proposal = propose::propose_told(&pieces, answers);
        if proposal.is_empty() {
            return Err(WardrobeError::NotRecognised { pattern: self.pattern.name.clone() }.into());
        }
        hold_for(&mut proposal, &self.size, &pieces, others);
        let name = self.seams.as_ref().map_or_else(|| format!("{style}.seams.toml"), |file| file.name.clone());
        let text = proposal.toml(style);
        Style::read(&pieces, text.as_bytes(), &name).origin(Origin::Pattern)?;
        Ok(SourceFile { name, bytes: text.into_bytes().into() })
    }

    /// Edges that the seam file leaves open, as `PIECE.EDGE`.
    pub fn open_edges(&self) -> Vec<String> {
        let entries = self.seams.as_ref().and_then(|file| SeamFile::parse(&file.bytes, &file.name).ok());
        entries.map_or_else(Vec::new, |entries| entries.open)
    }

    /// Empty for a pattern that holds its own seams.
    pub fn findings(&self, style: &Style) -> Result<Vec<Finding>> {
        let Some(file) = self.seams.as_ref().filter(|_| !self.pattern.holds_seams()) else { return Ok(Vec::new()) };
        let entries = SeamFile::parse(&file.bytes, &file.name).origin(Origin::Pattern)?;
        let pieces = patterns::pieces(&self.pattern, Some(&self.size), self.unit)?;
        Ok(check::findings(&pieces, &entries, style))
    }

    /// Questions of the proposal that nobody has answered or settled.
    pub fn asked(&self) -> Vec<Question> {
        self.text().map_or_else(Vec::new, |text| marked(&text, QUESTION).collect())
    }

    fn text(&self) -> Option<String> {
        Some(String::from_utf8_lossy(&self.seams.as_ref()?.bytes).into_owned())
    }
}

fn settled(text: &str, question: &str) -> String {
    let line = |line: &str| match line.strip_prefix(QUESTION) {
        Some(asked) if asked.trim_end() == question => format!("{SETTLED}{asked}"),
        _ => line.to_owned(),
    };
    text.split_inclusive('\n').map(line).collect()
}

/// Questions on the lines of a seam file that begin with `mark`.
fn marked<'a>(text: &'a str, mark: &'a str) -> impl Iterator<Item = Question> + 'a {
    text.lines().filter_map(move |line| line.strip_prefix(mark)).map(|line| Question::parse(line.trim_end()))
}

/// Checks the result against the pattern. Comments in the file stay.
pub fn edit_seams(
    pattern: &Path,
    seams: &Path,
    size: Option<&str>,
    unit: Option<Unit>,
    step: &SeamStep,
) -> Result<SourceFile> {
    Workpiece::open(pattern, Some(seams), size, unit)?.after(step)
}

/// Path of a style's seam file in the folder of a study, if its contents are still the stored ones.
pub fn seam_home(study: &Path, style: &str, stored: &SourceFile) -> Option<PathBuf> {
    let text = std::fs::read_to_string(study).ok()?;
    let table: toml::Table = text.parse().ok()?;
    let of_style = |garment: &&toml::Value| garment.get("name").and_then(toml::Value::as_str) == Some(style);
    let garment = table.get("garment")?.as_array()?.iter().find(of_style)?;
    let path = study.parent()?.join(garment.get("seams")?.as_str()?);
    std::fs::read(&path).is_ok_and(|bytes| *bytes == *stored.bytes).then_some(path)
}

/// Fails where the contents are no longer those of `before`.
pub fn write_seams(path: &Path, before: &SourceFile, after: &SourceFile) -> Result<()> {
    let found = std::fs::read(path).map_err(StudyError::io(path))?;
    if *found != *before.bytes {
        let problem = Problem::of(path, "it was changed meanwhile and stays as it is; the catalogue has the edits");
        return Err(StudyError::File(vec![problem]));
    }
    std::fs::write(path, &after.bytes).map_err(StudyError::io(path))
}

#[cfg(test)]
mod tests {
    use super::*;
    use pattern::draft::Model;
    use pattern::seam_edit::Edit;

    fn tshirt(seams: Option<String>) -> Workpiece {
        let files = Model::Tshirt.files();
        let (name, bytes) = files.into_iter().find(|(name, _)| name.ends_with("s.dxf")).expect("a size S");
        let seams = seams.map(|text| SourceFile { name: "t.seams.toml".into(), bytes: text.into_bytes().into() });
        Workpiece { pattern: SourceFile { name, bytes: bytes.into() }, seams, size: "S".into(), unit: None }
    }

    fn own_seams() -> String {
        String::from_utf8(Model::Tshirt.seams().to_vec()).expect("it is UTF-8")
    }

    #[test]
    fn a_style_is_laid_out_with_its_lengths_and_without_questions() {
        let laid = tshirt(Some(own_seams())).laid_out().expect("it reads");
        assert!(laid.desk.pieces.len() == 4 && laid.undecided.is_empty(), "{:?}", laid.undecided);
        assert!(laid.desk.seams.iter().all(|seam| seam.confidence.is_none()));
        let hem = laid.lengths.iter().find(|length| length.no == 1).expect("number 1");
        assert!((hem.l2d_mm - 974.0).abs() < 0.2, "{hem:?}");
    }

    #[test]
    fn a_proposal_is_confirmed_seam_by_seam_and_the_rest_of_its_text_stays() {
        let mut piece = tshirt(None);
        assert!(
            piece.after(&SeamStep::Confirm("x".into())).expect_err("nothing yet").to_string().contains("propose one")
        );
        piece.seams = Some(piece.after(&SeamStep::Propose("tee".into())).expect("known pieces"));
        let laid = piece.laid_out().expect("it fits");
        let seams = laid.desk.seams.len();
        assert!(seams >= 8 && laid.desk.seams.iter().all(|seam| seam.confidence.is_some()));
        let name = laid.desk.seams[2].name.clone();
        let before = piece.text().expect("proposed");
        piece.seams = Some(piece.after(&SeamStep::Confirm(name.clone())).expect("it is there"));
        let laid = piece.laid_out().expect("it fits");
        let sure: Vec<&str> =
            laid.desk.seams.iter().filter(|seam| seam.confidence.is_none()).map(|seam| seam.name.as_str()).collect();
        assert_eq!(sure, [name.as_str()]);
        let after = piece.text().expect("proposed");
        let changed = before.lines().zip(after.lines()).filter(|(before, after)| before != after).count();
        assert_eq!((before.lines().count(), changed), (after.lines().count(), 1));
        assert!(piece.after(&SeamStep::Confirm("none".into())).is_err());
        piece.seams = Some(piece.after(&SeamStep::ConfirmSure).expect("most are"));
        let left = piece.laid_out().expect("it fits").desk.seams;
        assert!(left.iter().all(|seam| seam.confidence.is_none_or(|sure| sure < SURE)), "{left:?}");
    }

    #[test]
    fn what_is_settled_stays_so_when_a_question_is_answered() {
        let asked = "which is it? a: the right one; b: the left one (a is taken)";
        let text = format!("{QUESTION}{asked}\n{QUESTION}is it whole?\nname = \"a\"\n");
        let once = settled(&text, "is it whole?");
        assert_eq!(once, format!("{QUESTION}{asked}\n{SETTLED}is it whole?\nname = \"a\"\n"));
        assert_eq!(settled(&once, "is it whole?"), once, "nobody asks it any more");
        assert_eq!(marked(&once, QUESTION).count(), 1);
    }

    #[test]
    fn an_opened_seam_leaves_free_edges_to_decide_on() {
        let mut piece = tshirt(Some(own_seams()));
        let edit = Edit::Remove { a: "front.side_right".into(), b: "back.side_right".into() };
        piece.seams = Some(piece.after(&SeamStep::Edit(edit)).expect("it is there"));
        let undecided = piece.laid_out().expect("it fits").undecided;
        let free = undecided.iter().find(|asked| asked.text.contains("back.side_right")).expect("it is said").clone();
        assert!(piece.after(&SeamStep::Decide(free.text.clone())).is_err(), "the check finds it, nobody asks it");
        // The likeliest answer sews the edge again.
        piece.seams = Some(piece.after(&free.choices[0].step).expect("they fit"));
        assert!(piece.laid_out().expect("it fits").undecided.is_empty());
    }

    #[test]
    fn the_file_of_a_study_is_written_only_while_it_says_what_it_said() {
        let folder = tempfile::tempdir().expect("a folder");
        let study = folder.path().join("study.toml");
        std::fs::write(&study, "[[garment]]\nname = \"tee\"\nseams = \"a.toml\"\n").expect("writable");
        let path = folder.path().join("a.toml");
        std::fs::write(&path, "one").expect("writable");
        let [one, two] = ["one", "two"].map(|text| SourceFile { name: "a.toml".into(), bytes: text.as_bytes().into() });
        assert_eq!(seam_home(&study, "tee", &one), Some(path.clone()));
        assert_eq!(seam_home(&study, "tee", &two), None);
        assert_eq!(seam_home(&study, "dress", &one), None);
        write_seams(&path, &one, &two).expect("it is as before");
        assert_eq!(std::fs::read_to_string(&path).expect("readable"), "two");
        assert!(write_seams(&path, &one, &two).expect_err("it is not").to_string().contains("changed meanwhile"));
    }
}
