//! Clips: planes and how they combine.

use rara::glam::DVec3;
use rara::{Camera, Clip, ClipOp, Error, Plane, Result};

use crate::boundary::{RaraResult, Versioned, guard, invalid, list, read, write};
use crate::region::{self, RaraRegion};

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
    /// A region in place of planes; null, the default, for none. Only the call itself reads it.
    pub region: *const RaraRegion,
    /// The depth along the view axis, world units, from which on the scene is kept: a plane across the axis that moves with
    /// the camera and cuts every layer, whatever else cuts it, those with a clip of their own too. Splats are cut exactly, as
    /// by any other plane; RARA_MODE_NONE does not ask. Default: -INFINITY, for no such plane.
    pub clip_near: f64,
    /// The depth up to which the scene is kept, likewise. Default: INFINITY, for no such plane.
    pub clip_far: f64,
    /// The depth along the view axis, world units, from which on splats are drawn: those whose centres are nearer are left out
    /// whole. 0, the default, stands for 0.2 units of the scene, as in 3DGS.
    pub near_cut: f64,
}

// SAFETY: repr(C), numbers, pointers and a handle, the size first.
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
        region: std::ptr::null(),
        clip_near: f64::NEG_INFINITY,
        clip_far: f64::INFINITY,
        near_cut: 0.0,
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

/// What a frame keeps: a clip in the world, between planes that move with the camera.
pub(crate) struct FrameClip {
    pub(crate) clip: Clip,
    pub(crate) near: Option<f64>,
    pub(crate) far: Option<f64>,
    pub(crate) cut: Option<f64>,
}

/// All that a clip keeps.
impl From<Clip> for FrameClip {
    fn from(clip: Clip) -> Self {
        Self {
            clip,
            near: None,
            far: None,
            cut: None,
        }
    }
}

impl FrameClip {
    /// The camera with its planes and its near cut, and the clip.
    pub(crate) fn seen_by(self, camera: Camera) -> (Camera, Clip) {
        let camera = camera.clip_near(self.near).clip_far(self.far);
        (camera.near_cut(self.cut), self.clip)
    }
}

/// Reads a frame's clip.
///
/// # Safety
/// `clip` is null, or points to one whose planes are there.
pub(crate) unsafe fn kept(clip: *const RaraClip) -> Result<FrameClip> {
    if clip.is_null() {
        return Ok(Clip::default().into());
    }
    // SAFETY: the caller's promise.
    let given = unsafe { read(clip, RaraClip::WHOLE, "clip") }?;
    let depth = |depth: f64, none: f64, field: &str| {
        let is_none = depth == none;
        match is_none || depth.is_finite() {
            true => Ok((!is_none).then_some(depth)),
            false => invalid(format!(
                "clip->{field} is {depth}: give a depth, or for none what rara_clip_default sets"
            )),
        }
    };
    Ok(FrameClip {
        near: depth(given.clip_near, f64::NEG_INFINITY, "clip_near")?,
        far: depth(given.clip_far, f64::INFINITY, "clip_far")?,
        cut: depth(given.near_cut, 0.0, "near_cut")?,
        // SAFETY: as above.
        clip: unsafe { in_place(&given) }?,
    })
}

/// Reads a layer's clip.
///
/// # Safety
/// As for [`kept`].
pub(crate) unsafe fn clip(clip: *const RaraClip) -> Result<Clip> {
    // SAFETY: the caller's promise.
    let kept = unsafe { kept(clip) }?;
    if kept.near.is_some() || kept.far.is_some() || kept.cut.is_some() {
        return invalid(
            "clip->clip_near, clip_far and near_cut are the camera's, and a layer's clip stands in the scene: give them to \
             rara_renderer_configure",
        );
    }
    Ok(kept.clip)
}

/// What a clip keeps wherever the camera is.
///
/// # Safety
/// Its planes are there.
unsafe fn in_place(clip: &RaraClip) -> Result<Clip> {
    if let Some(region) = region::clip(clip.region, "clip->region")? {
        if clip.plane_count > 0 {
            return invalid(
                "clip->region and clip->planes are both given: make one region of them, or set plane_count to 0",
            );
        }
        return Ok(region);
    }
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

#[cfg(test)]
mod tests;
