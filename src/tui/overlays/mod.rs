//! Lists, forms and questions that open above a screen. Each owns the keyboard while it is open.

pub mod action_list;
pub mod commands;
pub mod comment_form;
pub mod entry_form;
pub mod explanation;
pub mod form_frame;
pub mod jump;
pub mod outcome;
pub mod path_prompt;
pub mod saved_queries;
pub mod study_form;
pub mod style_form;
pub mod things;
pub mod tour;

use crossterm::event::{KeyCode, KeyEvent};
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::{Line, Span};
use ratatui::widgets::{Clear, Paragraph, Wrap};

use crate::messages::effect::Effect;
use crate::overlays::action_list::{List, Row};
use crate::overlays::commands::CommandLog;
use crate::overlays::comment_form::CommentForm;
use crate::overlays::entry_form::Form;
use crate::overlays::explanation::Explanation;
use crate::overlays::jump::Jump;
use crate::overlays::outcome::Outcome;
use crate::overlays::path_prompt::PathPrompt;
use crate::overlays::saved_queries::QueryList;
use crate::overlays::study_form::StudyForm;
use crate::overlays::style_form::StyleForm;
use crate::overlays::tour::Tour;
use crate::widgets::layout::middle;
use crate::widgets::lists::pane;
use crate::widgets::text::wrapped;
use crate::widgets::theme::Theme;
use crate::widgets::typing::{edit, is_ctrl_c};

#[derive(Clone, Debug, PartialEq)]
pub enum Overlay {
    Help(List),
    Palette(List),
    Explanation(Explanation),
    Jump(Jump),
    /// Line of the filter, with the filter to restore on Esc.
    Filter(String),
    /// Values of a subject or fabric.
    Form(Box<Form>),
    Path(PathPrompt),
    StyleForm(Box<StyleForm>),
    CommentForm(Box<CommentForm>),
    StudyForm(Box<StudyForm>),
    Queries(QueryList),
    Commands(CommandLog),
    Tour(Tour),
    Question {
        text: String,
        answers: Vec<Answer>,
    },
}

#[derive(Clone, Debug, PartialEq)]
pub struct Answer {
    /// Key that gives the answer, in lower or upper case.
    pub key: char,
    pub label: &'static str,
    pub effects: Vec<Effect>,
}

impl Overlay {
    pub fn draw(&self, frame: &mut Frame<'_>, area: Rect, theme: Theme) {
        match self {
            Self::Help(list) => {
                let title = format!("keys: /{}▏  type to filter, ↵ does it, Esc closes", list.text);
                action_list::draw(frame, area, &title, list, theme);
            }
            Self::Palette(list) => {
                let title = format!(":{}▏  ↑↓ choose, ↵ does it, Esc closes", list.text);
                action_list::draw(frame, area, &title, list, theme);
            }
            Self::Explanation(explanation) => explanation::draw(frame, area, explanation, theme),
            Self::Jump(jump) => jump::draw(frame, area, jump, theme),
            Self::Form(form) => entry_form::draw(frame, area, form, theme),
            Self::Path(prompt) => path_prompt::draw(frame, area, prompt, theme),
            Self::StyleForm(form) => style_form::draw(frame, area, form, theme),
            Self::CommentForm(form) => comment_form::draw(frame, area, form, theme),
            Self::StudyForm(form) => study_form::draw(frame, area, form, theme),
            Self::Queries(list) => saved_queries::draw(frame, area, list, theme),
            Self::Commands(log) => commands::draw(frame, area, log, theme),
            Self::Tour(tour) => tour::draw(frame, area, *tour, theme),
            Self::Question { text, answers } => draw_question(frame, area, text, answers, theme),
            Self::Filter(_) => {}
        }
    }

    /// Handles a key; `filter` is the filter of the screen.
    pub fn key(&mut self, event: &KeyEvent, filter: &mut String) -> Outcome {
        let leaves = event.code == KeyCode::Esc || is_ctrl_c(event);
        match self {
            Self::Help(_) | Self::Palette(_) if leaves => Outcome::Closed,
            Self::Help(list) | Self::Palette(list) if event.code == KeyCode::Enter => match list.rows().get(list.row) {
                Some(Row::Action(binding)) => Outcome::Action(binding.action),
                Some(Row::Thing(thing)) => Outcome::Thing((*thing).clone()),
                None => Outcome::Open,
            },
            Self::Help(list) | Self::Palette(list) => {
                list.edit(event);
                Outcome::Open
            }
            Self::Form(_) | Self::Path(_) | Self::StyleForm(_) | Self::Queries(_) if leaves => Outcome::Closed,
            Self::CommentForm(_) | Self::Commands(_) | Self::Tour(_) | Self::Explanation(_) if leaves => {
                Outcome::Closed
            }
            Self::Jump(jump) => jump.key(event),
            Self::Explanation(explanation) => {
                explanation.key(event);
                Outcome::Open
            }
            Self::Tour(tour) => tour.key(event),
            Self::Commands(log) => log.key(event),
            Self::StudyForm(form) => form.key(event),
            Self::Queries(list) => list.key(event),
            Self::Form(form) => form.key(event),
            Self::Path(prompt) => prompt.key(event),
            Self::StyleForm(form) => form.key(event),
            Self::CommentForm(form) => form.key(event),
            Self::Filter(before) if leaves => {
                filter.clone_from(before);
                Outcome::Closed
            }
            Self::Filter(_) if event.code == KeyCode::Enter => Outcome::Closed,
            Self::Filter(_) => {
                edit(filter, event);
                Outcome::Open
            }
            Self::Question { answers, .. } => {
                let is_given = |answer: &&mut Answer| matches!(event.code, KeyCode::Char(key) if key.eq_ignore_ascii_case(&answer.key));
                let given = answers.iter_mut().find(is_given);
                given.map_or(Outcome::Closed, |answer| Outcome::Effects(std::mem::take(&mut answer.effects)))
            }
        }
    }
}

fn draw_question(frame: &mut Frame<'_>, area: Rect, text: &str, answers: &[Answer], theme: Theme) {
    let width = area.width.min(60);
    let inside = usize::from(width.saturating_sub(2));
    let keys = answers.iter().flat_map(|answer| {
        [Span::styled(answer.key.to_string(), theme.bold()), Span::raw(format!(" {}    ", answer.label))]
    });
    let keys = Line::from_iter(keys.chain([Span::raw("any other key: no")]));
    let keys_rows = keys.width().div_ceil(inside.max(1));
    let rows = (wrapped(text, inside).len() + keys_rows + 3) as u16;
    let place = middle(area, width, rows.min(area.height));
    let lines = vec![Line::raw(text.to_owned()), Line::raw(""), keys];
    let block = pane(theme, "sure?", true).border_style(theme.warn());
    frame.render_widget(Clear, place);
    frame.render_widget(Paragraph::new(lines).wrap(Wrap { trim: true }).block(block), place);
}

#[cfg(test)]
mod tests {
    use crossterm::event::KeyModifiers;

    use super::*;
    use crate::keys::action::Action;
    use crate::keys::screen::Screen;
    use crate::keys::table::BINDINGS;

    fn press(code: KeyCode) -> KeyEvent {
        KeyEvent::new(code, KeyModifiers::NONE)
    }

    fn typed(overlay: &mut Overlay, filter: &mut String, text: &str) {
        for letter in text.chars() {
            assert_eq!(overlay.key(&press(KeyCode::Char(letter)), filter), Outcome::Open);
        }
    }

    #[test]
    fn the_palette_runs_what_is_typed() {
        let (mut palette, mut filter) = (Overlay::Palette(List::of(BINDINGS, Screen::Study)), String::new());
        typed(&mut palette, &mut filter, "canx");
        palette.key(&press(KeyCode::Backspace), &mut filter);
        assert_eq!(palette.key(&press(KeyCode::Enter), &mut filter), Outcome::Action(Action::Cancel));
        typed(&mut palette, &mut filter, "zzz");
        assert_eq!(palette.key(&press(KeyCode::Enter), &mut filter), Outcome::Open, "nothing matches");
    }

    #[test]
    fn every_action_can_be_reached_from_the_palette() {
        for binding in BINDINGS {
            let (mut palette, mut filter) = (Overlay::Palette(List::of(BINDINGS, Screen::Study)), String::new());
            typed(&mut palette, &mut filter, binding.name);
            assert_eq!(palette.key(&press(KeyCode::Enter), &mut filter), Outcome::Action(binding.action));
        }
    }

    #[test]
    fn keys_of_the_screen_come_first_and_those_of_other_screens_last() {
        let check = |screen: Screen, first: Action, last: Action| {
            let list = List::of(BINDINGS, screen);
            let rows = list.rows();
            assert_eq!(rows.len(), BINDINGS.len());
            let action = |k: usize| if let Row::Action(binding) = rows[k] { Some(binding.action) } else { None };
            assert_eq!((action(0), action(rows.len() - 1)), (Some(first), Some(last)), "{screen:?}");
        };
        check(Screen::Jobs, Action::Open, Action::Write);
        check(Screen::Sql, Action::EditQuery, Action::Lower);
    }

    #[test]
    fn the_filter_line_edits_and_gives_back() {
        let (mut line, mut filter) = (Overlay::Filter("old".into()), String::new());
        typed(&mut line, &mut filter, "tee fem");
        line.key(&KeyEvent::new(KeyCode::Char('w'), KeyModifiers::CONTROL), &mut filter);
        assert_eq!(filter, "tee ");
        assert_eq!(line.key(&press(KeyCode::Esc), &mut filter), Outcome::Closed);
        assert_eq!(filter, "old");
    }

    #[test]
    fn only_an_answer_is_one() {
        let yes = Answer { key: 'y', label: "yes", effects: vec![Effect::Quit] };
        let other = Answer { key: 'l', label: "leave it", effects: vec![Effect::StopRun] };
        let question = || Overlay::Question { text: "?".into(), answers: vec![yes.clone(), other.clone()] };
        for code in [KeyCode::Enter, KeyCode::Esc, KeyCode::Char('n'), KeyCode::Char(' ')] {
            assert_eq!(question().key(&press(code), &mut String::new()), Outcome::Closed);
        }
        let yes = question().key(&press(KeyCode::Char('y')), &mut String::new());
        assert_eq!(yes, Outcome::Effects(vec![Effect::Quit]));
        let other = question().key(&press(KeyCode::Char('L')), &mut String::new());
        assert_eq!(other, Outcome::Effects(vec![Effect::StopRun]));
    }
}
