//! The stages of the frame, one file each.

mod shaders;
