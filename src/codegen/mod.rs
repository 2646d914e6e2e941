//! The code that build.rs generates: Rust constants, structs and the interface of every shader from `glsl/`, and links to
//! pictures for the documentation. This module is compiled into the build script, and into the crate's tests.

pub(crate) mod glsl;
pub(crate) mod interface;
pub(crate) mod manifest;
pub(crate) mod pictures;
pub(crate) mod spirv;

#[cfg(feature = "shaderc")]
#[cfg(not(test))]
pub(crate) mod compile;

/// The ways in which a shader reaches its buffers: ending of the SPIR-V's file name, and preprocessor definition.
pub(crate) const VARIANTS: [(&str, Option<&str>); 3] = [
    ("address", None),
    ("bound", Some("RARA_BOUND")),
    ("mixed", Some("RARA_MIXED")),
];
