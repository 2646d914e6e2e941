//! `rara.h` and the library behind it: the header itself, what a host does wrong and right, hosts in C++ and in C,
//! what tools/install-c installs, and the log.

#[path = "../common/canvas/mod.rs"]
mod canvas;
mod compiler;
#[path = "../common/folder.rs"]
mod folder;

mod c_host;
mod calls;
mod clips;
mod cpp_host;
mod frame_lines;
mod frames;
mod header;
mod install;
mod layer;
mod layouts;
mod logging;
mod results;
