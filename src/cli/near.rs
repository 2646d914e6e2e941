//! What the near cut takes of a picture: Gaussians that would be in view, were they not nearer than splats are drawn.

use std::borrow::Cow;
use std::fmt;

use glam::DVec3;
use rara::{Camera, Clip, Projection, Scene};
use rara_base::limits::ALPHA_MIN;

use super::output::counted;

/// The Gaussians that a near cut takes.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct NearCut {
    count: u64,
    /// The least depth of one, in units of the world.
    nearest: f64,
    /// The name of the picture.
    view: String,
    /// How many other pictures it takes some of.
    others: usize,
}

/// The most centres that are looked at.
const MOST: usize = 1 << 27;

/// What the near cut takes of the pictures of these cameras, by that of which it takes most; `None` where it takes nothing.
pub(super) fn of<'a>(
    scene: &Scene<'_>,
    views: impl Iterator<Item = (&'a str, &'a Camera, &'a Clip)>,
) -> Option<NearCut> {
    let most = MOST / scene.gaussians().max(1);
    let cuts = views.take(most.max(1)).filter_map(|(name, camera, clip)| {
        let (count, nearest) = taken(scene, camera, clip);
        (count > 0).then_some((count, nearest, name))
    });
    let cuts: Vec<_> = cuts.collect();
    let (count, _, name) = cuts.iter().max_by_key(|(count, ..)| *count)?;
    let nearest = cuts.iter().map(|(_, nearest, _)| *nearest);
    Some(NearCut {
        count: *count,
        nearest: nearest.fold(f64::INFINITY, f64::min),
        view: (*name).to_owned(),
        others: cuts.len() - 1,
    })
}

/// How many Gaussians it takes of a picture, and the least depth of one.
fn taken(scene: &Scene<'_>, camera: &Camera, clip: &Clip) -> (u64, f64) {
    let (mut count, mut nearest) = (0, f64::INFINITY);
    for layer in scene.layers().iter().filter(|layer| layer.state().visible) {
        let (placement, gaussians) = (layer.placement(), layer.gaussians());
        let (seen, unit) = (camera.in_scene(&placement), placement.scale());
        let cut = seen.nearest(unit) / unit; // in the layer's units
        // A layer's own clip stands in place of the frame's; a camera whose planes mean nothing draws no picture.
        let clip = layer.clip().unwrap_or(clip);
        let clip = camera.sees_of(clip).unwrap_or(Cow::Borrowed(clip));
        let whole = f64::from(seen.width) / seen.fx + f64::from(seen.height) / seen.fy;
        let opacities = gaussians.opacities().iter();
        for (position, opacity) in gaussians.positions().iter().zip(opacities) {
            let off = position.as_dvec3() - seen.eye;
            let depth = seen.rotation.row(2).dot(off);
            // Most are farther, and the rest are looked at closely.
            if !(depth > 0.0 && depth < cut) || opacity * layer.state().opacity < ALPHA_MIN {
                continue;
            }
            let is_far_aside = off.length_squared() > (cut * (2.0 + whole)).powi(2)
                && seen.projection == Projection::Perspective;
            if !is_far_aside
                && is_in_picture(&seen, seen.rotation * off)
                && clip.keeps(placement.to_world(position.as_dvec3()))
            {
                count += 1;
                nearest = nearest.min(depth * unit);
            }
        }
    }
    (count, nearest)
}

/// True where a point of the camera's axes is in its picture.
fn is_in_picture(camera: &Camera, at: DVec3) -> bool {
    let depth = match camera.projection {
        Projection::Perspective => at.z,
        Projection::Orthographic => 1.0,
    };
    let (x, y) = (
        camera.fx * at.x / depth + camera.cx,
        camera.fy * at.y / depth + camera.cy,
    );
    (0.0..=f64::from(camera.width)).contains(&x) && (0.0..=f64::from(camera.height)).contains(&y)
}

impl NearCut {
    /// The flag that draws what it takes: a round depth before the nearest.
    fn remedy(&self) -> String {
        let step = 10_f64.powf(self.nearest.log10().floor() - 1.0);
        let depth = (0.9 * self.nearest / step).floor() * step;
        format!(
            "--near-cut {} draws them",
            depth.max(f64::from(f32::MIN_POSITIVE)) as f32
        )
    }

    /// The reason for which a picture is empty.
    pub(super) fn why_empty(&self) -> String {
        format!(
            "the {} in view {} nearer than splats are drawn, in a scene of small units or close to the eye; {}",
            match self.count {
                1 => "one Gaussian".into(),
                count => counted(count, "Gaussian"),
            },
            if self.count == 1 { "is" } else { "are" },
            self.remedy()
        )
    }
}

impl fmt::Display for NearCut {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let whose = match self.others {
            0 => String::new(),
            others => format!(
                " of {}, and some of {},",
                self.view,
                counted(others as u64, "other picture")
            ),
        };
        write!(
            f,
            "{}{whose} would be in view, but {} nearer to the eye than splats are drawn; {}",
            counted(self.count, "Gaussian"),
            if self.count == 1 { "is" } else { "are" },
            self.remedy()
        )
    }
}
