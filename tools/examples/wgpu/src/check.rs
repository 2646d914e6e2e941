//! Compares the host's pictures with those that rara draws without a host, while the validation layer watches.

use half::f16;
use rara::glam::DMat4;
use rara::gpu::{Bindings, PipelineCache};
use rara::scene::{Kind, generate};
use rara::{Camera, Gaussians, Headless, HeadlessDesc, Picture, Precision, TargetFormat};
use wgpu::hal::api::Vulkan;

use crate::Failure;
use crate::host::Host;
use crate::meshes::{Meshes, Wall};
use crate::splats::{Eye, Splats};
use crate::target::Target;
use crate::world::{BACKGROUND, World};

/// No multiple of anything, so that nothing is right by chance.
const SIZE: (u32, u32) = (189, 131);

const FORMATS: [(wgpu::TextureFormat, TargetFormat); 2] = [
    (wgpu::TextureFormat::Rgba8Unorm, TargetFormat::Unorm8),
    (wgpu::TextureFormat::Rgba16Float, TargetFormat::Half),
];

/// Onto nothing the picture is the headless one, byte for byte; onto what the host has drawn it is that over it, and what is
/// behind a wall is hidden. The validation layer has nothing to say of any of it.
pub(crate) fn check(device: &str) -> Result<(), Failure> {
    let world = World::new(generate(Kind::General, 3_000, 5), SIZE)?;
    let host = Host::new(device, true)?;
    let bindings = Bindings::suiting(&host.rara);
    let mut headless = Headless::new(
        &HeadlessDesc::default()
            .device(Some(host.rara.info().name.clone()))
            .bindings(Some(bindings))
            .pipeline_cache(PipelineCache::Off),
    )?;
    for (format, target) in FORMATS {
        let camera = world.view.camera;
        for eyes in [&[camera][..], &world.eyes()] {
            let drawn = draw(&host, &world, format, world.nothing(), eyes, true)?;
            for (bytes, camera) in drawn.iter().zip(eyes) {
                let truth = draw_headless(&mut headless, &world, &world.scene, camera, target)?;
                if *bytes != bytes_of(&truth, target) {
                    let apart = apart(&pixels(bytes, target), &truth.pixels);
                    return Err(
                        format!("{format:?}: not the headless bytes, by {apart}/255").into(),
                    );
                }
            }
            let (eyes, bytes) = (drawn.len(), drawn.concat().len());
            println!("{format:?}, eyes: {eyes}: {bytes} bytes, all as headless");
        }

        let furnished = draw(&host, &world, format, world.furniture(), &[camera], true)?.remove(0);
        let expected = over_furniture(&mut headless, &world)?;
        let apart = apart(&pixels(&furnished, target), &expected);
        // A blend into 8 bits is of 8-bit arithmetic on lavapipe, which truncates to halves too.
        let most = match target {
            TargetFormat::Unorm8 => 2.0,
            _ => 0.5,
        };
        if apart > most {
            return Err(format!("{format:?}: over the host's wall off by {apart}/255").into());
        }
        println!("{format:?}: over the host's wall at most {apart}/255 off");
    }
    headless.close()?;
    match &*host.close() {
        [] => Ok(()),
        said => Err(format!("the validation layer says:\n{}", said.join("\n")).into()),
    }
}

/// Leaves out a transition, and a barrier between two writes, to see that the validation layer watches what is recorded beside
/// wgpu: layouts across command buffers, and synchronisation at least inside of them.
pub(crate) fn careless(device: &str) -> Result<(), Failure> {
    let world = World::new(generate(Kind::General, 300, 5), SIZE)?;
    let host = Host::new(device, true)?;
    let (format, camera) = (FORMATS[0].0, world.view.camera);
    draw(&host, &world, format, world.furniture(), &[camera], false)?;
    let buffer = host.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("written twice"),
        size: 16,
        usage: wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    let ((), never_submitted) = host.raw("careless", |cmd| {
        // SAFETY: nothing of what is shown is destroyed, and `cmd` is recording outside any scope.
        unsafe {
            let hal = buffer.as_hal::<Vulkan>().expect("a buffer of Vulkan's");
            for value in 0..2 {
                let device = host.rara.raw();
                device.cmd_fill_buffer(cmd, hal.raw_handle(), 0, 16, value);
            }
        }
    });
    drop((buffer, never_submitted));
    let said = host.close();
    for (missing, part) in [
        ("transition", "VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL"),
        ("barrier", "SYNC-HAZARD-WRITE-AFTER-WRITE"),
    ] {
        if !said.iter().any(|text| text.contains(part)) {
            return Err(format!("a {missing} is missing and nobody sees it: {said:?}").into());
        }
    }
    Ok(())
}

/// The bytes of the third frame in the host, for each eye.
fn draw(
    host: &Host,
    world: &World,
    format: wgpu::TextureFormat,
    furniture: (wgpu::Color, &[Wall], DMat4),
    cameras: &[Camera],
    careful: bool,
) -> Result<Vec<Vec<u8>>, Failure> {
    let target = || Target::new(host, format, world.size);
    let targets: Vec<_> = cameras.iter().map(|_| target()).collect();
    let meshes = Meshes::new(host, format, furniture);
    let eyes = targets.iter().zip(cameras).map(|(target, camera)| Eye {
        meshes: &meshes,
        target,
        camera: *camera,
    });
    let eyes: Vec<_> = eyes.collect();
    let mut splats = Splats::new(host, &world.scene, format, &world.view, eyes.len())?;
    for _ in 0..3 {
        splats.frame(host, &eyes, &world.view, careful)?;
    }
    let bytes = targets.iter().map(|target| target.bytes(host)); // waits for all frames, so that everything may be dropped
    let bytes = bytes.collect::<Result<Vec<_>, _>>()?;
    match splats.path() {
        "tiles" => Ok(bytes),
        path => Err(format!("splats were drawn by {path}").into()),
    }
}

fn draw_headless(
    headless: &mut Headless,
    world: &World,
    scene: &Gaussians,
    camera: &Camera,
    format: TargetFormat,
) -> Result<Picture, Failure> {
    let view = &world.view;
    headless.load(scene)?;
    let precision = Precision::default().target(format);
    let settings = view.settings.precision(precision);
    headless.render(camera, &view.clip, &settings)?;
    Ok(headless.picture()?)
}

/// The headless picture over background and wall: before the wall, of the Gaussians that are nearer.
fn over_furniture(headless: &mut Headless, world: &World) -> Result<Vec<[f32; 4]>, Failure> {
    let float = TargetFormat::Float;
    let camera = &world.view.camera;
    let whole = draw_headless(headless, world, &world.scene, camera, float)?;
    let part = draw_headless(headless, world, &world.before_wall(), camera, float)?;
    let [left, top, right, bottom] = world.wall_area;
    let mut hidden = 0;
    let pixel = |at: usize| {
        let (x, y) = (at as u32 % whole.width, at as u32 / whole.width);
        let walled = (left..right).contains(&x) && (top..bottom).contains(&y);
        let (splats, below) = match walled {
            true => (part.pixels[at], world.wall.color),
            false => (whole.pixels[at], BACKGROUND.map(|c| c as f32)),
        };
        hidden += usize::from((splats[0] - whole.pixels[at][0]).abs() > 0.05);
        [0, 1, 2, 3].map(|c| splats[c] + (1.0 - splats[3]) * below[c])
    };
    let pixels = (0..whole.pixels.len()).map(pixel).collect();
    match hidden {
        0..500 => Err(format!("the wall hides {hidden} pixels").into()),
        _ => Ok(pixels),
    }
}

/// A picture in a format's bytes.
fn bytes_of(picture: &Picture, format: TargetFormat) -> Vec<u8> {
    let channels = picture.pixels.iter().flatten();
    match format {
        TargetFormat::Half => channels
            .flat_map(|&value| f16::from_f32(value).to_le_bytes())
            .collect(),
        _ => channels
            .map(|&value| (value * 255.0).round() as u8)
            .collect(),
    }
}

/// The numbers of a format's bytes.
fn pixels(bytes: &[u8], format: TargetFormat) -> Vec<[f32; 4]> {
    let channels: Vec<f32> = match format {
        TargetFormat::Half => bytes
            .chunks_exact(2)
            .map(|half| f16::from_le_bytes([half[0], half[1]]).to_f32())
            .collect(),
        _ => bytes.iter().map(|&byte| f32::from(byte) / 255.0).collect(),
    };
    let pixels = channels.chunks_exact(4);
    pixels.map(|c| [c[0], c[1], c[2], c[3]]).collect()
}

/// The largest difference, of 255. Values beyond white count as white.
fn apart(a: &[[f32; 4]], b: &[[f32; 4]]) -> f32 {
    let pairs = a.iter().flatten().zip(b.iter().flatten());
    let apart = pairs.map(|(a, b)| 255.0 * (a.min(1.0) - b.min(1.0)).abs());
    apart.fold(0.0, f32::max)
}
