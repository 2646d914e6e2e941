//! How Gaussians were trained, in so far as they are drawn by it.

use std::fmt;
use std::ops::RangeInclusive;

#[cfg(feature = "formats")]
use rara_base::error::shortened;
#[cfg(feature = "formats")]
use rara_base::value::Value;
use rara_base::{named, setters};

/// The low-passes that can be drawn, square pixels. Without any, splats of less than a pixel would come and go.
const LOW_PASSES: RangeInclusive<f32> = 0.01..=10.0;

named! {
    /// The order in which splats are blended.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
    pub enum SortBy {
        /// Splats are sorted by the depths of their centres along the view axis, as 3DGS and most trainers do.
        #[default]
        Depth = "depth",
        /// Splats are sorted by the distances of their centres from the eye, as glTF asks for. This order does not change when the camera turns. An
        /// orthographic view uses depths instead.
        Distance = "distance",
    }
}

setters! {
    /// How a set of Gaussians was trained. Gaussians are drawn in the way in which they were trained.
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
        /// True if they were trained antialiased: see [`is_antialiased`](crate::Gaussians::is_antialiased). Default: false.
        pub antialiased: bool,
        /// The low-pass, square pixels, 0.01 to 10: see [`low_pass`](crate::Gaussians::low_pass). Default: 0.3.
        pub low_pass: f32,
        /// The order in which they were blended. Default: by depth.
        pub sort_by: SortBy,
        /// The largest alpha of a splat in a pixel, above 0 and at most 1. 3DGS trains with 0.99; `KHR_gaussian_splatting` has no
        /// such limit, which is 1. A scene has the smallest limit of its layers. Default: 0.99.
        pub alpha_max: f32,
        /// True if their colours are linear light (`lin_rec709_display` of `KHR_gaussian_splatting`). They are blended in linear
        /// light, and the finished picture is converted to sRGB. All layers of a scene must agree in this. Default: false, sRGB.
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
        let sorted = self.sort_by.name();
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
                "the low-pass is {} square pixels; it must be from {} to {}",
                self.low_pass,
                LOW_PASSES.start(),
                LOW_PASSES.end()
            ));
        }
        match self.alpha_max > 0.0 && self.alpha_max <= 1.0 {
            true => Ok(()),
            false => Err(format!(
                "the largest alpha is {}; it must be above 0 and at most 1",
                self.alpha_max
            )),
        }
    }
}

/// What a file may say of training, beside what its format has a place for.
#[cfg(feature = "formats")]
struct Mark {
    name: &'static str,
    text: fn(&Training) -> Option<String>,
    read: fn(&mut Training, &str) -> Result<(), String>,
}

#[cfg(feature = "formats")]
macro_rules! marks {
    ($($name:literal => $field:ident;)+) => {
        &[$(Mark {
            name: $name,
            text: |of| of.$field.text(),
            read: |of, text| Value::read(text).map(|value| of.$field = value),
        }),+]
    };
}

#[cfg(feature = "formats")]
const MARKS: &[Mark] = marks! {
    "lowPass" => low_pass;
    "sortBy" => sort_by;
    "alphaMax" => alpha_max;
    "linear" => linear;
};

#[cfg(feature = "formats")]
impl Training {
    /// What differs from what a format says, or is taken to say, by names and values that [`mark`](Self::mark) reads: comments
    /// of PLY and members of JSON.
    pub(super) fn marks(&self, usual: Self) -> impl Iterator<Item = (&'static str, String)> {
        MARKS.iter().filter_map(move |mark| {
            let text = (mark.text)(self).filter(|_| (mark.text)(self) != (mark.text)(&usual));
            Some((mark.name, text?))
        })
    }

    /// The mark of a name.
    fn mark_of(name: &str) -> Option<&'static Mark> {
        MARKS
            .iter()
            .find(|mark| name.eq_ignore_ascii_case(mark.name))
    }

    /// True for the name of a mark.
    pub(super) fn is_mark(name: &str) -> bool {
        Self::mark_of(name).is_some()
    }

    /// Takes over what a mark of such a name says; the error says what of it cannot be drawn, and leaves it as it is. Other names
    /// say nothing.
    pub(super) fn mark(&mut self, name: &str, value: &str) -> Result<(), String> {
        let Some(mark) = Self::mark_of(name) else {
            return Ok(());
        };
        let mut marked = *self;
        let read = (mark.read)(&mut marked, value).and_then(|()| marked.check());
        read.map_err(|reason| {
            let value = shortened(value);
            format!("left out what the file says of {name}, {value}: {reason}")
        })?;
        *self = marked;
        Ok(())
    }
}
