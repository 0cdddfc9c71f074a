//! What is done to the seams of a style.

use crate::keys::screen::Screen;
use crate::messages::effect::Effect;
use crate::messages::requests::Command;
use crate::messages::seams::{LayoutRequest, SeamTask};
use crate::messages::taught;
use crate::screens::state::State;
use crate::screens::styles::state::{Asking, EdgeAt, Edited};
use store::files::SourceFile;
use wardrobe::seams::{DeskSeam, SeamEdit, SeamStep};
use wardrobe::{Part, SizeRow};

impl State {
    /// Gives the seams the focus; whether they can be worked on now.
    pub fn may_sew(&mut self) -> bool {
        if !self.may_change(Part::Style) {
            return false;
        }
        self.nav.second_pane[Screen::Styles as usize] = true;
        let is_current =
            matches!(&self.styles.layout, Some((request, Ok(_))) if Some(request) == self.styles.requested.as_ref());
        let is_ready = is_current && self.layout().is_some() && !self.styles.is_busy;
        if !is_ready && self.size_row().is_none() {
            self.say("no size is selected: i imports one");
        } else if !is_ready {
            self.say("the pieces are not laid out yet");
        }
        is_ready
    }

    /// Marks the selected edge, or takes its mark away.
    pub fn mark_edge(&mut self) {
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
    pub fn add_seam(&mut self) -> Vec<Effect> {
        if !self.may_sew() {
            return vec![];
        }
        let mut sides = self.styles.marks.clone();
        if sides.len() < 2 && !sides.contains(&self.styles.edge) {
            sides.push(self.styles.edge);
        }
        let Some(Ok(layout)) = self.layout() else { return vec![] };
        let [first, others @ ..] = sides.as_slice() else { return vec![] };
        if others.is_empty() {
            self.say("m marks an edge; then go to the edge it is sewn to, and a sews them");
            return vec![];
        }
        let length = |(piece, edge): &EdgeAt| layout.out.desk.pieces[*piece].edges[*edge].length_mm;
        let (a_mm, b_mm) = (length(first), others.iter().map(length).sum::<f64>());
        let a = layout.out.desk.edge_name(*first);
        let b = others.iter().map(|edge| layout.out.desk.edge_name(*edge)).collect::<Vec<_>>().join("+");
        let is_eased = (a_mm - b_mm).abs() > layout.out.tolerance_mm;
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
        let layout = self.layout()?.ok()?;
        let found = layout.seam_at(self.styles.edge).map(|k| layout.out.desk.seams[k].clone());
        if found.is_none() {
            self.say("no seam holds the selected edge");
        }
        found
    }

    /// Two edges that name a seam: one of each side.
    fn between(&self, seam: &DeskSeam) -> Option<(String, String)> {
        let layout = self.layout()?.ok()?;
        Some((layout.out.desk.edge_name(*seam.a.first()?), layout.out.desk.edge_name(*seam.b.first()?)))
    }

    /// Opens the selected seam.
    pub fn remove_seam(&mut self) -> Vec<Effect> {
        let edges = self.selected_seam().and_then(|seam| self.between(&seam));
        edges.map_or(vec![], |(a, b)| self.step_of_work(SeamStep::Edit(SeamEdit::Remove { a, b })))
    }

    /// Turns one side of the selected seam round.
    pub fn flip_seam(&mut self) -> Vec<Effect> {
        let edges = self.selected_seam().and_then(|seam| self.between(&seam));
        edges.map_or(vec![], |(a, b)| self.step_of_work(SeamStep::Edit(SeamEdit::Flip { a, b })))
    }

    /// Gives the seams the focus, and asks what is to be decided about them.
    pub fn decide(&mut self) {
        let had_focus = self.in_second_pane();
        self.show(Screen::Styles);
        self.nav.second_pane[Screen::Styles as usize] = true;
        let is_decided = self.layout().is_some_and(|layout| layout.is_ok_and(|layout| layout.out.undecided.is_empty()));
        if had_focus {
            self.begin_asking();
        } else if !is_decided {
            // What is not laid out yet is asked once it is.
            self.styles.asking = Some(Asking { at: 0, own: None, goes_on: true });
            if self.layout().is_some() {
                self.go_on_asking();
            }
        }
    }

    /// Proposes the seams of the selected style; asks where that replaces seams that somebody has made or confirmed.
    pub fn propose_seams(&mut self) -> Vec<Effect> {
        // What cannot be laid out with the seams it has may get others.
        if !self.may_change(Part::Style) || self.styles.is_busy {
            return vec![];
        }
        let Some(style) = self.size_row().map(|row| row.style.clone()) else { return vec![] };
        let replaced = self.layout().and_then(Result::ok).map_or(0, |layout| {
            layout.out.desk.seams.iter().filter(|seam| seam.confidence.is_none()).count() + layout.out.lengths.len()
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

    pub fn step_of_work(&mut self, step: SeamStep) -> Vec<Effect> {
        let Some(request) = self.layout_request() else { return vec![] };
        self.styles.is_busy = true;
        vec![Effect::Seams(SeamTask::Sew(request, step))]
    }

    /// Takes in a seam file after a step of work.
    pub fn sewn(&mut self, (request, step): (LayoutRequest, SeamStep), outcome: Result<SourceFile, String>) {
        self.styles.is_busy = false;
        let of_size = |row: &SizeRow| row.key.size == request.key.size;
        let size = self.data.iter().flat_map(|data| &data.sizes).find(|row| of_size(row));
        let size = size.map_or_else(|| request.style.clone(), |row| format!("{}/{}", row.style, row.size));
        let style = request.style;
        match outcome {
            Ok(seams) => {
                self.styles.undone.remove(&style);
                self.styles.edits.entry(style).or_default().push(Edited { size, step, seams });
                self.say("done; w saves it, u takes it back");
            }
            Err(text) => self.complain(text),
        }
    }

    /// Takes the last edit of the selected style back.
    pub fn undo_edit(&mut self) {
        self.show(Screen::Styles);
        let Some(style) = self.size_row().map(|row| row.style.clone()) else { return };
        let Some(edits) = self.styles.edits.get_mut(&style) else {
            return self.say(format!("{style} is as saved: nothing to take back"));
        };
        self.styles.undone.entry(style.clone()).or_default().extend(edits.pop());
        let left = edits.len();
        if left == 0 {
            self.styles.edits.remove(&style);
        }
        let left = match left {
            0 => "none is left".to_owned(),
            1 => "one is left".to_owned(),
            left => format!("{left} are left"),
        };
        self.say(format!("the last edit of {style} is taken back, {left}; U does it again"));
    }

    /// Does the edit of the selected style again that was taken back last.
    pub fn redo_edit(&mut self) {
        self.show(Screen::Styles);
        let Some(style) = self.size_row().map(|row| row.style.clone()) else { return };
        match self.styles.undone.get_mut(&style).and_then(Vec::pop) {
            Some(edit) => {
                self.styles.edits.entry(style).or_default().push(edit);
                self.say("done again");
            }
            None => self.say(format!("no edit of {style} was taken back")),
        }
    }

    /// Saves the edited seams of the selected style.
    pub fn save_seams(&mut self) -> Vec<Effect> {
        if !self.may_change(Part::Style) {
            return vec![];
        }
        let Some(style) = self.size_row().map(|row| row.style.clone()) else { return vec![] };
        let Some(seams) =
            self.styles.edits.get(&style).and_then(|edits| edits.last()).map(|edited| edited.seams.clone())
        else {
            self.say(format!("{style} is as saved: nothing to save"));
            return vec![];
        };
        vec![Effect::Do(Command::SaveSeams(style, seams))]
    }

    /// Forgets edits that are saved, and asks whether the file of the study is to say the same.
    pub fn seams_saved(&mut self, style: &str, seams: &SourceFile, outcome: Result<String, String>) {
        let text = match outcome {
            Ok(text) => text,
            Err(text) => return self.complain(text),
        };
        let is_last = |edits: &&Vec<Edited>| edits.last().is_some_and(|last| last.seams == *seams);
        if self.styles.edits.get(style).filter(is_last).is_some() {
            let edits = self.styles.edits.remove(style).unwrap_or_default();
            self.told.commands.extend(edits.iter().map(|edited| taught::sewn(&edited.size, &edited.step)));
        }
        let desk = self.styles.layout.as_ref().filter(|(request, _)| request.style == style);
        let home = desk
            .and_then(|(_, layout)| layout.as_ref().ok())
            .and_then(|layout| layout.home.clone().zip(layout.stored.clone()));
        self.say(text);
        if let Some((path, before)) = home.filter(|_| self.overlay.is_none()) {
            let text = format!("Write {} of the study too? Its comments stay; the next run uses it.", path.display());
            self.ask(text, vec![Effect::Do(Command::WriteSeams(path, before, seams.clone()))]);
        }
    }

    /// Styles with edits that are not saved.
    #[must_use]
    pub fn unsaved(&self) -> String {
        self.styles.edits.keys().cloned().collect::<Vec<_>>().join(", ")
    }
}
