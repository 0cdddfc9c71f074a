//! Vim's keys: a normal mode with motions, operators on motions, and one text that was cut or copied.

use crate::widgets::editor::{Editor, Mode};

impl Editor {
    /// Handles a letter in normal mode. Returns false if it is no command.
    pub(super) fn command(&mut self, letter: char) -> bool {
        if let Some(operator) = self.pending.take() {
            self.operate(operator, letter);
        } else {
            match letter {
                'd' | 'c' | 'y' => self.pending = Some(letter),
                'x' => self.operate('d', 'l'),
                'D' => self.operate('d', '$'),
                'C' => self.operate('c', '$'),
                'i' | 'a' | 'I' | 'A' | 'o' | 'O' => self.start_insert(letter),
                'p' => self.paste(),
                'u' => self.undo(),
                'j' => self.go_to_line(1),
                'k' => self.go_to_line(-1),
                '?' | ':' => return false,
                motion => self.cursor = self.target(motion).unwrap_or(self.cursor),
            }
        }
        if self.mode == Mode::Normal {
            self.stay_on_letter();
        }
        true
    }

    pub(super) fn end_insert(&mut self) {
        self.mode = Mode::Normal;
        self.cursor = self.before().max(self.line_start());
    }

    /// Moves the cursor back onto a letter: in normal mode it is never behind the last letter of a line.
    fn stay_on_letter(&mut self) {
        if self.cursor == self.line_end() {
            self.cursor = self.before().max(self.line_start());
        }
    }

    fn start_insert(&mut self, letter: char) {
        self.remember();
        self.mode = Mode::Insert;
        match letter {
            'a' => self.cursor = self.after().min(self.line_end()),
            'I' => self.cursor = self.line_start(),
            'A' => self.cursor = self.line_end(),
            'o' => {
                self.cursor = self.line_end();
                self.insert("\n");
            }
            'O' => {
                self.cursor = self.line_start();
                self.insert("\n");
                self.cursor = self.before();
            }
            _ => {}
        }
    }

    /// Byte to which a motion leads; `None` for a letter that is no motion.
    fn target(&self, motion: char) -> Option<usize> {
        Some(match motion {
            'h' => self.before().max(self.line_start()),
            'l' => self.after().min(self.line_end()),
            '0' => self.line_start(),
            '$' => self.line_end(),
            'w' => self.next_word(),
            'b' => self.word_start(),
            'e' => self.word_end(),
            'g' => 0,
            'G' => self.text().len(),
            _ => return None,
        })
    }

    /// Cuts, changes or copies the text of a motion; an operator typed twice takes the whole line.
    fn operate(&mut self, operator: char, motion: char) {
        let is_line = motion == operator;
        let (from, to) = if is_line {
            (self.line_start(), self.line_end())
        } else {
            // Changing a word keeps the blank after it.
            let motion = if operator == 'c' && motion == 'w' { 'e' } else { motion };
            let Some(target) = self.target(motion) else { return };
            let target = if motion == 'e' { self.letter_after(target) } else { target };
            (self.cursor.min(target), self.cursor.max(target))
        };
        self.killed = self.text()[from..to].to_owned() + if is_line { "\n" } else { "" };
        if operator == 'y' {
            self.cursor = if is_line { self.cursor } else { from };
            return;
        }
        self.remember();
        // Cutting a line takes one line feed with it.
        let (from, to) = match () {
            () if !is_line || operator == 'c' => (from, to),
            () if to < self.text().len() => (from, to + 1),
            () => (from.saturating_sub(1), to),
        };
        self.cut(from, to);
        if operator == 'c' {
            self.mode = Mode::Insert;
        } else if is_line {
            self.cursor = self.line_start();
        }
    }

    /// Pastes the text: whole lines below the present line, else after the letter.
    fn paste(&mut self) {
        self.remember();
        let text = self.killed.clone();
        match text.strip_suffix('\n') {
            Some(lines) => {
                self.cursor = self.line_end();
                let start = self.cursor + 1;
                self.insert(&format!("\n{lines}"));
                self.cursor = start;
            }
            None => {
                self.cursor = self.after().min(self.line_end());
                self.insert(&text);
                self.cursor = self.before();
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};

    use super::*;
    use crate::widgets::editor::Editing;

    /// Text after some keys, with the cursor as `|`; `^` is Esc.
    fn after(text: &str, keys: &str) -> String {
        let mut editor = Editor::default();
        editor.edit_as(Editing::Vim);
        editor.set(text);
        for letter in keys.chars() {
            let code = match letter {
                '^' => KeyCode::Esc,
                '\n' => KeyCode::Enter,
                letter => KeyCode::Char(letter),
            };
            editor.key(&KeyEvent::new(code, KeyModifiers::NONE), &[]);
        }
        let (line, column) = editor.place();
        let mut lines: Vec<String> = editor.text().split('\n').map(str::to_owned).collect();
        let at = lines[line].char_indices().nth(column).map_or(lines[line].len(), |(at, _)| at);
        lines[line].insert(at, '|');
        lines.join("\n")
    }

    #[test]
    fn motions_go_by_letters_words_and_lines() {
        let check = |keys: &str, expect: &str| assert_eq!(after("one two\nthree", keys), expect, "{keys}");
        check("^", "one two\nthre|e");
        check("^0", "one two\n|three");
        check("^k0", "|one two\nthree");
        check("^gw", "one |two\nthree");
        check("^gww", "one two\n|three");
        check("^ge", "on|e two\nthree");
        check("^gee", "one tw|o\nthree");
        check("^g$", "one tw|o\nthree");
        check("^gwb", "|one two\nthree");
        check("^ghl", "o|ne two\nthree");
        check("^g\n", "one two\n|three");
        check("^gG", "one two\nthre|e");
    }

    #[test]
    fn operators_cut_change_and_copy_what_a_motion_goes_over() {
        let check = |keys: &str, expect: &str| assert_eq!(after("one two\nthree", keys), expect, "{keys}");
        check("^gx", "|ne two\nthree");
        check("^gdw", "|two\nthree");
        check("^gwD", "one| \nthree");
        check("^gdd", "|three");
        check("^dd", "|one two");
        check("^gcwsix^", "si|x two\nthree");
        check("^gwCs^", "one |s\nthree");
        check("^gccx^", "|x\nthree");
        check("^gyyp", "one two\n|one two\nthree");
        check("^gyw$p", "one twoone| \nthree");
        check("^gde", "| two\nthree");
        check("^gwdb", "|two\nthree");
        check("^gdzx", "|ne two\nthree");
    }

    #[test]
    fn typing_begins_where_it_says_and_is_undone_at_once() {
        let check = |keys: &str, expect: &str| assert_eq!(after("ab\ncd", keys), expect, "{keys}");
        check("x", "ab\ncdx|");
        check("^gix^", "|xab\ncd");
        check("^gax^", "a|xb\ncd");
        check("^gIx^", "|xab\ncd");
        check("^gAx^", "ab|x\ncd");
        check("^gox^", "ab\n|x\ncd");
        check("^gOx^", "|x\nab\ncd");
        check("^gAxyz^u", "|ab\ncd");
        check("^gxxuu", "|ab\ncd");
        check("^u", "ab\nc|d");
    }
}
