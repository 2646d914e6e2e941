//! Windows that show 3D Gaussian Splatting scenes: [`Windowed`] draws scenes of [`rara`] into any window that implements
//! `raw-window-handle`, with [lines](Line) in the world and [panels](Panel) such as text over the picture.
//!
//! The window's events and its size are the program's business; with winit they come from its event loop:
//!
//! ```no_run
//! use std::sync::Arc;
//! use rara::scene::{Kind, generate};
//! use rara::{Camera, Clip, HeadlessDesc, Settings};
//! use rara_view::{Redraw, Windowed};
//! # use rara::glam::DVec3;
//! # use raw_window_handle::{HasDisplayHandle, HasWindowHandle};
//! # fn example<W: HasWindowHandle + HasDisplayHandle + 'static>(window: Arc<W>) -> rara::Result<()> {
//!
//! let mut windowed = Windowed::new(&HeadlessDesc::default(), window)?;
//! let settings = Settings::default();
//! windowed.load_as(&generate(Kind::Strands, 2000, 1), settings.precision.sh)?;
//!
//! // Whenever the window is to be drawn:
//! if let Some(size) = windowed.fit((1280, 720))? {
//!     let camera = Camera::look_at(DVec3::new(0.0, -1.0, -4.0), DVec3::ZERO, DVec3::NEG_Y, 50.0, size)?;
//!     if windowed.show(&camera, &Clip::default(), &settings)? != Redraw::NotNeeded {
//!         // ask the window to be drawn once more
//!     }
//! }
//! # windowed.close()
//! # }
//! ```
//!
//! The feature `viewer` adds a module of that name, which is all of a window: it turns views and drags clip shapes by mouse and keys.
//!
//! An engine that has a device and a window of its own does without this crate: it draws by [`rara::Renderer`].

mod in_flight;
mod lines;
mod panels;
mod surface;
mod swapchain;
#[cfg(feature = "viewer")]
pub mod viewer;
mod windowed;

pub use lines::Line;
pub use panels::Panel;
pub use windowed::{Redraw, Windowed};
