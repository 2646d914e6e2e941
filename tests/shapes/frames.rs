//! The same frame by several kinds of pipelines, and all that they leave of it.

use rara::gpu::{Bindings, DeviceShape};
use rara::types::{FrameCounts, FrameData, Gaussian};
use rara::{Camera, Clip, Gaussians, Headless, Picture, Raster, Scene, Settings};
use rara_base::limits::SORT_BITS;

use crate::common;

/// The most that a channel may differ, of 255: the pipelines for CPU drivers carry a weight down a tile's column.
const APART: f32 = 0.01;

/// What a frame leaves, whichever pipelines have drawn it.
struct Drawn {
    counts: FrameCounts,
    /// The parts of the working memory that every kind of pipeline fills.
    buffers: Vec<(&'static str, Vec<u8>)>,
    picture: Picture,
}

/// A renderer for each kind of pipelines, with one scene. The first one is for CPU drivers.
pub struct Shapes {
    renderers: Vec<(DeviceShape, Headless)>,
}

impl Shapes {
    /// Pipelines for CPU drivers, for GPUs with the device's own subgroups, and for GPUs that cannot be asked for any.
    pub fn new() -> Self {
        let cpu = common::headless_shaped(Bindings::Mixed, DeviceShape::Cpu);
        let [least, most] = cpu.device().support().full_subgroups;
        let mut shapes = vec![DeviceShape::Gpu { subgroup: 0 }];
        if most >= 8 {
            let subgroup = least.max(8);
            shapes.push(DeviceShape::Gpu { subgroup });
        } else {
            eprintln!("SKIPPED: this device has no subgroups of 8; pipelines without are compared");
        }
        let others = shapes.into_iter().map(|shape| {
            let renderer = common::headless_shaped(Bindings::Mixed, shape);
            assert_eq!(renderer.device().shape(), shape);
            (shape, renderer)
        });
        Self {
            renderers: std::iter::once((DeviceShape::Cpu, cpu))
                .chain(others)
                .collect(),
        }
    }

    pub fn load<'a>(&mut self, scene: impl Into<Scene<'a>>) {
        let scene = scene.into();
        for (_, renderer) in &mut self.renderers {
            renderer.load(&scene).expect("uploads");
        }
    }

    /// What the frame before has counted with pipelines for GPUs.
    pub fn counts(&mut self) -> FrameCounts {
        let (_, renderer) = self.renderers.last_mut().expect("several");
        let bytes = renderer.working_buffer("counts").expect("the counts");
        bytemuck::pod_read_unaligned(&bytes)
    }

    /// One of the renderers for GPUs, by turns.
    pub fn for_gpus(&mut self, turn: usize) -> &mut Headless {
        let [_, gpus @ ..] = &mut self.renderers[..] else {
            panic!("several");
        };
        let count = gpus.len();
        &mut gpus[turn % count].1
    }

    /// The numbers of the splats that one of the renderers for GPUs draws as quads, in their order.
    pub fn numbers_in_order(&mut self, scene: &Gaussians, camera: &Camera) -> Vec<u32> {
        let renderer = self.for_gpus(0);
        renderer.load(scene).expect("uploads");
        let settings = Settings::default().raster(Raster::Quad);
        let drawn = renderer.render(camera, &Clip::default(), &settings);
        let drawn = drawn.expect("renders").counts.drawn as usize;
        let (.., [_, order]) = constants(renderer);
        let mut words = |name: &str| -> Vec<u32> {
            bytemuck::pod_collect_to_vec(&read(renderer, name, 4 * drawn))
        };
        let (order, gaussians) = (words(order), words("splat_gaussians"));
        let stored = read(renderer, "gaussians", scene.len() * size_of::<Gaussian>());
        let stored: Vec<Gaussian> = bytemuck::pod_collect_to_vec(&stored);
        let number = |splat: &u32| stored[gaussians[*splat as usize] as usize].scale[3].to_bits();
        order.iter().map(number).collect()
    }

    /// Draws a whole frame with each and compares them. Returns how many Gaussians are drawn.
    pub fn check(&mut self, what: &str, camera: &Camera, clip: &Clip, settings: &Settings) -> u32 {
        for (_, renderer) in &mut self.renderers {
            renderer.forget();
        }
        self.check_next(what, camera, clip, settings)
    }

    /// The same, and draws it twice more with the last for GPUs: no run may differ from another.
    pub fn check_runs(
        &mut self,
        what: &str,
        camera: &Camera,
        clip: &Clip,
        settings: &Settings,
    ) -> u32 {
        let drawn = self.check(what, camera, clip, settings);
        let (_, gpu) = self.renderers.last_mut().expect("several");
        let once = draw(gpu, camera, clip, settings);
        gpu.forget();
        let twice = draw(gpu, camera, clip, settings);
        assert!(once.buffers == twice.buffers, "{what}: another run differs");
        assert!(
            once.picture.pixels == twice.picture.pixels,
            "{what}: another run's picture differs"
        );
        drawn
    }

    /// Draws a frame that may take over what the one before has found.
    pub fn check_next(
        &mut self,
        what: &str,
        camera: &Camera,
        clip: &Clip,
        settings: &Settings,
    ) -> u32 {
        let mut all = self.renderers.iter_mut().map(|(shape, renderer)| {
            let drawn = draw(renderer, camera, clip, settings);
            (*shape, drawn)
        });
        let (_, cpu) = all.next().expect("several");
        for (shape, gpu) in all {
            for ((name, ours), (_, theirs)) in cpu.buffers.iter().zip(&gpu.buffers) {
                assert!(ours == theirs, "{what}: {name} of {shape:?} differs");
            }
            assert_eq!(cpu.buffers.len(), gpu.buffers.len(), "{what}");
            let worst = apart(&cpu.picture, &gpu.picture);
            assert!(
                worst <= APART,
                "{what}: the picture of {shape:?} differs by {worst} of 255"
            );
        }
        cpu.counts.visible + cpu.counts.cutoff
    }

    /// Frees everything; the validation layer must have nothing to say.
    pub fn close(self) {
        for (shape, renderer) in self.renderers {
            let messages = renderer.device().validation_messages();
            assert_eq!(messages, Vec::<String>::new(), "{shape:?}");
        }
    }
}

/// The content of a buffer, of which so many bytes count.
fn read(renderer: &mut Headless, name: &str, bytes: usize) -> Vec<u8> {
    let content = renderer.working_buffer(name);
    let mut content = content.unwrap_or_else(|| panic!("there is no buffer {name}"));
    assert!(content.len() >= bytes, "{name}");
    content.truncate(bytes);
    content
}

/// A frame's constants and counts, and the buffers in which its keys and their order are.
fn constants(renderer: &mut Headless) -> (FrameData, FrameCounts, [&'static str; 2]) {
    let frame = read(renderer, "frame", size_of::<FrameData>());
    let frame: FrameData = bytemuck::pod_read_unaligned(&frame);
    let counts = read(renderer, "counts", size_of::<FrameCounts>());
    let span = frame.eye.order.key_span >> frame.eye.order.key_shift;
    let passes = (u32::BITS - span.leading_zeros())
        .div_ceil(SORT_BITS)
        .max(1);
    let sorted = [["keys", "order"], ["sorted_keys", "sorted_order"]][passes as usize % 2];
    (frame, bytemuck::pod_read_unaligned(&counts), sorted)
}

fn draw(renderer: &mut Headless, camera: &Camera, clip: &Clip, settings: &Settings) -> Drawn {
    renderer.render(camera, clip, settings).expect("renders");
    let picture = renderer.picture().expect("reads back");
    let shape = renderer.device().shape();
    let (frame, counts, [keys, order]) = constants(renderer);
    // Also those in view that a moved clip removes.
    let listed = counts.mesh_groups[3] as usize;
    let records = counts.cutoff as usize * frame.eye.weight.cut_stride as usize * 16;
    let mut wanted = vec![
        ("splat_gaussians", 4 * listed),
        ("cutoffs", 4 * counts.cutoff as usize),
        ("cut_records", records),
    ];
    let tiled = settings.raster == Raster::Tiles && frame.cut.scene.gaussian_count > 0;
    // Where tiles are wanted the keys' buffers are used for more once the order is known.
    wanted.push((order, 4 * listed));
    if tiled {
        let tiles = frame.eye.tiles.tile_count as usize;
        wanted.push(("tile_begins", 4 * (tiles + 1)));
        wanted.push(("tile_splats", 4 * counts.pairs as usize));
        assert_eq!(counts.has_room, 1, "there is room");
    } else {
        wanted.push((keys, 4 * listed));
        wanted.push(("quads", size_of::<rara::types::Quad>() * listed));
    }
    let mut buffers: Vec<_> = wanted
        .into_iter()
        .map(|(name, bytes)| (name, read(renderer, name, bytes)))
        .collect();
    let gaussians = frame.cut.scene.gaussian_count as usize;
    if gaussians > 0 {
        let vectors = match shape {
            DeviceShape::Cpu => 4 * gaussians,
            _ => 4 * gaussians + gaussians.div_ceil(4),
        };
        let splats = read(renderer, "splats", 16 * vectors);
        let splats: Vec<[f32; 4]> = bytemuck::pod_collect_to_vec(&splats);
        let splats = common::splats(&splats, gaussians, shape);
        buffers.push(("splats", bytemuck::cast_slice(&splats[..listed]).to_vec()));
    }
    let records = buffers.iter_mut().find(|(name, _)| *name == "cut_records");
    let stride = frame.eye.weight.cut_stride as usize * 16;
    if let Some((_, bytes)) = records.filter(|_| stride > 0) {
        bytes.chunks_mut(stride).for_each(clear_unused);
    }
    Drawn {
        counts,
        buffers,
        picture,
    }
}

/// Clears those of a record's vec4s that its kind does not use (glsl/cut.glsl), which hold whatever was there before.
fn clear_unused(record: &mut [u8]) {
    const HEADER: usize = 3;
    let flags: f32 = bytemuck::pod_read_unaligned(&record[12..16]);
    let flags = flags as usize;
    let [beam, front, curve] = [1, 2, 4].map(|flag| flags & flag != 0);
    for (place, part) in record.chunks_mut(16).enumerate() {
        let is_used = match (beam, curve) {
            (true, _) => place < HEADER + (flags >> 8) + usize::from(front),
            (false, true) => place <= HEADER,
            (false, false) => [0, HEADER, HEADER + 1].contains(&place),
        };
        if !is_used {
            part.fill(0);
        }
    }
}

/// Largest difference of a channel, of 255.
fn apart(a: &Picture, b: &Picture) -> f32 {
    let pairs = a.pixels.iter().flatten().zip(b.pixels.iter().flatten());
    255.0 * pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
}
