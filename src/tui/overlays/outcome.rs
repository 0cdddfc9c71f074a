//! Outcome of a key for an overlay.

use crate::keys::action::Action;
use crate::messages::effect::Effect;
use crate::overlays::things::Thing;
use crate::widgets::jump::Goal;

#[derive(Debug, PartialEq)]
pub enum Outcome {
    Open,
    Closed,
    /// The overlay closes, and an action follows.
    Action(Action),
    /// The overlay closes, and a study or entry is gone to.
    Thing(Thing),
    /// A step of the tour follows.
    Tour(usize),
    /// The overlay closes, and a place on the screen is gone to.
    Jump(Goal),
    /// The overlay closes, and a query goes into the editor.
    Query(String),
    /// The overlay closes, and a prompt for the new name of a saved query opens.
    Rename(String),
    /// The overlay closes, and effects follow.
    Effects(Vec<Effect>),
    /// The overlay stays open until its effects are done.
    Sent(Vec<Effect>),
}
