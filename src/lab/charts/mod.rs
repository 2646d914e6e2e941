//! Charts as SVG documents, for reports. Each is described by a struct and drawn by its `svg`.
//!
//! Values that are not finite are missing: they are left out. Colours can be told apart by people who are colour-blind,
//! and markers differ in shape as well.

mod axis;
mod canvas;
mod heat_map;
mod plot;
mod radar;
#[cfg(test)]
mod test;
mod violins;

pub use axis::Axis;
pub use heat_map::HeatMap;
pub use plot::{Plot, Series};
pub use radar::Radar;
pub use violins::Violins;
