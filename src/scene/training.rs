//! How Gaussians were trained, in so far as they are drawn by it.

use std::fmt;
use std::ops::RangeInclusive;

#[cfg(feature = "formats")]
use rara_base::error::shortened;
use rara_base::setters;

/// The low-passes that can be drawn, square pixels. Without any, splats of less than a pixel would come and go.
const LOW_PASSES: RangeInclusive<f32> = 0.01..=10.0;

/// The order in which splats are blended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
pub enum SortBy {
    /// By the depth of their centres along the view axis, as 3DGS and most trainers do.
    #[default]
    Depth,
    /// By the distance of their centres from the eye, as glTF asks for. It stays as it is where the camera turns. Where lines
    /// of sight are parallel, in an orthographic view, it is the depth.
    Distance,
}

setters! {
    /// How Gaussians were trained, in so far as they are drawn by it. It holds for all of a set.
    ///
    /// ```
    /// # use rara_scene as rara;
    /// use rara::{Gaussians, Training};
    /// let mut gaussians = Gaussians::default();
    /// gaussians.set_training(Training::default().antialiased(true).low_pass(0.1))?; // as by Mip-Splatting
    /// # Ok::<(), rara_base::error::Error>(())
    /// ```
    #[derive(Debug, Clone, Copy, PartialEq)]
    #[non_exhaustive]
    pub struct Training {
        /// See [`is_antialiased`](crate::Gaussians::is_antialiased). Default: false.
        pub antialiased: bool,
        /// The low-pass, square pixels, 0.01 to 10: see [`low_pass`](crate::Gaussians::low_pass). Default: 0.3.
        pub low_pass: f32,
        /// The order in which they were blended. Default: by depth.
        pub sort_by: SortBy,
        /// The most that a splat covers of a pixel, above 0 to 1. 3DGS trains with 0.99, and `KHR_gaussian_splatting` knows no
        /// such limit; a scene has the least of its layers'. Default: 0.99.
        pub alpha_max: f32,
        /// True where their colours are linear light (`lin_rec709_display` of `KHR_gaussian_splatting`): it is blended as such,
        /// and becomes what displays store once the picture is whole. All layers of a scene are alike in this. Default:
        /// false, colours as displays store them.
        pub linear: bool,
    }
}

impl Default for Training {
    fn default() -> Self {
        Self {
            antialiased: false,
            low_pass: 0.3,
            sort_by: SortBy::default(),
            alpha_max: 0.99,
            linear: false,
        }
    }
}

impl fmt::Display for Training {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let antialiased = if self.antialiased {
            "antialiased, "
        } else {
            ""
        };
        let sorted = match self.sort_by {
            SortBy::Depth => "depth",
            SortBy::Distance => "distance",
        };
        write!(
            f,
            "{antialiased}with a low-pass of {} px^2 in the order of {sorted}{}",
            self.low_pass,
            if self.linear { " in linear light" } else { "" }
        )
    }
}

impl Training {
    pub(super) fn check(&self) -> Result<(), String> {
        if !LOW_PASSES.contains(&self.low_pass) {
            return Err(format!(
                "the low-pass is {} square pixels: {} to {} can be drawn",
                self.low_pass,
                LOW_PASSES.start(),
                LOW_PASSES.end()
            ));
        }
        match self.alpha_max > 0.0 && self.alpha_max <= 1.0 {
            true => Ok(()),
            false => Err(format!(
                "the largest alpha is {}: above 0 to 1 can be drawn",
                self.alpha_max
            )),
        }
    }
}

/// The names of marks.
#[cfg(feature = "formats")]
const LOW_PASS: &str = "lowPass";
#[cfg(feature = "formats")]
const SORT_BY: &str = "sortBy";
#[cfg(feature = "formats")]
const ALPHA_MAX: &str = "alphaMax";
#[cfg(feature = "formats")]
const LINEAR: &str = "linear";

#[cfg(feature = "formats")]
impl Training {
    /// What differs from what a format says, or is taken to say, by names and values that [`mark`](Self::mark) reads: comments
    /// of PLY and members of JSON.
    pub(super) fn marks(&self, usual: Self) -> impl Iterator<Item = (&'static str, String)> {
        let low_pass = (self.low_pass != usual.low_pass).then(|| self.low_pass.to_string());
        let sort_by = (self.sort_by != usual.sort_by).then(|| match self.sort_by {
            SortBy::Depth => "depth".to_owned(),
            SortBy::Distance => "distance".to_owned(),
        });
        let alpha_max = (self.alpha_max != usual.alpha_max).then(|| self.alpha_max.to_string());
        let linear = (self.linear != usual.linear).then(|| self.linear.to_string());
        [
            (LOW_PASS, low_pass),
            (SORT_BY, sort_by),
            (ALPHA_MAX, alpha_max),
            (LINEAR, linear),
        ]
        .into_iter()
        .filter_map(|(name, value)| Some((name, value?)))
    }

    /// Takes over what a mark of such a name says; the error says what of it cannot be drawn, and leaves it as it is. Other names
    /// say nothing.
    pub(super) fn mark(&mut self, name: &str, value: &str) -> Result<(), String> {
        let unusable = |reason: &str| {
            let value = shortened(value);
            format!("left out what the file says of {name}, {value}: {reason}")
        };
        let mut marked = *self;
        if name.eq_ignore_ascii_case(LOW_PASS) {
            marked.low_pass = value.parse().unwrap_or(f32::NAN);
        } else if name.eq_ignore_ascii_case(SORT_BY) {
            marked.sort_by = match value {
                "depth" => SortBy::Depth,
                "distance" => SortBy::Distance,
                _ => return Err(unusable("depth and distance are known")),
            };
        } else if name.eq_ignore_ascii_case(ALPHA_MAX) {
            marked.alpha_max = value.parse().unwrap_or(f32::NAN);
        } else if name.eq_ignore_ascii_case(LINEAR) {
            marked.linear = value
                .parse()
                .map_err(|_| unusable("true and false are known"))?;
        }
        marked.check().map_err(|error| unusable(&error))?;
        *self = marked;
        Ok(())
    }
}
