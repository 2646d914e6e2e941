//! How the Gaussians of a PLY were trained, in so far as that changes how they are drawn: by its comments, and by properties
//! that only some trainers write.

use glam::DVec3;
use ply_rs::ply::{ElementDef, PropertyType};

use crate::{Gaussians, SH_0, Training};
use rara_base::counted::counted;
use rara_base::error::shortened;

/// The property in which Mip-Splatting and its descendants leave a deviation that each Gaussian has in all directions beside
/// its scales: the finest detail that the training pictures show of it.
pub(super) const FILTER: &str = "filter_3D";

/// The note on discs of 2DGS, which that intersects with each line of sight.
pub(super) const DISCS: &str = "its discs of 2D Gaussian Splatting are drawn as flat Gaussians, which are projected, not intersected with each line of sight";
/// The low-pass that Mip-Splatting trains with, px^2.
pub(super) const LOW_PASS: f32 = 0.1;
/// The third deviation of a disc, as a share of the smaller of the others.
const FLAT: f32 = 1e-3;

/// Gives discs, which have two scales, a third one.
pub(super) fn flatten(gaussians: &mut Gaussians) {
    for scale in gaussians.scales_mut() {
        scale.z = FLAT * scale.x.min(scale.y);
    }
}

/// Makes harmonics of degree 0 of what was read in their place: colours, of which `full` is the most.
pub(super) fn colour(gaussians: &mut Gaussians, full: f32) {
    let stride = 3 * gaussians.sh_coefficients();
    for sh in gaussians.sh_mut().chunks_exact_mut(stride) {
        for value in &mut sh[..3] {
            *value = (*value / full - 0.5) / SH_0 as f32;
        }
    }
}

/// The kinds of Gaussians that comments tell.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum TrainerKind {
    Plain,
    Antialiased,
    /// Discs, as 2DGS has them.
    Discs,
}

impl TrainerKind {
    /// The kind by the last comment of a header that says one, if any does: `SplatRenderMode: mip` of Brush, which others write too, or
    /// `antialiased 1` of Postshot.
    pub(super) fn from_comments(lines: &[String]) -> Option<Self> {
        comments(lines).rev().find_map(|comment| {
            let mut words = comment.split_ascii_whitespace();
            match (words.next()?.trim_end_matches(':'), words.next()?) {
                ("splatrendermode", "mip") | ("antialiased", "1") => Some(Self::Antialiased),
                ("splatrendermode", "2dgs") => Some(Self::Discs),
                ("splatrendermode", "default") | ("antialiased", "0") => Some(Self::Plain),
                _ => None,
            }
        })
    }
}

/// What comments say, in small letters.
fn comments(lines: &[String]) -> impl DoubleEndedIterator<Item = String> {
    lines.iter().filter_map(|line| {
        let line = line.trim().to_ascii_lowercase();
        let comment = line
            .strip_prefix("comment")
            .or_else(|| line.strip_prefix("obj_info"));
        comment.map(Into::into)
    })
}

/// The direction that is up by the last comment that says it, as nerfstudio writes it: `Vertical Axis: z`.
pub(super) fn up(lines: &[String]) -> Option<DVec3> {
    comments(lines).rev().find_map(|comment| {
        let (name, axis) = comment.split_once(':')?;
        let is_axis = |(_, known): &&(DVec3, &str)| *known == axis.trim();
        let found = AXES
            .iter()
            .find(is_axis)
            .filter(|_| name.trim() == "vertical axis");
        found.map(|(up, _)| *up)
    })
}

/// The comment that says which direction is up; none where it is no axis.
pub(crate) fn up_comment(up: DVec3) -> Option<String> {
    let axis = AXES.iter().find(|(axis, _)| axis.abs_diff_eq(up, 1e-6));
    axis.map(|(_, name)| format!("comment Vertical Axis: {name}\n"))
}

/// The axes by their names.
const AXES: [(DVec3, &str); 6] = [
    (DVec3::X, "x"),
    (DVec3::Y, "y"),
    (DVec3::Z, "z"),
    (DVec3::NEG_X, "-x"),
    (DVec3::NEG_Y, "-y"),
    (DVec3::NEG_Z, "-z"),
];

/// How Gaussians were trained by a header, and what is to say of it. Brush trains antialiased with the low-pass of Mip-Splatting,
/// others with that of 3DGS; this project's own [marks](Training::marks) come before that.
pub(super) fn training(lines: &[String]) -> (Training, Vec<String>) {
    let antialiased = TrainerKind::from_comments(lines) == Some(TrainerKind::Antialiased);
    let mut training = Training::default().antialiased(antialiased);
    let is_of_brush = comments(lines).any(|comment| {
        let mut words = comment.split(|sign: char| !sign.is_alphanumeric());
        words.any(|word| word == "brush")
    });
    if antialiased && is_of_brush {
        training.low_pass = LOW_PASS;
    }
    let marks = comments(lines).filter_map(|comment| {
        let (name, value) = comment.split_once(':')?;
        training.mark(name.trim(), value.trim()).err()
    });
    let unusable = marks.collect();
    (training, unusable)
}

/// Refuses Gaussians that are drawn in another way than those of 3DGS.
pub(super) fn check(vertex: &ElementDef) -> Result<(), String> {
    let has = |name: &str| vertex.properties.contains_key(name);
    if has("f_offset_0") && has("f_anchor_feat_0") {
        return Err(
            "the file holds anchors of Scaffold-GS or one of its kin (f_offset_*, f_anchor_feat_*), of which networks that \
             are not in it make Gaussians for each view; train the scene with 3DGS"
                .into(),
        );
    }
    let names = vertex.properties.keys();
    let of_time: Vec<_> = names.filter(|name| is_of_time(name)).collect();
    match of_time.first() {
        Some(first) => Err(format!(
            "its Gaussians change with time (by {}, such as `{}`), and those of all moments would be drawn at once; export a .ply \
             for each moment, and give them as scene_{{}}.ply",
            counted(of_time.len(), "property"),
            shortened(first),
        )),
        None => Ok(()),
    }
}

/// True for the properties by which Gaussians move, turn, appear and fade: those of Spacetime Gaussians (`trbf_*`, `motion_*`,
/// `omega_*`), of 4D Gaussians (`t`, `scale_t`, `rot_r_*`), and of their kin.
fn is_of_time(name: &str) -> bool {
    const FAMILIES: [&str; 6] = [
        "trbf_",
        "motion_",
        "omega_",
        "rot_r_",
        "velocity_",
        "rot_l_",
    ];
    match name {
        "t" | "scale_t" | "t_scale" | "scaling_t" | "t_center" | "time_scale" => true,
        "vx" | "vy" | "vz" => true,
        _ => FAMILIES.iter().any(|family| name.starts_with(family)),
    }
}

/// True when the Gaussians have filters of their own.
pub(super) fn has_filter(vertex: &ElementDef) -> bool {
    let property = vertex.properties.get(FILTER);
    property.is_some_and(|property| matches!(property.data_type, PropertyType::Scalar(_)))
}

/// Smooths each Gaussian by its filter, a standard deviation: the variance along each axis grows by the filter's, and the
/// opacity falls so that its mass is what it was (the 3D smoothing filter of Yu et al. 2024). Returns how many filters are
/// no finite number, whose Gaussians stay as they are.
pub(super) fn smooth(gaussians: &mut Gaussians, filters: &[f64]) -> u64 {
    let mut unusable = 0;
    for (index, filter) in filters.iter().enumerate() {
        let before = gaussians.scales()[index].as_dvec3();
        let after = (before * before + filter * filter).map(f64::sqrt);
        if !after.as_vec3().is_finite() {
            unusable += 1;
            continue;
        }
        // A scale of zero that stays zero has lost nothing.
        let shares = DVec3::select(after.cmpgt(DVec3::ZERO), before / after, DVec3::ONE);
        let opacity = f64::from(gaussians.opacities()[index]) * shares.element_product();
        gaussians.opacities_mut()[index] = opacity as f32;
        gaussians.scales_mut()[index] = after.as_vec3();
    }
    unusable
}

#[cfg(test)]
mod tests;
