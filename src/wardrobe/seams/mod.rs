//! Work on the seams of patterns: checks, proposals and edits.

mod assumed;
pub mod check;
pub mod desk;
pub mod pattern_files;
mod rework;
pub mod spec_sheet;
pub mod specification;
pub mod step;
pub mod undecided;
pub mod workpiece;

pub use assumed::{Assumed, LeftOut};
pub use check::{CHECK_EDGE_MM, SizeCheck, check_sizes, check_study, findings};
pub use desk::{Asking, Desk, DeskEdge, DeskPiece, DeskSeam, ProposalOnPieces, Proposed, SURE, proposal, propose};
pub use pattern::propose::{Proposal, Question};
pub use pattern::seam_edit::Edit as SeamEdit;
pub use spec_sheet::{AskedRow, SpecReport, spec_report};
pub use specification::{Specification, SpecifiedPoint, specification};
pub use step::SeamStep;
pub use undecided::{Choice, LEFT_OUT, Undecided};
pub use workpiece::{DeskLength, LaidOut, Workpiece, edit_seams, seam_home, write_seams};
