//! Features that a host enables beside its own: rara's structs in a chain with the host's, and the host's own structs, in
//! which rara sets what it needs. Either way the host has the timeline semaphores that it asked for, and what a host claims
//! to have enabled and has not is refused by name.

use std::ffi::c_void;
use std::mem::ManuallyDrop;
use std::ptr::null_mut;

use crate::canvas::host;
use crate::canvas::host::validation::{self, Messages};
use crate::canvas::{Canvas, CanvasDesc, Frame};
use crate::common;
use rara::ash::{Device, Entry, Instance, vk};
use rara::gpu::{self, AdoptDesc, Bindings, Support};
use rara::scene::{Kind, generate};
use rara::{ClipOp, Raster, Renderer, RendererDesc, SceneBuffers, Settings, ShFormat};

const VERSION: u32 = vk::API_VERSION_1_3;

/// Creates a device by `create`, which is given the physical one, what it supports, and the create info without features.
/// The host makes a timeline semaphore on it, and `adopt` adopts it; the validation layer must have nothing to say.
fn with_device(
    create: impl FnOnce(&Instance, vk::PhysicalDevice, &Support, vk::DeviceCreateInfo<'_>) -> Device,
    adopt: impl FnOnce(AdoptDesc, &Support),
) {
    // SAFETY: every handle is used while it is alive, and destroyed once, in order; what is pointed to outlives the calls.
    unsafe {
        // A layer's threads may still be in the loader's library when the test ends.
        let entry = ManuallyDrop::new(Entry::load().expect("a Vulkan loader"));
        let messages = Box::new(Messages::default());
        let made = validation::instance(&entry, VERSION, true, &messages);
        let (instance, messenger) = made.expect("the validation layer (tools/test installs it)");
        let part = std::env::var("RARA_TEST_DEVICE").unwrap_or_default();
        let chosen = host::choose(&instance, VERSION, &part);
        let (physical, support) = chosen.expect("a device that draws splats");
        let extensions: Vec<_> = support.extensions().iter().map(|e| e.as_ptr()).collect();
        let family = support.queue_family;
        let queues = [vk::DeviceQueueCreateInfo::default()
            .queue_family_index(family)
            .queue_priorities(&[1.0])];
        let info = vk::DeviceCreateInfo::default()
            .queue_create_infos(&queues)
            .enabled_extension_names(&extensions);
        let raw = create(&instance, physical, &support, info);

        let mut timeline =
            vk::SemaphoreTypeCreateInfo::default().semaphore_type(vk::SemaphoreType::TIMELINE);
        let info = vk::SemaphoreCreateInfo::default().push_next(&mut timeline);
        let semaphore = raw.create_semaphore(&info, None).expect("a semaphore");
        raw.destroy_semaphore(semaphore, None);
        let queue = (raw.get_device_queue(family, 0), family);
        let lent = AdoptDesc::new(VERSION, instance.clone(), physical, raw.clone(), queue);
        adopt(lent, &support);

        raw.destroy_device(None);
        if let Some((loader, messenger)) = messenger {
            loader.destroy_debug_utils_messenger(messenger, None);
        }
        instance.destroy_instance(None);
        let messages = messages.into_inner().expect("nobody has panicked");
        assert_eq!(messages, Vec::<String>::new());
    }
}

/// Adopts a device with all that it was created with, and uploads a scene, which reaches buffers by address.
fn upload(lent: AdoptDesc, support: &Support) {
    let lent = lent
        .mesh_shader(support.mesh_shader)
        .push_descriptor(support.push_descriptor)
        .full_subgroups(support.full_subgroups[1] > 0);
    // SAFETY: the handles belong together, and are as the description says.
    let device = unsafe { gpu::Device::adopt(lent) }.expect("draws splats");
    assert_eq!(device.support().mesh_shader, support.mesh_shader);
    let scene = generate(Kind::General, 100, 1);
    let buffers = SceneBuffers::upload(&device, &scene, ShFormat::default());
    drop(buffers.expect("uploads"));
    assert_eq!(device.close(), Vec::<String>::new());
}

#[test]
fn our_structs_go_together_with_a_hosts_single_ones() {
    with_device(
        |instance, physical, support, info| {
            let mut own =
                vk::PhysicalDeviceTimelineSemaphoreFeatures::default().timeline_semaphore(true);
            let mut features = support.features();
            let info = features.chain(info.push_next(&mut own));
            // SAFETY: the instance is alive, and the device offers all that is asked for.
            unsafe { instance.create_device(physical, &info, None) }.expect("a device")
        },
        upload,
    );
}

#[test]
fn a_hosts_own_structs_take_what_is_needed() {
    with_device(
        |instance, physical, support, info| {
            let mut of_1_2 = vk::PhysicalDeviceVulkan12Features::default().timeline_semaphore(true);
            let mut of_1_3 = vk::PhysicalDeviceVulkan13Features::default();
            let mut mesh = vk::PhysicalDeviceMeshShaderFeaturesEXT::default();
            let mut info = info.push_next(&mut of_1_2);
            // SAFETY: each chain holds structs that are alive, and nobody else uses them; the device offers all that is
            // asked for.
            unsafe {
                let lacks =
                    |chain: *mut c_void| support.set_features(chain).unwrap_err().to_string();
                assert!(lacks(null_mut()).contains("bufferDeviceAddress"));
                let text = lacks(info.p_next.cast_mut());
                assert!(text.contains("synchronization2: chain a Vk"), "{text}");
                info = info.push_next(&mut of_1_3);
                if support.mesh_shader {
                    info = info.push_next(&mut mesh);
                }
                let set = support.set_features(info.p_next.cast_mut());
                set.expect("the chain has all of them");
                let made = instance.create_device(physical, &info, None);
                assert_eq!(of_1_2.timeline_semaphore + of_1_2.buffer_device_address, 2);
                assert_eq!(of_1_3.synchronization2 + of_1_3.dynamic_rendering, 2);
                assert_eq!(of_1_3.maintenance4, vk::FALSE, "not asked for");
                assert_eq!(mesh.task_shader, vk::Bool32::from(support.mesh_shader));
                made.expect("a device")
            }
        },
        upload,
    );
}

/// An engine's chain has some of the structs, with other features of theirs set or none: what is missing is chained, and no
/// struct twice, which the layer would say.
#[test]
fn a_chain_is_completed_whatever_it_has() {
    for of_1_2 in [false, true] {
        with_device(
            |instance, physical, support, info| {
                let mut all = vk::PhysicalDeviceVulkan12Features::default();
                let mut timeline = vk::PhysicalDeviceTimelineSemaphoreFeatures::default();
                let mut sizes = vk::PhysicalDeviceSubgroupSizeControlFeatures::default()
                    .subgroup_size_control(support.full_subgroups[1] > 0);
                let mut mesh = vk::PhysicalDeviceMeshShaderFeaturesEXT::default();
                let mut rendering = vk::PhysicalDeviceDynamicRenderingFeatures::default();
                (all.timeline_semaphore, timeline.timeline_semaphore) = (vk::TRUE, vk::TRUE);
                let mut ours = support.features();
                let info = match of_1_2 {
                    true => info.push_next(&mut all).push_next(&mut rendering),
                    false => info.push_next(&mut timeline).push_next(&mut sizes),
                };
                let info = match !of_1_2 && support.mesh_shader {
                    true => info.push_next(&mut mesh),
                    false => info,
                };
                // SAFETY: each chain holds structs that are alive, and nobody else uses them; the device offers all that is
                // asked for.
                let made = unsafe {
                    let info = support.complete(&mut ours, info);
                    instance.create_device(physical, &info, None)
                };
                let subgroups = vk::Bool32::from(support.full_subgroups[1] > 0);
                if of_1_2 {
                    assert_eq!(all.buffer_device_address + rendering.dynamic_rendering, 2);
                } else {
                    assert_eq!(sizes.compute_full_subgroups, subgroups);
                    assert_eq!(mesh.task_shader, vk::Bool32::from(support.mesh_shader));
                }
                made.expect("a device")
            },
            upload,
        );
    }
}

#[test]
fn what_a_host_claims_and_has_not_enabled_is_refused_by_name() {
    with_device(
        |instance, physical, support, info| {
            let mut own =
                vk::PhysicalDeviceTimelineSemaphoreFeatures::default().timeline_semaphore(true);
            let mut support = support.clone();
            (support.mesh_shader, support.push_descriptor) = (false, false);
            let mut features = support.features();
            let extensions: Vec<_> = support.extensions().iter().map(|e| e.as_ptr()).collect();
            let info = info.enabled_extension_names(&extensions);
            let info = features.chain(info.push_next(&mut own));
            // SAFETY: the instance is alive, and the device offers all that is asked for.
            unsafe { instance.create_device(physical, &info, None) }.expect("a device")
        },
        |lent, support| {
            let refused = |lent: AdoptDesc, says: [&str; 2]| {
                // SAFETY: the handles belong together; what the description claims wrongly is what is tried here.
                let error = unsafe { gpu::Device::adopt(lent) }.unwrap_err();
                let text = error.to_string();
                assert!(matches!(error, rara::Error::Invalid(_)), "{text}");
                assert!(says.iter().all(|part| text.contains(part)), "{text}");
            };
            for (offered, claimed, says) in [
                (
                    support.mesh_shader,
                    lent.clone().mesh_shader(true),
                    ["without VK_EXT_mesh_shader", "mesh_shader false"],
                ),
                (
                    support.push_descriptor,
                    lent.clone().push_descriptor(true),
                    ["without VK_KHR_push_descriptor", "push_descriptor false"],
                ),
            ] {
                if offered {
                    refused(claimed, says);
                }
            }
            // What 1.3 has in its core, 1.2 has in extensions, which this device was created without.
            let mut of_1_2 = lent.clone();
            of_1_2.api_version = vk::API_VERSION_1_2;
            refused(of_1_2, ["without VK_KHR_synchronization2", "gpu::check"]);
            // SAFETY: as above, and nothing is claimed.
            let device = unsafe { gpu::Device::adopt(lent) }.expect("draws splats");
            assert_eq!(device.close(), Vec::<String>::new());
        },
    );
}

/// Draws a frame by tiles and one by quads on a host's device.
fn pictures(lent: &AdoptDesc, device: &gpu::Device, bindings: Bindings) -> Vec<Vec<[f32; 4]>> {
    const VIEW: (u32, u32) = (90, 60);
    let scene = generate(Kind::General, 600, 1);
    let (camera, clip) = (
        common::views(&scene, 1, VIEW)[0],
        common::clip(&scene, 1, ClipOp::And),
    );
    let buffers = SceneBuffers::upload(device, &scene, ShFormat::default()).expect("uploads");
    let format = vk::Format::R32G32B32A32_SFLOAT;
    let canvas = Canvas::new(lent, device, CanvasDesc::new(VIEW, format));
    let desc = RendererDesc::new(format).bindings(bindings);
    let mut renderer = Renderer::new(device, desc).expect("a renderer");
    let mut draw = |raster| {
        let settings = Settings::default().raster(raster);
        let configured = renderer.configure(&buffers, &camera, &clip, &settings);
        canvas.draw_frame(&mut renderer, &buffers, configured, &Frame::new(VIEW))
    };
    [Raster::Tiles, Raster::Quad].map(&mut draw).into()
}

/// A device without addresses draws the same bytes, whatever way a renderer asks for: only bound buffers are left.
#[test]
fn a_device_without_addresses_draws_the_same_bytes() {
    let drawn = |addresses: bool, bindings: &[Bindings]| {
        let mut drawn = Vec::new();
        with_device(
            |instance, physical, support, info| {
                let mut own =
                    vk::PhysicalDeviceTimelineSemaphoreFeatures::default().timeline_semaphore(true);
                let mut support = support.clone();
                support.buffer_device_address &= addresses;
                let mut features = support.features();
                let info = features.chain(info.push_next(&mut own));
                // SAFETY: the instance is alive, and the device offers all that is asked for.
                unsafe { instance.create_device(physical, &info, None) }.expect("a device")
            },
            |lent, support| {
                if !support.push_descriptor {
                    eprintln!("SKIPPED: BOUND BUFFERS: the device has no push descriptors");
                    return;
                }
                let lent = lent.buffer_device_address(addresses);
                if !addresses {
                    // SAFETY: the handles belong together, and are as the description says.
                    let error = unsafe { gpu::Device::adopt(lent.clone()) }.unwrap_err();
                    let text = error.to_string();
                    assert!(matches!(error, rara::Error::Invalid(_)), "{text}");
                    assert!(text.contains("neither bufferDeviceAddress"), "{text}");
                }
                let lent = lent.push_descriptor(true);
                // SAFETY: as above.
                let device = unsafe { gpu::Device::adopt(lent.clone()) }.expect("draws splats");
                assert_eq!(device.support().buffer_device_address, addresses);
                if !addresses {
                    assert_eq!(Bindings::suiting(&device), Bindings::Bound);
                }
                drawn = bindings
                    .iter()
                    .map(|bindings| pictures(&lent, &device, *bindings))
                    .collect();
                assert_eq!(device.close(), Vec::<String>::new());
            },
        );
        drawn
    };
    let usual = drawn(true, &[Bindings::Bound]);
    let all = [Bindings::Address, Bindings::Bound, Bindings::Mixed];
    let without = drawn(false, &all);
    assert!(without.iter().all(|pictures| *pictures == usual[0]));
    let opaque = |pixels: &Vec<[f32; 4]>| pixels.iter().any(|pixel| pixel[3] > 0.5);
    assert!(usual.iter().flatten().all(opaque));
}

/// Vulkan does not say for which version an instance was made; the functions and answers that it lacks do.
#[test]
fn an_instance_made_for_less_than_is_said_is_told_so() {
    for made_for in [
        vk::API_VERSION_1_0,
        vk::API_VERSION_1_1,
        vk::API_VERSION_1_2,
    ] {
        // SAFETY: every handle is used while it is alive, and destroyed once, in order; what is pointed to outlives the calls.
        unsafe {
            let entry = ManuallyDrop::new(Entry::load().expect("a Vulkan loader"));
            let application = vk::ApplicationInfo::default().api_version(made_for);
            let info = vk::InstanceCreateInfo::default().application_info(&application);
            let instance = entry.create_instance(&info, None).expect("an instance");
            let part = std::env::var("RARA_TEST_DEVICE").unwrap_or_default();
            let devices = instance.enumerate_physical_devices().expect("devices");
            let mut devices = devices.into_iter().filter(|device| {
                let name = instance.get_physical_device_properties(*device);
                let name = name
                    .device_name_as_c_str()
                    .unwrap_or_default()
                    .to_string_lossy();
                name.contains(&part)
            });
            let physical = devices.next().expect("the device under test");
            let queues = [vk::DeviceQueueCreateInfo::default().queue_priorities(&[1.0])];
            let info = vk::DeviceCreateInfo::default().queue_create_infos(&queues);
            let raw = instance
                .create_device(physical, &info, None)
                .expect("a device");
            let queue = (raw.get_device_queue(0, 0), 0);
            let lent = AdoptDesc::new(VERSION, instance.clone(), physical, raw.clone(), queue);
            let refused = gpu::Device::adopt(lent)
                .expect_err("it was made for less")
                .to_string();
            assert!(
                refused.contains("VkApplicationInfo::apiVersion"),
                "{refused}"
            );
            raw.destroy_device(None);
            instance.destroy_instance(None);
        }
    }
}
