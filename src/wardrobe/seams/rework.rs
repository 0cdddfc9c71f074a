//! Edits that a person made to a proposed seam file: found by comparison, and applied to a later proposal.

use toml_edit::DocumentMut;

use pattern::StyleError;
use pattern::seam_edit::{Edit, Sizes, edited};
use pattern::seams::{PieceEntry, SeamEntry, SeamFile};
use store::{InOrigin, Origin, Result};

/// Tables of a seam file that only a person writes.
const OWN_TABLES: [&str; 3] = ["measurement", "reinforce", "fit"];

/// A seam file as proposed, and as a person has edited it.
#[derive(Clone, Copy)]
pub struct Reworked<'a> {
    pub proposed: &'a str,
    /// Text after the edits.
    pub own: &'a str,
    pub file: &'a str,
}

impl Reworked<'_> {
    /// Applies all these edits to another proposal. A seam that can no longer be sewn becomes a question.
    pub fn done_again(&self, other: String, sizes: &Sizes<'_>) -> Result<String> {
        let read = |text: &str| SeamFile::parse(text.as_bytes(), self.file).origin(Origin::Pattern);
        let (proposed, own) = (read(self.proposed)?, read(self.own)?);
        let text = self.with_own_tables(other)?;
        let text = self.applied(text, edits_of_pieces(&proposed, &own), sizes);
        let known = read(&text)?;
        Ok(self.applied(text, edits_of_seams(&proposed, &own, &known), sizes))
    }

    fn applied(&self, text: String, edits: Vec<Edit>, sizes: &Sizes<'_>) -> String {
        edits.into_iter().fold(text, |text, edit| match edited(&text, self.file, sizes, &edit) {
            Ok(after) => after,
            Err(error) if matches!(edit, Edit::Add { .. }) => asked(&text, &error),
            // Another edit fails where it is done already, or where its seam or piece is no longer proposed. Both are
            // fine.
            Err(_) => text,
        })
    }

    fn with_own_tables(&self, text: String) -> Result<String> {
        let parse = |text: &str| text.parse::<DocumentMut>().origin(Origin::Pattern);
        let own = parse(self.own)?;
        if !OWN_TABLES.iter().any(|key| own.contains_key(key)) {
            return Ok(text);
        }
        let mut document = parse(&text)?;
        for (key, item) in OWN_TABLES.iter().filter_map(|key| Some((key, own.get(key)?))) {
            document.insert(key, item.clone());
        }
        Ok(document.to_string())
    }
}

/// Adds a question to a text about a hand-made seam that no longer fits.
fn asked(text: &str, error: &StyleError) -> String {
    let told = error.to_string().replace(['\n', '\r'], " ");
    format!("# ASK: a seam that was sewn by hand does not fit any more: {told}\n{text}")
}

/// Edits of pieces: left out, taken in, given another role.
fn edits_of_pieces(proposed: &SeamFile, own: &SeamFile) -> Vec<Edit> {
    let is_new = |id: &&String| !proposed.piece.contains_key(*id);
    let left_out = proposed.piece.keys().filter(|id| !own.piece.contains_key(*id));
    let mut edits: Vec<Edit> = left_out.map(|piece| Edit::LeaveOut { piece: piece.clone() }).collect();
    for PieceEntry { block, .. } in own.piece.keys().filter(is_new).filter_map(|id| own.piece.get(id)) {
        let copies = || own.piece.values().filter(|entry| entry.block == *block);
        let is_pair = copies().any(|entry| entry.mirror) && copies().any(|entry| !entry.mirror);
        let edit = Edit::TakeIn { drawn: block.clone(), is_pair };
        if !edits.contains(&edit) {
            edits.push(edit);
        }
    }
    let is_worn_as = |id: &String, entry: &PieceEntry| proposed.piece.get(id).is_some_and(|old| old.role == entry.role);
    let changed = own.piece.iter().filter(|(id, entry)| !is_worn_as(id, entry));
    edits.extend(changed.map(|(id, entry)| Edit::Role { piece: id.clone(), role: entry.role.as_str().to_owned() }));
    edits
}

/// Edits of seams and open edges, in the edge names of `known`, to which they will be applied.
fn edits_of_seams(proposed: &SeamFile, own: &SeamFile, known: &SeamFile) -> Vec<Edit> {
    let is_same = |seam: &SeamEntry, other: &SeamEntry| seam.a == other.a && seam.b == other.b;
    let among = |seams: &[SeamEntry], seam: &SeamEntry| seams.iter().find(|other| is_same(seam, other)).cloned();
    let ends = |seam: &SeamEntry| Some((seam.a.first()?.clone(), seam.b.first()?.clone()));
    let removed = proposed.seam.iter().filter(|seam| among(&own.seam, seam).is_none());
    let mut edits: Vec<Edit> = removed.filter_map(ends).map(|(a, b)| Edit::Remove { a, b }).collect();
    for seam in &own.seam {
        let before = among(&proposed.seam, seam);
        let now = among(&known.seam, seam);
        if before.is_none() && now.is_none() {
            let side =
                |edges: &[String]| edges.iter().map(|edge| called(own, known, edge)).collect::<Vec<_>>().join("+");
            let (a, b) = (side(&seam.a), side(&seam.b));
            edits.push(Edit::Add { a, b, name: Some(seam.name.clone()), is_eased: true });
        }
        let runs = |seam: Option<SeamEntry>| seam.is_some_and(|seam| seam.same_direction);
        if let (true, Some((a, b))) =
            (runs(before) != seam.same_direction && runs(now) != seam.same_direction, ends(seam))
        {
            edits.push(Edit::Flip { a: called(own, known, &a), b: called(own, known, &b) });
        }
    }
    let opened = own.open.iter().filter(|edge| !proposed.open.contains(edge));
    edits.extend(opened.map(|edge| Edit::Open { edge: called(own, known, edge) }));
    edits
}

/// Name of an edge of `own` in the file `other`; the corners of the edge where it has no name there.
fn called(own: &SeamFile, other: &SeamFile, edge: &str) -> String {
    let Some((piece, name)) = edge.split_once('.') else { return edge.to_owned() };
    let in_file = |file: &SeamFile| file.piece.get(piece).and_then(|entry| entry.edges.get(name)).copied();
    match (in_file(own), in_file(other)) {
        (Some([from, to]), None) => format!("{piece}.{from}-{to}"),
        _ => edge.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pattern::draft::Model;

    #[test]
    fn what_was_done_to_a_proposal_is_done_to_another() {
        let pieces = Model::Tshirt.drafts().swap_remove(0).pieces;
        let sizes = Sizes { name: "S", pieces: &pieces, others: &[] };
        let text = String::from_utf8(Model::Tshirt.seams().to_vec()).expect("it is UTF-8");
        let measured = text.find("[[measurement]]").expect("measurements");
        let (proposed, measurements) = text.split_at(measured);
        let edge = |name: &str| format!("front.{name}");
        let check = |edits: &[Edit]| {
            let own = edits.iter().fold(proposed.to_owned(), |text, edit| {
                edited(&text, "t", &sizes, edit).unwrap_or_else(|error| panic!("{edit:?}: {error}"))
            });
            let rework = Reworked { proposed, own: &own, file: "t" };
            let again = rework.done_again(proposed.to_owned(), &sizes).expect("it can be");
            let read = |text: &str| {
                let mut file = SeamFile::parse(text.as_bytes(), "t").expect("it reads");
                file.seam.sort_by(|p, q| p.name.cmp(&q.name));
                file
            };
            assert_eq!(read(&again), read(&own), "{edits:?}");
            assert!(!again.contains("# ASK"));
        };
        let [a, b] = [edge("side_right"), "back.side_right".to_owned()];
        check(&[]);
        check(&[Edit::Flip { a: a.clone(), b: b.clone() }]);
        check(&[Edit::Remove { a: a.clone(), b: b.clone() }, Edit::Open { edge: a.clone() }]);
        check(&[Edit::LeaveOut { piece: "sleeve_left".to_owned() }]);
        check(&[Edit::Role { piece: "back".to_owned(), role: "other".to_owned() }]);
        check(&[
            Edit::Remove { a: a.clone(), b: b.clone() },
            Edit::Add { a, b, name: Some("side_right".to_owned()), is_eased: true },
        ]);
        // Measurements that a person has added stay.
        let own = format!("{proposed}{measurements}");
        let again =
            Reworked { proposed, own: &own, file: "t" }.done_again(proposed.to_owned(), &sizes).expect("it can be");
        assert_eq!(
            SeamFile::parse(again.as_bytes(), "t").expect("it reads").measurement.len(),
            SeamFile::parse(own.as_bytes(), "t").expect("it reads").measurement.len()
        );
    }

    #[test]
    fn a_seam_that_does_not_fit_any_more_is_asked_about() {
        let pieces = Model::Tshirt.drafts().swap_remove(0).pieces;
        let sizes = Sizes { name: "S", pieces: &pieces, others: &[] };
        let text = String::from_utf8(Model::Tshirt.seams().to_vec()).expect("it is UTF-8");
        let proposed = &text[..text.find("[[measurement]]").expect("measurements")];
        let opened = Edit::Remove { a: "front.side_right".to_owned(), b: "back.side_right".to_owned() };
        let before = edited(proposed, "t", &sizes, &opened).expect("it is there");
        let other = edited(&before, "t", &sizes, &Edit::LeaveOut { piece: "back".to_owned() }).expect("a piece");
        let again =
            Reworked { proposed: &before, own: proposed, file: "t" }.done_again(other, &sizes).expect("it can be");
        assert!(
            again.starts_with("# ASK: a seam that was sewn by hand") && again.contains("no piece `back`"),
            "{again}"
        );
    }
}
