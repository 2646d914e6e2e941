//! Calls on a scene's layers.

use super::*;
use rara_c::clip::*;
use rara_c::layer::*;
use rara_c::layer_info::*;

/// # Safety
/// The handles are alive, and nobody else uses them; the scene is of one layer.
pub(super) unsafe fn what_is_wrong_is_said(
    device: *mut RaraDevice,
    gaussians: *mut RaraGaussians,
    scene: *mut RaraSceneBuffers,
) {
    let format = RARA_SH_FORMAT_FLOAT;
    // SAFETY: the caller's promises; every pointer below is alive, null, or to be overwritten.
    unsafe {
        let mut layer: RaraLayer = std::mem::zeroed();
        let size = size_of_val(&layer);
        let filled = rara_layer_default(&mut layer, size, c"mine".as_ptr(), gaussians);
        assert_ok(filled);
        let mut other = null_mut();
        let mut upload = |layers: *const RaraLayer, count, format| {
            let result = rara_scene_buffers_upload(device, layers, count, format, &mut other);
            assert!(other.is_null());
            result
        };
        let failed = upload(&layer, 0, format);
        assert_fails(failed, RARA_ERROR_INVALID, "layer_count is 0");
        let failed = upload(null(), 1, format);
        assert_fails(failed, RARA_ERROR_INVALID, "layers is null");
        let failed = upload(&layer, 1, 4);
        assert_fails(failed, RARA_ERROR_INVALID, "sh_format 4");
        let mut state: RaraLayerState = std::mem::zeroed();
        let size = size_of_val(&state);
        assert_ok(rara_layer_state_default(&mut state, size));
        state.opacity = 1.1;
        layer.state = &state;
        let failed = upload(&layer, 1, format);
        let says = "layers[0].state: the opacity of layer 'mine' is 1.1; give 0 to 1";
        assert_fails(failed, RARA_ERROR_INVALID, says);

        assert_eq!(rara_scene_buffers_layer_count(scene), 1);
        let mut info: RaraLayerInfo = std::mem::zeroed();
        let info_size = size_of_val(&info);
        let result = rara_scene_buffers_layer_info(scene, 0, &mut info, info_size);
        assert_ok(result);
        assert_eq!((CStr::from_ptr(info.name), info.count), (c"scene", 1));
        let beyond = "index is 1, and rara_scene_buffers_layer_count is 1: give less than that";
        let failed = rara_scene_buffers_layer_info(scene, 1, &mut info, info_size);
        assert_fails(failed, RARA_ERROR_INVALID, beyond);
        let failed = rara_scene_buffers_layer_info(scene, 0, &mut info, 3);
        assert_fails(failed, RARA_ERROR_INVALID, "sizeof(RaraLayerInfo)");
        let failed = rara_scene_buffers_layer_state(scene, 1, &mut state, size);
        assert_fails(failed, RARA_ERROR_INVALID, beyond);
        let failed = rara_scene_buffers_layer_state(scene, 0, null_mut(), size);
        assert_fails(failed, RARA_ERROR_INVALID, "state is null");

        let set = |index, state: *const RaraLayerState| {
            rara_scene_buffers_set_layer_state(scene, index, state)
        };
        let clip = clip_of(&[]);
        rara_clip_destroy(clip);
        let failed = rara_scene_buffers_set_layer_clip(scene, 0, clip);
        assert_fails(
            failed,
            RARA_ERROR_INVALID,
            "clip is no RaraClip that is alive",
        );
        let mut index = 7;
        let failed = rara_scene_buffers_layer_by_name(scene, c"skin".as_ptr(), &mut index);
        assert_fails(
            failed,
            RARA_ERROR_INVALID,
            "no layer is called 'skin'; there is 'scene'",
        );
        assert_eq!(index, 7, "left alone");
        assert_ok(rara_scene_buffers_layer_by_name(
            scene,
            c"scene".as_ptr(),
            &mut index,
        ));
        assert_eq!(index, 0);
        let failed = rara_scene_buffers_set_layer_clip(scene, 1, null());
        assert_fails(failed, RARA_ERROR_INVALID, beyond);
        let failed = set(0, &state);
        let says = "state: the opacity of layer 'scene' is 1.1; give 0 to 1";
        assert_fails(failed, RARA_ERROR_INVALID, says);
        let failed = set(0, null());
        assert_fails(failed, RARA_ERROR_INVALID, "state is null");
        state.opacity = 0.5;
        let failed = set(1, &state);
        assert_fails(failed, RARA_ERROR_INVALID, beyond);
        state.placement.rotation = [0.0; 4];
        let failed = set(0, &state);
        assert_fails(failed, RARA_ERROR_INVALID, "its rotation cannot be zero");
        state.struct_size = 3;
        let failed = set(0, &state);
        assert_fails(failed, RARA_ERROR_INVALID, "state->struct_size is 3");
        // The state is the one from before.
        assert_ok(rara_scene_buffers_layer_state(scene, 0, &mut state, size));
        assert_eq!(state, rara::LayerState::default().into());
    }
}
