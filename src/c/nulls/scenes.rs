//! Calls on scenes, layers, selections and regions.

use super::*;

pub(super) fn calls(called: &mut Vec<Called>) {
    let no_cmd = vk::CommandBuffer::null();
    macro_rules! call {
        ($($call:tt)*) => { call_in!(called, $($call)*); };
    }
    call!(rara_gaussians_load(null(), null_mut()), "gaussians is null");
    call!(
        rara_gaussians_load_from(null(), 0, null(), null_mut()),
        "gaussians is null"
    );
    call!(
        rara_gaussian_arrays_default(null_mut(), size_of::<RaraGaussianArrays>()),
        "arrays is null"
    );
    call!(
        rara_gaussians_from_arrays(null(), null_mut()),
        "gaussians is null"
    );
    call!(
        rara_gaussians_append(null_mut(), null()),
        "gaussians is null"
    );
    call!(
        rara_gaussians_info(null(), null_mut(), 0),
        "gaussians is null"
    );
    call!(
        rara_gaussians_set_antialiased(null_mut(), 0),
        "gaussians is null"
    );
    call!(
        rara_scene_buffers_upload(null(), null(), 0, null_mut()),
        "scene is null"
    );
    call!(
        rara_scene_buffers_staging_bytes(null(), 0, null_mut()),
        "bytes is null"
    );
    call!(
        rara_scene_buffers_upload_with(null(), no_cmd, null(), null(), 0, null_mut()),
        "scene is null"
    );
    call!(
        rara_staging_default(null_mut(), size_of::<RaraStaging>()),
        "staging is null"
    );
    call!(
        rara_clip_default(null_mut(), size_of::<RaraClip>()),
        "clip is null"
    );
    call!(
        rara_layer_state_default(null_mut(), size_of::<RaraLayerState>()),
        "state is null"
    );
    call!(
        rara_layer_default(null_mut(), size_of::<RaraLayer>(), null(), null()),
        "layer is null"
    );
    call!(
        rara_scene_buffers_upload_layers(null(), null(), 0, 0, null_mut()),
        "scene is null"
    );
    call!(
        rara_scene_buffers_staging_bytes_of_layers(null(), 0, 0, null_mut()),
        "bytes is null"
    );
    call!(
        rara_scene_buffers_upload_layers_with(null(), no_cmd, null(), null(), 0, 0, null_mut()),
        "scene is null"
    );
    call!(
        rara_scene_buffers_layer_info(null(), 0, null_mut(), 0),
        "scene is null"
    );
    call!(
        rara_scene_buffers_layer_state(null(), 0, null_mut(), 0),
        "scene is null"
    );
    call!(
        rara_scene_buffers_set_layer_state(null_mut(), 0, null()),
        "scene is null"
    );
    call!(
        rara_scene_buffers_set_layer_clip(null_mut(), 0, null()),
        "scene is null"
    );
    call!(
        rara_scene_buffers_layer_by_name(null(), null(), null_mut()),
        "scene is null"
    );
    call!(
        rara_scene_buffers_set_layer_region(null_mut(), 0, null()),
        "scene is null"
    );
    call!(rara_region_parse(null(), null_mut()), "region is null");
    call!(
        rara_region_from_json(null(), 0, null(), null_mut()),
        "region is null"
    );
    call!(
        rara_region_load(null(), null(), null_mut()),
        "region is null"
    );
    call!(
        rara_region_keeps(null(), null(), null_mut()),
        "kept is null"
    );
    call!(
        rara_renderer_configure_region(null_mut(), null(), null(), 0, null(), null(), null_mut()),
        "frame is null"
    );
    call!(
        rara_bake_settings_default(null_mut(), size_of::<RaraBakeSettings>()),
        "settings is null"
    );
    call!(
        rara_gaussians_bake(null(), null(), null(), null_mut(), null_mut(), 0),
        "baked is null"
    );
    call!(
        rara_gaussians_load_with(null(), null(), 0, null_mut()),
        "gaussians is null"
    );
    call!(
        rara_gaussians_load_from_with(null(), 0, null(), null(), 0, null_mut()),
        "gaussians is null"
    );
    call!(
        rara_gaussians_set_property(null_mut(), null(), null(), 0),
        "gaussians is null"
    );
    call!(
        rara_gaussians_select(null_mut(), null(), null(), null_mut()),
        "taken is null"
    );
}
