//! Clips of a host's planes.

use std::ptr::null_mut;

use rara_c::clip::*;

use crate::results::assert_ok;

/// A clip that keeps what is on the visible side of all planes.
pub(crate) fn clip_of(planes: &[RaraPlane]) -> *mut RaraClip {
    let mut clip = null_mut();
    // SAFETY: the planes are there, and the pointer may be overwritten.
    assert_ok(unsafe {
        rara_clip_of_planes(planes.as_ptr(), planes.len(), RARA_CLIP_OP_AND, &mut clip)
    });
    clip
}
