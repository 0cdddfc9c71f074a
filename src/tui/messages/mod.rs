//! Messages that arrive at the event loop, and effects that it asks for: closed sets, so that all of the workbench is
//! `(state, message) -> (state, effects)`. Threads and screens meet here, and only here.

pub mod alterations;
pub mod answered;
pub mod effect;
pub mod message;
pub mod requests;
pub mod seams;
pub mod snapshot;
pub mod taught;
