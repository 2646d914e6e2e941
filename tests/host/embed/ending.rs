//! Objects that end while frames in flight use them.

use super::*;

/// The validation layer would see memory that is freed while the device uses it.
#[test]
fn what_frames_in_flight_use_goes_when_their_fence_is_signalled() {
    let scene = scene();
    let host = open_host(BYTES, VIEW, true);
    let mut engine = Engine::new(
        host,
        &scene,
        ShFormat::default(),
        in_flight(BYTES, Bindings::Mixed),
    );
    let frames = frames(&scene);
    for frame in &frames[..FRAMES] {
        engine.configure(frame);
        engine.record(vk::Offset2D::default());
    }
    let Engine {
        host,
        device,
        scene,
        renderer,
        prepared,
        ..
    } = engine;
    let (raw, queue) = (device.raw().clone(), host.lend().queue);
    // SAFETY: the fence is alive, and is submitted behind all frames.
    unsafe {
        let fence = raw
            .create_fence(&Default::default(), None)
            .expect("a fence");
        device.drop_after((renderer, prepared), fence);
        device.drop_after(scene, fence);
        assert_eq!(device.drop_finished(), 2, "the fence is unsignalled");
        assert!(device.device_bytes() > 0);
        raw.queue_submit2(queue, &[], fence).expect("submits");
        raw.wait_for_fences(&[fence], true, u64::MAX)
            .expect("waits");
        assert_eq!(device.drop_finished(), 0);
        raw.destroy_fence(fence, None);
    }
    assert_eq!(device.device_bytes(), 0);
    drop(device);
    assert_eq!(host.close(), Vec::<String>::new());
}
