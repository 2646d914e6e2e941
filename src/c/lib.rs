//! rara for C and C++: the functions and structs of `rara.h`, which `cbindgen` makes of this crate.
//!
//! Names are those of the Rust crate with a prefix: [`Renderer`](rara::Renderer) is `RaraRenderer`. Nothing is decided
//! here: a function checks what it was given, translates it, and calls its namesake. [`boundary`] is where panics end,
//! where errors become codes, and where structs of other versions are read.
//!
//! # Safety
//! Every function asks for this: pointers that go in are null where that is allowed, or point to what their types say, as
//! many values as the count beside them says; strings end in NUL; what a call fills may be overwritten, and a `..._size` is
//! its room in bytes. A function that asks for more says so.

// The promises are said above, and nearly all that a function does relies on them.
#![allow(clippy::missing_safety_doc, unsafe_op_in_unsafe_fn)]

#[cfg(not(panic = "unwind"))]
compile_error!("rara-c stops panics at its boundary, and needs panic = \"unwind\" for that");

pub mod arrays;
pub mod bake;
pub mod boundary;
pub mod camera;
pub mod camera_files;
pub mod channels;
pub mod clip;
pub mod cut;
pub mod depth;
pub mod device;
pub mod editor;
pub mod frame;
pub mod gaussians;
mod handles;
pub mod layer;
pub mod layer_info;
pub mod layers;
pub mod lent;
pub mod load;
pub mod logging;
pub mod matrices;
mod names;
mod numbering;
pub mod picker;
pub mod placement;
pub mod renderer;
pub mod renderer_desc;
pub mod reserve;
pub mod scene;
pub mod selection;
pub mod settings;
pub mod shots;
pub mod staging;
pub mod stats;
pub mod support;
#[cfg(test)]
mod tests;
mod text;
pub mod upload;
