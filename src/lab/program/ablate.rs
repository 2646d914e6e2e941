//! `rara-lab ablate`: the paper's second table.

use clap::Args;
use rara_cli::parts::{CameraArgs, DeviceArgs, Failure, LookArgs, SceneArgs, json, say};
use rara_lab::paper::ablation;

/// Repeat the paper's ablation with a plane at infinity
#[derive(Debug, Args)]
#[command(after_help = "\
Example:
  rara-lab ablate scene.ply --size 512x512

Each row is compared with the picture of mode none. The rows that trace every Gaussian differ in the radius of the ellipsoid, in
standard deviations (sigma), and in what a splat keeps in a pixel whose ray misses the ellipsoid. The paper's text keeps the
splat there and traces 1 sigma; its released code drops the splat there and traces 3 sigma.")]
pub(super) struct Ablate {
    /// Print the table as JSON to stdout
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    camera: CameraArgs,
    #[command(flatten)]
    look: LookArgs,
    #[command(flatten)]
    device: DeviceArgs,
    #[command(flatten)]
    scenes: SceneArgs,
}

impl Ablate {
    pub(super) fn run(self) -> Result<(), Failure> {
        let look = self.look.meant();
        let views = self.camera.meant(&self.scenes.places())?;
        let views = views.single("an ablation")?;
        let loaded = self.scenes.load()?;
        let scene = loaded.scene();
        let camera = views.boxed(&scene)?.remove(0).camera;

        let mut headless = self.device.headless()?;
        headless.load_as(&scene, look.precision.sh)?;
        let rows = ablation::ablation(&mut headless, &scene, &camera, &look)?;
        headless.close()?;
        if self.json {
            return Ok(json(&rows)?);
        }
        say(ablation::table("Plane at infinity", &rows).markdown());
        Ok(())
    }
}
