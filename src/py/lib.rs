//! The native module of the Python package `rara`: it converts arguments and results, and calls the library.

use pyo3::prelude::*;

mod arrays;
mod camera;
mod clip;
mod clip_methods;
mod errors;
mod gaussians;
mod picture;
mod renderer;
mod scene;

/// The native part of the package `rara`.
#[pymodule(gil_used = true)]
mod _rara {
    #[pymodule_export]
    use super::camera::{Camera, orbit, path, section};
    #[pymodule_export]
    use super::clip::{Clip, Mesh};
    #[pymodule_export]
    use super::gaussians::{Gaussians, generate};
    #[pymodule_export]
    use super::picture::{Picture, compare};
    #[pymodule_export]
    use super::renderer::{Renderer, devices, truth};
    #[pymodule_export]
    use super::scene::{bake, bounds, load, merged};

    #[pymodule_init]
    fn begin() {
        crate::errors::tell_warnings();
    }
}
