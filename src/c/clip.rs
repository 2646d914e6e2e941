//! Clips: planes and how they combine.

use rara::glam::DVec3;
use rara::{Clip, ClipOp, Error, Plane, Result};

use crate::boundary::{invalid, list};

/// A half-space: the points x with normal . x + offset >= 0 are visible. The normal need not have length one, but must
/// not be zero.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RaraPlane {
    /// Points to the visible side.
    pub normal: [f64; 3],
    /// World units times the normal's length.
    pub offset: f64,
}

/// How several planes combine.
pub type RaraClipOp = u32;
/// Visible where every plane keeps it.
pub const RARA_CLIP_OP_AND: RaraClipOp = 0;
/// Visible where any plane keeps it.
pub const RARA_CLIP_OP_OR: RaraClipOp = 1;

/// The region that stays visible. Where a function takes one, null means everything.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct RaraClip {
    /// The half-spaces; only the call itself reads them.
    pub planes: *const RaraPlane,
    /// How many planes there are, at most 32. With 0 everything is visible.
    pub plane_count: usize,
    /// How they combine.
    pub op: RaraClipOp,
}

/// # Safety
/// `clip` is null, or points to one whose planes are there.
pub(crate) unsafe fn clip(clip: *const RaraClip) -> Result<Clip> {
    // SAFETY: the caller's promise.
    let Some(clip) = (unsafe { clip.as_ref() }) else {
        return Ok(Clip::default());
    };
    if clip.plane_count > Clip::MAX_SURFACES {
        return invalid(format!(
            "clip->plane_count is {}, and a clip has at most {} planes",
            clip.plane_count,
            Clip::MAX_SURFACES
        ));
    }
    // SAFETY: the caller's promise.
    let planes = unsafe { list(clip.planes, clip.plane_count, "clip->planes") }?;
    let plane = |(index, plane): (usize, &RaraPlane)| {
        let made = Plane::new(DVec3::from(plane.normal), plane.offset);
        made.map_err(|error| Error::Invalid(format!("clip->planes[{index}]: {error}")))
    };
    let planes: Vec<_> = (planes.iter().enumerate().map(plane)).collect::<Result<_>>()?;
    let op = match clip.op {
        RARA_CLIP_OP_AND => ClipOp::And,
        RARA_CLIP_OP_OR => ClipOp::Or,
        other => return invalid(format!("clip->op {other} is no RaraClipOp")),
    };
    Ok(Clip::of(planes, op))
}
