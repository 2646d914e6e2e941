//! `--panorama`: everything that is seen from one place, longitudes across and latitudes down.
//!
//! A panorama is resampled from six square pictures, each an ordinary frame, so that a clip is as exact as in any other. They
//! are half as many pixels wide as it is: in the middle of each the low-pass of the splats then blurs a pixel of the panorama
//! as much as one of an ordinary picture, resampling and all. Splats are projected by an approximation that differs between
//! the pictures, so they overlap a little, and one goes over into the other there.

use std::f64::consts::{FRAC_PI_2, PI};

use clap::Args;
use glam::{DMat3, DVec3};
use rara::{Camera, Picture, Projection};
use rara_base::parallel::in_parallel;

use super::failure::Failure;
use super::views::NamedView;

/// A picture of all directions.
#[derive(Debug, Args)]
#[command(next_help_heading = "Paths, films and panoramas")]
pub(super) struct PanoramaArgs {
    /// Draw everything that is seen from --eye, twice as wide as high
    ///
    /// The picture is equirectangular [default: 2048x1024], and what the camera looks at is in its middle. The
    /// place may also be a camera of a file or of a path.
    #[arg(long, conflicts_with_all = ["ortho", "fov_y", "section", "aov", "clip_near", "clip_far", "near_cut"])]
    panorama: bool,
}

const MOST: u32 = Camera::MAX_SIZE;

const SIZE: (u32, u32) = (2048, 1024);

/// How far the pictures overlap on either side of the edge between two, as a share of half a picture.
const OVERLAP: f64 = 0.1;

/// Lines and columns of the places in a pixel whose mean it is.
const SAMPLES: u32 = 3;

impl PanoramaArgs {
    /// The panorama that is asked for. `size` is that of the flags.
    pub(super) fn meant(&self, size: Option<(u32, u32)>) -> Result<Option<Panorama>, Failure> {
        let (width, height) = size.unwrap_or(SIZE);
        if !self.panorama {
            return Ok(None);
        }
        if u64::from(width) != 2 * u64::from(height) || height == 0 || width > MOST {
            return Err(Failure::Usage(format!(
                "a panorama of {width}x{height} is not possible: it is twice as wide as high, as 2048x1024, and at most {MOST} \
                 pixels wide"
            )));
        }
        Ok(Some(Panorama { width }))
    }
}

#[derive(Debug, Clone, Copy)]
pub(super) struct Panorama {
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

impl Panorama {
    pub(super) const FACES: usize = FACES.len();

    pub(super) fn size(self) -> (u32, u32) {
        (self.width, self.width / 2)
    }

    pub(super) fn kept_pixels(self) -> u64 {
        let (half, margin) = self.half();
        let side = 2 * (half + margin) as u64;
        Self::FACES as u64 * side * side
    }

    /// Half of a picture's pixels that are within 45 degrees of its middle, and all beyond them on one side.
    fn half(self) -> (f64, f64) {
        let half = (f64::from(self.width) / 4.0).max(1.0).ceil();
        // Two pixels more, since a place in the outermost half has no neighbours.
        (half, (half * OVERLAP).ceil() + 2.0)
    }

    /// The six views of a view's surroundings.
    pub(super) fn faces(self, view: &NamedView) -> Vec<NamedView> {
        let (half, margin) = self.half();
        let side = 2.0 * (half + margin);
        let axes = view.camera.rotation;
        let face = |(name, own): &(&str, [DVec3; 3])| NamedView {
            number: view.number,
            name: format!("{} {name}", view.name),
            camera: view
                .camera
                .projection(Projection::Perspective)
                .width(side as u32)
                .height(side as u32)
                .fx(half)
                .fy(half)
                .cx(side / 2.0)
                .cy(side / 2.0)
                .rotation(DMat3::from_cols(own[0], own[1], own[2]).transpose() * axes),
        };
        FACES.iter().map(face).collect()
    }

    /// The panorama of the pictures of its six faces, in their order.
    pub(super) fn assembled(self, faces: &[Picture]) -> Picture {
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

    fn pixel(self, faces: &[Picture], (x, y): (usize, usize)) -> [f32; 4] {
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
    fn seen(self, faces: &[Picture], direction: DVec3) -> [f32; 4] {
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

/// The camera without its tilt, so that the horizon is level; as it is where it looks along `up`.
pub(super) fn levelled(camera: Camera, up: DVec3) -> Camera {
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
mod tests {
    use super::*;

    fn view() -> NamedView {
        let (eye, target) = (DVec3::new(1.0, 2.0, 3.0), DVec3::new(4.0, 0.0, 4.0));
        NamedView {
            number: 0,
            name: "v".into(),
            camera: Camera::look_at(eye, target, DVec3::NEG_Y, 50.0, (8, 8)).unwrap(),
        }
    }

    /// What a face shows where every direction has a colour of its own.
    fn painted(face: &Camera, axes: DMat3) -> Picture {
        let mut picture = Picture::filled(face.width, face.height, [0.0; 4]);
        for (index, pixel) in picture.pixels.iter_mut().enumerate() {
            let (x, y) = (index as u32 % face.width, index as u32 / face.width);
            let off = DVec3::new(
                (f64::from(x) + 0.5 - face.cx) / face.fx,
                (f64::from(y) + 0.5 - face.cy) / face.fy,
                1.0,
            );
            let seen = axes * (face.rotation.transpose() * off.normalize());
            *pixel = [seen.x as f32, seen.y as f32, seen.z as f32, 1.0];
        }
        picture
    }

    #[test]
    fn every_direction_is_where_it_belongs_without_a_seam() {
        let panorama = Panorama { width: 128 };
        let mut view = view();
        view.camera = levelled(view.camera, DVec3::NEG_Y);
        let axes = view.camera.rotation;
        assert!((axes.row(1) - DVec3::Y).length() < 1e-12 && axes.determinant() > 0.999);
        let faces = panorama.faces(&view);
        for face in &faces {
            assert!((face.camera.rotation.determinant() - 1.0).abs() < 1e-12);
        }
        let pictures: Vec<_> = faces
            .iter()
            .map(|face| painted(&face.camera, axes))
            .collect();
        let made = panorama.assembled(&pictures);
        assert_eq!((made.width, made.height), (128, 64));
        for y in 0..64 {
            for x in 0..128 {
                let right = panorama.direction((f64::from(x) + 0.5, f64::from(y) + 0.5));
                let [r, g, b, a] = made.at(x, y).map(f64::from);
                // Bilinear steps and the mean over a pixel shorten what turns.
                assert!((DVec3::new(r, g, b) - right).length() < 2e-3, "{x} {y}");
                assert!((a - 1.0).abs() < 1e-6);
            }
        }
        // The middle is what the camera looks at, but for its tilt.
        let middle = panorama.direction((64.0, 32.0));
        assert!((middle - DVec3::Z).length() < 1e-12);
    }

    #[test]
    fn a_file_s_camera_keeps_its_own_axes_and_sizes_are_two_to_one() {
        let view = view();
        let panorama = Panorama { width: 64 };
        let faces = panorama.faces(&view);
        assert!(
            (faces[0].camera.rotation - view.camera.rotation)
                .to_cols_array()
                .iter()
                .all(|one| one.abs() < 1e-12)
        );
        assert_eq!(faces[5].name, "v down");
        let pixels =
            |face: &NamedView| u64::from(face.camera.width) * u64::from(face.camera.height);
        assert_eq!(
            panorama.kept_pixels(),
            faces.iter().map(pixels).sum::<u64>()
        );
        let args = PanoramaArgs { panorama: true };
        assert_eq!(args.meant(None).unwrap().unwrap().size(), (2048, 1024));
        for wrong in [(64, 64), (0, 0), (32768, 16384), (63, 31)] {
            assert!(args.meant(Some(wrong)).is_err(), "{wrong:?}");
        }
        assert!(
            PanoramaArgs { panorama: false }
                .meant(None)
                .unwrap()
                .is_none()
        );
    }
}
