//! Edits of a seam file that keep the rest of its text, comments included.
//!
//! An edge is named as in the file (`front.side_left`), by the number in the drawing (`front.3`), or by its corners
//! (`front.3-5`, counter-clockwise as drawn). An edge that has no name in the file gets one. A side of several edges is
//! written with `+`, in order along the seam.

use toml_edit::{Array, ArrayOfTables, DocumentMut, InlineTable, Item, Table, Value, value};

use super::check;
use super::garment::Role;
use super::piece::Piece;
use super::seams::{RATIO_DOUBT, SAME_EASE, SeamEntry, SeamFile, StyleError};
use super::style::Style;
use geom::units::mm;

/// An edit of a seam file. A side is written `PIECE.EDGE` or `PIECE.EDGE+PIECE.EDGE`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Edit {
    Add {
        a: String,
        b: String,
        /// `None` for a name made of the first edge.
        name: Option<String>,
        /// True if the sides differ in length on purpose. The difference is then written as ease.
        is_eased: bool,
    },
    /// Removes the seam between two edges.
    Remove {
        a: String,
        b: String,
    },
    /// Reverses one side of the seam between two edges.
    Flip {
        a: String,
        b: String,
    },
    /// Lists an edge as `open`: in no seam on purpose.
    Open {
        edge: String,
    },
    LeaveOut {
        piece: String,
    },
    /// Adds a drawn piece that the file leaves out. [`Edit::Role`] sets its role.
    TakeIn {
        /// Name or block of the piece.
        drawn: String,
        /// True if the piece is worn twice, right and left, the second time mirrored.
        is_pair: bool,
    },
    Role {
        piece: String,
        /// Name such as `front` or `sleeve_right`.
        role: String,
    },
}

/// Sizes that share one seam file: the edited one, and the others.
#[derive(Clone, Copy, Debug)]
pub struct Sizes<'a> {
    pub name: &'a str,
    pub pieces: &'a [Piece],
    pub others: &'a [(String, Vec<Piece>)],
}

/// Text of the seam file after the edit. `file` is its name for messages. Fails where the edit names something that
/// does not exist, or its result does not fit the pieces.
pub fn edited(text: &str, file: &str, sizes: &Sizes<'_>, edit: &Edit) -> Result<String, StyleError> {
    let pieces = sizes.pieces;
    let entries = SeamFile::parse(text.as_bytes(), file)?;
    let style = Style::read(pieces, text.as_bytes(), file)?;
    let syntax = |error: toml_edit::TomlError| StyleError::Syntax { file: file.to_owned(), reason: error.to_string() };
    let document: DocumentMut = text.parse().map_err(syntax)?;
    let mut editor = Editor { file, entries, style, document };
    match edit {
        Edit::Add { a, b, name, is_eased } => editor.add([a, b], name.as_deref(), *is_eased, sizes)?,
        Edit::Remove { a, b } => {
            let index = editor.between(a, b)?;
            editor.seams()?.remove(index);
        }
        Edit::Flip { a, b } => {
            let index = editor.between(a, b)?;
            let is_same = !editor.entries.seam[index].same_direction;
            if let Some(seam) = editor.seams()?.get_mut(index) {
                // Whoever turns a seam has looked at it: the doubt of the proposal goes.
                seam.decor_mut().set_suffix("");
                if is_same {
                    seam["same_direction"] = value(true);
                } else {
                    seam.remove("same_direction");
                }
            }
        }
        Edit::Open { edge } => editor.open(edge)?,
        Edit::LeaveOut { piece } => editor.leave_out(piece)?,
        Edit::TakeIn { drawn, is_pair } => editor.take_in(drawn, *is_pair, pieces)?,
        Edit::Role { piece, role } => editor.wear(piece, role)?,
    }
    let text = editor.document.to_string();
    Style::read(pieces, text.as_bytes(), file)?;
    Ok(text)
}

fn edges_between(corners: usize) -> InlineTable {
    let edge = |k: usize| {
        let (from, to) = (k as i64, ((k + 1) % corners) as i64);
        (format!("edge_{from}_{to}"), Value::from([from, to].into_iter().collect::<Array>()))
    };
    (0..corners).map(edge).collect()
}

struct Editor<'a> {
    file: &'a str,
    entries: SeamFile,
    style: Style,
    document: DocumentMut,
}

impl Editor<'_> {
    fn refused(&self, place: &str, found: String, accepted: &str) -> StyleError {
        let (place, accepted) = (place.to_owned(), accepted.to_owned());
        StyleError::Contradiction { file: self.file.to_owned(), place, found, accepted }
    }

    fn seams(&mut self) -> Result<&mut ArrayOfTables, StyleError> {
        let refused = self.refused("seam", "a list in one line".to_owned(), "[[seam]] tables");
        let seams = self.document.entry("seam").or_insert(Item::ArrayOfTables(ArrayOfTables::new()));
        seams.as_array_of_tables_mut().ok_or(refused)
    }

    fn add(
        &mut self,
        [a, b]: [&str; 2],
        name: Option<&str>,
        is_eased: bool,
        sizes: &Sizes<'_>,
    ) -> Result<(), StyleError> {
        let sides = [self.side(a)?, self.side(b)?];
        let [a, b] = sides.clone().map(|side| side.into_iter().map(|(name, _)| name).collect::<Vec<_>>());
        let own = sides.map(|side| side.iter().map(|(_, length_mm)| length_mm).sum::<f64>());
        let name = name.map_or_else(|| self.free_name(&a[0]), str::to_owned);
        let mut all = vec![(sizes.name.to_owned(), own)];
        for (size, pieces) in sizes.others {
            // A size that the file does not fit already is left to the check of the seam file.
            all.extend(self.sides_in(pieces, [&a, &b]).map(|sides| (size.clone(), sides)));
        }
        let ease = self.ease(&name, &all, is_eased)?;
        let mut seam = Table::new();
        seam["name"] = value(&name);
        for (key, names) in [("a", &a), ("b", &b)] {
            seam[key] = value(names.iter().collect::<Array>());
        }
        if let Some(ease) = ease {
            seam["ease_mm"] = Item::Value(ease);
        }
        self.seams()?.push(seam);
        Ok(())
    }

    /// Lengths, mm. `None` if the present file does not fit these pieces.
    fn sides_in(&self, pieces: &[Piece], sides: [&[String]; 2]) -> Option<[f64; 2]> {
        let mut entries = SeamFile::parse(self.document.to_string().as_bytes(), self.file).ok()?;
        entries.length_tolerance_mm = f64::INFINITY;
        let style = Style::of(pieces, &entries, self.file).ok()?;
        let length = |name: &String| {
            let (piece, edge) = name.split_once('.')?;
            let drawn = style.pieces.iter().find(|drawn| drawn.id == piece)?;
            let edge = drawn.edges.iter().find(|drawn| drawn.name.as_deref() == Some(edge))?;
            Some(mm(edge.line.length()))
        };
        let [a, b] = sides.map(|side| side.iter().map(length).sum::<Option<f64>>());
        Some([a?, b?])
    }

    /// Value of `ease_mm`. `all` has the lengths of both sides in each size, mm, the edited size first. `None` if both
    /// sides are equally long in all sizes.
    fn ease(&self, name: &str, all: &[(String, [f64; 2])], is_eased: bool) -> Result<Option<Value>, StyleError> {
        let tolerance_mm = self.entries.length_tolerance_mm;
        let own = all.first().map_or(1.0, |(_, [a_mm, b_mm])| a_mm / b_mm);
        let is_alike = |k: usize, [a_mm, b_mm]: [f64; 2]| match k {
            0 => (a_mm - b_mm).abs() <= tolerance_mm,
            _ => (a_mm - b_mm).abs() <= tolerance_mm || (a_mm / b_mm / own - 1.0).abs() <= RATIO_DOUBT,
        };
        let odd = all.iter().enumerate().find(|(k, (_, sides))| !is_alike(*k, *sides));
        if let Some((k, (size, [a_mm, b_mm]))) = odd.filter(|_| !is_eased) {
            let of_size = if k == 0 { String::new() } else { format!(" in size {size}") };
            let found = format!("sides of {a_mm:.1} and {b_mm:.1} mm{of_size}");
            let accepted = "sides of one length, or --eased where the difference is meant";
            return Err(self.refused(&format!("seam `{name}`"), found, accepted));
        }
        let rounded = |[a_mm, b_mm]: [f64; 2]| ((a_mm - b_mm) * 10.0).round() / 10.0;
        let eases: Vec<(&str, f64)> = all.iter().map(|(size, sides)| (size.as_str(), rounded(*sides))).collect();
        let first = eases.first().map_or(0.0, |(_, ease)| *ease);
        if eases.iter().all(|(_, ease)| ease.abs() <= tolerance_mm) {
            return Ok(None);
        }
        if eases.iter().all(|(_, ease)| (ease - first).abs() <= SAME_EASE * tolerance_mm) {
            return Ok(Some(first.into()));
        }
        Ok(Some(Value::InlineTable(eases.into_iter().map(|(size, ease)| (size, Value::from(ease))).collect())))
    }

    fn open(&mut self, edge: &str) -> Result<(), StyleError> {
        let (name, _) = self.edge(edge)?;
        let holds = |seam: &&SeamEntry| seam.a.contains(&name) || seam.b.contains(&name);
        if let Some(seam) = self.entries.seam.iter().find(holds) {
            let accepted = "an edge in no seam; remove that seam first";
            return Err(self.refused(&format!("edge `{name}`"), format!("it is in seam `{}`", seam.name), accepted));
        }
        if !self.entries.open.contains(&name) {
            let refused = self.refused("open", "no list".to_owned(), "a list of edges");
            let open = self.document.entry("open").or_insert(value(Array::new()));
            open.as_array_mut().ok_or(refused)?.push(name);
        }
        Ok(())
    }

    fn leave_out(&mut self, piece: &str) -> Result<(), StyleError> {
        self.known_piece(piece)?;
        if let Some(pieces) = self.document["piece"].as_table_like_mut() {
            pieces.remove(piece);
        }
        let is_of = |edge: &str| edge.split_once('.').is_some_and(|(id, _)| id == piece);
        let touches = |seam: &Table| {
            let sides = ["a", "b"].into_iter().filter_map(|side| seam.get(side)?.as_array());
            sides.flatten().filter_map(|edge| edge.as_str()).any(is_of)
        };
        self.seams()?.retain(|seam| !touches(seam));
        if let Some(open) = self.document.get_mut("open").and_then(Item::as_array_mut) {
            open.retain(|edge| !edge.as_str().is_some_and(is_of));
        }
        Ok(())
    }

    fn take_in(&mut self, drawn: &str, is_pair: bool, pieces: &[Piece]) -> Result<(), StyleError> {
        let left_out = check::unused(pieces, &self.entries);
        let Some(piece) =
            left_out.iter().find(|piece| [&piece.name, &piece.block].into_iter().any(|name| name == drawn))
        else {
            let names: Vec<&str> = left_out.iter().map(|piece| piece.name.as_str()).collect();
            return Err(self.unknown("piece that is left out", drawn, &names.join(", ")));
        };
        let hands: &[(&str, bool)] = if is_pair { &[("_right", false), ("_left", true)] } else { &[("", false)] };
        for (hand, is_mirrored) in hands {
            let mut entry = Table::new();
            entry["block"] = value(&piece.block);
            entry["role"] = value(Role::Other.as_str());
            if *is_mirrored {
                entry["mirror"] = value(true);
            }
            entry["edges"] = value(edges_between(2));
            let id = self.free_id(&piece.name, hand);
            self.document["piece"][&id] = Item::Table(entry);
            let style = Style::read(pieces, self.document.to_string().as_bytes(), self.file)?;
            let corners = style.pieces.iter().find(|worn| worn.id == id).map_or(2, |worn| worn.corners.len());
            self.document["piece"][&id]["edges"] = value(edges_between(corners));
        }
        Ok(())
    }

    /// Unused identifier of letters, digits and `_`.
    fn free_id(&self, drawn: &str, hand: &str) -> String {
        let words = drawn.split(|c: char| !c.is_ascii_alphanumeric()).filter(|word| !word.is_empty());
        let base = match words.map(str::to_ascii_lowercase).collect::<Vec<_>>().join("_") {
            empty if empty.is_empty() => "piece".to_owned(),
            base => base,
        };
        let numbered = (2..).map(|number| format!("{base}_{number}{hand}"));
        let is_free = |id: &String| !self.entries.piece.contains_key(id);
        std::iter::once(format!("{base}{hand}")).chain(numbered).find(is_free).unwrap_or(base)
    }

    fn wear(&mut self, piece: &str, role: &str) -> Result<(), StyleError> {
        self.known_piece(piece)?;
        if Role::from_name(role).is_none() {
            let names: Vec<&str> = Role::ALL.into_iter().map(Role::as_str).collect();
            return Err(self.unknown("role", role, &names.join(", ")));
        }
        self.document["piece"][piece]["role"] = value(role);
        Ok(())
    }

    fn known_piece(&self, piece: &str) -> Result<(), StyleError> {
        if self.entries.piece.contains_key(piece) {
            return Ok(());
        }
        let ids: Vec<&str> = self.entries.piece.keys().map(String::as_str).collect();
        Err(self.unknown("piece", piece, &ids.join(", ")))
    }

    /// Unused name for a seam, made of that of its first edge.
    fn free_name(&self, edge: &str) -> String {
        let base = edge.replace('.', "_");
        let is_free = |name: &String| !self.entries.seam.iter().any(|seam| seam.name == *name);
        let numbered = (2..).map(|number| format!("{base}_{number}"));
        std::iter::once(base.clone()).chain(numbered).find(is_free).unwrap_or(base)
    }

    /// Names and lengths, mm, of the edges of a side. Names those that have no name.
    fn side(&mut self, side: &str) -> Result<Vec<(String, f64)>, StyleError> {
        side.split('+').map(|edge| self.edge(edge.trim())).collect()
    }

    /// Name and length, mm. Names an edge that has no name.
    fn edge(&mut self, text: &str) -> Result<(String, f64), StyleError> {
        let (piece, edge) = text.split_once('.').unwrap_or((text, ""));
        let Some(drawn) = self.style.pieces.iter().find(|drawn| drawn.id == piece) else {
            let ids: Vec<&str> = self.style.pieces.iter().map(|piece| piece.id.as_str()).collect();
            return Err(self.unknown("piece", piece, &ids.join(", ")));
        };
        let length = |index: usize| mm(drawn.edges[index].line.length());
        let by_name = drawn.edges.iter().position(|drawn| drawn.name.as_deref() == Some(edge));
        let by_number = edge.parse::<usize>().ok().and_then(|n| n.checked_sub(1)).filter(|&n| n < drawn.edges.len());
        if let Some(index) = by_name.or(by_number) {
            let length_mm = length(index);
            let name = match &drawn.edges[index].name {
                Some(name) => name.clone(),
                None => {
                    let corners = self.unnamed_corners(piece, index);
                    self.named(piece, corners)
                }
            };
            return Ok((format!("{piece}.{name}"), length_mm));
        }
        let corner = |text: &str| text.parse::<usize>().ok().filter(|&corner| corner < drawn.corners.len());
        let corners = edge.split_once('-').and_then(|(from, to)| Some([corner(from)?, corner(to)?]));
        let Some(corners) = corners.filter(|[from, to]| from != to) else {
            let names: Vec<String> = drawn
                .edges
                .iter()
                .enumerate()
                .map(|(k, edge)| edge.name.clone().unwrap_or_else(|| (k + 1).to_string()))
                .collect();
            let accepted = format!(
                "{}; a number 1 to {}; corners such as 0-1, of 0 to {}",
                names.join(", "),
                names.len(),
                drawn.corners.len().saturating_sub(1)
            );
            return Err(self.unknown("edge", text, &accepted));
        };
        let known =
            self.entries.piece[piece].edges.iter().find(|(_, ends)| **ends == corners).map(|(name, _)| name.clone());
        let length_mm = self.length_between(piece, corners);
        let name = known.unwrap_or_else(|| self.named(piece, corners));
        Ok((format!("{piece}.{name}"), length_mm))
    }

    /// Length of the outline, counter-clockwise as drawn, mm.
    fn length_between(&self, piece: &str, [from, to]: [usize; 2]) -> f64 {
        let Some(drawn) = self.style.pieces.iter().find(|drawn| drawn.id == piece) else { return 0.0 };
        // A mirrored piece runs clockwise as drawn.
        let is_mirrored = self.entries.piece[piece].mirror;
        let [from, to] = if is_mirrored { [to, from] } else { [from, to] };
        let outline = drawn.outline();
        let place = |corner: usize| {
            let distance = |i: &usize| (outline[*i] - drawn.corners[corner]).norm();
            (0..outline.len()).min_by(|i, j| distance(i).total_cmp(&distance(j))).unwrap_or(0)
        };
        let (first, last, n) = (place(from), place(to), outline.len());
        let steps = (last + n - first) % n;
        (0..steps).map(|k| mm((outline[(first + k + 1) % n] - outline[(first + k) % n]).norm())).sum()
    }

    fn unnamed_corners(&self, piece: &str, index: usize) -> [usize; 2] {
        let edges = &self.style.pieces.iter().find(|drawn| drawn.id == piece).map_or(&[][..], |drawn| &drawn.edges);
        let n = edges.len();
        let corners_of = |index: usize| {
            let name = edges[index % n].name.as_ref();
            name.and_then(|name| self.entries.piece[piece].edges.get(name)).copied().unwrap_or_default()
        };
        let (before, after) = (corners_of(index + n - 1), corners_of(index + 1));
        if self.entries.piece[piece].mirror { [after[1], before[0]] } else { [before[1], after[0]] }
    }

    fn named(&mut self, piece: &str, [from, to]: [usize; 2]) -> String {
        let name = format!("edge_{from}_{to}");
        let mut corners = Array::new();
        corners.push(from as i64);
        corners.push(to as i64);
        self.document["piece"][piece]["edges"][&name] = value(corners);
        name
    }

    fn between(&self, a: &str, b: &str) -> Result<usize, StyleError> {
        let full = |text: &str| {
            let (piece, edge) = text.split_once('.').unwrap_or((text, ""));
            let drawn = self.style.pieces.iter().find(|drawn| drawn.id == piece);
            let numbered = edge.parse::<usize>().ok().and_then(|n| drawn?.edges.get(n.checked_sub(1)?)?.name.clone());
            format!("{piece}.{}", numbered.unwrap_or_else(|| edge.to_owned()))
        };
        let (a, b) = (full(a), full(b));
        let joins = |side: &[String], other: &[String]| side.contains(&a) && other.contains(&b);
        let found = self.entries.seam.iter().position(|seam| joins(&seam.a, &seam.b) || joins(&seam.b, &seam.a));
        found.ok_or_else(|| {
            let seams: Vec<String> =
                self.entries.seam.iter().map(|seam| format!("{} to {}", seam.a.join("+"), seam.b.join("+"))).collect();
            self.unknown("seam between", &format!("{a} and {b}"), &seams.join("; "))
        })
    }

    fn unknown(&self, what: &'static str, found: &str, accepted: &str) -> StyleError {
        StyleError::Unknown {
            file: self.file.to_owned(),
            place: "edit".to_owned(),
            what,
            found: found.to_owned(),
            accepted: accepted.to_owned(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::draft::{Model, TSHIRT_SEAMS, TshirtSize, tshirt};

    fn text() -> String {
        String::from_utf8(TSHIRT_SEAMS.to_vec()).expect("it is UTF-8")
    }

    fn edit(text: &str, edit: &Edit) -> Result<String, StyleError> {
        let pieces = tshirt(TshirtSize::S).pieces;
        edited(text, "a.toml", &Sizes { name: "S", pieces: &pieces, others: &[] }, edit)
    }

    fn add(a: &str, b: &str) -> Edit {
        Edit::Add { a: a.to_owned(), b: b.to_owned(), name: None, is_eased: false }
    }

    #[test]
    fn a_seam_that_is_opened_can_be_sewn_again_and_comments_stay() {
        let [a, b] = ["front.side_right", "back.side_right"].map(str::to_owned);
        let opened = edit(&text(), &Edit::Remove { a: b.clone(), b: a.clone() }).expect("it is there");
        assert!(!opened.contains("name = \"side_right\"") && opened.contains("# +u is the wearer's right"));
        let sewn = edit(&opened, &add(&a, &b)).expect("they fit");
        let read = |text: &str| {
            let mut seams = SeamFile::parse(text.as_bytes(), "a.toml").expect("it reads").seam;
            seams.sort_by(|p, q| (&p.a, &p.b).cmp(&(&q.a, &q.b)));
            seams.into_iter().map(|seam| (seam.a, seam.b, seam.same_direction)).collect::<Vec<_>>()
        };
        assert_eq!(read(&sewn), read(&text()));
        // By numbers: the sides of front and back are their last and second edges.
        let numbered = edit(&opened, &add("front.9", "back.2")).expect("they fit");
        assert_eq!(read(&numbered), read(&text()));
        let turned = edit(&text(), &Edit::Flip { a: a.clone(), b: b.clone() }).expect("it is there");
        assert_ne!(read(&turned), read(&text()));
        assert_eq!(edit(&turned, &Edit::Flip { a, b }).expect("it is there"), text());
    }

    #[test]
    fn edges_without_a_name_get_one_and_chains_are_sewn() {
        let model = Model::Trousers;
        let pieces = model.drafts().swap_remove(0).pieces;
        let text = String::from_utf8(model.seams().to_vec()).expect("it is UTF-8");
        let named = "waist = [4, 5]\noutseam_upper = [5, 6]\noutseam_lower = [6, 0]\n";
        // Only the left outseam loses its names; the right one is measured.
        let at = text.rfind(named).expect("it is there");
        let mut without = format!("{}waist = [4, 5]\n{}", &text[..at], &text[at + named.len()..]);
        for seam in ["outseam_upper_left", "outseam_lower_left"] {
            let from = without.find(&format!("[[seam]]\nname = \"{seam}\"")).expect("it is there");
            let length = without[from + 1..].find("[[").expect("there is more");
            without.replace_range(from..=from + length, "");
        }
        let from = without.find("[fit.hip]").expect("it is there");
        without.truncate(from);
        for (a, edge) in [
            ("leg_front_left.5-0", "edge_5_0 = [5, 0]"),
            ("leg_front_left.5-6+leg_front_left.6-0", "edge_5_6 = [5, 6]"),
        ] {
            let b = "leg_back_left.outseam_upper+leg_back_left.outseam_lower";
            let sewn = edited(&without, "a.toml", &Sizes { name: "S", pieces: &pieces, others: &[] }, &add(a, b))
                .unwrap_or_else(|error| panic!("{error}"));
            assert!(sewn.contains(edge), "{sewn}");
        }
    }

    #[test]
    fn what_cannot_be_sewn_is_refused_with_what_could() {
        let check = |edit_: Edit, expect: &str| {
            let told = edit(&text(), &edit_).expect_err("it cannot be").to_string();
            assert!(told.contains(expect), "{told}");
        };
        check(add("front.hem", "sleeve_right.opening"), "or --eased");
        check(add("front.hem", "back.side_right"), "front");
        check(add("collar.hem", "back.hem"), "no piece `collar`; there is: back, front");
        check(add("front.99", "back.hem"), "a number 1 to 9; corners such as 0-1, of 0 to 8");
        check(Edit::Remove { a: "front.hem".to_owned(), b: "back.hem".to_owned() }, "no seam between");
        let eased = Edit::Add {
            a: "front.hem".to_owned(),
            b: "sleeve_right.opening".to_owned(),
            name: Some("x".to_owned()),
            is_eased: true,
        };
        assert!(edit(&text(), &eased).expect("it is meant").contains("ease_mm = "));
        check(Edit::Open { edge: "front.side_right".to_owned() }, "it is in seam `side_right`");
        check(Edit::LeaveOut { piece: "collar".to_owned() }, "there is: back, front");
        check(Edit::Role { piece: "front".to_owned(), role: "collar".to_owned() }, "sleeve_left");
        let drawn = "front".to_owned();
        check(Edit::TakeIn { drawn, is_pair: false }, "no piece that is left out `front`");
    }

    #[test]
    fn pieces_that_were_left_out_are_taken_in() {
        let measured = text().find("[[measurement]]").expect("measurements");
        let without =
            |piece: &str, text: &str| edit(text, &Edit::LeaveOut { piece: piece.to_owned() }).expect("a piece");
        let text = without("sleeve_left", &without("sleeve_right", &text()[..measured]));
        let check = |is_pair: bool, expect: &[(&str, bool)]| {
            let taken = edit(&text, &Edit::TakeIn { drawn: "SLEEVE".to_owned(), is_pair }).expect("it is drawn");
            let read = SeamFile::parse(taken.as_bytes(), "a.toml").expect("it reads").piece;
            let found: Vec<(&str, bool)> = read
                .iter()
                .filter(|(id, _)| id.starts_with("sleeve"))
                .map(|(id, entry)| (id.as_str(), entry.mirror))
                .collect();
            assert_eq!(found, expect);
            // And is sewn from there.
            let first = expect[0].0;
            let worn =
                edit(&taken, &Edit::Role { piece: first.to_owned(), role: "sleeve_right".to_owned() }).expect("a role");
            edit(&worn, &add(&format!("{first}.edge_1_2"), &format!("{first}.edge_4_0"))).expect("its underarm");
        };
        check(false, &[("sleeve", false)]);
        check(true, &[("sleeve_left", true), ("sleeve_right", false)]);
    }

    #[test]
    fn pieces_are_left_out_edges_left_open_and_roles_said() {
        let [a, b] = ["front.side_right", "back.side_right"].map(str::to_owned);
        let opened = edit(&text(), &Edit::Remove { a: a.clone(), b }).expect("it is there");
        let open = edit(&opened, &Edit::Open { edge: a.clone() }).expect("it is free");
        let read = |text: &str| SeamFile::parse(text.as_bytes(), "a.toml").expect("it reads");
        assert!(read(&open).open.contains(&a) && !read(&text()).open.contains(&a));
        assert_eq!(edit(&open, &Edit::Open { edge: a }).expect("it is open already"), open);
        let other = edit(&text(), &Edit::Role { piece: "back".to_owned(), role: "other".to_owned() }).expect("a role");
        assert_eq!(read(&other).piece["back"].role, Role::Other);
        // What is measured on a sleeve is measured no more without it.
        let measured = text().find("[[measurement]]").expect("measurements");
        let alone = edit(&text()[..measured], &Edit::LeaveOut { piece: "sleeve_left".to_owned() }).expect("a piece");
        let left = read(&alone);
        let is_of = |edge: &String| edge.starts_with("sleeve_left.");
        assert!(!left.piece.contains_key("sleeve_left") && left.seam.len() == read(&text()).seam.len() - 2);
        assert!(!left.seam.iter().any(|seam| seam.a.iter().chain(&seam.b).any(is_of)));
    }

    #[test]
    fn the_ease_of_a_seam_is_that_of_each_size() {
        let pieces = |size: TshirtSize| tshirt(size).pieces;
        let (small, others) = (pieces(TshirtSize::S), vec![("L".to_owned(), pieces(TshirtSize::L))]);
        let sizes = Sizes { name: "S", pieces: &small, others: &others };
        let [a, b] = ["front.hem", "sleeve_right.opening"].map(str::to_owned);
        let eased = Edit::Add { a, b, name: Some("x".to_owned()), is_eased: true };
        let sewn = edited(&text(), "a.toml", &sizes, &eased).expect("it is meant");
        let entries = SeamFile::parse(sewn.as_bytes(), "a.toml").expect("it reads");
        let ease = entries.seam.last().map(|seam| seam.ease_mm.clone()).expect("a seam");
        let ease_of = |size: &str| ease.of_size(size).expect("both sizes");
        assert!(ease_of("L") > ease_of("S") + 1.0, "{ease}");
        for (size, pieces) in [("S", &small), ("L", &others[0].1)] {
            let entries = SeamFile { size: Some(size.to_owned()), ..entries.clone() };
            Style::of(pieces, &entries, "a.toml").unwrap_or_else(|error| panic!("{size}: {error}"));
        }
    }
}
