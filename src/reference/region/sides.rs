//! The region's answers, made from those of its surfaces.

use super::Side;
use crate::ClipOp;

/// The region's side of something, from its surfaces' sides. No intersection holds what one surface drops, and every union
/// holds what one keeps, whatever the others say; else it is cut where one of them cuts it.
pub(super) fn combined(op: ClipOp, sides: impl Iterator<Item = Side>) -> Side {
    let (decides, undecided) = match op {
        ClipOp::And => (Side::Invisible, Side::Visible),
        ClipOp::Or => (Side::Visible, Side::Invisible),
    };
    let mut side = undecided;
    for one in sides {
        if one == decides {
            return one;
        }
        if one == Side::Cutoff {
            side = one;
        }
    }
    side
}

/// True when the region keeps a point; `kept` says which of its surfaces keep it.
pub(in crate::reference) fn keeps(op: ClipOp, mut kept: impl Iterator<Item = bool>) -> bool {
    match op {
        ClipOp::And => kept.all(|k| k),
        ClipOp::Or => kept.any(|k| k),
    }
}
