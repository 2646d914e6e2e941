//! Every kind of frame is recorded under synchronisation checks.

use rara_gpu::{Bindings, Device, DeviceDesc, DeviceShape, ImageDesc};

use crate::gpu_cost::frames::{FORMAT, Frames, SMALL};

/// Barriers follow from what the shaders declare and the order of the passes, so that a frame need only be recorded to find one
/// that is missing: nothing is drawn, and nothing compiled. All other tests reach most buffers by address, as users do, which the
/// layer's synchronisation checks cannot watch.
#[test]
fn no_kind_of_frame_has_a_hazard() {
    let desc = DeviceDesc::default()
        .selector(std::env::var("RARA_TEST_DEVICE").ok())
        .validation(true);
    let gpu = |subgroup| DeviceShape::Gpu { subgroup };
    let device = Device::headless(&desc).expect("a Vulkan device and the validation layer");
    let [least, most] = device.support().full_subgroups;
    drop(device);
    for shape in [DeviceShape::Cpu, gpu(32.clamp(least, most)), gpu(0)] {
        let desc = desc.clone().shape(Some(shape));
        let frames = Frames::bound_as(Bindings::Bound, &desc, SMALL);
        let target = frames.device.create_image(&ImageDesc {
            name: "target",
            width: SMALL.0,
            height: SMALL.1,
            format: FORMAT,
        });
        let target = target.expect("a target");
        for frame in frames.all().iter().filter(|frame| frame.is_own_recording()) {
            frames.record(frame, &target);
            let messages = frames.device.validation_messages();
            assert!(
                messages.is_empty(),
                "{shape:?}, {}: {messages:?}",
                frame.name
            );
        }
        drop(target);
        frames.close();
    }
}
