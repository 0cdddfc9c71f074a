//! The start screen of a database without studies.

use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Rect};
use ratatui::text::Line;
use ratatui::widgets::{Paragraph, Wrap};

use crate::screens::state::State;

pub fn draw(frame: &mut Frame<'_>, area: Rect, state: &State) {
    let bold = state.theme.bold();
    let mut lines = vec![
        Line::styled("Toile: dress bodies in patterns, measure the drape, choose a simulator", bold),
        Line::raw(""),
        Line::raw("This database has no study yet."),
        Line::raw(""),
    ];
    let can_run = state.setup.abilities.run;
    lines.extend(match (&state.running.target, can_run) {
        (Some(_), _) => vec![Line::styled("▶ The quickstart is being made ready…", state.theme.busy())],
        (None, true) => vec![
            Line::styled("Enter  run the quickstart", bold),
            Line::raw("       A small study with all it needs; results appear here as they come."),
            Line::raw("       T then shows round: six screens, a few words on each."),
            Line::raw(""),
            Line::styled("a      make a study of your own", bold),
            Line::raw("       Choose subjects, styles, fabric, simulators; it writes a study.toml."),
            Line::raw(""),
            Line::styled("3 i    import a pattern of your own", bold),
            Line::raw("       DXF or GarmentCode; sewn and draped while you decide its seams."),
        ],
        (None, false) => vec![Line::raw("It is open read-only: start without --readonly to run a study.")],
    });
    lines.extend([
        Line::raw(""),
        Line::raw("Or, in another terminal:"),
        Line::raw("       toile run STUDY    runs a folder's study.toml; this screen follows"),
        Line::raw(""),
        Line::styled("?  keys    :  all actions    q  quit", state.theme.dim()),
    ]);
    let height = (lines.len() as u16).min(area.height);
    let [_, column, _] =
        Layout::horizontal([Constraint::Fill(1), Constraint::Max(76), Constraint::Fill(1)]).areas(area);
    let [_, place, _] =
        Layout::vertical([Constraint::Fill(1), Constraint::Length(height), Constraint::Fill(2)]).areas(column);
    frame.render_widget(Paragraph::new(lines).wrap(Wrap { trim: false }), place);
}
