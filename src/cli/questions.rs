//! Questions of a proposal, asked one by one at the terminal.

use std::io::{BufRead, IsTerminal, Write};

use super::CliError;
use super::output::printable;
use wardrobe::seams::{Proposed, Question};

/// Asks the questions that have choices but no answer yet, in order, until none is left. An empty line takes the marked
/// answer.
pub fn ask(
    mut answers: Vec<(usize, char)>,
    proposed: impl Fn(&[(usize, char)]) -> Result<Proposed, CliError>,
) -> Result<Proposed, CliError> {
    if !std::io::stdin().is_terminal() || !std::io::stderr().is_terminal() {
        return Err(CliError::Usage("--ask: found no terminal; accepted: --answer N=x for each question".to_owned()));
    }
    let mut lines = std::io::stdin().lock().lines();
    let mut passed: Vec<String> = Vec::new();
    loop {
        let proposal = proposed(&answers)?;
        let is_open = |question: &&Question| {
            !question.choices.is_empty() && !question.is_answered && !passed.contains(&question.text)
        };
        let Some(question) = proposal.proposal.questions.iter().find(is_open) else { return Ok(proposal) };
        let mut terminal = std::io::stderr().lock();
        writeln!(terminal, "{}. {}", question.number, printable(&question.text))?;
        for (index, choice) in question.choices.iter().enumerate() {
            let mark = if question.taken == Some(index) { "*" } else { " " };
            writeln!(terminal, " {mark}{}: {}", Question::letter(index), printable(choice))?;
        }
        let enter = if question.taken.is_some() { "takes *" } else { "leaves it open" };
        write!(terminal, "letter (Enter {enter}): ")?;
        terminal.flush()?;
        let Some(line) = lines.next().transpose()? else { return Ok(proposal) };
        let letter = line.trim().to_ascii_lowercase().chars().next();
        let known = |letter: &char| (0..question.choices.len()).any(|index| Question::letter(index) == *letter);
        match letter {
            None => passed.push(question.text.clone()),
            Some(letter) if known(&letter) => answers.push((question.number, letter)),
            Some(_) => {
                writeln!(terminal, "found `{}`; accepted: a letter of the list, or Enter", printable(line.trim()))?
            }
        }
    }
}
