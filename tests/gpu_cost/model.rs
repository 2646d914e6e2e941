//! What the model of GPUs (`rara_lab::measure::gpu_model`) is fed with: the numbers of frames, counted on whatever device there is,
//! and the estimates of a GPU's compiler.

use std::collections::BTreeSet;
use std::path::Path;
use std::{env, fs};

use rara::Training;
use rara::ash::vk;
use rara::gpu::{Device, DeviceDesc, DeviceShape};
use rara::types::{FrameData, Splat};
use rara::{Gaussians, Mode, Raster, Renderer, RendererDesc, SceneBuffers, Settings, ShFormat};
use rara_base::limits;
use rara_lab::measure::gpu_model::{
    self, COSTS, FRAMES_FILE, FrameNumbers, ModelFrame, PIPELINES_FILE, PipelineEstimate, frames,
    pipelines,
};

use crate::common;
use crate::common::folder::Folder;
use crate::frames::Drawn;
use crate::passes::{groups, numbers};
use crate::pipelines::{Driver, OUT};

/// The GPU whose compiler's estimates the model takes.
const GPU: &str = "navi31";
/// The scenes' sizes.
const GAUSSIANS: [usize; 2] = [1_000_000, 5_000_000];

/// Draws a scene as `rara render --raster tiles` would, with a clip or without, and with room for all pairs.
fn draw(device: &Device, scene: &Gaussians, is_cut: bool) -> Drawn {
    let camera = gpu_model::camera(scene).expect("a camera");
    let clip = gpu_model::clip(is_cut).expect("a clip");
    let buffers = SceneBuffers::upload(device, scene, ShFormat::Packed).expect("uploads");
    let desc = RendererDesc::new(vk::Format::R32G32B32A32_SFLOAT);
    let mut renderer = Renderer::new(device, desc).expect("a renderer");
    let settings = Settings::default().mode(Mode::Exact).raster(Raster::Tiles);
    // The first frames learn how many pairs there are.
    for _ in 0..3 {
        renderer.forget();
        let frame = renderer
            .configure(&buffers, &camera, &clip, &settings)
            .expect("it can be drawn");
        let submitted = device.submit_and_wait(|cmd| {
            // SAFETY: `cmd` is recording outside rendering, and all that is used outlives the wait.
            unsafe { renderer.prepare(cmd, &buffers, None, frame) }
        });
        submitted.expect("it is drawn");
    }
    Drawn::new(device.recorded(), renderer)
}

/// Takes minutes, and gigabytes of memory.
#[test]
#[ignore = "its results are the same on every device: RARA_RENEW_BUDGET=1 writes them anew, else they are compared"]
fn the_models_frames_are_counted() {
    let desc = DeviceDesc::default().selector(env::var("RARA_TEST_DEVICE").ok());
    let device = Device::headless_inspected(&desc).expect("a Vulkan device");
    let [least, most] = device.support().full_subgroups;
    drop(device);
    let shape = DeviceShape::Gpu {
        subgroup: 32.clamp(least, most),
    };
    let device = Device::headless_inspected(&desc.shape(Some(shape))).expect("a Vulkan device");
    let mut found = Vec::new();
    for gaussians in GAUSSIANS {
        let scene = gpu_model::scene(gaussians);
        for is_cut in [false, true] {
            let drawn = draw(&device, &scene, is_cut);
            found.push(counted(gaussians, &drawn, is_cut));
        }
    }
    if env::var_os("RARA_RENEW_BUDGET").is_none() {
        assert_eq!(frames(), found);
        return;
    }
    write(FRAMES_FILE, &gpu_model::text(&found));
}

fn write(file: &str, text: &str) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(file);
    fs::write(path, text).expect("src/ is writable");
}

fn counted(gaussians: usize, drawn: &Drawn, is_cut: bool) -> ModelFrame {
    let dispatches = drawn.recorded.dispatches.iter();
    let names = dispatches.filter(|dispatch| groups(drawn, dispatch) > 0);
    let data: FrameData =
        bytemuck::pod_read_unaligned(&drawn.buffer("frame")[..size_of::<FrameData>()]);
    let found = numbers(drawn);
    let mut numbers = FrameNumbers {
        surfaces: is_cut.into(),
        // Without their stages nobody writes how many there are.
        clip_blocks: if is_cut { found.clip_blocks } else { 0 },
        changed: 0,
        ..found
    };
    assert!(numbers.pairs > 0, "the pairs have room");
    let splats: Vec<[f32; 4]> = bytemuck::pod_collect_to_vec(&drawn.buffer("splats"));
    let shape = DeviceShape::Gpu { subgroup: 0 };
    let splats = common::splats(&splats, data.scene.gaussian_count as usize, shape);
    let splats = &splats[..numbers.splats as usize];
    numbers.tied = tied(splats, &data);
    numbers.masked_pairs = masked(drawn, numbers.macro_pairs);
    numbers.loaded = loaded(splats, drawn, &data);
    ModelFrame {
        gaussians,
        is_cut,
        numbers,
        dispatches: names.map(|dispatch| dispatch.name.to_owned()).collect(),
    }
}

/// The most splats that have one key.
fn tied(splats: &[Splat], data: &FrameData) -> u64 {
    let order = &data.order;
    let key = |splat: &Splat| {
        let depth = splat.curvature_depth[3].to_bits().max(order.key_near) - order.key_near;
        depth.min(order.key_span) >> order.key_shift
    };
    let mut keys: Vec<u32> = splats.iter().map(key).collect();
    keys.sort_unstable();
    let same = keys.chunk_by(|a, b| a == b).map(<[u32]>::len);
    same.max().unwrap_or(0) as u64
}

/// The pairs of macro-tile and splat whose keys are marked as those that need the splat's mask (glsl/macro_tiles.glsl).
fn masked(drawn: &Drawn, pairs: u64) -> u64 {
    let keys: Vec<u32> = bytemuck::pod_collect_to_vec(&drawn.buffer("macro_keys"));
    keys[..pairs as usize]
        .iter()
        .filter(|key| *key >> 31 == 1)
        .count() as u64
}

/// The splats that tiles load, a batch at a time, before all of their pixels are saturated; as if none were cut.
fn loaded(splats: &[Splat], drawn: &Drawn, data: &FrameData) -> u64 {
    let lists: Vec<u32> = bytemuck::pod_collect_to_vec(&drawn.buffer("tile_splats"));
    let begins: Vec<u32> = bytemuck::pod_collect_to_vec(&drawn.buffer("tile_begins"));
    let tiles = &data.tiles;
    let [width, height] = [limits::TILE_WIDTH, limits::TILE_HEIGHT];
    let [columns, rows] = [data.views[0].size[0], data.views[0].size[1]];
    let mut sum = 0;
    for tile in 0..tiles.tile_count {
        let corner = [
            tile % tiles.tile_columns * width,
            tile / tiles.tile_columns * height,
        ];
        let list = &lists[begins[tile as usize] as usize..begins[tile as usize + 1] as usize];
        let pixels = (0..width * height).map(|i| [corner[0] + i % width, corner[1] + i / width]);
        let mut pixels: Vec<([f32; 2], f32)> = pixels
            .map(|at| at.map(|at| at as f32 + 0.5))
            .filter(|at| at[0] < columns && at[1] < rows)
            .map(|at| (at, 1.0))
            .collect();
        for batch in list.chunks((width * height) as usize) {
            sum += batch.len() as u64;
            for &splat in batch {
                let splat = &splats[splat as usize];
                for (at, transmittance) in &mut pixels {
                    *transmittance *= 1.0 - alpha(splat, *at);
                }
            }
            pixels.retain(|(_, transmittance)| *transmittance >= tiles.transmittance_min);
            if pixels.is_empty() {
                break;
            }
        }
    }
    sum
}

/// The alpha of a splat in a pixel, as tiles compute it.
fn alpha(splat: &Splat, at: [f32; 2]) -> f32 {
    let [x, y, k0, k1] = splat.centre_conic;
    let [k2, opacity, ..] = splat.conic_cut;
    let (u, v) = (k0 * (at[0] - x), k1 * (at[0] - x));
    let w = v + k2 * (at[1] - y);
    let alpha = Training::default()
        .alpha_max
        .min(opacity * (-0.5 * (u * u + w * w)).exp());
    if alpha >= limits::ALPHA_MIN {
        alpha
    } else {
        0.0
    }
}

#[test]
fn the_models_pipelines_are_as_a_gpus_compiler_estimates_them() {
    let driver = match Driver::find() {
        Ok(driver) => driver,
        Err(reason) => {
            eprintln!("SKIPPED: NO GPU'S COMPILER SAW THE MODEL'S PIPELINES: {reason}");
            return;
        }
    };
    let folder = Folder::new("gpu_model");
    let out = folder.join("pipelines");
    let child = driver.start(
        GPU,
        "model::pipelines_of_the_device_that_is_pretended",
        &out,
    );
    let output = child.wait_with_output().expect("the child process ends");
    let error = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{error}");
    let found = fs::read_to_string(out).expect("what the child has found");
    if env::var_os("RARA_RENEW_BUDGET").is_some() {
        write(PIPELINES_FILE, &found);
        return;
    }
    let (committed, found) = (pipelines(), gpu_model::parse::<PipelineEstimate>(&found));
    let names = |all: &[PipelineEstimate]| -> Vec<_> {
        let name = |pipeline: &PipelineEstimate| (pipeline.pass.clone(), pipeline.is_cut);
        all.iter().map(name).collect()
    };
    assert_eq!(
        names(&committed),
        names(&found),
        "RARA_RENEW_BUDGET=1 writes them anew"
    );
    for (committed, found) in committed.iter().zip(&found) {
        // Versions of the compiler differ.
        for (before, now) in [
            (committed.latency, found.latency),
            (committed.cycles, found.cycles),
        ] {
            assert!(
                (0.8..1.25).contains(&(now as f64 / before as f64)),
                "{}: {before} cycles were {now}; RARA_RENEW_BUDGET=1 writes that down",
                found.pass
            );
        }
    }
}

/// Makes the pipelines of the model's frames on whatever device there is, and writes what they are estimated at.
#[test]
#[ignore = "another test starts this one for the GPU that is pretended"]
fn pipelines_of_the_device_that_is_pretended() {
    let out = env::var_os(OUT).expect("the test that starts this one names a file");
    let scene = gpu_model::scene(2000);
    let mut pipelines = Vec::new();
    for is_cut in [false, true] {
        // A device of its own, so that it has made no other frame's pipelines.
        let device = Device::headless_inspected(&DeviceDesc::default()).expect("a device");
        let drawn = draw(&device, &scene, is_cut);
        let recorded: BTreeSet<_> = drawn.recorded.dispatches.iter().map(|d| d.name).collect();
        for pass in recorded {
            assert!(
                COSTS.iter().any(|cost| cost.name == pass),
                "{pass} has no cost"
            );
            let shaders = device.compiled_shaders();
            let mut of_pass = shaders.iter().filter(|shader| shader.name == pass);
            let shader = of_pass.next().expect("it was compiled");
            assert!(
                of_pass.all(|other| other.constants == shader.constants),
                "{pass}"
            );
            let number = |name| shader.numbers.iter().find(|(known, _)| known == name);
            let [latency, cycles] = ["Latency", "Inverse Throughput"].map(|name| {
                number(name)
                    .unwrap_or_else(|| panic!("{pass}: no {name}"))
                    .1
            });
            pipelines.push(PipelineEstimate {
                pass: pass.into(),
                is_cut,
                latency,
                cycles,
            });
        }
    }
    fs::write(out, gpu_model::text(&pipelines)).expect("the file is writable");
}
