//! What a frame needs, decided on the CPU before anything is recorded: which stages run, and the frame's constants.

use ash::vk;
use glam::{DVec3, Vec3};

use crate::camera::Camera;
use crate::clip::{Clip, ClipOp, Plane};
use crate::error::{Error, Result};
use crate::limits;
use crate::passes::depth_keys::DepthKeys;
use crate::passes::occluders::Occluders;
use crate::passes::tiles::TileWork;
use crate::passes::work::Work;
use crate::precision::ShFormat;
use crate::settings::{Decay, ExactForm, Miss, Mode, Raster, Settings, Show};
use crate::types::{self, FrameData};

/// A frame, decided but not recorded.
#[derive(Debug, Clone)]
pub(crate) struct Plan {
    /// Gaussians in the scene.
    pub(crate) gaussians: u32,
    /// The mode, reduced to `MODE_NONE` where there is nothing to clip with.
    pub(crate) mode: u32,
    /// What of the frame has to be computed.
    pub(crate) work: Work,
    /// Whether cutoff Gaussians can exist.
    pub(crate) cutoff: bool,
    /// vec4s of a cutoff record.
    pub(crate) cut_stride: u32,
    /// How the scene's spherical harmonics are stored.
    pub(crate) sh_format: ShFormat,
    /// `DECAY_*`.
    pub(crate) decay: u32,
    /// `MISS_*`.
    pub(crate) miss: u32,
    /// `PHI_*`.
    pub(crate) phi: u32,
    /// Passes of the sort that the scene's bounds ask for, at least one.
    pub(crate) sort_passes: u32,
    /// Invocations of the sort.
    pub(crate) sort_runs: u32,
    /// How splats become pixels; never `Auto`.
    pub(crate) raster: Raster,
    pub(crate) tile_work: TileWork,
    /// What hides splats of tiles.
    pub(crate) occluders: Option<Occluders>,
    /// Whether the splats' depths are wanted.
    pub(crate) expects_depth: bool,
    /// Colours, or a debug view.
    pub(crate) show: Show,
    /// The frame's constants.
    pub(crate) data: FrameData,
}

/// What a plan is made from besides camera, clip and settings.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SceneFacts {
    pub(crate) gaussians: u32,
    pub(crate) sh_degree: u32,
    pub(crate) sh_format: ShFormat,
    /// The corners of the box around the centres.
    pub(crate) bounds: [Vec3; 2],
    pub(crate) sort_runs: u32,
    /// How splats become pixels; never `Auto`.
    pub(crate) raster: Raster,
    pub(crate) tile_work: TileWork,
    /// Pairs of tile and splat that there is to be room for.
    pub(crate) pair_capacity: u32,
    /// Whether a frame without room for its pairs is drawn once more, instead of as quads.
    pub(crate) redrawn: bool,
    /// What hides splats of tiles, if they are wanted.
    pub(crate) occluders: Option<Occluders>,
    /// Whether the splats' depths are wanted.
    pub(crate) expects_depth: bool,
}

impl Plan {
    /// Decides what a frame needs.
    pub(crate) fn new(
        scene: SceneFacts,
        camera: &Camera,
        clip: &Clip,
        settings: &Settings,
    ) -> Result<Self> {
        if clip.planes.len() > limits::MAX_CLIP_PLANES as usize {
            let (have, most) = (clip.planes.len(), limits::MAX_CLIP_PLANES);
            return Err(Error::Invalid(format!(
                "a clip of {have} half-spaces is beyond the {most} supported; use fewer"
            )));
        }
        if !(settings.sigma.is_finite() && settings.sigma > 0.0) {
            return Err(Error::Invalid(format!(
                "an ellipsoid of {} standard deviations cannot be traced",
                settings.sigma
            )));
        }
        let switch = settings.precision.beam_switch;
        if switch.is_nan() || switch < 0.0 {
            return Err(Error::Invalid(format!(
                "a beam switch of {switch} is not a size; give zero or more"
            )));
        }
        let saturated = settings.precision.transmittance_min;
        if !(0.0..1.0).contains(&saturated) {
            return Err(Error::Invalid(format!(
                "a least transmittance of {saturated} is not one; give zero or more, below 1"
            )));
        }
        let clipping = settings.mode != Mode::None && !clip.planes.is_empty();
        let mode = match settings.mode {
            Mode::Hard if clipping => types::MODE_HARD,
            Mode::Rara if clipping => types::MODE_RARA,
            Mode::Exact if clipping => types::MODE_EXACT,
            _ => types::MODE_NONE,
        };
        let planes = if clipping {
            distinct(&clip.planes)
        } else {
            Vec::new()
        };
        let cutoff = mode == types::MODE_RARA || mode == types::MODE_EXACT;
        // A header of three, the planes, and the eye's own plane where the camera may be inside a splat.
        let cut_stride = if cutoff {
            3 + planes.len() as u32 + 1
        } else {
            0
        };

        // Shaders count the records' elements in 32 bits.
        if u64::from(scene.gaussians) * u64::from(cut_stride) > u64::from(u32::MAX) {
            return Err(Error::Invalid(format!(
                "{} Gaussians cut by {} planes are beyond what a frame can address; use fewer planes or split the scene",
                scene.gaussians,
                planes.len()
            )));
        }

        let mut data: FrameData = bytemuck::Zeroable::zeroed();
        camera_constants(&mut data, camera);
        data.gaussian_count = scene.gaussians;
        data.sh_coefficients = (scene.sh_degree + 1) * (scene.sh_degree + 1);
        data.sh_degree = settings
            .sh_degree
            .map_or(scene.sh_degree, |cap| cap.min(scene.sh_degree));
        data.plane_count = planes.len() as u32;
        data.mode = mode;
        data.op = if clipping && clip.op == ClipOp::Or {
            types::OP_OR
        } else {
            types::OP_AND
        };
        data.form = match settings.form {
            ExactForm::Auto => types::FORM_AUTO,
            ExactForm::Beam => types::FORM_BEAM,
            ExactForm::Affine => types::FORM_AFFINE,
        };
        data.sigma = settings.sigma;
        data.transmittance_min = saturated;
        data.beam_switch = settings.precision.beam_switch;
        let keys = DepthKeys::new(scene.bounds, camera, settings.precision.key_bits)?;
        data.key_near = keys.near;
        data.key_span = keys.span;
        data.key_shift = keys.shift;
        data.trace_all = settings.trace_all.into();
        data.cut_stride = cut_stride;
        data.sort_runs = scene.sort_runs;
        data.tile_columns = camera.width.div_ceil(limits::TILE_WIDTH);
        data.tile_count = data.tile_columns * camera.height.div_ceil(limits::TILE_HEIGHT);
        // As many invocations as the sort has; whole workgroups a row, whose invocations then have as much to do as each other.
        let rows = data.tile_count / data.tile_columns;
        data.row_parts = (scene.sort_runs.div_ceil(rows)).next_multiple_of(limits::ROW_GROUP_SIZE);
        data.pair_capacity = scene.pair_capacity;
        data.block_count = scene.gaussians.div_ceil(limits::BLOCK_SIZE);
        data.redrawn = scene.redrawn.into();
        for (index, plane) in planes.iter().enumerate() {
            let (high, low) = two_float(plane.normal());
            // Farther away than single precision reaches: beyond every splat.
            let offset = plane.offset().clamp(-FARTHEST, FARTHEST);
            let offset_high = offset as f32;
            let offset_low = (offset - f64::from(offset_high)) as f32;
            data.plane_high[index] = [high[0], high[1], high[2], offset_high];
            data.plane_low[index] = [low[0], low[1], low[2], offset_low];
        }
        Ok(Self {
            gaussians: scene.gaussians,
            mode,
            work: Work::Whole {
                clip: mode != types::MODE_NONE,
            },
            cutoff,
            cut_stride,
            sh_format: scene.sh_format,
            decay: match settings.decay_law() {
                Decay::Linear => types::DECAY_LINEAR,
                Decay::Depth => types::DECAY_DEPTH,
            },
            miss: match settings.miss {
                Miss::Keep => types::MISS_KEEP,
                Miss::Drop => types::MISS_DROP,
                Miss::Peak => types::MISS_PEAK,
            },
            phi: settings.precision.phi.code(),
            sort_passes: keys.passes(),
            sort_runs: scene.sort_runs,
            raster: scene.raster,
            tile_work: scene.tile_work,
            occluders: scene
                .occluders
                .filter(|_| scene.raster == Raster::Tiles)
                .map(|occluders| Occluders {
                    size: vk::Extent2D {
                        width: camera.width,
                        height: camera.height,
                    },
                    ..occluders
                }),
            expects_depth: scene.expects_depth,
            show: settings.show,
            data,
        })
    }

    /// Which of the two pairs of key and order buffers holds the sorted ones: each pass carries them to the other.
    pub(crate) fn sorted(&self) -> usize {
        (self.sort_passes % 2) as usize
    }

    /// Whether splats become pixels by tiles.
    pub(crate) fn is_tiled(&self) -> bool {
        self.raster == Raster::Tiles
    }

    /// Whether the clip's classes have to be found, for blocks and Gaussians whether in view or not.
    pub(crate) fn finds_clip(&self) -> bool {
        self.work == Work::Whole { clip: true }
    }

    /// Whether it has to be found what is in view.
    pub(crate) fn finds_view(&self) -> bool {
        matches!(self.work, Work::Whole { .. } | Work::Sweep { base: true, .. })
    }

    /// Whether the clip moves over what is in view, clipped away or not.
    pub(crate) fn sweeps(&self) -> bool {
        matches!(self.work, Work::Sweep { .. })
    }

    /// Whether what is in view is found without what the clip removes.
    pub(crate) fn view_is_clipped(&self) -> bool {
        self.mode != types::MODE_NONE && !self.sweeps()
    }

    /// Whether what is in view is found with the cutoff records of what the clip cuts.
    pub(crate) fn view_is_cut(&self) -> bool {
        self.cutoff && !self.sweeps()
    }
}

fn camera_constants(data: &mut FrameData, camera: &Camera) {
    let rows = camera.rotation.transpose();
    let row = |axis: DVec3| {
        let ([x, y, z], [low_x, low_y, low_z]) = two_float(axis);
        ([x, y, z, 0.0], [low_x, low_y, low_z, 0.0])
    };
    (data.rotation_x, data.rotation_low[0]) = row(rows.x_axis);
    (data.rotation_y, data.rotation_low[1]) = row(rows.y_axis);
    (data.rotation_z, data.rotation_low[2]) = row(rows.z_axis);
    data.precise_view = (camera.fx.max(camera.fy) > f64::from(limits::PRECISE_FOCAL)).into();
    let (high, low) = two_float(camera.eye);
    data.eye_high = [high[0], high[1], high[2], 0.0];
    data.eye_low = [low[0], low[1], low[2], 0.0];
    data.focal = [camera.fx, camera.fy, camera.cx, camera.cy].map(|x| x as f32);
    let (width, height) = (f64::from(camera.width), f64::from(camera.height));
    let margin = f64::from(limits::CLAMP_MARGIN);
    let bounds = |size: f64, centre: f64, focal: f64| {
        (
            (-margin * size - centre) / focal,
            ((1.0 + margin) * size - centre) / focal,
        )
    };
    let (x_low, x_high) = bounds(width, camera.cx, camera.fx);
    let (y_low, y_high) = bounds(height, camera.cy, camera.fy);
    data.slope_bounds = [x_low, x_high, y_low, y_high].map(|x| x as f32);
    data.size = [width, height, 1.0 / width, 1.0 / height].map(|x| x as f32);
}

/// Largest offset of a plane that is told from infinity, world units: a power of two below the end of single
/// precision's range.
const FARTHEST: f64 = (1_u128 << 126) as f64;

/// The planes without repetitions, since cutting twice is cutting once, and in an order of their own: to the bit no
/// picture depends on the order in which planes are given.
fn distinct(planes: &[Plane]) -> Vec<Plane> {
    let key = |plane: &Plane| {
        let [x, y, z] = plane.normal().to_array();
        [x, y, z, plane.offset()]
    };
    let mut planes = planes.to_vec();
    planes.sort_by(|a, b| {
        let pairs = key(a).into_iter().zip(key(b));
        pairs.fold(std::cmp::Ordering::Equal, |order, (a, b)| {
            order.then((a + 0.0).total_cmp(&(b + 0.0))) // -0 is 0
        })
    });
    planes.dedup();
    planes
}

/// A vector as the sum of two single-precision ones.
fn two_float(v: DVec3) -> ([f32; 3], [f32; 3]) {
    let high = v.as_vec3();
    (high.into(), (v - high.as_dvec3()).as_vec3().into())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::passes::project;
    use crate::passes::weight::Weight;

    fn plan(mode: Mode, planes: usize) -> Plan {
        let facts = SceneFacts {
            gaussians: 1000,
            sh_degree: 0,
            sh_format: ShFormat::Float,
            bounds: [Vec3::NEG_ONE, Vec3::ONE],
            sort_runs: 128,
            raster: Raster::Tiles,
            tile_work: TileWork::suiting(true, 8),
            pair_capacity: 1000,
            redrawn: false,
            occluders: None,
            expects_depth: false,
        };
        let eye = DVec3::new(0.0, 0.0, -4.0);
        let camera = Camera::look_at(eye, DVec3::ZERO, -DVec3::Y, 50.0, (64, 64));
        let plane = Plane::new(DVec3::X, 0.0).expect("a finite normal");
        let clip = Clip {
            planes: vec![plane; planes],
            op: ClipOp::And,
        };
        let settings = Settings {
            mode,
            ..Settings::default()
        };
        Plan::new(facts, &camera.expect("a view"), &clip, &settings).expect("a plan")
    }

    #[test]
    fn without_planes_every_mode_is_none_to_the_pipeline_and_the_byte() {
        let none = plan(Mode::None, 0);
        assert_eq!(none.skipped(), ["clip", "cutoff"]);
        for (mode, planes) in [
            (Mode::None, 2),
            (Mode::Hard, 0),
            (Mode::Rara, 0),
            (Mode::Exact, 0),
        ] {
            let plan = plan(mode, planes);
            assert_eq!(plan.work, none.work);
            assert_eq!(
                plan.mode, none.mode,
                "the blocks' and the classes' pipeline"
            );
            assert_eq!(Weight::of(&plan), Weight::of(&none));
            assert_eq!(project::kernel(&plan), project::kernel(&none));
            assert_eq!((plan.cutoff, plan.cut_stride), (false, 0), "no record");
            let bytes = |plan: &Plan| bytemuck::bytes_of(&plan.data).to_vec();
            assert!(bytes(&plan) == bytes(&none), "{mode:?}");
        }
    }

    #[test]
    fn a_hard_clip_needs_no_records_and_no_weights() {
        let (none, hard) = (plan(Mode::None, 0), plan(Mode::Hard, 1));
        assert_eq!(hard.skipped(), ["cutoff"]);
        assert_eq!(Weight::of(&hard), Weight::of(&none));
        assert_eq!(ProjectKey::new(&hard), ProjectKey::new(&none));
    }
}
