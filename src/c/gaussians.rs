//! A scene in the host's memory, and from files.

use rara::Gaussians;
use rara::ash::vk;
use rara::scene::{Bounds, LoadReport, Property};

use crate::boundary::{RaraResult, guard, invalid, versioned, write};
use crate::handles::{alive, alone, destroy};
use crate::numbering::SetPart;

/// A scene in the host's memory. It may be destroyed once it is on the device. Several threads may read it at once.
pub struct RaraGaussians {
    pub(crate) gaussians: Gaussians,
    /// What of the file could not be used; nothing where there was none.
    pub(crate) report: LoadReport,
    /// Numbers that each of them has beside what it is drawn with, for selections.
    pub(crate) properties: Vec<Property>,
    /// The part of a set that they are, where selections have divided it.
    pub(crate) part: Option<SetPart>,
}

impl From<Gaussians> for RaraGaussians {
    fn from(gaussians: Gaussians) -> Self {
        Self {
            gaussians,
            report: LoadReport::default(),
            properties: Vec::new(),
            part: None,
        }
    }
}

/// Describes a scene, and what of its file could not be used.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct RaraGaussiansInfo {
    /// Set by rara_gaussians_info.
    pub struct_size: usize,
    /// Gaussians in the scene.
    pub count: u64,
    /// Elements of the file that were left out: numbers that are not finite.
    pub dropped: u64,
    /// Elements that were kept with a value put right.
    pub repaired: u64,
    /// Degree of its spherical harmonics, 0 to 3.
    pub sh_degree: u32,
    /// The corner of the scene's box with the smallest coordinates. The box holds all but the outermost percent of the
    /// centres at each end of each axis.
    pub bounds_min: [f64; 3],
    /// The corner with the largest coordinates.
    pub bounds_max: [f64; 3],
    /// Whether they are drawn antialiased: see rara_gaussians_set_antialiased.
    pub antialiased: vk::Bool32,
    /// The low-pass that they are drawn with, square pixels: see rara_gaussians_set_low_pass.
    pub low_pass: f32,
    /// The point that the scene's positions are relative to: zero unless it is far from there, as in coordinates of a map.
    pub origin: [f64; 3],
}

versioned!(RaraGaussiansInfo);

/// Appends another scene to one, so that both are sorted and composited as one. Properties that both have
/// stay, for rara_gaussians_select.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_gaussians_append(
    gaussians: *mut RaraGaussians,
    other: *const RaraGaussians,
) -> RaraResult {
    guard(|| {
        if std::ptr::eq(gaussians, other) && !other.is_null() {
            return invalid("gaussians and other are the same scene");
        }
        let (mut to, from) = (alone(gaussians, "gaussians")?, alive(other, "other")?);
        let was_empty = to.gaussians.is_empty();
        to.gaussians.append(&from.gaussians);
        to.report.dropped += from.report.dropped;
        to.report.repaired += from.report.repaired;
        if was_empty {
            to.properties.clone_from(&from.properties);
        } else if !from.gaussians.is_empty() {
            to.append_properties(&from);
        }
        if !from.gaussians.is_empty() {
            to.part = None;
        }
        Ok(())
    })
}

/// Says whether Gaussians were trained antialiased, as by Mip-Splatting or gsplat's rasterize_mode antialiased: what the
/// low-pass makes larger on the screen then gets no brighter for it. Files that say so are loaded so. It holds for a whole
/// scene; what is appended to one is drawn like it. A scene that is on the device already stays as it is.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_gaussians_set_antialiased(
    gaussians: *mut RaraGaussians,
    antialiased: vk::Bool32,
) -> RaraResult {
    guard(|| {
        let mut gaussians = alone(gaussians, "gaussians")?;
        gaussians
            .gaussians
            .set_antialiased(antialiased != vk::FALSE);
        Ok(())
    })
}

/// Says with which low-pass Gaussians were trained, square pixels, 0.01 to 10: 0.3 by 3DGS, gsplat and nerfstudio, 0.1 by
/// Mip-Splatting and by Brush where that trains antialiased. It is added to the variance of each footprint along either axis of
/// the picture. Files that say so are loaded so. It holds for a whole scene; what is appended to one is drawn like it. A scene
/// that is on the device already stays as it is.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_gaussians_set_low_pass(
    gaussians: *mut RaraGaussians,
    low_pass: f32,
) -> RaraResult {
    guard(|| {
        let gaussians = &mut alone(gaussians, "gaussians")?.gaussians;
        gaussians.set_training(gaussians.training().low_pass(low_pass))
    })
}

/// Describes a scene. `info_size` is sizeof *info.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_gaussians_info(
    gaussians: *const RaraGaussians,
    info: *mut RaraGaussiansInfo,
    info_size: usize,
) -> RaraResult {
    guard(|| {
        let gaussians = alive(gaussians, "gaussians")?;
        let RaraGaussians {
            gaussians, report, ..
        } = &*gaussians;
        let bounds = Bounds::of(gaussians);
        let found = RaraGaussiansInfo {
            struct_size: size_of::<RaraGaussiansInfo>(),
            count: gaussians.len() as u64,
            dropped: report.dropped,
            repaired: report.repaired,
            sh_degree: gaussians.sh_degree(),
            bounds_min: bounds.min.into(),
            bounds_max: bounds.max.into(),
            antialiased: gaussians.is_antialiased().into(),
            low_pass: gaussians.low_pass(),
            origin: gaussians.origin().into(),
        };
        write(info, info_size, &found, "info")
    })
}

/// Frees a scene's memory; null is ignored.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_gaussians_destroy(gaussians: *mut RaraGaussians) {
    destroy(gaussians);
}
