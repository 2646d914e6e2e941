//! Frames through the functions of `rara.h` on the example host's device are those of the Rust interface to the byte: splats
//! behind what the host has drawn, expected depths, a scene placed in a world, a scene by the host's own staging memory,
//! layers that are hidden, moved and faded.

use std::cell::Cell;
use std::ffi::{CStr, CString};
use std::path::{Path, PathBuf};
use std::ptr::{null, null_mut};

use crate::canvas::{Canvas, CanvasDesc, Frame, with_host};
use crate::folder::Folder;
use rara::ash::{Entry, vk};
use rara::glam::{DQuat, DVec3};
use rara::gpu::{AdoptDesc, Bindings, Buffer, BufferDesc, Device, Location};
use rara::scene::{Bounds, Kind, generate, load, save_ply};
use rara::{
    Camera, Clip, ClipOp, DepthDesc, DepthMap, ExpectedDepthDesc, Gaussians, Layer, LayerState,
    Placement, Plane, Raster, Renderer, RendererDesc, Scene, SceneBuffers, Settings, ShFormat,
};
use rara_c::boundary::*;
use rara_c::camera::*;
use rara_c::clip::*;
use rara_c::depth::*;
use rara_c::device::*;
use rara_c::layer::*;
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
    /// What the camera looks at.
    scene: &'a Gaussians,
    /// What is drawn: the scene alone, unless a test adds more.
    layers: Scene<'a>,
    camera: Camera,
    plane: Plane,
    raster: Raster,
    placement: Placement,
    /// Whether expected depths are drawn, not colours.
    depths: bool,
}

impl<'a> World<'a> {
    fn new(scene: &'a Gaussians, raster: Raster) -> Self {
        let bounds = Bounds::of(scene);
        let normal = DVec3::new(0.6, 0.0, 0.8);
        Self {
            scene,
            layers: scene.into(),
            camera: Camera::frame(&bounds, DVec3::NEG_Y, 50.0, VIEW).expect("a view"),
            plane: Plane::new(normal, 0.1 - normal.dot(bounds.centre())).expect("a normal"),
            raster,
            placement: Placement::IDENTITY,
            depths: false,
        }
    }

    /// A canvas with a mesh amid the splats, in the middle of the picture.
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

    /// Draws by the Rust interface.
    fn drawn(&self, device: &Device, canvas: &Canvas) -> Pixels {
        let desc = RendererDesc::new(FLOATS)
            .depth(Some(DepthDesc::new(DEPTH, map()).readable(true)))
            .expected_depth(Some(ExpectedDepthDesc::new(DEPTHS)))
            .bindings(Bindings::Bound);
        let scene = SceneBuffers::upload(device, self.layers.clone(), ShFormat::Packed);
        let scene = scene.expect("uploads");
        let mut renderer = Renderer::new(device, desc).expect("a renderer");
        renderer.set_placement(self.placement);
        let settings = Settings::default().raster(self.raster);
        let clip = Clip::of([self.plane], ClipOp::And);
        let configured = renderer.configure(&scene, &self.camera, &clip, &settings);
        configured.expect("configures");
        let frame = Frame {
            behind: Some(canvas.depth_image(0, 0)),
            depths: self.depths,
            ..Frame::new(VIEW)
        };
        canvas.draw_frame(&mut renderer, &scene, &frame)
    }

    /// Draws by rara.h the scene that `scene` returns, which may upload it in the frame's own commands.
    ///
    /// # Safety
    /// The device and the scene are alive.
    unsafe fn drawn_in_c(
        &self,
        device: *mut RaraDevice,
        canvas: &Canvas,
        scene: impl Fn(vk::CommandBuffer) -> *mut RaraSceneBuffers,
    ) -> Pixels {
        // SAFETY: the caller's promises; everything below is alive, or to be overwritten.
        unsafe {
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
            let placement = RaraPlacement::from(self.placement);
            assert_ok(rara_renderer_set_placement(renderer, &placement));
            let nowhere = RaraPlacement {
                scale: 0.0,
                ..placement
            };
            let refused = rara_renderer_set_placement(renderer, &nowhere);
            assert_eq!(refused, RARA_ERROR_INVALID); // the placement stays as it was

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
                let scene = scene(cmd);
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
            pixels
        }
    }
}

fn map() -> DepthMap {
    DepthMap::reversed(MAP.z_near, MAP.z_far).expect("0 < near < far")
}

/// What stays the same while frames are drawn in C.
struct Ours {
    device: *mut RaraDevice,
    gaussians: *mut RaraGaussians,
}

impl Ours {
    /// # Safety
    /// The host and its loader outlive what is returned.
    unsafe fn new(entry: &Entry, host: &AdoptDesc, path: &Path) -> Self {
        let mut device = null_mut();
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
        }
        let gaussians = loaded_in_c(path);
        Self { device, gaussians }
    }

    /// Uploads its Gaussians to its device.
    fn uploaded(&self) -> *mut RaraSceneBuffers {
        let (mut scene, format) = (null_mut(), RARA_SH_FORMAT_PACKED);
        // SAFETY: both are alive, and the pointer may be overwritten.
        assert_ok(unsafe {
            rara_scene_buffers_upload(self.device, self.gaussians, format, &mut scene)
        });
        scene
    }
}

/// Writes so many made-up Gaussians to a file, and loads them from it: a file has opacities and scales in another form.
fn saved(folder: &Folder, kind: Kind, count: usize) -> (PathBuf, Gaussians) {
    let path = folder.join("scene.ply");
    save_ply(&path, &generate(kind, count, 5)).expect("a temporary file");
    let loaded = load(&path, &mut |_, _| ()).expect("loads");
    (path, loaded.gaussians)
}

fn loaded_in_c(path: &Path) -> *mut RaraGaussians {
    let mut gaussians = null_mut();
    let name = CString::new(path.to_str().expect("UTF-8")).expect("no NUL");
    // SAFETY: the name ends in NUL, and the pointer may be overwritten.
    assert_ok(unsafe { rara_gaussians_load(name.as_ptr(), &mut gaussians) });
    gaussians
}

/// # Safety
/// As for `rara_scene_buffers_upload_with`.
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
    let (path, scene) = saved(&folder, Kind::General, count);
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

#[test]
fn what_is_behind_a_mesh_and_expected_depths_are_the_same_bytes() {
    with_both(3_000, |scene, lent, device, ours| {
        let turn = DQuat::from_xyzw(0.1, -0.2, 0.05, 0.9);
        let placed = Placement::new(DVec3::new(0.3, -0.1, 0.2), turn, 0.8).expect("possible");
        let mut seen: Vec<Pixels> = Vec::new();
        let uploaded = ours.uploaded();
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
                let drawn = unsafe { world.drawn_in_c(ours.device, &canvas, |_| uploaded) };
                assert!(drawn == truth, "{what}");
                let filled = drawn.iter().filter(|pixel| pixel[1] > 0.05).count();
                assert!(filled > 1_000, "{what}: {filled} pixels");
                seen.push(drawn);
            }
        }
        assert!(seen[0] != seen[1] && seen[3] != seen[4], "placed elsewhere");
        // SAFETY: all frames were waited for.
        unsafe { rara_scene_buffers_destroy(uploaded) };
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
        let (_memory, staging) = staging(device, needed);
        let scene = Cell::new(null_mut());
        // SAFETY: the handles and the memory are alive; the scene is when its frame has been waited for.
        unsafe {
            let drawn = world.drawn_in_c(ours.device, &canvas, |cmd| {
                upload_with(ours, cmd, &staging, scene.as_ptr());
                scene.get()
            });
            assert!(drawn == truth);
            rara_scene_buffers_destroy(scene.get());
        }
    });
}

/// So many bytes of the host's memory, behind some that are not lent.
fn staging(device: &Device, bytes: u64) -> (Buffer, RaraStaging) {
    let offset = 64;
    let mut memory = device
        .create_buffer(&BufferDesc {
            name: "host's staging",
            size: offset + bytes,
            location: Location::Upload,
        })
        .expect("a buffer");
    let staging = RaraStaging {
        buffer: memory.handle(),
        offset,
        mapped: memory.mapped_mut()[offset as usize..].as_mut_ptr().cast(),
        size: bytes as usize,
    };
    (memory, staging)
}

const NAMES: [&CStr; 2] = [c"first", c"zweite \u{e4}"];

/// Two layers as rara.h has them.
fn layers_in_c(
    gaussians: [*mut RaraGaussians; 2],
    states: [*const RaraLayerState; 2],
) -> [RaraLayer; 2] {
    [0, 1].map(|index| {
        // SAFETY: the struct may hold any bytes, and has the room that the call is given.
        unsafe {
            let mut layer: RaraLayer = std::mem::zeroed();
            let (size, name) = (size_of_val(&layer), NAMES[index].as_ptr());
            assert_ok(rara_layer_default(&mut layer, size, name, gaussians[index]));
            layer.state = states[index];
            layer
        }
    })
}

#[test]
fn layers_are_the_same_bytes() {
    let own = Folder::new("c-frames-layers");
    let (path, other) = saved(&own, Kind::Strands, 1_300);
    with_both(2_100, |scene, lent, device, ours| {
        let gaussians = [ours.gaussians, loaded_in_c(&path)];
        let counts = [scene.len(), other.len()];
        let shown = LayerState::default();
        let turn = DQuat::from_xyzw(0.1, 0.3, -0.2, 0.9);
        let moved = Placement::new(DVec3::new(0.4, -0.2, 0.1), turn, 1.2).expect("possible");
        let faded = shown.placement(moved).opacity(0.35);
        let format = RARA_SH_FORMAT_PACKED;
        let mut uploaded = null_mut();
        // SAFETY: the layers are alive, the pointer may be overwritten.
        unsafe {
            let layers = layers_in_c(gaussians, [null(); 2]);
            assert_ok(rara_scene_buffers_upload_layers(
                ours.device,
                layers.as_ptr(),
                layers.len(),
                format,
                &mut uploaded,
            ));
            assert_eq!(rara_scene_buffers_layer_count(uploaded), layers.len());
            for (index, count) in counts.into_iter().enumerate() {
                let mut info: RaraLayerInfo = std::mem::zeroed();
                let size = size_of_val(&info);
                let result = rara_scene_buffers_layer_info(uploaded, index, &mut info, size);
                assert_ok(result);
                assert_eq!((info.struct_size, info.count), (size, count as u64));
                assert_eq!(CStr::from_ptr(info.name), NAMES[index]);
            }
        }
        let mut seen: Vec<Pixels> = Vec::new();
        for (raster, states) in [
            (Raster::Tiles, [shown, shown]),
            (Raster::Tiles, [shown.visible(false), shown]),
            (Raster::Tiles, [shown, faded]),
            (Raster::Quad, [shown, faded]),
        ] {
            let names = NAMES.map(|name| name.to_str().expect("UTF-8"));
            let world = World {
                layers: Scene::from_iter([
                    Layer::new(names[0], scene).with(states[0]),
                    Layer::new(names[1], &other).with(states[1]),
                ]),
                ..World::new(scene, raster)
            };
            let canvas = world.canvas(lent, device);
            let truth = world.drawn(device, &canvas);
            let what = format!("{raster:?}, {states:?}");

            // The state is set in a scene that has been drawn in another state.
            let given = states.map(RaraLayerState::from);
            // SAFETY: the scene is alive, and nobody else uses it.
            unsafe {
                for (index, given) in given.iter().enumerate() {
                    assert_ok(rara_scene_buffers_set_layer_state(uploaded, index, given));
                    let mut state: RaraLayerState = std::mem::zeroed();
                    let size = size_of_val(&state);
                    let result = rara_scene_buffers_layer_state(uploaded, index, &mut state, size);
                    assert_ok(result);
                    assert_eq!(state, *given, "{what}");
                }
                let drawn = world.drawn_in_c(ours.device, &canvas, |_| uploaded);
                assert!(drawn == truth, "{what}");
            }

            // The scene is uploaded in that state, by the host's staging memory.
            let layers = layers_in_c(gaussians, given.each_ref().map(std::ptr::from_ref));
            let (list, count) = (layers.as_ptr(), layers.len());
            let (mut bytes, staged) = (0, Cell::new(null_mut()));
            // SAFETY: the handles and the memory are alive; the scene is when its frame has been waited for.
            unsafe {
                assert_ok(rara_scene_buffers_staging_bytes_of_layers(
                    list, count, format, &mut bytes,
                ));
                let (_memory, staging) = staging(device, bytes);
                let drawn = world.drawn_in_c(ours.device, &canvas, |cmd| {
                    assert_ok(rara_scene_buffers_upload_layers_with(
                        ours.device,
                        cmd,
                        &staging,
                        list,
                        count,
                        format,
                        staged.as_ptr(),
                    ));
                    staged.get()
                });
                assert!(drawn == truth, "{what}, staged");
                rara_scene_buffers_destroy(staged.get());
            }
            seen.push(truth);
        }
        assert!(seen[0] != seen[1] && seen[0] != seen[2] && seen[1] != seen[2]);

        // A clip without planes keeps a layer that the frame's clip would cut.
        let names = NAMES.map(|name| name.to_str().expect("UTF-8"));
        let world = World {
            layers: Scene::from_iter([
                Layer::new(names[0], scene),
                Layer::new(names[1], &other).clipped(Clip::default()),
            ]),
            ..World::new(scene, Raster::Tiles)
        };
        let canvas = world.canvas(lent, device);
        let truth = world.drawn(device, &canvas);
        assert!(truth != seen[0], "the frame's clip cuts it otherwise");
        let whole = RaraClip {
            planes: null(),
            plane_count: 0,
            op: RARA_CLIP_OP_AND,
        };
        // SAFETY: as above.
        unsafe {
            let given = RaraLayerState::from(shown);
            for index in 0..2 {
                assert_ok(rara_scene_buffers_set_layer_state(uploaded, index, &given));
            }
            assert_ok(rara_scene_buffers_set_layer_clip(uploaded, 1, &whole));
            let drawn = world.drawn_in_c(ours.device, &canvas, |_| uploaded);
            assert!(drawn == truth, "a clip of its own");
            assert_ok(rara_scene_buffers_set_layer_clip(uploaded, 1, null()));
            let drawn = world.drawn_in_c(ours.device, &canvas, |_| uploaded);
            assert!(drawn == seen[0], "the frame's clip again");
        }
        // SAFETY: all frames were waited for.
        unsafe {
            rara_scene_buffers_destroy(uploaded);
            rara_gaussians_destroy(gaussians[1]);
        }
    });
}
