//! What other programs that take the same flags are made of: `rara-lab` measures with it.

pub use super::camera::CameraArgs;
pub use super::clip::ClipArgs;
pub use super::demo::middle;
pub use super::failure::Failure;
pub use super::memory::check_drawing;
pub use super::output::{answer, counted, json, make_folder, say, text};
pub use super::process::make_drivers_folder;
pub use super::program::{Commands, main};
pub use super::progress::ProgressLine;
pub use super::scenes::SceneArgs;
pub use super::settings::{DeviceArgs, LookArgs};
pub use super::values::{named, one_file};
