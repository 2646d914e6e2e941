//! Clips as a host fills them.

use crate::results::assert_ok;
use rara_c::clip::*;

/// A clip of planes that all keep what is kept, which it points to.
pub(crate) fn clip_of(planes: &[RaraPlane]) -> RaraClip {
    // SAFETY: the struct may hold any bytes, and has the room that the call is given.
    let mut clip = unsafe {
        let mut clip: RaraClip = std::mem::zeroed();
        assert_ok(rara_clip_default(&mut clip, size_of_val(&clip)));
        clip
    };
    (clip.planes, clip.plane_count) = (planes.as_ptr(), planes.len());
    clip
}
