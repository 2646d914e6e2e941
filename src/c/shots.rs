//! Cameras for pictures of a scene, and what belongs to them: a camera that shows all that is visible, orbits, paths, sections,
//! slices and panoramas.

use rara::ash::vk;
use rara::glam::DVec3;
use rara::scene::cross_section;
use rara::{Camera, Error, Picture, Result, Scene};
use rara_shots::{Framing, Lens, Orbit, Panorama, Sections, Spline, Visible};

use crate::boundary::{RaraResult, guard, invalid, list, read_list, shared, write};
use crate::camera::{self, NOWHERE, RaraCamera, make, vector};
use crate::clip::RaraPlane;
use crate::gaussians::RaraGaussians;
use crate::handles::{alive, create};
use crate::layer::{RaraLayer, given};
use crate::scene::{numbers_of, of_layers};

/// A camera that shows all that is visible of the layers of a scene, from the front, the right and above, as near as possible.
/// Stray splats far from the rest do not count, and neither do clips, so that pictures with and without a clip have the same
/// camera. `up` and `fov_y` are as for rara_camera_look_at, and the layers as for rara_scene_buffers_upload.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_camera_frame_visible(
    layers: *const RaraLayer,
    layer_count: usize,
    up: *const f64,
    fov_y: f64,
    width: u32,
    height: u32,
    camera: *mut RaraCamera,
    camera_size: usize,
) -> RaraResult {
    make(camera, camera_size, || {
        let framing = Framing::new(Lens::Perspective(fov_y), (width, height)).up(vector(up, "up")?);
        seen(layers, layer_count, |scene| {
            framing.camera(&Visible::of(scene))
        })
    })
}

/// The camera of a section: without perspective, square on to a plane from the side that it cuts away, with all that is visible
/// of the layers in the picture, also behind the plane. Give rara_renderer_configure a clip of the plane, and of a second one
/// for a slab; the pictures of all planes with one normal have the same scale. `up` is three numbers that point up in the
/// picture, not along the normal.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_camera_section(
    layers: *const RaraLayer,
    layer_count: usize,
    plane: *const RaraPlane,
    up: *const f64,
    width: u32,
    height: u32,
    camera: *mut RaraCamera,
    camera_size: usize,
) -> RaraResult {
    make(camera, camera_size, || {
        let (plane, up) = (shared(plane, "plane")?.plane("plane")?, vector(up, "up")?);
        let sections = Sections::new((width, height)).up(Some(up));
        let section = |scene: &Scene<'_>| sections.at(plane, &Visible::nearly_all_of(scene));
        seen(layers, layer_count, |scene| Ok(section(scene)?.camera))
    })
}

/// Writes `count` cameras of an orbit, one after the other, at `cameras`: `camera` turned about the axis through the point
/// `pivot`, each three numbers in world units. `turns` below zero turn to the left. Whole turns are closed: the camera after the
/// last would be the first. `camera_size` is sizeof *cameras.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_cameras_orbit(
    camera: *const RaraCamera,
    pivot: *const f64,
    axis: *const f64,
    turns: f64,
    count: u32,
    cameras: *mut RaraCamera,
    camera_size: usize,
) -> RaraResult {
    guard(|| {
        let (pivot, axis) = (vector(pivot, "pivot")?, vector(axis, "axis")?);
        let given = camera::camera(camera)?;
        if !pivot.is_finite() || !axis.is_finite() || axis == DVec3::ZERO || !turns.is_finite() {
            return invalid(format!(
                "pivot is {pivot}, axis is {axis} and turns is {turns}: give finite numbers, and an axis with a length"
            ));
        }
        let orbit = Orbit::new(turns, count);
        write_all(cameras, camera_size, || {
            Ok(orbit.cameras(given, (pivot, axis)))
        })
    })
}

/// Writes `count` cameras, one after the other, at `cameras`: those of a smooth path through others at an even pace, closed or
/// from the first to the last. The cameras that it goes through are all of one struct_size, picture size and projection, and two
/// of them stand in different places. `camera_size` is sizeof *cameras.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_cameras_path(
    through: *const RaraCamera,
    through_count: usize,
    closed: vk::Bool32,
    count: u32,
    cameras: *mut RaraCamera,
    camera_size: usize,
) -> RaraResult {
    guard(|| {
        let through = read_list(through, through_count, NOWHERE, "through")?;
        let named = |(index, camera): (usize, &RaraCamera)| {
            let made = camera.camera();
            made.map_err(|error| Error::Invalid(format!("through[{index}]: {error}")))
        };
        let through: Vec<_> = through
            .iter()
            .enumerate()
            .map(named)
            .collect::<Result<_>>()?;
        let path = Spline::through(&through, closed != 0)?;
        write_all(cameras, camera_size, || Ok(path.cameras(count)))
    })
}

/// Writes the cameras of the six pictures of a panorama, one after the other, at `cameras`: squares to the front, right, back,
/// left, up and down of `camera`, which overlap a little. The panorama is `width` pixels wide and half as high. `camera_size` is
/// sizeof *cameras.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_cameras_panorama(
    camera: *const RaraCamera,
    width: u32,
    cameras: *mut RaraCamera,
    camera_size: usize,
) -> RaraResult {
    guard(|| {
        let middle = camera::camera(camera)?;
        write_all(cameras, camera_size, || Ok(panorama(width)?.faces(&middle)))
    })
}

/// Puts the six pictures of rara_cameras_panorama together, given in their order: four floats a pixel, the colour multiplied by
/// the alpha, row by row from the top without gaps. `pixels` is filled likewise: width * (width / 2) * 4 floats, longitudes
/// across with the direction of view in the middle, latitudes down.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_panorama_assemble(
    width: u32,
    faces: *const *const f32,
    pixels: *mut f32,
) -> RaraResult {
    guard(|| {
        let faces = list(faces, 6, "faces")?;
        shared(pixels.cast_const(), "pixels")?;
        let panorama = panorama(width)?;
        let anywhere = Camera::look_at(DVec3::ZERO, DVec3::Z, DVec3::NEG_Y, 90.0, (1, 1))?;
        let sides = panorama.faces(&anywhere);
        let mut pictures = sides.map(|side| Picture::filled(side.width, side.height, [0.0; 4]));
        for (index, (picture, &face)) in pictures.iter_mut().zip(faces).enumerate() {
            let floats = 4 * picture.pixels.len();
            let face = list(face, floats, &format!("faces[{index}]"))?;
            for (pixel, floats) in picture.pixels.iter_mut().zip(face.as_chunks().0) {
                *pixel = *floats;
            }
        }
        let made = panorama.assembled(&pictures);
        let made = made.pixels.as_flattened();
        std::ptr::copy_nonoverlapping(made.as_ptr(), pixels, made.len());
        Ok(())
    })
}

/// Makes the cross-sections of Gaussians by a plane: flat Gaussians on the plane, each as opaque there as the one that it is of.
/// The plane is where the Gaussians were made, before any placement. Draw them with RARA_SHOW_MEAN by the camera of
/// rara_camera_section: a pixel then has the mean of their colours, weighted by their opacities.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_gaussians_cross_section(
    gaussians: *const RaraGaussians,
    plane: *const RaraPlane,
    flat: *mut *mut RaraGaussians,
) -> RaraResult {
    create(flat, "flat", || {
        let (gaussians, plane) = (
            alive(gaussians, "gaussians")?,
            shared(plane, "plane")?.plane("plane")?,
        );
        let origin = gaussians.gaussians.origin();
        let plane = rara::Plane::new(plane.normal(), plane.distance(origin))?;
        Ok(cross_section(&gaussians.gaussians, &plane).into())
    })
}

fn panorama(width: u32) -> Result<Panorama> {
    Panorama::new((width, width / 2))
}

/// Finds something in the scene of a host's layers.
unsafe fn seen<T>(
    layers: *const RaraLayer,
    layer_count: usize,
    find: impl FnOnce(&Scene<'_>) -> Result<T>,
) -> Result<T> {
    let layers = given(layers, layer_count)?;
    let numbers = numbers_of(&layers);
    find(&of_layers(&layers, &numbers))
}

/// Makes cameras, and writes them one after the other where a host has room for them. Room that is null is named before any is
/// made.
unsafe fn write_all<C: AsRef<[Camera]>>(
    to: *mut RaraCamera,
    camera_size: usize,
    made: impl FnOnce() -> Result<C>,
) -> Result<()> {
    shared(to.cast_const().cast::<u8>(), "cameras")?;
    for (index, &camera) in made()?.as_ref().iter().enumerate() {
        let place = to.byte_add(index * camera_size);
        write(place, camera_size, &camera.into(), "cameras")?;
    }
    Ok(())
}

#[cfg(test)]
mod tests;
