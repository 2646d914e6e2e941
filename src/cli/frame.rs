//! The flags that commands which draw have in common.

use clap::Args;
use rara::Settings;
use rara::camera_files::load_path_settings;

use super::camera::CameraArgs;
use super::clip::{ClipArgs, Regions};
use super::failure::Failure;
use super::output;
use super::settings::{DeviceArgs, SettingsArgs};

/// The flags of a command whose user chooses the clip and the mode.
#[derive(Debug, Args)]
pub(super) struct FrameArgs {
    #[command(flatten)]
    pub(super) clip: ClipArgs,
    #[command(flatten)]
    pub(super) camera: CameraArgs,
    #[command(flatten)]
    pub(super) settings: SettingsArgs,
    #[command(flatten)]
    pub(super) device: DeviceArgs,
}

impl FrameArgs {
    /// The clip that the flags mean and these settings, which they mean too, within what the file of the cameras says of its
    /// pictures, and how many of them a second has, where the file says it.
    pub(super) fn staged(
        &self,
        settings: Settings,
    ) -> Result<(Regions, Settings, Option<f64>), Failure> {
        let regions = self.clip.meant()?;
        let Some(file) = self.camera.chosen_file() else {
            return Ok((regions, settings, None));
        };
        let said = load_path_settings(file)?;
        let Some(crop) = said.crop else {
            return Ok((regions, settings, said.fps));
        };
        let background = settings.background.or(said.background);
        output::say(format_args!(
            "note: nothing outside of the crop box of {} is drawn; take `crop` out of the file to draw all",
            file.display()
        ));
        Ok((
            regions.within(crop),
            settings.background(background),
            said.fps,
        ))
    }
}
