//! The working memory by its debug names, for tests that compare what a stage has written with the stage's twin.

use crate::passes::buffers::Buffers;
use crate::passes::owner::Owner;
use crate::passes::scene_buffers::SceneBuffers;
use rara_gpu::Buffer;

impl<P: Owner> Buffers<P> {
    pub(crate) fn named(&self, name: &str) -> Option<&Buffer> {
        let mut all = self.sizes().all();
        let (storage, _) = all.find(|(storage, _)| storage.name == name)?;
        Some(self.get(storage))
    }
}

impl SceneBuffers {
    pub(crate) fn named(&self, name: &str) -> Option<&Buffer> {
        let all = [&self.gaussians, &self.sh, &self.blocks];
        all.into_iter().find(|buffer| buffer.name() == name)
    }
}
