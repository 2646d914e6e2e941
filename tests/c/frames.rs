//! Frames through the functions of `rara.h` on the example host's device are those of the Rust interface to the byte: splats
//! behind what the host has drawn, expected depths, a scene placed in a world, a scene by the host's own staging memory.

use std::cell::{Cell, RefCell};
use std::ffi::{CStr, CString};
use std::path::Path;
use std::ptr::null_mut;

use crate::canvas::{Canvas, CanvasDesc, with_host};
use crate::folder::Folder;
use rara::ash::{Entry, vk};
use rara::glam::{DQuat, DVec3};
use rara::gpu::{AdoptDesc, Bindings, BufferDesc, Device, Location};
use rara::scene::{Bounds, Kind, generate, load, save_ply};
use rara::{
    Camera, Clip, ClipOp, DepthDesc, DepthMap, ExpectedDepthDesc, Gaussians, Placement, Plane,
    Raster, Renderer, RendererDesc, SceneBuffers, Settings, ShFormat,
};
use rara_c::boundary::*;
use rara_c::camera::*;
use rara_c::clip::*;
use rara_c::depth::*;
use rara_c::device::*;
use rara_c::placement::*;
use rara_c::renderer::*;
use rara_c::scene::*;
use rara_c::settings::*;

const FLOATS: vk::Format = vk::Format::R32G32B32A32_SFLOAT;
const DEPTHS: vk::Format = vk::Format::R32G32_SFLOAT;
const DEPTH: vk::Format = vk::Format::D32_SFLOAT;
const VIEW: (u32, u32) = (121, 83);
const MAP: RaraDepthMap = RaraDepthMap {
    z_near: 0.05,
    z_far: f64::INFINITY,
    reversed: vk::TRUE,
};
type Pixels = Vec<[f32; 4]>;

#[track_caller]
fn assert_ok(result: RaraResult) {
    // SAFETY: a string of this thread, used before its next call.
    let message = unsafe { CStr::from_ptr(rara_last_error_message()) };
    assert_eq!(result, RARA_OK, "{message:?}");
}

#[track_caller]
fn assert_fails(result: RaraResult, part: &str) {
    // SAFETY: as above.
    let message = unsafe { CStr::from_ptr(rara_last_error_message()) };
    let message = message.to_str().expect("UTF-8");
    assert!(
        result == RARA_ERROR_INVALID && message.contains(part),
        "{result}: {message}"
    );
}

/// What both interfaces draw.
struct World<'a> {
    scene: &'a Gaussians,
    camera: Camera,
    plane: Plane,
    raster: Raster,
    placement: Placement,
    /// Expected depths, not colours.
    depths: bool,
}

impl<'a> World<'a> {
    fn new(scene: &'a Gaussians, raster: Raster) -> Self {
        let bounds = Bounds::of(scene);
        let normal = DVec3::new(0.6, 0.0, 0.8);
        Self {
            scene,
            camera: Camera::frame(&bounds, DVec3::NEG_Y, 50.0, VIEW).expect("a view"),
            plane: Plane::new(normal, 0.1 - normal.dot(bounds.centre())).expect("a normal"),
            raster,
            placement: Placement::IDENTITY,
            depths: false,
        }
    }

    /// With a mesh amid the splats, in the middle of the picture.
    fn canvas(&self, lent: &AdoptDesc, device: &Device) -> Canvas {
        let mut desc = CanvasDesc::new(VIEW, if self.depths { DEPTHS } else { FLOATS });
        (desc.depth, desc.far) = (DEPTH, 0.0);
        let centre = self.placement.to_world(Bounds::of(self.scene).centre());
        let z = (self.camera.rotation * (centre - self.camera.eye)).z;
        let rect = vk::Rect2D {
            offset: vk::Offset2D { x: 41, y: 20 },
            extent: vk::Extent2D {
                width: 50,
                height: 45,
            },
        };
        desc.meshes = vec![(rect, map().at(z) as f32)];
        Canvas::new(lent, device, desc)
    }

    /// By the Rust interface.
    fn drawn(&self, device: &Device, canvas: &Canvas) -> Pixels {
        let desc = RendererDesc::new(FLOATS)
            .depth(Some(DepthDesc::new(DEPTH, map()).readable(true)))
            .expected_depth(Some(ExpectedDepthDesc::new(DEPTHS)))
            .bindings(Bindings::Bound);
        let scene = SceneBuffers::upload(device, self.scene, ShFormat::Packed);
        let scene = scene.expect("uploads");
        let renderer = RefCell::new(Renderer::new(device, desc).expect("a renderer"));
        renderer.borrow_mut().set_placement(self.placement);
        let settings = Settings::default().raster(self.raster);
        let clip = Clip {
            planes: vec![self.plane],
            op: ClipOp::And,
        };
        let configured = (renderer.borrow_mut()).configure(&scene, &self.camera, &clip, &settings);
        configured.expect("configures");
        let depth = canvas.depth_image(0, 0);
        // SAFETY: recording outside a scope; the canvas's depth is ready to be copied, and all is waited for.
        let before = |cmd| unsafe {
            renderer
                .borrow_mut()
                .prepare_behind(cmd, &scene, &depth)
                .expect("records")
        };
        let inside = |cmd| {
            canvas.viewport(cmd, 0, 0, VIEW);
            let mut renderer = renderer.borrow_mut();
            // SAFETY: inside the canvas's scope, which the renderer was made for.
            unsafe {
                match self.depths {
                    true => renderer.draw_depth(cmd, [0.0; 2]).expect("records"),
                    false => renderer.draw(cmd, [0.0; 2]).expect("records"),
                }
            }
        };
        let [pixels, _] = canvas.draw(before, inside);
        pixels
    }

    /// By rara.h: with a scene that is uploaded before, or in the frame's own commands.
    ///
    /// # Safety
    /// The handles are alive, and the staging memory is as it says.
    unsafe fn drawn_in_c(
        &self,
        ours: &Ours,
        canvas: &Canvas,
        staging: Option<RaraStaging>,
    ) -> Pixels {
        let Ours { device, gaussians } = *ours;
        let scene = Cell::new(null_mut());
        // SAFETY: the caller's promises; everything below is alive, or to be overwritten.
        unsafe {
            if staging.is_none() {
                let format = RARA_SH_FORMAT_PACKED;
                let result = rara_scene_buffers_upload(device, gaussians, format, scene.as_ptr());
                assert_ok(result);
            }
            let mut depth: RaraDepthDesc = std::mem::zeroed();
            let size = size_of_val(&depth);
            assert_ok(rara_depth_desc_default(&mut depth, size, DEPTH, MAP));
            depth.readable = vk::TRUE;
            let mut desc: RaraRendererDesc = std::mem::zeroed();
            let size = size_of_val(&desc);
            assert_ok(rara_renderer_desc_default(&mut desc, size, FLOATS));
            (desc.depth, desc.expected_depth_format) = (&depth, DEPTHS);
            desc.bindings = RARA_BINDINGS_BOUND;
            let mut renderer = null_mut();
            assert_ok(rara_renderer_create(device, &desc, &mut renderer));
            let placement = RaraPlacement {
                position: self.placement.position().into(),
                rotation: self.placement.rotation().into(),
                scale: self.placement.scale(),
            };
            assert_ok(rara_renderer_set_placement(renderer, &placement));
            let nowhere = RaraPlacement {
                scale: 0.0,
                ..placement
            };
            let refused = rara_renderer_set_placement(renderer, &nowhere);
            assert_eq!(refused, RARA_ERROR_INVALID); // and the placement is the one before

            let mut settings: RaraSettings = std::mem::zeroed();
            let size = size_of_val(&settings);
            let preset = RARA_PRESET_BALANCED;
            assert_ok(rara_settings_default(&mut settings, size, preset));
            settings.raster = match self.raster {
                Raster::Tiles => RARA_RASTER_TILES,
                _ => RARA_RASTER_QUAD,
            };
            let plane = RaraPlane {
                normal: self.plane.normal().into(),
                offset: self.plane.offset(),
            };
            let clip = RaraClip {
                planes: &plane,
                plane_count: 1,
                op: RARA_CLIP_OP_AND,
            };
            let camera = RaraCamera::from(self.camera);
            let shown = canvas.depth_image(0, 0);
            let shown = RaraDepthImage {
                image: shown.image,
                layout: shown.layout,
                width: shown.extent.width,
                height: shown.extent.height,
                layer: shown.layer,
                x: shown.origin.x,
                y: shown.origin.y,
            };
            let before = |cmd| {
                if let Some(staging) = &staging {
                    upload_with(ours, cmd, staging, scene.as_ptr());
                }
                let scene = scene.get();
                let configured =
                    rara_renderer_configure(renderer, scene, &camera, &clip, &settings);
                assert_ok(configured);
                assert_ok(rara_renderer_prepare_behind(renderer, cmd, scene, &shown));
            };
            let inside = |cmd| {
                canvas.viewport(cmd, 0, 0, VIEW);
                assert_ok(match self.depths {
                    true => rara_renderer_draw_depth(renderer, cmd, 0.0, 0.0),
                    false => rara_renderer_draw(renderer, cmd, 0.0, 0.0),
                });
            };
            let [pixels, _] = canvas.draw(before, inside);
            rara_renderer_destroy(renderer);
            rara_scene_buffers_destroy(scene.get());
            assert_eq!(
                rara_device_bytes(device),
                0,
                "all that was allocated was freed"
            );
            pixels
        }
    }
}

fn map() -> DepthMap {
    DepthMap::reversed(MAP.z_near, MAP.z_far).expect("0 < near < far")
}

/// What stays while frames are drawn in C.
struct Ours {
    device: *mut RaraDevice,
    gaussians: *mut RaraGaussians,
}

impl Ours {
    /// # Safety
    /// The host and its loader outlive what is returned.
    unsafe fn new(entry: &Entry, host: &AdoptDesc, path: &Path) -> Self {
        let (mut device, mut gaussians) = (null_mut(), null_mut());
        let name = CString::new(path.to_str().expect("UTF-8")).expect("no NUL");
        // SAFETY: the caller's promise; the others are alive, or to be overwritten.
        unsafe {
            let mut desc: RaraAdoptDesc = std::mem::zeroed();
            assert_ok(rara_adopt_desc_default(&mut desc, size_of_val(&desc)));
            desc.get_instance_proc_addr = Some(entry.static_fn().get_instance_proc_addr);
            desc.instance = host.instance.handle();
            desc.physical_device = host.physical_device;
            desc.device = host.device.handle();
            (desc.queue, desc.queue_family) = (host.queue, host.queue_family);
            desc.mesh_shader = host.mesh_shader.into();
            desc.push_descriptor = host.push_descriptor.into();
            desc.debug_utils = host.debug_utils.into();
            desc.api_version = host.api_version;
            assert_ok(rara_device_adopt(&desc, &mut device));
            assert_ok(rara_gaussians_load(name.as_ptr(), &mut gaussians));
        }
        Self { device, gaussians }
    }
}

/// # Safety
/// As of `rara_scene_buffers_upload_with`.
unsafe fn upload_with(
    ours: &Ours,
    cmd: vk::CommandBuffer,
    staging: &RaraStaging,
    scene: *mut *mut RaraSceneBuffers,
) {
    let format = RARA_SH_FORMAT_PACKED;
    let upload = |staging: RaraStaging| {
        // SAFETY: the caller's promises.
        unsafe {
            rara_scene_buffers_upload_with(
                ours.device,
                cmd,
                &staging,
                ours.gaussians,
                format,
                scene,
            )
        }
    };
    let short = upload(RaraStaging {
        size: staging.size - 1,
        ..*staging
    });
    assert_fails(short, "bytes of staging memory");
    let unmapped = upload(RaraStaging {
        mapped: null_mut(),
        ..*staging
    });
    assert_fails(unmapped, "staging->mapped is null");
    let nowhere = upload(RaraStaging {
        buffer: vk::Buffer::null(),
        ..*staging
    });
    assert_fails(nowhere, "staging->buffer is null");
    let beyond = upload(RaraStaging {
        offset: u64::MAX - 8,
        ..*staging
    });
    assert_fails(beyond, "beyond any buffer");
    assert_ok(upload(*staging));
}

/// Draws with a scene of this many Gaussians, on the example host's device by both interfaces.
fn with_both(count: usize, test: impl FnOnce(&Gaussians, &AdoptDesc, &Device, &Ours)) {
    let folder = Folder::new(&format!("c-frames-{count}"));
    let path = folder.join("scene.ply");
    save_ply(&path, &generate(Kind::General, count, 5)).expect("a temporary file");
    // As loaded: a file has opacities and scales in another form.
    let scene = load(&path, &mut |_, _| ()).expect("loads").gaussians;
    with_host(true, |host, device| {
        // SAFETY: the system's loader; the host outlives what is made here.
        unsafe {
            let entry = Entry::load().expect("a Vulkan loader");
            let lent = host.lend();
            let ours = Ours::new(&entry, &lent, &path);
            test(&scene, &lent, device, &ours);
            rara_gaussians_destroy(ours.gaussians);
            rara_device_destroy(ours.device);
        }
    });
    std::fs::remove_file(&path).expect("is there");
}

#[test]
fn what_is_behind_a_mesh_and_expected_depths_are_the_same_bytes() {
    with_both(3_000, |scene, lent, device, ours| {
        let turn = DQuat::from_xyzw(0.1, -0.2, 0.05, 0.9);
        let placed = Placement::new(DVec3::new(0.3, -0.1, 0.2), turn, 0.8).expect("possible");
        let mut seen: Vec<Pixels> = Vec::new();
        for raster in [Raster::Tiles, Raster::Quad] {
            for (placement, depths) in [
                (Placement::IDENTITY, false),
                (placed, false),
                (placed, true),
            ] {
                let world = World {
                    placement,
                    depths,
                    ..World::new(scene, raster)
                };
                let what = format!("{raster:?}, {placement:?}, depths: {depths}");
                let canvas = world.canvas(lent, device);
                let truth = world.drawn(device, &canvas);
                // SAFETY: the handles are alive.
                let drawn = unsafe { world.drawn_in_c(ours, &canvas, None) };
                assert!(drawn == truth, "{what}");
                let filled = drawn.iter().filter(|pixel| pixel[1] > 0.05).count();
                assert!(filled > 1_000, "{what}: {filled} pixels");
                seen.push(drawn);
            }
        }
        assert!(seen[0] != seen[1] && seen[3] != seen[4], "placed elsewhere");
    });
}

#[test]
fn a_scene_by_the_hosts_own_staging_memory_is_the_same_bytes() {
    with_both(2_900, |scene, lent, device, ours| {
        let world = World::new(scene, Raster::Tiles);
        let canvas = world.canvas(lent, device);
        let truth = world.drawn(device, &canvas);
        let mut needed = 0;
        // SAFETY: the handles are alive, and the number may be overwritten.
        unsafe {
            let ask = |format, bytes: &mut u64| {
                rara_scene_buffers_staging_bytes(ours.gaussians, format, bytes)
            };
            assert_fails(ask(4, &mut needed), "sh_format 4");
            assert_ok(ask(RARA_SH_FORMAT_PACKED, &mut needed));
        }
        assert_eq!(needed, SceneBuffers::staging_bytes(scene, ShFormat::Packed));
        let mut memory = device
            .create_buffer(&BufferDesc {
                name: "host's staging",
                size: needed + 64,
                location: Location::Upload,
            })
            .expect("a buffer");
        let staging = RaraStaging {
            buffer: memory.handle(),
            offset: 64,
            mapped: memory.mapped_mut()[64..].as_mut_ptr().cast(),
            size: needed as usize,
        };
        // SAFETY: the handles and the memory are alive.
        let drawn = unsafe { world.drawn_in_c(ours, &canvas, Some(staging)) };
        assert!(drawn == truth);
    });
}
