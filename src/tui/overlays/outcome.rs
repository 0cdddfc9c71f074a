//! What a key does to what is open above a screen.

use crate::keys::action::Action;
use crate::messages::effect::Effect;
use crate::overlays::things::Thing;
use crate::widgets::jump::Goal;

/// What a key did to an overlay.
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
    /// It closes and what is to be seen somewhere is gone to.
    Jump(Goal),
    /// It closes and a query goes into the editor.
    Query(String),
    /// It closes and another name of a saved query is asked for.
    Rename(String),
    /// It closes and effects follow.
    Effects(Vec<Effect>),
    /// It stays open until what it asked for is done.
    Sent(Vec<Effect>),
}
