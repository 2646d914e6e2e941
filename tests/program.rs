//! The tests of the program `rara` in one executable: the command, and the window.

#[path = "common/folder.rs"]
mod folder;
#[path = "common/output.rs"]
mod output;

mod cli;
mod view;
