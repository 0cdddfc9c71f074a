//! Update loop of the workbench (messages and actions change its state), and the frame around its screens.

mod act;
mod answers;
pub mod fading;
pub mod frame;
pub mod headless;
pub mod session;
mod update;

use ratatui::layout::Size;

use crate::screens::Screens;
use crate::screens::state::{Abilities, State};
use crate::widgets::theme::Theme;

pub struct App {
    pub state: State,
    pub screens: Screens,
}

impl App {
    pub fn new(theme: Theme, abilities: Abilities, size: Size) -> Self {
        Self { state: State::new(theme, abilities, size), screens: Screens::default() }
    }
}
