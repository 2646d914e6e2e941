//! The working memory by its debug names, for tests that compare what a stage has written with the stage's twin.

use crate::gpu::Buffer;
use crate::passes::buffers::Buffers;
use crate::passes::scene_buffers::SceneBuffers;

impl Buffers {
    /// The buffer of a debug name.
    pub(crate) fn named(&self, name: &str) -> Option<&Buffer> {
        self.all().into_iter().find(|buffer| buffer.name() == name)
    }

    fn all(&self) -> Vec<&Buffer> {
        let mut all = vec![
            &self.frame,
            &self.surfaces,
            &self.masks,
            &self.clip_sides,
            &self.clip_masks,
            &self.shortlists,
            &self.shortlists,
            &self.block_sides,
            &self.block_list,
            &self.block_counts,
            &self.block_offsets,
            &self.counts,
            &self.survivors,
            &self.cutoffs,
            &self.cut_records,
            &self.splats,
            &self.quads,
            &self.depth_keys,
            &self.histogram,
            &self.crowds,
            &self.tile_masks,
        ];
        all.extend(self.keys.iter().chain(&self.order));
        if let Some(t) = &self.tiles {
            all.extend(t.scratch.all());
            all.extend([
                &t.picture.begins,
                &t.splats,
                &t.picture.pixels,
                &t.occluders,
            ]);
        }
        if let Some(d) = &self.depth {
            all.extend([&d.depths, &d.draw]);
        }
        if let Some(s) = &self.reclip {
            all.extend([&s.revisits, &s.reclips, &s.recuts, &s.dirty]);
        }
        all
    }
}

impl SceneBuffers {
    /// The buffer of a debug name.
    pub(crate) fn named(&self, name: &str) -> Option<&Buffer> {
        let all = [&self.gaussians, &self.sh, &self.blocks];
        all.into_iter().find(|buffer| buffer.name() == name)
    }
}
