//! Choosing a size, an edge, a line of the table; importing and removing.

use crate::keys::screen::Screen;
use crate::messages::answered::Answered;
use crate::messages::effect::Effect;
use crate::messages::seams::{LayoutRequest, SeamTask, SizeLayout};
use crate::overlays::Overlay;
use crate::screens::catalogue::{self, may_change};
use crate::screens::movement::{Movement, stepped};
use crate::screens::state::State;
use crate::screens::styles::numbers::keep_numbers;
use crate::screens::styles::state::{StylesScreen, TableLine};
use store::OutfitRow;
use wardrobe::{Part, SizeRow};

/// Outfits of which a style is a layer, those of the open study first.
fn outfits_of<'a>(state: &'a State, style: &str) -> Vec<&'a OutfitRow> {
    let outfits = state.data.iter().flat_map(|data| &data.outfits);
    let is_layer = |outfit: &&OutfitRow| outfit.layers.iter().any(|(_, other)| other == style);
    let mut outfits: Vec<&OutfitRow> = outfits.filter(is_layer).collect();
    outfits.sort_by_key(|outfit| state.study().is_none_or(|study| study.name != outfit.study));
    outfits
}

/// Mark of a style in lists, whole and short: its first outfit, with its place among the layers, the inmost 1. Empty for
/// a style of no outfit.
pub fn outfit_marks(state: &State, style: &str) -> [String; 2] {
    let outfits = outfits_of(state, style);
    let Some(first) = outfits.first() else { return Default::default() };
    let layer = first.layers.iter().position(|(_, other)| other == style).map_or(0, |layer| layer + 1);
    let (name, layers) = (&first.name, first.layers.len());
    let more = if outfits.len() > 1 { format!(" and {} more", outfits.len() - 1) } else { String::new() };
    [format!("layer {layer} of {layers} of {name}{more}"), format!("{layer}/{layers} {name}{more}")]
}

/// Outfits of a style in words, the inmost layer first.
pub fn outfit_lines(state: &State, style: &str) -> Vec<String> {
    let line = |outfit: &OutfitRow| {
        let layers: Vec<&str> = outfit.layers.iter().map(|(_, style)| style.as_str()).collect();
        let is_open = state.study().is_some_and(|study| study.name == outfit.study);
        let study = if is_open { String::new() } else { format!(" (study {})", outfit.study) };
        format!("outfit {}: {}{study}", outfit.name, layers.join(" under "))
    };
    outfits_of(state, style).into_iter().map(line).collect()
}

impl StylesScreen {
    pub fn sizes<'a>(&self, state: &'a State) -> Vec<&'a SizeRow> {
        let Some(data) = &state.data else { return vec![] };
        let filter = state.filter_of(Screen::Styles);
        let words = |row: &SizeRow| {
            let (marks, outfits) = (self.marks_of(state, row).concat(), outfit_lines(state, &row.style).join(" "));
            format!("{marks} {} {} {} {} {outfits}", row.style, row.size, revisions(row), row.pattern_file)
                .to_lowercase()
        };
        data.sizes.iter().filter(|row| words(row).contains(&filter)).collect()
    }

    /// Marks of a size: of the study, not saved, and the number of its proposed seams.
    pub fn marks_of(&self, state: &State, row: &SizeRow) -> [String; 3] {
        let is_used = state.study().is_some_and(|study| study.garments.contains(&row.style));
        let mark = |is_set: bool, mark: &str| if is_set { mark } else { " " }.to_owned();
        let unsure = if row.unconfirmed > 0 { format!("?{} ", row.unconfirmed) } else { String::new() };
        [mark(is_used, "•"), mark(self.edits.contains_key(&row.style), "*"), unsure]
    }

    /// Selected size. Where it is not shown: another size of its style, or the first of the list.
    pub fn size_row<'a>(&self, state: &'a State) -> Option<&'a SizeRow> {
        let sizes = self.sizes(state);
        let (style, size) = self.selected.as_ref().map_or(("", ""), |(style, size)| (style, size));
        let found = sizes.iter().find(|row| row.style == style && row.size == size);
        found.or_else(|| sizes.iter().find(|row| row.style == style)).or(sizes.first()).copied()
    }

    /// Layout of the selected size, or the reason why there is none; `None` while it is being made.
    pub fn layout(&self, state: &State) -> Option<Result<&SizeLayout, &str>> {
        let row = self.size_row(state)?;
        let Answered { request, outcome } = self.layout.as_ref()?;
        let is_shown = request.style == row.style && request.key.size == row.key.size;
        is_shown.then(|| outcome.as_deref().map_err(String::as_str))
    }

    pub fn laid_out(&self, state: &State) -> Option<&SizeLayout> {
        self.layout(state)?.ok()
    }

    /// True if the latest layout is that of the latest request.
    pub fn is_current(&self) -> bool {
        self.layout
            .as_ref()
            .is_some_and(|layout| layout.outcome.is_ok() && Some(&layout.request) == self.requested.as_ref())
    }

    pub fn table_line(&self, state: &State) -> Option<TableLine> {
        let lines = self.laid_out(state)?.lines();
        lines.get(self.line).or(lines.last()).copied()
    }

    pub fn ask_for_layout(&mut self, state: &State) -> Option<Effect> {
        let wanted = self.layout_request(state);
        if wanted == self.requested {
            return None;
        }
        self.requested.clone_from(&wanted);
        wanted.map(|request| Effect::Seams(SeamTask::LayOut(request)))
    }

    pub fn layout_request(&self, state: &State) -> Option<LayoutRequest> {
        let row = self.size_row(state)?;
        let study = state.study().filter(|study| study.garments.contains(&row.style)).map(|study| study.path.clone());
        let seams = self.edits.get(&row.style).and_then(|edits| edits.last());
        let seams = seams.map(|edited| edited.seams.clone());
        Some(LayoutRequest { style: row.style.clone(), key: row.key, seams, study })
    }

    /// Stores a layout that is still wanted.
    pub fn take_layout(
        &mut self,
        state: &mut State,
        request: LayoutRequest,
        mut outcome: Result<Box<SizeLayout>, String>,
    ) {
        if self.requested.as_ref() != Some(&request) {
            return;
        }
        let is_other = self.layout.as_ref().is_none_or(|before| before.request.key.size != request.key.size);
        let before = self.layout.as_ref().filter(|_| !is_other).and_then(|before| before.outcome.as_ref().ok());
        if let (Some(before), Ok(now)) = (before, &mut outcome) {
            keep_numbers(&before.out.desk.pieces, &mut now.out.desk.pieces);
        }
        self.layout = Some(Answered { request, outcome });
        self.marks.clear();
        if is_other {
            (self.line, self.edge) = (0, (0, 0));
        }
        let Some(layout) = self.laid_out(state) else { return };
        let (lines, pieces) = (layout.lines().len(), &layout.out.desk.pieces);
        let piece = self.edge.0.min(pieces.len().saturating_sub(1));
        let edges = pieces.get(piece).map_or(0, |piece| piece.edges.len());
        let edge = self.edge.1.min(edges.saturating_sub(1));
        self.edge = (piece, edge);
        self.line = self.line.min(lines.saturating_sub(1));
        if is_other {
            self.select_line(state, 0);
        }
        self.go_on_asking(state);
    }

    /// Selects a line of the table, and an edge of its seam.
    pub fn select_line(&mut self, state: &State, line: usize) {
        let Some(layout) = self.laid_out(state) else { return };
        let edge = match layout.lines().get(line) {
            Some(TableLine::Seam(k)) => layout.out.desk.seams[*k].a.first().copied(),
            _ => None,
        };
        self.line = line;
        self.edge = edge.unwrap_or(self.edge);
    }

    /// Selects the next edge, and the seam that it is in.
    pub fn step_edge(&mut self, state: &mut State, step: isize) {
        let Some(layout) = self.laid_out(state) else { return };
        let edges = layout.edges();
        let at = edges.iter().position(|edge| *edge == self.edge).unwrap_or(0);
        if let Some(next) = stepped(at, step, edges.len()) {
            self.go_to_edge(state, next);
        }
    }

    /// Selects an edge by its index among all, and the seam that it is in.
    pub fn go_to_edge(&mut self, state: &mut State, edge: usize) {
        let Some(layout) = self.laid_out(state) else { return };
        let Some(edge) = layout.edges().get(edge).copied() else { return };
        let line = layout.seam_at(edge).unwrap_or(self.line);
        (self.edge, self.line) = (edge, line);
        state.nav.second_pane[Screen::Styles as usize] = true;
    }

    /// Enlarges the pieces to all the room, or makes them small again.
    pub fn enlarge_pieces(&mut self, state: &mut State) {
        state.show(Screen::Styles);
        self.enlarged = !self.enlarged;
    }

    /// Removes the selected size, after a question. The last size of a style is removed with the style.
    pub fn remove_size(&self, state: &mut State) {
        if !may_change(state, Part::Style) {
            return;
        }
        let Some(row) = self.size_row(state) else { return state.say("no size is selected") };
        let is_last =
            state.data.iter().flat_map(|data| &data.sizes).filter(|other| other.style == row.style).count() < 2;
        let (part, name) = match is_last {
            true => (Part::Style, row.style.clone()),
            false => (Part::Size, format!("{}/{}", row.style, row.size)),
        };
        catalogue::remove(state, part, vec![name]);
    }

    pub fn go_in_sizes(&mut self, state: &State, movement: Movement) {
        let selected = self.size_row(state).map(|row| row.key);
        let sizes = self.sizes(state);
        let at = sizes.iter().position(|row| Some(row.key) == selected).unwrap_or(0);
        let next = sizes.get(movement.from(at, sizes.len()));
        self.selected = next.map(|row| (row.style.clone(), row.size.clone()));
    }

    pub fn go_in_seams(&mut self, state: &State, movement: Movement) {
        let lines = self.laid_out(state).map_or(0, |layout| layout.lines().len());
        self.select_line(state, movement.from(self.line, lines));
    }
}

pub fn revisions(row: &SizeRow) -> String {
    format!("{}/{}", row.style_revision, row.revision)
}

pub fn import_style(state: &mut State) {
    if may_change(state, Part::Style) {
        state.overlay = Some(Overlay::StyleForm(Box::default()));
    }
}

/// Table of seams as text, separated by tabs.
pub fn seam_table(layout: &SizeLayout) -> String {
    let desk = &layout.out.desk;
    let names = |chain: &[(usize, usize)]| chain.iter().map(|edge| desk.edge_name(*edge)).collect::<Vec<_>>().join("+");
    let mut table = String::from("seam\ta\tb\ta_mm\tb_mm\tconfidence\n");
    for seam in &desk.seams {
        let confidence = seam.confidence.map_or(String::new(), |confidence| confidence.to_string());
        let (a, b) = (names(&seam.a), names(&seam.b));
        table += &format!("{}\t{a}\t{b}\t{:.1}\t{:.1}\t{confidence}\n", seam.name, seam.a_mm, seam.b_mm);
    }
    table
}
