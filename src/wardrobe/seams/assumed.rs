//! Assumptions on a pattern, and pieces that are drawn and not sewn.

use crate::seams::desk::confidences;
use crate::seams::workpiece::Workpiece;
use geom::units::from_mm;
use pattern::check::FindingKind;
use pattern::propose::{self, Question};
use pattern::seams::SeamFile;
use pattern::style::shrinkage::Shrinkage;
use spec::patterns::{self, Nest};
use store::{InOrigin, Origin, Result};

/// Start of a proposal's note on pieces that it leaves out.
const NOTE: &str = "left out: ";

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Assumed {
    /// Sentences on the line that is sewn, the unit, seams that nobody confirmed and questions that nobody answered.
    pub told: Vec<String>,
    pub left_out: Vec<LeftOut>,
}

/// Pieces that are drawn and not sewn, for one reason.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LeftOut {
    /// Each name once.
    pub pieces: Vec<String>,
    pub why: String,
}

impl Workpiece {
    pub fn assumed(&self) -> Result<Assumed> {
        let Some(file) = self.seams.as_ref().filter(|_| !self.pattern.holds_seams()) else {
            let told = vec!["the pattern holds its seams: its edges are sewn as they are drawn".to_owned()];
            return Ok(Assumed { told, left_out: Vec::new() });
        };
        let entries = SeamFile::parse(&file.bytes, &file.name).origin(Origin::Pattern)?;
        let nest = Nest::read(&self.pattern, self.unit)?.with_allowance(from_mm(entries.allowance_mm));
        let mut told = vec![nest.sewn_along()];
        let shrinkage = Shrinkage::of(&entries).ok().filter(|shrinkage| !shrinkage.is_none());
        told.extend(shrinkage.map(|by| format!("the cloth shrinks by {by}: all lengths are those after that")));
        let own: usize = entries.piece.values().map(|piece| piece.allowance_mm.len()).sum();
        told.extend((own > 0).then(|| format!("{own} edges have an allowance of their own in the seam file")));
        told.extend(nest.unit_remarks().map(str::to_owned));
        let unsure = confidences(&String::from_utf8_lossy(&file.bytes)).into_iter().flatten().count();
        let all = entries.seam.len();
        told.extend(
            (unsure > 0).then(|| format!("{unsure} of {all} seams are proposed, and nobody has confirmed them")),
        );
        told.extend(self.asked().iter().map(open));
        Ok(Assumed { told, left_out: self.left_out()? })
    }

    /// Pieces that the seam file does not name. The reason is that of a proposal for the same pieces, where it leaves
    /// them out too.
    fn left_out(&self) -> Result<Vec<LeftOut>> {
        let style = patterns::read_style(&self.pattern, self.seams.as_ref(), Some(&self.size), self.unit)?;
        let findings = self.findings(&style)?.into_iter();
        let unused: Vec<String> =
            findings.filter(|found| found.kind == FindingKind::UnusedPiece).map(|found| found.place).collect();
        if unused.is_empty() {
            return Ok(Vec::new());
        }
        let notes = propose::propose(&patterns::pieces(&self.pattern, Some(&self.size), self.unit)?).notes;
        let mut found: Vec<LeftOut> = Vec::new();
        for piece in unused {
            let why = why(&notes, &piece).unwrap_or("the seam file does not name it");
            match found.iter_mut().find(|known| known.why == why) {
                Some(known) if known.pieces.contains(&piece) => {}
                Some(known) => known.pieces.push(piece),
                None => found.push(LeftOut { pieces: vec![piece], why: why.to_owned() }),
            }
        }
        Ok(found)
    }
}

/// Open question, with the answer that is taken until somebody answers.
fn open(asked: &Question) -> String {
    let taken = asked.taken.and_then(|taken| asked.choices.get(taken));
    let taken = taken.map_or_else(String::new, |choice| format!(" Taken: {choice}"));
    format!("open question: {}{taken}", asked.text)
}

fn why<'n>(notes: &'n [String], piece: &str) -> Option<&'n str> {
    let quoted = format!("`{piece}`");
    let note = notes.iter().filter_map(|note| note.strip_prefix(NOTE)).find(|note| note.contains(&quoted))?;
    note.rsplit_once("`: ").map(|(_, why)| why)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::seams::{SeamEdit, SeamStep};
    use spec::patterns::Model;
    use store::files::SourceFile;

    fn drafted(name: &str) -> SourceFile {
        let files = patterns::drafted(Model::Tshirt);
        let (name, bytes) = files.into_iter().find(|(file, _)| file == name).expect("it is drafted");
        SourceFile { name, bytes: bytes.into() }
    }

    fn tee(seams: SourceFile) -> Workpiece {
        Workpiece { pattern: drafted("tshirt-m.dxf"), seams: Some(seams), size: "M".to_owned(), unit: None }
    }

    #[test]
    fn the_line_that_is_sewn_is_told() {
        let check = |keys: &str, told: &str| {
            let seams = drafted("tshirt.seams.toml");
            let text = [keys.as_bytes(), &seams.bytes].concat();
            let seams = SourceFile { bytes: text.into(), ..seams };
            let found = tee(seams).assumed().expect("it is sewn");
            assert_eq!(found, Assumed { told: vec![told.to_owned()], left_out: Vec::new() });
        };
        check("", "the cut line is sewn: the file has no sew line, and no allowance was said");
        check("allowance_mm = 0.1\n", "sewn 0.1 mm inside the cut line");
    }

    #[test]
    fn seams_that_nobody_confirmed_are_counted() {
        let proposed = tee(drafted("tshirt.seams.toml")).proposed("tee").expect("it is recognised");
        let told = tee(proposed).assumed().expect("it is sewn").told;
        assert_eq!(told[1], "8 of 8 seams are proposed, and nobody has confirmed them");
    }

    #[test]
    fn open_questions_are_told() {
        let asked = "# ASK: which is `A`? a: the right one; b: the left one (b is taken)\n# SETTLED: is it whole?\n";
        let seams = drafted("tshirt.seams.toml");
        let text = [asked.as_bytes(), &seams.bytes].concat();
        let told = tee(SourceFile { bytes: text.into(), ..seams }).assumed().expect("it is sewn").told;
        let open: Vec<&String> = told.iter().filter(|told| told.starts_with("open question: ")).collect();
        assert_eq!(open, ["open question: which is `A`? Taken: the left one"], "{told:?}");
    }

    #[test]
    fn a_piece_that_the_seam_file_does_not_name_is_left_out() {
        let mut seams = tee(drafted("tshirt.seams.toml")).proposed("tee").expect("it is recognised");
        for piece in ["sleeve_right", "sleeve_left"] {
            let step = SeamStep::Edit(SeamEdit::LeaveOut { piece: piece.to_owned() });
            seams = tee(seams).after(&step).expect("it can be left out");
        }
        let found = tee(seams).assumed().expect("it is sewn").left_out;
        let expected = LeftOut { pieces: vec!["SLEEVE".to_owned()], why: "the seam file does not name it".to_owned() };
        assert_eq!(found, [expected]);
    }

    #[test]
    fn a_reason_is_that_of_the_import() {
        let notes = ["sewn".to_owned(), format!("{NOTE}`A`, `B: x`: by their names"), format!("{NOTE}`C`: spare")];
        let check = |piece: &str, expect: Option<&str>| assert_eq!(why(&notes, piece), expect, "{piece}");
        check("A", Some("by their names"));
        check("B: x", Some("by their names"));
        check("C", Some("spare"));
        check("D", None);
    }
}
