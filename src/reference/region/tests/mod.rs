//! Twins of shaders that no other twin needs, with their tests.

mod tile_combination;
mod tile_side;
