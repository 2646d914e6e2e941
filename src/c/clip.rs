//! Clips: planes and how they combine.

use rara::glam::DVec3;
use rara::{Clip, ClipOp, Error, Plane, Result};

use crate::boundary::{RaraResult, Versioned, guard, invalid, list, read, write};

/// A half-space: the points x with normal . x + offset >= 0 are visible. The normal need not have length one, but must
/// not be zero. It never grows.
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
    /// Set by rara_clip_default.
    pub struct_size: usize,
    /// The half-spaces; only the call itself reads them.
    pub planes: *const RaraPlane,
    /// How many planes there are, at most 32. With 0, the default, they keep everything.
    pub plane_count: usize,
    /// How they combine. Default: RARA_CLIP_OP_AND.
    pub op: RaraClipOp,
}

// SAFETY: repr(C), numbers and pointers, the size first.
unsafe impl Versioned for RaraClip {
    const NAME: &'static str = "RaraClip";
}

impl RaraClip {
    /// Everything.
    pub(crate) const WHOLE: Self = Self {
        struct_size: size_of::<Self>(),
        planes: std::ptr::null(),
        plane_count: 0,
        op: RARA_CLIP_OP_AND,
    };
}

/// A clip that keeps everything. `clip_size` is sizeof *clip.
///
/// # Safety
/// `clip` has room for `clip_size` bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_clip_default(clip: *mut RaraClip, clip_size: usize) -> RaraResult {
    // SAFETY: the caller's promise.
    guard(|| unsafe { write(clip, clip_size, &RaraClip::WHOLE, "clip") })
}

/// # Safety
/// `clip` is null, or points to one whose planes are there.
pub(crate) unsafe fn clip(clip: *const RaraClip) -> Result<Clip> {
    if clip.is_null() {
        return Ok(Clip::default());
    }
    // SAFETY: the caller's promise.
    let clip = unsafe { read(clip, RaraClip::WHOLE, "clip") }?;
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
