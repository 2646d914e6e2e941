//! `rara.h` and the library behind it: the header itself, what a host does wrong and right, a host in C++,
//! and what tools/install-c installs.

#[path = "../common/canvas/mod.rs"]
mod canvas;
mod compiler;
#[path = "../common/folder.rs"]
mod folder;
#[path = "../../tools/examples/host.rs"]
#[allow(dead_code, reason = "its frames are for the hosts that draw")]
mod host;

mod calls;
mod clips;
mod cpp_host;
mod frames;
mod header;
mod install;
mod layer;
mod layouts;
mod results;
