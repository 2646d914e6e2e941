//! How the Gaussians of a PLY were trained, in so far as that changes how they are drawn: by its comments, and by properties
//! that only some trainers write.

use ply_rs::ply::{ElementDef, PropertyType};

use crate::{Gaussians, SH_0, Training};

/// The property in which Mip-Splatting and its descendants leave a deviation that each Gaussian has in all directions beside
/// its scales: the finest detail that the training pictures show of it.
pub(super) const FILTER: &str = "filter_3D";

/// The note on discs of 2DGS, which that intersects with each line of sight.
pub(super) const DISCS: &str = "drew the discs of 2D Gaussian Splatting as flat Gaussians, which are projected, not intersected with each line of sight";
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
    Ok(())
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
        let shares = glam::DVec3::select(
            after.cmpgt(glam::DVec3::ZERO),
            before / after,
            glam::DVec3::ONE,
        );
        let opacity = f64::from(gaussians.opacities()[index]) * shares.element_product();
        gaussians.opacities_mut()[index] = opacity as f32;
        gaussians.scales_mut()[index] = after.as_vec3();
    }
    unusable
}

#[cfg(test)]
mod tests {
    use glam::{Quat, Vec3};

    use super::*;
    use crate::SortBy;

    #[test]
    fn the_last_comment_that_says_a_kind_counts() {
        let kind = |lines: &[&str]| {
            TrainerKind::from_comments(&lines.iter().map(|l| l.to_string()).collect::<Vec<_>>())
        };
        for (lines, expected) in [
            (
                &["comment SplatRenderMode: mip"][..],
                Some(TrainerKind::Antialiased),
            ),
            (
                &["comment  splatrendermode:  MIP "],
                Some(TrainerKind::Antialiased),
            ),
            (&["comment SplatRenderMode: 2dgs"], Some(TrainerKind::Discs)),
            (&["comment SplatRenderMode: new"], None),
            (&["comment antialiased 1"], Some(TrainerKind::Antialiased)),
            (
                &["comment antialiased 1", "comment SplatRenderMode: default"],
                Some(TrainerKind::Plain),
            ),
            (
                &["comment antialiased 0", "comment SplatRenderMode: mip"],
                Some(TrainerKind::Antialiased),
            ),
            (
                &["property float antialiased 1", "comment SH degree: 3"],
                None,
            ),
            (&[], None),
        ] {
            assert_eq!(kind(lines), expected, "{lines:?}");
        }
    }

    #[test]
    fn the_low_pass_is_what_a_mark_says_or_that_of_who_wrote_the_file() {
        let found =
            |lines: &[&str]| training(&lines.iter().map(|l| l.to_string()).collect::<Vec<_>>());
        let (brush, mip) = (
            "comment Exported from Brush",
            "comment SplatRenderMode: mip",
        );
        for (lines, expected) in [
            (&[brush, mip][..], 0.1),
            (&[mip, "obj_info made by brush-app 0.3"], 0.1),
            (&[brush, "comment SplatRenderMode: default"], 0.3),
            (&[brush], 0.3),
            (&[mip], 0.3),
            (&[mip, "comment a brushed scene"], 0.3),
            (&[brush, mip, "comment lowPass: 0.25"], 0.25),
            (&["comment LOWPASS : 0.2"], 0.2),
        ] {
            let (found, unusable) = found(lines);
            assert_eq!((found.low_pass, unusable), (expected, vec![]), "{lines:?}");
        }
        let (kept, unusable) = found(&["comment lowPass: much", "comment sortBy: distance"]);
        assert_eq!(kept, Training::default().sort_by(SortBy::Distance));
        assert!(unusable[0].contains("much"), "{unusable:?}");
    }

    #[test]
    fn smoothing_widens_and_keeps_the_mass() {
        let mut set = Gaussians::default();
        for scale in [Vec3::new(0.3, 0.4, 0.0), Vec3::ZERO, Vec3::ONE] {
            set.push(Vec3::ZERO, scale, Quat::IDENTITY, 0.8, &[0.0; 3]);
        }
        let unusable = smooth(&mut set, &[0.4, 0.0, f64::NAN]);
        assert_eq!(unusable, 1);
        assert!((set.scales()[0] - Vec3::new(0.5, 0.4 * 2.0_f32.sqrt(), 0.4)).length() < 1e-6);
        assert_eq!(set.opacities()[0], 0.0, "a disc has no mass");
        assert_eq!((set.scales()[1], set.opacities()[1]), (Vec3::ZERO, 0.8));
        assert_eq!((set.scales()[2], set.opacities()[2]), (Vec3::ONE, 0.8));
        let mut round = Gaussians::default();
        round.push(Vec3::ZERO, Vec3::splat(0.3), Quat::IDENTITY, 0.5, &[0.0; 3]);
        smooth(&mut round, &[0.4]);
        assert!((round.opacities()[0] - 0.5 * 0.6_f32.powi(3)).abs() < 1e-6);
    }
}
