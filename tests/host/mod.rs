//! rara in a host: the Vulkan layer, devices that are lent, targets, depth and viewports, frames in flight.

mod classic_host;
mod depth;
mod dispatches;
mod dynamic_state;
mod editing;
mod embed;
mod features;
mod formats;
mod gpu;
mod motion;
mod streaming;
mod views;
mod wgpu_host;
