//! The scene in memory: one array per attribute, as the file had them but in the units the renderer works in.

use bytemuck::allocation::try_zeroed_vec;
use glam::{DVec3, Quat, Vec3};

use super::training::Training;
use super::{SH_0, picture};
use rara_base::counted::counted;
use rara_base::error::{Error, Result};

/// The highest degree of spherical harmonics.
pub(super) const MAX_SH_DEGREE: u32 = 3;
/// How far the square of a rotation's length may be from one. Rounded ones are within 1e-6; unnormalised ones are not.
const UNIT: f32 = 1e-3;

/// A set of 3D Gaussians, one array per attribute.
///
/// [`new`](Self::new) takes them as whole arrays, [`push`](Self::push) one by one, and files are read by
/// [`scene::load`](crate::load). The arrays always have matching lengths. Everything in them is finite, rotations are unit
/// quaternions, scales are not negative and opacities between 0 and 1: the loaders repair or drop what is not and report it,
/// and `new` refuses it, so that no later stage has to ask.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Gaussians(GaussianArrays);

/// The arrays that [`Gaussians`] are made of, all of the same length except [`sh`](Self::sh).
#[derive(Debug, Clone, Default, PartialEq)]
pub struct GaussianArrays {
    /// The point that the centres are relative to: see [`Gaussians::origin`].
    pub origin: DVec3,
    /// The centres, in world units from the origin.
    pub positions: Vec<Vec3>,
    /// The standard deviations along each Gaussian's own axes, in world units (not logarithms). Zero is allowed.
    pub scales: Vec<Vec3>,
    /// The rotations from each Gaussian's own axes to the world, as unit quaternions.
    pub rotations: Vec<Quat>,
    /// The opacities at the centres, 0 to 1 (not logits).
    pub opacities: Vec<f32>,
    /// Degree of the spherical harmonics, 0 to 3.
    pub sh_degree: u32,
    /// The spherical harmonics, `[Gaussian][coefficient][r, g, b]`, with `(sh_degree + 1)^2` coefficients per Gaussian.
    pub sh: Vec<f32>,
    /// How they were trained.
    pub training: Training,
}

impl Gaussians {
    /// Makes Gaussians of whole arrays.
    ///
    /// # Errors
    /// [`Error::Invalid`] names the array whose length is not that of `positions`, or the first number in it that cannot
    /// be drawn: one that is not finite, a negative scale, a rotation that is no unit quaternion, an opacity that is not
    /// between 0 and 1; or says that the low-pass is one that cannot be drawn.
    pub fn new(arrays: GaussianArrays) -> Result<Self> {
        arrays.check().map_err(Error::Invalid)?;
        Ok(Self(arrays))
    }

    /// Gaussians of arrays that are known to fit.
    pub(super) fn of_fitting(arrays: GaussianArrays) -> Self {
        Self(arrays)
    }

    /// An empty set of degree `sh_degree` with room for exactly `count`; `None` if there is not enough memory.
    pub(super) fn with_room(count: usize, sh_degree: u32) -> Option<Self> {
        let numbers = count.checked_mul(3 * sh_coefficients(sh_degree))?;
        let mut arrays = GaussianArrays {
            sh_degree,
            ..GaussianArrays::default()
        };
        arrays.positions.try_reserve_exact(count).ok()?;
        arrays.scales.try_reserve_exact(count).ok()?;
        arrays.rotations.try_reserve_exact(count).ok()?;
        arrays.opacities.try_reserve_exact(count).ok()?;
        arrays.sh.try_reserve_exact(numbers).ok()?;
        Some(Self(arrays))
    }

    /// Returns the arrays, which can be changed and made into Gaussians again.
    pub fn into_arrays(self) -> GaussianArrays {
        self.0
    }

    /// The arrays.
    #[doc(hidden)]
    pub fn arrays(&self) -> &GaussianArrays {
        &self.0
    }

    /// The arrays, of which the numbers may be changed and not the lengths.
    pub(super) fn arrays_mut(&mut self) -> &mut GaussianArrays {
        &mut self.0
    }

    /// Number of Gaussians.
    pub fn len(&self) -> usize {
        self.0.positions.len()
    }

    /// Returns true if there are no Gaussians.
    pub fn is_empty(&self) -> bool {
        self.0.positions.is_empty()
    }

    /// Returns the point that the centres are relative to, in world units. A centre is at `origin + position`. The origin is
    /// zero if single precision is enough for the centres. Far from zero, as in coordinates of a map, it is a point near all
    /// centres, in double precision. All functions that take a [layer](crate::Layer) add it, and so does
    /// [`centre`](Self::centre). Loaders set it.
    pub fn origin(&self) -> DVec3 {
        self.0.origin
    }

    /// Returns the centre of one Gaussian, in world units.
    pub fn centre(&self, index: usize) -> DVec3 {
        self.0.origin + self.0.positions[index].as_dvec3()
    }

    /// Sets the origin, which moves all Gaussians at once without rounding: see [`origin`](Self::origin).
    ///
    /// # Errors
    /// [`Error::Invalid`] where it is not finite.
    pub fn set_origin(&mut self, origin: DVec3) -> Result<()> {
        check_origin(origin).map_err(Error::Invalid)?;
        self.0.origin = origin;
        Ok(())
    }

    /// Centres, world units from the [origin](Self::origin).
    pub fn positions(&self) -> &[Vec3] {
        &self.0.positions
    }

    /// Standard deviations along the Gaussians' own axes, world units (linear, not logarithms).
    pub fn scales(&self) -> &[Vec3] {
        &self.0.scales
    }

    /// Rotations from the Gaussians' own axes to the world, unit quaternions.
    pub fn rotations(&self) -> &[Quat] {
        &self.0.rotations
    }

    /// Opacities at the centres, 0 to 1 (not logits).
    pub fn opacities(&self) -> &[f32] {
        &self.0.opacities
    }

    /// Degree of the spherical harmonics, 0 to 3.
    pub fn sh_degree(&self) -> u32 {
        self.0.sh_degree
    }

    /// Spherical harmonics, `[Gaussian][coefficient][r, g, b]`.
    pub fn sh(&self) -> &[f32] {
        &self.0.sh
    }

    /// Returns true if the Gaussians were trained antialiased, as by `--antialiasing` of 3DGS, `rasterize_mode antialiased` of
    /// gsplat and nerfstudio, or Mip-Splatting. Each is then drawn with its opacity multiplied by `sqrt(max(det S / det (S + L
    /// I), 0.000025))`, with the covariance `S` of its footprint and the [low-pass](Self::low_pass) L, square pixels: what the
    /// low-pass makes larger than it is gets no brighter for it. Others are drawn as opaque as they are. Loaders find it in
    /// files that say so.
    pub fn is_antialiased(&self) -> bool {
        self.0.training.antialiased
    }

    /// Returns the low-pass: the variance, in square pixels, that is added to each footprint along both axes of the picture.
    /// Gaussians look as they did in training with the low-pass of their trainer: 0.3, as in 3DGS, gsplat and nerfstudio, or
    /// 0.1, as in Mip-Splatting and in Brush where that trains antialiased. Loaders find it in files that say so, and by who
    /// wrote them.
    pub fn low_pass(&self) -> f32 {
        self.0.training.low_pass
    }

    /// How they were trained.
    pub fn training(&self) -> Training {
        self.0.training
    }

    /// Sets whether the Gaussians of this set were trained antialiased.
    pub fn set_antialiased(&mut self, antialiased: bool) {
        self.0.training.antialiased = antialiased;
    }

    /// Sets how the Gaussians of this set were trained.
    ///
    /// # Errors
    /// [`Error::Invalid`] where the low-pass is one that cannot be drawn.
    pub fn set_training(&mut self, training: Training) -> Result<()> {
        training.check().map_err(Error::Invalid)?;
        self.0.training = training;
        Ok(())
    }

    /// An empty set of the degree, the training and the origin of this one.
    #[doc(hidden)]
    pub fn empty_like(&self) -> Self {
        Self(GaussianArrays {
            sh_degree: self.0.sh_degree,
            training: self.0.training,
            origin: self.0.origin,
            ..GaussianArrays::default()
        })
    }

    /// What is added to positions that are relative to this origin, to make them relative to that of others.
    #[doc(hidden)]
    pub fn shift_to(&self, other: &Gaussians) -> DVec3 {
        self.0.origin - other.0.origin
    }

    /// Says that they were trained in a way that can be drawn.
    #[cfg_attr(not(feature = "formats"), allow(dead_code))]
    pub(super) fn train(&mut self, training: Training) {
        self.0.training = training;
    }

    /// Returns the centres, to change them. The numbers that are written here and through the methods below are not checked. A
    /// number that [`new`](Self::new) would refuse can make its own Gaussian look wrong or vanish, but no other one.
    pub fn positions_mut(&mut self) -> &mut [Vec3] {
        &mut self.0.positions
    }

    /// Returns the standard deviations, to change them.
    pub fn scales_mut(&mut self) -> &mut [Vec3] {
        &mut self.0.scales
    }

    /// Returns the rotations, to change them.
    pub fn rotations_mut(&mut self) -> &mut [Quat] {
        &mut self.0.rotations
    }

    /// Returns the opacities, to change them.
    pub fn opacities_mut(&mut self) -> &mut [f32] {
        &mut self.0.opacities
    }

    /// Returns the spherical harmonics, to change them.
    pub fn sh_mut(&mut self) -> &mut [f32] {
        &mut self.0.sh
    }

    /// Mixes a colour, red, green and blue from 0 to 1, into that of all Gaussians: with a share of 0 nothing changes, and with 1
    /// each has this colour from all sides.
    pub fn tint(&mut self, colour: [f32; 3], share: f32) {
        let constants = colour.map(|stored| {
            let seen = match self.training().linear {
                true => picture::linear_light(stored),
                false => stored,
            };
            ((f64::from(seen) - 0.5) / SH_0) as f32
        });
        let numbers = 3 * self.sh_coefficients();
        for sh in self.0.sh.chunks_exact_mut(numbers) {
            sh.iter_mut().for_each(|value| *value *= 1.0 - share);
            for (value, constant) in sh.iter_mut().zip(constants) {
                *value += share * constant;
            }
        }
    }

    /// Returns the number of coefficients per colour channel: `(sh_degree + 1)^2`.
    pub fn sh_coefficients(&self) -> usize {
        sh_coefficients(self.0.sh_degree)
    }

    /// The spherical harmonics of one Gaussian, `[coefficient][r, g, b]`.
    pub fn sh_of(&self, index: usize) -> &[f32] {
        let stride = 3 * self.sh_coefficients();
        &self.0.sh[index * stride..][..stride]
    }

    /// Appends a Gaussian, whose numbers are not checked, as with [`positions_mut`](Self::positions_mut). `sh` is
    /// `[coefficient][r, g, b]`.
    ///
    /// # Panics
    /// If `sh` is not of these Gaussians' degree.
    pub fn push(&mut self, position: Vec3, scale: Vec3, rotation: Quat, opacity: f32, sh: &[f32]) {
        let numbers = 3 * self.sh_coefficients();
        assert!(
            sh.len() == numbers,
            "{} cannot be spherical harmonics of degree {}, which have {numbers}",
            counted(sh.len(), "number"),
            self.0.sh_degree
        );
        self.0.positions.push(position);
        self.0.scales.push(scale);
        self.0.rotations.push(rotation);
        self.0.opacities.push(opacity);
        self.0.sh.extend_from_slice(sh);
    }

    /// Drops all Gaussians but the first `count`. If there are no more, nothing happens.
    pub fn truncate(&mut self, count: usize) {
        let numbers = count.saturating_mul(3 * self.sh_coefficients());
        self.0.positions.truncate(count);
        self.0.scales.truncate(count);
        self.0.rotations.truncate(count);
        self.0.opacities.truncate(count);
        self.0.sh.truncate(numbers);
    }

    /// Appends `other`, raising both to the higher spherical-harmonics degree (the missing coefficients are zero). A set is
    /// [trained](Self::training) in one way: the first Gaussians say in which, and others are drawn like them.
    pub fn append(&mut self, other: &Gaussians) {
        if self.is_empty() {
            self.0.training = other.0.training;
            self.0.origin = other.0.origin;
        }
        let degree = if self.is_empty() {
            other.0.sh_degree
        } else {
            self.0.sh_degree.max(other.0.sh_degree)
        };
        self.set_sh_degree(degree);
        let shift = other.shift_to(self);
        let moved = |position: &Vec3| (position.as_dvec3() + shift).as_vec3();
        self.0.positions.extend(other.0.positions.iter().map(moved));
        self.0.scales.extend_from_slice(&other.0.scales);
        self.0.rotations.extend_from_slice(&other.0.rotations);
        self.0.opacities.extend_from_slice(&other.0.opacities);
        if other.0.sh_degree == degree {
            self.0.sh.extend_from_slice(&other.0.sh);
        } else {
            let mut raised = other.clone();
            raised.set_sh_degree(degree);
            self.0.sh.extend_from_slice(&raised.0.sh);
        }
    }

    /// Appends `other` as [`append`](Self::append) does; `None` if there is no memory for it.
    #[cfg_attr(not(feature = "formats"), allow(dead_code))]
    pub(super) fn try_append(&mut self, other: &Gaussians) -> Option<()> {
        let (count, arrays) = (other.len(), &mut self.0);
        arrays.positions.try_reserve(count).ok()?;
        arrays.scales.try_reserve(count).ok()?;
        arrays.rotations.try_reserve(count).ok()?;
        arrays.opacities.try_reserve(count).ok()?;
        let numbers = 3 * sh_coefficients(arrays.sh_degree.max(other.0.sh_degree));
        arrays.sh.try_reserve(count.checked_mul(numbers)?).ok()?;
        self.append(other);
        Some(())
    }

    /// Keeps those of these numbers, which ascend.
    pub(super) fn keep(&mut self, numbers: &[u32]) {
        self.0.keep(numbers);
    }

    /// Refuses what cannot be drawn, as [`new`](Self::new) does.
    #[cfg_attr(not(feature = "formats"), allow(dead_code))]
    pub(super) fn check(&self) -> Result<()> {
        self.0.check().map_err(Error::Invalid)
    }

    /// Changes the degree: higher coefficients are dropped, missing ones are zero.
    ///
    /// # Panics
    /// If `degree` is above 3.
    pub fn set_sh_degree(&mut self, degree: u32) {
        assert!(
            degree <= MAX_SH_DEGREE,
            "spherical harmonics of degree {degree} cannot be drawn: 0 to {MAX_SH_DEGREE} can"
        );
        let (old, new) = (3 * self.sh_coefficients(), 3 * sh_coefficients(degree));
        if old != new {
            let mut sh = vec![0.0; self.len() * new];
            let kept = old.min(new);
            for (to, from) in sh.chunks_exact_mut(new).zip(self.0.sh.chunks_exact(old)) {
                to[..kept].copy_from_slice(&from[..kept]);
            }
            self.0.sh = sh;
        }
        self.0.sh_degree = degree;
    }
}

fn check_origin(origin: DVec3) -> std::result::Result<(), String> {
    match origin.is_finite() {
        true => Ok(()),
        false => Err(format!("the origin is {origin}, which is not finite")),
    }
}

impl GaussianArrays {
    /// Arrays of zeros for exactly `count`, of which memory is taken only where they are written; `None` if there is not
    /// enough.
    #[cfg_attr(not(feature = "formats"), allow(dead_code))]
    pub(super) fn zeroed(count: usize, sh_degree: u32) -> Option<Self> {
        let numbers = count.checked_mul(3 * sh_coefficients(sh_degree))?;
        Some(Self {
            origin: DVec3::ZERO,
            positions: try_zeroed_vec(count).ok()?,
            scales: try_zeroed_vec(count).ok()?,
            rotations: try_zeroed_vec(count).ok()?,
            opacities: try_zeroed_vec(count).ok()?,
            sh_degree,
            sh: try_zeroed_vec(numbers).ok()?,
            training: Training::default(),
        })
    }

    fn check(&self) -> std::result::Result<(), String> {
        self.training.check()?;
        check_origin(self.origin)?;
        if self.sh_degree > MAX_SH_DEGREE {
            let degree = self.sh_degree;
            return Err(format!(
                "sh_degree is {degree}; it must be from 0 to {MAX_SH_DEGREE}"
            ));
        }
        let count = self.positions.len();
        let numbers = 3 * sh_coefficients(self.sh_degree);
        for (array, found, expected) in [
            ("scales", self.scales.len(), Some(count)),
            ("rotations", self.rotations.len(), Some(count)),
            ("opacities", self.opacities.len(), Some(count)),
            ("sh", self.sh.len(), count.checked_mul(numbers)),
        ] {
            if Some(found) != expected {
                let each = if array == "sh" {
                    format!(", each {} of {array}", counted(numbers, "number"))
                } else {
                    String::new()
                };
                return Err(format!(
                    "{array} has {}, which do not fit {count} positions{each}",
                    counted(found, "element")
                ));
            }
        }
        refuse("positions", &self.positions, "not finite", |p| {
            p.is_finite()
        })?;
        refuse(
            "scales",
            &self.scales,
            "not finite and zero or above; logarithms are exponentiated first",
            |s| s.is_finite() && s.min_element() >= 0.0,
        )?;
        refuse(
            "rotations",
            &self.rotations,
            "no unit quaternion; normalise it first",
            |q| (q.length_squared() - 1.0).abs() <= UNIT,
        )?;
        refuse(
            "opacities",
            &self.opacities,
            "not between 0 and 1; logits go through the sigmoid first",
            |o| (0.0..=1.0).contains(o),
        )?;
        refuse("sh", &self.sh, "not finite", |v| v.is_finite())
    }
}

/// An error for the first element that is not `fit`.
fn refuse<T: std::fmt::Debug>(
    array: &str,
    elements: &[T],
    problem: &str,
    fit: impl Fn(&T) -> bool,
) -> std::result::Result<(), String> {
    match elements.iter().position(|element| !fit(element)) {
        Some(at) => Err(format!(
            "{array}[{at}] is {:?}: that is {problem}",
            elements[at]
        )),
        None => Ok(()),
    }
}

/// Returns the number of coefficients per colour channel for spherical harmonics up to `degree`.
pub const fn sh_coefficients(degree: u32) -> usize {
    ((degree + 1) * (degree + 1)) as usize
}

/// Returns the coefficient of the constant spherical harmonic with which a channel has a colour from 0 to 1.
pub fn sh_of_colour(colour: f32) -> f32 {
    ((f64::from(colour) - 0.5) / SH_0) as f32
}

#[cfg(test)]
mod tests;
