//! Stage `compact`: the Gaussians that are drawn, in the scene's order.

use super::region::Side;

/// Indices of the visible and the cut Gaussians, in the scene's order.
pub fn compact(sides: &[Side]) -> Vec<u32> {
    (0_u32..)
        .zip(sides)
        .filter(|(_, side)| matches!(side, Side::Visible | Side::Cutoff))
        .map(|(index, _)| index)
        .collect()
}
