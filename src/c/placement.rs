//! The placement of a scene in the host's world.

use rara::glam::{DQuat, DVec3};
use rara::{Placement, Result};

use crate::boundary::{RaraResult, guard, shared};
use crate::handles::alone;
use crate::renderer::RaraRenderer;

/// The placement of a scene in a world: its points are scaled, then turned, then moved. {{0, 0, 0}, {0, 0, 0, 1}, 1}
/// leaves it where it was made. It never grows.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RaraPlacement {
    /// The position of the scene's origin, world units.
    pub position: [f64; 3],
    /// How it is turned: a quaternion x, y, z, w, of any length but zero.
    pub rotation: [f64; 4],
    /// How many world units one unit of the scene is, above zero.
    pub scale: f64,
}

impl From<Placement> for RaraPlacement {
    fn from(placement: Placement) -> Self {
        Self {
            position: placement.position().into(),
            rotation: placement.rotation().into(),
            scale: placement.scale(),
        }
    }
}

impl RaraPlacement {
    pub(crate) fn placement(&self) -> Result<Placement> {
        let rotation = DQuat::from_array(self.rotation);
        Placement::new(DVec3::from(self.position), rotation, self.scale)
    }
}

/// Sets where the scene stands, from the next rara_renderer_configure on; camera, clip, depth map and expected depths are
/// the world's. Until this is called the scene stands where it was made. RARA_ERROR_INVALID for numbers that are not
/// finite, a scale that is not above zero and a rotation of zero; the placement then stays as it was.
///
/// The picture is that of the placed Gaussians, spherical harmonics turn with the scene, and no Gaussian is touched: a
/// scene can be moved in every frame, and one RaraSceneBuffers can be drawn in several places, by a renderer each. All
/// lengths are then in the scene's units, also the depth of 0.2 below which centres are culled where RaraCamera::near_cut
/// says no other, in world units.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_renderer_set_placement(
    renderer: *mut RaraRenderer,
    placement: *const RaraPlacement,
) -> RaraResult {
    guard(|| {
        let mut renderer = alone(renderer, "renderer")?;
        let placement = shared(placement, "placement")?.placement()?;
        renderer.0.set_placement(placement);
        Ok(())
    })
}
