//! Stage `classify` finds the side of each Gaussian (the paper, section 3.2).
//!
//! The paper's band is 3 max(sigma) on either side of the plane. Here it is K |M^T n|: the Gaussian's own extent along
//! the normal, out to the contour on which its alpha falls to 1/255. Outside of it no pixel would change by more
//! than half of 1/255, and half as many needles are called cut. Where weights follow each pixel's true ray, the band is
//! wider by what perspective adds: see `beam_band`.

use glam::DVec3;

use super::clip;
use super::footprint::Footprint;
use super::real::{Real, vec3};
use super::region::{
    Ellipsoid, HalfSpace, RegionRest, Side, gaussian_side, reduced, surface_gaussian_side,
    surface_half_space,
};
use super::view::ViewTransform;
use rara_base::limits::{ALPHA_MIN_INVERSE, BEYOND_EYE, WIDENING_REST};
use rara_scene::Gaussians;
use rara_scene::camera::Projection;
use rara_scene::clip::{Clip, Surface};
use rara_scene::settings::{ExactForm, Mode, Settings};

/// The side of every Gaussian of the scene.
pub fn classify<T: Real>(
    scene: &Gaussians,
    view: &ViewTransform<T>,
    clip: &Clip,
    settings: &Settings,
) -> Vec<Side> {
    (0..scene.len())
        .map(|index| match Footprint::new(scene, index, view) {
            Some(seen) => GaussianInView::new(scene, index, &seen, clip, settings).side(),
            None => Side::Culled,
        })
        .collect()
}

/// A Gaussian in view, with all on which its side and its record depend.
#[derive(Clone, Copy)]
pub(super) struct GaussianInView<'a, T> {
    pub(super) scene: &'a Gaussians,
    pub(super) index: usize,
    pub(super) footprint: &'a Footprint<T>,
    pub(super) clip: &'a Clip,
    pub(super) settings: &'a Settings,
}

impl<'a, T: Real> GaussianInView<'a, T> {
    pub(super) fn new(
        scene: &'a Gaussians,
        index: usize,
        footprint: &'a Footprint<T>,
        clip: &'a Clip,
        settings: &'a Settings,
    ) -> Self {
        Self {
            scene,
            index,
            footprint,
            clip,
            settings,
        }
    }

    pub(super) fn side(&self) -> Side {
        gaussian_side(&self.ellipsoid(), self.band(), self.clip, self.settings)
    }

    /// The half-spaces that surfaces keep of it where they cut it, in the clip's order.
    pub(super) fn cutting(&self) -> Vec<HalfSpace<T>> {
        let surfaces = self.cutting_surfaces();
        surfaces.iter().map(|s| self.half_space(s)).collect()
    }

    /// The surfaces of the region and its parts that cut it; none where its side is not [`Side::Cutoff`].
    pub(super) fn cutting_surfaces(&self) -> Vec<Surface> {
        if self.side() != Side::Cutoff {
            return Vec::new();
        }
        let (ellipsoid, band) = (self.ellipsoid(), self.band());
        let mut surfaces = self.clip.all_surfaces();
        surfaces.retain(|surface| {
            surface_gaussian_side(surface, &ellipsoid, band, self.settings) == Side::Cutoff
        });
        surfaces
    }

    /// The half-space that a surface keeps of it.
    pub(super) fn half_space(&self, surface: &Surface) -> HalfSpace<T> {
        surface_half_space(surface, &self.ellipsoid())
    }

    /// What is left of the region where its side is [`Side::Cutoff`].
    pub(super) fn left(&self) -> RegionRest<T> {
        self.reduced().without_implied(self.band())
    }

    /// How many surfaces pass through it, as far as it reaches, of those on which what is kept of it depends.
    pub(super) fn cutting_count(&self) -> usize {
        if self.side() != Side::Cutoff || !self.clip.is_general() {
            return self.cutting_surfaces().len();
        }
        match self.reduced() {
            RegionRest::Cut(surfaces) => surfaces.len(),
            RegionRest::Decided(_) => 0,
        }
    }

    fn reduced(&self) -> RegionRest<T> {
        reduced(&self.ellipsoid(), self.band(), self.clip, self.settings)
    }

    fn ellipsoid(&self) -> Ellipsoid<T> {
        Ellipsoid::new(self.scene, self.index, self.footprint.axes)
    }

    /// Half width of the band in which a surface cuts, standard deviations, with what perspective adds to it.
    fn band(&self) -> T {
        if self.settings.mode == Mode::Exact && self.is_beam() {
            return beam_band(self.footprint);
        }
        clip::band(self.footprint.reach, self.settings)
    }

    /// True when a splat is too large or too far off the axis for the affine form. An eye within the splat makes it too
    /// large: its depth is then less than K < 3.4 deviations. In an orthographic view the affine form is exact for all
    /// splats.
    pub(super) fn is_beam(&self) -> bool {
        let footprint = self.footprint;
        if footprint.projection == Projection::Orthographic {
            return false;
        }
        match self.settings.form {
            ExactForm::Beam => true,
            ExactForm::Affine => false,
            ExactForm::Auto => {
                let largest = self.scene.scales()[self.index].max_element();
                let sigma_max = footprint.unit * T::of(f64::from(largest));
                let large = sigma_max / footprint.view_centre.z
                    > T::of(f64::from(self.settings.precision.beam_switch));
                large || footprint.clamped
            }
        }
    }
}

/// Half width of the band of a splat whose weight follows each pixel's true ray. The footprint is linear: a pixel at
/// `delta` sees the point u with `B u = delta`. The ray of the same pixel holds the points with
/// `B u = delta (1 + e . u)`, with the lean e, among them `u / (1 - e . u)` of that same u.
/// So no ray within K deviations passes farther than `K / (1 - K |e|)`. Where the splat reaches around the eye that has
/// no bound, but all rays pass through the eye; [`BEYOND_EYE`] deviations beyond it nothing counts.
fn beam_band<T: Real>(footprint: &Footprint<T>) -> T {
    let depth_share = footprint.rows[2].length() / footprint.view_centre.z;
    let rest = T::one() - footprint.reach * footprint.stretch * depth_share;
    if rest > T::of(f64::from(WIDENING_REST)) {
        return footprint.reach * footprint.stretch / rest;
    }
    let eye = footprint
        .axes
        .map(|axis| axis.dot(footprint.relative) / axis.dot(axis));
    let eye = vec3(eye[0], eye[1], eye[2]).length();
    // A splat without thickness has its eye nowhere: every plane may cut it.
    if eye.is_nan() {
        T::infinity()
    } else {
        eye + T::of(f64::from(BEYOND_EYE))
    }
}

/// How many of a scene's Gaussians a plane through its middle cuts, by either band.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Bands {
    /// The share that is called cut here: within K deviations along the normal, with K where alpha falls to 1/255.
    pub ours: f64,
    /// The share that the paper calls cut: within three times the largest deviation.
    pub paper: f64,
}

/// The mean over planes through the median centre, whose normals are the 13 axes of the cube (through faces, edges and
/// corners). Gaussians fainter than 1/255 do not count; there is no camera that could leave others out of sight.
pub fn bands(scene: &Gaussians) -> Bands {
    let steps = [-1.0, 0.0, 1.0];
    let all = steps
        .iter()
        .flat_map(|&x| steps.map(|y| (x, y)))
        .flat_map(|(x, y)| steps.map(|z| DVec3::new(x, y, z)));
    // The first 13 of 27 are the opposites of the last 13.
    let normals = all.skip(14).map(DVec3::normalize);
    let (mut ours, mut paper, mut total) = (0_usize, 0_usize, 0_usize);
    for normal in normals {
        let along = scene
            .positions()
            .iter()
            .map(|p| normal.dot(p.as_dvec3()))
            .collect::<Vec<_>>();
        let mut sorted = along.clone();
        sorted.sort_unstable_by(f64::total_cmp);
        let middle = sorted.get(sorted.len() / 2).copied().unwrap_or(0.0);
        for (index, distance) in along.iter().map(|x| (x - middle).abs()).enumerate() {
            let brightness = f64::from(scene.opacities()[index]) * f64::from(ALPHA_MIN_INVERSE);
            if brightness < 1.0 {
                continue;
            }
            let scales = scene.scales()[index].as_dvec3();
            let local = scene.rotations()[index].as_dquat().inverse() * normal;
            let reach = (2.0 * brightness.ln()).sqrt();
            total += 1;
            ours += usize::from(distance < reach * (local * scales).length());
            paper += usize::from(distance < 3.0 * scales.max_element());
        }
    }
    let share = |count: usize| count as f64 / total.max(1) as f64;
    Bands {
        ours: share(ours),
        paper: share(paper),
    }
}
