//! Advice drawn from patterns, bodies and results: alterations, the chance that a size fits, sizes graded for a
//! population, subjects that represent it.

mod alteration;
pub mod chance;
pub mod comments;
mod error;
mod grading;
pub mod population;

pub use alteration::{
    Alteration, AlteredLevel, AlteredReading, ForFigure, MovedHandle, Redraped, SignRead, Standing, Wish, alter,
    standing,
};
pub use chance::{
    Chance, DrapedChance, LevelChance, LikelyDimension, PlantedLevel, PlantedTally, Question, Reliability, SizeChance,
    chance, planted,
};
pub use grading::{
    DrapedAgain, GradeWish, Grading, Grown, LevelShare, PartShare, Range, SizeSet, SizeShare, Turn, grade,
};
pub use population::{Nearest, PopulationOptions, Representative, representatives, subjects_text};
