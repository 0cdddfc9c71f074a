//! What a user can do, and how a key stands for it.

use std::fmt;

use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};

use study::Part;

/// A screen of the workbench; its number is its key.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Screen {
    /// The study as a grid of sizes by subjects.
    Study,
    /// The subjects of the catalogue.
    Subjects,
    /// The styles and sizes of the catalogue, and the seams of one.
    Styles,
    /// The queue.
    Jobs,
    /// One result: its measurements and its picture.
    Results,
    /// Several results side by side.
    Compare,
    /// Questions in SQL.
    Sql,
    /// Reports that were built.
    Reports,
    /// The fabrics of the catalogue.
    Fabrics,
}

impl Screen {
    /// All screens, in order of their numbers.
    pub const ALL: [Self; 9] = [
        Self::Study,
        Self::Subjects,
        Self::Styles,
        Self::Jobs,
        Self::Results,
        Self::Compare,
        Self::Sql,
        Self::Reports,
        Self::Fabrics,
    ];

    /// Name, and a short one for tabs with little room.
    #[must_use]
    pub fn names(self) -> [&'static str; 2] {
        match self {
            Self::Study => ["Study", "Study"],
            Self::Subjects => ["Subjects", "Subj"],
            Self::Styles => ["Styles", "Style"],
            Self::Jobs => ["Jobs", "Jobs"],
            Self::Results => ["Results", "Res"],
            Self::Compare => ["Compare", "Cmp"],
            Self::Sql => ["SQL", "SQL"],
            Self::Reports => ["Reports", "Rep"],
            Self::Fabrics => ["Fabrics", "Fab"],
        }
    }
}

/// Everything a key or the palette can ask for. Handled in one place, `State::act`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Action {
    /// Selects what is above.
    Up,
    /// Selects what is below.
    Down,
    /// Selects what is left; turns the picture when it has the focus.
    Left,
    /// Selects what is right; turns the picture when it has the focus.
    Right,
    /// Selects the first.
    First,
    /// Selects the last.
    Last,
    /// Goes up by a page.
    PageUp,
    /// Goes down by a page.
    PageDown,
    /// Gives the focus to the next pane.
    NextPane,
    /// Gives the focus to the pane before.
    PreviousPane,
    /// Shows a screen.
    Show(Screen),
    /// Opens what is selected.
    Open,
    /// Goes back, as far as there is anything to go back to.
    Back,
    /// Goes back; at the top, quits.
    Leave,
    /// Asks for text that rows must contain.
    Filter,
    /// Selects the next row or cell that matches the filter.
    NextMatch,
    /// Selects the one before.
    PreviousMatch,
    /// Sorts by the next column.
    Sort,
    /// Reverses the order.
    Reverse,
    /// Copies what is selected to the clipboard of the terminal.
    Copy,
    /// Shows the next garment of the study.
    NextGarment,
    /// Shows the garment before.
    PreviousGarment,
    /// Shows the next study.
    NextStudy,
    /// Shows the same size and subject by the other simulator.
    OtherSimulator,
    /// Shows the measurements of the next stage.
    NextStage,
    /// Turns the picture to the next view.
    NextView,
    /// Changes what the colours of the picture mean.
    NextMap,
    /// Gives the picture all the room, or less again.
    Enlarge,
    /// Shows the picture from nearer.
    ZoomIn,
    /// Shows the picture from farther.
    ZoomOut,
    /// Selects the job for a comparison, or no longer.
    Mark,
    /// Takes all selections back.
    Unmark,
    /// Shows only the measurements in which compared runs differ, or all.
    Differences,
    /// Asks what a new study is made of.
    NewStudy,
    /// Types in the query.
    EditQuery,
    /// Offers the saved queries.
    SavedQueries,
    /// Puts the query before into the editor.
    OlderQuery,
    /// Puts the query after into the editor.
    NewerQuery,
    /// Asks for the file that the rows of the query go into.
    ExportQuery,
    /// Builds the report of the study.
    BuildReport,
    /// Opens the selected report.
    OpenReport,
    /// Shows the screen in ASCII, or no longer.
    Ascii,
    /// Takes the mouse, or gives it back to the terminal.
    Mouse,
    /// Asks for the values of a new subject or fabric.
    Add(Part),
    /// Asks for other values of the selected subject or fabric.
    Edit(Part),
    /// Asks for a file with subjects or fabrics, or for the files of a style.
    Import(Part),
    /// Removes the selected subject, fabric or size.
    Remove(Part),
    /// Gives the pieces all the room, or less again.
    EnlargePieces,
    /// Marks the selected edge.
    MarkEdge,
    /// Sews the marked edges.
    AddSeam,
    /// Opens the selected seam.
    RemoveSeam,
    /// Turns one side of the selected seam round.
    FlipSeam,
    /// Takes the selected proposed seam for right.
    ConfirmSeam,
    /// Proposes the seams of the selected style.
    ProposeSeams,
    /// Takes the last edit of the seams back.
    UndoEdit,
    /// Saves the edited seams.
    SaveSeams,
    /// Pauses or resumes the study.
    Pause,
    /// Cancels the selected job.
    Cancel,
    /// Queues the selected job again.
    Retry,
    /// Runs the selected job earlier.
    Raise,
    /// Runs the selected job later.
    Lower,
    /// Runs the open jobs of the study here; on SQL, the query.
    Run,
    /// Stops the run.
    Stop,
    /// Lists the keys.
    Help,
    /// Lists the actions.
    Palette,
    /// Draws everything anew.
    Redraw,
    /// Leaves the program.
    Quit,
}

/// A key with its modifiers; Shift is part of a character.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Key {
    code: KeyCode,
    ctrl: bool,
    alt: bool,
}

impl Key {
    /// A key, with Ctrl or without.
    #[must_use]
    pub const fn new(code: KeyCode, ctrl: bool) -> Self {
        Self { code, ctrl, alt: false }
    }

    /// A key with Alt.
    #[must_use]
    pub const fn alt(code: KeyCode) -> Self {
        Self { code, ctrl: false, alt: true }
    }

    /// The key of an event.
    #[must_use]
    pub fn of(event: &KeyEvent) -> Self {
        let is = |modifier| event.modifiers.contains(modifier);
        Self { code: event.code, ctrl: is(KeyModifiers::CONTROL), alt: is(KeyModifiers::ALT) }
    }
}

impl fmt::Display for Key {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.ctrl {
            f.write_str("C-")?;
        }
        if self.alt {
            f.write_str("A-")?;
        }
        match self.code {
            KeyCode::Char(' ') => f.write_str("Space"),
            KeyCode::Char(letter) => write!(f, "{letter}"),
            KeyCode::Up => f.write_str("↑"),
            KeyCode::Down => f.write_str("↓"),
            KeyCode::Left => f.write_str("←"),
            KeyCode::Right => f.write_str("→"),
            KeyCode::Enter => f.write_str("↵"),
            KeyCode::BackTab => f.write_str("S-Tab"),
            KeyCode::PageUp => f.write_str("PgUp"),
            KeyCode::PageDown => f.write_str("PgDn"),
            other => write!(f, "{other}"),
        }
    }
}

/// One row of the table of keys.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Binding {
    /// What it does.
    pub action: Action,
    /// Its name in the palette.
    pub name: &'static str,
    /// The keys that do it.
    pub keys: &'static [Key],
    /// Where; empty means everywhere.
    pub screens: &'static [Screen],
    /// Its word in the status line; empty where it is not shown there.
    pub hint: &'static str,
    /// What it does, in words.
    pub help: &'static str,
}

impl Binding {
    /// Whether it holds on a screen.
    #[must_use]
    pub fn is_on(&self, screen: Screen) -> bool {
        self.screens.is_empty() || self.screens.contains(&screen)
    }

    /// Its keys, as help shows them.
    #[must_use]
    pub fn keys_text(&self) -> String {
        self.keys.iter().map(Key::to_string).collect::<Vec<_>>().join(" ")
    }

    /// Whether its name, keys or help contain a text, whatever the case.
    #[must_use]
    pub fn matches(&self, text: &str) -> bool {
        let text = text.to_lowercase();
        self.name.contains(&text)
            || self.help.to_lowercase().contains(&text)
            || self.keys.iter().any(|key| key.to_string().to_lowercase() == text)
    }
}

/// The action of a key on a screen.
#[must_use]
pub fn action_of(bindings: &[Binding], key: Key, screen: Screen) -> Option<Action> {
    bindings.iter().find(|binding| binding.is_on(screen) && binding.keys.contains(&key)).map(|binding| binding.action)
}

/// The actions whose name, keys or help contain a text: those whose name begins with it first.
#[must_use]
pub fn search(bindings: &'static [Binding], text: &str) -> Vec<&'static Binding> {
    let text = text.trim().to_lowercase();
    let mut found: Vec<&Binding> = bindings.iter().filter(|binding| binding.matches(&text)).collect();
    found.sort_by_key(|binding| (binding.name != text, !binding.name.starts_with(&text)));
    found
}
