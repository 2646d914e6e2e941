//! Measures of the whole process, in which nothing else may run: its memory, and who allocates.

mod recording;
mod soak;
