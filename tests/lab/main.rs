//! The laboratory as people use it: its program, and a participant who answers the user study in a browser.

mod browser;
#[path = "../common/folder.rs"]
mod folder;
#[path = "../common/output.rs"]
mod output;
mod program;
mod study;
