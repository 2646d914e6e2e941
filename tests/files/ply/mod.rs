//! Reading and writing `.ply` scenes: what must load, what must be refused with a sentence, and that nothing panics.

mod accepted;
mod collected;
pub(crate) mod made;
mod mutated;
mod properties;
mod refused;
