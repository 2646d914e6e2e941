//! What baking asks of a clip; nothing else here knows what a clip is made of.

use glam::DVec3;

use super::child::{Part, children};
use super::half_line::HalfLine;
use super::rays::Rays;
use super::{BakeSettings, Fate};
use rara_base::limits::ALPHA_MIN_INVERSE;
use rara_reference::Side;
use rara_reference::footprint::half_axes;
use rara_reference::region::{Ellipsoid, gaussian_side};
use rara_scene::Gaussians;
use rara_scene::clip::Clip;
use rara_scene::settings::{Mode, Settings};

/// What rounding and the quadrature may take from a child's distance to a surface, as a factor.
const SLACK: f64 = 0.99;

/// The region that a clip keeps, and the Gaussians that it is asked about.
pub(super) struct Region<'a> {
    gaussians: &'a Gaussians,
    /// The factor of their opacities.
    opacity: f32,
    clip: &'a Clip,
    /// What the stages that find a Gaussian's side read.
    settings: Settings,
    /// A Gaussian stays whole where all within this many deviations of its centre is kept.
    leave: f64,
}

impl<'a> Region<'a> {
    pub(super) fn new(
        gaussians: &'a Gaussians,
        opacity: f32,
        clip: &'a Clip,
        settings: &BakeSettings,
    ) -> Self {
        Self {
            gaussians,
            opacity,
            clip,
            settings: Settings::default()
                .mode(settings.mode)
                .sigma(settings.sigma),
            leave: SLACK * f64::from(settings.leave),
        }
    }

    /// What becomes of a Gaussian, of which `count` children would be left.
    pub(super) fn fate(&self, index: usize, count: usize) -> Fate {
        let scene = self.gaussians;
        let axes = half_axes::<f64>(scene.scales()[index], scene.rotations()[index]);
        let deviations = self.band(index);
        let ellipsoid = Ellipsoid::new(scene, index, axes);
        match self.side(&ellipsoid, deviations) {
            Side::Visible | Side::Culled => return Fate::Visible,
            Side::Invisible => return Fate::Invisible,
            Side::Cutoff => {}
        }
        if self.side(&ellipsoid, self.leave.min(deviations)) == Side::Visible {
            return Fate::Left;
        }
        let unit = UnitSpace {
            centre: scene.positions()[index].as_dvec3(),
            axes: axes.map(|axis| DVec3::new(axis.x, axis.y, axis.z)),
        };
        let kept = |u: DVec3| self.clip.keeps(unit.point(u));
        let parts: Vec<Part> = match self.only_plane(&unit, deviations) {
            Some(line) if kept(line.inside()) != kept(line.outside()) => {
                let line = if kept(line.inside()) {
                    line
                } else {
                    line.complement()
                };
                line.parts(count)
            }
            _ => Rays::through(kept).parts(count),
        };
        match children(scene, index, &parts, self.opacity) {
            Some(children) => Fate::Cut(children),
            // Beyond what single precision has there is no child that could be written.
            None => Fate::Left,
        }
    }

    /// Half width of the band in which a surface cuts, as stage `clip` has it.
    fn band(&self, index: usize) -> f64 {
        let opacity = f64::from(self.gaussians.opacities()[index]) * f64::from(self.opacity);
        let reach = (2.0 * (opacity * f64::from(ALPHA_MIN_INVERSE)).ln()).max(0.0);
        match self.settings.mode {
            Mode::Rara => reach.sqrt().max(f64::from(self.settings.sigma)),
            Mode::None | Mode::Hard | Mode::Exact => reach.sqrt(),
        }
    }

    fn side(&self, ellipsoid: &Ellipsoid<f64>, deviations: f64) -> Side {
        gaussian_side(ellipsoid, deviations, self.clip, &self.settings)
    }

    /// The only surface that comes near the Gaussian, if that is a plane: all others are decided wherever it shows.
    fn only_plane(&self, unit: &UnitSpace, deviations: f64) -> Option<HalfLine> {
        let mut only = None;
        for surface in self.clip.all_surfaces() {
            let plane = surface.as_plane()?;
            let normal = plane.normal();
            let local = DVec3::from_array(unit.axes.map(|axis| axis.dot(normal)));
            let (offset, deviation) = (plane.distance(unit.centre), local.length());
            if offset.abs() < deviations * deviation {
                let line = HalfLine::new(local / deviation, -offset / deviation);
                if only.replace(line).is_some() {
                    return None;
                }
            }
        }
        only
    }
}

/// A Gaussian's own space, in which it is a standard normal distribution.
struct UnitSpace {
    centre: DVec3,
    /// Half axes, the columns of M.
    axes: [DVec3; 3],
}

impl UnitSpace {
    fn point(&self, u: DVec3) -> DVec3 {
        let [x, y, z] = self.axes;
        self.centre + x * u.x + y * u.y + z * u.z
    }
}
