//! What a frame needs has three owners: the scene, the cut, which is what a clip keeps of the scene, and the eye, which
//! sees the cut.

use crate::passes::storage::Storage;

/// The plan of an owner that has stages and memory of its own, as a cut and an eye have.
pub(crate) trait Owner: Sized + 'static {
    /// A buffer that its stages reach.
    type Name: Copy;

    /// All buffers that are its own, by their places.
    fn storages() -> &'static [&'static Storage<Self>];

    /// The buffer that is bound in place of those of which a plan needs no byte.
    fn empty() -> &'static Storage<Self>;

    /// How many Gaussians and blocks the scene has.
    fn scene_size(&self) -> [u64; 2];
}
