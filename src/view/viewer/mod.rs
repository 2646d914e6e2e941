//! A viewer: a window on a scene with clip shapes to drag through it, by mouse, keys and scripts.
//!
//! The program that opens it is its [`Host`], which prints lines for people and writes screenshots:
//!
//! ```no_run
//! use std::path::{Path, PathBuf};
//! use rara::Picture;
//! use rara_view::viewer::{Connection, Failure, Host, Shown, ViewerDesc};
//!
//! struct Program;
//!
//! impl Host for Program {
//!     fn screenshot(&mut self, picture: &Picture, file: Option<&Path>, _: &Shown<'_>) -> Result<PathBuf, Failure> {
//!         let file = file.unwrap_or("screenshot.png".as_ref());
//!         picture.save(file)?;
//!         Ok(file.into())
//!     }
//! }
//!
//! let desc = ViewerDesc::new(Program.read(vec!["scene.ply".into()], None, (1280, 720)));
//! Connection::open()?.run(desc, Program)?;
//! # Ok::<(), Failure>(())
//! ```

mod action;
mod app;
mod cut;
mod desc;
mod display;
mod dropped;
mod failure;
mod frames;
mod grip;
mod host;
mod input;
mod lasso;
mod layers;
mod loading;
mod lost;
mod numbers;
mod opening;
mod outlines;
mod overlay;
mod scenery;
mod slices;
mod stage;
mod text;
mod title;
mod viewpoint;

pub use action::{Action, Edit, GripAction, Step, Which};
pub use cut::ClipEditor;
pub use desc::{Follow, ViewerDesc};
pub use display::Connection;
pub use failure::Failure;
pub use host::{Host, Shown};
pub use input::KEYS;
pub use layers::{Clips, NamedLayer};
pub use loading::{Load, Progress, Watch};
pub use scenery::{FaceView, SceneView};
pub use viewpoint::Walk;
