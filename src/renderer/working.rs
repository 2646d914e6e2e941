//! The contents that stages have written, for tests of the stages.

use super::Renderer;
use crate::passes::SceneBuffers;

impl Renderer {
    /// The bytes of the working buffer of a debug name, once the submitted frames have written it; nothing where there is
    /// no such buffer. This is for tests: names and contents are no interface, and change with any version.
    #[doc(hidden)]
    pub fn working_buffer(&self, name: &str) -> Option<Vec<u8>> {
        let of_eye = self.memory.allocated()?.named(name);
        let buffer = of_eye.or_else(|| self.cut.memory.allocated()?.named(name))?;
        self.device.download(buffer).ok()
    }

    /// The same of a scene's buffer.
    #[doc(hidden)]
    pub fn scene_buffer(&self, scene: &SceneBuffers, name: &str) -> Option<Vec<u8>> {
        self.device.download(scene.named(name)?).ok()
    }
}
