//! Values that command lines, job files and other languages write as text: choices by their names, numbers, colours.

use crate::error::shortened;

/// A value that has a text.
pub trait Value: Sized + 'static {
    /// The names of all values, each with its documentation, if the values are choices among a few.
    const CHOICES: &'static [(&'static str, &'static str)] = &[];

    /// Returns the value of a text, or a sentence that says what was expected.
    fn read(text: &str) -> Result<Self, String>;

    /// Returns the text that `read` reads, without loss; `None` for a value that stands for "not given".
    fn text(&self) -> Option<String>;
}

/// Defines an enumeration whose values have names. It gets `ALL`, which lists the named values in their order, `name`,
/// `Display` and `FromStr`. A value without a name is for programs alone.
#[macro_export]
macro_rules! named {
    (
        $(#[$about:meta])*
        pub enum $of:ident {
            $($(#[doc = $doc:literal])+ $(#[default$($default:tt)*])? $value:ident $(= $name:literal)?,)+
        }
    ) => {
        $(#[$about])*
        pub enum $of {
            $($(#[doc = $doc])+ $(#[default$($default)*])? $value,)+
        }

        impl $of {
            /// All values that have a name, in their order.
            pub const ALL: &'static [Self] = &[$($({ let _ = $name; Self::$value },)?)+];

            /// Returns the value's name, which `parse` reads.
            pub const fn name(self) -> &'static str {
                match self {
                    $(Self::$value => concat!($($name)?),)+
                }
            }
        }

        impl $crate::value::Value for $of {
            const CHOICES: &'static [(&'static str, &'static str)] =
                &[$((concat!($($name)?), concat!($($doc, "\n"),+)),)+].split_at(Self::ALL.len()).0;

            fn read(text: &str) -> std::result::Result<Self, String> {
                let found = Self::ALL.iter().find(|value| value.name() == text);
                found.copied().ok_or_else(|| $crate::value::unknown(text, Self::CHOICES))
            }

            fn text(&self) -> Option<String> {
                Some(self.name().into())
            }
        }

        impl std::fmt::Display for $of {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.pad(self.name())
            }
        }

        impl std::str::FromStr for $of {
            type Err = $crate::error::Error;

            fn from_str(name: &str) -> $crate::error::Result<Self> {
                $crate::value::Value::read(name).map_err($crate::error::Error::Invalid)
            }
        }
    };
}

/// The sentence about a name that none of the choices has.
#[doc(hidden)]
pub fn unknown(name: &str, choices: &[(&str, &str)]) -> String {
    let names: Vec<_> = choices.iter().map(|(name, _)| *name).collect();
    format!(
        "there is no '{}'; give one of {}",
        shortened(name),
        names.join(", ")
    )
}

/// Values whose text is that of the standard library.
macro_rules! plain {
    ($($of:ty, $expected:literal;)+) => {
        $(impl Value for $of {
            fn read(text: &str) -> std::result::Result<Self, String> {
                text.parse().map_err(|_| concat!("expected ", $expected).into())
            }

            fn text(&self) -> Option<String> {
                Some(self.to_string())
            }
        })+
    };
}

plain! {
    f32, "a number";
    u32, "a whole number";
    bool, "true or false";
}

impl<T: Value> Value for Option<T> {
    const CHOICES: &'static [(&'static str, &'static str)] = T::CHOICES;

    fn read(text: &str) -> std::result::Result<Self, String> {
        T::read(text).map(Some)
    }

    fn text(&self) -> Option<String> {
        self.as_ref().and_then(T::text)
    }
}

/// A share, as a number from 0 to 1 or as a percentage.
///
/// # Errors
/// A sentence that says what was expected.
pub fn share(text: &str) -> Result<f64, String> {
    let (text, whole) = match text.strip_suffix('%') {
        Some(text) => (text, 100.0),
        None => (text, 1.0),
    };
    let share = text.parse().ok();
    let share = share.filter(|share: &f64| (0.0..=whole).contains(share));
    let share = share.ok_or("expected a number from 0 to 1, or from 0% to 100%")?;
    Ok(share / whole)
}

/// Names of colours whose meaning is older here than CSS's names, which have 0,0.5,0 for green.
const COLOURS: [(&str, [f32; 3]); 2] = [("gray", [0.5, 0.5, 0.5]), ("green", [0.0, 1.0, 0.0])];

/// A colour: `r,g,b`, each 0 to 1, `#rgb`, `#rrggbb` or a name that CSS has for it.
impl Value for [f32; 3] {
    fn read(text: &str) -> std::result::Result<Self, String> {
        if text.starts_with('#') {
            let rgb = if matches!(text.len(), 4 | 7) {
                css(text)
            } else {
                None
            };
            return rgb
                .ok_or_else(|| "expected three or six hexadecimal digits, as in #fff".into());
        }
        if text.starts_with(|letter: char| letter.is_ascii_alphabetic()) && !text.contains(',') {
            return css(text).ok_or_else(|| {
                let name = shortened(text);
                format!("there is no colour '{name}'; give one of CSS's names, such as white or orange, #rrggbb, or r,g,b from 0 to 1")
            });
        }
        let rgb: Option<Vec<f32>> = text.split(',').map(|n| n.trim().parse().ok()).collect();
        let rgb: [f32; 3] = rgb.and_then(|rgb| rgb.try_into().ok()).ok_or(
            "expected three numbers with commas between them, as in 1,0.5,0, or #rrggbb, or a name such as orange",
        )?;
        match rgb.iter().all(|c| (0.0..=1.0).contains(c)) {
            true => Ok(rgb),
            false => Err("red, green and blue are each between 0 and 1".into()),
        }
    }

    fn text(&self) -> Option<String> {
        let [r, g, b] = self;
        Some(format!("{r},{g},{b}"))
    }
}

/// An opaque colour by its name or its hexadecimal digits. CSS spells grey in both ways.
fn css(text: &str) -> Option<[f32; 3]> {
    let text = text.to_ascii_lowercase().replace("grey", "gray");
    if let Some((_, rgb)) = COLOURS.iter().find(|(name, _)| *name == text) {
        return Some(*rgb);
    }
    let is_word = text
        .bytes()
        .all(|byte| byte == b'#' || byte.is_ascii_alphanumeric());
    let colour = color::parse_color(&text).ok().filter(|_| is_word)?;
    let colour = colour.to_alpha_color::<color::Srgb>().to_rgba8();
    let rgb = [colour.r, colour.g, colour.b].map(|value| f32::from(value) / 255.0);
    (colour.a == 255).then_some(rgb)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_are_numbers_or_percentages() {
        assert_eq!((share("0.25"), share("25%")), (Ok(0.25), Ok(0.25)));
        assert_eq!((share("0"), share("100%")), (Ok(0.0), Ok(1.0)));
        for wrong in ["1.5", "101%", "-1%", "nan", "%", ""] {
            assert!(share(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn colours() {
        let read = <[f32; 3]>::read;
        assert_eq!(read("white"), Ok([1.0; 3]));
        assert_eq!(read("#fff"), Ok([1.0; 3]));
        assert_eq!(read("#ff0080"), Ok([1.0, 0.0, 128.0 / 255.0]));
        assert_eq!(read("#F08"), Ok([1.0, 0.0, 136.0 / 255.0]));
        assert_eq!(read("0, 0.5,1"), Ok([0.0, 0.5, 1.0]));
        let orange = [1.0, 165.0 / 255.0, 0.0];
        assert_eq!((read("orange"), read("Orange")), (Ok(orange), Ok(orange)));
        assert_eq!(
            (read("grey"), read("green")),
            (Ok([0.5; 3]), Ok([0.0, 1.0, 0.0]))
        );
        assert!(read("darkslategrey").is_ok() && read("darkslategrey") == read("darkslategray"));
        for wrong in [
            "#ffff",
            "#ggg",
            "wite",
            "0,0,1.5",
            "0,0",
            "nan,0,0",
            "",
            "transparent",
            "rgb(0 0 0)",
            "#",
        ] {
            assert!(read(wrong).is_err(), "{wrong}");
        }
    }
}
