//! The flags that commands which draw have in common.

use clap::Args;
use rara::Settings;
use rara::camera_files::load_path_settings;
use rara::clip::Lasso;

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
    /// Keep what is seen within a polygon of the picture, X,Y;X,Y;..., px (repeatable)
    ///
    /// The clip keeps everything that is seen through the polygon, at every depth; with a leading ! it keeps the rest. Pixels are
    /// counted from the picture's top left corner, and a | begins the corners of a hole. If the command draws several pictures, the
    /// polygon is drawn in the first one, and the others show the same part of the scene. --save-clip saves it.
    #[arg(long, value_name = "CORNERS", value_parser = str::parse::<Lasso>, allow_hyphen_values = true, help_heading = "Clip")]
    lasso: Vec<Lasso>,
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
        let regions = self.clip.meant_beside(&self.lasso)?;
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
