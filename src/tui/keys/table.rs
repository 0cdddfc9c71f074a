//! The one table of keys, for key handling, help and palette.

use crossterm::event::KeyCode;

use crate::keys::action::Action;
use crate::keys::binding::{Binding, Key};
use crate::keys::screen::Screen::{self, Compare, Fabrics, Fit, Jobs, Reports, Results, Sql, Study, Styles, Subjects};
use wardrobe::Part;

const fn ch(letter: char) -> Key {
    Key::new(KeyCode::Char(letter), false)
}

const fn ctrl(letter: char) -> Key {
    Key::new(KeyCode::Char(letter), true)
}

const fn key(code: KeyCode) -> Key {
    Key::new(code, false)
}

const fn bind(
    action: Action,
    name: &'static str,
    keys: &'static [Key],
    screens: &'static [Screen],
    hint: &'static str,
    help: &'static str,
) -> Binding {
    Binding { action, name, keys, screens, hint, help }
}

/// Screens on which a job is selected.
const RESULTS: &[Screen] = &[Study, Jobs, Results];

/// Screens with rows that can be selected; those with lists of them; those where all selections can be taken back.
const MARKED: &[Screen] = &[Study, Jobs, Results, Subjects, Fabrics];
const LISTED: &[Screen] = &[Study, Jobs, Subjects, Fabrics];
const UNMARKED: &[Screen] = &[Study, Jobs, Results, Compare, Subjects, Fabrics];

const SORTED: &[Screen] = &[Study, Subjects, Fabrics, Jobs, Results, Compare, Sql, Reports];

/// The built-in table of keys, which a file may change (`keys`). It does not use Ctrl-A, B, S, Q, H, I, J and M, which
/// tmux, screen, flow control and the terminal need.
pub const BINDINGS: &[Binding] = &[
    bind(Action::Open, "open", &[key(KeyCode::Enter)], &[Study, Jobs], "open", "Open the result of the selected job"),
    bind(
        Action::Enlarge,
        "enlarge",
        &[key(KeyCode::Enter), ch('z')],
        &[Results, Compare],
        "enlarge",
        "Give the picture all the room, or less again",
    ),
    bind(
        Action::Edit(Part::Subject),
        "edit-subject",
        &[ch('e'), key(KeyCode::Enter)],
        &[Subjects],
        "edit",
        "Change the selected subject; results keep theirs",
    ),
    bind(Action::Add(Part::Subject), "add-subject", &[ch('a')], &[Subjects], "add", "Add a subject"),
    bind(
        Action::Import(Part::Subject),
        "import-subjects",
        &[ch('i')],
        &[Subjects],
        "import",
        "Add or change the subjects of a CSV or TOML file",
    ),
    bind(
        Action::Remove(Part::Subject),
        "delete-subject",
        &[ch('d')],
        &[Subjects],
        "delete",
        "Remove the selected subject; asks",
    ),
    bind(
        Action::Edit(Part::Fabric),
        "edit-fabric",
        &[ch('e'), key(KeyCode::Enter)],
        &[Fabrics],
        "edit",
        "Change the selected fabric; results keep theirs",
    ),
    bind(Action::Add(Part::Fabric), "add-fabric", &[ch('a')], &[Fabrics], "add", "Add a fabric like the selected one"),
    bind(
        Action::Import(Part::Fabric),
        "import-fabrics",
        &[ch('i')],
        &[Fabrics],
        "import",
        "Add or change the fabrics of a TOML or CSV file",
    ),
    bind(
        Action::Remove(Part::Fabric),
        "delete-fabric",
        &[ch('d')],
        &[Fabrics],
        "delete",
        "Remove the selected fabric; asks",
    ),
    bind(
        Action::Decide,
        "decide",
        &[key(KeyCode::Enter)],
        &[Styles],
        "decide",
        "Work on the seams: asks what is to be decided",
    ),
    bind(Action::TryOn, "try-on", &[ch('t')], &[Styles], "try on", "Drape the selected size on the subject in hand"),
    bind(
        Action::MarkEdge,
        "mark-edge",
        &[ch('m'), ch(' ')],
        &[Styles],
        "mark",
        "Mark the selected edge for a new seam, or unmark it",
    ),
    bind(
        Action::AddSeam,
        "add-seam",
        &[ch('a')],
        &[Styles],
        "sew",
        "Sew the marked edge to the selected or other marked",
    ),
    bind(Action::RemoveSeam, "remove-seam", &[ch('x')], &[Styles], "open", "Open the selected seam"),
    bind(
        Action::SaveSeams,
        "save-seams",
        &[ch('w')],
        &[Styles],
        "save",
        "Save the seams: catalogue, and study folder if asked",
    ),
    bind(Action::AskEdge, "ask-edge", &[ch('e')], &[Styles], "edge", "Ask what the selected edge is sewn to"),
    bind(
        Action::AskPiece,
        "ask-piece",
        &[ch('o')],
        &[Styles],
        "piece",
        "What the piece is; again: pieces that are left out",
    ),
    bind(
        Action::Import(Part::Style),
        "import-style",
        &[ch('i')],
        &[Styles],
        "import",
        "Add a style or sizes: DXF, GarmentCode, study.toml",
    ),
    bind(Action::FlipSeam, "flip-seam", &[ch('f')], &[Styles], "flip", "Turn one side of the selected seam round"),
    bind(
        Action::ProposeSeams,
        "propose-seams",
        &[ch('p')],
        &[Styles],
        "propose",
        "Propose all seams of the style; asks",
    ),
    bind(Action::UndoEdit, "undo-edit", &[ch('u')], &[Styles], "undo", "Take the last edit of the seams back"),
    bind(Action::RedoEdit, "redo-edit", &[ch('U')], &[Styles], "", "Do the edit again that was taken back last"),
    bind(
        Action::EnlargePieces,
        "enlarge-pieces",
        &[ch('z')],
        &[Styles],
        "enlarge",
        "Give the pieces all the room, or less again",
    ),
    bind(
        Action::Remove(Part::Size),
        "delete-size",
        &[ch('d')],
        &[Styles],
        "delete",
        "Remove the selected size, the last with its style",
    ),
    bind(Action::Pause, "pause", &[ch('p')], &[Study, Jobs], "pause", "Pause or resume the study; running jobs go on"),
    bind(Action::Cancel, "cancel", &[ch('x')], RESULTS, "cancel", "Cancel the selected queued or running jobs; asks"),
    bind(Action::Retry, "retry", &[ch('r')], RESULTS, "retry", "Queue the selected failed or cancelled jobs again"),
    bind(
        Action::RetryFailed,
        "retry-failed",
        &[ch('A')],
        &[Study, Jobs],
        "all failed",
        "Queue all failed jobs of the study again",
    ),
    bind(
        Action::OpenReport,
        "open-report",
        &[key(KeyCode::Enter)],
        &[Reports],
        "open",
        "Open the report, or copy its address",
    ),
    bind(
        Action::BuildReport,
        "build-report",
        &[ch('b')],
        &[Study, Results, Compare, Reports],
        "report",
        "Build the report of the study, in the background",
    ),
    bind(
        Action::EditQuery,
        "edit-query",
        &[ch('e'), ch('i'), key(KeyCode::Enter)],
        &[Sql],
        "edit",
        "Type in the query; Esc leaves it",
    ),
    bind(
        Action::Run,
        "run",
        &[ch('R'), key(KeyCode::F(5)), Key::alt(KeyCode::Enter)],
        &[],
        "run",
        "Run the study in the background; on SQL, the query",
    ),
    bind(Action::NewQuery, "new-query", &[ch('a')], &[Sql], "new", "Begin a query beside the others; ] and [ change"),
    bind(Action::SavedQueries, "saved-queries", &[ch('o')], &[Sql], "saved", "Choose a saved query"),
    bind(
        Action::ExportQuery,
        "export-query",
        &[ch('w')],
        &[Sql],
        "export",
        "Write all rows: CSV, JSON, Parquet or XLSX",
    ),
    bind(Action::SaveQuery, "save-query", &[ch('W')], &[Sql], "", "Save the query under a name"),
    bind(Action::OlderQuery, "older-query", &[ctrl('p')], &[Sql], "", "The query before, of the history"),
    bind(Action::NewerQuery, "newer-query", &[ctrl('n')], &[Sql], "", "The query after, of the history"),
    bind(Action::NewStudy, "new-study", &[ch('a')], &[Study], "new", "Make a study: subjects, styles, sizes, fabric"),
    bind(Action::Mark, "select", &[ch(' ')], MARKED, "select", "Select the row for x, r, d or a comparison, or not"),
    bind(Action::MarkRange, "select-range", &[ch('V')], LISTED, "", "Select the rows from the one selected last"),
    bind(Action::MarkAll, "select-all", &[ch('*')], LISTED, "", "Select all shown rows, or none of them"),
    bind(
        Action::Show(Compare),
        "compare",
        &[ch('c'), ch('6')],
        &[],
        "compare",
        "Screen 6: selected runs, or FEM and Hybrid",
    ),
    bind(
        Action::NextLevel,
        "level",
        &[ch('v')],
        &[Fit],
        "level",
        "Cut at the next level: chest, underbust, waist, ...",
    ),
    bind(Action::PreviousLevel, "level-before", &[ch('V')], &[Fit], "", "Cut at the level before"),
    bind(Action::Alter, "alter", &[ch('a')], &[Fit], "alter", "Find what to change of the size so that it fits"),
    bind(Action::DrapeChange, "drape-change", &[ch('d')], &[Fit], "", "Drape the changed pattern, in the background"),
    bind(Action::WriteChange, "write-change", &[ch('w')], &[Fit], "", "Write the changed pattern, seams and a sheet"),
    bind(Action::LargerSize, "larger-size", &[ch('+'), ch('=')], &[Fit], "", "Change the next larger size instead"),
    bind(Action::SmallerSize, "smaller-size", &[ch('-')], &[Fit], "", "Change the next smaller size instead"),
    bind(Action::Comments, "comments", &[ch('m')], &[Fit], "comments", "Comments of the fitting: asked, met, closed"),
    bind(
        Action::EditComment,
        "edit-comment",
        &[ch('e'), key(KeyCode::Enter)],
        &[Fit],
        "",
        "Change the comment: words, action, owner, status",
    ),
    bind(Action::AddComment, "add-comment", &[ch('i')], &[Fit], "", "Add a comment of your own to the last round"),
    bind(Action::CloseComment, "close-comment", &[ch('x')], &[Fit], "", "Close the selected comment, or open it again"),
    bind(Action::UndoComment, "undo-comment", &[ch('u')], &[Fit], "", "Take the last change of a comment back"),
    bind(
        Action::BeginRound,
        "begin-round",
        &[ch('b')],
        &[Fit],
        "",
        "Comment what was measured as the next round; asks",
    ),
    bind(Action::SignRound, "sign-round", &[ch('S')], &[Fit], "", "Sign the last round of the fitting off"),
    bind(Action::AllComments, "all-comments", &[ch('z')], &[Fit], "", "Comments of the whole study, or of one fitting"),
    bind(Action::Unmark, "unselect", &[ch('u')], UNMARKED, "", "Take all selections back"),
    bind(
        Action::Differences,
        "differences",
        &[ch('d')],
        &[Compare],
        "differences",
        "Only what differs, or all measurements",
    ),
    bind(Action::Stop, "stop", &[ch('X')], &[], "", "Stop the run started here; asks"),
    bind(
        Action::NextView,
        "view",
        &[ch('v')],
        &[Results, Compare, Styles],
        "view",
        "Turn the picture: front, side, back, quarter",
    ),
    bind(
        Action::NextMap,
        "map",
        &[ch('m')],
        &[Results, Compare],
        "map",
        "Colour it: plain, check, stretch, tension, ...",
    ),
    bind(
        Action::OtherSimulator,
        "other-simulator",
        &[ch('f')],
        RESULTS,
        "FEM/HYB",
        "Same size and subject by the other simulator",
    ),
    bind(
        Action::ZoomIn,
        "zoom-in",
        &[ch('+'), ch('=')],
        &[Results, Compare],
        "",
        "Nearer; ↑↓ move in the focused picture",
    ),
    bind(Action::ZoomOut, "zoom-out", &[ch('-')], &[Results, Compare], "", "Farther"),
    bind(Action::NextStage, "stage", &[ch('t')], &[Results], "stage", "Measurements of the next stage: popup, drape"),
    bind(Action::Filter, "filter", &[ch('/')], &[], "filter", "Show only what contains a text"),
    bind(Action::Sort, "sort", &[ch('s')], SORTED, "sort", "Sort by the next column, on SQL by the selected one"),
    bind(Action::Reverse, "reverse", &[ch('S')], SORTED, "", "Reverse the order"),
    bind(Action::Show(Fit), "fit", &[ch('F'), ch('0')], &[], "fit", "Screen 0: which size to wear, and how all sit"),
    bind(
        Action::Help,
        "help",
        &[ch('?'), key(KeyCode::F(1))],
        &[],
        "help",
        "List the keys; type to filter by name or key",
    ),
    bind(Action::Explain, "explain", &[ch('K')], &[], "", "What the selected row and the columns here are"),
    bind(Action::Jump, "jump", &[ch('\'')], &[], "", "Letters on rows, panes and edges: type one to go"),
    bind(Action::Palette, "palette", &[ch(':')], &[], "command", "Run any action by its name; :q quits"),
    bind(Action::Up, "up", &[ch('k'), key(KeyCode::Up)], &[], "", "Select what is above"),
    bind(Action::Down, "down", &[ch('j'), key(KeyCode::Down)], &[], "", "Select what is below"),
    bind(
        Action::Left,
        "left",
        &[ch('h'), key(KeyCode::Left)],
        &[],
        "",
        "Left; result before; turn the focused picture",
    ),
    bind(
        Action::Right,
        "right",
        &[ch('l'), key(KeyCode::Right)],
        &[],
        "",
        "Right; next result; turn the focused picture",
    ),
    bind(Action::First, "first", &[ch('g'), key(KeyCode::Home)], &[], "", "Select the first"),
    bind(Action::Last, "last", &[ch('G'), key(KeyCode::End)], &[], "", "Select the last"),
    bind(Action::PageUp, "page-up", &[key(KeyCode::PageUp), ctrl('u')], &[], "", "Go up by a page"),
    bind(Action::PageDown, "page-down", &[key(KeyCode::PageDown), ctrl('d')], &[], "", "Go down by a page"),
    bind(Action::NextPane, "next-pane", &[key(KeyCode::Tab)], &[], "", "Give the focus to the next pane"),
    bind(Action::PreviousPane, "previous-pane", &[key(KeyCode::BackTab)], &[], "", "Give the focus to the pane before"),
    bind(Action::Show(Study), "study", &[ch('1')], &[], "", "Screen 1: the study, sizes by subjects"),
    bind(
        Action::Show(Subjects),
        "subjects",
        &[ch('2')],
        &[],
        "",
        "Screen 2: the subjects, their bodies and percentiles",
    ),
    bind(Action::Show(Styles), "styles", &[ch('3')], &[], "", "Screen 3: styles and sizes, pieces and seams"),
    bind(Action::Show(Jobs), "jobs", &[ch('4')], &[], "", "Screen 4: the queue, logs and convergence"),
    bind(Action::Show(Results), "results", &[ch('5')], &[], "", "Screen 5: one result, its numbers and picture"),
    bind(Action::Show(Sql), "sql", &[ch('7')], &[], "", "Screen 7: questions in SQL"),
    bind(Action::Show(Reports), "reports", &[ch('8')], &[], "", "Screen 8: the reports that were built"),
    bind(Action::Show(Fabrics), "fabrics", &[ch('9')], &[], "", "Screen 9: the fabrics, their numbers and sources"),
    bind(Action::NextGarment, "next-garment", &[ch(']')], &[], "", "Next garment of the study; on SQL, the next query"),
    bind(Action::PreviousGarment, "previous-garment", &[ch('[')], &[], "", "Garment or query before"),
    bind(Action::NextStudy, "next-study", &[ch('}')], &[], "", "Next study"),
    bind(Action::NextMatch, "next-match", &[ch('n')], &[], "", "Next match of the filter"),
    bind(Action::PreviousMatch, "previous-match", &[ch('N')], &[], "", "Match before"),
    bind(Action::Raise, "raise", &[ch('+')], &[Jobs], "", "Have the selected job run earlier"),
    bind(Action::Lower, "lower", &[ch('-')], &[Jobs], "", "Have the selected job run later"),
    bind(Action::Copy, "copy", &[ch('y')], &[], "", "Copy the line or the table, over SSH too"),
    bind(
        Action::Write,
        "edit-text",
        &[ch('E')],
        &[Study, Styles, Sql],
        "",
        "Edit query, seams or study file in $EDITOR",
    ),
    bind(Action::Tour, "tour", &[ch('T')], &[], "", "Six screens on the results, a few words on each"),
    bind(Action::Commands, "commands", &[ch('L')], &[], "", "Log of what was done here, as commands to copy"),
    bind(Action::Redraw, "redraw", &[ctrl('l')], &[], "", "Draw everything anew"),
    bind(Action::Suspend, "suspend", &[ctrl('z')], &[], "", "Back to the shell; its fg goes on here"),
    bind(Action::Ascii, "ascii", &[key(KeyCode::F(2))], &[], "", "Plain ASCII instead of lines and signs, or back"),
    bind(Action::Mouse, "mouse", &[key(KeyCode::F(3))], &[], "", "Take the mouse: click and wheel; or not"),
    bind(Action::Back, "back", &[key(KeyCode::Esc)], &[], "", "Close, clear the filter, go back a screen"),
    bind(Action::Leave, "leave", &[ch('q')], &[], "", "Go back; at the top, quit"),
    bind(Action::Quit, "quit", &[ctrl('c')], &[], "", "Cancel a query; else leave; asks while a run goes on"),
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::keys::binding::{action_of, search};

    #[test]
    fn no_key_is_bound_twice_on_a_screen_nor_to_what_terminals_use() {
        for screen in Screen::ALL {
            let keys: Vec<Key> =
                BINDINGS.iter().filter(|b| b.is_on(screen)).flat_map(|b| b.keys.iter().copied()).collect();
            for (i, key) in keys.iter().enumerate() {
                assert!(!keys[..i].contains(key), "{key} twice on {screen:?}");
                let avoided = "absqhijm".chars().map(ctrl).any(|taken| taken == *key);
                assert!(!avoided, "{key} is taken by terminals");
            }
        }
    }

    #[test]
    fn every_binding_has_a_key_a_unique_name_and_help() {
        for (i, binding) in BINDINGS.iter().enumerate() {
            assert!(!binding.keys.is_empty() && !binding.help.is_empty(), "{}", binding.name);
            assert!(binding.help.chars().count() <= 52, "{} has to fit 80 columns", binding.name);
            assert!(BINDINGS[..i].iter().all(|b| b.name != binding.name && b.action != binding.action));
            assert_eq!(search(BINDINGS, binding.name)[0].name, binding.name, "the palette finds it by its name");
        }
    }

    #[test]
    fn the_palette_puts_names_first() {
        let check = |text: &str, expect: &str| assert_eq!(search(BINDINGS, text)[0].name, expect, "{text}");
        check("q", "quit");
        check("quit", "quit");
        check("can", "cancel");
        check("queue", "cancel");
        assert!(search(BINDINGS, "no such action").is_empty());
    }

    #[test]
    fn keys_mean_what_their_screen_says() {
        let check = |k: Key, screen, expect| assert_eq!(action_of(BINDINGS, k, screen), expect, "{k} on {screen:?}");
        check(key(KeyCode::Enter), Jobs, Some(Action::Open));
        check(key(KeyCode::Enter), Results, Some(Action::Enlarge));
        check(key(KeyCode::Enter), Subjects, Some(Action::Edit(Part::Subject)));
        check(key(KeyCode::Enter), Styles, Some(Action::Decide));
        check(ch('x'), Styles, Some(Action::RemoveSeam));
        check(ch('x'), Subjects, None);
        check(ch('v'), Study, None);
        check(ctrl('c'), Study, Some(Action::Quit));
        check(ch('c'), Study, Some(Action::Show(Compare)));
        check(Key::alt(KeyCode::Enter), Sql, Some(Action::Run));
    }
}
