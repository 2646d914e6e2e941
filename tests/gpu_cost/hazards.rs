//! Every kind of frame is recorded under synchronisation checks.

use rara::ash::vk;
use rara::scene::{Kind, generate};
use rara::{SceneBuffers, ShFormat, Staging};
use rara_gpu::{
    Bindings, Buffer, BufferDesc, Device, DeviceDesc, DeviceShape, ImageDesc, Location,
    RecordedCommands,
};

use crate::gpu_cost::frames::{FORMAT, Frame, Frames, SMALL};

fn validated() -> DeviceDesc {
    DeviceDesc::default()
        .selector(std::env::var("RARA_TEST_DEVICE").ok())
        .validation(true)
}

/// Records every kind of frame that is different from the others.
fn record(frames: &Frames, shape: DeviceShape, record: impl Fn(&Frame)) {
    for frame in frames.all().iter().filter(|frame| frame.is_own_recording()) {
        record(frame);
        let messages = frames.device.validation_messages();
        assert!(
            messages.is_empty(),
            "{shape:?}, {}: {messages:?}",
            frame.name
        );
    }
}

/// Barriers follow from what the shaders declare and the order of the passes, so that a frame need only be recorded to find one
/// that is missing: nothing is drawn, and nothing compiled. All other tests reach most buffers by address, as users do, which the
/// layer's synchronisation checks cannot watch.
#[test]
fn no_kind_of_frame_has_a_hazard() {
    let desc = validated();
    let gpu = |subgroup| DeviceShape::Gpu { subgroup };
    let device = Device::headless(&desc).expect("a Vulkan device and the validation layer");
    let [least, most] = device.support().full_subgroups;
    drop(device);
    for shape in [DeviceShape::Cpu, gpu(32.clamp(least, most)), gpu(0)] {
        let desc = desc.clone().shape(Some(shape));
        let mut frames = Frames::bound_as(Bindings::Bound, &desc, SMALL);
        let target = frames.device.create_image(&ImageDesc {
            name: "target",
            width: SMALL.0,
            height: SMALL.1,
            format: FORMAT,
        });
        let target = target.expect("a target");
        record(&frames, shape, |frame| {
            frames.record(frame, Some(&target));
        });
        drop(target);
        if shape == DeviceShape::Cpu {
            // The same barriers, but for those of draws, which are in another queue.
            frames.compute_family = Some(frames.device.queue_family());
            record(&frames, shape, |frame| {
                let recorded = frames.record(frame, None);
                assert!(recorded.barriers > 0);
                assert_names_only(&recorded, COMPUTE | vk::PipelineStageFlags2::HOST);
            });
        }
        frames.close();
    }
}

/// The stages of a queue that only computes.
const COMPUTE: vk::PipelineStageFlags2 = vk::PipelineStageFlags2::from_raw(
    vk::PipelineStageFlags2::COMPUTE_SHADER.as_raw()
        | vk::PipelineStageFlags2::DRAW_INDIRECT.as_raw()
        | vk::PipelineStageFlags2::ALL_TRANSFER.as_raw(),
);

fn assert_names_only(recorded: &RecordedCommands, stages: vk::PipelineStageFlags2) {
    let others = recorded.stages & !stages;
    assert!(others.is_empty(), "barriers name {others:?}");
}

fn lent(staging: &mut Buffer) -> Staging<'_> {
    Staging {
        buffer: staging.handle(),
        offset: 0,
        bytes: staging.mapped_mut(),
    }
}

/// A scene may be uploaded, and a layer replaced, in a queue for transfers alone.
#[test]
fn copies_of_a_scene_name_no_stage_that_a_queue_for_transfers_lacks() {
    let device = Device::headless_inspected(&validated()).expect("the validation layer");
    let gaussians = generate(Kind::General, 300, 5);
    let format = ShFormat::default();
    let mut staging = device
        .create_buffer(&BufferDesc {
            name: "lent",
            size: SceneBuffers::staging_bytes(&gaussians, format),
            location: Location::Upload,
        })
        .expect("memory");
    let scene = device.submit_and_wait(|cmd| {
        // SAFETY: `cmd` is recording, and all that is used outlives the wait.
        unsafe { SceneBuffers::upload_with(&device, cmd, lent(&mut staging), &gaussians, format) }
    });
    let mut scene = scene.expect("uploads");
    assert_eq!(device.recorded().barriers, 0, "the memory is new");
    let replaced = device.submit_and_wait(|cmd| {
        // SAFETY: the same.
        unsafe { scene.replace_layer_with(cmd, lent(&mut staging), 0, &gaussians) }
    });
    replaced.expect("replaces");
    assert_eq!(device.recorded().barriers, 1);
    let known = vk::PipelineStageFlags2::ALL_COMMANDS | vk::PipelineStageFlags2::ALL_TRANSFER;
    assert_names_only(&device.recorded(), known);
    drop((scene, staging));
    assert_eq!(device.close(), Vec::<String>::new());
}
