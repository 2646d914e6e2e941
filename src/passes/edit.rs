//! An edit packs what a host's shaders have written of a layer's Gaussians, and finds the bounds of their blocks anew: one
//! workgroup a block.

use std::ops::Range;

use crate::passes::block_order;
use crate::passes::earlier_shapes::EarlierShapes;
use crate::passes::pipelines::{Pipeline, PipelineKey, Pipelines};
use crate::passes::scene_buffers::SceneBuffers;
use crate::passes::scene_layer::{SceneLayer, bytes_each};
use crate::passes::shaders::{Compute, edit};
use crate::types;
use rara_base::counted::counted;
use rara_base::error::{Error, Result};
use rara_base::setters;
use rara_gpu::{Buffer, Groups, Recorder};
use rara_scene::Bounds;
use rara_scene::precision::ShFormat;

setters! {
    /// An edit of a layer: which of its Gaussians change, and what of them. Everything else stays as it is.
    #[derive(Debug, Clone, Copy, PartialEq)]
    #[non_exhaustive]
    pub struct LayerEdit {
        /// The number in the layer of the first Gaussian that is edited, which is the first one of the editor's buffer.
        pub first: u32,
        /// How many are edited.
        pub count: u32,
        /// True if their centres are read. They stay within [`bounds`](Self::bounds).
        pub positions: bool,
        /// True if their standard deviations are read.
        pub scales: bool,
        /// True if their rotations are read.
        pub rotations: bool,
        /// True if their opacities are read.
        pub opacities: bool,
        /// True if the constant coefficients of their spherical harmonics are read. The others stay, if not `flat`.
        pub colours: bool,
        /// True if all but the constant coefficients become zero: the Gaussians have one colour from all sides.
        pub flat: bool,
        /// True if the Gaussians move to where the edit puts them, so that the next frame's motion
        /// ([`RendererDesc::motion`](crate::RendererDesc::motion)) shows how far. False if others take their place, which count
        /// as at rest. The first such edit of a scene takes 48 bytes of device memory for each of its Gaussians.
        pub moves: bool,
        /// The box around the centres of all Gaussians of the layer after the edit, in the layer's units and relative to its
        /// origin; `None` for the box that it has ([`SceneLayer::bounds`]). It may be larger than needed, but depths are sorted
        /// the more coarsely for it. Gaussians with a centre outside may be drawn in a wrong order.
        pub bounds: Option<Bounds>,
    }
}

impl LayerEdit {
    /// An edit of Gaussians by their numbers in the layer, of which nothing is read yet.
    pub fn of(gaussians: Range<u32>) -> Self {
        Self {
            first: gaussians.start,
            count: gaussians.end.saturating_sub(gaussians.start),
            positions: false,
            scales: false,
            rotations: false,
            opacities: false,
            colours: false,
            flat: false,
            moves: false,
            bounds: None,
        }
    }

    /// The parts as shaders have them.
    fn parts(&self) -> u32 {
        [
            (self.positions, types::EDIT_POSITIONS),
            (self.scales, types::EDIT_SCALES),
            (self.rotations, types::EDIT_ROTATIONS),
            (self.opacities, types::EDIT_OPACITIES),
            (self.colours, types::EDIT_COLOURS),
            (self.flat, types::EDIT_FLAT),
        ]
        .into_iter()
        .filter_map(|(is_read, part)| is_read.then_some(part))
        .sum()
    }

    /// True where it changes nothing.
    pub(crate) fn is_empty(&self) -> bool {
        self.count == 0 || self.parts() == 0
    }

    /// Checks the edit of a layer by a buffer of so many Gaussians.
    fn check(&self, layer: &SceneLayer, room: u32) -> Result<()> {
        let refuse = |what: String| Err(Error::Invalid(format!("an edit {what}")));
        let end = u64::from(self.first) + u64::from(self.count);
        if end > layer.gaussians().into() {
            return refuse(format!(
                "ends with Gaussian {end} of layer '{}', which has {}: replace the layer to change their number",
                layer.name(),
                counted(layer.gaussians(), "Gaussian")
            ));
        }
        if self.count > room {
            return refuse(format!(
                "of {} needs an editor for as many, and this one is for {room}",
                counted(self.count, "Gaussian")
            ));
        }
        match self.bounds {
            Some(Bounds { min, max })
                if !(min.as_vec3().is_finite()
                    && max.as_vec3().is_finite()
                    && min.cmple(max).all()) =>
            {
                refuse(format!(
                    "has bounds from {min} to {max}, which are not a box: give finite corners, the least one first"
                ))
            }
            _ => Ok(()),
        }
    }
}

/// An edit that was checked, with the layer as it is then.
#[derive(Debug)]
pub(crate) struct CheckedEdit {
    index: usize,
    layer: SceneLayer,
    params: edit::Params,
    /// The scene's earlier shapes after this edit, if it moves Gaussians.
    moved: Option<EarlierShapes>,
    /// Blocks of the layer that hold Gaussians.
    blocks: u32,
}

impl CheckedEdit {
    /// Checks an edit of a layer of a scene by a buffer of so many Gaussians.
    pub(crate) fn new(
        scene: &SceneBuffers,
        index: usize,
        edit: &LayerEdit,
        room: u32,
    ) -> Result<Self> {
        let layer = scene.layer(index)?;
        let numbers = layer.numbers()?;
        edit.check(layer, room)?;
        let training = layer.training();
        let [_, sh_bytes] = bytes_each(scene.sh());
        let moves = edit.moves && (edit.positions || edit.scales || edit.rotations);
        let moved = moves.then(|| scene.moved_again()).transpose()?;
        let [number, shown] = moved.as_ref().map_or([0; 2], EarlierShapes::numbers);
        let params = edit::Params {
            first_block: layer.first_block,
            gaussian_end: layer.gaussian_end(),
            first_number: numbers.of(edit.first),
            count: edit.count,
            parts: edit.parts(),
            sh_words: (sh_bytes / size_of::<u32>()) as u32,
            sh_floats: u32::from(scene.sh_format == ShFormat::Float),
            spanning_opacity: block_order::opacity_spanning(training),
            least_opacity: block_order::least_opacity(training),
            low_pass: match training.antialiased {
                true => training.low_pass,
                false => 0.0,
            },
            edit: number,
            shown,
        };
        Ok(Self {
            index,
            layer: match edit.bounds {
                Some(bounds) => layer.within(bounds),
                None => layer.clone(),
            },
            params,
            moved,
            blocks: layer.filled_blocks(),
        })
    }

    /// Records it, and notes in the scene what it changes.
    pub(crate) fn record(
        self,
        recorder: &mut Recorder<'_>,
        pipelines: &Pipelines,
        plain: &Buffer,
        scene: &mut SceneBuffers,
    ) {
        if let Some(moved) = self.moved {
            if scene.earlier.is_none() {
                let buffer = moved.buffer();
                recorder.label("edit", |r| r.fill(buffer, 0, buffer.size(), 0));
            }
            scene.earlier = Some(moved);
        }
        let earlier = scene.earlier.as_ref();
        let buffers = edit::Buffers {
            plain,
            gaussians: &scene.gaussians,
            sh: &scene.sh,
            blocks: &scene.blocks,
            earlier: earlier.map_or(&scene.blocks, EarlierShapes::buffer),
        };
        let groups = Groups::Count(self.blocks);
        recorder.label("edit", |recorder| {
            pipeline().dispatch(
                pipelines,
                recorder,
                (buffers, |buffer| buffer),
                self.params,
                (groups, None),
            );
        });
        scene.hold(self.index, self.layer);
    }
}

/// The pipeline of all edits.
pub(crate) fn needs(need: &mut dyn FnMut(PipelineKey)) {
    need(pipeline().key());
}

fn pipeline() -> Pipeline<edit::Program> {
    Pipeline::new(edit::Program::SHADER, ())
}

#[cfg(test)]
mod tests;
