//! Descriptions that no device can fulfil, and calls in a wrong order.

use super::*;

#[test]
fn what_there_cannot_be_is_refused_with_a_reason() {
    let host = open_host(BYTES, VIEW, true);
    let device = adopt(&host);
    let depth = |format, stencil| {
        let map = rara::DepthMap::ordinary(0.1, 10.0).expect("a map");
        Some(rara::DepthDesc::new(format, map).stencil(stencil))
    };
    let desc = RendererDesc::new(BYTES);
    let name = &device.info().name;
    for (desc, says) in [
        (
            RendererDesc::new(vk::Format::R8G8B8A8_UINT),
            ["R8G8B8A8_UINT", name.as_str()],
        ),
        (
            desc.frames_in_flight(0),
            ["frames_in_flight is 0", "from 1 to 16"],
        ),
        (
            desc.frames_in_flight(u32::MAX),
            ["frames_in_flight is 4294967295", "from 1 to 16"],
        ),
        (
            desc.depth(depth(vk::Format::S8_UINT, false)),
            ["S8_UINT", "no depth"],
        ),
        (
            desc.depth(depth(vk::Format::D32_SFLOAT, true)),
            ["D32_SFLOAT", "DepthDesc::stencil"],
        ),
        (
            desc.expected_depth(Some(rara::ExpectedDepthDesc::new(vk::Format::R32_SFLOAT))),
            ["R32_SFLOAT", "two floats"],
        ),
    ] {
        let text = Renderer::new(&device, desc).unwrap_err().to_string();
        assert!(says.iter().all(|part| text.contains(part)), "{text}");
    }
    drop(device);
    assert_eq!(host.close(), Vec::<String>::new());
}

/// Calls that are refused before anything is recorded, so that no command buffer is needed.
#[test]
fn calls_in_an_order_that_makes_no_sense_are_refused() {
    let headless = common::headless();
    let device = headless.device();
    let null = vk::CommandBuffer::null();
    let refused = |result: rara::Result<()>, why: &str| match result {
        Err(rara::Error::Invalid(text)) => assert!(text.contains(why), "{text}"),
        other => panic!("{other:?}, and not that {why}"),
    };
    let (camera, clip, settings) = frames(&scene()).swap_remove(1);
    let upload =
        |scene| SceneBuffers::upload(device, &scene, rara::ShFormat::default()).expect("uploads");
    // A scene as large as the other, but not the same.
    let (one, other) = (upload(scene()), upload(generate(Kind::General, 3_000, 6)));
    let mut renderer = Renderer::new(device, RendererDesc::new(BYTES)).expect("a renderer");
    let configured = renderer.configure(&one, &camera, &clip, &settings);
    let configured = configured.expect("configures");
    // SAFETY: it is refused before anything is recorded.
    let prepared = unsafe { renderer.prepare(null, &other, None, configured) };
    refused(prepared.map(drop), "another scene than Renderer::configure");
    let map = rara::DepthMap::ordinary(0.1, 10.0).expect("a map");
    refused(renderer.set_depth_map(map), "depth attachment");
    // A scene on a device of its own.
    let elsewhere = common::headless();
    let scene = SceneBuffers::upload(elsewhere.device(), &scene(), rara::ShFormat::default());
    let configured = renderer.configure(&scene.expect("uploads"), &camera, &clip, &settings);
    refused(configured.map(drop), "another device");
}
