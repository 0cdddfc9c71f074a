//! Drawing a question: its whole text, and its answers with digits.

use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::style::Style;
use ratatui::text::Line;
use ratatui::widgets::Paragraph;

use crate::screens::state::State;
use crate::screens::styles::state::StylesScreen;
use crate::widgets::lists::pane;
use crate::widgets::text::wrapped;
use wardrobe::seams::Undecided;

impl StylesScreen {
    pub fn draw_question(&self, frame: &mut Frame<'_>, area: Rect, state: &State, asked: &Undecided) {
        let count = self.laid_out(state).map_or(0, |layout| layout.out.undecided.len());
        let title = match self.asking {
            Some(asking) if asking.own.is_none() => {
                format!("question {} of {count}", asking.at.min(count.saturating_sub(1)) + 1)
            }
            _ => "question".to_owned(),
        };
        let title =
            title + &self.laid_out(state).map_or(String::new(), |layout| left_out(layout.out.desk.left_out.len()));
        let block = pane(state.theme, title, true)
            .title_bottom(Line::styled(" y takes ●  A all sure  n next ", state.theme.legend()));
        let inner = block.inner(area);
        let about = self.laid_out(state).map_or(String::new(), |layout| layout.named(&self.pointed(state)));
        let lines = lines(state, asked, &about, usize::from(inner.width), usize::from(inner.height));
        frame.render_widget(Paragraph::new(lines).block(block), area);
    }
}

/// Number of pieces that the seam file leaves out, for a title; empty for none.
fn left_out(pieces: usize) -> String {
    match pieces {
        0 => String::new(),
        1 => " · 1 piece left out".to_owned(),
        pieces => format!(" · {pieces} pieces left out"),
    }
}

/// Lines of the question, the edges that it is about, and its answers; where they do not fit, the first ones and `…`.
fn lines(state: &State, asked: &Undecided, about: &str, width: usize, height: usize) -> Vec<Line<'static>> {
    let mut lines: Vec<Line<'_>> =
        wrapped(&asked.text, width).into_iter().map(|text| Line::styled(text, state.theme.bold())).collect();
    if !about.is_empty() {
        lines.extend(
            wrapped(&format!("● {about}"), width).into_iter().map(|text| Line::styled(text, state.theme.dim())),
        );
    }
    lines.push(Line::raw(""));
    for (k, choice) in asked.choices.iter().enumerate().take(9) {
        let mark = if asked.stands == Some(k) { "●" } else { " " };
        let style = if asked.stands == Some(k) { state.theme.good() } else { Style::new() };
        let rest = wrapped(&choice.label, width.saturating_sub(4));
        for (row, text) in rest.into_iter().enumerate() {
            let start = if row == 0 { format!("{mark}{} ", k + 1) } else { "   ".to_owned() };
            lines.push(Line::styled(format!("{start}{text}"), style));
        }
    }
    if asked.choices.is_empty() {
        let told = "only an edit helps: h l select an edge, e asks what it is sewn to, o what its piece is";
        lines.extend(wrapped(told, width).into_iter().map(|text| Line::styled(text, state.theme.dim())));
    }
    if lines.len() > height {
        lines.truncate(height.saturating_sub(1));
        lines.push(Line::styled("…", state.theme.dim()));
    }
    lines
}
