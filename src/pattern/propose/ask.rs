//! Questions to the person who sews: what could not be told, what may be answered, and what they answered.

use std::collections::BTreeMap;
use std::fmt;

/// What a person must decide.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize)]
pub struct Question {
    /// Number by which it is answered.
    pub number: usize,
    /// The question in words.
    pub text: String,
    /// What may be answered, the likeliest first; empty where only an edit of the seam file helps.
    pub choices: Vec<String>,
    /// The choice that is taken: the person's, or the one that stands while nobody answers.
    pub taken: Option<usize>,
    /// Whether a person answered.
    pub is_answered: bool,
}

/// An answer to nothing that is asked.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("answer {number}={letter}: accepted: {accepted}")]
pub struct UnknownAnswer {
    /// Number of the question.
    pub number: usize,
    /// Letter of the choice.
    pub letter: char,
    /// What would be accepted.
    pub accepted: String,
}

/// Numbers questions in the order in which they were first asked; `known` are the texts of those asked so far.
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

/// Answers by the text of their question: the index of the choice.
pub type Answers = BTreeMap<String, usize>;

impl Question {
    /// What has no choices.
    pub(super) fn told(text: String) -> Self {
        Self { number: 0, text, choices: Vec::new(), taken: None, is_answered: false }
    }

    /// A question as it is written: the reverse of its text form.
    #[must_use]
    pub fn parse(written: &str) -> Self {
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

    /// Letter of a choice.
    #[must_use]
    pub fn letter(choice: usize) -> char {
        u8::try_from(choice).ok().filter(|&choice| choice < 26).map_or('?', |choice| (b'a' + choice) as char)
    }
}

impl fmt::Display for Question {
    /// The question with its choices: `which is it? a: the right one; b: the left one (a is taken)`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)?;
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

/// Asks questions: looks up what was answered, and keeps what was asked.
pub(super) struct Asker<'a> {
    answers: &'a Answers,
    asked: Vec<Question>,
}

impl<'a> Asker<'a> {
    /// With the answers there are.
    pub fn new(answers: &'a Answers) -> Self {
        Self { answers, asked: Vec::new() }
    }

    /// One that knows the same answers, for a trial whose questions nobody hears.
    pub fn aside(&self) -> Self {
        Self::new(self.answers)
    }

    /// Whether a person has answered a question.
    pub fn is_answered(&self, text: &str) -> bool {
        self.answers.contains_key(text)
    }

    /// All questions that were asked, in order.
    pub fn into_questions(self) -> Vec<Question> {
        self.asked
    }

    /// Asks what has no choices.
    pub fn tell(&mut self, text: String) {
        self.keep(Question::told(text));
    }

    /// Keeps a question; what is asked of both sides of the wearer alike is asked once.
    fn keep(&mut self, question: Question) {
        if !self.asked.iter().any(|asked| asked.text == question.text) {
            self.asked.push(question);
        }
    }

    /// The choice of a person, or else the one that stands while nobody answers.
    pub fn ask<S: Into<String>>(
        &mut self,
        text: String,
        choices: impl IntoIterator<Item = S>,
        stands: Option<usize>,
    ) -> Option<usize> {
        let choices: Vec<String> = choices.into_iter().map(Into::into).collect();
        let answer = self.answers.get(&text).copied().filter(|&answer| answer < choices.len());
        let taken = answer.or(stands);
        self.keep(Question { number: 0, text, choices, taken, is_answered: answer.is_some() });
        taken
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_question_is_read_as_it_is_written() {
        let check = |text: &str, choices: &[&str], taken: Option<usize>, is_answered: bool| {
            let choices = choices.iter().map(|&choice| choice.to_owned()).collect();
            let question = Question { number: 0, text: text.to_owned(), choices, taken, is_answered };
            assert_eq!(Question::parse(&question.to_string()), question);
        };
        check("is it a seam?", &["a seam or a fold", "an opening (a slit); or both"], Some(1), false);
        check("which piece is the sleeve?", &["STYLE SS", "STYLE SS1"], Some(0), true);
        check("where does `waistband` open?", &[], None, false);
        check("which (of these) is it?", &["one"], None, false);
    }
}
