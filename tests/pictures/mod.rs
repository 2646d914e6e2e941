//! Pictures: against the reference, and against the same picture drawn in other ways; and the memory that they take.

mod accuracy;
mod agreement;
mod aov;
mod bake;
mod camera_planes;
mod classification;
mod curves;
mod debug_view;
mod determinism;
mod invariance;
mod large;
mod layers;
mod light;
mod memory;
mod orthographic;
mod paper;
mod picking;
mod pipeline_cache;
mod precision;
mod quadrature;
mod reuse;
mod shapes;
mod shortlists;
mod slices;
mod stress;
mod trained;
