//! Messages to the event loop and effects from it, both as closed sets, so the workbench is a function `(state,
//! message) -> (state, effects)`. Threads and screens meet only here.

pub mod alterations;
pub mod answered;
pub mod comments;
pub mod effect;
pub mod message;
pub mod requests;
pub mod seams;
pub mod snapshot;
pub mod taught;
