//! A frame by the Rust interface, and the same frame by `rara.h`.

use std::cell::Cell;
use std::ffi::CStr;

use super::*;
use crate::canvas::{CanvasDesc, Frame};
use crate::clips::clip_of;
use rara::clip::Expression;
use rara::glam::DMat4;
use rara::gpu::{Bindings, DepthImage};
use rara::scene::Bounds;
use rara::{
    Camera, Clip, ClipOp, DepthDesc, DepthMap, ExpectedDepthDesc, MotionDesc, Ndc, Plane,
    Projection, Renderer, RendererDesc, Settings,
};
use rara_c::boundary::*;
use rara_c::camera::*;
use rara_c::clip::*;
use rara_c::depth::*;
use rara_c::frame::*;
use rara_c::matrices::*;
use rara_c::placement::*;
use rara_c::renderer::*;
use rara_c::renderer_desc::*;
use rara_c::settings::*;

const FLOATS: vk::Format = vk::Format::R32G32B32A32_SFLOAT;
const DEPTHS: vk::Format = vk::Format::R32G32_SFLOAT;
const DEPTH: vk::Format = vk::Format::D32_SFLOAT;
const VIEW: (u32, u32) = (121, 83);
/// The depth that becomes 1 in perspective, where infinity becomes 0.
const NEAR: f64 = 0.05;

/// The depths that become 0 and 1 without perspective.
const FLAT: [f64; 2] = [40.0, 0.0];

/// What a frame draws.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Drawn {
    Colours,
    Depths,
    Motion,
}

impl Drawn {
    fn format(self) -> vk::Format {
        match self {
            Self::Depths => DEPTHS,
            Self::Colours | Self::Motion => FLOATS,
        }
    }
}

/// A frame that both interfaces draw.
pub(super) struct World<'a> {
    /// The Gaussians that the camera looks at.
    pub(super) scene: &'a Gaussians,
    /// The layers that are drawn: the scene alone, unless a test adds more.
    pub(super) layers: Scene<'a>,
    pub(super) camera: Camera,
    pub(super) plane: Plane,
    pub(super) raster: Raster,
    pub(super) placement: Placement,
    pub(super) drawn: Drawn,
    /// The expression that clips in place of the plane.
    pub(super) region: Option<&'static CStr>,
    /// A host's view and projection, which say what the camera is and what depths are; y is up.
    pub(super) matrices: Option<[DMat4; 2]>,
}

impl<'a> World<'a> {
    pub(super) fn new(scene: &'a Gaussians, raster: Raster) -> Self {
        let bounds = Bounds::of(scene);
        let normal = DVec3::new(0.6, 0.0, 0.8);
        Self {
            scene,
            layers: scene.into(),
            camera: Camera::frame(&bounds, DVec3::NEG_Y, 50.0, VIEW).expect("a view"),
            plane: Plane::new(normal, 0.1 - normal.dot(bounds.centre())).expect("a normal"),
            raster,
            placement: Placement::IDENTITY,
            drawn: Drawn::Colours,
            region: None,
            matrices: None,
        }
    }

    /// What clips the frame.
    fn clip(&self) -> Clip {
        let Some(text) = self.region else {
            return Clip::of([self.plane], ClipOp::And);
        };
        let expression: Expression = text.to_str().expect("UTF-8").parse().expect("a region");
        expression.clip()
    }

    /// The same seen without perspective.
    pub(super) fn flat(scene: &'a Gaussians, raster: Raster) -> Self {
        let camera = Camera::frame_orthographic(&Bounds::of(scene), DVec3::NEG_Y, VIEW);
        Self {
            camera: camera.expect("a view"),
            ..Self::new(scene, raster)
        }
    }

    /// The same seen by a host's matrices, for depths that are reversed.
    pub(super) fn of_matrices(mut self, matrices: [DMat4; 2]) -> Self {
        self.matrices = Some(matrices);
        self.camera = self.host_view(matrices).0;
        self
    }

    /// The picture's width and height, pixels.
    pub(super) fn size(&self) -> [f64; 2] {
        [VIEW.0.into(), VIEW.1.into()]
    }

    fn host_view(&self, [view, projection]: [DMat4; 2]) -> (Camera, DepthMap) {
        let ndc = Ndc::DIRECT3D.reversed(true);
        Camera::of_projection(view, projection, ndc, VIEW).expect("a camera")
    }

    fn map(&self) -> DepthMap {
        if let Some(matrices) = self.matrices {
            return self.host_view(matrices).1;
        }
        let map = match self.camera.projection {
            Projection::Orthographic => DepthMap::orthographic(FLAT[0], FLAT[1]),
            _ => DepthMap::reversed(NEAR, f64::INFINITY),
        };
        map.expect("proper depths")
    }

    /// A canvas with a mesh amid the splats, in the middle of the picture.
    pub(super) fn canvas(&self, lent: &AdoptDesc, device: &Device) -> Canvas {
        let mut desc = CanvasDesc::new(VIEW, self.drawn.format());
        (desc.depth, desc.far) = (DEPTH, 0.0);
        if self.drawn == Drawn::Motion {
            desc.clear = [7.0; 4];
        }
        let centre = self.placement.to_world(Bounds::of(self.scene).centre());
        let z = (self.camera.rotation * (centre - self.camera.eye)).z;
        let rect = vk::Rect2D {
            offset: vk::Offset2D { x: 41, y: 20 },
            extent: vk::Extent2D {
                width: 50,
                height: 45,
            },
        };
        desc.meshes = vec![(rect, self.map().at(z) as f32)];
        Canvas::new(lent, device, desc)
    }

    /// Draws by the Rust interface.
    pub(super) fn drawn(&self, device: &Device, canvas: &Canvas) -> Pixels {
        let desc = RendererDesc::new(FLOATS)
            .depth(Some(DepthDesc::new(DEPTH, self.map()).readable(true)))
            .expected_depth(Some(ExpectedDepthDesc::new(DEPTHS)))
            .motion((self.drawn == Drawn::Motion).then(|| MotionDesc::new(FLOATS)))
            .bindings(Bindings::Mixed);
        let scene = SceneBuffers::upload(device, self.layers.clone(), ShFormat::Packed);
        let scene = scene.expect("uploads");
        let mut renderer = Renderer::new(device, desc).expect("a renderer");
        renderer.set_placement(self.placement);
        let settings = Settings::default().raster(self.raster);
        let configured = renderer.configure(&scene, &self.camera, &self.clip(), &settings);
        let frame = Frame {
            behind: Some(canvas.depth_image(0, 0)),
            call: match self.drawn {
                Drawn::Colours => Renderer::draw,
                Drawn::Depths => Renderer::draw_depth,
                Drawn::Motion => Renderer::draw_motion,
            },
            ..Frame::new(VIEW)
        };
        canvas.draw_frame(&mut renderer, &scene, configured, &frame)
    }

    /// Draws by rara.h the scene that `scene` returns, which may upload it in the frame's own commands.
    ///
    /// # Safety
    /// The device and the scene are alive.
    pub(super) unsafe fn drawn_in_c(
        &self,
        device: *mut RaraDevice,
        canvas: &Canvas,
        scene: impl Fn(vk::CommandBuffer) -> *mut RaraSceneBuffers,
    ) -> Pixels {
        // SAFETY: the caller's promises; everything below is alive, or to be overwritten.
        unsafe {
            let is_flat = self.camera.projection == Projection::Orthographic;
            let (mut map, [zero, one]) = (std::mem::zeroed(), FLAT);
            assert_ok(match is_flat {
                true => rara_depth_map_orthographic(zero, one, &mut map),
                false => rara_depth_map_perspective(NEAR, f64::INFINITY, vk::TRUE, &mut map),
            });
            let mut depth: RaraDepthDesc = std::mem::zeroed();
            let size = size_of_val(&depth);
            assert_ok(rara_depth_desc_default(&mut depth, size, DEPTH, map));
            depth.readable = vk::TRUE;
            let mut desc: RaraRendererDesc = std::mem::zeroed();
            let size = size_of_val(&desc);
            assert_ok(rara_renderer_desc_default(&mut desc, size, FLOATS));
            (desc.depth, desc.expected_depth_format) = (&depth, DEPTHS);
            if self.drawn == Drawn::Motion {
                desc.motion_format = FLOATS;
            }
            desc.bindings = RARA_BINDINGS_MIXED;
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
            let mut camera = RaraCamera::from(self.camera);
            let shown = canvas.depth_image(0, 0);
            let shown = depth_image_in_c(&shown);
            if let Some(matrices) = self.matrices {
                let (near, far) = (camera.clip_near, camera.clip_far);
                (camera, map) = host_view_in_c(matrices);
                (camera.clip_near, camera.clip_far) = (near, far);
                assert_ok(rara_renderer_set_depth_map(renderer, &map));
                assert_eq!(map.projection, u32::from(is_flat));
            }
            let mut clip = clip_of(&[plane]);
            if let Some(text) = self.region {
                rara_clip_destroy(clip);
                assert_ok(rara_clip_parse(text.as_ptr(), &mut clip));
            }
            let made = Cell::new(null_mut());
            let before = |cmd| {
                let scene = scene(cmd);
                let mut frame = null_mut();
                let (camera, settings) = (&camera, &settings);
                assert_ok(rara_renderer_configure(
                    renderer, scene, camera, clip, settings, &mut frame,
                ));
                made.set(frame);
                let early = rara_renderer_draw(renderer, cmd, 0.0, 0.0, frame);
                assert_eq!(early, RARA_ERROR_INVALID);
                assert_ok(rara_renderer_prepare(renderer, cmd, scene, &shown, frame));
                let again = rara_renderer_prepare(renderer, cmd, scene, &shown, frame);
                assert_eq!(again, RARA_ERROR_INVALID);
            };
            let inside = |cmd| {
                canvas.viewport(cmd, 0, 0, VIEW);
                let draw = match self.drawn {
                    Drawn::Colours => rara_renderer_draw,
                    Drawn::Depths => rara_renderer_draw_depth,
                    Drawn::Motion => rara_renderer_draw_motion,
                };
                assert_ok(draw(renderer, cmd, 0.0, 0.0, made.get()));
            };
            let [pixels, _] = canvas.draw(before, inside);
            rara_clip_destroy(clip);
            rara_frame_destroy(made.get());
            rara_renderer_destroy(renderer);
            pixels
        }
    }
}

fn depth_image_in_c(shown: &DepthImage) -> RaraDepthImage {
    // SAFETY: the struct may hold any bytes, and has the room that the call is given.
    unsafe {
        let mut image: RaraDepthImage = std::mem::zeroed();
        let (size, extent) = (size_of_val(&image), shown.extent);
        let (width, height) = (extent.width, extent.height);
        let filled = rara_depth_image_default(&mut image, size, shown.image, width, height);
        assert_ok(filled);
        (image.layout, image.layer) = (shown.layout, shown.layer);
        image.view = shown.view;
        (image.x, image.y) = (shown.origin.x, shown.origin.y);
        image
    }
}

/// What a host's matrices are in C, which it keeps row by row.
unsafe fn host_view_in_c(matrices: [DMat4; 2]) -> (RaraCamera, RaraDepthMap) {
    let [view, projection] = matrices.map(|matrix| matrix.transpose().to_cols_array());
    // SAFETY: both have 16 numbers, and the structs have the room that the calls are given.
    unsafe {
        let (mut ndc, mut camera): (RaraNdc, RaraCamera) = (std::mem::zeroed(), std::mem::zeroed());
        let mut map = std::mem::zeroed();
        assert_ok(rara_ndc_default(&mut ndc, size_of_val(&ndc)));
        ndc.order = RARA_MATRIX_ORDER_TRANSLATION_BESIDE;
        (ndc.y_up, ndc.reversed) = (vk::TRUE, vk::TRUE);
        let (width, height) = VIEW;
        assert_ok(rara_camera_of_projection(
            view.as_ptr(),
            projection.as_ptr(),
            &ndc,
            width,
            height,
            &mut camera,
            size_of::<RaraCamera>(),
            &mut map,
        ));
        (camera, map)
    }
}
