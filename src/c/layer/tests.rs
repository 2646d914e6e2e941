//! Mistakes in lists of layers.

use std::ptr::null;

use super::*;
use crate::boundary::*;
use crate::gaussians::*;
use crate::scene::*;
use crate::tests::assert_fails;
use crate::upload::*;

/// Bytes of staging memory that layers need: a call that reads them without a device.
///
/// # Safety
/// `layers` is null, or points to `count` layers that are as their fields say.
unsafe fn staging(layers: *const RaraLayer, count: usize, bytes: &mut u64) -> RaraResult {
    let format = RARA_SH_FORMAT_HALF;
    // SAFETY: the caller's promise.
    unsafe { rara_scene_buffers_staging_bytes(layers, count, format, bytes) }
}

/// Gaussians as C has them.
fn handle(gaussians: rara::Gaussians) -> *mut RaraGaussians {
    crate::handles::add(RaraGaussians::from(gaussians)).expect("a number")
}

#[test]
fn layers() {
    let gaussians = |count| rara::scene::generate(rara::scene::Kind::General, count, 1);
    let (first, second) = (gaussians(300), gaussians(20));
    let handles = [handle(first.clone()), handle(second.clone())];
    let mut bytes = 0;
    // SAFETY: strings that end in NUL, handles that are alive, and as many structs as the counts say; they may hold any
    // bytes.
    unsafe {
        assert_fails(
            staging(null(), 0, &mut bytes),
            RARA_ERROR_INVALID,
            "layer_count is 0, and a scene has at least one layer: give one or more",
        );
        let nothing = staging(null(), 2, &mut bytes);
        assert_fails(nothing, RARA_ERROR_INVALID, "layers is null");
        let mut state: RaraLayerState = std::mem::zeroed();
        let state_size = size_of_val(&state);
        assert_eq!(rara_layer_state_default(&mut state, state_size), RARA_OK);
        assert_eq!(state, rara::LayerState::default().into());
        let mut layers: [RaraLayer; 2] = std::mem::zeroed();
        let size = size_of::<RaraLayer>();
        let named = [(c"one", handles[0]), (c"two", handles[1])];
        for (layer, (name, gaussians)) in layers.iter_mut().zip(named) {
            let filled = rara_layer_default(layer, size, name.as_ptr(), gaussians);
            assert_eq!((filled, layer.state), (RARA_OK, null()));
        }
        let usual = layers;
        let refused = |layers: &[RaraLayer; 2], part: &str| {
            let result = staging(layers.as_ptr(), layers.len(), &mut 0);
            assert_fails(result, RARA_ERROR_INVALID, part);
        };
        assert_eq!(staging(layers.as_ptr(), 2, &mut bytes), RARA_OK);
        let scene = rara::Scene::from_iter([
            rara::Layer::new("one", &first),
            rara::Layer::new("two", &second),
        ]);
        let truth = rara::SceneBuffers::staging_bytes(scene, rara::ShFormat::Half);
        assert_eq!(bytes, truth);
        layers[1].room = 700;
        assert_eq!(staging(layers.as_ptr(), 2, &mut bytes), RARA_OK);
        let scene = rara::Scene::from_iter([
            rara::Layer::new("one", &first),
            rara::Layer::new("two", &second).with_room(700),
        ]);
        let truth = rara::SceneBuffers::staging_bytes(scene, rara::ShFormat::Half);
        assert_eq!(bytes, truth);
        layers = usual;

        layers[1].name = null();
        refused(&layers, "layers[1].name is null");
        layers[1].name = c"\xff".as_ptr();
        refused(&layers, "layers[1].name is not UTF-8");
        layers = usual;
        layers[0].gaussians = null();
        refused(&layers, "layers[0].gaussians is null");
        layers[1].gaussians = handle(gaussians(3));
        rara_gaussians_destroy(layers[1].gaussians.cast_mut());
        refused(&layers, "layers[0].gaussians is null");
        layers[0].gaussians = handles[0];
        refused(
            &layers,
            "layers[1].gaussians is no RaraGaussians that is alive: it was destroyed",
        );
        layers = usual;
        layers[1].state = &state;
        assert_eq!(staging(layers.as_ptr(), 2, &mut bytes), RARA_OK);
        for opacity in [-0.1, 1.5, f32::NAN] {
            let state = RaraLayerState { opacity, ..state };
            layers[1].state = &state;
            let says =
                format!("layers[1].state: the opacity of layer 'two' is {opacity}; give 0 to 1");
            refused(&layers, &says);
        }
        let mut nowhere = state;
        nowhere.placement.scale = 0.0;
        layers[1].state = &nowhere;
        refused(&layers, "layers[1].state: a scene cannot be placed so");
        let larger = RaraLayerState {
            struct_size: state_size + 8,
            ..state
        };
        layers[1].state = &larger;
        refused(&layers, "layers[1].state->struct_size is ");
        for handle in handles {
            rara_gaussians_destroy(handle);
        }
    }
}

#[test]
fn lists_of_structs_of_other_versions() {
    let gaussians = handle(Default::default());
    let name = c"a layer".as_ptr();
    let ours = size_of::<RaraLayer>();
    // An older host, whose struct ended before `state`.
    let older = std::mem::offset_of!(RaraLayer, state);
    let mut bytes = 0;
    // SAFETY: the bytes are aligned as the struct and as many as its size says; the struct may hold any bytes.
    unsafe {
        let mut room: [RaraLayer; 3] = std::mem::zeroed();
        let at = |room: &mut [RaraLayer; 3], index: usize, size: usize| {
            room.as_mut_ptr().byte_add(index * size)
        };
        for index in 0..3 {
            let layer = at(&mut room, index, older);
            assert_eq!(rara_layer_default(layer, older, name, gaussians), RARA_OK);
        }
        assert_eq!(staging(room.as_ptr(), 3, &mut bytes), RARA_OK);
        // Layers of one array, but of two versions.
        (*at(&mut room, 2, older)).struct_size = ours;
        let result = staging(room.as_ptr(), 3, &mut bytes);
        let says =
            format!("layers[2].struct_size is {ours}, and layers[0].struct_size is {older}:");
        assert_fails(result, RARA_ERROR_INVALID, &says);
        for size in [0, 1, ours - 1, ours + 8, usize::MAX] {
            room[0].struct_size = size;
            let result = staging(room.as_ptr(), 3, &mut bytes);
            let says = format!("layers[0].struct_size is {size}, ");
            assert_fails(result, RARA_ERROR_INVALID, &says);
        }
        room[0].struct_size = ours;
        let result = staging(room.as_ptr(), usize::MAX, &mut bytes);
        assert_fails(result, RARA_ERROR_INVALID, "more than memory holds");
        rara_gaussians_destroy(gaussians);
    }
}
