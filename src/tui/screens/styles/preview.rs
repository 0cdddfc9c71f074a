//! Preview of the selected size: sewn coarsely on the chosen subject, and shown beside the pieces.

use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Rect};
use ratatui::text::Line;
use ratatui::widgets::Paragraph;

use crate::keys::screen::Screen;
use crate::messages::answered::Answered;
use crate::messages::effect::Effect;
use crate::messages::seams::{LayoutRequest, PreviewRequest, Previewed};
use crate::screens::picture_pane::draw::{draw_shot, parts};
use crate::screens::state::State;
use crate::screens::styles::state::StylesScreen;
use crate::widgets::layout::{WIDE, is_narrow};
use crate::widgets::lists::pane;
use crate::widgets::picture::{FRONT, Pictured, look_name, next_view};
use crate::widgets::text::{shortened, wrapped};
use results::preview::{Care, Hung};
use store::SubjectId;

/// Lines below the picture, without that of a legend: in a high pane, and in a low one.
const TOLD: [u16; 2] = [5, 2];
/// Least lines of a high pane.
const HIGH: u16 = 30;

impl StylesScreen {
    /// True if the preview is shown: beside the pieces or, where only one fits, instead of them.
    fn shows_preview(&self, state: &State) -> bool {
        let is_wide = state.body().width >= WIDE;
        state.setup.abilities.pictures && !is_narrow(state.body()) && (is_wide || self.preview.is_chosen)
    }

    /// Fabric in which the shown study wears the selected style; `None` where it does not.
    pub fn cloth<'a>(&self, state: &'a State) -> Option<&'a String> {
        state.data.as_ref()?.cloths.get(&self.size_row(state)?.style)
    }

    /// Requests a preview of the selected size with its edits, if it is shown and was not requested before.
    pub fn ask_for_preview(&mut self, state: &State) -> Option<Effect> {
        if !self.shows_preview(state) || !self.is_current() {
            return None;
        }
        let (size, subject) = (self.dressed_size(state)?, state.in_hand.subject?);
        let asked = self.preview.asked.as_ref();
        if asked.is_some_and(|asked| asked.is_of(&size, subject, state.in_hand.fabric.as_ref())) {
            return None;
        }
        Some(self.dress(state, size, subject, Care::Glance))
    }

    /// Request for the selected size with its seam file, edited or stored.
    fn dressed_size(&self, state: &State) -> Option<LayoutRequest> {
        let size = self.layout_request(state)?;
        let stored = self.laid_out(state).and_then(|layout| layout.stored.clone());
        Some(LayoutRequest { seams: size.seams.or(stored), ..size })
    }

    fn dress(&mut self, state: &State, size: LayoutRequest, subject: SubjectId, care: Care) -> Effect {
        let number = self.preview.asked.as_ref().map_or(1, |asked| asked.number + 1);
        let request = PreviewRequest { number, size, subject, fabric: state.in_hand.fabric.clone(), care };
        self.preview.asked = Some(request.clone());
        Effect::Preview(request)
    }

    /// Drapes the selected size on the chosen subject, as finely as a study.
    pub fn try_on(&mut self, state: &mut State) -> Vec<Effect> {
        state.show(Screen::Styles);
        let subject = state.subject_in_hand().map(|subject| (subject.id, subject.name.clone()));
        let (Some((subject, name)), Some(size)) = (subject, self.dressed_size(state)) else {
            return state.reply("a size and a subject are needed: i imports a style, 2 shows the subjects");
        };
        if !state.setup.abilities.pictures {
            return state.reply("pictures are off (--images off)");
        }
        self.preview.is_chosen = true;
        state.say(format!("draping {} {} on {name}…", size.style, self.size_row(state).map_or("", |row| &row.size)));
        vec![self.dress(state, size, subject, Care::Trial)]
    }

    /// Stores a preview that is still wanted.
    pub fn take_preview(&mut self, state: &mut State, request: PreviewRequest, outcome: Result<Previewed, String>) {
        if request.care == Care::Trial {
            match &outcome {
                Ok(seen) => {
                    let told =
                        if seen.remarks.is_empty() { String::new() } else { format!(": {}", seen.remarks.join("; ")) };
                    state.say(format!("tried on by {} in {:.1} s{told}", seen.subject, seen.took_ms as f64 / 1e3));
                }
                Err(error) => state.complain(error.clone()),
            }
        }
        self.preview.seen = Some(Answered { request, outcome });
    }

    /// Shows the preview from the next side. Where only one fits, the pieces follow after the last side.
    pub fn turn_preview(&mut self, state: &mut State) {
        if !state.setup.abilities.pictures {
            return state.say("pictures are off (--images off)");
        }
        let is_wide = state.body().width >= WIDE;
        let (preview, look) = (&mut self.preview, &mut state.pictures.look);
        if !is_wide && !preview.is_chosen {
            (preview.is_chosen, *look) = (true, FRONT);
            return;
        }
        *look = next_view(*look);
        preview.is_chosen = is_wide || *look != FRONT;
    }

    pub fn previewed(&self, state: &State, area: Rect) -> Vec<(Pictured, Rect)> {
        let number = self.preview.seen.as_ref().filter(|seen| seen.outcome.is_ok()).map(|seen| seen.request.number);
        let pane = self
            .preview_place(state, area)
            .map(|pane| Rect { height: pane.height.saturating_sub(told_lines(pane)), ..pane });
        number.map(Pictured::Preview).zip(pane).into_iter().collect()
    }

    /// Area of the preview within that of the pieces; `None` where it is not shown.
    pub fn preview_place(&self, state: &State, area: Rect) -> Option<Rect> {
        if !self.shows_preview(state) {
            return None;
        }
        if area.width < WIDE * 9 / 20 {
            return Some(area);
        }
        Some(Layout::horizontal([Constraint::Fill(3), Constraint::Fill(2)]).areas::<2>(area)[1])
    }

    pub fn draw_preview(&self, frame: &mut Frame<'_>, area: Rect, state: &State) {
        let view = look_name(state.pictures.look);
        let seen = self.preview.seen.as_ref().map(|Answered { request, outcome }| (request, outcome));
        let on = match seen {
            Some((_, Ok(seen))) => format!("on {} in {} · {view}", seen.subject, seen.fabric),
            _ => "on the body".to_owned(),
        };
        let block = pane(state.theme, on, false)
            .title_bottom(Line::styled(" v turns it  2 body  9 cloth ", state.theme.legend()));
        let [picture, told] = split(area, block.inner(area));
        frame.render_widget(block, area);
        let is_current = seen.is_some_and(|(request, _)| Some(request) == self.preview.asked.as_ref());
        let (text, style) = match seen {
            _ if state.subject_in_hand().is_none() => {
                ("no subject to dress: 2 shows them, a adds one".to_owned(), state.theme.dim())
            }
            None => ("sewing it…".to_owned(), state.theme.busy()),
            Some((_, Err(error))) => (format!("✗ {error}"), state.theme.bad()),
            Some((request, Ok(seen))) => {
                let (sign, style) = match seen.hung {
                    Hung::Draped if request.care == Care::Trial => ("✓ draped as a study does", state.theme.good()),
                    Hung::Draped => ("✓ sewn and draped coarsely", state.theme.good()),
                    Hung::Undone => ("✗ not sewn up", state.theme.bad()),
                    Hung::Not => ("✗ not placed", state.theme.bad()),
                };
                let again = match self.preview.asked.as_ref().map(|asked| asked.care) {
                    _ if is_current => "",
                    Some(Care::Trial) => "; draping it…",
                    _ => "; sewing it again…",
                };
                let remarks = seen.remarks.iter().map(|remark| format!("; {remark}")).collect::<String>();
                (format!("{sign}{remarks}{again}"), style)
            }
        };
        let mut texts = wrapped(&text, usize::from(told.width));
        if texts.len() > usize::from(told.height) {
            texts.truncate(usize::from(told.height));
            if let Some(last) = texts.last_mut() {
                *last = shortened(&format!("{last} …………"), usize::from(told.width));
            }
        }
        let lines: Vec<Line<'_>> = texts.into_iter().map(|text| Line::styled(text, style)).collect();
        frame.render_widget(Paragraph::new(lines), told);
        if let Some((request, Ok(_))) = seen {
            draw_shot(frame, picture, state, Some(Pictured::Preview(request.number)), "");
        }
    }
}

fn told_lines(pane: Rect) -> u16 {
    TOLD[usize::from(pane.height < HIGH)]
}

/// Areas of the picture, in its requested size, and of the text below.
fn split(pane: Rect, inner: Rect) -> [Rect; 2] {
    let (picture, _) = parts(Rect { height: inner.height.saturating_sub(told_lines(pane)), ..inner });
    let told = Rect { y: picture.bottom(), height: inner.bottom().saturating_sub(picture.bottom()), ..inner };
    [picture, told]
}
