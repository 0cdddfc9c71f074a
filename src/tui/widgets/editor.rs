//! Editor of a text of several lines, with the keys of readline or vim (`vim`), and completion of the word before its
//! cursor.

use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};

use store::Relation;

/// SQL words that are offered besides names.
const WORDS: [&str; 24] = [
    "SELECT",
    "FROM",
    "WHERE",
    "JOIN",
    "LEFT JOIN",
    "USING",
    "GROUP BY",
    "ORDER BY",
    "HAVING",
    "LIMIT",
    "DISTINCT",
    "AND",
    "BETWEEN",
    "LIKE",
    "IS NOT NULL",
    "DESC",
    "WITH",
    "CASE",
    "count(*)",
    "avg(",
    "median(",
    "quantile(",
    "stddev(",
    "round(",
];

/// Most edits that can be undone.
const REMEMBERED: usize = 100;

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Editing {
    /// Readline's keys: letters are typed, keys with Ctrl and Alt move and cut.
    #[default]
    Readline,
    Vim,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Mode {
    #[default]
    Insert,
    Normal,
}

#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Editor {
    text: String,
    /// Position of the cursor: a byte of `text` between characters.
    pub(super) cursor: usize,
    editing: Editing,
    pub(super) mode: Mode,
    /// Vim's operator that waits for a motion.
    pub(super) pending: Option<char>,
    /// Text that was cut or copied last; whole lines end with a line feed.
    pub(super) killed: String,
    /// Texts and cursors before the latest edits in normal mode.
    before_edits: Vec<(String, usize)>,
    offer: Option<Offer>,
}

/// Possible completions of the word before the cursor.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Offer {
    /// Byte at which the word begins.
    start: usize,
    pub words: Vec<String>,
    /// Index of the word that is in the text; `None` while words are only offered.
    pub taken: Option<usize>,
}

impl Editor {
    pub fn text(&self) -> &str {
        &self.text
    }

    pub fn offer(&self) -> Option<&Offer> {
        self.offer.as_ref()
    }

    pub fn decline(&mut self) {
        self.offer = None;
    }

    /// Replaces the text; the cursor is at its end.
    pub fn set(&mut self, text: &str) {
        let Self { editing, killed, .. } = std::mem::take(self);
        *self = Self { text: text.to_owned(), cursor: text.len(), editing, killed, ..Self::default() };
    }

    pub fn edit_as(&mut self, editing: Editing) {
        self.editing = editing;
    }

    /// Returns `None` for readline, where the meaning of letters does not change.
    pub fn mode(&self) -> Option<Mode> {
        (self.editing == Editing::Vim).then_some(self.mode)
    }

    /// Line and column of the cursor, in characters from 0.
    pub fn place(&self) -> (usize, usize) {
        let before = &self.text[..self.cursor];
        let line = before.matches('\n').count();
        (line, before[self.line_start()..].chars().count())
    }

    pub(super) fn line_start(&self) -> usize {
        self.text[..self.cursor].rfind('\n').map_or(0, |at| at + 1)
    }

    pub(super) fn line_end(&self) -> usize {
        self.text[self.cursor..].find('\n').map_or(self.text.len(), |at| self.cursor + at)
    }

    /// Handles a key. Returns false if the editor does not know the key.
    pub fn key(&mut self, event: &KeyEvent, relations: &[Relation]) -> bool {
        let [ctrl, alt] = [KeyModifiers::CONTROL, KeyModifiers::ALT].map(|modifier| event.modifiers.contains(modifier));
        match event.code {
            KeyCode::Tab if self.offer.is_some() => self.take_word(1),
            KeyCode::BackTab if self.offer.is_some() => self.take_word(-1),
            KeyCode::Esc if self.mode() == Some(Mode::Insert) => {
                self.offer = None;
                self.end_insert();
            }
            KeyCode::Char(letter) if self.mode == Mode::Normal && !ctrl && !alt => return self.command(letter),
            KeyCode::Enter if self.mode == Mode::Normal && !alt => self.go_to_line(1),
            code => {
                let is_taken = if alt { self.edit_words(code) } else { self.edit(code, ctrl) };
                if !is_taken {
                    return false;
                }
                self.offer = self.offered(relations);
            }
        }
        true
    }

    /// Handles readline's keys with Alt.
    fn edit_words(&mut self, code: KeyCode) -> bool {
        match code {
            KeyCode::Char('b') => self.cursor = self.word_start(),
            KeyCode::Char('f') => self.cursor = self.after_word(),
            KeyCode::Char('d') => self.kill(self.cursor, self.after_word()),
            _ => return false,
        }
        true
    }

    fn edit(&mut self, code: KeyCode, ctrl: bool) -> bool {
        match code {
            KeyCode::Char('a') if ctrl => self.cursor = self.line_start(),
            KeyCode::Char('e') if ctrl => self.cursor = self.line_end(),
            KeyCode::Char('k') if ctrl => {
                // At the end of a line, removes the line feed.
                let end = if self.cursor == self.line_end() { self.after() } else { self.line_end() };
                self.kill(self.cursor, end);
            }
            KeyCode::Char('u') if ctrl => self.kill(self.line_start(), self.cursor),
            KeyCode::Char('w') if ctrl => self.kill(self.word_start(), self.cursor),
            KeyCode::Char('y') if ctrl => self.insert(&self.killed.clone()),
            KeyCode::Char(_) if ctrl => return false,
            KeyCode::Char(letter) => self.insert(letter.encode_utf8(&mut [0; 4])),
            KeyCode::Enter => self.insert("\n"),
            KeyCode::Backspace => self.cut(self.before(), self.cursor),
            KeyCode::Delete => self.cut(self.cursor, self.after()),
            KeyCode::Left if ctrl => self.cursor = self.word_start(),
            KeyCode::Right if ctrl => self.cursor = self.after_word(),
            KeyCode::Left => self.cursor = self.before(),
            KeyCode::Right => self.cursor = self.after(),
            KeyCode::Home => self.cursor = self.line_start(),
            KeyCode::End => self.cursor = self.line_end(),
            KeyCode::Up => self.go_to_line(-1),
            KeyCode::Down => self.go_to_line(1),
            _ => return false,
        }
        true
    }

    pub(super) fn insert(&mut self, text: &str) {
        self.text.insert_str(self.cursor, text);
        self.cursor += text.len();
    }

    /// Cuts the text between two positions and keeps it for pasting.
    fn kill(&mut self, from: usize, to: usize) {
        self.killed = self.text[from..to].to_owned();
        self.cut(from, to);
    }

    /// Removes the text between two positions, and moves the cursor there.
    pub(super) fn cut(&mut self, from: usize, to: usize) {
        self.text.replace_range(from..to, "");
        self.cursor = from;
    }

    pub(super) fn remember(&mut self) {
        self.before_edits.push((self.text.clone(), self.cursor));
        let surplus = self.before_edits.len().saturating_sub(REMEMBERED);
        self.before_edits.drain(..surplus);
    }

    pub(super) fn undo(&mut self) {
        if let Some((text, cursor)) = self.before_edits.pop() {
            (self.text, self.cursor) = (text, cursor);
        }
    }

    pub(super) fn before(&self) -> usize {
        self.text[..self.cursor].char_indices().next_back().map_or(0, |(at, _)| at)
    }

    pub(super) fn after(&self) -> usize {
        self.letter_after(self.cursor)
    }

    pub(super) fn letter_after(&self, at: usize) -> usize {
        at + self.text[at..].chars().next().map_or(0, char::len_utf8)
    }

    /// Byte at which the next word or sign begins.
    pub(super) fn next_word(&self) -> usize {
        let kind = self.text[self.cursor..].chars().next().map(is_of_word);
        let rest = |from: usize, is_passed: &dyn Fn(char) -> bool| {
            self.text[from..].find(|c: char| !is_passed(c)).map_or(self.text.len(), |at| from + at)
        };
        let end = rest(self.cursor, &|c| !c.is_whitespace() && Some(is_of_word(c)) == kind);
        rest(end, &char::is_whitespace)
    }

    /// Position of the last letter of the word that ends after the cursor.
    pub(super) fn word_end(&self) -> usize {
        let end = |c: char, next: Option<char>| {
            !c.is_whitespace() && next.is_none_or(|next| next.is_whitespace() || is_of_word(next) != is_of_word(c))
        };
        let letters = || self.text[self.after()..].char_indices();
        let next = letters().skip(1).map(|(_, c)| Some(c)).chain([None]);
        letters().zip(next).find(|((_, c), next)| end(*c, *next)).map_or(self.cursor, |((at, _), _)| self.after() + at)
    }

    /// Position after the word that ends after the cursor.
    fn after_word(&self) -> usize {
        let start = self.text[self.cursor..].find(is_of_word).map_or(self.text.len(), |at| self.cursor + at);
        self.text[start..].find(|c| !is_of_word(c)).map_or(self.text.len(), |at| start + at)
    }

    /// Byte at which the word before the cursor begins, without blanks after the word.
    pub(super) fn word_start(&self) -> usize {
        let trimmed = self.text[..self.cursor].trim_end();
        trimmed.rfind(|c: char| !is_of_word(c)).map_or(0, |at| {
            let after = at + trimmed[at..].chars().next().map_or(1, char::len_utf8);
            if after == trimmed.len() { at } else { after }
        })
    }

    pub(super) fn go_to_line(&mut self, step: isize) {
        let (line, column) = self.place();
        let starts: Vec<usize> =
            std::iter::once(0).chain(self.text.match_indices('\n').map(|(at, _)| at + 1)).collect();
        let Some(start) = line.checked_add_signed(step).and_then(|line| starts.get(line)) else {
            self.cursor = if step < 0 { 0 } else { self.text.len() };
            return;
        };
        self.cursor = *start;
        let end = self.line_end();
        self.cursor = self.text[*start..end].char_indices().nth(column).map_or(end, |(at, _)| start + at);
    }

    fn take_word(&mut self, step: isize) {
        let Some(offer) = &mut self.offer else { return };
        let last = offer.words.len() as isize;
        let next = offer.taken.map_or(if step > 0 { 0 } else { last - 1 }, |at| (at as isize + step).rem_euclid(last));
        offer.taken = Some(next as usize);
        let word = &offer.words[next as usize];
        self.text.replace_range(offer.start..self.cursor, word);
        self.cursor = offer.start + word.len();
    }

    /// Completions of the word before the cursor: columns of the views in the text, names of views and tables, SQL
    /// words, other columns. After `view.` only columns of that view.
    fn offered(&self, relations: &[Relation]) -> Option<Offer> {
        let before = &self.text[..self.cursor];
        let start = before
            .rfind(|c: char| !is_of_word(c))
            .map_or(0, |at| at + before[at..].chars().next().map_or(1, char::len_utf8));
        let prefix = before[start..].to_lowercase();
        let owner = before[..start]
            .strip_suffix('.')
            .map(|rest| rest.rsplit(|c: char| !is_of_word(c)).next().unwrap_or_default());
        if prefix.is_empty() && owner.is_none() {
            return None;
        }
        let named = self.named(relations);
        let columns = |relations: &[&Relation]| relations.iter().flat_map(|r| r.columns.clone()).collect::<Vec<_>>();
        let mut words = match owner {
            Some(owner) => columns(&self.owned(owner, relations).into_iter().collect::<Vec<_>>()),
            None => {
                let names = relations.iter().map(|relation| relation.name.clone());
                let sql = WORDS.iter().map(|word| (*word).to_owned());
                let others = columns(&relations.iter().collect::<Vec<_>>());
                columns(&named).into_iter().chain(names).chain(sql).chain(others).collect()
            }
        };
        let mut seen = std::collections::BTreeSet::new();
        words.retain(|word| {
            let lower = word.to_lowercase();
            lower.starts_with(&prefix) && lower != prefix && seen.insert(lower)
        });
        (!words.is_empty()).then_some(Offer { start, words, taken: None })
    }

    /// Views and tables whose names are in the text.
    fn named<'a>(&self, relations: &'a [Relation]) -> Vec<&'a Relation> {
        let words: Vec<&str> = self.text.split(|c: char| !is_of_word(c)).collect();
        relations.iter().filter(|relation| words.iter().any(|word| relation.name.eq_ignore_ascii_case(word))).collect()
    }

    /// View or table with a name: its own, or an alias with or without `AS`.
    fn owned<'a>(&self, name: &str, relations: &'a [Relation]) -> Option<&'a Relation> {
        let of_name = |name: &str| relations.iter().find(|relation| relation.name.eq_ignore_ascii_case(name));
        let words: Vec<&str> = self.text.split(|c: char| !is_of_word(c)).filter(|word| !word.is_empty()).collect();
        let alias = words.iter().enumerate().find_map(|(k, word)| {
            let after = words.get(k + 1)?;
            let alias = if after.eq_ignore_ascii_case("as") { words.get(k + 2)? } else { after };
            of_name(word).filter(|_| alias.eq_ignore_ascii_case(name))
        });
        of_name(name).or(alias)
    }
}

fn is_of_word(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}

#[cfg(test)]
mod tests {
    use super::*;

    fn relations() -> Vec<Relation> {
        let relation = |name: &str, columns: &[&str]| Relation {
            name: name.to_owned(),
            columns: columns.iter().map(|column| (*column).to_owned()).collect(),
        };
        vec![relation("v_chi", &["study", "chi", "l2d_mm"]), relation("v_jobs", &["study", "status", "job_id"])]
    }

    /// Editor after some keys: `|` is Tab, `<` Left, `^` Up, `~` Backspace.
    fn typed(keys: &str) -> Editor {
        let mut editor = Editor::default();
        for letter in keys.chars() {
            let code = match letter {
                '|' => KeyCode::Tab,
                '<' => KeyCode::Left,
                '^' => KeyCode::Up,
                '~' => KeyCode::Backspace,
                '\n' => KeyCode::Enter,
                other => KeyCode::Char(other),
            };
            editor.key(&KeyEvent::new(code, KeyModifiers::NONE), &relations());
        }
        editor
    }

    #[test]
    fn text_is_edited_anywhere() {
        let check = |keys: &str, text: &str, place| {
            let editor = typed(keys);
            assert_eq!((editor.text(), editor.place()), (text, place), "{keys}");
        };
        check("ac<b", "abc", (0, 2));
        check("äö<~", "ö", (0, 0));
        check("one\ntwo^x", "onex\ntwo", (0, 4));
        check("one\n\nthree^^2", "2one\n\nthree", (0, 1));
        check("~^<", "", (0, 0));
        let mut editor = typed("SELECT chi");
        editor.key(&KeyEvent::new(KeyCode::Char('w'), KeyModifiers::CONTROL), &[]);
        assert_eq!(editor.text(), "SELECT ");
        editor.key(&KeyEvent::new(KeyCode::Char('u'), KeyModifiers::CONTROL), &[]);
        assert_eq!(editor.text(), "");
    }

    #[test]
    fn the_keys_of_readline_move_cut_and_put_in() {
        let check = |keys: &str, text: &str, column: usize| {
            let mut editor = Editor::default();
            editor.set("SELECT chi, ei");
            for key in keys.split(' ') {
                let (modifier, letter) = key.split_once('-').expect("C-x or A-x");
                let modifier = if modifier == "C" { KeyModifiers::CONTROL } else { KeyModifiers::ALT };
                let letter = letter.chars().next().expect("a letter");
                assert!(editor.key(&KeyEvent::new(KeyCode::Char(letter), modifier), &[]), "{key}");
            }
            assert_eq!((editor.text(), editor.place()), (text, (0, column)), "{keys}");
        };
        check("C-a", "SELECT chi, ei", 0);
        check("C-a C-e", "SELECT chi, ei", 14);
        check("A-b A-b A-b", "SELECT chi, ei", 7);
        check("C-a A-f A-f", "SELECT chi, ei", 10);
        check("C-a A-d", " chi, ei", 0);
        check("A-b C-k", "SELECT chi, ", 12);
        check("C-w C-y C-y", "SELECT chi, eiei", 16);
        check("C-a A-d C-e C-y", " chi, eiSELECT", 14);
        check("C-u C-k", "", 0);
        check("C-u C-y", "SELECT chi, ei", 14);
    }

    #[test]
    fn words_are_completed_by_what_the_text_names() {
        let check = |keys: &str, text: &str| assert_eq!(typed(keys).text(), text, "{keys}");
        check("sel|", "SELECT");
        check("SELECT * FROM v_|", "SELECT * FROM v_chi");
        check("SELECT * FROM v_||", "SELECT * FROM v_jobs");
        check("SELECT * FROM v_|||", "SELECT * FROM v_chi");
        check("SELECT * FROM v_jobs WHERE st|", "SELECT * FROM v_jobs WHERE study");
        check("SELECT * FROM v_jobs WHERE sta|", "SELECT * FROM v_jobs WHERE status");
        check("SELECT * FROM v_chi AS c, v_jobs j WHERE j.|", "SELECT * FROM v_chi AS c, v_jobs j WHERE j.study");
        check("SELECT * FROM v_chi AS c WHERE c.l|", "SELECT * FROM v_chi AS c WHERE c.l2d_mm");
        assert!(typed("SELECT ").offer().is_none() && typed("zzz").offer().is_none());
    }
}
