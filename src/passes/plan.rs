//! A frame's plan, made on the CPU before anything is recorded: which stages run, and the frame's constants.

use crate::passes::depth_keys::DepthKeys;
use crate::passes::laws::Laws;
use crate::passes::layers::{self, Layers};
use crate::passes::occluders::Occluders;
use crate::passes::region::{region_data, shortlist_from};
use crate::passes::scene_layer::SceneLayer;
use crate::passes::splat_colours::SplatColours;
use crate::passes::tile_picture::TilePixels;
use crate::passes::tile_work::TileWork;
use crate::passes::view::view_data;
use crate::passes::work::Work;
use crate::types::{
    self, FrameData, OrderData, RoomData, SceneData, TilesData, ViewData, WeightData,
};
use ash::vk;
use rara_base::counted::counted;
use rara_base::error::{Error, Result};
use rara_base::limits;
use rara_gpu::{DeviceShape, Location};
use rara_scene::SortBy;
use rara_scene::camera::Camera;
use rara_scene::clip::{Clip, ClipOp};
use rara_scene::precision::ShFormat;
use rara_scene::settings::{ExactForm, Raster, Settings, Show};

/// A frame, decided but not recorded.
#[derive(Debug, Clone)]
pub(crate) struct Plan {
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
    /// The frame's constants.
    pub(crate) data: FrameData,
    /// The constants of its layers.
    pub(crate) layers: Layers,
}

/// The stages and their variants that a frame takes. They decide what kinds of things it leaves in which buffers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Way {
    /// How splats become pixels; never `Auto`.
    pub(crate) raster: Raster,
    /// For what kind of device pipelines are chosen.
    pub(crate) shape: DeviceShape,
    pub(crate) sh_format: ShFormat,
    pub(crate) layered: bool,
    /// Passes of the sort that the scene's bounds ask for, at least one.
    pub(crate) sort_passes: u32,
    /// True when the splats' depths are wanted.
    pub(crate) expects_depth: bool,
    /// True when splats are drawn as quads. Where tiles' lists have no room, the quads are boxes that
    /// nobody has to find before.
    pub(crate) needs_quads: bool,
    /// Colours, or a debug view.
    pub(crate) show: Show,
    pub(crate) colours: SplatColours,
    pub(crate) tile_pixels: TilePixels,
}

/// The arguments of a plan besides camera, clip and settings.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SceneFacts<'a> {
    /// At least one.
    pub(crate) layers: &'a [SceneLayer],
    pub(crate) gaussians: u32,
    pub(crate) blocks: u32,
    /// True when the Gaussians lie in another order than that of their numbers.
    pub(crate) reordered: bool,
    pub(crate) sh_degree: u32,
    pub(crate) sh_format: ShFormat,
    /// For what kind of device pipelines are chosen.
    pub(crate) shape: DeviceShape,
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
    /// True when a frame without room for its pairs is drawn again, instead of as quads.
    pub(crate) redrawn: bool,
    /// The depth that hides splats of tiles, if they are wanted.
    pub(crate) occluders: Option<Occluders>,
    /// True when the splats' depths are wanted.
    pub(crate) expects_depth: bool,
    /// The camera of whose picture the frame shows a part; `None` where it shows all of it.
    pub(crate) whole: Option<&'a Camera>,
    pub(crate) colours: SplatColours,
}

impl Plan {
    /// Decides what a frame needs.
    pub(crate) fn new(
        scene: SceneFacts<'_>,
        camera: &Camera,
        clip: &Clip,
        settings: &Settings,
    ) -> Result<Self> {
        let visible = scene.layers.iter().filter(|layer| layer.is_visible());
        camera.check_near_cut()?;
        let own = visible.filter_map(SceneLayer::clip);
        let of_camera = Clip::of(camera.clip_planes()?, ClipOp::And);
        let region = region_data(own.chain([clip, &of_camera]), settings)?;
        let layers = Layers::new(scene.layers, camera, clip, &region)?;
        // The laws take Phi; the target and the scene have formats of their own.
        let (_target, _sh, _phi, key_bits, beam_switch, transmittance_min) =
            settings.precision.fields();
        let filled = scene.layers.iter().filter(|layer| layer.gaussians() > 0);
        let alphas = filled.clone().map(|layer| layer.training().alpha_max);
        let alpha_max = alphas.fold(1.0, f32::min);
        let weight = weight_data(&scene, &region, &layers, settings, beam_switch)?;
        let boxes = layers::boxes(scene.layers, camera);
        let trained = filled.filter(|layer| layer.is_visible());
        let trained = trained.map(SceneLayer::training);
        let order = settings.order_of(camera, trained);
        let keys = DepthKeys::new(boxes, key_bits, order)?;
        let degree = settings.sh_degree.unwrap_or(scene.sh_degree);
        let size = vk::Extent2D {
            width: camera.width,
            height: camera.height,
        };
        let is_tiled = scene.raster == Raster::Tiles;
        let occluders = scene.occluders.filter(|_| is_tiled);
        Ok(Self {
            work: Work::Whole {
                clip: region.mode != types::MODE_NONE,
            },
            way: Way {
                raster: scene.raster,
                shape: scene.shape,
                sh_format: scene.sh_format,
                layered: scene.layers.len() > 1,
                sort_passes: keys.passes(),
                expects_depth: scene.expects_depth,
                needs_quads: !is_tiled || scene.expects_depth,
                show: settings.show,
                colours: match settings.show {
                    Show::Strongest => SplatColours::Numbers,
                    Show::Colour | Show::Weight | Show::Count | Show::Mean => scene.colours,
                },
                tile_pixels: scene.picture.unwrap_or_default(),
            },
            laws: Laws::from_settings(settings),
            tile_work: scene.tile_work,
            is_drawn: scene.picture.is_none(),
            occluders: occluders.map(|occluders| Occluders { size, ..occluders }),
            reordered: scene.reordered,
            data: FrameData {
                scene: SceneData {
                    gaussian_count: scene.gaussians,
                    block_count: scene.blocks,
                    sh_coefficients: (scene.sh_degree + 1) * (scene.sh_degree + 1),
                    layer_count: scene.layers.len() as u32,
                },
                views: [view_data(
                    camera,
                    scene.whole.unwrap_or(camera),
                    keys.deepest,
                    degree.min(scene.sh_degree),
                )],
                order: OrderData {
                    key_near: keys.near,
                    key_span: keys.span,
                    key_shift: keys.shift,
                    sort_runs: scene.sort_runs,
                    by_distance: (order == SortBy::Distance).into(),
                    pad: [0; 3],
                },
                tiles: tiles_data(size, scene.span_runs, [transmittance_min, alpha_max])?,
                room: RoomData {
                    pair_capacity: scene.pair_capacity,
                    redrawn: scene.redrawn.into(),
                    pad: [0; 2],
                },
                weight,
                region,
            },
            layers,
        })
    }

    /// The same plan for another size of the picture, px, as far as buffers are concerned.
    pub(crate) fn sized(&self, width: u32, height: u32) -> Result<Self> {
        let mut plan = self.clone();
        let TilesData {
            span_runs,
            transmittance_min,
            alpha_max,
            ..
        } = self.data.tiles;
        let size = vk::Extent2D { width, height };
        plan.data.tiles = tiles_data(size, span_runs, [transmittance_min, alpha_max])?;
        for view in &mut plan.data.views {
            view.size[..2].copy_from_slice(&[width as f32, height as f32]);
        }
        Ok(plan)
    }

    pub(crate) fn gaussians(&self) -> u64 {
        self.data.scene.gaussian_count.into()
    }

    pub(super) fn blocks(&self) -> u64 {
        self.data.scene.block_count.into()
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
        match self.way.shape {
            DeviceShape::Cpu if !self.is_drawn => Location::Readback,
            DeviceShape::Cpu | DeviceShape::Gpu { .. } => Location::GpuOnly,
        }
    }

    /// `MODE_*`: `MODE_NONE` where there is nothing to clip with.
    pub(crate) fn mode(&self) -> u32 {
        self.data.region.mode
    }

    /// The picture of the frame's eye.
    fn view(&self) -> &ViewData {
        let [view] = &self.data.views;
        view
    }

    /// Width and height of the camera's picture, px.
    pub(crate) fn size(&self) -> [f32; 2] {
        let [width, height, ..] = self.view().size;
        [width, height]
    }

    /// The camera's principal point in an attachment in which the viewport begins at `origin`, px.
    pub(crate) fn principal_point(&self, origin: [f32; 2]) -> [f32; 2] {
        let [_, _, cx, cy] = self.view().focal;
        [cx + origin[0], cy + origin[1]]
    }

    /// True when cutoff Gaussians can exist.
    pub(crate) fn cuts(&self) -> bool {
        cuts(self.mode())
    }

    /// True when the blocks have shortlists of the surfaces that may cut them.
    pub(crate) fn is_shortlisted(&self) -> bool {
        let from = shortlist_from(self.way.shape);
        self.mode() != types::MODE_NONE && self.layers.most_surfaces() >= from
    }

    /// Which of the two pairs of key and order buffers holds the sorted ones: each pass carries them to the other pair.
    pub(crate) fn sorted(&self) -> usize {
        (self.way.sort_passes % 2) as usize
    }

    pub(crate) fn is_tiled(&self) -> bool {
        self.way.raster == Raster::Tiles
    }

    /// True when splats' rectangles of tiles are kept, and masks of their tiles only where these do not tell everything.
    pub(crate) fn keeps_rects(&self) -> bool {
        self.is_tiled() && self.way.shape != DeviceShape::Cpu
    }

    /// True when the quads of the splats have to be found.
    pub(crate) fn needs_quads(&self) -> bool {
        self.way.needs_quads
    }

    /// True when the clip's sides have to be found, of blocks and Gaussians whether in view or not.
    pub(crate) fn finds_clip(&self) -> bool {
        self.work == Work::Whole { clip: true }
    }

    /// True when the Gaussians in view have to be found.
    pub(crate) fn finds_view(&self) -> bool {
        matches!(
            self.work,
            Work::Whole { .. } | Work::Reclip { base: true, .. }
        )
    }

    /// True when the clip moves over what is in view, clipped away or not.
    pub(crate) fn reclips(&self) -> bool {
        matches!(self.work, Work::Reclip { .. })
    }

    /// True when the Gaussians that the clip removes are left out when those in view are found.
    pub(crate) fn view_is_clipped(&self) -> bool {
        self.mode() != types::MODE_NONE && !self.reclips()
    }

    /// True when cutoff records are written when the Gaussians in view are found.
    pub(crate) fn view_is_cut(&self) -> bool {
        self.cuts() && !self.reclips()
    }
}

/// True when a mode can have cutoff Gaussians.
fn cuts(mode: u32) -> bool {
    mode == types::MODE_RARA || mode == types::MODE_EXACT
}

/// How cut splats are weighted.
fn weight_data(
    scene: &SceneFacts<'_>,
    region: &types::RegionData,
    layers: &Layers,
    settings: &Settings,
    switch: f32,
) -> Result<WeightData> {
    if !(settings.sigma.is_finite() && settings.sigma > 0.0) {
        return Err(Error::Invalid(format!(
            "an ellipsoid of {} standard deviations cannot be traced",
            settings.sigma
        )));
    }
    if switch.is_nan() || switch < 0.0 {
        return Err(Error::Invalid(format!(
            "a beam switch of {switch} is not a size; give zero or more"
        )));
    }
    // A record is a header of three, the surfaces, and the eye's own plane where the camera may be inside a splat, or a strip.
    let most_surfaces = layers.most_surfaces();
    let surfaces = 3 + layers.most_record_vectors() + 1;
    let cut_stride = match cuts(region.mode) {
        false => 0,
        true if layers.are_combined() && scene.shape == DeviceShape::Cpu => {
            surfaces.max(types::TERMS_VECTORS + 1)
        }
        true => surfaces,
    };
    // Shaders count the records' elements in 32 bits.
    let has_room = cut_stride == 0 || scene.gaussians <= limits::MAX_RECORDS;
    if !has_room || u64::from(scene.gaussians) * u64::from(cut_stride) > u64::from(u32::MAX) {
        return Err(Error::Invalid(format!(
            "{} cut by {} are beyond what a frame can address; use fewer or split the scene",
            counted(scene.gaussians, "Gaussian"),
            counted(most_surfaces, "surface")
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
        pad: 0,
    })
}

/// The tiles of a picture.
fn tiles_data(
    size: vk::Extent2D,
    span_runs: u32,
    [saturated, alpha_max]: [f32; 2],
) -> Result<TilesData> {
    if !(0.0..1.0).contains(&saturated) {
        return Err(Error::Invalid(format!(
            "a least transmittance of {saturated} is not one; give zero or more, below 1"
        )));
    }
    let columns = size.width.div_ceil(limits::TILE_WIDTH);
    let rows = size.height.div_ceil(limits::TILE_HEIGHT);
    Ok(TilesData {
        tile_columns: columns,
        tile_count: columns * rows,
        // There are as many invocations as the spans have. Each row has whole workgroups, whose invocations then have
        // equally much to do.
        span_runs,
        row_parts: span_runs
            .div_ceil(rows)
            .next_multiple_of(limits::ROW_GROUP_SIZE),
        transmittance_min: saturated,
        alpha_max,
        pad: [0; 2],
    })
}

#[cfg(test)]
mod tests;
