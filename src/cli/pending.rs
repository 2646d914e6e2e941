//! Stand-ins with the signatures of library parts that this branch does not have yet. At merge this file goes, and
//! every `super::pending::` becomes `rara::`; the imports of the two traits go, since their functions are methods there.

use rara::{Error, Result};

fn missing<T>(what: &str) -> Result<T> {
    Err(Error::Invalid(format!("{what} is not in this build")))
}

pub(super) mod scene {
    use std::path::Path;

    use glam::DVec3;
    use rara::{Gaussians, Result};

    pub(in crate::cli) struct Loaded {
        pub(in crate::cli) gaussians: Gaussians,
        pub(in crate::cli) report: LoadReport,
    }

    pub(in crate::cli) struct LoadReport {
        pub(in crate::cli) dropped: u64,
        pub(in crate::cli) repaired: u64,
    }

    impl LoadReport {
        pub(in crate::cli) fn lines(&self) -> Vec<String> {
            Vec::new()
        }
    }

    pub(in crate::cli) fn load(
        _path: &Path,
        _progress: &mut dyn FnMut(u64, u64),
    ) -> Result<Loaded> {
        super::missing("reading scenes")
    }

    pub(in crate::cli) fn save_ply(_path: &Path, _scene: &Gaussians) -> Result<()> {
        super::missing("writing scenes")
    }

    #[derive(Debug, Clone, Copy)]
    pub(in crate::cli) enum Kind {
        General,
        Strands,
        Layers,
    }

    pub(in crate::cli) fn generate(_kind: Kind, _count: usize, _seed: u64) -> Gaussians {
        Gaussians::default()
    }

    pub(in crate::cli) struct Bounds {
        pub(in crate::cli) min: DVec3,
        pub(in crate::cli) max: DVec3,
    }

    impl Bounds {
        pub(in crate::cli) fn of(_scene: &Gaussians) -> Self {
            Self {
                min: -DVec3::ONE,
                max: DVec3::ONE,
            }
        }

        pub(in crate::cli) fn centre(&self) -> DVec3 {
            (self.min + self.max) / 2.0
        }
    }

    pub(in crate::cli) fn extent_along(_scene: &Gaussians, _normal: DVec3) -> (f64, f64) {
        (-1.0, 1.0)
    }
}

pub(super) mod camera_files {
    use std::path::Path;

    use rara::{Camera, Result};

    pub(in crate::cli) struct NamedCamera {
        pub(in crate::cli) name: String,
        pub(in crate::cli) camera: Camera,
    }

    pub(in crate::cli) fn load_cameras(_path: &Path) -> Result<Vec<NamedCamera>> {
        super::missing("reading cameras")
    }

    pub(in crate::cli) fn load_camera(_path: &Path) -> Result<Camera> {
        super::missing("reading a camera")
    }
}

/// `Camera::frame`.
pub(super) trait Framing: Sized {
    fn frame(bounds: &scene::Bounds, up: glam::DVec3, fov_y: f64, size: (u32, u32))
    -> Result<Self>;
}

impl Framing for rara::Camera {
    fn frame(
        bounds: &scene::Bounds,
        up: glam::DVec3,
        fov_y: f64,
        size: (u32, u32),
    ) -> Result<Self> {
        let eye = bounds.centre() - 3.0 * glam::DVec3::Z;
        rara::Camera::look_at(eye, bounds.centre(), up, fov_y, size)
    }
}

pub(super) mod reference {
    use rara::{Camera, Clip, Gaussians, Picture, Settings};

    pub(in crate::cli) struct Frame {
        pub(in crate::cli) picture: Picture,
    }

    pub(in crate::cli) fn render<T: Default>(
        _: &Gaussians,
        camera: &Camera,
        _: &Clip,
        _: &Settings,
    ) -> Frame {
        let _ = T::default();
        Frame {
            picture: Picture::filled(camera.width, camera.height, [0.0; 4]),
        }
    }
}

pub(super) mod measure {
    use rara::{Picture, Result};

    #[derive(Clone, Copy)]
    pub(in crate::cli) struct Comparison {
        pub(in crate::cli) max: f64,
        pub(in crate::cli) l1: f64,
        pub(in crate::cli) rmse: f64,
        pub(in crate::cli) psnr: f64,
        pub(in crate::cli) ssim: f64,
        pub(in crate::cli) share_over_2: f64,
    }

    pub(in crate::cli) fn compare(_a: &Picture, _b: &Picture) -> Result<Comparison> {
        super::missing("comparing pictures")
    }
}

/// `Picture::load` and `Picture::save`.
pub(super) trait PictureFile: Sized {
    fn load(path: &std::path::Path) -> Result<Self>;
    fn save(&self, path: &std::path::Path) -> Result<()>;
}

impl PictureFile for rara::Picture {
    fn load(_path: &std::path::Path) -> Result<Self> {
        missing("reading pictures")
    }

    fn save(&self, _path: &std::path::Path) -> Result<()> {
        missing("writing pictures")
    }
}

pub(super) mod gpu {
    use rara::Result;

    pub(in crate::cli) struct DeviceInfo {
        pub(in crate::cli) name: String,
        pub(in crate::cli) driver: String,
        pub(in crate::cli) support: std::result::Result<(), String>,
    }

    impl DeviceInfo {
        pub(in crate::cli) fn kind_name(&self) -> &'static str {
            "cpu"
        }
    }

    pub(in crate::cli) fn list_devices() -> Result<Vec<DeviceInfo>> {
        super::missing("listing devices")
    }
}
