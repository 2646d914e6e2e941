//! The layer that a set of Gaussians is.

use rara_c::gaussians::RaraGaussians;
use rara_c::layer::*;

use crate::results::assert_ok;

pub(crate) fn one_layer(gaussians: *mut RaraGaussians) -> RaraLayer {
    // SAFETY: the struct may hold any bytes, and has the room that the call is given.
    unsafe {
        let mut layer: RaraLayer = std::mem::zeroed();
        let (size, name) = (size_of_val(&layer), c"scene".as_ptr());
        assert_ok(rara_layer_default(&mut layer, size, name, gaussians));
        layer
    }
}
