//! The flags that commands which draw have in common.

use clap::Args;

use super::camera::CameraArgs;
use super::clip::ClipArgs;
use super::settings::{DeviceArgs, LookArgs, SettingsArgs};

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

/// The flags of a command that chooses the clip and the modes itself.
#[derive(Debug, Args)]
pub(super) struct ComparisonArgs {
    #[command(flatten)]
    pub(super) camera: CameraArgs,
    #[command(flatten)]
    pub(super) look: LookArgs,
    #[command(flatten)]
    pub(super) device: DeviceArgs,
}
