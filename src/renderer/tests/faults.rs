//! A host adopts a device, uploads by staging memory of its own and has two frames in flight, and every call that can fail
//! does so at its first places. Each failure ends in an error and leaves nothing behind.

use super::super::*;
use crate::passes::{SceneBuffers, Staging};
use ash::vk::Result as Code;
use glam::DVec3;
use rara_gpu::faults::{self, CAN_BE_LOST, Fault};
use rara_gpu::{Bindings, BufferDesc, Drawer, ImageDesc, Location};
use rara_scene::camera::Camera;
use rara_scene::clip::{Clip, ClipOp, Plane};
use rara_scene::precision::ShFormat;
use rara_scene::settings::Settings;
use rara_scene::{Bounds, Kind, generate};

const FORMAT: vk::Format = vk::Format::R32G32B32A32_SFLOAT;

/// Runs a host's work, with `host` as the engine's device and the engine's memory allocated from it.
fn life(host: &Device) -> Result<()> {
    // SAFETY: the handles are of one device, which outlives what is made here.
    let device = unsafe { Device::adopt(faults::lent(host)) }?;
    let scene = generate(Kind::General, 600, 1);
    let camera = Camera::frame(&Bounds::of(&scene), -DVec3::Y, 50.0, (24, 16))?;
    let target = host.create_image(&ImageDesc {
        name: "host's target",
        width: camera.width,
        height: camera.height,
        format: FORMAT,
    })?;
    let mut memory = host.create_buffer(&BufferDesc {
        name: "host's staging",
        size: SceneBuffers::staging_bytes(&scene, ShFormat::Packed),
        location: Location::Upload,
    })?;
    let desc = RendererDesc {
        bindings: Bindings::Mixed,
        timing: true,
        reuse: true,
        frames_in_flight: 2,
        ..RendererDesc::new(FORMAT)
    };
    let mut renderer = Renderer::new(&device, desc)?;
    let mut buffers = None;
    // The frames are one from nothing, one in which only the clip has moved, and one that outgrows the memory of both.
    for (frame, planes) in [1, 1, 3].into_iter().enumerate() {
        let plane = |i| {
            let normal = DVec3::new(1.0, f64::from(i), 0.0);
            Plane::new(normal, 0.1 * frame as f64)
        };
        let clip = Clip::of(
            (0..planes).map(plane).collect::<Result<Vec<_>>>()?,
            ClipOp::And,
        );
        host.submit_and_wait(|cmd| {
            if buffers.is_none() {
                let staging = Staging {
                    buffer: memory.handle(),
                    offset: 0,
                    bytes: memory.mapped_mut(),
                };
                let format = ShFormat::Packed;
                // SAFETY: `cmd` is recording outside rendering; scene and staging outlive the wait.
                let uploaded =
                    unsafe { SceneBuffers::upload_with(&device, cmd, staging, &scene, format) };
                buffers = Some(uploaded?);
            }
            let buffers = buffers.as_ref().expect("just uploaded");
            let frame = renderer.configure(buffers, &camera, &clip, &Settings::default())?;
            // SAFETY: `cmd` is recording outside rendering, and all that is used outlives the wait. The scope is opened
            // and closed around the draw, on an attachment of the renderer's format.
            unsafe {
                let frame = renderer.prepare(cmd, buffers, None, frame)?;
                target.begin_rendering(cmd, [0.0; 4]);
                Drawer::new(&device, cmd, None).viewport(target.extent().into());
                renderer.draw(cmd, [0.0; 2], &frame)?;
                target.end_rendering(cmd);
            }
            Ok(())
        })?;
        renderer.pass_times();
    }
    drop((renderer, buffers));
    assert_eq!(device.device_bytes(), 0);
    Ok(())
}

#[test]
fn memory_may_run_out_where_a_host_draws() {
    if faults::is_slow() {
        eprintln!("SKIPPED: memory that runs out, on a slow driver, whose code it does not test");
        return;
    }
    let host = faults::device(None).expect("a device");
    life(&host).expect("no fault");
    let counts = faults::CALLS.map(faults::count);
    let mut places = 0;
    for (call, count) in faults::CALLS.iter().zip(counts) {
        for after in [0, 3].into_iter().filter(|after| *after < count) {
            let result = Code::ERROR_OUT_OF_DEVICE_MEMORY;
            faults::set_among(std::slice::from_ref(call), Some(Fault { after, result }));
            let lived = life(&host);
            let fired = faults::fired().is_some();
            faults::set_among(&[], None);
            if !fired {
                lived.expect("nothing has failed");
                break;
            }
            places += 1;
            match lived {
                Err(Error::Memory(_)) => {}
                // Without an error, times are left out, tiles have become quads and a reclipped frame a whole one.
                Ok(()) => assert!(
                    [
                        "vkGetQueryPoolResults",
                        "vkAllocateMemory",
                        "vkCreateBuffer",
                        "vkBindBufferMemory"
                    ]
                    .contains(call),
                    "nobody noticed that {call} failed"
                ),
                Err(other) => panic!("{call}: {other}"),
            }
            assert_eq!(host.device_bytes(), 0, "after {call} failed");
            assert_eq!(host.validation_messages(), Vec::<String>::new(), "{call}");
        }
    }
    assert!(places > 20, "{places} places");
    assert_eq!(host.close(), Vec::<String>::new());
}

/// The host learns of a lost device from its own calls. Its later calls to rara may fail or not, but nothing panics or
/// stays behind.
#[test]
fn a_hosts_device_may_be_lost() {
    let step = if faults::is_slow() { 5 } else { 1 };
    for after in (0..).step_by(step) {
        let host = faults::device(None).expect("a device");
        let result = Code::ERROR_DEVICE_LOST;
        faults::set_among(&CAN_BE_LOST, Some(Fault { after, result }));
        let lived = life(&host);
        let fired = faults::fired();
        if fired.is_some() {
            let _ = life(&host);
        }
        assert_eq!(host.device_bytes(), 0, "after {fired:?}");
        faults::set_among(&[], None);
        assert_eq!(host.close(), Vec::<String>::new(), "{fired:?}");
        let Some(call) = fired else {
            lived.expect("nothing has failed");
            assert!(after > 5, "{after} places");
            return;
        };
        let tolerated = call == "vkGetQueryPoolResults"; // the times are left out
        assert!(tolerated || lived.is_err(), "nobody noticed {call}");
    }
}
