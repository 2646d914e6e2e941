//! An engine in raw calls of an older age: classic render passes, barriers and submissions of 1.0, and all memory from
//! one `gpu-allocator`, which it lends. Its viewport has a negative height. Its pictures are the headless ones, byte for
//! byte, in Vulkan 1.3 and in 1.2, where the layer checks that no newer function is called.

mod engine;
mod target;

use std::cell::{OnceCell, RefCell};

use crate::common;
use engine::Host;
use rara::ash::vk;
use rara::gpu::{self, Target};
use rara::scene::{Kind, generate};
use rara::{ClipOp, Raster, Renderer, RendererDesc, SceneBuffers, Settings, ShFormat};

const FORMAT: vk::Format = vk::Format::R32G32B32A32_SFLOAT;
const EXTENT: vk::Extent2D = vk::Extent2D {
    width: 151,
    height: 97,
};

#[test]
fn in_vulkan_1_3_the_pictures_are_the_headless_ones() {
    check(vk::API_VERSION_1_3);
}

#[test]
fn in_vulkan_1_2_the_pictures_are_the_headless_ones() {
    check(vk::API_VERSION_1_2);
}

fn check(version: u32) {
    let scene = generate(Kind::General, 3_000, 5);
    let camera = common::views(&scene, 1, (EXTENT.width, EXTENT.height))[0];
    // SAFETY: everything made from the host goes before it.
    let mut host = unsafe { Host::new(version) };
    // SAFETY: as above.
    let device = unsafe { gpu::Device::adopt(host.lend()) }.expect("draws splats");
    let rasters = common::rasters(&device);
    let buffers = SceneBuffers::upload(&device, &scene, ShFormat::Float).expect("uploads");
    let names = |host: &Host| -> Vec<String> {
        let report = host.allocator.lock().expect("ours").generate_report();
        report.allocations.into_iter().map(|a| a.name).collect()
    };
    assert!(names(&host).iter().any(|name| name == "host's target"));
    let ours = device.memory_by_name();
    assert!(!ours.is_empty() && ours.iter().all(|part| names(&host).contains(&part.name)));
    assert!(ours.iter().all(|part| !part.name.starts_with("host's")));

    for bindings in common::bindings(&device) {
        // The two paths are compiled from other modules: pictures of one path agree to the bit, those of two to 2e-5 of
        // 255.
        let mut headless = common::headless_by(bindings);
        headless.load(&scene).expect("uploads");
        // Slow drivers, which compile for seconds, get only the last.
        let few = if common::scale() < 1.0 { 2 } else { 0 };
        let clips = |raster: &Raster| {
            [0, 1, 3]
                .map(|planes| (*raster, planes))
                .into_iter()
                .skip(few)
        };
        for (raster, planes) in rasters.iter().flat_map(clips) {
            let clip = common::clip(&scene, planes, ClipOp::And);
            let settings = Settings::default().raster(raster);
            headless.render(&camera, &clip, &settings).expect("renders");
            let truth = headless.picture().expect("reads back");
            let desc = RendererDesc::new(FORMAT)
                .bindings(bindings)
                .timing(true)
                .statistics(true)
                // SAFETY: the render pass outlives the renderer.
                .target(unsafe { Target::render_pass(host.render_pass, 0) });
            let mut renderer = Renderer::new(&device, desc).expect("a renderer");
            let configured = renderer.configure(&buffers, &camera, &clip, &settings);
            let configured = configured.expect("configures");
            let prepared = OnceCell::new();
            let renderer = RefCell::new(renderer);
            // SAFETY: the frame is waited for before renderer and scene are dropped; `cmd` is where each call needs it.
            let picture = unsafe {
                host.frame(
                    |cmd| {
                        let mut renderer = renderer.borrow_mut();
                        let made = renderer.prepare(cmd, &buffers, None, configured);
                        prepared.get_or_init(|| made.expect("prepares"));
                    },
                    |cmd| {
                        let prepared = prepared.get().expect("it was prepared");
                        let drawn = renderer.borrow_mut().draw(cmd, [0.0, 0.0], prepared);
                        drawn.expect("draws");
                    },
                )
            };
            let times = renderer.borrow_mut().pass_times();
            assert!(!times.is_empty() || device.support().timestamp_period == 0.0);
            let statistics = renderer.borrow_mut().pass_statistics();
            assert_eq!(statistics.is_empty(), !device.support().pipeline_statistics);
            assert!(
                picture == truth,
                "{raster:?}, {bindings:?}, {planes} planes: not the headless picture"
            );
        }
    }
    drop((buffers, device));
    // SAFETY: everything of rara's is dropped.
    assert_eq!(unsafe { host.close() }, Vec::<String>::new());
}
