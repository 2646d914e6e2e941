//! Stage `depth`: how deep each splat is, on average of what the clip leaves of it.

use rara::gpu::{Bindings, Device, DeviceDesc};
use rara::types::{FrameCounts, Gaussian, SplatDepth};
use rara::{
    Camera, Clip, ClipOp, ExpectedDepthDesc, Layer, LayerState, Mode, Raster, Renderer,
    RendererDesc, Scene, SceneBuffers, Settings, ShFormat,
};
use rara_reference::depth;
use rara_reference::{Footprint, Real, ViewTransform};

use crate::stages::frame;
use crate::stages::layers;

/// The values that the stage has written of each splat, and the splat's number in the scene.
fn depths<'a>(
    device: &Device,
    renderer: &mut Renderer,
    scene: impl Into<Scene<'a>>,
    camera: &Camera,
    clip: &Clip,
) -> Vec<(usize, SplatDepth)> {
    let scene = scene.into();
    let there = SceneBuffers::upload(device, &scene, ShFormat::Float).expect("uploads");
    let configured = renderer.configure(&there, camera, clip, &settings());
    let frame = configured.expect("configures");
    let submitted = device.submit_and_wait(|cmd| {
        // SAFETY: `cmd` is recording outside a scope, and all outlives the wait for it.
        unsafe { renderer.prepare(cmd, &there, None, frame) }
    });
    submitted.expect("runs");
    if scene.gaussians() == 0 {
        return Vec::new();
    }
    let read = |name| renderer.working_buffer(name).expect(name);
    let counts: FrameCounts = bytemuck::pod_read_unaligned(&read("counts"));
    let splat_gaussians = (counts.visible + counts.cutoff) as usize;
    let gaussians: Vec<Gaussian> =
        bytemuck::pod_collect_to_vec(&renderer.scene_buffer(&there, "gaussians").expect("them"));
    let indices: Vec<u32> = bytemuck::pod_collect_to_vec(&read("splat_gaussians"));
    let number = |index: u32| gaussians[index as usize].scale[3].to_bits() as usize;
    let numbers = indices.into_iter().map(number);
    // They follow the splats: see glsl/splats.glsl.
    let count = scene.gaussians();
    let splats = read("splats");
    let depths =
        splats[16 * (4 * count + count.div_ceil(4))..].chunks_exact(size_of::<SplatDepth>());
    let depths = depths.map(bytemuck::pod_read_unaligned);
    numbers.zip(depths).take(splat_gaussians).collect()
}

fn settings() -> Settings {
    Settings::default().mode(Mode::Exact).raster(Raster::Quad)
}

/// The mean depth that the fragment stage computes from a record at an offset from the splat's centre, and the share that
/// it is of.
fn mean(depth: &SplatDepth, [dx, dy]: [f64; 2]) -> [f64; 2] {
    let at = |[a, b, c, _]: [f32; 4]| f64::from(a) + f64::from(b) * dx + f64::from(c) * dy;
    let density = |z: f64| (-0.5 * z * z).exp() / std::f64::consts::TAU.sqrt();
    let whole = at(depth.mean);
    let low = -at(depth.far).clamp(-8.0, 8.0);
    let high = at(depth.near).clamp(-8.0, 8.0);
    let moment = f64::from(depth.far[3]) * density(low) + f64::from(depth.near[3]) * density(high);
    let between = if low + high > 0.0 {
        (-low).phi() - (-high).phi()
    } else {
        high.phi() - low.phi()
    };
    match (low < high, depth.mean[3] < 0.0) {
        (false, _) => [whole, 0.0],
        (true, false) => [whole + moment / between, between],
        (true, true) => [whole - moment / (1.0 - between), 1.0 - between],
    }
}

/// A device under validation, and a renderer that draws depths.
fn renderer() -> (Device, Renderer) {
    let device = Device::headless(
        &DeviceDesc::default()
            .selector(std::env::var("RARA_TEST_DEVICE").ok())
            .validation(true),
    );
    let device = device.expect("a device and the validation layer");
    let format = rara::ash::vk::Format::R32G32B32A32_SFLOAT;
    let desc = RendererDesc::new(format)
        .bindings(Bindings::Mixed)
        .expected_depth(Some(ExpectedDepthDesc::new(format)));
    let renderer = Renderer::new(&device, desc).expect("a renderer");
    (device, renderer)
}

/// Depths of placed layers are in the scene's units: each layer's are those of the layer alone, times its unit. Units
/// are powers of two, by which no number is rounded.
#[test]
fn depths_of_layers_are_in_the_scenes_units() {
    let (device, mut renderer) = renderer();
    let parts = [300, 2_000].map(frame::scene);
    let placements = layers::placements();
    let placements = [placements[0], placements[2]];
    let of_layers = parts.iter().zip(placements).map(|(part, placement)| {
        Layer::new("part", part).with(LayerState::default().placement(placement))
    });
    let scene: Scene<'_> = of_layers.collect();
    let camera = frame::views(&parts[1])[0];
    for (planes, op) in [(1, ClipOp::And), (2, ClipOp::Or)] {
        let clip = frame::clip(&parts[1], planes, op);
        let mut together = depths(&device, &mut renderer, &scene, &camera, &clip).into_iter();
        let mut first = 0;
        for (part, placement) in parts.iter().zip(placements) {
            let (own, kept) = (camera.in_scene(&placement), clip.in_scene(&placement));
            let unit = placement.scale() as f32;
            let alone = depths(&device, &mut renderer, part, &own, &kept);
            assert!(alone.len() > 100, "{} survive", alone.len());
            for (number, mut one) in alone {
                one.mean = one.mean.map(|value| value * unit);
                one.far[3] *= unit;
                one.near[3] *= unit;
                let (ours, theirs) = together.next().expect("as many survive");
                assert_eq!(ours, first + number);
                assert_eq!(
                    bytemuck::bytes_of(&theirs),
                    bytemuck::bytes_of(&one),
                    "{number}"
                );
            }
            first += part.len();
        }
        assert!(together.next().is_none(), "as many survive");
    }
    drop(renderer);
    assert_eq!(device.close(), Vec::<String>::new());
}

#[test]
fn mean_depths_are_the_twins() {
    let (device, mut renderer) = renderer();
    let (mut worst, mut moved, mut compared) = (0.0_f64, 0.0_f64, 0);
    for scene in frame::scenes() {
        for (view, planes, op) in [
            (0, 1, ClipOp::And),
            (1, 3, ClipOp::And),
            (0, 2, ClipOp::Or),
            (2, 1, ClipOp::And),
        ] {
            let camera = frame::views(&scene)[view];
            let single = ViewTransform::<f32>::new(&camera);
            let clip = frame::clip(&scene, planes, op);
            for (index, ours) in depths(&device, &mut renderer, &scene, &camera, &clip) {
                let Some(footprint) = Footprint::new(&scene, index, &single) else {
                    continue; // a tie of stage classify
                };
                let twin = depth::SplatDepth::new(&scene, index, &footprint, &clip, &settings());
                let whole = depth::SplatDepth::new(
                    &scene,
                    index,
                    &footprint,
                    &Clip::default(),
                    &settings(),
                );
                let deviation = f64::from(footprint.rows[2].length());
                let [k0, k1, k2] = footprint.conic.map(f64::from);
                for (u, v) in [(0.0, 0.0), (1.0, 0.0), (0.0, 1.5), (-1.2, -1.2)] {
                    let (dx, dy) = (u / k0, (v - k1 * u / k0) / k2);
                    let [ours, share] = mean(&ours, [dx, dy]);
                    // The depth of nearly nothing is a quotient of two roundings.
                    if share < 0.01 || deviation == 0.0 {
                        continue;
                    }
                    let at = |depth: &depth::SplatDepth<f32>| {
                        f64::from(depth.mean(dx as f32, dy as f32))
                    };
                    let ulp = f64::from(f32::EPSILON) * f64::from(footprint.relative.length());
                    let apart = (ours - at(&twin)).abs();
                    worst = worst.max(apart / (deviation + 1e3 * ulp));
                    moved = moved.max((at(&twin) - at(&whole)).abs() / deviation);
                    compared += 1;
                }
            }
        }
    }
    println!("{worst} deviations apart at worst of {compared}; the clip moves up to {moved}");
    assert!(compared > 100_000 && moved > 1.0, "{compared}, {moved}");
    // Of a splat's own thickness along the view axis, beside the rounding of its distance.
    assert!(worst <= 2e-3, "{worst}");
    drop(renderer);
    assert_eq!(device.close(), Vec::<String>::new());
}
