//! Tools for drawing and typing, independent of the state.

pub mod ascii;
pub mod braille;
pub mod dots;
pub mod editor;
pub mod half_blocks;
pub mod jump;
pub mod layout;
pub mod lists;
pub mod picture;
pub mod result_table;
pub mod text;
pub mod theme;
pub mod theme_file;
pub mod typing;
mod vim;
