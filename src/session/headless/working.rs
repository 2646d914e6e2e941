//! What tests need beside pictures: the contents that stages have written, and a second renderer that compiles nothing again.

use super::Headless;
use rara_base::error::Result;

impl Headless {
    /// Another one on the same device, without a scene, that shares the compiled pipelines and nothing else. This is for tests
    /// that draw a frame in two ways: a second device would compile all of them a second time.
    #[doc(hidden)]
    pub fn sharing(&self) -> Result<Self> {
        Self::beside(&self.session.renderer)
    }

    /// The bytes of the working buffer of a debug name, as the last frame has left it, or of one of the scene's; nothing
    /// where there is no such buffer. This is for tests: names and contents are no interface, and change with any version.
    #[doc(hidden)]
    pub fn working_buffer(&mut self, name: &str) -> Option<Vec<u8>> {
        let scene = self.session.scene.as_ref();
        if let Some(buffer) = scene.and_then(|scene| scene.named(name)) {
            return self.session.device.download(buffer).ok();
        }
        self.session.renderer.working_buffer(name)
    }
}
