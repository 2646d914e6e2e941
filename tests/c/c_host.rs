//! `tools/examples/host.c` is compiled as strict C99 with what `tools/install-c` installs, and run under validation: its picture
//! and its depths are those of the Rust interface to the byte.

use std::path::Path;
use std::process::Command;

use crate::canvas::{Canvas, CanvasDesc, Frame, with_host};
use crate::compiler::{compiler, root, run_host};
use crate::folder::Folder;
use crate::install::{build, flags, has, installed};
use rara::ash::vk;
use rara::glam::DVec3;
use rara::gpu::{AdoptDesc, Bindings, Device};
use rara::scene::{Bounds, Kind, generate, load, save_ply};
use rara::{
    Camera, Clip, ClipOp, DepthDesc, DepthMap, Gaussians, Plane, Renderer, RendererDesc,
    SceneBuffers, Settings, ShFormat,
};

/// What the host's source says: the picture's size, its colours, and the square with its left upper corner and its side.
const SIZE: (u32, u32) = (480, 360);
const BACKGROUND: [f32; 4] = [0.125, 0.125, 0.125, 1.0];
const SQUARE: [f32; 4] = [0.75, 0.5, 0.25, 1.0];
const CORNER: (i32, i32) = (180, 120);
const SIDE: u32 = 120;

/// The same frame by the Rust interface, over a background of one colour: its picture and its depths.
fn drawn(
    lent: &AdoptDesc,
    device: &Device,
    scene: &Gaussians,
    clear: [f32; 4],
) -> (Vec<[f32; 4]>, Vec<f32>) {
    let bounds = Bounds::of(scene);
    let (centre, normal) = (bounds.centre(), DVec3::new(-0.28, 0.0, 0.96));
    let plane = Plane::new(normal, -normal.dot(centre)).expect("a normal");
    let camera = Camera::frame(&bounds, DVec3::NEG_Y, 50.0, SIZE).expect("a view");
    let map = DepthMap::reversed(0.05, f64::INFINITY).expect("a map");
    let z = (camera.rotation * (centre - camera.eye)).z;
    let square = vk::Rect2D {
        offset: vk::Offset2D {
            x: CORNER.0,
            y: CORNER.1,
        },
        extent: vk::Extent2D {
            width: SIDE,
            height: SIDE,
        },
    };
    let (colours, depths) = (vk::Format::R32G32B32A32_SFLOAT, vk::Format::D32_SFLOAT);
    let mut desc = CanvasDesc::new(SIZE, colours);
    (desc.depth, desc.far, desc.clear) = (depths, 0.0, clear);
    desc.meshes = vec![(square, map.at(z) as f32)];
    let canvas = Canvas::new(lent, device, desc);
    let depth = DepthDesc::new(depths, map)
        .readable(true)
        .write_alpha(Some(0.5));
    let desc = RendererDesc::new(colours)
        .depth(Some(depth))
        .bindings(Bindings::Bound);
    let mut renderer = Renderer::new(device, desc).expect("a renderer");
    let buffers = SceneBuffers::upload(device, scene, ShFormat::Packed).expect("uploads");
    let clip = Clip::of([plane], ClipOp::And);
    let configured = renderer.configure(&buffers, &camera, &clip, &Settings::default());
    let frame = Frame {
        behind: Some(canvas.depth_image(0, 0)),
        ..Frame::new(SIZE)
    };
    let pixels = canvas.draw_frame(&mut renderer, &buffers, configured, &frame);
    (pixels, canvas.depths())
}

/// The numbers of a portable float map, the highest row first.
fn read_map(path: &Path, kind: &str, channels: usize) -> Vec<f32> {
    let bytes = std::fs::read(path).expect("a picture");
    let header = format!("{kind}\n{} {}\n-1.0\n", SIZE.0, SIZE.1);
    let numbers = bytes.strip_prefix(header.as_bytes()).expect("a float map");
    let numbers: Vec<_> = numbers
        .as_chunks()
        .0
        .iter()
        .map(|bytes| f32::from_le_bytes(*bytes))
        .collect();
    let rows = numbers.chunks(channels * SIZE.0 as usize);
    assert_eq!(rows.len(), SIZE.1 as usize);
    rows.rev().flatten().copied().collect()
}

#[test]
fn a_host_in_c_draws_what_the_rust_interface_does() {
    let Some(compiler) = compiler("rara.h was not tried from C") else {
        return;
    };
    if !has("pkg-config") {
        return;
    }
    let own = Folder::new("c99-host");
    let [path, picture, depths] =
        ["scene.ply", "picture.pfm", "depths.pfm"].map(|name| own.join(name));
    save_ply(&path, &generate(Kind::Layers, 20_000, 2)).expect("a temporary file");
    // The scene as loaded, since a file has opacities and scales in another form.
    let scene = load(&path, &mut |_, _| ()).expect("loads").gaussians;

    let library = installed(&own).join("lib");
    let host = own.join("host");
    let strict = "-std=c99 -Wall -Wextra -Werror -pedantic";
    let flags = flags(&library, &["--cflags", "--libs"]);
    let source = root().join("tools/examples/host.c");
    let flags = format!("{strict} {flags} -lvulkan");
    // tools/setup test installs the Vulkan headers.
    build(&compiler, &source, &host, &flags);

    with_host(true, |of_rust, device| {
        let mut run = Command::new(&host);
        run.args([&path, &picture, &depths])
            .env("LD_LIBRARY_PATH", &library);
        run_host(&mut run, &device.info().name);
        let (picture, depths) = (read_map(&picture, "PF", 3), read_map(&depths, "Pf", 1));

        // The canvas's square has a depth alone, so that its colour is another canvas's background.
        let lent = of_rust.lend();
        let [(beside, true_depths), (before, _)] =
            [BACKGROUND, SQUARE].map(|clear| drawn(&lent, device, &scene, clear));
        let in_square = |at: usize| {
            let (x, y) = (at as u32 % SIZE.0, at as u32 / SIZE.0);
            let of =
                |place: u32, corner: i32| (0..SIDE).contains(&place.wrapping_sub(corner as u32));
            of(x, CORNER.0) && of(y, CORNER.1)
        };
        let truth = |at| {
            if in_square(at) {
                before[at]
            } else {
                beside[at]
            }
        };
        let apart = (0..depths.len())
            .filter(|&at| picture[3 * at..][..3] != truth(at)[..3] || depths[at] != true_depths[at])
            .count();
        assert_eq!(apart, 0, "pixels that are not the same to the byte");
        let [mut hidden, mut covered, mut drawn] = [0; 3];
        for (at, depth) in depths.iter().enumerate() {
            let bare = if in_square(at) { SQUARE } else { BACKGROUND };
            let is_bare = picture[3 * at..][..3] == bare[..3];
            drawn += usize::from(*depth != 0.0 && !in_square(at));
            hidden += usize::from(in_square(at) && is_bare);
            covered += usize::from(in_square(at) && !is_bare);
        }
        eprintln!(
            "{drawn} depths of splats; of the square {hidden} pixels are bare, {covered} covered"
        );
        assert!(drawn > 1000 && hidden > 1000 && covered > 200);
    });
}
