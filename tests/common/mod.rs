//! Everything that the tests share: scenes, views around them, planes through them, and a renderer under validation.
#![allow(dead_code, unreachable_pub, reason = "each test binary uses a part")]

pub mod folder;

use std::collections::VecDeque;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};

use glam::DVec3;
use rara::gpu::{Bindings, Device, DeviceShape};
use rara::scene::{Bounds, Kind, generate, load};
use rara::types::Splat;
use rara::{
    Camera, Clip, ClipOp, FrameStats, Gaussians, Headless, HeadlessDesc, Picture, PipelineCache,
    Plane, Projection, Raster, Settings,
};
use rara_lab::measure::differences;

/// The scale of generated scenes and pictures against the usual size, `RARA_TEST_SCALE`, for slow drivers. The tests'
/// bounds are the same at every scale.
pub fn scale() -> f64 {
    let text = std::env::var("RARA_TEST_SCALE").unwrap_or("1".into());
    let scale: f64 = text.parse().expect("RARA_TEST_SCALE is a number");
    assert!((0.1..=1.0).contains(&scale), "RARA_TEST_SCALE is 0.1 to 1");
    scale
}

/// A picture's size at that scale.
pub fn scaled((width, height): (u32, u32)) -> (u32, u32) {
    let scaled = |pixels| (f64::from(pixels) * scale().sqrt()) as u32;
    (scaled(width), scaled(height))
}

/// The splats of a buffer, which lie as glsl/splats.glsl says.
pub fn splats(buffer: &[[f32; 4]], gaussians: usize, shape: DeviceShape) -> Vec<Splat> {
    let apart = shape != DeviceShape::Cpu;
    let of = |splat: usize| {
        let place = splat * if apart { 3 } else { 4 };
        let [centre_conic, conic_cut, colour_cut] = [0, 1, 2].map(|part| buffer[place + part]);
        let mut curvature_depth = buffer[if apart {
            3 * gaussians + splat
        } else {
            place + 3
        }];
        if apart {
            // Only those of cut splats are there.
            if conic_cut[2] >= 1e30 {
                curvature_depth = [0.0; 4];
            }
            curvature_depth[3] = buffer[4 * gaussians + splat / 4][splat % 4];
        }
        Splat {
            centre_conic,
            conic_cut,
            colour_cut,
            curvature_depth,
        }
    };
    (0..gaussians).map(of).collect()
}

/// The ways to reach buffers that users have on a device.
pub fn bindings(device: &Device) -> Vec<Bindings> {
    let mut all = vec![Bindings::Address];
    if device.support().push_descriptor {
        all.push(Bindings::Mixed);
    }
    all
}

/// The ways of drawing that a device has.
pub fn rasters(device: &Device) -> Vec<Raster> {
    let mut rasters = vec![Raster::Tiles, Raster::Quad];
    if device.support().mesh_shader {
        rasters.push(Raster::Mesh);
    }
    rasters
}

/// A generator of numbers below a limit, the same ones in every run.
pub fn picker(seed: u64) -> impl FnMut(usize) -> usize {
    let mut state = seed;
    move |count| {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        (state >> 33) as usize % count
    }
}

/// A renderer whose every validation message is an error, with the bindings that users have on CPU drivers, which compile these
/// in a fraction of the time. tests/gpu_cost/hazards.rs has every kind of frame with all buffers bound, where the synchronisation
/// checks see them.
pub fn headless() -> Headless {
    headless_by(Bindings::Mixed)
}

/// A renderer whose every validation message is an error.
pub fn headless_by(bindings: Bindings) -> Headless {
    open(bindings, true)
}

/// A renderer without the layer.
pub fn headless_unchecked(bindings: Bindings) -> Headless {
    open(bindings, false)
}

/// A renderer whose every validation message is an error, with the pipelines for a kind of device.
pub fn headless_shaped(bindings: Bindings, shape: DeviceShape) -> Headless {
    opened(&desc(bindings, true).shape(Some(shape)))
}

fn open(bindings: Bindings, validation: bool) -> Headless {
    opened(&desc(bindings, validation))
}

fn desc(bindings: Bindings, validation: bool) -> HeadlessDesc {
    HeadlessDesc::default()
        .device(std::env::var("RARA_TEST_DEVICE").ok())
        .validation(validation)
        .bindings(Some(bindings))
        .pipeline_cache(PipelineCache::Off)
}

fn opened(desc: &HeadlessDesc) -> Headless {
    Headless::new(desc)
        .expect("a Vulkan device and the validation layer (tools/test installs both)")
}

/// The folder in which tools/test has put the decoded scenes, if it found any.
fn decoded_scenes() -> Option<PathBuf> {
    std::env::var_os("RARA_SCENES")
        .map(PathBuf::from)
        .filter(|folder| folder.is_dir())
}

/// The trained scenes, each under its name; prints a message where they are absent. `RARA_TEST_SCENES` names those to
/// take, for slow drivers.
pub fn trained_scenes() -> Vec<(String, Gaussians)> {
    let Some(folder) = decoded_scenes() else {
        eprintln!(
            "SKIPPED: no trained scenes here (RARA_SCENES names no folder); generated ones are still tested"
        );
        return Vec::new();
    };
    let layers = [
        "mni_0_envelope",
        "mni_1_grey_matter",
        "mni_2_white_matter",
        "mni_3_csf_ventricles",
    ];
    let mut scenes: Vec<(&str, Vec<&str>)> = vec![("mni_layers", layers.to_vec())];
    for name in [
        "playbot_L3",
        "leica_8192_inria",
        "skull",
        "heart",
        "hair_bear",
    ] {
        scenes.push((name, vec![name]));
    }
    let wanted = std::env::var("RARA_TEST_SCENES").ok();
    let is_wanted = |name: &str| {
        let wanted = wanted.as_deref();
        wanted.is_none_or(|wanted| wanted.split(',').any(|part| part == name))
    };
    scenes
        .iter()
        .filter(|(name, _)| is_wanted(name))
        .map(|(name, files)| (name.to_string(), merged(&folder, files)))
        .collect()
}

fn merged(folder: &std::path::Path, files: &[&str]) -> Gaussians {
    let mut scene = Gaussians::default();
    for file in files {
        let path = folder.join(file).with_extension("ply");
        scene.append(
            &load(&path, &mut |_, _| {})
                .expect("a shared scene loads")
                .gaussians,
        );
    }
    scene
}

/// One generated scene of each kind.
pub fn generated_scenes(count: usize) -> Vec<(String, Gaussians)> {
    let count = (count as f64 * scale()) as usize;
    let kinds = [
        ("general", Kind::General),
        ("strands", Kind::Strands),
        ("layers", Kind::Layers),
    ];
    kinds
        .iter()
        .map(|(name, kind)| (format!("generated {name}"), generate(*kind, count, 1)))
        .collect()
}

/// Some Gaussians of a scene.
pub fn picked(scene: &Gaussians, indices: impl IntoIterator<Item = usize>) -> Gaussians {
    let mut picked = Gaussians::default();
    picked.set_sh_degree(scene.sh_degree());
    picked.set_training(scene.training()).expect("as it was");
    for index in indices {
        picked.push(
            scene.positions()[index],
            scene.scales()[index],
            scene.rotations()[index],
            scene.opacities()[index],
            scene.sh_of(index),
        );
    }
    picked
}

/// `count` views around a scene, from changing heights.
pub fn views(scene: &Gaussians, count: usize, size: (u32, u32)) -> Vec<Camera> {
    let bounds = Bounds::of(scene);
    let centre = bounds.centre();
    let view = |index: usize| {
        let turn = index as f64 / count as f64 * std::f64::consts::TAU + 0.3;
        let height = [0.35, -0.2, 0.7][index % 3];
        let direction = DVec3::new(turn.cos(), -height, turn.sin()).normalize();
        let eye = centre + direction * bounds.radius() * 2.2;
        Camera::look_at(eye, centre, -DVec3::Y, 50.0, size).expect("a view from outside")
    };
    (0..count).map(view).collect()
}

/// The orthographic camera in the place of one in perspective, which shows the middle of a scene at the scale that it has
/// from outside.
pub fn flattened(camera: &Camera, scene: &Gaussians) -> Camera {
    let scale = camera.fy / (2.2 * Bounds::of(scene).radius());
    let scale = if scale > 0.0 { scale } else { camera.fy };
    let flat = camera.projection(Projection::Orthographic);
    flat.fx(scale).fy(scale)
}

/// `count` oblique planes through the middle of a scene that together leave a part of it.
pub fn clip(scene: &Gaussians, count: usize, op: ClipOp) -> Clip {
    let bounds = Bounds::of(scene);
    let normals = [
        DVec3::new(0.9, 0.3, 0.2),
        DVec3::new(-0.8, 0.1, 0.7),
        DVec3::new(0.1, -0.9, 0.3),
        DVec3::new(0.2, 0.8, -0.4),
        DVec3::new(-0.3, 0.2, -0.9),
        DVec3::new(0.5, 0.5, 0.6),
    ];
    let plane = |(index, normal): (usize, &DVec3)| {
        // The first plane goes through the centre, the others away from it, so that the intersection is not empty.
        let shift = if index == 0 {
            0.0
        } else {
            0.3 * bounds.radius()
        };
        Plane::new(
            *normal,
            -normal.dot(bounds.centre()) + shift * normal.length(),
        )
        .expect("a proper plane")
    };
    Clip::of(normals.iter().take(count).enumerate().map(plane), op)
}

/// The clip with its first plane moved so that it keeps that much more.
pub fn moved(mut clip: Clip, by: f64) -> Clip {
    let plane = clip.surfaces[0].as_plane().expect("a plane");
    let moved = Plane::new(plane.normal(), plane.offset() + by);
    clip.surfaces[0] = moved.expect("a plane").into();
    clip
}

/// Asserts the project's bounds: 60 dB into a 32-bit target, 48 dB through 8 bits, and at most one pixel in a thousand
/// further off than 2/255 (a splat that f32 puts on the other side of alpha = 1/255 or of a neighbour).
pub fn assert_agrees(what: &str, ours: &Picture, truth: &Picture) {
    let float = differences(ours, truth).expect("the same size");
    assert!(
        float.psnr >= 60.0,
        "{what}: {:.1} dB into a 32-bit target: {float:?}",
        float.psnr
    );
    assert!(
        float.share_over_2 <= 0.001,
        "{what}: {:.3} % of pixels over 2/255",
        100.0 * float.share_over_2
    );
    let png = differences(&ours.quantised(), &displayable(truth)).expect("the same size");
    assert!(
        png.psnr >= 48.0,
        "{what}: {:.1} dB through 8 bits",
        png.psnr
    );
}

/// The picture as 8 bits could show it without rounding: colours beyond white become white.
fn displayable(picture: &Picture) -> Picture {
    let pixels = picture
        .pixels
        .iter()
        .map(|&[r, g, b, a]| [r.min(a), g.min(a), b.min(a), a]);
    Picture {
        pixels: pixels.collect(),
        ..*picture
    }
}

/// The reference's frame in double precision. The last ones are kept, since most tests draw one frame in several ways; what
/// the reference does not know, how splats become pixels and how numbers are stored, is the usual in all of them.
pub fn truth(
    scene: &Gaussians,
    camera: &Camera,
    clip: &Clip,
    settings: &Settings,
) -> Arc<rara_reference::ReferenceFrame> {
    /// A frame takes .3 to 1 MB.
    const KEPT: usize = 40;
    static LAST: Mutex<VecDeque<(String, Arc<rara_reference::ReferenceFrame>)>> =
        Mutex::new(VecDeque::new());
    let usual = Settings::default();
    let mut settings = settings.raster(usual.raster);
    settings.precision = usual
        .precision
        .beam_switch(settings.precision.beam_switch)
        .transmittance_min(settings.precision.transmittance_min);
    let mut hash = DefaultHasher::new();
    bytemuck::cast_slice::<_, u8>(scene.positions()).hash(&mut hash);
    bytemuck::cast_slice::<_, u8>(scene.scales()).hash(&mut hash);
    bytemuck::cast_slice::<_, u8>(scene.rotations()).hash(&mut hash);
    bytemuck::cast_slice::<_, u8>(scene.opacities()).hash(&mut hash);
    bytemuck::cast_slice::<_, u8>(scene.sh()).hash(&mut hash);
    let scene_key = (
        hash.finish(),
        scene.sh_degree(),
        scene.training(),
        scene.origin(),
    );
    // Numbers are written so that different ones differ.
    let key = format!("{scene_key:?} {camera:?} {clip:?} {settings:?}");
    let mut last = LAST.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some((_, frame)) = last.iter().find(|(known, _)| *known == key) {
        return frame.clone();
    }
    let frame = rara_reference::render::<f64>(scene, camera, clip, &settings);
    let frame = Arc::new(frame);
    last.truncate(KEPT - 1);
    last.push_front((key, frame.clone()));
    frame
}

/// Asserts that a frame is the reference's: the picture within the bounds above, the counts except for a few. Returns its
/// statistics.
pub fn check(
    headless: &mut Headless,
    name: &str,
    scene: &Gaussians,
    camera: &Camera,
    clip: &Clip,
    settings: &Settings,
) -> FrameStats {
    let stats = headless.render(camera, clip, settings).expect("renders");
    let picture = headless.picture().expect("reads back");
    let truth = truth(scene, camera, clip, settings);
    let what = format!(
        "{name}, {:?}, {} planes {:?}",
        settings.mode,
        clip.surfaces.len(),
        clip.op
    );
    assert_agrees(&what, &picture, &truth.picture);
    let total = |c: rara::Counts| c.visible + c.cutoff + c.invisible + c.culled;
    assert_eq!(
        total(stats.counts) as usize,
        scene.len(),
        "{what}: every Gaussian is counted once"
    );
    // f32 may put a splat that only just touches a pixel or a band on the other side: one in a thousand at most.
    let slack = 2 + scene.len() as u32 / 1000;
    for (ours, theirs) in [
        (stats.counts.visible, truth.counts.visible),
        (stats.counts.cutoff, truth.counts.cutoff),
        (stats.counts.invisible, truth.counts.invisible),
        (stats.counts.culled, truth.counts.culled),
    ] {
        assert!(
            ours.abs_diff(theirs) <= slack,
            "{what}: counts {:?} against {:?}",
            stats.counts,
            truth.counts
        );
    }
    stats
}
