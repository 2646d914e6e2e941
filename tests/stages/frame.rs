//! A frame whose stages are examined: the scene as it lies on the device, and what the stages have written.

use glam::{DVec3, Quat, Vec3};
use rara::gpu::{Bindings, DeviceShape};
use rara::scene::{Bounds, Kind, generate};
use rara::types::{FrameCounts, FrameData, Gaussian, MODE_RARA, NOT_CUT, Quad, Splat};
use rara::{Camera, Clip, ClipOp, FrameStats, Gaussians, Headless, Plane, Settings, ShFormat};

use crate::common;

/// No Gaussian, one, numbers around a workgroup and a block, and enough for every path.
const SIZES: [usize; 6] = [0, 1, 255, 256, 257, 50_000];
/// Not a multiple of a tile.
pub const SIZE: (u32, u32) = (253, 190);

/// A renderer and its scene.
pub struct Stages {
    pub headless: Headless,
    /// In the device's order.
    pub scene: Gaussians,
    /// The numbers of its Gaussians in the scene.
    pub numbers: Vec<u32>,
}

/// Every test of a stage ends without messages of the validation layer, of whatever it has drawn and read back.
impl Drop for Stages {
    fn drop(&mut self) {
        if !std::thread::panicking() {
            let messages = self.headless.device().validation_messages();
            assert_eq!(messages, Vec::<String>::new());
        }
    }
}

impl Stages {
    pub fn new() -> Self {
        Self {
            headless: common::headless_by(Bindings::Mixed),
            scene: Gaussians::default(),
            numbers: Vec::new(),
        }
    }

    pub fn load(&mut self, scene: &Gaussians) {
        self.load_as(scene, ShFormat::Float);
    }

    pub fn load_as(&mut self, scene: &Gaussians, format: ShFormat) {
        self.headless.load_as(scene, format).expect("uploads");
        let there: Vec<Gaussian> = self.read("gaussians");
        let numbers = there.iter().take(scene.len());
        self.numbers = numbers.map(|one| one.scale[3].to_bits()).collect();
        let mut once = self.numbers.clone();
        once.sort_unstable();
        assert!(once.into_iter().eq(0..scene.len() as u32), "each once");
        let indices = self.numbers.iter().map(|&number| number as usize);
        self.scene = common::picked(scene, indices);
    }

    /// Draws a whole frame.
    pub fn draw(&mut self, camera: &Camera, clip: &Clip, settings: &Settings) -> FrameStats {
        self.headless.forget();
        self.again(camera, clip, settings)
    }

    /// Draws a frame that may take over what the one before has found.
    pub fn again(&mut self, camera: &Camera, clip: &Clip, settings: &Settings) -> FrameStats {
        let drawn = self.headless.render(camera, clip, settings);
        drawn.expect("renders")
    }

    /// The content of a buffer.
    pub fn read<T: bytemuck::AnyBitPattern>(&mut self, name: &str) -> Vec<T> {
        let bytes = self.headless.working_buffer(name);
        let bytes = bytes.unwrap_or_else(|| panic!("there is no buffer {name}"));
        let elements = bytes.chunks_exact(size_of::<T>());
        elements.map(bytemuck::pod_read_unaligned).collect()
    }

    /// True where the pipelines are those for CPU drivers.
    pub fn is_cpus(&self) -> bool {
        self.headless.device().shape() == DeviceShape::Cpu
    }

    pub fn counts(&mut self) -> FrameCounts {
        self.read("counts")[0]
    }

    /// The indices of the splats, and their numbers among the cut ones.
    pub fn splat_gaussians(&mut self) -> Vec<[u32; 2]> {
        let counts = self.counts();
        let frame: FrameData = self.read("frame")[0];
        let count = (counts.visible + counts.cutoff) as usize;
        let splat_gaussians: Vec<u32> = self.read("splat_gaussians");
        let cuts = &splat_gaussians[frame.cut.scene.gaussian_count as usize..];
        // Only frames that may cut any say which are cut.
        let may_cut = frame.cut.region.mode >= MODE_RARA;
        let cut = |i: usize| if may_cut { cuts[i] } else { NOT_CUT };
        (0..count).map(|i| [splat_gaussians[i], cut(i)]).collect()
    }

    /// The indices of the splats after a reclipped frame, which are all in view, clipped away or not.
    pub fn gaussians_in_view(&mut self) -> Vec<u32> {
        let in_view = self.counts().mesh_groups[3] as usize;
        let mut splat_gaussians = self.read("splat_gaussians");
        splat_gaussians.truncate(in_view);
        splat_gaussians
    }

    pub fn splats_in_view(&mut self, count: usize) -> Vec<Splat> {
        let frame: FrameData = self.read("frame")[0];
        let splats = self.read::<[f32; 4]>("splats");
        let gaussians = frame.cut.scene.gaussian_count as usize;
        let mut splats = common::splats(&splats, gaussians, self.headless.device().shape());
        splats.truncate(count);
        splats
    }

    pub fn splats(&mut self) -> Vec<Splat> {
        let count = self.splat_gaussians().len();
        self.splats_in_view(count)
    }

    /// What a frame draws the first so many splats with, unless tiles surely draw it.
    pub fn quads(&mut self, count: usize) -> Vec<Quad> {
        let mut quads = self.read("quads");
        quads.truncate(count);
        quads
    }

    /// The numbers of the splats in the scene.
    pub fn numbers_in_view(&mut self, count: usize) -> Vec<u32> {
        let gaussians: Vec<Gaussian> = self.read("gaussians");
        let splat_gaussians: Vec<u32> = self.read("splat_gaussians");
        let number = |index: &u32| gaussians[*index as usize].scale[3].to_bits();
        splat_gaussians[..count].iter().map(number).collect()
    }
}

/// A generated scene with splats of which such scenes have too few: faint ones, ones around the limit of 1/255, and ones
/// without thickness.
pub fn scene(count: usize) -> Gaussians {
    let mut scene = generate(Kind::General, count, 1);
    for index in 0..count {
        match index % 23 {
            3 => scene.opacities_mut()[index] = (index % 9) as f32 / 1000.0,
            7 => scene.opacities_mut()[index] *= 0.05,
            11 => scene.scales_mut()[index].x = 0.0,
            _ => {}
        }
    }
    scene
}

/// Such scenes of every size that a stage is tested with.
pub fn scenes() -> impl Iterator<Item = Gaussians> {
    let [few @ .., many] = SIZES;
    let many = (many as f64 * common::scale()) as usize;
    few.into_iter().chain([many]).map(scene)
}

/// Runs a test with each of these scenes, which is loaded.
pub fn for_each_scene(mut test: impl FnMut(&mut Stages, &Gaussians)) {
    let mut stages = Stages::new();
    for scene in scenes() {
        stages.load(&scene);
        test(&mut stages, &scene);
    }
}

/// A view from outside, one from within the scene, where splats are large, beside the picture and behind the eye, and an
/// orthographic one from there.
pub fn views(scene: &Gaussians) -> [Camera; 3] {
    let outside = if scene.is_empty() {
        let eye = DVec3::new(0.0, 1.0, -4.0);
        Camera::look_at(eye, DVec3::ZERO, -DVec3::Y, 50.0, SIZE).expect("a view")
    } else {
        common::views(scene, 3, SIZE)[0]
    };
    let mut within = outside;
    within.eye = 0.7 * Bounds::of(scene).centre() + 0.3 * outside.eye;
    if !within.eye.is_finite() {
        within = outside;
    }
    [outside, within, common::flattened(&within, scene)]
}

/// Oblique planes through the middle of a scene, in the order in which the renderer has them.
pub fn clip(scene: &Gaussians, count: usize, op: ClipOp) -> Clip {
    let centre = match Bounds::of(scene).centre() {
        centre if centre.is_finite() => centre,
        _ => DVec3::ZERO,
    };
    let normals = [
        DVec3::new(-0.8, 0.1, 0.7),
        DVec3::new(0.1, -0.9, 0.3),
        DVec3::new(0.9, 0.3, 0.2),
    ];
    let planes = normals
        .iter()
        .take(count)
        .map(|normal| Plane::new(*normal, -normal.dot(centre)).expect("a proper plane"));
    Clip::of(planes, op)
}

/// One Gaussian of degree 0.
pub fn one(position: Vec3, scale: Vec3, rotation: Quat, opacity: f32) -> Gaussians {
    let mut one = Gaussians::default();
    one.push(position, scale, rotation, opacity, &[1.0, 0.5, 0.25]);
    one
}
