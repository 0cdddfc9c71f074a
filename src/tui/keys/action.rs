//! Actions of a user.

use crate::keys::screen::Screen;
use wardrobe::Part;

/// Actions that a key or the palette can ask for. `App::act` carries out the common ones; screens have their own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Action {
    /// Selects the row or cell above.
    Up,
    /// Selects the row or cell below.
    Down,
    /// Selects the cell to the left; turns a picture that has the focus.
    Left,
    /// Selects the cell to the right; turns a picture that has the focus.
    Right,
    /// Selects the first row.
    First,
    /// Selects the last row.
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
    /// Opens the selected row or cell.
    Open,
    /// Goes back, where there is anything to go back to.
    Back,
    /// Goes back; quits where there is nothing to go back to.
    Leave,
    /// Asks for text that rows must contain.
    Filter,
    /// Selects the next row or cell that matches the filter.
    NextMatch,
    /// Selects the previous row or cell that matches the filter.
    PreviousMatch,
    /// Sorts by the next column.
    Sort,
    /// Reverses the order.
    Reverse,
    /// Copies the selection to the clipboard of the terminal.
    Copy,
    /// Shows the next garment of the study.
    NextGarment,
    /// Shows the previous garment of the study.
    PreviousGarment,
    /// Shows the next study.
    NextStudy,
    /// Shows the same size and subject by the other simulator.
    OtherSimulator,
    /// Shows the measurements of the next stage.
    NextStage,
    /// Turns the picture to the next view.
    NextView,
    /// Colours the picture by the next map.
    NextMap,
    /// Enlarges the picture to all the room, or makes it small again.
    Enlarge,
    /// Zooms into the picture.
    ZoomIn,
    /// Zooms out of the picture.
    ZoomOut,
    /// Marks the row, or takes the mark away.
    Mark,
    /// Marks the rows from the one that was marked last.
    MarkRange,
    /// Marks all shown rows, or takes their marks away.
    MarkAll,
    /// Takes all marks away.
    Unmark,
    /// Shows the cross section at the next level.
    NextLevel,
    /// Shows the cross section at the previous level.
    PreviousLevel,
    /// Finds the alteration of a size that makes it fit.
    Alter,
    /// Drapes the altered pattern.
    DrapeChange,
    /// Asks for the folder for the altered pattern.
    WriteChange,
    /// Finds the alteration of the next larger size.
    LargerSize,
    /// Finds the alteration of the next smaller size.
    SmallerSize,
    /// Shows the comments of the fitting.
    Comments,
    /// Lists the comments of all fittings of the study, or of the shown one again.
    AllComments,
    /// Opens the form of a new comment.
    AddComment,
    /// Opens the form of the selected comment.
    EditComment,
    /// Closes the selected comment, or opens it again.
    CloseComment,
    /// Takes the last change of a comment back.
    UndoComment,
    /// Begins the next round of the fitting.
    BeginRound,
    /// Asks for the name of who signs the last round off.
    SignRound,
    /// Shows only the measurements in which the compared runs differ, or all again.
    Differences,
    /// Opens the form of a new study.
    NewStudy,
    /// Begins typing in the query.
    EditQuery,
    /// Begins a new query beside the others.
    NewQuery,
    /// Saves the query under a name.
    SaveQuery,
    /// Lists the saved queries.
    SavedQueries,
    /// Puts the previous query of the history into the editor.
    OlderQuery,
    /// Puts the next query of the history into the editor.
    NewerQuery,
    /// Asks for the file for the rows of the query.
    ExportQuery,
    /// Builds the report of the study.
    BuildReport,
    /// Opens the selected report.
    OpenReport,
    /// Shows the screen in plain ASCII, or with all signs again.
    Ascii,
    /// Takes the mouse, or gives it back to the terminal.
    Mouse,
    /// Opens the form of a new subject or fabric.
    Add(Part),
    /// Opens the form of the selected subject or fabric.
    Edit(Part),
    /// Asks for a file with subjects or fabrics, or for the files of a style.
    Import(Part),
    /// Removes the selected subject, fabric or size.
    Remove(Part),
    /// Enlarges the pieces to all the room, or makes them small again.
    EnlargePieces,
    /// Marks the selected edge.
    MarkEdge,
    /// Sews the marked edges.
    AddSeam,
    /// Opens the selected seam.
    RemoveSeam,
    /// Reverses one side of the selected seam.
    FlipSeam,
    /// Asks the open questions about the seams.
    Decide,
    /// Drapes the selected size on the chosen subject.
    TryOn,
    /// Asks what the selected edge is sewn to.
    AskEdge,
    /// Asks for the role of the selected piece.
    AskPiece,
    /// Proposes the seams of the selected style.
    ProposeSeams,
    /// Undoes the last edit of the seams.
    UndoEdit,
    /// Redoes the edit that was undone last.
    RedoEdit,
    /// Saves the edited seams.
    SaveSeams,
    /// Pauses or resumes the study.
    Pause,
    /// Cancels the selected job.
    Cancel,
    /// Queues the selected job again.
    Retry,
    /// Queues all failed jobs of the study again.
    RetryFailed,
    /// Runs the selected job earlier.
    Raise,
    /// Runs the selected job later.
    Lower,
    /// Runs the queued jobs of the study here; on the SQL screen, runs the query.
    Run,
    /// Stops the run.
    Stop,
    /// Lists the keys.
    Help,
    /// Explains the selected row and the columns of the screen.
    Explain,
    /// Puts letters on the things on the screen; typing a letter goes there.
    Jump,
    /// Lists the actions.
    Palette,
    /// Opens the query, the seams or the study in the user's editor.
    Write,
    /// Starts the tour of the screens.
    Tour,
    /// Lists the commands that do the same as was done here.
    Commands,
    /// Draws the whole screen again.
    Redraw,
    /// Gives the terminal back to the shell until that continues the program.
    Suspend,
    /// Leaves the program.
    Quit,
}
