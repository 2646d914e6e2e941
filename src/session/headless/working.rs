//! The contents that stages have written, for tests of the stages.

use super::Headless;

impl Headless {
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
