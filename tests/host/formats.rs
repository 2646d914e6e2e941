//! Splats in a host's format: 8 bits, sRGB, halves and floats show the same picture, each as well as it can.

use crate::canvas::{Canvas, CanvasDesc, Frame, with_host};
use crate::common;
use rara::ash::vk;
use rara::gpu::Bindings;
use rara::scene::{Kind, generate};
use rara::{ClipOp, Raster, Renderer, RendererDesc, SceneBuffers, Settings};

const SIZE: (u32, u32) = (189, 131);
/// The colour that the host has painted before.
const BACKDROP: [f32; 4] = [0.2, 0.6, 0.4, 1.0];

/// By how much a format may be off, of 255, in the worst pixel and on average. Tiles blend once, which costs half a step;
/// quads blend dozens of times, and each blend is off by half a step (on lavapipe, which truncates, by a whole one). The
/// stored numbers are compared, so that a step of sRGB is up to 2.3 of 255 near white.
const BOUNDS: [(vk::Format, [f32; 2], [f32; 2]); 4] = [
    (vk::Format::R32G32B32A32_SFLOAT, [0.01, 1e-4], [1.0, 1e-3]),
    (vk::Format::R16G16B16A16_SFLOAT, [0.25, 0.05], [6.0, 0.1]),
    (vk::Format::R8G8B8A8_UNORM, [1.3, 0.06], [10.0, 0.2]),
    (vk::Format::R8G8B8A8_SRGB, [2.4, 0.6], [12.0, 0.7]),
];

#[test]
fn every_format_holds_the_picture_as_well_as_it_can() {
    let scene = generate(Kind::General, 3_000, 5);
    let camera = common::views(&scene, 3, SIZE)[1];
    let clip = common::clip(&scene, 2, ClipOp::And);
    let mut headless = common::headless();
    headless.load(&scene).expect("uploads");
    let truth = headless.render(&camera, &clip, &Settings::default());
    truth.expect("renders");
    let truth = headless.picture().expect("reads back");
    let over = |pixel: &[f32; 4]| {
        let blend = |c: usize| pixel[c] + (1.0 - pixel[3]) * BACKDROP[c];
        [0, 1, 2, 3].map(|c| blend(c).clamp(0.0, 1.0))
    };
    let truth: Vec<_> = truth.pixels.iter().map(over).collect();
    with_host(true, |host, device| {
        let format = rara::ShFormat::Float;
        let buffers = SceneBuffers::upload(device, &scene, format).expect("uploads");
        for (format, tiles, quads) in BOUNDS {
            let mut desc = CanvasDesc::new(SIZE, format);
            desc.clear = BACKDROP;
            let canvas = Canvas::new(&host.lend(), device, desc);
            for raster in common::rasters(device) {
                let [most, average] = match raster {
                    Raster::Tiles => tiles,
                    _ => quads,
                };
                let desc = RendererDesc::new(format).bindings(Bindings::Mixed);
                let mut renderer = Renderer::new(device, desc).expect("a renderer");
                let settings = Settings::default().raster(raster);
                let configured = renderer.configure(&buffers, &camera, &clip, &settings);
                let pixels =
                    canvas.draw_frame(&mut renderer, &buffers, configured, &Frame::new(SIZE));
                let pairs = pixels.iter().flatten().zip(truth.iter().flatten());
                let differences: Vec<_> = pairs
                    .map(|(a, b)| 255.0 * (a.clamp(0.0, 1.0) - b).abs())
                    .collect();
                let worst = differences.iter().copied().fold(0.0, f32::max);
                let mean = differences.iter().sum::<f32>() / differences.len() as f32;
                let what = format!("{format:?}, {raster:?}: {worst:.4}/255, on average {mean:.5}");
                eprintln!("{what}");
                assert!(worst <= most && mean <= average, "{what}");
            }
        }
    });
}
