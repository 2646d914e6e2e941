//! rara
fn main() {}
