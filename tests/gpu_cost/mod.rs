//! What frames cost a GPU, as far as it can be known without one: the commands that a frame records, and what a GPU's
//! compiler makes of its pipelines. `budget.toml` says how much each may
//! have, so that a change that costs more has to change that file too. The same frames are recorded to see that no barrier is missing.
//!
//! The compiler is Mesa's for AMD, RADV, on devices that the library of the package mesa-drm-shim pretends there are. It
//! compiles as for real ones; what it draws there means nothing, and nothing here looks at pictures or times.

mod budget;
mod commands;
mod frames;
mod hazards;
mod pipelines;
