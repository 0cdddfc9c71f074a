//! Choosing, adding, changing and closing comments of fittings; beginning and signing rounds.

use crate::keys::action::Action;
use crate::keys::screen::Screen;
use crate::messages::comments::{Change, CommentDeed, FittingOf, RoundRequest};
use crate::messages::effect::Effect;
use crate::messages::requests::Command;
use crate::overlays::Overlay;
use crate::overlays::comment_form::CommentForm;
use crate::overlays::path_prompt::{PathPrompt, Purpose};
use crate::screens::fit::actions::{passes, wearer};
use crate::screens::fit::state::{Comments, FitScreen, View};
use crate::screens::movement::Movement;
use crate::screens::state::State;
use store::comments::{Comment, Edit, Round, State as Status};

impl Comments {
    /// Listed comments that pass the filter: of the shown fitting or of all, without those that an earlier round met.
    pub fn shown<'a>(&self, state: &'a State) -> Vec<&'a Comment> {
        let mut shown = self.in_scope(state);
        shown.retain(|one| {
            let last = last_round(state, &one.garment, &one.subject).map_or(0, |last| last.round);
            let is_old = one.status == Status::Met && one.met_in.is_some_and(|met_in| met_in < last);
            !is_old && passes(state, &words(one))
        });
        shown
    }

    /// Comments of the shown fitting, or of all fittings of the study.
    pub fn in_scope<'a>(&self, state: &'a State) -> Vec<&'a Comment> {
        let Some((data, grid)) = state.data.as_ref().zip(state.grid()) else { return vec![] };
        let is_own = |one: &&Comment| one.garment == grid.garment && Some(&one.subject) == wearer(state);
        data.comments.iter().filter(|one| self.is_whole || is_own(one)).collect()
    }

    pub fn index_in(&self, shown: &[&Comment]) -> usize {
        shown.iter().position(|one| Some(&key(one)) == self.chosen.as_ref()).unwrap_or(0)
    }

    pub fn selected<'a>(&self, state: &'a State) -> Option<&'a Comment> {
        let shown = self.shown(state);
        shown.get(self.index_in(&shown)).copied()
    }

    pub fn go(&mut self, state: &State, movement: Movement) {
        let shown = self.shown(state);
        self.chosen = shown.get(movement.from(self.index_in(&shown), shown.len())).map(|one| key(one));
    }

    /// Fitting that actions are on: that of the selected comment among those of the study, else the shown one.
    pub fn fitting(&self, state: &State) -> Option<FittingOf> {
        let study = state.study()?.name.clone();
        let selected = self.selected(state).filter(|_| self.is_whole);
        let (garment, subject) = match selected {
            Some(one) => (one.garment.clone(), one.subject.clone()),
            None => (state.grid()?.garment.clone(), wearer(state)?.clone()),
        };
        Some(FittingOf { study, garment, subject })
    }

    /// Keeps a change, so that it can be taken back.
    pub fn changed(&mut self, of: FittingOf, change: Change) {
        if change.before.is_some() {
            self.changes.push((of, change));
        }
    }

    fn to_change<'a>(&self, state: &'a State) -> Result<(FittingOf, &'a Comment), &'static str> {
        self.fitting(state).zip(self.selected(state)).ok_or("no comment is selected")
    }

    fn edit(&self, state: &mut State) -> Vec<Effect> {
        match self.to_change(state) {
            Ok((of, comment)) => {
                let form = CommentForm::of(of, comment);
                state.overlay = Some(Overlay::CommentForm(Box::new(form)));
                vec![]
            }
            Err(why_not) => state.reply(why_not),
        }
    }

    /// Opens the form of a new comment, which needs a round.
    fn add(&self, state: &mut State) -> Vec<Effect> {
        match self.fitting(state) {
            Some(of) if round_of(state, &of).is_some() => {
                state.overlay = Some(Overlay::CommentForm(Box::new(CommentForm::new(of))));
                vec![]
            }
            _ => state.reply("there is no round yet: b begins one"),
        }
    }

    fn close(&self, state: &mut State) -> Vec<Effect> {
        match self.to_change(state) {
            Ok((of, comment)) => {
                let status = if comment.status == Status::Open { Status::Closed } else { Status::Open };
                let edit = Edit { status: Some(status), ..Edit::default() };
                vec![Effect::Do(Command::Comment(of, CommentDeed::Set(Box::new(Change::of(comment, edit)))))]
            }
            Err(why_not) => state.reply(why_not),
        }
    }

    fn undo(&mut self, state: &mut State) -> Vec<Effect> {
        let Some((of, change)) = self.changes.pop() else { return state.reply("no comment was changed here") };
        let back = Change { number: change.number, edit: change.before.unwrap_or_default(), before: None };
        vec![Effect::Do(Command::Comment(of, CommentDeed::Set(Box::new(back))))]
    }

    fn sign(&self, state: &mut State) -> Vec<Effect> {
        match self.fitting(state) {
            Some(of) if round_of(state, &of).is_some() => {
                state.overlay = Some(Overlay::Path(PathPrompt::new(Purpose::Sign(of), "")));
                vec![]
            }
            _ => state.reply("there is no round to sign yet: b begins one"),
        }
    }

    /// Begins the next round, after a question.
    fn begin(&self, state: &mut State) -> Vec<Effect> {
        let Some((of, study)) = self.fitting(state).zip(state.study().map(|study| study.path.clone())) else {
            return state.reply("there is no fitting yet");
        };
        let round = round_of(state, &of).map_or(1, |last| last.round + 1);
        let FittingOf { garment, subject, .. } = &of;
        let text = format!(
            "Begin round {round} of {garment} on {subject}? What was measured is commented, and comments that are \
             measured no more are met. It cannot be taken back."
        );
        state.ask(text, vec![Effect::Round(RoundRequest { study, of })]);
        vec![]
    }

    /// Listed comments as text, separated by tabs.
    pub fn table(&self, state: &State) -> Option<String> {
        let shown = self.shown(state);
        let mut table = "garment\tsubject\tsize\tround\tno\tside\tplace\tcomment\tseverity\tcause\taction\towner\t\
                         status\n"
            .to_owned();
        for one in &shown {
            let (round, number, remark) = (one.round.to_string(), one.number.to_string(), &one.remark);
            let cells = [
                &one.garment,
                &one.subject,
                &one.size,
                &round,
                &number,
                remark.side.as_str(),
                &remark.place,
                &remark.said,
                remark.severity.as_str(),
                &remark.cause,
                &remark.action,
                &one.owner,
                &status(one),
            ];
            table += &(cells.join("\t") + "\n");
        }
        (!shown.is_empty()).then_some(table)
    }
}

impl FitScreen {
    /// Returns `None` for an action that is not about comments.
    pub fn act_on_comments(&mut self, state: &mut State, action: Action) -> Option<Vec<Effect>> {
        let changes = [
            Action::EditComment,
            Action::AddComment,
            Action::CloseComment,
            Action::UndoComment,
            Action::BeginRound,
            Action::SignRound,
        ];
        if action == Action::Comments {
            state.show(Screen::Fit);
            (self.view, self.alter.is_open) = (View::Comments, false);
            return Some(vec![]);
        }
        if action != Action::AllComments && !changes.contains(&action) {
            return None;
        }
        if state.nav.screen != Screen::Fit || self.view != View::Comments || self.alter.is_open {
            return Some(state.reply("the comments are not shown: m on screen 0 shows them"));
        }
        if changes.contains(&action) && !state.setup.abilities.run {
            state.complain("this workbench is read-only: start it without --readonly to change comments");
            return Some(vec![]);
        }
        let comments = &mut self.comments;
        Some(match action {
            Action::EditComment => comments.edit(state),
            Action::AddComment => comments.add(state),
            Action::CloseComment => comments.close(state),
            Action::UndoComment => comments.undo(state),
            Action::BeginRound => comments.begin(state),
            Action::SignRound => comments.sign(state),
            _ => {
                comments.is_whole = !comments.is_whole;
                vec![]
            }
        })
    }
}

fn key(one: &Comment) -> (String, String, i64) {
    (one.garment.clone(), one.subject.clone(), one.number)
}

pub fn last_round<'a>(state: &'a State, garment: &str, subject: &str) -> Option<&'a Round> {
    state.data.as_ref()?.rounds.iter().find(|round| round.garment == garment && round.subject == subject)
}

fn round_of<'a>(state: &'a State, of: &FittingOf) -> Option<&'a Round> {
    last_round(state, &of.garment, &of.subject)
}

pub fn status(one: &Comment) -> String {
    match (one.status, one.met_in) {
        (Status::Met, Some(round)) => format!("met in {round}"),
        (status, _) => status.as_str().to_owned(),
    }
}

/// Words that a filter searches.
fn words(one: &Comment) -> String {
    let remark = &one.remark;
    let (severity, side) = (remark.severity.as_str(), remark.side.as_str());
    let seen = format!("{} {} {severity} {side} {}", one.garment, one.subject, remark.place);
    format!("{seen} {} {} {} {} {}", remark.said, remark.cause, remark.action, one.owner, status(one))
}
