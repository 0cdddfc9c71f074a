//! Choosing a size, an edge, a line of its table; importing and removing.

use crate::keys::screen::Screen;
use crate::messages::effect::Effect;
use crate::messages::requests::Command;
use crate::messages::seams::{LayoutRequest, SeamTask, SizeLayout};
use crate::overlays::Overlay;
use crate::screens::movement::{Movement, stepped};
use crate::screens::state::State;
use crate::screens::styles::state::TableLine;
use wardrobe::{Part, SizeRow};

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

    /// The layout of the selected size, or why there is none; `None` while it is read.
    #[must_use]
    pub fn layout(&self) -> Option<Result<&SizeLayout, &str>> {
        let row = self.size_row()?;
        let (request, layout) = self.styles.layout.as_ref()?;
        let is_shown = request.style == row.style && request.key.size == row.key.size;
        is_shown.then(|| layout.as_deref().map_err(String::as_str))
    }

    /// The line of the table that is selected.
    #[must_use]
    pub fn table_line(&self) -> Option<TableLine> {
        let lines = self.layout()?.ok()?.lines();
        lines.get(self.styles.line).or(lines.last()).copied()
    }

    /// Has the selected size laid out, where that was not asked for already.
    pub fn ask_for_layout(&mut self) -> Option<Effect> {
        let wanted = self.layout_request();
        if wanted == self.styles.requested {
            return None;
        }
        self.styles.requested.clone_from(&wanted);
        wanted.map(|request| Effect::Seams(SeamTask::LayOut(request)))
    }

    /// What is to be laid out: the selected size as it is edited.
    pub fn layout_request(&self) -> Option<LayoutRequest> {
        let row = self.size_row()?;
        let study = self.data.as_ref().and_then(|data| data.study());
        let study = study.filter(|study| study.garments.contains(&row.style)).map(|study| study.path.clone());
        let seams = self.styles.edits.get(&row.style).and_then(|edits| edits.last());
        let seams = seams.map(|edited| edited.seams.clone());
        Some(LayoutRequest { style: row.style.clone(), key: row.key, seams, study })
    }

    /// Takes in what was laid out.
    pub fn take_layout(&mut self, request: LayoutRequest, outcome: Result<Box<SizeLayout>, String>) {
        if self.styles.requested.as_ref() != Some(&request) {
            return;
        }
        let is_other = self.styles.layout.as_ref().is_none_or(|(before, _)| before.key.size != request.key.size);
        self.styles.layout = Some((request, outcome));
        self.styles.marks.clear();
        if is_other {
            (self.styles.line, self.styles.edge) = (0, (0, 0));
        }
        let Some(Ok(layout)) = self.layout() else { return };
        let (lines, pieces) = (layout.lines().len(), &layout.out.desk.pieces);
        let piece = self.styles.edge.0.min(pieces.len().saturating_sub(1));
        let edges = pieces.get(piece).map_or(0, |piece| piece.edges.len());
        let edge = self.styles.edge.1.min(edges.saturating_sub(1));
        self.styles.edge = (piece, edge);
        self.styles.line = self.styles.line.min(lines.saturating_sub(1));
        if is_other {
            self.select_line(0);
        }
        self.go_on_asking();
    }

    /// Selects a line of the table, and an edge of its seam.
    pub fn select_line(&mut self, line: usize) {
        let Some(Ok(layout)) = self.layout() else { return };
        let edge = match layout.lines().get(line) {
            Some(TableLine::Seam(k)) => layout.out.desk.seams[*k].a.first().copied(),
            _ => None,
        };
        self.styles.line = line;
        self.styles.edge = edge.unwrap_or(self.styles.edge);
    }

    /// Selects the next edge, and the seam that holds it.
    pub fn step_edge(&mut self, step: isize) {
        let Some(Ok(layout)) = self.layout() else { return };
        let edges = layout.edges();
        let at = edges.iter().position(|edge| *edge == self.styles.edge).unwrap_or(0);
        if let Some(next) = stepped(at, step, edges.len()) {
            self.go_to_edge(next);
        }
    }

    /// Selects an edge by its place among all, and the seam that holds it.
    pub fn go_to_edge(&mut self, edge: usize) {
        let Some(Ok(layout)) = self.layout() else { return };
        let Some(edge) = layout.edges().get(edge).copied() else { return };
        let line = layout.seam_at(edge).unwrap_or(self.styles.line);
        (self.styles.edge, self.styles.line) = (edge, line);
        self.nav.second_pane[Screen::Styles as usize] = true;
    }

    /// Gives the pieces all the room, or less again.
    pub fn enlarge_pieces(&mut self) {
        self.show(Screen::Styles);
        self.styles.enlarged = !self.styles.enlarged;
    }

    /// Asks for the files of a style.
    pub fn import_style(&mut self) {
        if self.may_change(Part::Style) {
            self.overlay = Some(Overlay::StyleForm(Box::default()));
        }
    }

    /// Removes the selected size, with its style where it is the last, once that is confirmed.
    pub fn remove_size(&mut self) {
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
        self.ask(text, vec![Effect::Do(Command::Remove(part, name))]);
    }

    /// Moves in the list of sizes.
    pub fn go_in_sizes(&mut self, movement: Movement) {
        let selected = self.size_row().map(|row| row.key);
        let sizes = self.sizes();
        let at = sizes.iter().position(|row| Some(row.key) == selected).unwrap_or(0);
        let next = sizes.get(movement.from(at, sizes.len()));
        self.styles.selected = next.map(|row| (row.style.clone(), row.size.clone()));
    }

    /// Moves in the table of seams.
    pub fn go_in_seams(&mut self, movement: Movement) {
        let lines = self.layout().and_then(Result::ok).map_or(0, |layout| layout.lines().len());
        self.select_line(movement.from(self.styles.line, lines));
    }
}

/// The table of seams, tab-separated.
pub fn seam_table(state: &State) -> Option<String> {
    let desk = &state.layout()?.ok()?.out.desk;
    let names = |chain: &[(usize, usize)]| chain.iter().map(|edge| desk.edge_name(*edge)).collect::<Vec<_>>().join("+");
    let mut table = String::from("seam\ta\tb\ta_mm\tb_mm\tconfidence\n");
    for seam in &desk.seams {
        let confidence = seam.confidence.map_or(String::new(), |confidence| confidence.to_string());
        let (a, b) = (names(&seam.a), names(&seam.b));
        table += &format!("{}\t{a}\t{b}\t{:.1}\t{:.1}\t{confidence}\n", seam.name, seam.a_mm, seam.b_mm);
    }
    Some(table)
}
