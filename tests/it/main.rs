//! Toile from outside: the program as its users call it, and the rules that the sources keep.
//!
//! `structure` and `tidy` read the sources, `words` the documents as well, `documents` what these name. `blocks` has the program
//! read what they show, `reference` holds one of them to it. `cli`, `bad_input` and `run` start the real program in folders of their own, `workbench` in a pseudo-terminal. Tests that need the sample data beside the project
//! say so and pass where it is not there.

mod bad_input;
mod blocks;
mod chance;
mod claims;
mod cli;
mod comments;
mod documents;
mod doors;
mod durability;
mod engine;
mod figures;
mod fit;
mod fit_report;
mod golden;
mod grade;
mod keys;
mod outfit;
mod pattern_files;
mod pictures;
mod program;
mod reach;
mod readers;
mod reference;
mod report;
mod run;
mod seat;
mod specification;
mod structure;
mod tidy;
mod together;
mod tree;
mod wardrobe;
mod words;
mod workbench;
mod written;
