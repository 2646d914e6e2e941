//! Splats against a host's depth buffer: what lies behind an opaque mesh is hidden, on ordinary and reversed depth, in
//! every way of drawing, dynamic rendering and classic render passes, with one sample and several.

mod expected;
mod eyes;
mod hidden;
mod targets;
mod written;

use crate::canvas::{Canvas, CanvasDesc, Frame};
use crate::common;
use rara::ash::vk;
use rara::gpu::{DepthImage, Device};
use rara::scene::{Kind, generate};
use rara::{
    Camera, Clip, ClipOp, DepthDesc, DepthMap, Gaussians, Headless, Picture, Raster, Renderer,
    RendererDesc, SceneBuffers, Settings, SortBy,
};

const FLOATS: vk::Format = vk::Format::R32G32B32A32_SFLOAT;
/// The size of the camera's picture, and where it begins in the target: over its left and lower edges, at an odd column.
const VIEW: (u32, u32) = (189, 131);
const ORIGIN: (i32, i32) = (-7, 40);
const TARGET: (u32, u32) = (211, 160);

/// A scene with a clip through it, and amid it two meshes that face the camera.
struct World {
    scene: Gaussians,
    camera: Camera,
    clip: Clip,
    settings: Settings,
    /// Their places in pixels of the picture, and their depths.
    meshes: [(vk::Rect2D, f64); 2],
}

impl World {
    fn new() -> Self {
        let scene = generate(Kind::General, 3_000, 5);
        let camera = common::views(&scene, 3, VIEW)[1];
        Self::of(scene, camera)
    }

    /// The same world before an orthographic camera.
    fn flat() -> Self {
        let Self { scene, camera, .. } = Self::new();
        let camera = common::flattened(&camera, &scene);
        Self::of(scene, camera)
    }

    /// The same world from nearby, in the order of distance, which at the picture's edges is not that of depth.
    fn by_distance() -> Self {
        let Self { scene, camera, .. } = Self::new();
        let (eye, focal) = (0.55 * camera.eye, 0.7 * camera.fx);
        let mut world = Self::of(scene, camera.eye(eye).fx(focal).fy(focal));
        world.settings = world.settings.sort_by(Some(SortBy::Distance));
        world
    }

    fn of(scene: Gaussians, camera: Camera) -> Self {
        let clip = common::clip(&scene, 1, ClipOp::And);
        let mut depths: Vec<_> = (0..scene.len())
            .map(|i| depth(&scene, &camera, i))
            .collect();
        depths.sort_by(f64::total_cmp);
        let at = |share: f64| depths[(share * depths.len() as f64) as usize];
        let rect = |x, y, width, height| vk::Rect2D {
            offset: vk::Offset2D { x, y },
            extent: vk::Extent2D { width, height },
        };
        let meshes = [
            (rect(20, 11, 71, 67), at(0.4) + 1e-4),
            (rect(60, 50, 90, 41), at(0.6) + 1e-4),
        ];
        Self {
            scene,
            camera,
            clip,
            settings: Settings::default(),
            meshes,
        }
    }

    /// The picture as a headless renderer draws it: where there is a mesh, of the Gaussians before it alone.
    fn truth(&self, headless: &mut Headless) -> Picture {
        let mut draw = |scene: &Gaussians| {
            headless.load(scene).expect("uploads");
            headless
                .render(&self.camera, &self.clip, &self.settings)
                .expect("renders");
            headless.picture().expect("reads back")
        };
        let mut picture = draw(&self.scene);
        for (rect, depth) in &self.meshes {
            let part = draw(&self.before(*depth));
            for y in 0..rect.extent.height {
                for x in 0..rect.extent.width {
                    let row = rect.offset.y as u32 + y;
                    let at = (row * VIEW.0 + rect.offset.x as u32 + x) as usize;
                    picture.pixels[at] = part.pixels[at];
                }
            }
        }
        let whole = draw(&self.scene);
        let hidden = whole.pixels.iter().zip(&picture.pixels);
        let changed = hidden.filter(|(a, b)| (a[0] - b[0]).abs() > 0.05).count();
        assert!(
            changed > 1_000,
            "the meshes hide something: {changed} pixels"
        );
        picture
    }

    /// The Gaussians that are nearer than a depth.
    fn before(&self, limit: f64) -> Gaussians {
        let nearer = |&i: &usize| depth(&self.scene, &self.camera, i) < limit;
        common::picked(&self.scene, (0..self.scene.len()).filter(nearer))
    }
}

fn depth(scene: &Gaussians, camera: &Camera, index: usize) -> f64 {
    let relative = scene.positions()[index].as_dvec3() - camera.eye;
    (camera.rotation * relative).z
}

/// A canvas with the world's meshes in its depth buffer.
fn canvas(world: &World, map: DepthMap, depth: vk::Format) -> CanvasDesc {
    let mut desc = CanvasDesc::new(TARGET, FLOATS);
    desc.depth = depth;
    desc.far = if map.is_reversed() { 0.0 } else { 1.0 };
    let in_target = |(rect, depth): (vk::Rect2D, f64)| {
        let mut rect = rect;
        rect.offset.x += ORIGIN.0;
        rect.offset.y += ORIGIN.1;
        (rect, map.at(depth) as f32)
    };
    desc.meshes = world.meshes.map(in_target).to_vec();
    desc
}

fn depth_desc(canvas: &CanvasDesc, map: DepthMap, readable: bool) -> DepthDesc {
    DepthDesc::new(canvas.depth, map).readable(readable)
}

/// A frame at the place of the camera's picture in the target.
fn frame(behind: Option<DepthImage>) -> Frame {
    Frame {
        origin: ORIGIN,
        behind,
        ..Frame::new(VIEW)
    }
}

/// A device, and a renderer on it whose pipelines all others share.
type On<'a> = (&'a Device, &'a Renderer);

fn first(device: &Device) -> Renderer {
    Renderer::new(device, RendererDesc::new(FLOATS)).expect("a renderer")
}

/// Draws one frame of the world on a canvas; returns the part under the camera's picture, and how it was drawn.
fn draw(
    on: On<'_>,
    canvas: &Canvas,
    world: &World,
    desc: RendererDesc,
    raster: Raster,
) -> (Picture, &'static str) {
    let is_read = desc.depth.is_some_and(|depth| depth.readable);
    let behind = is_read.then(|| canvas.depth_image(ORIGIN.0, ORIGIN.1));
    draw_behind(on, canvas, world, desc, raster, behind)
}

/// Draws one frame behind a depth image.
fn draw_behind(
    (device, first): On<'_>,
    canvas: &Canvas,
    world: &World,
    desc: RendererDesc,
    raster: Raster,
    behind: Option<DepthImage>,
) -> (Picture, &'static str) {
    let format = rara::ShFormat::Float;
    let scene = SceneBuffers::upload(device, &world.scene, format).expect("uploads");
    let mut renderer = first.sharing(desc).expect("a renderer");
    let settings = world.settings.raster(raster);
    let configured = renderer.configure(&scene, &world.camera, &world.clip, &settings);
    let pixels = canvas.draw_frame(&mut renderer, &scene, configured, &frame(behind));
    let path = renderer.raster().path;
    (part(&pixels), path)
}

/// The part of a target that lies under the camera's picture; transparent where the picture is beside the target.
fn part(pixels: &[[f32; 4]]) -> Picture {
    let mut picture = Picture::filled(VIEW.0, VIEW.1, [0.0; 4]);
    for (i, pixel) in picture.pixels.iter_mut().enumerate() {
        let (x, y) = (
            i as i32 % VIEW.0 as i32 + ORIGIN.0,
            i as i32 / VIEW.0 as i32 + ORIGIN.1,
        );
        if x >= 0 && y >= 0 && x < TARGET.0 as i32 && y < TARGET.1 as i32 {
            *pixel = pixels[(y * TARGET.0 as i32 + x) as usize];
        }
    }
    picture
}

/// Largest difference, of 255, inside the target, leaving out a share of the pixels.
fn apart(a: &Picture, b: &Picture, share: f64) -> f32 {
    let mut differences = Vec::new();
    for (i, (a, b)) in a.pixels.iter().zip(&b.pixels).enumerate() {
        let (x, y) = (
            i as i32 % VIEW.0 as i32 + ORIGIN.0,
            i as i32 / VIEW.0 as i32 + ORIGIN.1,
        );
        if x >= 0 && y < TARGET.1 as i32 {
            let pairs = a.iter().zip(b);
            let worst = pairs.map(|(a, b)| 255.0 * (a.min(1.0) - b.min(1.0)).abs());
            differences.push(worst.fold(0.0, f32::max));
        }
    }
    differences.sort_by(f32::total_cmp);
    differences[((1.0 - share) * (differences.len() - 1) as f64) as usize]
}

fn maps() -> [DepthMap; 3] {
    [
        DepthMap::ordinary(0.5, 50.0),
        DepthMap::reversed(0.5, 50.0),
        DepthMap::reversed(0.1, f64::INFINITY),
    ]
    .map(|map| map.expect("0 < near < far"))
}
