//! Gaussians from a host's own arrays.

use rara::Training;
use rara::ash::vk;
use rara::glam::{Quat, Vec3};
use rara::{Error, GaussianArrays, Gaussians, Result};

use crate::boundary::{RaraResult, Versioned, guard, invalid, read, versioned, write};
use crate::gaussians::RaraGaussians;
use crate::handles::create;

/// A host's Gaussians, as it has them in memory: each attribute an array, or a field of its own structs. A stride is the
/// bytes from one Gaussian's numbers to the next one's; 0, the default, stands for numbers without a gap. Nothing has to be
/// aligned, and only the call itself reads it.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct RaraGaussianArrays {
    /// Set by rara_gaussian_arrays_default.
    pub struct_size: usize,
    /// How many Gaussians there are. Where there are none the pointers may be null.
    pub count: usize,
    /// Centres, world units: 3 floats a Gaussian.
    pub positions: *const f32,
    /// Bytes from one centre to the next; 0 stands for 12.
    pub position_stride: usize,
    /// Standard deviations along the Gaussian's own axes, world units, not logarithms: 3 floats a Gaussian, zero or above.
    pub scales: *const f32,
    /// Bytes from one Gaussian's to the next one's; 0 stands for 12.
    pub scale_stride: usize,
    /// Unit quaternions x, y, z, w that turn the Gaussian's own axes to the world's: 4 floats a Gaussian. Files of 3DGS have w
    /// first.
    pub rotations: *const f32,
    /// Bytes from one quaternion to the next; 0 stands for 16.
    pub rotation_stride: usize,
    /// Opacities at the centre, 0 to 1, not logits: a float a Gaussian.
    pub opacities: *const f32,
    /// Bytes from one opacity to the next; 0 stands for 4.
    pub opacity_stride: usize,
    /// Degree of the spherical harmonics, 0 to 3. Default: 0.
    pub sh_degree: u32,
    /// Spherical harmonics: (sh_degree + 1)^2 coefficients per Gaussian, each red, green and blue, the constant one first.
    pub sh: *const f32,
    /// Bytes from one Gaussian's to the next one's; 0 stands for 12 (sh_degree + 1)^2.
    pub sh_stride: usize,
    /// True if the Gaussians were trained antialiased: see rara_gaussians_set_antialiased. Default: false.
    pub antialiased: vk::Bool32,
    /// The low-pass that they were trained with, square pixels: see rara_gaussians_set_low_pass. Default: 0, which is 0.3.
    pub low_pass: f32,
    /// The point that positions are relative to, world units, for scenes far from zero. Default: 0, 0, 0.
    pub origin: [f64; 3],
}

versioned!(RaraGaussianArrays);

/// No Gaussians, of degree 0, in arrays without gaps. `arrays_size` is sizeof *arrays.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_gaussian_arrays_default(
    arrays: *mut RaraGaussianArrays,
    arrays_size: usize,
) -> RaraResult {
    guard(|| write(arrays, arrays_size, &Versioned::BLANK, "arrays"))
}

/// Copies Gaussians from a host's arrays. RARA_ERROR_INVALID names the array and, where a number in it cannot be drawn (one
/// that is not finite, a negative scale, a rotation that is no unit quaternion, an opacity that is not between 0 and 1), the
/// element.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_gaussians_from_arrays(
    arrays: *const RaraGaussianArrays,
    gaussians: *mut *mut RaraGaussians,
) -> RaraResult {
    create(gaussians, "gaussians", || {
        let arrays = read(arrays, Versioned::BLANK, "arrays")?;
        let gaussians = Gaussians::new(arrays.copied()?).map_err(|error| {
            Error::Invalid(format!("arrays->{error}")) // which begins with the array's name
        })?;
        Ok(gaussians.into())
    })
}

impl RaraGaussianArrays {
    unsafe fn copied(&self) -> Result<GaussianArrays> {
        if self.sh_degree > 3 {
            return invalid(format!(
                "arrays->sh_degree is {}; it must be from 0 to 3",
                self.sh_degree
            ));
        }
        let coefficients = (self.sh_degree as usize + 1).pow(2);
        let array = |first, stride, name| Array {
            first,
            stride,
            count: self.count,
            name,
        };
        let vectors = |array: Array<'_>| array.copied(3, 1, |to, v| to.push(Vec3::from_slice(v)));
        let rotations = array(self.rotations, self.rotation_stride, "rotation");
        let opacities = array(self.opacities, self.opacity_stride, "opacity");
        let sh = array(self.sh, self.sh_stride, "sh");
        let floats = 3 * coefficients;
        Ok(GaussianArrays {
            origin: self.origin.into(),
            positions: vectors(array(self.positions, self.position_stride, "position"))?,
            scales: vectors(array(self.scales, self.scale_stride, "scale"))?,
            rotations: rotations.copied(4, 1, |to, v| to.push(Quat::from_slice(v)))?,
            opacities: opacities.copied(1, 1, |to, v| to.push(v[0]))?,
            sh_degree: self.sh_degree,
            sh: sh.copied(floats, floats, |to, v| to.extend_from_slice(v))?,
            training: Training::default()
                .antialiased(self.antialiased != vk::FALSE)
                .low_pass(match self.low_pass {
                    0.0 => Training::default().low_pass,
                    low_pass => low_pass,
                }),
        })
    }
}

/// One attribute of the Gaussians in a host's memory.
struct Array<'a> {
    first: *const f32,
    /// Bytes, 0 where there are no gaps.
    stride: usize,
    count: usize,
    /// The name of one element in messages.
    name: &'a str,
}

/// The most floats that an attribute of a Gaussian has.
const MOST: usize = 3 * 16;

impl Array<'_> {
    /// Copies so many floats of each Gaussian, of which `put` makes so many elements.
    unsafe fn copied<T>(
        &self,
        floats: usize,
        elements: usize,
        put: impl Fn(&mut Vec<T>, &[f32]),
    ) -> Result<Vec<T>> {
        let Self {
            first,
            stride,
            count,
            name,
        } = *self;
        if count == 0 {
            return Ok(Vec::new());
        }
        if first.is_null() {
            return invalid(format!("arrays->{} is null", plural(name)));
        }
        let bytes = floats * size_of::<f32>();
        let stride = if stride == 0 { bytes } else { stride };
        if stride < bytes {
            return invalid(format!(
                "arrays->{name}_stride is {stride}, and each has {bytes} bytes: give the bytes from one to the next, or 0"
            ));
        }
        if count
            .checked_mul(stride)
            .is_none_or(|all| all > isize::MAX as usize)
        {
            return invalid(format!(
                "arrays->count is {count}, which with arrays->{name}_stride is more than memory holds"
            ));
        }
        let mut copied = Vec::new();
        copied.try_reserve_exact(count * elements).map_err(|_| {
            Error::Memory(format!(
                "arrays->count is {count}: there is no room for so many {}",
                plural(name)
            ))
        })?;
        let mut one = [0.0; MOST];
        for index in 0..count {
            // SAFETY: the caller's promise; bytes are copied, so that nothing has to be aligned.
            unsafe {
                let from = first.byte_add(index * stride).cast::<u8>();
                std::ptr::copy_nonoverlapping(from, one.as_mut_ptr().cast::<u8>(), bytes);
            }
            put(&mut copied, &one[..floats]);
        }
        Ok(copied)
    }
}

/// The name of an array of these.
fn plural(name: &str) -> String {
    match name {
        "sh" => "sh".into(),
        "opacity" => "opacities".into(),
        _ => format!("{name}s"),
    }
}

#[cfg(test)]
mod tests;
