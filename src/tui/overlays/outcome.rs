//! Outcomes of a key for the overlay above a screen.

use crate::keys::action::Action;
use crate::messages::effect::Effect;
use crate::overlays::things::Thing;
use crate::widgets::jump::Goal;

/// Outcome of a key for an overlay.
#[derive(Debug, PartialEq)]
pub enum Outcome {
    /// It stays open.
    Open,
    /// It closes, and nothing follows.
    Closed,
    /// It closes and an action follows.
    Action(Action),
    /// It closes and something is gone to.
    Thing(Thing),
    /// A step of the tour follows.
    Tour(usize),
    /// It closes and a place on the screen is gone to.
    Jump(Goal),
    /// It closes and a query goes into the editor.
    Query(String),
    /// It closes and another name of a saved query is asked for.
    Rename(String),
    /// It closes and effects follow.
    Effects(Vec<Effect>),
    /// It stays open until the effects that it asked for are done.
    Sent(Vec<Effect>),
}
