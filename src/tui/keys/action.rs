//! Actions of a user.

use crate::keys::screen::Screen;
use wardrobe::Part;

/// Actions that a key or the palette can ask for. `App::act` carries out the common ones; screens have their own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Action {
    Up,
    Down,
    /// Selects the cell to the left; turns a picture that has the focus.
    Left,
    /// Selects the cell to the right; turns a picture that has the focus.
    Right,
    First,
    Last,
    PageUp,
    PageDown,
    NextPane,
    PreviousPane,
    Show(Screen),
    Open,
    Back,
    /// Goes back; quits where there is nothing to go back to.
    Leave,
    Filter,
    NextMatch,
    PreviousMatch,
    /// Sorts by the next column.
    Sort,
    Reverse,
    Copy,
    NextGarment,
    PreviousGarment,
    NextStudy,
    OtherSimulator,
    NextStage,
    NextView,
    NextMap,
    Enlarge,
    ZoomIn,
    ZoomOut,
    Mark,
    MarkRange,
    MarkAll,
    Unmark,
    NextLevel,
    PreviousLevel,
    Alter,
    DrapeChange,
    WriteChange,
    /// Finds the alteration of the next larger size.
    LargerSize,
    /// Finds the alteration of the next smaller size.
    SmallerSize,
    Comments,
    AllComments,
    AddComment,
    EditComment,
    CloseComment,
    UndoComment,
    BeginRound,
    SignRound,
    /// Shows only the measurements in which the compared runs differ, or all again.
    Differences,
    NewStudy,
    EditQuery,
    NewQuery,
    SaveQuery,
    SavedQueries,
    OlderQuery,
    NewerQuery,
    ExportQuery,
    BuildReport,
    OpenReport,
    Ascii,
    Mouse,
    Add(Part),
    Edit(Part),
    /// Asks for a file with subjects or fabrics, or for the files of a style.
    Import(Part),
    Remove(Part),
    EnlargePieces,
    MarkEdge,
    AddSeam,
    /// Opens the selected seam.
    RemoveSeam,
    FlipSeam,
    Decide,
    /// Drapes the selected size on the chosen subject.
    TryOn,
    AskEdge,
    AskPiece,
    ProposeSeams,
    UndoEdit,
    RedoEdit,
    SaveSeams,
    Pause,
    Cancel,
    Retry,
    RetryFailed,
    /// Runs the selected job earlier.
    Raise,
    /// Runs the selected job later.
    Lower,
    /// Runs the queued jobs of the study here; on the SQL screen, runs the query.
    Run,
    Stop,
    Help,
    Explain,
    /// Puts letters on the things on the screen; typing one goes there.
    Jump,
    Palette,
    /// Opens the query, the seams or the study in the user's editor.
    Write,
    Tour,
    /// Lists the commands that do the same as was done here.
    Commands,
    Redraw,
    Suspend,
    Quit,
}
