//! The functions of `rara.h` on a device: whatever a host does wrong there has a message, and so has a lost device.
//! `tests/c/cpp_host.rs` and `tests/c/frames` draw what a host does right.

mod ended;
mod layers;
mod lost;

use std::ffi::{CStr, c_void};
use std::ptr::{null, null_mut};

use crate::canvas::host::Host;
use crate::canvas::{ONE_PIXEL, open_host};
use crate::clips::clip_of;
use crate::layer::one_layer;
use crate::results::{assert_fails, assert_ok};
use rara::ash::{Entry, vk};
use rara_c::boundary::*;
use rara_c::camera::*;
use rara_c::clip::*;
use rara_c::depth::*;
use rara_c::device::*;
use rara_c::frame::*;
use rara_c::gaussians::*;
use rara_c::load::*;
use rara_c::renderer::*;
use rara_c::renderer_desc::*;
use rara_c::scene::*;
use rara_c::stats::*;
use rara_c::support::*;
use rara_c::upload::*;

const FORMAT: vk::Format = vk::Format::R16G16B16A16_SFLOAT;

/// A scene of one Gaussian.
const SCENE: &[u8] =
    b"ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z
property float f_dc_0\nproperty float f_dc_1\nproperty float f_dc_2\nproperty float opacity
property float scale_0\nproperty float scale_1\nproperty float scale_2
property float rot_0\nproperty float rot_1\nproperty float rot_2\nproperty float rot_3\nend_header
0 0 0 1 1 1 2 -1 -1 -1 1 0 0 0\n";

fn host() -> Host {
    open_host(FORMAT, ONE_PIXEL, false)
}

#[test]
fn what_is_wrong_is_said() {
    let host = host();
    let ours = host.lend();
    // SAFETY: the system's loader; every handle and pointer below is alive, null, or to be overwritten.
    unsafe {
        let entry = Entry::load().expect("a Vulkan loader");
        let loader = entry.static_fn().get_instance_proc_addr;
        let mut support: RaraSupport = std::mem::zeroed();
        let size = size_of_val(&support);
        let (instance, physical) = (ours.instance.handle(), ours.physical_device);
        let version = ours.api_version;
        let check = |physical, support: &mut RaraSupport| {
            rara_check(Some(loader), instance, physical, version, support, size)
        };
        let nothing = check(vk::PhysicalDevice::null(), &mut support);
        assert_fails(nothing, RARA_ERROR_INVALID, "physical_device is null");
        assert_ok(check(physical, &mut support));
        assert_eq!(support.struct_size, size);
        for name in &support.extensions[..support.extension_count as usize] {
            assert!(CStr::from_ptr(*name).to_bytes().starts_with(b"VK_"));
        }
        let mut vulkan12 = vk::PhysicalDeviceVulkan12Features::default().timeline_semaphore(true);
        let mut vulkan13 = vk::PhysicalDeviceVulkan13Features::default();
        let nothing = rara_support_features(&support, null_mut());
        assert_fails(nothing, RARA_ERROR_INVALID, "bufferDeviceAddress");
        let chain = (&raw mut vulkan12).cast::<c_void>();
        let half = rara_support_features(&support, chain);
        assert_fails(half, RARA_ERROR_INVALID, "synchronization2");
        vulkan12.p_next = (&raw mut vulkan13).cast();
        assert_ok(rara_support_features(&support, chain));
        assert_eq!(
            vulkan12.buffer_device_address + vulkan12.timeline_semaphore,
            2
        );
        assert_eq!(vulkan13.synchronization2 + vulkan13.dynamic_rendering, 2);
        assert_eq!(vulkan13.maintenance4, vk::FALSE, "not asked for");
        let mut sizes = vk::PhysicalDeviceSubgroupSizeControlFeatures::default();
        vulkan13.p_next = (&raw mut sizes).cast();
        assert_ok(rara_support_features(&support, chain));
        for of_sizes in [
            vulkan13.subgroup_size_control,
            vulkan13.compute_full_subgroups,
            sizes.subgroup_size_control,
            sizes.compute_full_subgroups,
        ] {
            assert_eq!(of_sizes, support.full_subgroups, "where they are offered");
        }

        let mut desc: RaraAdoptDesc = std::mem::zeroed();
        assert_ok(rara_adopt_desc_default(&mut desc, size_of_val(&desc)));
        desc.get_instance_proc_addr = Some(loader);
        (desc.instance, desc.physical_device) = (instance, physical);
        desc.queue_family = ours.queue_family;
        assert_eq!(desc.api_version, version);
        let mut device = null_mut();
        let failed = rara_device_adopt(&desc, &mut device);
        assert_fails(failed, RARA_ERROR_INVALID, "desc->device is null");
        (desc.device, desc.queue) = (ours.device.handle(), ours.queue);
        if support.mesh_shader != 0 {
            desc.mesh_shader = vk::TRUE; // the host has not enabled it
            let failed = rara_device_adopt(&desc, &mut device);
            assert_fails(failed, RARA_ERROR_INVALID, "without VK_EXT_mesh_shader");
            desc.mesh_shader = vk::FALSE;
        }
        desc.api_version = vk::API_VERSION_1_2; // this version needs extensions that this host has not enabled
        let failed = rara_device_adopt(&desc, &mut device);
        assert_fails(failed, RARA_ERROR_INVALID, "VK_KHR_synchronization2");
        desc.api_version = version;
        desc.queue_family = 99;
        let failed = rara_device_adopt(&desc, &mut device);
        assert_fails(failed, RARA_ERROR_INVALID, "no queue family 99");
        desc.queue_family = ours.queue_family;
        desc.shape = 3;
        let failed = rara_device_adopt(&desc, &mut device);
        assert_fails(failed, RARA_ERROR_INVALID, "desc->shape is 3");
        (desc.shape, desc.subgroup) = (RARA_SHAPE_GPU, 3);
        let failed = rara_device_adopt(&desc, &mut device);
        assert_fails(failed, RARA_ERROR_INVALID, "subgroups of 3");
        assert!(device.is_null());
        (desc.shape, desc.subgroup) = (RARA_SHAPE_AUTO, 0);
        assert_eq!(desc.api_version, version);
        assert_ok(rara_device_adopt(&desc, &mut device));

        let (mut gaussians, mut scene) = (null_mut(), null_mut());
        let loaded = rara_gaussians_load_from(
            SCENE.as_ptr(),
            SCENE.len(),
            c"one".as_ptr(),
            null(),
            0,
            &mut gaussians,
        );
        assert_ok(loaded);
        let failed = rara_scene_buffers_upload(device, &one_layer(gaussians), 1, 4, &mut scene);
        assert_fails(failed, RARA_ERROR_INVALID, "sh_format 4");
        let uploaded = rara_scene_buffers_upload(
            device,
            &one_layer(gaussians),
            1,
            RARA_SH_FORMAT_FLOAT,
            &mut scene,
        );
        assert_ok(uploaded);
        assert!(rara_scene_buffers_bytes(scene) > 0);
        layers::what_is_wrong_is_said(device, gaussians, scene);
        let mut camera: RaraCamera = std::mem::zeroed();
        let up = [0.0, -1.0, 0.0];
        assert_ok(rara_camera_frame(
            gaussians,
            up.as_ptr(),
            50.0,
            90,
            60,
            &mut camera,
            size_of::<RaraCamera>(),
        ));
        rara_gaussians_destroy(gaussians);

        let mut desc: RaraRendererDesc = std::mem::zeroed();
        let size = size_of_val(&desc);
        assert_ok(rara_renderer_desc_default(&mut desc, size, FORMAT));
        let mut renderer = null_mut();
        desc.frames_in_flight = 0;
        let failed = rara_renderer_create(device, &desc, &mut renderer);
        assert_fails(failed, RARA_ERROR_INVALID, "frames_in_flight");
        desc.frames_in_flight = 1;
        desc.color_format = vk::Format::BC1_RGB_UNORM_BLOCK;
        let failed = rara_renderer_create(device, &desc, &mut renderer);
        assert_fails(failed, RARA_ERROR_DEVICE, "BC1_RGB_UNORM_BLOCK");
        desc.color_format = FORMAT;
        let mut depth: RaraDepthDesc = std::mem::zeroed();
        let mut map = std::mem::zeroed();
        let failed = rara_depth_map_perspective(0.0, 9.0, vk::TRUE, &mut map);
        assert_fails(failed, RARA_ERROR_INVALID, "0 < near < far");
        map.offset = f64::NAN;
        let size = size_of_val(&depth);
        let filled = rara_depth_desc_default(&mut depth, size, vk::Format::D32_SFLOAT, map);
        assert_ok(filled);
        desc.depth = &depth;
        let failed = rara_renderer_create(device, &desc, &mut renderer);
        assert_fails(failed, RARA_ERROR_INVALID, "NaN");
        desc.depth = null();
        assert_ok(rara_renderer_create(device, &desc, &mut renderer));
        assert_ok(rara_depth_map_perspective(1.0, 9.0, vk::TRUE, &mut map));
        let failed = rara_renderer_set_depth_map(renderer, &map);
        assert_fails(failed, RARA_ERROR_INVALID, "depth attachment");

        let cmd = vk::CommandBuffer::null();
        let mut frame = null_mut();
        let configured =
            rara_renderer_configure(renderer, scene, &camera, null(), null(), &mut frame);
        assert_ok(configured);
        let failed = rara_renderer_prepare(renderer, cmd, scene, null(), frame);
        assert_fails(failed, RARA_ERROR_INVALID, "cmd is null");
        // Nothing is recorded into it: the frame is seen not to be prepared before.
        let cmd = <vk::CommandBuffer as vk::Handle>::from_raw(8);
        let failed = rara_renderer_draw(renderer, cmd, 0.0, 0.0, frame);
        assert_fails(failed, RARA_ERROR_INVALID, "frame was not prepared");
        let failed = rara_renderer_draw_depth(renderer, cmd, 0.0, 0.0, frame);
        assert_fails(failed, RARA_ERROR_INVALID, "frame was not prepared");
        rara_frame_destroy(frame);
        let failed = rara_renderer_draw(renderer, cmd, 0.0, 0.0, frame);
        let says = "frame is no RaraFrame that is alive";
        assert_fails(failed, RARA_ERROR_INVALID, says);
        let clip = clip_of(&[]);
        rara_clip_destroy(clip);
        let failed = rara_renderer_configure(renderer, scene, &camera, clip, null(), &mut frame);
        assert_fails(
            failed,
            RARA_ERROR_INVALID,
            "clip is no RaraClip that is alive",
        );
        assert!(frame.is_null());
        let mut stats: RaraFrameStats = std::mem::zeroed();
        let result = rara_renderer_stats(renderer, &mut stats, size_of_val(&stats));
        assert_ok(result);
        let reason = CStr::from_ptr(stats.raster_reason.as_ptr());
        assert!(reason.is_empty() && stats.drawn == 0 && stats.skipped_count == 0);
        assert!(stats.pass_count == 0 && stats.gpu_ms.is_nan(), "no timing");
        assert_ok(rara_renderer_forget(renderer));
        let mut second = null_mut();
        assert_ok(rara_renderer_create_sharing(renderer, &desc, &mut second));

        rara_renderer_destroy(second);
        rara_renderer_destroy(renderer);
        rara_scene_buffers_destroy(scene);
        assert_eq!(
            rara_device_bytes(device),
            0,
            "everything allocated was freed"
        );
        rara_device_destroy(device);
    }
    assert_eq!(host.close(), Vec::<String>::new());
}
