//! `--panorama`: everything that is seen from one place.

use clap::Args;
use rara_shots::Panorama;

use super::failure::Failure;

/// A picture of all directions.
#[derive(Debug, Args)]
#[command(next_help_heading = "Paths, films and panoramas")]
pub(super) struct PanoramaArgs {
    /// Draw all directions around --eye in a picture that is twice as wide as high
    ///
    /// The picture is equirectangular, and the direction of view is in its middle. Its default size is 2048x1024. Instead of
    /// --eye, a camera of a file or of a path may give the position.
    #[arg(long, conflicts_with_all = ["ortho", "fov_y", "section", "aov", "clip_near", "clip_far", "near_cut"])]
    panorama: bool,
}

impl PanoramaArgs {
    /// The panorama that is asked for. `size` is that of the flags.
    pub(super) fn meant(&self, size: Option<(u32, u32)>) -> Result<Option<Panorama>, Failure> {
        let panorama = self
            .panorama
            .then(|| Panorama::new(size.unwrap_or((2048, 1024))));
        panorama.transpose().map_err(Failure::usage)
    }
}
