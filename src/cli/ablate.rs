//! `rara ablate`: the paper's second table.

use clap::Args;
use rara_lab::paper::ablation;

use super::failure::Failure;
use super::frame::ComparisonArgs;
use super::framing;
use super::output::{self, say};
use super::scenes::SceneArgs;

/// Repeat the paper's ablation with a plane at infinity
#[derive(Debug, Args)]
#[command(after_help = "\
Example:
  rara ablate scene.ply --size 512x512

Each row is compared with the picture of mode none. The rows that trace everything say what a pixel keeps whose ray
misses the ellipsoid; the paper's text keeps all of it at 1 sigma, its released code drops it at 3 sigma.")]
pub(super) struct Ablate {
    /// Print the table as JSON to stdout
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    common: ComparisonArgs,
    #[command(flatten)]
    scenes: SceneArgs,
}

impl Ablate {
    pub(super) fn run(self) -> Result<(), Failure> {
        let look = self.common.look.meant()?;
        let views = self.common.camera.meant(&self.scenes.places())?;
        let views = views.single("an ablation")?;
        let loaded = self.scenes.load()?;
        let scene = loaded.scene();
        let camera = framing::boxed_views(views, &scene)?.remove(0).camera;

        let mut headless = self.common.device.headless()?;
        headless.load_as(&scene, look.precision.sh)?;
        let rows = ablation::ablation(&mut headless, &scene, &camera, &look)?;
        headless.close()?;
        if self.json {
            return Ok(output::json(&rows)?);
        }
        say(ablation::table("Plane at infinity", &rows).markdown());
        Ok(())
    }
}
