//! Panoramas: everything that is seen from one place, longitudes across and latitudes down.
//!
//! A panorama is resampled from six square pictures, each an ordinary frame, so that a clip is as exact as in any other. They
//! are half as many pixels wide as it is: in the middle of each the low-pass of the splats then blurs a pixel of the panorama
//! as much as one of an ordinary picture, resampling and all. Splats are projected by an approximation that differs between
//! the pictures, so they overlap a little, and one goes over into the other there.

use std::f64::consts::{FRAC_PI_2, PI};
use std::fmt;

use glam::{DMat3, DVec3};
use rara::{Camera, Error, Picture, Projection, Result};
use rara_base::parallel::in_parallel;

/// How far the pictures overlap on either side of the edge between two, as a share of half a picture.
const OVERLAP: f64 = 0.1;

/// Lines and columns of the places in a pixel whose mean it is.
const SAMPLES: u32 = 3;

/// An equirectangular picture of all directions.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Panorama {
    /// Pixels; it is half as high.
    width: u32,
}

/// What a picture shows, by its own axes in those of the panorama: right, down and forward.
const FACES: [(&str, [DVec3; 3]); 6] = [
    ("front", [DVec3::X, DVec3::Y, DVec3::Z]),
    ("right", [DVec3::NEG_Z, DVec3::Y, DVec3::X]),
    ("back", [DVec3::NEG_X, DVec3::Y, DVec3::NEG_Z]),
    ("left", [DVec3::Z, DVec3::Y, DVec3::NEG_X]),
    ("up", [DVec3::X, DVec3::Z, DVec3::NEG_Y]),
    ("down", [DVec3::X, DVec3::NEG_Z, DVec3::Y]),
];

/// The differences between the pictures of neighbouring faces of a panorama along their common edges, on a scale of 0 to 255.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Seams {
    /// The mean along all twelve edges.
    pub mean: f64,
    /// The largest difference anywhere.
    pub largest: f64,
}

impl Seams {
    /// Returns the seams of several panoramas together: the mean of all, and the largest of any; `None` if there is no
    /// panorama.
    pub fn together(all: &[Self]) -> Option<Self> {
        let largest = all.iter().map(|one| one.largest).reduce(f64::max)?;
        let mean = all.iter().map(|one| one.mean).sum::<f64>() / all.len() as f64;
        Some(Self { mean, largest })
    }
}

impl fmt::Display for Seams {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { mean, largest } = self;
        write!(
            f,
            "the six pictures of the panorama differ by {mean:.1} of 255 where they meet, and by {largest:.0} at most"
        )
    }
}

impl Panorama {
    /// Makes a panorama of this size, which must be twice as wide as high.
    ///
    /// # Errors
    /// [`Error::Invalid`] if it is not, or wider than [`Camera::MAX_SIZE`].
    pub fn new((width, height): (u32, u32)) -> Result<Self> {
        let most = Camera::MAX_SIZE;
        if u64::from(width) != 2 * u64::from(height) || height == 0 || width > most {
            return Err(Error::Invalid(format!(
                "a panorama cannot have the size {width}x{height}: give a size that is twice as wide as high, such as 2048x1024, and at most \
                 {most} pixels wide"
            )));
        }
        Ok(Self { width })
    }

    /// Returns the width and height of the panorama, in pixels.
    pub fn size(self) -> (u32, u32) {
        (self.width, self.width / 2)
    }

    /// Returns the number of pixels of all faces.
    pub fn face_pixels(self) -> u64 {
        let (half, margin) = self.half();
        let side = 2 * (half + margin) as u64;
        FACES.len() as u64 * side * side
    }

    /// Half of a picture's pixels that are within 45 degrees of its middle, and all beyond them on one side.
    fn half(self) -> (f64, f64) {
        let half = (f64::from(self.width) / 4.0).max(1.0).ceil();
        // Two pixels more, since a place in the outermost half has no neighbours.
        (half, (half * OVERLAP).ceil() + 2.0)
    }

    /// Returns the name of each face's direction, in the order of [`faces`](Self::faces).
    pub fn face_names() -> [&'static str; 6] {
        FACES.map(|(name, _)| name)
    }

    /// Returns the cameras of the six faces of a cube around a camera, with its position and axes. The direction of view of the
    /// camera is in the middle of the panorama.
    pub fn faces(self, camera: &Camera) -> [Camera; 6] {
        let (half, margin) = self.half();
        let side = 2.0 * (half + margin);
        FACES.map(|(_, own)| {
            camera
                .projection(Projection::Perspective)
                .width(side as u32)
                .height(side as u32)
                .fx(half)
                .fy(half)
                .cx(side / 2.0)
                .cy(side / 2.0)
                .rotation(DMat3::from_cols(own[0], own[1], own[2]).transpose() * camera.rotation)
        })
    }

    /// Returns the panorama that the pictures of its six faces make, given in their order.
    pub fn assembled(self, faces: &[Picture; 6]) -> Picture {
        let (width, height) = self.size();
        let mut panorama = Picture::filled(width, height, [0.0; 4]);
        let rows = panorama.pixels.chunks_mut(width as usize);
        in_parallel(rows.enumerate(), |(y, row)| {
            for (x, pixel) in row.iter_mut().enumerate() {
                *pixel = self.pixel(faces, (x, y));
            }
        });
        panorama
    }

    /// Returns how much the pictures of the six faces differ along the edges between them, in their premultiplied channels.
    pub fn seams(self, faces: &[Picture; 6]) -> Seams {
        let half = self.half().0;
        let steps = 2 * half as usize;
        let (mut sum, mut largest, mut count) = (0.0, 0.0_f64, 0);
        for (number, (_, own)) in FACES.iter().enumerate() {
            // Each edge is met from both of its sides, and counts from one.
            let others = FACES.iter().enumerate().skip(number + 1);
            for (other, (_, its)) in others.filter(|(_, (_, its))| own[2].dot(its[2]) == 0.0) {
                let along = own[2].cross(its[2]);
                for step in 0..steps {
                    let share = (step as f64 + 0.5) / half - 1.0;
                    let direction = own[2] + its[2] + share * along;
                    let seen = [(number, own), (other, its)].map(|(face, axes)| {
                        let picture = &faces[face];
                        let off = [axes[0], axes[1]].map(|axis| axis.dot(direction));
                        between(
                            picture,
                            off.map(|off| off * half + f64::from(picture.width) / 2.0),
                        )
                    });
                    let channels = seen[0].iter().zip(seen[1]);
                    let apart = channels.map(|(a, b)| f64::from((a - b).abs()));
                    let apart = 255.0 * apart.fold(0.0, f64::max);
                    (sum, largest, count) = (sum + apart, largest.max(apart), count + 1);
                }
            }
        }
        Seams {
            mean: sum / f64::from(count),
            largest,
        }
    }

    fn pixel(self, faces: &[Picture; 6], (x, y): (usize, usize)) -> [f32; 4] {
        let mut sum = [0.0; 4];
        for sample in 0..SAMPLES * SAMPLES {
            let within = |part: u32| (f64::from(part) + 0.5) / f64::from(SAMPLES);
            let at = (
                x as f64 + within(sample % SAMPLES),
                y as f64 + within(sample / SAMPLES),
            );
            let seen = self.seen(faces, self.direction(at));
            (0..4).for_each(|channel| sum[channel] += seen[channel]);
        }
        sum.map(|channel| channel / (SAMPLES * SAMPLES) as f32)
    }

    /// The direction of a place in the panorama, in its axes.
    fn direction(self, (x, y): (f64, f64)) -> DVec3 {
        let width = f64::from(self.width);
        let (east, north) = (
            (x / width - 0.5) * 2.0 * PI,
            FRAC_PI_2 - y / width * 2.0 * PI,
        );
        DVec3::new(
            north.cos() * east.sin(),
            -north.sin(),
            north.cos() * east.cos(),
        )
    }

    /// What the pictures show in a direction: where they overlap the mean, each by how far it is from its own end.
    fn seen(self, faces: &[Picture; 6], direction: DVec3) -> [f32; 4] {
        let half = self.half().0;
        let (mut sum, mut weights) = ([0.0_f32; 4], 0.0_f32);
        for ((_, own), picture) in FACES.iter().zip(faces) {
            let depth = own[2].dot(direction);
            let off = [own[0], own[1]].map(|axis| axis.dot(direction) / depth);
            let away = off[0].abs().max(off[1].abs());
            if depth <= 0.0 || away >= 1.0 + OVERLAP {
                continue;
            }
            let weight = ((1.0 + OVERLAP - away) / (2.0 * OVERLAP)).min(1.0) as f32;
            let middle = f64::from(picture.width) / 2.0;
            let seen = between(picture, off.map(|off| off * half + middle));
            (0..4).for_each(|channel| sum[channel] += weight * seen[channel]);
            weights += weight;
        }
        sum.map(|channel| channel / weights)
    }
}

/// Returns the camera without its tilt, so that the horizon is level. A camera that looks along `up` is returned as it is.
pub fn levelled(camera: Camera, up: DVec3) -> Camera {
    match level(camera.rotation, up) {
        Some(axes) => camera.rotation(axes),
        None => camera,
    }
}

/// Axes with the same right, or nearly so, whose down is against `up`; none where they look along it.
fn level(axes: DMat3, up: DVec3) -> Option<DMat3> {
    let down = -up.try_normalize()?;
    let right = down.cross(axes.row(2)).try_normalize()?;
    Some(DMat3::from_cols(right, down, right.cross(down)).transpose())
}

/// The pixel between its four neighbours, premultiplied as they are.
fn between(picture: &Picture, [x, y]: [f64; 2]) -> [f32; 4] {
    let (x, y) = (x - 0.5, y - 0.5);
    let (left, top) = (x.floor(), y.floor());
    let (right, below) = ((x - left) as f32, (y - top) as f32);
    let at = |dx: u32, dy: u32| {
        let clamped = |from: f64, off: u32, side: u32| (from as u32 + off).min(side - 1);
        picture.at(
            clamped(left, dx, picture.width),
            clamped(top, dy, picture.height),
        )
    };
    let neighbours = [at(0, 0), at(1, 0), at(0, 1), at(1, 1)];
    std::array::from_fn(|channel| {
        let [a, b, c, d] = neighbours.map(|pixel| pixel[channel]);
        let (upper, lower) = (a + (b - a) * right, c + (d - c) * right);
        upper + (lower - upper) * below
    })
}

#[cfg(test)]
mod tests;
