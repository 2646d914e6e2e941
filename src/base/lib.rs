//! The crate that all others of rara use: errors, files, statistics, and the numbers that host and shaders share.
//!
//! Applications use the crate `rara`, which shows what of this is meant for them; the rest may change with any version.

#![forbid(unsafe_code)]

pub mod counted;
pub mod error;
pub mod files;
pub mod fnv;
#[cfg(feature = "json")]
pub mod json;
pub mod limits;
pub mod parallel;
mod rows;
mod setters;
pub mod stats;
pub mod value;

/// The text of `limits.rs`, of which the build of rara makes GLSL.
#[doc(hidden)]
pub const LIMITS: &str = include_str!("limits.rs");
