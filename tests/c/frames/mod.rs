//! Frames through the functions of `rara.h` on the example host's device are those of the Rust interface to the byte: splats
//! behind what the host has drawn, expected depths, a scene placed in a world, a scene by the host's own staging memory,
//! layers that are hidden, moved and faded.

mod channels;
mod layers;
mod lent;
mod ours;
mod passes;
mod picks;
mod regions;
mod reserve;
mod selections;
mod staged;
mod world;

use std::ptr::null_mut;

use crate::canvas::{Canvas, with_host};
use crate::folder::Folder;
use crate::layer::one_layer;
use crate::results::assert_ok;
use ours::{Ours, saved, saved_as};
use rara::ash::{Entry, vk};
use rara::glam::dcamera::lh;
use rara::glam::{DQuat, DVec3};
use rara::gpu::{AdoptDesc, Device, DeviceShape};
use rara::scene::{Kind, generate};
use rara::{Gaussians, Placement, Projection, Raster, Scene, SceneBuffers, ShFormat};
use rara_c::device::*;
use rara_c::gaussians::*;
use rara_c::load::*;
use rara_c::scene::*;
use rara_c::upload::*;
use world::{Drawn, World};

type Pixels = Vec<[f32; 4]>;

/// Draws with a scene of this many Gaussians, on the example host's device by both interfaces.
fn with_both(count: usize, test: impl FnOnce(&Gaussians, &AdoptDesc, &Device, &Ours)) {
    let made = generate(Kind::General, count, 5);
    with_saved(&format!("c-frames-{count}"), &made, test);
}

/// The same with these Gaussians, saved in a folder of this name.
fn with_saved(
    name: &str,
    made: &Gaussians,
    test: impl FnOnce(&Gaussians, &AdoptDesc, &Device, &Ours),
) {
    let folder = Folder::new(name);
    let (path, scene) = saved_as(&folder, made);
    with_host(true, |host, device| {
        // SAFETY: the system's loader; the host outlives what is made here.
        unsafe {
            let entry = Entry::load().expect("a Vulkan loader");
            let lent = host.lend();
            let ours = Ours::new(&entry, &lent, &path);
            test(&scene, &lent, device, &ours);
            rara_gaussians_destroy(ours.gaussians);
            let bytes = rara_device_bytes(ours.device);
            assert_eq!(bytes, 0, "all that was allocated was freed");
            rara_device_destroy(ours.device);
        }
    });
}

/// A host asks for the pipelines of a kind of machine, which are here those for GPUs without subgroup operations.
#[test]
fn pipelines_are_those_that_the_host_asks_for() {
    let folder = Folder::new("c-frames-shape");
    let (path, scene) = saved(&folder, Kind::General, 3_000);
    with_host(true, |host, usual| {
        // SAFETY: the system's loader; the host outlives what is made here.
        unsafe {
            let entry = Entry::load().expect("a Vulkan loader");
            let shape = DeviceShape::Gpu { subgroup: 0 };
            let device = Device::adopt(host.lend().shape(Some(shape))).expect("adopted");
            let lent = host.lend();
            let ours = Ours::shaped(&entry, &lent, &path, RARA_SHAPE_GPU);
            let world = World::new(&scene, Raster::Tiles);
            let uploaded = ours.uploaded();
            let canvas = world.canvas(&lent, usual);
            let drawn = world.drawn_in_c(ours.device, &canvas, |_| uploaded);
            assert!(drawn == world.drawn(&device, &canvas), "as in Rust");
            if usual.shape() == DeviceShape::Cpu {
                assert!(drawn != world.drawn(usual, &canvas), "sums round otherwise");
            }
            rara_scene_buffers_destroy(uploaded);
            rara_gaussians_destroy(ours.gaussians);
            rara_device_destroy(ours.device);
            assert_eq!(device.close(), Vec::<String>::new());
        }
    });
}

#[test]
fn what_is_behind_a_mesh_expected_depths_and_motion_are_the_same_bytes() {
    with_both(3_000, |scene, lent, device, ours| {
        let turn = DQuat::from_xyzw(0.1, -0.2, 0.05, 0.9);
        let placed = Placement::new(DVec3::new(0.3, -0.1, 0.2), turn, 0.8).expect("possible");
        let mut seen: Vec<Pixels> = Vec::new();
        let uploaded = ours.uploaded();
        for raster in [Raster::Tiles, Raster::Quad] {
            for (made, placement, drawn) in [
                (
                    World::new(scene, raster),
                    Placement::IDENTITY,
                    Drawn::Colours,
                ),
                (World::new(scene, raster), placed, Drawn::Colours),
                (World::new(scene, raster), placed, Drawn::Depths),
                (World::flat(scene, raster), placed, Drawn::Colours),
            ] {
                let world = World {
                    placement,
                    drawn,
                    ..made
                };
                let what = format!("{raster:?}, {placement:?}, {drawn:?}");
                let canvas = world.canvas(lent, device);
                let truth = world.drawn(device, &canvas);
                // SAFETY: the handles are alive.
                let drawn = unsafe { world.drawn_in_c(ours.device, &canvas, |_| uploaded) };
                assert!(drawn == truth, "{what}");
                let filled = drawn.iter().filter(|pixel| pixel[1] > 0.05).count();
                assert!(filled > 1_000, "{what}: {filled} pixels");
                seen.push(drawn);
            }
        }
        assert!(seen[0] != seen[1] && seen[4] != seen[5], "placed elsewhere");
        assert!(
            seen[1] != seen[3] && seen[5] != seen[7],
            "without perspective"
        );
        let world = World {
            drawn: Drawn::Motion,
            ..World::new(scene, Raster::Tiles)
        };
        let canvas = world.canvas(lent, device);
        let truth = world.drawn(device, &canvas);
        // SAFETY: the handles are alive.
        let drawn = unsafe { world.drawn_in_c(ours.device, &canvas, |_| uploaded) };
        assert!(drawn == truth, "motion");
        let filled = drawn.iter().filter(|p| **p == [0.0; 4]).count();
        assert!(
            filled > 500,
            "{filled} pixels, of which no frame before tells"
        );
        // SAFETY: all frames were waited for.
        unsafe { rara_scene_buffers_destroy(uploaded) };
    });
}

/// A host's matrices say in C what they say in Rust: left-handed, and seen in a mirror; and orthographic.
#[test]
fn views_of_a_hosts_matrices_are_the_same_bytes() {
    with_both(1_500, |scene, lent, device, ours| {
        let uploaded = ours.uploaded();
        let mut seen: Vec<Pixels> = Vec::new();
        for made in [
            World::new(scene, Raster::Quad),
            World::flat(scene, Raster::Quad),
        ] {
            let (camera, size) = (made.camera, made.size());
            let [forward, up] = [DVec3::Z, DVec3::NEG_Y].map(|v| camera.rotation.transpose() * v);
            let view = lh::view::look_to_mat4(camera.eye, forward, up);
            let projection = match camera.projection {
                Projection::Orthographic => {
                    let [x, y] = [size[0] / camera.fx, size[1] / camera.fy].map(|v| 0.5 * v);
                    lh::proj::directx::orthographic(-x, x, -y, y, 40.0, 0.0)
                }
                _ => {
                    let angle = 2.0 * (0.5 * size[1] / camera.fy).atan();
                    let aspect = size[0] / size[1];
                    lh::proj::directx::perspective_infinite_reverse(angle, aspect, 0.05)
                }
            };
            let world = made.of_matrices([view, projection]);
            assert!(world.camera.rotation.determinant() < 0.0);
            let canvas = world.canvas(lent, device);
            let truth = world.drawn(device, &canvas);
            // SAFETY: the handles are alive.
            let drawn = unsafe { world.drawn_in_c(ours.device, &canvas, |_| uploaded) };
            assert!(drawn == truth);
            assert!(drawn.iter().filter(|pixel| pixel[1] > 0.05).count() > 1_000);
            seen.push(drawn);
        }
        assert!(seen[0] != seen[1]);
        // SAFETY: all frames were waited for.
        unsafe { rara_scene_buffers_destroy(uploaded) };
    });
}
