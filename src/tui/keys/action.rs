//! Actions of a user.

use crate::keys::screen::Screen;
use wardrobe::Part;

/// Everything a key or the palette can ask for. `App::act` hands it to the screen whose own it is, or does it.
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
    /// Cuts the body at the next level.
    NextLevel,
    /// Cuts the body at the level before.
    PreviousLevel,
    /// Finds the change of a size so that it fits.
    Alter,
    /// Drapes the changed pattern.
    DrapeChange,
    /// Asks for the folder that the changed pattern goes into.
    WriteChange,
    /// Finds the change of the next larger size.
    LargerSize,
    /// Finds the change of the next smaller size.
    SmallerSize,
    /// Shows only the measurements in which compared runs differ, or all.
    Differences,
    /// Asks what a new study is made of.
    NewStudy,
    /// Types in the query.
    EditQuery,
    /// Saves the query under a name.
    SaveQuery,
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
    /// Asks what is to be decided about the seams.
    Decide,
    /// Drapes the selected size on the subject in hand.
    TryOn,
    /// Asks what the selected edge is sewn to.
    AskEdge,
    /// Asks what the selected piece is worn as.
    AskPiece,
    /// Proposes the seams of the selected style.
    ProposeSeams,
    /// Takes the last edit of the seams back.
    UndoEdit,
    /// Does the edit again that was taken back last.
    RedoEdit,
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
    /// Tells what the selected row and the columns of the screen are.
    Explain,
    /// Puts letters on what is to be seen; typing one goes there.
    Jump,
    /// Lists the actions.
    Palette,
    /// Opens the query, seams or study in an editor.
    Write,
    /// Shows the screens in turn, with a few words on each.
    Tour,
    /// Lists what was done here, as commands.
    Commands,
    /// Draws everything anew.
    Redraw,
    /// Leaves the program.
    Quit,
}
