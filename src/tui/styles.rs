//! What is done to the styles of the catalogue and to their seams.

use std::collections::BTreeMap;

use super::action::Screen;
use super::message::{Act, Effect};
use super::overlay::Overlay;
use super::state::State;
use super::tailor::{Laid, Laying, Task};
use study::files::SourceFile;
use study::seams::{DeskSeam, SeamEdit, SeamStep};
use study::{Part, SizeRow};

/// An edge by its piece and its place on it.
pub type EdgeAt = (usize, usize);

/// Where the user is among the styles.
#[derive(Debug, Default)]
pub struct Styles {
    /// Style and size selected.
    pub selected: Option<(String, String)>,
    /// Seam files of styles as edited and not saved, the latest last.
    pub edits: BTreeMap<String, Vec<SourceFile>>,
    /// What the desk was asked for.
    pub asked: Option<Laying>,
    /// What lies on it, or why it does not.
    pub desk: Option<(Laying, Result<Box<Laid>, String>)>,
    /// Edge selected.
    pub edge: EdgeAt,
    /// Line of the table selected.
    pub line: usize,
    /// Edges marked, in order.
    pub marks: Vec<EdgeAt>,
    /// Whether a step of work goes on.
    pub is_busy: bool,
    /// Whether the pieces have all the room.
    pub enlarged: bool,
}

/// A line of the table beside the pieces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DeskLine {
    /// A seam.
    Seam(usize),
    /// What a person must decide.
    Question(usize),
    /// A measurement.
    Length(usize),
}

impl Laid {
    /// The lines of the table: seams, questions, measurements.
    #[must_use]
    pub fn lines(&self) -> Vec<DeskLine> {
        let seams = (0..self.out.desk.seams.len()).map(DeskLine::Seam);
        let questions = (0..self.out.questions.len()).map(DeskLine::Question);
        seams.chain(questions).chain((0..self.out.lengths.len()).map(DeskLine::Length)).collect()
    }

    /// The seam that holds an edge.
    #[must_use]
    pub fn seam_at(&self, edge: EdgeAt) -> Option<usize> {
        self.out.desk.seams.iter().position(|seam| seam.a.contains(&edge) || seam.b.contains(&edge))
    }

    /// An edge as the command line names it: `front.side_left`, or `front.3` where it has no name.
    fn edge_name(&self, (piece, edge): EdgeAt) -> String {
        let piece = &self.out.desk.pieces[piece];
        let edge = &piece.edges[edge];
        format!("{}.{}", piece.id, edge.name.clone().unwrap_or_else(|| edge.number.to_string()))
    }

    /// All edges, piece by piece.
    fn edges(&self) -> Vec<EdgeAt> {
        let pieces = self.out.desk.pieces.iter().enumerate();
        pieces.flat_map(|(piece, drawn)| (0..drawn.edges.len()).map(move |edge| (piece, edge))).collect()
    }
}

impl State {
    /// Sizes that pass the filter of the Styles screen.
    #[must_use]
    pub fn sizes(&self) -> Vec<&SizeRow> {
        let Some(data) = &self.data else { return vec![] };
        let filter = self.nav.filters[Screen::Styles as usize].to_lowercase();
        let words = |row: &SizeRow| format!("{} {} {}", row.style, row.size, row.pattern_file).to_lowercase();
        data.sizes.iter().filter(|row| words(row).contains(&filter)).collect()
    }

    /// The selected size: another of its style, or the first, where the one wanted is not shown.
    #[must_use]
    pub fn size_row(&self) -> Option<&SizeRow> {
        let sizes = self.sizes();
        let (style, size) = self.styles.selected.as_ref().map_or(("", ""), |(style, size)| (style, size));
        let found = sizes.iter().find(|row| row.style == style && row.size == size);
        found.or_else(|| sizes.iter().find(|row| row.style == style)).or(sizes.first()).copied()
    }

    /// What lies on the desk of the selected size, or why it does not; `None` while it is read.
    #[must_use]
    pub fn laid(&self) -> Option<Result<&Laid, &str>> {
        let row = self.size_row()?;
        let (laying, laid) = self.styles.desk.as_ref()?;
        let is_shown = laying.style == row.style && laying.key.size == row.key.size;
        is_shown.then(|| laid.as_deref().map_err(String::as_str))
    }

    /// The line of the table that is selected.
    #[must_use]
    pub fn desk_line(&self) -> Option<DeskLine> {
        let lines = self.laid()?.ok()?.lines();
        lines.get(self.styles.line).or(lines.last()).copied()
    }

    /// Has the selected size laid out, where it is not what the desk was asked for already.
    pub(super) fn ask_for_desk(&mut self) -> Option<Effect> {
        if self.nav.screen != Screen::Styles {
            return None;
        }
        let wanted = self.laying();
        if wanted == self.styles.asked {
            return None;
        }
        self.styles.asked.clone_from(&wanted);
        wanted.map(|laying| Effect::Desk(Task::LayOut(laying)))
    }

    fn laying(&self) -> Option<Laying> {
        let row = self.size_row()?;
        let study = self.data.as_ref().and_then(|data| data.study());
        let study = study.filter(|study| study.garments.contains(&row.style)).map(|study| study.path.clone());
        let seams = self.styles.edits.get(&row.style).and_then(|edits| edits.last()).cloned();
        Some(Laying { style: row.style.clone(), key: row.key, seams, study })
    }

    /// Takes in what was laid out.
    pub(super) fn laid_out(&mut self, laying: Laying, outcome: Result<Box<Laid>, String>) {
        if self.styles.asked.as_ref() != Some(&laying) {
            return;
        }
        let is_other = self.styles.desk.as_ref().is_none_or(|(before, _)| before.key.size != laying.key.size);
        self.styles.desk = Some((laying, outcome));
        self.styles.marks.clear();
        if is_other {
            (self.styles.line, self.styles.edge) = (0, (0, 0));
        }
        let Some(Ok(laid)) = self.laid() else { return };
        let (lines, pieces) = (laid.lines().len(), &laid.out.desk.pieces);
        let piece = self.styles.edge.0.min(pieces.len().saturating_sub(1));
        let edges = pieces.get(piece).map_or(0, |piece| piece.edges.len());
        let edge = self.styles.edge.1.min(edges.saturating_sub(1));
        self.styles.edge = (piece, edge);
        self.styles.line = self.styles.line.min(lines.saturating_sub(1));
        if is_other {
            self.select_line(0);
        }
    }

    /// Selects a line of the table, and an edge of its seam.
    pub(super) fn select_line(&mut self, line: usize) {
        let Some(Ok(laid)) = self.laid() else { return };
        let edge = match laid.lines().get(line) {
            Some(DeskLine::Seam(k)) => laid.out.desk.seams[*k].a.first().copied(),
            _ => None,
        };
        self.styles.line = line;
        self.styles.edge = edge.unwrap_or(self.styles.edge);
    }

    /// Selects the next edge, and the seam that holds it.
    pub(super) fn step_edge(&mut self, step: isize) {
        let Some(Ok(laid)) = self.laid() else { return };
        let edges = laid.edges();
        let at = edges.iter().position(|edge| *edge == self.styles.edge).unwrap_or(0);
        let Some(next) = super::act::stepped(at, step, edges.len()) else { return };
        let line = laid.seam_at(edges[next]).unwrap_or(self.styles.line);
        (self.styles.edge, self.styles.line) = (edges[next], line);
    }

    /// Gives the pieces all the room, or less again.
    pub(super) fn enlarge_pieces(&mut self) {
        self.show(Screen::Styles);
        self.styles.enlarged = !self.styles.enlarged;
    }

    /// Asks for the files of a style.
    pub(super) fn import_style(&mut self) {
        if self.may_change(Part::Style) {
            self.overlay = Some(Overlay::StyleForm(Box::default()));
        }
    }

    /// Removes the selected size, with its style where it is the last, once that is confirmed.
    pub(super) fn remove_size(&mut self) {
        if !self.may_change(Part::Style) {
            return;
        }
        let Some(row) = self.size_row() else { return self.say("no size is selected") };
        let is_last =
            self.data.iter().flat_map(|data| &data.sizes).filter(|other| other.style == row.style).count() < 2;
        let (part, name) = match is_last {
            true => (Part::Style, row.style.clone()),
            false => (Part::Size, format!("{}/{}", row.style, row.size)),
        };
        let text = format!("Remove {part} {name}? Results that use it stay as they are.");
        self.ask(text, vec![Effect::Do(Act::Remove(part, name))]);
    }

    /// Gives the desk the focus; whether what lies on it can be worked on now.
    fn may_sew(&mut self) -> bool {
        if !self.may_change(Part::Style) {
            return false;
        }
        self.nav.second_pane[Screen::Styles as usize] = true;
        let is_current =
            matches!(&self.styles.desk, Some((laying, Ok(_))) if Some(laying) == self.styles.asked.as_ref());
        let is_ready = is_current && self.laid().is_some() && !self.styles.is_busy;
        if !is_ready && self.size_row().is_none() {
            self.say("no size is selected: i imports one");
        } else if !is_ready {
            self.say("the pieces are not laid out yet");
        }
        is_ready
    }

    /// Marks the selected edge, or takes its mark away.
    pub(super) fn mark_edge(&mut self) {
        if !self.may_sew() {
            return;
        }
        let (edge, marks) = (self.styles.edge, &mut self.styles.marks);
        match marks.iter().position(|mark| *mark == edge) {
            Some(at) => drop(marks.remove(at)),
            None => marks.push(edge),
        }
    }

    /// Sews the edge marked first to the others marked, or to the selected one.
    pub(super) fn add_seam(&mut self) -> Vec<Effect> {
        if !self.may_sew() {
            return vec![];
        }
        let mut sides = self.styles.marks.clone();
        if sides.len() < 2 && !sides.contains(&self.styles.edge) {
            sides.push(self.styles.edge);
        }
        let Some(Ok(laid)) = self.laid() else { return vec![] };
        let [first, others @ ..] = sides.as_slice() else { return vec![] };
        if others.is_empty() {
            self.say("m marks an edge; then go to the edge it is sewn to, and a sews them");
            return vec![];
        }
        let length = |(piece, edge): &EdgeAt| laid.out.desk.pieces[*piece].edges[*edge].length_mm;
        let (a_mm, b_mm) = (length(first), others.iter().map(length).sum::<f64>());
        let a = laid.edge_name(*first);
        let b = others.iter().map(|edge| laid.edge_name(*edge)).collect::<Vec<_>>().join("+");
        let is_eased = (a_mm - b_mm).abs() > laid.out.tolerance_mm;
        let text = format!(
            "{a} is {a_mm:.1} mm, {b} is {b_mm:.1} mm. Sew them with {:+.1} mm of ease (ratio {:.3})?",
            a_mm - b_mm,
            a_mm / b_mm
        );
        let effects = self.step_of_work(SeamStep::Edit(SeamEdit::Add { a, b, name: None, is_eased }));
        if is_eased {
            self.styles.is_busy = false;
            self.ask(text, effects);
            return vec![];
        }
        effects
    }

    /// The seam that holds the selected edge.
    fn selected_seam(&mut self) -> Option<DeskSeam> {
        if !self.may_sew() {
            return None;
        }
        let laid = self.laid()?.ok()?;
        let found = laid.seam_at(self.styles.edge).map(|k| laid.out.desk.seams[k].clone());
        if found.is_none() {
            self.say("no seam holds the selected edge");
        }
        found
    }

    /// Two edges that name a seam: one of each side.
    fn between(&self, seam: &DeskSeam) -> Option<(String, String)> {
        let laid = self.laid()?.ok()?;
        Some((laid.edge_name(*seam.a.first()?), laid.edge_name(*seam.b.first()?)))
    }

    /// Opens the selected seam.
    pub(super) fn remove_seam(&mut self) -> Vec<Effect> {
        let edges = self.selected_seam().and_then(|seam| self.between(&seam));
        edges.map_or(vec![], |(a, b)| self.step_of_work(SeamStep::Edit(SeamEdit::Remove { a, b })))
    }

    /// Turns one side of the selected seam round.
    pub(super) fn flip_seam(&mut self) -> Vec<Effect> {
        let edges = self.selected_seam().and_then(|seam| self.between(&seam));
        edges.map_or(vec![], |(a, b)| self.step_of_work(SeamStep::Edit(SeamEdit::Flip { a, b })))
    }

    /// Takes the selected proposed seam for right, or the selected question for answered; gives the desk the focus first where the list has it.
    pub(super) fn confirm_seam(&mut self) -> Vec<Effect> {
        if self.nav.screen == Screen::Styles && !self.in_second_pane() {
            self.nav.second_pane[Screen::Styles as usize] = true;
            return vec![];
        }
        if let (true, Some(DeskLine::Question(k))) = (self.nav.screen == Screen::Styles, self.desk_line()) {
            if !self.may_sew() {
                return vec![];
            }
            let question = self.laid().and_then(Result::ok).and_then(|laid| laid.out.questions.get(k).cloned());
            return question.map_or(vec![], |question| self.step_of_work(SeamStep::Decide(question)));
        }
        match self.selected_seam() {
            Some(seam) if seam.confidence.is_some() => self.step_of_work(SeamStep::Confirm(seam.name)),
            Some(seam) => {
                self.say(format!("{} is no proposal: nothing to confirm", seam.name));
                vec![]
            }
            None => vec![],
        }
    }

    /// Proposes the seams of the selected style; asks where that replaces seams that somebody has made or confirmed.
    pub(super) fn propose_seams(&mut self) -> Vec<Effect> {
        // What cannot be laid out with the seams it has may get others.
        if !self.may_change(Part::Style) || self.styles.is_busy {
            return vec![];
        }
        let Some(style) = self.size_row().map(|row| row.style.clone()) else { return vec![] };
        let replaced = self.laid().and_then(Result::ok).map_or(0, |laid| {
            laid.out.desk.seams.iter().filter(|seam| seam.confidence.is_none()).count() + laid.out.lengths.len()
        });
        let effects = self.step_of_work(SeamStep::Propose(style.clone()));
        if replaced > 0 {
            self.styles.is_busy = false;
            let text = format!("Propose all seams of {style} anew? Its seams and measurements go; u brings them back.");
            self.ask(text, effects);
            return vec![];
        }
        effects
    }

    fn step_of_work(&mut self, step: SeamStep) -> Vec<Effect> {
        let Some(laying) = self.laying() else { return vec![] };
        self.styles.is_busy = true;
        vec![Effect::Desk(Task::Sew(laying, step))]
    }

    /// Takes in a seam file after a step of work.
    pub(super) fn sewn(&mut self, style: String, outcome: Result<SourceFile, String>) {
        self.styles.is_busy = false;
        match outcome {
            Ok(seams) => {
                self.styles.edits.entry(style).or_default().push(seams);
                self.say("done; w saves it, u takes it back");
            }
            Err(text) => self.complain(text),
        }
    }

    /// Takes the last edit of the selected style back.
    pub(super) fn undo_edit(&mut self) {
        self.show(Screen::Styles);
        let Some(style) = self.size_row().map(|row| row.style.clone()) else { return };
        let Some(edits) = self.styles.edits.get_mut(&style) else {
            return self.say(format!("{style} is as saved: nothing to take back"));
        };
        edits.pop();
        let left = edits.len();
        if left == 0 {
            self.styles.edits.remove(&style);
        }
        self.say(format!("taken back; {left} edits of {style} are left"));
    }

    /// Saves the edited seams of the selected style.
    pub(super) fn save_seams(&mut self) -> Vec<Effect> {
        if !self.may_change(Part::Style) {
            return vec![];
        }
        let Some(style) = self.size_row().map(|row| row.style.clone()) else { return vec![] };
        let Some(seams) = self.styles.edits.get(&style).and_then(|edits| edits.last()).cloned() else {
            self.say(format!("{style} is as saved: nothing to save"));
            return vec![];
        };
        vec![Effect::Do(Act::SaveSeams(style, seams))]
    }

    /// Forgets edits that are saved, and asks whether the file of the study is to say the same.
    pub(super) fn seams_saved(&mut self, style: &str, seams: &SourceFile, outcome: Result<String, String>) {
        let text = match outcome {
            Ok(text) => text,
            Err(text) => return self.complain(text),
        };
        if self.styles.edits.get(style).and_then(|edits| edits.last()) == Some(seams) {
            self.styles.edits.remove(style);
        }
        let desk = self.styles.desk.as_ref().filter(|(laying, _)| laying.style == style);
        let home =
            desk.and_then(|(_, laid)| laid.as_ref().ok()).and_then(|laid| laid.home.clone().zip(laid.stored.clone()));
        self.say(text);
        if let Some((path, before)) = home.filter(|_| self.overlay.is_none()) {
            let text = format!("Write {} of the study too? Its comments stay; the next run uses it.", path.display());
            self.ask(text, vec![Effect::Do(Act::WriteSeams(path, before, seams.clone()))]);
        }
    }

    /// Styles with edits that are not saved.
    #[must_use]
    pub fn unsaved(&self) -> String {
        self.styles.edits.keys().cloned().collect::<Vec<_>>().join(", ")
    }
}
