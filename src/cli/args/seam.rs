//! Arguments of `toile pattern seam` and `toile style sew`: steps of work on seams.

use std::path::PathBuf;

use clap::{Args, Subcommand};

use super::PatternUnit;
use wardrobe::seams::{SeamEdit, SeamStep};

/// A seam file and its pattern.
#[derive(Clone, Debug, Args)]
pub struct SeamHome {
    /// Seam file, changed in its place.
    pub seams: PathBuf,
    /// DXF file, or folder of them, that the seam file belongs to.
    #[arg(long, value_name = "FILE")]
    pub pattern: PathBuf,
    /// Size, where the file holds several.
    #[arg(long, value_name = "NAME")]
    pub size: Option<String>,
    /// Unit of the file, where it names none.
    #[arg(long, value_enum)]
    pub unit: Option<PatternUnit>,
}

/// Two sides of a seam.
#[derive(Clone, Debug, Args)]
pub struct Sides {
    /// One side: PIECE.EDGE by name, by its number in the sheet (front.3) or its corners (front.3-5); chains with `+`.
    #[arg(value_name = "PIECE.EDGE")]
    a: String,
    /// The other side.
    #[arg(value_name = "PIECE.EDGE")]
    b: String,
}

/// A new seam.
#[derive(Clone, Debug, Args)]
pub struct NewSeam {
    #[command(flatten)]
    sides: Sides,
    /// Name of the seam.
    #[arg(long, value_name = "NAME")]
    name: Option<String>,
    /// The difference of their lengths is meant: ease or gathers.
    #[arg(long)]
    eased: bool,
}

/// An edge that a step of work is about.
#[derive(Clone, Debug, Args)]
pub struct Edge {
    /// Edge by its name in the seam file, by its number, or by its corners.
    #[arg(value_name = "PIECE.EDGE")]
    edge: String,
}

/// A piece that a step of work is about.
#[derive(Clone, Debug, Args)]
pub struct OnePiece {
    /// Piece as the seam file names it.
    piece: String,
}

/// A drawn piece that the seams leave out.
#[derive(Clone, Debug, Args)]
pub struct DrawnPiece {
    /// The piece, by its name or its block in the pattern.
    drawn: String,
    /// It is worn twice, right and left, the second mirrored.
    #[arg(long)]
    pair: bool,
}

/// What a piece is.
#[derive(Clone, Debug, Args)]
pub struct Worn {
    /// Piece as the seam file names it.
    piece: String,
    /// What it is: front, back, sleeve_right, ..., other.
    role: String,
}

/// A proposed seam.
#[derive(Clone, Debug, Args)]
pub struct Proposed {
    /// Name of the seam; without it all that are at least 80 % sure.
    seam: Option<String>,
}

/// An answer to a question of the seam file.
#[derive(Clone, Debug, Args)]
pub struct Answered {
    /// The question, as it stands in the seam file, without its choices.
    question: String,
    /// Letter of the choice.
    #[arg(value_parser = letter)]
    choice: usize,
}

/// A question of the seam file.
#[derive(Clone, Debug, Args)]
pub struct Asked {
    /// The question, as it stands in the seam file.
    question: String,
}

fn letter(text: &str) -> Result<usize, String> {
    let place = ('a'..='z').position(|letter| text.eq_ignore_ascii_case(&letter.to_string()));
    place.ok_or_else(|| format!("`{text}`: accepted: a letter, a to z"))
}

/// Steps of work on the seams of a style of the catalogue.
#[derive(Clone, Debug, Subcommand)]
pub enum SewStep {
    /// Sew two sides.
    Add(NewSeam),
    /// Open the seam between two edges.
    Rm(Sides),
    /// Turn one side of the seam between two edges round.
    Flip(Sides),
    /// Say that an edge is meant to be in no seam.
    Open(Edge),
    /// Leave a piece out, with its seams.
    LeaveOut(OnePiece),
    /// Take a drawn piece in that the seams leave out.
    TakeIn(DrawnPiece),
    /// Say what a piece is worn as.
    Role(Worn),
    /// Take a proposed seam for right, or all that are sure.
    Confirm(Proposed),
    /// Answer a question of the proposal: it is made anew, and what was confirmed stays so where it is proposed again.
    Answer(Answered),
    /// Strike a question out: the seams are as they should be.
    Settle(Asked),
    /// Propose all seams anew.
    Propose,
}

impl SewStep {
    /// The step; `style` is the name that a proposal gets.
    pub fn step(self, style: &str) -> SeamStep {
        match self {
            Self::Add(NewSeam { sides: Sides { a, b }, name, eased }) => {
                SeamStep::Edit(SeamEdit::Add { a, b, name, is_eased: eased })
            }
            Self::Rm(Sides { a, b }) => SeamStep::Edit(SeamEdit::Remove { a, b }),
            Self::Flip(Sides { a, b }) => SeamStep::Edit(SeamEdit::Flip { a, b }),
            Self::Open(Edge { edge }) => SeamStep::Edit(SeamEdit::Open { edge }),
            Self::LeaveOut(OnePiece { piece }) => SeamStep::Edit(SeamEdit::LeaveOut { piece }),
            Self::TakeIn(DrawnPiece { drawn, pair }) => SeamStep::Edit(SeamEdit::TakeIn { drawn, is_pair: pair }),
            Self::Role(Worn { piece, role }) => SeamStep::Edit(SeamEdit::Role { piece, role }),
            Self::Confirm(Proposed { seam: Some(seam) }) => SeamStep::Confirm(seam),
            Self::Confirm(Proposed { seam: None }) => SeamStep::ConfirmSure,
            Self::Answer(Answered { question, choice }) => SeamStep::Answer { question, choice },
            Self::Settle(Asked { question }) => SeamStep::Decide(question),
            Self::Propose => SeamStep::Propose(style.to_owned()),
        }
    }
}

/// Steps of work on a seam file; the result is checked against the pattern, and comments stay.
#[derive(Clone, Debug, Subcommand)]
pub enum SeamCommand {
    /// Sew two sides.
    Add {
        #[command(flatten)]
        home: SeamHome,
        #[command(flatten)]
        of: NewSeam,
    },
    /// Open the seam between two edges.
    Rm {
        #[command(flatten)]
        home: SeamHome,
        #[command(flatten)]
        of: Sides,
    },
    /// Turn one side of the seam between two edges round.
    Flip {
        #[command(flatten)]
        home: SeamHome,
        #[command(flatten)]
        of: Sides,
    },
    /// Say that an edge is meant to be in no seam.
    Open {
        #[command(flatten)]
        home: SeamHome,
        #[command(flatten)]
        of: Edge,
    },
    /// Leave a piece out, with its seams.
    LeaveOut {
        #[command(flatten)]
        home: SeamHome,
        #[command(flatten)]
        of: OnePiece,
    },
    /// Take a drawn piece in that the seams leave out.
    TakeIn {
        #[command(flatten)]
        home: SeamHome,
        #[command(flatten)]
        of: DrawnPiece,
    },
    /// Say what a piece is worn as.
    Role {
        #[command(flatten)]
        home: SeamHome,
        #[command(flatten)]
        of: Worn,
    },
    /// Take a proposed seam for right, or all that are sure.
    Confirm {
        #[command(flatten)]
        home: SeamHome,
        #[command(flatten)]
        of: Proposed,
    },
    /// Answer a question of the proposal: it is made anew, and what was confirmed stays so where it is proposed again.
    Answer {
        #[command(flatten)]
        home: SeamHome,
        #[command(flatten)]
        of: Answered,
    },
    /// Strike a question out: the file is as it should be.
    Settle {
        #[command(flatten)]
        home: SeamHome,
        #[command(flatten)]
        of: Asked,
    },
}

impl SeamCommand {
    /// The seam file, and the step.
    pub fn step(self) -> (SeamHome, SeamStep) {
        let (home, step) = match self {
            Self::Add { home, of } => (home, SewStep::Add(of)),
            Self::Rm { home, of } => (home, SewStep::Rm(of)),
            Self::Flip { home, of } => (home, SewStep::Flip(of)),
            Self::Open { home, of } => (home, SewStep::Open(of)),
            Self::LeaveOut { home, of } => (home, SewStep::LeaveOut(of)),
            Self::TakeIn { home, of } => (home, SewStep::TakeIn(of)),
            Self::Role { home, of } => (home, SewStep::Role(of)),
            Self::Confirm { home, of } => (home, SewStep::Confirm(of)),
            Self::Answer { home, of } => (home, SewStep::Answer(of)),
            Self::Settle { home, of } => (home, SewStep::Settle(of)),
        };
        (home, step.step(""))
    }
}
