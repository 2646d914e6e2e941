//! Baking: Gaussians that show a cut in any viewer.

use rara::{BakeCounts, BakeSettings, bake};

use crate::boundary::{RaraResult, guard, read, versioned, write};
use crate::clip::RaraClip;
use crate::gaussians::RaraGaussians;
use crate::handles::{alive, create};
use crate::settings::{Coded as _, RaraMode, choice};

/// How a clip is baked.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RaraBakeSettings {
    /// Set by rara_bake_settings_default.
    pub struct_size: usize,
    /// Which Gaussians are cut: those that a frame of this mode cuts. RARA_MODE_HARD cuts none, so that Gaussians stay or go by
    /// their centres, and RARA_MODE_NONE keeps all. Default: RARA_MODE_EXACT.
    pub mode: RaraMode,
    /// RARA_MODE_RARA: the traced ellipsoid, in standard deviations. Default: 3.
    pub sigma: f32,
    /// How many Gaussians stand for a cut one, 1 to 3. Default: 1.
    pub children: u32,
    /// A cut Gaussian stays whole where the clip keeps all within this many standard deviations of its centre. Default: 1, at
    /// which baking twice is baking once.
    pub leave: f32,
}

versioned!(RaraBakeSettings);

impl From<BakeSettings> for RaraBakeSettings {
    fn from(settings: BakeSettings) -> Self {
        Self {
            struct_size: size_of::<Self>(),
            mode: settings.mode.code(),
            sigma: settings.sigma,
            children: settings.children,
            leave: settings.leave,
        }
    }
}

/// The numbers of Gaussians that baking has kept, replaced and dropped. The fields visible, cutoff and invisible are the
/// classes that a frame counts, without regard to a camera.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RaraBakeCounts {
    /// Set by rara_gaussians_bake.
    pub struct_size: usize,
    /// Gaussians that the clip leaves whole; they are kept.
    pub visible: u64,
    /// Gaussians that the clip cuts; they are replaced, except those of left and faint.
    pub cutoff: u64,
    /// Gaussians outside the clip; they are dropped.
    pub invisible: u64,
    /// Cut Gaussians that stay whole, because the cut is far enough from their centres (RaraBakeSettings::leave).
    pub left: u64,
    /// Cut Gaussians that are dropped, because their visible part cannot be seen.
    pub faint: u64,
    /// Gaussians that replace cut ones.
    pub children: u64,
}

versioned!(RaraBakeCounts);

impl From<BakeCounts> for RaraBakeCounts {
    fn from(counts: BakeCounts) -> Self {
        Self {
            struct_size: size_of::<Self>(),
            visible: counts.visible,
            cutoff: counts.cutoff,
            invisible: counts.invisible,
            left: counts.left,
            faint: counts.faint,
            children: counts.children,
        }
    }
}

/// The default settings. `settings_size` is sizeof *settings.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_bake_settings_default(
    settings: *mut RaraBakeSettings,
    settings_size: usize,
) -> RaraResult {
    let default = BakeSettings::default().into();
    guard(|| write(settings, settings_size, &default, "settings"))
}

/// Makes Gaussians that show a cut without a clip, wherever they are drawn: those outside it are dropped, those that it
/// leaves whole are kept, and each that it cuts is replaced by one with the mass, the mean and the covariance of what is left.
/// A Gaussian has no edge, so that this is a preview: against the exact cut, 12 to 17 % of the light of cut Gaussians is off,
/// where a cut by centres is off by 35 %. It needs no device; all processors work at it.
/// Properties, for rara_gaussians_select, stay those of the Gaussians that they come from.
///
/// Null `settings` are the defaults. `counts` says what has been done; it may be null, and `counts_size` is sizeof *counts.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_gaussians_bake(
    gaussians: *const RaraGaussians,
    clip: *const RaraClip,
    settings: *const RaraBakeSettings,
    baked: *mut *mut RaraGaussians,
    counts: *mut RaraBakeCounts,
    counts_size: usize,
) -> RaraResult {
    create(baked, "baked", || {
        let gaussians = alive(gaussians, "gaussians")?;
        let clip = alive(clip, "clip")?;
        let default = BakeSettings::default();
        let settings = match settings.is_null() {
            true => default,
            false => {
                let given = read(settings, default.into(), "settings")?;
                default
                    .mode(choice(given.mode, "settings->mode")?)
                    .sigma(given.sigma)
                    .children(given.children)
                    .leave(given.leave)
            }
        };
        let made = bake(&gaussians.gaussians, &clip.0, &settings)?;
        if !counts.is_null() {
            write(counts, counts_size, &made.counts.into(), "counts")?;
        }
        Ok(RaraGaussians {
            properties: gaussians.properties_of(&made.sources),
            ..made.gaussians.into()
        })
    })
}
