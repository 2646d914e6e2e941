//! The kinds of frame whose pipelines and commands are examined.

use rara::ash::vk;
use rara::glam::{DQuat, DVec3};
use rara::scene::{Bounds, Kind, generate};
use rara::{
    Camera, Clip, ClipOp, DepthDesc, DepthMap, Error, ExpectedDepthDesc, Gaussians, Layer, Mode,
    MotionDesc, Preset, Raster, Renderer, RendererDesc, Scene, SceneBuffers, Settings, ShFormat,
    Shape,
};
use rara_gpu::{Bindings, Device, DeviceDesc, DeviceShape, Drawer, Image, RecordedCommands};

use crate::common;

pub const FORMAT: vk::Format = vk::Format::R32G32B32A32_SFLOAT;
/// A picture in which each kind of work occurs. Not a multiple of a tile.
pub const SMALL: (u32, u32) = (253, 190);
/// A picture with more macro-tiles than a digit has values: their sort takes a second pass.
pub const LARGE: (u32, u32) = (2600, 1500);

/// The clips and modes: a name, the mode and how many planes.
const CLIPS: [(&str, Mode, usize); 8] = [
    ("no clip", Mode::None, 0),
    ("hard", Mode::Hard, 1),
    ("rara, one plane", Mode::Rara, 1),
    ("rara, three planes", Mode::Rara, 3),
    ("exact, one plane", Mode::Exact, 1),
    ("exact, three planes", Mode::Exact, 3),
    ("rara, shapes", Mode::Rara, SHAPES),
    ("exact, shapes", Mode::Exact, SHAPES),
];
/// In place of a number of planes: curved shapes, and parts.
const SHAPES: usize = usize::MAX;

/// What of a host a frame has to do with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Host {
    Plain,
    /// Splats are tested against its depth, which tiles read before its scope.
    HasDepth,
    /// It asks for the splats' depths.
    WantsDepth,
    /// It asks for their motion, which follows from their depths.
    WantsMotion,
}

/// A kind of frame.
#[derive(Debug, Clone)]
pub struct Frame {
    pub name: String,
    pub raster: Raster,
    mode: Mode,
    pub planes: usize,
    /// How often the clip has moved before a camera that stands still.
    pub moves: u32,
    layered: bool,
    stored: ShFormat,
    preset: Preset,
    host: Host,
}

impl Frame {
    /// True when its commands are in the budget: meshes have those of quads, and layers change none.
    pub fn is_counted(&self) -> bool {
        self.is_usual() && !self.layered && self.raster != Raster::Mesh
    }

    /// True of frames that can be recorded without a host's images, and that differ from the others in more than their shaders'
    /// constants.
    pub fn is_own_recording(&self) -> bool {
        let stored = self.stored == ShFormat::Packed && self.preset == Preset::Balanced;
        stored && self.host == Host::Plain
    }

    /// True when the splats' depths are found for the host.
    pub fn wants_depth(&self) -> bool {
        matches!(self.host, Host::WantsDepth | Host::WantsMotion)
    }

    /// True of frames in whose commands the others do not differ: more planes in a mode that is not exact, another format or
    /// another preset change none.
    pub fn is_usual(&self) -> bool {
        let stored = self.stored == ShFormat::Packed && self.preset == Preset::Balanced;
        let clip = match self.mode {
            Mode::Exact => self.planes != SHAPES,
            Mode::Rara => false,
            _ => self.planes <= 1,
        };
        stored && clip && self.host != Host::HasDepth
    }
}

/// A device, and all that frames are drawn of.
pub struct Frames {
    renderer: Renderer,
    bindings: Bindings,
    camera: Camera,
    scene: Gaussians,
    /// The same Gaussians as one layer, stored in each way, and as two.
    stored: Vec<(ShFormat, SceneBuffers)>,
    layered: SceneBuffers,
    /// The family that frames are prepared for, where they are drawn in another queue.
    pub compute_family: Option<u32>,
    pub device: Device,
}

impl Frames {
    /// On any device, with the pipelines for GPUs, under validation.
    pub fn on_a_gpus_pipelines(size: (u32, u32)) -> Self {
        let desc = DeviceDesc::default()
            .selector(std::env::var("RARA_TEST_DEVICE").ok())
            .validation(true);
        let device = Device::headless(&desc).expect("a Vulkan device and the validation layer");
        let [least, most] = device.support().full_subgroups;
        let subgroup = 32.clamp(least, most);
        drop(device);
        Self::on(&desc.shape(Some(DeviceShape::Gpu { subgroup })), size)
    }

    /// On a device that takes notes.
    pub fn on(desc: &DeviceDesc, size: (u32, u32)) -> Self {
        Self::bound_as(Bindings::default(), desc, size)
    }

    /// The same with buffers that are reached in one way.
    pub fn bound_as(bindings: Bindings, desc: &DeviceDesc, size: (u32, u32)) -> Self {
        let device = Device::headless_inspected(desc).expect("a Vulkan device");
        let scene = generate(Kind::General, 2000, 5);
        let upload = |format| SceneBuffers::upload(&device, &scene, format).expect("uploads");
        let formats = [
            ShFormat::Packed,
            ShFormat::Float,
            ShFormat::Half,
            ShFormat::Byte,
        ];
        let layers = ["first", "second"].map(|name| Layer::new(name, &scene));
        let layers = Scene::from_iter(layers);
        let layered = SceneBuffers::upload(&device, &layers, ShFormat::Packed);
        Self {
            renderer: Renderer::new(&device, RendererDesc::new(FORMAT).bindings(bindings))
                .expect("a renderer"),
            bindings,
            camera: common::views(&scene, 1, size)[0],
            stored: formats.map(|format| (format, upload(format))).into(),
            layered: layered.expect("uploads"),
            compute_family: None,
            scene,
            device,
        }
    }

    /// Every kind of frame that the device has.
    pub fn all(&self) -> Vec<Frame> {
        let rasters = common::rasters(&self.device);
        rasters.into_iter().flat_map(frames).collect()
    }

    /// Draws a frame and returns its commands, from nothing but the frames that it is to take over from. Nothing is drawn of one for which the host has
    /// to have a depth, only its pipelines are made.
    pub fn draw(&self, frame: &Frame) -> RecordedCommands {
        let mut recorded = RecordedCommands::default();
        self.configured(frame, |renderer, scene, configured| {
            let submitted = self.device.submit_and_wait(|cmd| {
                // SAFETY: `cmd` is recording outside rendering, and all that is used outlives the wait.
                unsafe { renderer.prepare(cmd, scene, None, configured) }
            });
            submitted.unwrap_or_else(|error| panic!("{}: {error}", frame.name));
            recorded = self.device.recorded();
        });
        recorded
    }

    /// Records a frame, with its draws where there is a target, and submits nothing. Returns its commands.
    pub fn record(&self, frame: &Frame, target: Option<&Image>) -> RecordedCommands {
        self.configured(frame, |renderer, scene, configured| {
            let unsubmitted = self.device.submit_and_wait(|cmd| {
                // SAFETY: `cmd` is recording outside rendering, and what is recorded is never executed. The scope is opened
                // and closed around the draw, on an attachment of the renderer's format.
                unsafe {
                    let prepared = renderer.prepare(cmd, scene, None, configured)?;
                    if let Some(target) = target {
                        target.begin_rendering(cmd, [0.0; 4]);
                        Drawer::new(&self.device, cmd, None).viewport(target.extent().into());
                        renderer.draw(cmd, [0.0; 2], &prepared)?;
                        target.end_rendering(cmd);
                    }
                }
                Err::<(), _>(Error::Invalid("recorded".into()))
            });
            let error = unsubmitted.expect_err("nothing is submitted").to_string();
            assert!(error.ends_with("recorded"), "{}: {error}", frame.name);
        });
        self.device.recorded()
    }

    /// Configures a frame after those that it is to reuse, and has each recorded. Nothing is recorded of one for which the host
    /// has to have a depth.
    fn configured(
        &self,
        frame: &Frame,
        mut record: impl FnMut(&mut Renderer, &SceneBuffers, rara::ConfiguredFrame),
    ) {
        let mut desc = RendererDesc::new(FORMAT)
            .reuse(true)
            .bindings(self.bindings)
            .compute_family(self.compute_family);
        match frame.host {
            Host::Plain => {}
            Host::HasDepth => {
                let map = DepthMap::reversed(0.1, 100.0).expect("a map");
                let depth = DepthDesc::new(vk::Format::D32_SFLOAT, map);
                desc = desc.depth(Some(depth.readable(true)));
            }
            Host::WantsDepth => {
                let expected = ExpectedDepthDesc::new(vk::Format::R32G32_SFLOAT);
                desc = desc.expected_depth(Some(expected));
            }
            Host::WantsMotion => desc = desc.motion(Some(MotionDesc::new(FORMAT))),
        }
        let mut renderer = self.renderer.sharing(desc).expect("a renderer");
        let scene = match frame.layered {
            true => &self.layered,
            false => {
                let stored = self
                    .stored
                    .iter()
                    .find(|(format, _)| *format == frame.stored);
                &stored.expect("a scene of each format").1
            }
        };
        let settings = Settings::default()
            .mode(frame.mode)
            .raster(frame.raster)
            .precision(frame.preset.precision());
        for moves in 0..=frame.moves {
            let clip = self.clip(frame.planes, moves);
            let configured = renderer.configure(scene, &self.camera, &clip, &settings);
            let configured = configured.unwrap_or_else(|error| panic!("{}: {error}", frame.name));
            if frame.host != Host::HasDepth {
                record(&mut renderer, scene, configured);
            }
        }
    }

    fn clip(&self, planes: usize, moves: u32) -> Clip {
        if planes == SHAPES {
            let bounds = Bounds::of(&self.scene);
            let (c, r) = (
                bounds.centre(),
                bounds.radius() * (0.6 + 0.05 * f64::from(moves)),
            );
            let ball = Shape::sphere(c, r).expect("a radius");
            let block = Shape::cuboid(c, DVec3::splat(0.4 * r), DQuat::IDENTITY).expect("sizes");
            return Clip::of_shapes(&[ball, block.complement()], ClipOp::And);
        }
        let clip = common::clip(&self.scene, planes, ClipOp::And);
        match moves {
            0 => clip,
            moves => common::moved(clip, 0.05 * f64::from(moves)),
        }
    }

    /// Frees everything; the validation layer must have nothing to say.
    pub fn close(self) {
        let device = self.device.clone();
        drop(self);
        assert_eq!(device.close(), Vec::<String>::new());
    }
}

/// The kinds of frame of a way of drawing.
fn frames(raster: Raster) -> Vec<Frame> {
    let mut all = Vec::new();
    let name = format!("{raster:?}").to_lowercase();
    for (clip, mode, planes) in CLIPS {
        let plain = Frame {
            name: format!("{name}, {clip}"),
            raster,
            mode,
            planes,
            moves: 0,
            layered: false,
            stored: ShFormat::Packed,
            preset: Preset::Balanced,
            host: Host::Plain,
        };
        let more = |what: &str| Frame {
            name: format!("{name}, {clip}, {what}"),
            ..plain.clone()
        };
        let moved = [(1, "moved once"), (2, "moved twice")];
        for (moves, what) in moved.into_iter().filter(|_| planes > 0) {
            all.push(Frame {
                moves,
                ..more(what)
            });
            let layered = more(&format!("layered, {what}"));
            all.push(Frame {
                moves,
                layered: true,
                ..layered
            });
        }
        all.push(Frame {
            layered: true,
            ..more("layered")
        });
        all.push(Frame {
            host: Host::HasDepth,
            ..more("behind the host's depth")
        });
        all.push(Frame {
            host: Host::WantsDepth,
            ..more("with expected depths")
        });
        // Only tiles find it.
        if raster == Raster::Tiles {
            all.push(Frame {
                host: Host::WantsMotion,
                ..more("with motion")
            });
        }
        all.push(Frame {
            preset: Preset::Fast,
            ..more("fast")
        });
        for stored in [ShFormat::Float, ShFormat::Half, ShFormat::Byte] {
            all.push(Frame {
                stored,
                ..more(&format!("{stored:?}"))
            });
        }
        all.push(plain);
    }
    all
}
