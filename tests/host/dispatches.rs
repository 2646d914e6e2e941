//! With `RARA_TIMES=dispatches` each dispatch has its own time, also where the host has drawn before in the same command buffer.

use crate::canvas::{Canvas, CanvasDesc, Frame, with_host};
use crate::common;
use crate::common::folder::has_run_with;
use rara::ash::vk;
use rara::gpu::Bindings;
use rara::scene::{Kind, generate};
use rara::{
    Clip, DepthDesc, DepthMap, Raster, Renderer, RendererDesc, SceneBuffers, Settings, ShFormat,
};

const FLOATS: vk::Format = vk::Format::R32G32B32A32_SFLOAT;
const DEPTH: vk::Format = vk::Format::D32_SFLOAT;
const VIEW: (u32, u32) = (128, 96);

#[test]
fn dispatches_have_all_of_their_time_behind_a_scope_of_the_hosts() {
    let variables = [("RARA_TIMES", "dispatches")];
    if has_run_with(
        &variables,
        dispatches_have_all_of_their_time_behind_a_scope_of_the_hosts,
    ) {
        return;
    }
    with_host(false, |host, device| {
        if device.support().timestamp_period == 0.0 {
            return eprintln!("SKIPPED: NO TIMESTAMPS: no dispatch was measured");
        }
        // A canvas with a depth buffer has a scope for it before everything else.
        let mut desc = CanvasDesc::new(VIEW, FLOATS);
        (desc.depth, desc.far) = (DEPTH, 0.0);
        let canvas = Canvas::new(&host.lend(), device, desc);
        let scene = generate(Kind::General, 30_000, 5);
        let camera = common::views(&scene, 1, VIEW)[0];
        let uploaded = SceneBuffers::upload(device, &scene, ShFormat::Packed).expect("uploads");
        let map = DepthMap::reversed(0.05, f64::INFINITY).expect("proper depths");
        let desc = RendererDesc::new(FLOATS)
            .depth(Some(DepthDesc::new(DEPTH, map).readable(true)))
            .bindings(Bindings::suiting(device))
            .timing(true);
        let mut renderer = Renderer::new(device, desc).expect("a renderer");
        let settings = Settings::default().raster(Raster::Tiles);
        let frame = Frame {
            behind: Some(canvas.depth_image(0, 0)),
            ..Frame::new(VIEW)
        };
        // Drivers may compile in the first frame.
        for _ in 0..2 {
            let configured = renderer.configure(&uploaded, &camera, &Clip::default(), &settings);
            canvas.draw_frame(&mut renderer, &uploaded, configured, &frame);
        }
        let mut spans = renderer.pass_spans();
        spans.retain(|span| span.name != "splat"); // the draw
        let [first, .., last] = &spans[..] else {
            panic!("{spans:?}");
        };
        let whole = last.end - first.begin;
        let sum: u64 = spans.iter().map(|span| span.end - span.begin).sum();
        assert!(2 * sum > whole, "{sum} of {whole} ticks: {spans:#?}");
    });
}
