//! The region's answers, made from those of its surfaces.

use super::Side;
use rara_scene::clip::{Clip, ClipOp, Surface};

/// The region's side of something, from its surfaces' sides. No intersection holds what one surface drops, and every union
/// holds what one keeps, whatever the others say; else it is cut where one of them cuts it.
pub(super) fn combined(clip: &Clip, side: &dyn Fn(&Surface) -> Side) -> Side {
    let (decides, undecided) = match clip.op {
        ClipOp::And => (Side::Invisible, Side::Visible),
        ClipOp::Or => (Side::Visible, Side::Invisible),
    };
    let surfaces = clip.surfaces.iter().map(side);
    let parts = clip.parts.iter().map(|part| combined(part, side));
    let mut answer = undecided;
    for one in surfaces.chain(parts) {
        if one == decides {
            return one;
        }
        if one == Side::Cutoff {
            answer = one;
        }
    }
    answer
}

/// True when an intersection or a union keeps a point; `kept` says which of its surfaces keep it.
pub(crate) fn keeps(op: ClipOp, mut kept: impl Iterator<Item = bool>) -> bool {
    match op {
        ClipOp::And => kept.all(|k| k),
        ClipOp::Or => kept.any(|k| k),
    }
}
