//! Recording a frame allocates nothing on the heap: an engine may do it in its hottest loop.

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

use crate::common;
use crate::common::folder::has_run_alone;
use rara::ash::vk;
use rara::scene::{Kind, generate};
use rara::{ClipOp, Renderer, RendererDesc, SceneBuffers, Settings, ShFormat};
use rara_gpu::{Drawer, ImageDesc};

/// The system's allocator, which counts what this thread asks of it.
struct Counting;

thread_local! {
    static ASKED: Cell<usize> = const { Cell::new(0) };
}

// SAFETY: every call goes to the system's allocator as it came.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        let _ = ASKED.try_with(|asked| asked.set(asked.get() + 1));
        // SAFETY: the caller's promise.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, memory: *mut u8, layout: Layout) {
        // SAFETY: the caller's promise.
        unsafe { System.dealloc(memory, layout) };
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

const SIZE: (u32, u32) = (160, 120);
const FORMAT: vk::Format = vk::Format::R32G32B32A32_SFLOAT;

#[test]
fn recording_allocates_nothing() {
    if has_run_alone(recording_allocates_nothing) {
        return;
    }
    let scene = generate(Kind::General, 2_000, 5);
    let camera = common::views(&scene, 1, SIZE)[0];
    for bindings in common::bindings(common::headless().device()) {
        // No validation layer, since it puts functions of its own between.
        let headless = common::headless_unchecked(bindings);
        let device = headless.device();
        let buffers = SceneBuffers::upload(device, &scene, ShFormat::Packed).expect("uploads");
        let target = device.create_image(&ImageDesc {
            name: "target",
            width: SIZE.0,
            height: SIZE.1,
            format: FORMAT,
        });
        let target = target.expect("a target");
        let rasters = common::rasters(device).into_iter();
        for (raster, reuse) in rasters.flat_map(|r| [(r, false), (r, true)]) {
            let desc = RendererDesc::new(FORMAT)
                .bindings(bindings)
                .reuse(reuse)
                .timing(true);
            let mut renderer = Renderer::new(device, desc).expect("a renderer");
            let settings = Settings::default().raster(raster);
            for (number, planes) in [0, 1, 3, 1, 1].into_iter().enumerate() {
                let clip = common::clip(&scene, planes, ClipOp::And);
                let configured = renderer.configure(&buffers, &camera, &clip, &settings);
                let frame = configured.expect("configures");
                let submitted = device.submit_and_wait(|cmd| {
                    let before = ASKED.get();
                    // SAFETY: `cmd` is recording outside rendering; all that is used outlives the wait. The scope is
                    // opened and closed around the draw, on an attachment of the renderer's format.
                    unsafe {
                        let frame = renderer.prepare(cmd, &buffers, None, frame)?;
                        target.begin_rendering(cmd, [0.0; 4]);
                        let area = target.extent().into();
                        Drawer::new(device, cmd, None).viewport(area);
                        renderer.draw(cmd, [0.0; 2], &frame)?;
                        target.end_rendering(cmd);
                    }
                    let asked = ASKED.get() - before;
                    assert_eq!(
                        asked, 0,
                        "{raster:?}, {bindings:?}, reuse {reuse}, frame {number}"
                    );
                    Ok(())
                });
                submitted.expect("submits");
            }
        }
    }
    assert!(ASKED.get() > 0, "everything else does");
}
