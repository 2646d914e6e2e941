//! The plan of an eye that sees a cut, made on the CPU before anything is recorded: which stages run, and its constants.

use std::sync::Arc;

use ash::vk;

use crate::passes::bin::lists;
use crate::passes::cut_plan::{CutPlan, SceneFacts};
use crate::passes::depth_keys::DepthKeys;
use crate::passes::laws::Laws;
use crate::passes::layers;
use crate::passes::occluders::Occluders;
use crate::passes::scene_layer::SceneLayer;
use crate::passes::splat_colours::SplatColours;
use crate::passes::tile_picture::TilePixels;
use crate::passes::tile_work::TileWork;
use crate::passes::view::view_data;
use crate::passes::work::Work;
use crate::types::{self, EyeData, LayerView, OrderData, RoomData, TilesData, WeightData};
use rara_base::counted::counted;
use rara_base::error::{Error, Result};
use rara_base::limits;
use rara_gpu::{DeviceShape, Location};
use rara_scene::SortBy;
use rara_scene::camera::Camera;
use rara_scene::precision::ShFormat;
use rara_scene::settings::{ExactForm, Raster, Settings, Show};

/// A frame of an eye, decided but not recorded.
#[derive(Debug, Clone)]
pub(crate) struct EyePlan {
    /// What the eye sees.
    pub(crate) cut: CutPlan,
    pub(crate) work: Work,
    /// The stages and their variants that it takes.
    pub(crate) way: Way,
    /// How cut splats are weighted, besides what the constants say.
    pub(crate) laws: Laws,
    pub(crate) tile_work: TileWork,
    /// True when a draw makes the picture, of splats or of the tiles' picture. Else the tiles' picture is the picture.
    pub(crate) is_drawn: bool,
    /// The depth that hides splats of tiles.
    pub(crate) occluders: Option<Occluders>,
    /// True when the Gaussians lie in another order than that of their numbers, by which those of one depth are sorted.
    pub(crate) reordered: bool,
    /// The eye's own constants.
    pub(crate) data: EyeData,
    /// Where each layer has the eye.
    pub(crate) views: Arc<[LayerView]>,
}

/// The stages and their variants that a frame takes. They decide what kinds of things it leaves in which buffers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Way {
    /// How splats become pixels; never `Auto`.
    pub(crate) raster: Raster,
    pub(crate) sh_format: ShFormat,
    /// Passes of the sort that the scene's bounds ask for, at least one.
    pub(crate) sort_passes: u32,
    /// True when the pixels' expected depths are wanted.
    pub(crate) expects_depth: bool,
    /// True when depths for the host's depth buffer are.
    pub(crate) writes_depth: bool,
    /// True when the pixels' motion is.
    pub(crate) draws_motion: bool,
    /// Colours, or a debug view.
    pub(crate) show: Show,
    pub(crate) colours: SplatColours,
    pub(crate) tile_pixels: TilePixels,
}

/// The arguments of an eye's plan besides scene, cut, camera and settings.
#[derive(Debug, Clone, Copy)]
pub(crate) struct EyeFacts<'a> {
    /// Invocations of the sort by runs, or 0 for that by partitions.
    pub(crate) sort_runs: u32,
    /// Invocations of the steps that find the splats' spans of tiles, or 0 for the bin by macro-tiles.
    pub(crate) span_runs: u32,
    /// How splats become pixels; never `Auto`.
    pub(crate) raster: Raster,
    pub(crate) tile_work: TileWork,
    /// The pixels with which the tiles' picture is the picture; `None` where that is drawn.
    pub(crate) picture: Option<TilePixels>,
    /// The number of pairs of tile and splat that have room.
    pub(crate) pair_capacity: u32,
    /// The depth that hides splats of tiles, if they are wanted.
    pub(crate) occluders: Option<Occluders>,
    /// True when the pixels' expected depths are wanted.
    pub(crate) expects_depth: bool,
    /// The alpha of the pixels whose depths are written into the host's depth buffer, if any are.
    pub(crate) write_alpha: Option<f32>,
    /// True when the pixels' motion is wanted.
    pub(crate) draws_motion: bool,
    /// The camera of whose picture the frame shows a part; `None` where it shows all of it.
    pub(crate) whole: Option<&'a Camera>,
    pub(crate) colours: SplatColours,
}

impl EyePlan {
    /// Decides what a frame needs that shows a cut of a scene to a camera in the scene's space.
    pub(crate) fn new(
        scene: SceneFacts<'_>,
        cut: CutPlan,
        eye: EyeFacts<'_>,
        camera: &Camera,
        settings: &Settings,
    ) -> Result<Self> {
        camera.check_near_cut()?;
        // The laws take Phi; the target and the scene have formats of their own.
        let (_target, _sh, _phi, key_bits, beam_switch, transmittance_min) =
            settings.precision.fields();
        if !(0.0..1.0).contains(&transmittance_min) {
            return Err(Error::Invalid(format!(
                "the least transmittance is {transmittance_min}; it must be 0 or more, and below 1"
            )));
        }
        let filled = || scene.layers.iter().filter(|layer| layer.gaussians() > 0);
        let alphas = filled().map(|layer| layer.training().alpha_max);
        let alpha_max = alphas.fold(1.0, f32::min);
        let trained = filled().filter(|layer| layer.is_visible());
        let order = settings.order_of(camera, trained.map(SceneLayer::training));
        let keys = DepthKeys::new(layers::boxes(scene.layers, camera), key_bits, order)?;
        let degree = settings.sh_degree.unwrap_or(scene.sh_degree);
        let size = vk::Extent2D {
            width: camera.width,
            height: camera.height,
        };
        let is_tiled = eye.raster == Raster::Tiles;
        let occluders = eye.occluders.filter(|_| is_tiled);
        let write_alpha = eye.write_alpha.filter(|_| is_tiled);
        let tiles = tiles_data(size, eye.span_runs);
        Ok(Self {
            work: Work::Whole,
            way: Way {
                raster: eye.raster,
                sh_format: scene.sh_format,
                sort_passes: keys.passes(),
                expects_depth: eye.expects_depth,
                writes_depth: write_alpha.is_some(),
                draws_motion: eye.draws_motion && is_tiled,
                show: settings.show,
                colours: match settings.show {
                    Show::Strongest => SplatColours::Numbers,
                    Show::Colour | Show::Weight | Show::Count | Show::Mean => eye.colours,
                },
                tile_pixels: eye.picture.unwrap_or_default(),
            },
            laws: Laws::from_settings(settings),
            tile_work: eye.tile_work,
            is_drawn: eye.picture.is_none(),
            occluders: occluders.map(|occluders| Occluders { size, ..occluders }),
            reordered: scene.reordered,
            data: EyeData {
                view: view_data(
                    camera,
                    eye.whole.unwrap_or(camera),
                    keys.deepest,
                    degree.min(scene.sh_degree),
                ),
                order: OrderData {
                    key_near: keys.near,
                    key_span: keys.span,
                    key_shift: keys.shift,
                    sort_runs: eye.sort_runs,
                    by_distance: (order == SortBy::Distance).into(),
                    pad: [0; 3],
                },
                tiles: TilesData {
                    transmittance_min,
                    alpha_max,
                    // Pixels that are saturated do not fall any further.
                    written_transmittance: write_alpha
                        .map_or(-1.0, |alpha| (1.0 - alpha).max(transmittance_min)),
                    ..tiles
                },
                room: RoomData {
                    pair_capacity: eye.pair_capacity,
                    cell_side: lists::cell_side(
                        cut.gaussians(),
                        [tiles.tile_columns, tiles.tile_count / tiles.tile_columns],
                        eye.pair_capacity,
                    ),
                    pad: [0; 2],
                },
                weight: weight_data(&cut, settings, beam_switch)?,
            },
            views: layers::views(scene.layers, camera).into(),
            cut,
        })
    }

    /// The same plan for another size of the picture, px, as far as buffers are concerned.
    pub(crate) fn sized(&self, width: u32, height: u32) -> Self {
        let mut plan = self.clone();
        let size = vk::Extent2D { width, height };
        plan.data.tiles = tiles_data(size, self.data.tiles.span_runs);
        plan.data.view.size[..2].copy_from_slice(&[width as f32, height as f32]);
        plan
    }

    pub(crate) fn gaussians(&self) -> u64 {
        self.cut.gaussians()
    }

    pub(super) fn blocks(&self) -> u64 {
        self.cut.blocks()
    }

    pub(super) fn pixels(&self) -> u64 {
        self.size().map(|side| side as u64).iter().product()
    }

    /// So many bytes where there are tiles, or else none.
    pub(super) fn when_tiled(&self, bytes: u64) -> u64 {
        if self.is_tiled() { bytes } else { 0 }
    }

    /// Who reaches the tiles' picture. On a processor the host may as well read it in place; what a GPU writes stays there
    /// until it is wanted.
    pub(super) fn picture_location(&self) -> Location {
        match self.cut.shape {
            DeviceShape::Cpu if !self.is_drawn => Location::Readback,
            DeviceShape::Cpu | DeviceShape::Gpu { .. } => Location::GpuOnly,
        }
    }

    /// Width and height of the camera's picture, px.
    pub(crate) fn size(&self) -> [f32; 2] {
        let [width, height, ..] = self.data.view.size;
        [width, height]
    }

    /// The camera's principal point in an attachment in which the viewport begins at `origin`, px.
    pub(crate) fn principal_point(&self, origin: [f32; 2]) -> [f32; 2] {
        let [_, _, cx, cy] = self.data.view.focal;
        [cx + origin[0], cy + origin[1]]
    }

    /// Which of the two pairs of key and order buffers holds the sorted ones: each pass carries them to the other pair.
    pub(crate) fn sorted(&self) -> usize {
        (self.way.sort_passes % 2) as usize
    }

    pub(crate) fn is_tiled(&self) -> bool {
        self.way.raster == Raster::Tiles
    }

    /// True when the splats' depths in their pixels are found.
    pub(crate) fn finds_depth(&self) -> bool {
        let way = &self.way;
        way.expects_depth || way.writes_depth || way.draws_motion || self.has_soft_depth()
    }

    /// True when the host's depth hides parts of splats.
    pub(super) fn has_soft_depth(&self) -> bool {
        self.occluders.is_some_and(|occluders| occluders.soft)
    }

    /// True when splats' rectangles of tiles are kept, and masks of their tiles only where these do not tell everything.
    pub(crate) fn keeps_rects(&self) -> bool {
        self.is_tiled() && self.cut.shape != DeviceShape::Cpu
    }

    /// True when the quads of the splats have to be found.
    pub(crate) fn needs_quads(&self) -> bool {
        !self.is_tiled()
    }

    /// True when the Gaussians in view have to be found.
    pub(crate) fn finds_view(&self) -> bool {
        matches!(self.work, Work::Whole | Work::Reclip { base: true, .. })
    }

    /// True when the clip moves over what is in view, clipped away or not.
    pub(crate) fn reclips(&self) -> bool {
        matches!(self.work, Work::Reclip { .. })
    }

    /// True when the Gaussians that the clip removes are left out when those in view are found.
    pub(crate) fn view_is_clipped(&self) -> bool {
        self.cut.clips() && !self.reclips()
    }

    /// True when cutoff records are written when the Gaussians in view are found.
    pub(crate) fn view_is_cut(&self) -> bool {
        self.cut.cuts() && !self.reclips()
    }
}

/// The most memory that long records take, which hold all surfaces of a splat that more cut than a record has room for: those of
/// 40 000 splats that 50 planes cut.
const LONG_RECORDS_BYTES: u64 = 32 << 20;

/// How cut splats are weighted.
fn weight_data(cut: &CutPlan, settings: &Settings, switch: f32) -> Result<WeightData> {
    if !(settings.sigma.is_finite() && settings.sigma > 0.0) {
        return Err(Error::Invalid(format!(
            "the ellipsoid of mode rara has a radius of {} standard deviations; it must be finite and above 0",
            settings.sigma
        )));
    }
    if switch.is_nan() || switch < 0.0 {
        return Err(Error::Invalid(format!(
            "the beam switch is {switch}; it must be 0 or more"
        )));
    }
    // A record is a header of three, the surfaces, and the eye's own plane where the camera may be inside a splat, or a strip.
    let layers = &cut.layers;
    // Where there may be long records, it ends with the name of its own.
    let [vectors, long_vectors] = layers.most_record_vectors().map(|vectors| 3 + vectors + 1);
    let is_long = u32::from(long_vectors > vectors);
    let cut_stride = match cut.cuts() {
        false => 0,
        true if layers.are_combined() && cut.shape == DeviceShape::Cpu => {
            vectors.max(types::TERMS_VECTORS + 1) + is_long
        }
        true => vectors + is_long,
    };
    let long_strides = match cut_stride * is_long {
        0 => 0,
        stride => {
            let all = cut.gaussians() * u64::from(long_vectors.div_ceil(stride));
            all.min(LONG_RECORDS_BYTES / (16 * u64::from(stride))) as u32
        }
    };
    // Shaders count the records' elements in 32 bits.
    let records = cut.gaussians() + u64::from(long_strides);
    let has_room = cut_stride == 0 || records <= u64::from(limits::MAX_RECORDS);
    let meshes = records * u64::from(cut_stride);
    if !has_room || meshes + layers.meshes().quads() > u64::from(u32::MAX) {
        return Err(Error::Invalid(format!(
            "{} cut by {} are beyond what a frame can address; use fewer or split the scene",
            counted(cut.data.scene.gaussian_count, "Gaussian"),
            counted(layers.most_surfaces(), "surface")
        )));
    }
    Ok(WeightData {
        form: match settings.form {
            ExactForm::Auto => types::FORM_AUTO,
            ExactForm::Beam => types::FORM_BEAM,
            ExactForm::Affine => types::FORM_AFFINE,
        },
        beam_switch: switch,
        cut_stride,
        long_strides,
        meshes: meshes as u32,
        ..bytemuck::Zeroable::zeroed()
    })
}

/// The tiles of a picture, however its pixels blend.
fn tiles_data(size: vk::Extent2D, span_runs: u32) -> TilesData {
    let columns = size.width.div_ceil(limits::TILE_WIDTH);
    let rows = size.height.div_ceil(limits::TILE_HEIGHT);
    TilesData {
        tile_columns: columns,
        tile_count: columns * rows,
        // There are as many invocations as the spans have. Each row has whole workgroups, whose invocations then have
        // equally much to do.
        span_runs,
        row_parts: span_runs
            .div_ceil(rows)
            .next_multiple_of(limits::ROW_GROUP_SIZE),
        ..bytemuck::Zeroable::zeroed()
    }
}

#[cfg(test)]
mod tests;
