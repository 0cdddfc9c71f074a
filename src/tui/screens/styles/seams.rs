//! Editing, proposing and saving the seams of a style.

use crate::keys::screen::Screen;
use crate::messages::effect::{Effect, Writing};
use crate::messages::requests::Command;
use crate::messages::seams::{LayoutRequest, SeamTask, SeamWork};
use crate::messages::taught;
use crate::screens::catalogue::may_change;
use crate::screens::state::State;
use crate::screens::styles::state::{Asking, EdgeAt, Edited, StylesScreen};
use store::files::SourceFile;
use wardrobe::Part;
use wardrobe::seams::{DeskSeam, SeamEdit, SeamStep};

impl StylesScreen {
    /// Moves the focus to the seams. Returns true if they can be edited now; else says why not.
    pub fn may_sew(&self, state: &mut State) -> bool {
        if !may_change(state, Part::Style) {
            return false;
        }
        state.nav.second_pane[Screen::Styles as usize] = true;
        let is_ready = self.is_current() && self.layout(state).is_some() && !self.is_busy;
        if !is_ready && self.size_row(state).is_none() {
            state.say("no size is selected: i imports one");
        } else if !is_ready {
            state.say("the pieces are not laid out yet");
        }
        is_ready
    }

    /// Marks the selected edge, or takes the mark away.
    pub fn mark_edge(&mut self, state: &mut State) {
        if !self.may_sew(state) {
            return;
        }
        let (edge, marks) = (self.edge, &mut self.marks);
        match marks.iter().position(|mark| *mark == edge) {
            Some(at) => drop(marks.remove(at)),
            None => marks.push(edge),
        }
    }

    /// Sews the edge that was marked first to the other marked edges; without others, to the selected edge.
    pub fn add_seam(&mut self, state: &mut State) -> Vec<Effect> {
        if !self.may_sew(state) {
            return vec![];
        }
        let mut sides = self.marks.clone();
        if sides.len() < 2 && !sides.contains(&self.edge) {
            sides.push(self.edge);
        }
        let Some(layout) = self.laid_out(state) else { return vec![] };
        let [first, others @ ..] = sides.as_slice() else { return vec![] };
        if others.is_empty() {
            return state.reply("m marks an edge; then go to the edge it is sewn to, and a sews them");
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
        let effects = self.step_of_work(state, SeamStep::Edit(SeamEdit::Add { a, b, name: None, is_eased }));
        if is_eased {
            self.is_busy = false;
            state.ask(text, effects);
            return vec![];
        }
        effects
    }

    /// Seam that the selected edge is in; `None`, with a message, where it is in none.
    fn selected_seam(&self, state: &mut State) -> Option<DeskSeam> {
        if !self.may_sew(state) {
            return None;
        }
        let layout = self.laid_out(state)?;
        let found = layout.seam_at(self.edge).map(|k| layout.out.desk.seams[k].clone());
        if found.is_none() {
            state.say("no seam holds the selected edge");
        }
        found
    }

    /// Two edges that identify a seam, one of each side.
    fn between(&self, state: &State, seam: &DeskSeam) -> Option<(String, String)> {
        let layout = self.laid_out(state)?;
        Some((layout.out.desk.edge_name(*seam.a.first()?), layout.out.desk.edge_name(*seam.b.first()?)))
    }

    pub fn remove_seam(&mut self, state: &mut State) -> Vec<Effect> {
        let edges = self.selected_seam(state).and_then(|seam| self.between(state, &seam));
        edges.map_or(vec![], |(a, b)| self.step_of_work(state, SeamStep::Edit(SeamEdit::Remove { a, b })))
    }

    /// Reverses one side of the selected seam.
    pub fn flip_seam(&mut self, state: &mut State) -> Vec<Effect> {
        let edges = self.selected_seam(state).and_then(|seam| self.between(state, &seam));
        edges.map_or(vec![], |(a, b)| self.step_of_work(state, SeamStep::Edit(SeamEdit::Flip { a, b })))
    }

    /// Moves the focus to the seams, and asks the open questions about them.
    pub fn decide(&mut self, state: &mut State) {
        let had_focus = state.in_second_pane();
        state.show(Screen::Styles);
        state.nav.second_pane[Screen::Styles as usize] = true;
        let is_decided =
            self.layout(state).is_some_and(|layout| layout.is_ok_and(|layout| layout.out.undecided.is_empty()));
        if had_focus {
            self.begin_asking(state);
        } else if !is_decided {
            // If the size is not laid out yet, asking starts once it is.
            self.asking = Some(Asking { at: 0, own: None, goes_on: true });
            if self.layout(state).is_some() {
                self.go_on_asking(state);
            }
        }
    }

    /// Proposes the seams of the selected style, after a question if that replaces seams that somebody made or
    /// confirmed.
    pub fn propose_seams(&mut self, state: &mut State) -> Vec<Effect> {
        // A size that its present seams do not fit may get others.
        if !may_change(state, Part::Style) || self.is_busy {
            return vec![];
        }
        let Some(style) = self.size_row(state).map(|row| row.style.clone()) else { return vec![] };
        let replaced = self.laid_out(state).map_or(0, |layout| {
            let made = layout.out.desk.seams.iter().filter(|seam| seam.confidence.is_none()).count();
            made + layout.out.lengths.len() + layout.out.answered
        });
        let effects = self.step_of_work(state, SeamStep::Propose(style.clone()));
        if replaced > 0 {
            self.is_busy = false;
            let text = format!(
                "Propose all seams of {style} anew? Its answers, seams and measurements go; u brings them back."
            );
            state.ask(text, effects);
            return vec![];
        }
        effects
    }

    pub fn step_of_work(&mut self, state: &State, step: SeamStep) -> Vec<Effect> {
        let Some(request) = self.layout_request(state) else { return vec![] };
        self.is_busy = true;
        vec![Effect::Seams(SeamTask::Sew(SeamWork { size: request, step }))]
    }

    pub fn sewn(&mut self, state: &mut State, work: SeamWork, outcome: Result<SourceFile, String>) {
        let SeamWork { size: request, step } = work;
        self.is_busy = false;
        let size = state.data.iter().flat_map(|data| &data.sizes).find(|row| row.key.size == request.key.size);
        let size = size.map_or_else(|| request.style.clone(), |row| format!("{}/{}", row.style, row.size));
        let style = request.style;
        match outcome {
            Ok(seams) => {
                self.undone.remove(&style);
                self.edits.entry(style).or_default().push(Edited { size, step, seams });
                state.say("done; w saves it, u takes it back");
            }
            Err(text) => state.complain(text),
        }
    }

    pub fn undo_edit(&mut self, state: &mut State) {
        state.show(Screen::Styles);
        let Some(style) = self.size_row(state).map(|row| row.style.clone()) else { return };
        let Some(edits) = self.edits.get_mut(&style) else {
            return state.say(format!("{style} is as saved: nothing to take back"));
        };
        self.undone.entry(style.clone()).or_default().extend(edits.pop());
        let left = edits.len();
        if left == 0 {
            self.edits.remove(&style);
        }
        let left = match left {
            0 => "none is left".to_owned(),
            1 => "one is left".to_owned(),
            left => format!("{left} are left"),
        };
        state.say(format!("the last edit of {style} is taken back, {left}; U does it again"));
    }

    pub fn redo_edit(&mut self, state: &mut State) {
        state.show(Screen::Styles);
        let Some(style) = self.size_row(state).map(|row| row.style.clone()) else { return };
        match self.undone.get_mut(&style).and_then(Vec::pop) {
            Some(edit) => {
                self.edits.entry(style).or_default().push(edit);
                state.say("done again");
            }
            None => state.say(format!("no edit of {style} was taken back")),
        }
    }

    pub fn save_seams(&self, state: &mut State) -> Vec<Effect> {
        if !may_change(state, Part::Style) {
            return vec![];
        }
        let Some(style) = self.size_row(state).map(|row| row.style.clone()) else { return vec![] };
        let Some(seams) = self.edits.get(&style).and_then(|edits| edits.last()).map(|edited| edited.seams.clone())
        else {
            return state.reply(format!("{style} is as saved: nothing to save"));
        };
        vec![Effect::Do(Command::SaveSeams(style, seams))]
    }

    /// Forgets edits that were saved, and asks if the study's own seam file should be replaced too.
    pub fn seams_saved(&mut self, state: &mut State, style: &str, seams: &SourceFile, outcome: Result<String, String>) {
        let text = match outcome {
            Ok(text) => text,
            Err(text) => return state.complain(text),
        };
        let is_last = |edits: &&Vec<Edited>| edits.last().is_some_and(|last| last.seams == *seams);
        if self.edits.get(style).filter(is_last).is_some() {
            let edits = self.edits.remove(style).unwrap_or_default();
            state.told.commands.extend(edits.iter().map(|edited| taught::sewn(&edited.size, &edited.step)));
        }
        let layout = self.layout.as_ref().filter(|layout| layout.request.style == style);
        let layout = layout.and_then(|layout| layout.outcome.as_ref().ok());
        let home = layout.and_then(|layout| layout.home.clone().zip(layout.stored.clone()));
        state.say(text);
        if let Some((path, before)) = home.filter(|_| state.overlay.is_none()) {
            let text = format!("Write {} of the study too? Its comments stay; the next run uses it.", path.display());
            state.ask(text, vec![Effect::Do(Command::WriteSeams(path, before, seams.clone()))]);
        }
    }

    /// Seam file of the selected size with its edits, for the user's editor.
    pub fn seam_file(&self, state: &State) -> Option<Writing> {
        let request = self.layout_request(state)?;
        let stored = self.laid_out(state).and_then(|layout| layout.stored.clone());
        let file = request.seams.clone().or(stored)?;
        Some(Writing::Seams(request, file))
    }

    pub fn written(
        &mut self,
        state: &mut State,
        request: LayoutRequest,
        file: SourceFile,
        text: String,
    ) -> Vec<Effect> {
        if text.as_bytes() == &*file.bytes {
            return state.reply("the seams are as they were");
        }
        let file = SourceFile { name: file.name, bytes: text.into_bytes().into() };
        self.is_busy = true;
        vec![Effect::Seams(SeamTask::Sew(SeamWork { size: request, step: SeamStep::Written(file) }))]
    }

    /// Names of the styles with unsaved edits.
    pub fn unsaved(&self) -> String {
        self.edits.keys().cloned().collect::<Vec<_>>().join(", ")
    }
}
