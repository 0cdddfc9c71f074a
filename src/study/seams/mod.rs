//! What is sewn: patterns with their seams, checked, proposed and edited.

pub mod check;
pub mod desk;
pub mod pattern_files;
pub mod workpiece;
