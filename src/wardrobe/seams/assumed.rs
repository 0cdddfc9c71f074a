//! Assumptions on a pattern, and pieces that are drawn and not sewn.

use crate::seams::desk::confidences;
use crate::seams::workpiece::Workpiece;
use geom::units::from_mm;
use pattern::check::FindingKind;
use pattern::propose;
use pattern::seams::SeamFile;
use spec::patterns::{self, Nest};
use store::{InOrigin, Origin, Result};

/// Start of a proposal's note on pieces that it leaves out.
const NOTE: &str = "left out: ";

/// Assumptions on a size of a pattern.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Assumed {
    /// Sentences on the line that is sewn, the unit, and seams that nobody confirmed.
    pub told: Vec<String>,
    /// Pieces that are drawn and not sewn.
    pub left_out: Vec<LeftOut>,
}

/// Pieces that are drawn and not sewn, for one reason.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LeftOut {
    /// Names of the pieces, each once.
    pub pieces: Vec<String>,
    /// Reason, in words.
    pub why: String,
}

impl Workpiece {
    /// Assumptions on the pattern, and the pieces that its seam file does not sew.
    ///
    /// # Errors
    /// When a file cannot be read, or seams and pattern do not fit each other.
    pub fn assumed(&self) -> Result<Assumed> {
        let Some(file) = self.seams.as_ref().filter(|_| !self.pattern.holds_seams()) else {
            let told = vec!["the pattern holds its seams: its edges are sewn as they are drawn".to_owned()];
            return Ok(Assumed { told, left_out: Vec::new() });
        };
        let entries = SeamFile::parse(&file.bytes, &file.name).origin(Origin::Pattern)?;
        let nest = Nest::read(&self.pattern, self.unit)?.with_allowance(from_mm(entries.allowance_mm));
        let mut told = vec![nest.sewn_along()];
        let own: usize = entries.piece.values().map(|piece| piece.allowance_mm.len()).sum();
        told.extend((own > 0).then(|| format!("{own} edges have an allowance of their own in the seam file")));
        told.extend(nest.unit_remarks().map(str::to_owned));
        let unsure = confidences(&String::from_utf8_lossy(&file.bytes)).into_iter().flatten().count();
        let all = entries.seam.len();
        told.extend(
            (unsure > 0).then(|| format!("{unsure} of {all} seams are proposed, and nobody has confirmed them")),
        );
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

/// Reason in the note that leaves a piece out: what follows the names.
fn why<'n>(notes: &'n [String], piece: &str) -> Option<&'n str> {
    let quoted = format!("`{piece}`");
    let note = notes.iter().filter_map(|note| note.strip_prefix(NOTE)).find(|note| note.contains(&quoted))?;
    note.rsplit_once("`: ").map(|(_, why)| why)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::seams::desk::{Asking, proposal};
    use spec::patterns::Model;
    use store::files::SourceFile;

    fn drafted(name: &str) -> SourceFile {
        let files = patterns::drafted(Model::Tshirt);
        let (name, bytes) = files.into_iter().find(|(file, _)| file == name).expect("it is drafted");
        SourceFile { name, bytes: bytes.into() }
    }

    fn sewn(pattern: SourceFile, seams: SourceFile) -> Assumed {
        Workpiece { pattern, seams: Some(seams), size: "M".to_owned(), unit: None }.assumed().expect("it is sewn")
    }

    #[test]
    fn the_line_that_is_sewn_is_told() {
        let check = |from: &str, to: &str, told: &[&str]| {
            let seams = drafted("tshirt.seams.toml");
            let text = String::from_utf8_lossy(&seams.bytes).replacen(from, to, 1);
            let seams = SourceFile { bytes: text.into_bytes().into(), ..seams };
            let found = sewn(drafted("tshirt-m.dxf"), seams);
            assert_eq!(found.told, told);
            assert!(found.left_out.is_empty(), "{found:?}");
        };
        let plain = "the cut line is sewn: the file has no sew line, and no allowance was said";
        check("", "", &[plain]);
        let inside = "sewn 5 mm inside the cut line";
        check("length_tolerance_mm", "allowance_mm = 5.0\nlength_tolerance_mm", &[inside]);
    }

    #[test]
    fn a_piece_that_is_not_sewn_has_the_reason_of_the_import() {
        let pattern = drafted("tshirt-m.dxf");
        let text = String::from_utf8_lossy(&pattern.bytes).replace("SLEEVE", "POCKET");
        let pattern = SourceFile { bytes: text.into_bytes().into(), ..pattern };
        let proposed = proposal(&pattern, &Asking::default()).expect("a trunk").proposal;
        let seams = SourceFile { name: "a.seams.toml".to_owned(), bytes: proposed.toml("a").into_bytes().into() };
        let found = sewn(pattern, seams);
        let [left_out] = &found.left_out[..] else { panic!("{found:?}") };
        assert!(left_out.pieces.iter().all(|piece| piece.contains("POCKET")), "{left_out:?}");
        assert_eq!(left_out.why, "by their names or their size details that a drape does without");
        let note = format!("{NOTE}`{}`: {}", left_out.pieces.join("`, `"), left_out.why);
        assert!(proposed.notes.contains(&note), "{note}: {:?}", proposed.notes);
        let unsure = found.told.iter().find(|told| told.contains("nobody has confirmed"));
        assert!(unsure.is_some_and(|told| told.contains(&format!("of {} seams", proposed.seams.len()))), "{found:?}");
    }
}
