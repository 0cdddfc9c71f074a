//! Questions to the user about what could not be determined, with their possible answers and the answers given.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt;

#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize)]
pub struct Question {
    pub number: usize,
    pub text: String,
    /// Likeliest first. Empty if only an edit of the seam file can settle the question.
    pub choices: Vec<String>,
    /// Index of the choice in effect: the user's answer, or else the default. `None` without either.
    pub taken: Option<usize>,
    pub is_answered: bool,
    /// Edges, `PIECE.EDGE` of the proposal.
    pub about: Vec<String>,
}

#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("answer {number}={letter}: accepted: {accepted}")]
pub struct UnknownAnswer {
    pub number: usize,
    pub letter: char,
    pub accepted: String,
}

/// Numbers questions in the order in which they were first asked. `known` are the texts of all questions so far.
pub(super) fn number(questions: &mut [Question], known: &mut Vec<String>) {
    for question in questions.iter_mut() {
        let place = known.iter().position(|text| *text == question.text);
        question.number = 1 + place.unwrap_or_else(|| {
            known.push(question.text.clone());
            known.len() - 1
        });
    }
    questions.sort_by_key(|question| question.number);
}

/// Text of the question to index of the choice.
pub type Answers = BTreeMap<String, usize>;

impl Question {
    pub(super) fn told(text: String) -> Self {
        Self { number: 0, text, choices: Vec::new(), taken: None, is_answered: false, about: Vec::new() }
    }

    /// Parses a question as `Display` writes it.
    pub fn parse(written: &str) -> Self {
        let mut question = Self::parse_choices(written);
        let edges = question.text.strip_suffix(']').and_then(|text| text.rsplit_once(" ["));
        let is_edge = |name: &&str| name.contains('.') && !name.contains([' ', '`']);
        if let Some((text, edges)) = edges
            && edges.split(", ").all(|name| is_edge(&name))
        {
            question.about = edges.split(", ").map(str::to_owned).collect();
            question.text = text.to_owned();
        }
        question
    }

    /// Parses a question whose text still has its edges.
    fn parse_choices(written: &str) -> Self {
        let mut question = Self::told(written.to_owned());
        let Some((text, mut rest)) = written.split_once(" a: ") else { return question };
        let taken = [(" (answered: ", ")"), (" (", " is taken)")].into_iter().find_map(|(before, after)| {
            let (choices, letter) = rest.strip_suffix(after)?.rsplit_once(before)?;
            let [letter] = letter.as_bytes() else { return None };
            Some((choices, usize::from(letter.checked_sub(b'a')?), before.contains("answered")))
        });
        if let Some((choices, choice, is_answered)) = taken {
            (rest, question.taken, question.is_answered) = (choices, Some(choice), is_answered);
        }
        text.clone_into(&mut question.text);
        let mark = |index: usize| format!("; {}: ", Self::letter(index));
        while let Some((choice, others)) = rest.split_once(&mark(question.choices.len() + 1)) {
            question.choices.push(choice.to_owned());
            rest = others;
        }
        question.choices.push(rest.to_owned());
        question
    }

    pub fn letter(choice: usize) -> char {
        u8::try_from(choice).ok().filter(|&choice| choice < 26).map_or('?', |choice| (b'a' + choice) as char)
    }
}

impl fmt::Display for Question {
    /// Writes the question with its edges and choices: `which is it? [front.hem] a: the right one; b: the left one (a is
    /// taken)`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)?;
        if !self.about.is_empty() {
            write!(f, " [{}]", self.about.join(", "))?;
        }
        for (index, choice) in self.choices.iter().enumerate() {
            let mark = if index == 0 { "" } else { ";" };
            write!(f, "{mark} {}: {choice}", Self::letter(index))?;
        }
        match self.taken {
            Some(taken) if self.is_answered => write!(f, " (answered: {})", Self::letter(taken)),
            Some(taken) => write!(f, " ({} is taken)", Self::letter(taken)),
            None => Ok(()),
        }
    }
}

/// Answer that dismisses the pieces of a question: they are nothing that is draped.
const NONE_OF_THESE: &str = "none of these: left out";

pub(super) struct Asker<'a> {
    answers: &'a Answers,
    asked: Vec<Question>,
    dismissed: BTreeSet<usize>,
    dismissing: BTreeSet<usize>,
    /// Questions without an answer of which the drape cannot do without.
    unsettled: Vec<String>,
}

pub(super) struct Asked {
    pub questions: Vec<Question>,
    /// Pieces that the user dismisses, and has not before.
    pub dismissing: BTreeSet<usize>,
    /// Texts of the questions that are to be answered before anything is draped.
    pub unsettled: Vec<String>,
}

impl<'a> Asker<'a> {
    pub fn new(answers: &'a Answers, dismissed: BTreeSet<usize>) -> Self {
        Self { answers, asked: Vec::new(), dismissed, dismissing: BTreeSet::new(), unsettled: Vec::new() }
    }

    /// Makes an asker with the same answers, for a trial whose questions are discarded.
    pub fn aside(&self) -> Self {
        Self::new(self.answers, self.dismissed.clone())
    }

    pub fn is_dismissed(&self, piece: usize) -> bool {
        self.dismissed.contains(&piece)
    }

    pub fn is_answered(&self, text: &str) -> bool {
        self.answers.contains_key(text)
    }

    pub fn into_asked(self) -> Asked {
        Asked { questions: self.asked, dismissing: self.dismissing, unsettled: self.unsettled }
    }

    pub fn tell(&mut self, text: String) {
        self.keep(Question::told(text));
    }

    /// Collects a question, once if it is asked for the right and the left side: then it is about the edges of both.
    fn keep(&mut self, question: Question) {
        match self.asked.iter_mut().find(|asked| asked.text == question.text) {
            Some(asked) => {
                let new = question.about.into_iter().filter(|edge| !asked.about.contains(edge)).collect::<Vec<_>>();
                asked.about.extend(new);
            }
            None => self.asked.push(question),
        }
    }

    /// Returns the choice of the user, or without an answer the default `stands`.
    pub fn ask<S: Into<String>>(
        &mut self,
        text: String,
        choices: impl IntoIterator<Item = S>,
        stands: Option<usize>,
    ) -> Option<usize> {
        self.ask_at(Vec::new(), text, choices, stands)
    }

    /// Asks a question about some edges, `PIECE.EDGE`, as [`Asker::ask`] does.
    pub fn ask_at<S: Into<String>>(
        &mut self,
        about: Vec<String>,
        text: String,
        choices: impl IntoIterator<Item = S>,
        stands: Option<usize>,
    ) -> Option<usize> {
        let choices: Vec<String> = choices.into_iter().map(Into::into).collect();
        let answer = self.answers.get(&text).copied().filter(|&answer| answer < choices.len());
        let taken = answer.or(stands);
        self.keep(Question { number: 0, text, choices, taken, is_answered: answer.is_some(), about });
        taken
    }

    /// Asks a question about what some pieces are, as [`Asker::ask`] does. The user may also dismiss them: then the
    /// default stands until the proposal is made without them.
    pub fn ask_of<S: Into<String>>(
        &mut self,
        pieces: impl IntoIterator<Item = usize>,
        text: String,
        choices: impl IntoIterator<Item = S>,
        stands: Option<usize>,
    ) -> Option<usize> {
        let mut choices: Vec<String> = choices.into_iter().map(Into::into).collect();
        choices.push(NONE_OF_THESE.to_owned());
        let none = choices.len() - 1;
        let taken = self.ask(text, choices, stands);
        if taken == Some(none) {
            self.dismissing.extend(pieces);
            return stands;
        }
        taken
    }

    /// Asks a question as [`Asker::ask`] does, to be answered before anything is draped.
    pub fn ask_first<S: Into<String>>(
        &mut self,
        text: String,
        choices: impl IntoIterator<Item = S>,
        stands: Option<usize>,
    ) -> Option<usize> {
        self.require(&text);
        self.ask(text, choices, stands)
    }

    /// Marks a question as one to be answered before anything is draped.
    pub fn require(&mut self, text: &str) {
        if !self.is_answered(text) {
            self.unsettled.push(text.to_owned());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_question_for_both_sides_is_about_the_edges_of_both() {
        let answers = Answers::new();
        let mut asker = Asker::new(&answers, BTreeSet::new());
        for hand in ["right", "left", "right"] {
            asker.ask_at(vec![format!("sleeve_{hand}.underarm")], "which?".to_owned(), ["one", "other"], Some(0));
        }
        let asked = asker.into_asked().questions;
        assert_eq!(asked.len(), 1);
        assert_eq!(asked[0].about, ["sleeve_right.underarm", "sleeve_left.underarm"]);
    }

    #[test]
    fn a_question_is_read_as_it_is_written() {
        let check = |text: &str, choices: &[&str], taken: Option<usize>, is_answered: bool| {
            for about in [&[][..], &["front.hem"], &["sleeve_back_right.underarm", "sleeve_front_right.underarm"]] {
                let [choices, about] = [choices, about].map(|all| all.iter().map(|&one| one.to_owned()).collect());
                let question = Question { number: 0, text: text.to_owned(), choices, taken, is_answered, about };
                assert_eq!(Question::parse(&question.to_string()), question);
            }
        };
        check("is it a seam?", &["a seam or a fold", "an opening (a slit); or both"], Some(1), false);
        check("which piece is the sleeve?", &["STYLE SS", "STYLE SS1"], Some(0), true);
        check("where does `waistband` open?", &[], None, false);
        check("does it hold for [SIZE 38]", &[], None, false);
        check("which (of these) is it?", &["one"], None, false);
    }
}
