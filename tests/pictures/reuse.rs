//! A frame takes over from the one before only what it would have computed: the bytes are the same, and it says which
//! stages it skipped.

use crate::common;
use glam::DVec3;
use rara::gpu::Bindings;
use rara::{
    Camera, Clip, ClipOp, Decay, ExactForm, Gaussians, Headless, Miss, Mode, PhiForm, Picture,
    Plane, Raster, Settings, Show, TargetFormat,
};

const SIZE: (u32, u32) = (250, 190);
/// All that comes before the pixels.
const VIEW: [&str; 5] = ["blocks", "classify", "compact", "project", "sort"];

/// Two renderers on one device with one scene: one keeps what it can, the other forgets everything.
struct Pair {
    keeps: Headless,
    forgets: Headless,
}

impl Pair {
    fn new(scene: &Gaussians) -> Self {
        Self::by(Bindings::Mixed, scene)
    }

    fn by(bindings: Bindings, scene: &Gaussians) -> Self {
        let keeps = common::headless_by(bindings);
        let forgets = keeps.sharing().expect("another renderer");
        let mut pair = Self { keeps, forgets };
        pair.load(scene);
        pair
    }

    fn load(&mut self, scene: &Gaussians) {
        for headless in [&mut self.keeps, &mut self.forgets] {
            headless.load(scene).expect("uploads");
        }
    }

    /// Draws frames one after the other, each as [`draw`](Self::draw) does, after one that leaves nothing to the first;
    /// returns their pictures.
    fn walk<const N: usize>(&mut self, frames: [(Camera, Clip, Settings); N]) -> [Picture; N] {
        self.keeps.forget();
        frames.map(|(camera, clip, settings)| {
            self.draw(&camera, &clip, &settings);
            self.forgets.picture().expect("reads back")
        })
    }

    /// Draws a frame with both and compares the pictures and counts; returns what the first one skipped.
    fn draw(&mut self, camera: &Camera, clip: &Clip, settings: &Settings) -> Vec<&'static str> {
        self.forgets.forget();
        let picture = |headless: &mut Headless| {
            let stats = headless.render(camera, clip, settings).expect("renders");
            (headless.picture().expect("reads back"), stats)
        };
        let (kept, stats) = picture(&mut self.keeps);
        let (whole, truth) = picture(&mut self.forgets);
        assert_eq!(stats.counts, truth.counts, "{settings:?} {clip:?}");
        let apart = kept
            .pixels
            .iter()
            .zip(&whole.pixels)
            .enumerate()
            .filter(|(_, (a, b))| a.map(f32::to_bits) != b.map(f32::to_bits));
        let apart: Vec<_> = apart.collect();
        assert!(
            apart.is_empty(),
            "{} pixels differ, the first {:?}: {settings:?} {clip:?}, skipped {:?}",
            apart.len(),
            apart[0],
            stats.skipped
        );
        for pass in &stats.passes {
            assert!(!stats.skipped.contains(&pass.name), "{}", pass.name);
        }
        stats.skipped
    }
}

/// A plane across the scene at a share of its extent.
fn plane(scene: &Gaussians, normal: DVec3, share: f64) -> Plane {
    let (low, high) = rara::scene::extent_along(scene, normal);
    Plane::new(normal, -(low + share * (high - low))).expect("a finite normal")
}

/// The same plane, moved.
fn nudged(plane: &Plane, by: f64) -> Plane {
    Plane::new(plane.normal(), plane.offset() + by).expect("a finite normal")
}

fn cut(scene: &Gaussians, normal: DVec3, share: f64) -> Clip {
    Clip::of([plane(scene, normal, share)], ClipOp::And)
}

#[test]
fn a_sweep_computes_the_view_once() {
    let mut scenes = common::generated_scenes(6_000);
    scenes.extend(common::trained_scenes());
    let mut pair = Pair::new(&scenes[0].1);
    for (index, (name, scene)) in scenes.into_iter().enumerate() {
        pair.load(&scene);
        let camera = common::views(&scene, 3, common::scaled(SIZE))[1];
        let normal = DVec3::new(0.8, 0.3, 0.5).normalize();
        let (rasters, modes) = (
            common::rasters(pair.keeps.device()),
            [Mode::Exact, Mode::Rara, Mode::Hard],
        );
        // The first scene gets all combinations, unless the driver is slow, and the others a part of them.
        let all = index == 0 && common::scale() == 1.0;
        for (r, raster) in rasters.into_iter().enumerate() {
            for (m, mode) in modes.into_iter().enumerate() {
                if !all && (r, m) != (index % 2, index % 3) && (r, m) != (0, 0) {
                    continue;
                }
                let settings = Settings::default().mode(mode).raster(raster);
                pair.keeps.forget();
                for (step, share) in [0.1, 0.35, 0.4, 0.9, 0.5, 0.45].into_iter().enumerate() {
                    let skipped = pair.draw(&camera, &cut(&scene, normal, share), &settings);
                    let is_kept = VIEW.iter().all(|stage| skipped.contains(stage));
                    assert_eq!(is_kept, step > 1, "{name}, step {step}: {skipped:?}");
                    assert_eq!(skipped.contains(&"clip"), step > 0, "{skipped:?}");
                }
            }
        }
    }
}

#[test]
fn a_frame_like_the_one_before_does_nothing_and_another_background_only_draws() {
    let (_, scene) = common::generated_scenes(3_000).remove(0);
    let mut pair = Pair::new(&scene);
    let camera = common::views(&scene, 3, SIZE)[0];
    let clip = cut(&scene, DVec3::X, 0.5);
    for raster in common::rasters(pair.keeps.device()) {
        let settings = Settings::default().raster(raster);
        assert!(!pair.draw(&camera, &clip, &settings).contains(&"project"));
        let skipped = pair.draw(&camera, &clip, &settings);
        assert!(VIEW.iter().all(|stage| skipped.contains(stage)));
        assert!(skipped.contains(&"splat") && skipped.contains(&"cutoff"));
        let red = settings.background(Some([0.5, 0.0, 0.0]));
        let skipped = pair.draw(&camera, &clip, &red);
        assert!(VIEW.iter().all(|stage| skipped.contains(stage)));
        assert!(!skipped.contains(&"splat"));
    }
}

#[test]
fn a_camera_that_moves_keeps_the_clips_classes() {
    let (_, scene) = common::generated_scenes(6_000).remove(0);
    let mut pair = Pair::new(&scene);
    let clip = cut(&scene, DVec3::new(0.5, 0.1, -0.7).normalize(), 0.4);
    for (step, camera) in common::views(&scene, 4, SIZE).iter().enumerate() {
        let skipped = pair.draw(camera, &clip, &Settings::default());
        assert_eq!(skipped.contains(&"clip"), step > 0, "{skipped:?}");
        assert!(!skipped.contains(&"project"));
    }
}

/// A frame of a walk: each differs from the one before in one thing, mostly in where the clip is. Now and then the settings
/// are the usual ones again: a walk that never comes back compiles another shader with each setting that it changes, while
/// what a frame may take over is asked of each by itself.
#[derive(Clone)]
struct Frame {
    settings: Settings,
    size: (u32, u32),
    camera: usize,
    share: f64,
    nudge: f64,
    planes: usize,
    op: ClipOp,
}

impl Frame {
    fn step(&mut self, rasters: &[Raster], pick: &mut impl FnMut(usize) -> usize) {
        let settings = &mut self.settings;
        match pick(42) {
            0 => self.camera = pick(3),
            1 => self.size = common::scaled([SIZE, (97, 301), (8, 8)][pick(3)]),
            2 => settings.mode = [Mode::None, Mode::Hard, Mode::Rara, Mode::Exact][pick(4)],
            3 => settings.raster = rasters[pick(rasters.len())],
            4 => settings.decay = [None, Some(Decay::Linear), Some(Decay::Depth)][pick(3)],
            5 => {
                settings.form = [ExactForm::Auto, ExactForm::Beam, ExactForm::Affine][pick(3)];
            }
            6 => {
                let formats = [
                    TargetFormat::Unorm8,
                    TargetFormat::Half,
                    TargetFormat::Float,
                ];
                settings.precision.target = formats[pick(3)];
            }
            7 => self.planes = 1 + pick(2),
            8 => settings.trace_all = pick(3) == 0,
            9 => self.op = [ClipOp::And, ClipOp::Or][pick(2)],
            10 => settings.sigma = [1.0, 3.0, 5.0][pick(3)],
            11 => settings.miss = [Miss::Keep, Miss::Drop, Miss::Peak][pick(3)],
            12 => settings.show = [Show::Colour, Show::Weight][pick(2)],
            13 => settings.precision.beam_switch = [0.0, 0.005, 0.05][pick(3)],
            14 => settings.precision.transmittance_min = [0.0, 4e-6, 0.3][pick(3)],
            15 => settings.sh_degree = [None, Some(0), Some(2)][pick(3)],
            // A change below single precision: only the planes' low words differ.
            16 => self.nudge = [0.0, 1e-9, -1e-9][pick(3)],
            17..=20 => *settings = Settings::default(),
            _ => self.share = [0.2, 0.4, 0.5, 0.55, 0.8][pick(5)],
        }
    }
}

#[test]
fn whatever_changes_the_bytes_are_those_of_a_whole_frame() {
    let mut pick = common::picker(11);
    let normals = [DVec3::X, DVec3::new(0.1, 0.9, -0.3).normalize()];
    let steps = (80.0 * common::scale()) as usize;
    let scenes = common::generated_scenes(4_000);
    let device = common::headless();
    for bindings in common::bindings(device.device()) {
        let mut pair = Pair::by(bindings, &scenes[0].1);
        let rasters = common::rasters(pair.keeps.device());
        // What is taken over depends on the kind of scene; how buffers are reached is another matter, for which one does.
        let count = if bindings == Bindings::Mixed { 3 } else { 1 };
        for (_, scene) in &scenes[..count] {
            pair.load(scene);
            let mut frame = Frame {
                settings: Settings::default(),
                size: common::scaled(SIZE),
                camera: 0,
                share: 0.5,
                nudge: 0.0,
                planes: 1,
                op: ClipOp::And,
            };
            let mut sweeps = 0;
            for _ in 0..steps {
                frame.step(&rasters, &mut pick);
                let mut cameras = common::views(scene, 3, frame.size);
                // A view from inside the scene, where splats are large, beside the picture and behind the eye.
                cameras[2].eye = rara::scene::Bounds::of(scene).centre();
                let clip = Clip::of(
                    normals[..frame.planes]
                        .iter()
                        .map(|&normal| nudged(&plane(scene, normal, frame.share), frame.nudge)),
                    frame.op,
                );
                let skipped = pair.draw(&cameras[frame.camera], &clip, &frame.settings);
                // Where the tiles' picture is the picture, a frame that computes something has no draw either.
                let has_quads = matches!(frame.settings.raster, Raster::Quad | Raster::Mesh);
                let is_new =
                    !skipped.contains(&"splat") || !(has_quads || skipped.contains(&"tiles"));
                sweeps += usize::from(skipped.contains(&"project") && is_new);
            }
            assert!(
                sweeps > steps / 6,
                "only {sweeps} frames were those of a sweep"
            );
        }
    }
}

/// The name of one thing that changes, and the settings of the two frames, before and after.
type Change = (&'static str, Settings, Settings);

/// All changes that leave the camera and the clip's place alone, each by itself; by tiles, on which more depends.
fn changes() -> Vec<Change> {
    let usual = Settings::default().raster(Raster::Tiles);
    let traced = usual.mode(Mode::Rara);
    let coarse = usual.precision(usual.precision.key_bits(16));
    let changed = |name, before: Settings, change: fn(&mut Settings)| {
        let mut after = before;
        change(&mut after);
        (name, before, after)
    };
    vec![
        changed("sigma", traced, |s| s.sigma = 5.0),
        changed("miss", traced, |s| s.miss = Miss::Keep),
        changed("mode", traced, |s| s.mode = Mode::Hard),
        changed("trace_all", usual, |s| s.trace_all = true),
        changed("decay", usual, |s| s.decay = Some(Decay::Linear)),
        changed("form", usual, |s| s.form = ExactForm::Affine),
        changed("show", usual, |s| s.show = Show::Weight),
        changed("beam_switch", usual, |s| s.precision.beam_switch = 0.0),
        changed("phi", usual, |s| s.precision.phi = PhiForm::Logistic),
        changed("transmittance_min", usual, |s| {
            s.precision.transmittance_min = 0.3;
        }),
        changed("sh_degree", usual, |s| s.sh_degree = Some(0)),
        changed("key_bits", usual, |s| s.precision.key_bits = 8),
        changed("key_bits of as many passes", coarse, |s| {
            s.precision.key_bits = 12;
        }),
    ]
}

/// Each change by itself, under a camera that stands still and then moves; there and back.
#[test]
fn each_setting_alone_changes_what_it_should() {
    let (_, scene) = common::generated_scenes(2_000).remove(0);
    let mut pair = Pair::new(&scene);
    let cameras = common::views(&scene, 3, common::scaled((125, 95)));
    let normal = DVec3::new(0.8, 0.3, 0.5).normalize();
    let clips = [0.4, 0.45].map(|share| cut(&scene, normal, share));
    for (name, before, after) in changes() {
        // The second frame begins a sweep: the third may take over more than after a whole frame, and so may the fourth.
        let steps = [
            (0, 0, before),
            (0, 1, before),
            (0, 1, after),
            (1, 1, after),
            (1, 1, before),
            (2, 1, after),
        ];
        let shown = pair.walk(
            steps.map(|(camera, clip, settings)| (cameras[camera], clips[clip].clone(), settings)),
        );
        assert!(shown[1] != shown[2], "{name} changes nothing");
        assert!(shown[3] != shown[4], "{name} changes nothing");
    }
}

/// The same for a clip of which only the planes' low words change: a million units from the origin single precision knows
/// an offset to a sixteenth, and so it does the centres, which lie in sheets there.
#[test]
fn a_planes_low_word_alone_changes_what_it_should() {
    let (_, mut scene) = common::generated_scenes(2_000).remove(0);
    for position in scene.positions_mut() {
        position.x += 1e6;
    }
    let mut pair = Pair::new(&scene);
    let cameras = common::views(&scene, 3, common::scaled((125, 95)));
    let mut sheets: Vec<f32> = scene
        .positions()
        .iter()
        .map(|position| position.x)
        .collect();
    sheets.sort_unstable_by(f32::total_cmp);
    let sheet = f64::from(sheets[sheets.len() / 2]);
    let clips = [0.01, -0.01].map(|beside| {
        let plane = Plane::new(DVec3::X, beside - sheet).expect("a finite normal");
        assert_eq!(f64::from(plane.offset() as f32), -sheet, "the high word");
        Clip::of([plane], ClipOp::And)
    });
    for (raster, mode) in [(Raster::Tiles, Mode::Hard), (Raster::Quad, Mode::Exact)] {
        let settings = Settings::default().mode(mode).raster(raster);
        let steps = [(0, 0), (0, 1), (1, 1), (1, 0), (2, 1)];
        let frame =
            |(camera, clip): (usize, usize)| (cameras[camera], clips[clip].clone(), settings);
        let shown = pair.walk(steps.map(frame));
        assert!(shown[0] != shown[1] && shown[2] != shown[3], "{mode:?}");
    }
}

/// A camera that stands still goes on with the tiles' picture, also where quads have been drawn since tiles first were.
#[test]
fn what_quads_leave_between_is_not_taken_for_the_tiles_picture() {
    let (_, scene) = common::generated_scenes(2_000).remove(0);
    let camera = common::views(&scene, 3, common::scaled((125, 95)))[1];
    let clip = cut(&scene, DVec3::new(0.8, 0.3, 0.5).normalize(), 0.45);
    let frames = [
        (Mode::None, Raster::Tiles),
        (Mode::None, Raster::Quad),
        (Mode::None, Raster::Tiles),
        (Mode::Hard, Raster::Tiles),
    ];
    let frame = |(mode, raster)| {
        let settings = Settings::default().mode(mode).raster(raster);
        (camera, clip.clone(), settings)
    };
    Pair::new(&scene).walk(frames.map(frame));
}

#[test]
fn another_scene_is_not_taken_for_the_one_before() {
    let mut scenes = common::generated_scenes(2_000).into_iter();
    let (first, second) = (
        scenes.next().expect("some").1,
        scenes.next().expect("two").1,
    );
    let mut pair = Pair::new(&first);
    let camera = common::views(&first, 3, SIZE)[0];
    let settings = Settings::default();
    pair.draw(&camera, &Clip::default(), &settings);
    pair.load(&second);
    let skipped = pair.draw(&camera, &Clip::default(), &settings);
    assert!(!skipped.contains(&"project"));
}
