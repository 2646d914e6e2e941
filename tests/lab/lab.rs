//! The laboratory as people use it: a participant answers the user study in a browser.

mod browser;
#[path = "../common/folder.rs"]
mod folder;
mod study;
