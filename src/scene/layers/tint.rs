//! Colours that are mixed into layers.

use std::fmt;
use std::str::FromStr;

use rara_base::error::{Error, Result};
use rara_base::value::{self, Value};

use crate::gaussians::Gaussians;

/// A colour that is mixed into a layer. Its text is the colour, and a share behind a colon where that is not a half: `gold`,
/// `1,0.5,0:30%`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tint {
    /// Red, green and blue, each 0 to 1.
    pub colour: [f32; 3],
    /// The share of this colour, 0 to 1.
    pub share: f32,
}

/// The share where a text says none.
const SHARE: f32 = 0.5;

impl Tint {
    /// Mixes the colour into that of all Gaussians: see [`Gaussians::tint`].
    pub fn apply(&self, gaussians: &mut Gaussians) {
        gaussians.tint(self.colour, self.share);
    }
}

impl FromStr for Tint {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self> {
        let (colour, share) = match text.rsplit_once(':') {
            Some((colour, share)) => (colour, value::share(share).map(|share| share as f32)),
            None => (text, Ok(SHARE)),
        };
        Ok(Self {
            share: share.map_err(Error::Invalid)?,
            colour: Value::read(colour).map_err(Error::Invalid)?,
        })
    }
}

impl fmt::Display for Tint {
    /// The text that is parsed to it.
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        to.write_str(&self.colour.text().unwrap_or_default())?;
        match self.share == SHARE {
            true => Ok(()),
            false => write!(to, ":{}", self.share),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tint_is_read_as_it_is_written() {
        for (text, written) in [
            ("red", "1,0,0"),
            ("#ff0000:30%", "1,0,0:0.3"),
            ("1,0.5,0:0.5", "1,0.5,0"),
        ] {
            let tint: Tint = text.parse().expect("a tint");
            assert_eq!(tint.to_string(), written);
            assert_eq!(written.parse::<Tint>().expect("a tint"), tint);
        }
        for wrong in ["rouge", "red:2", "red:", ""] {
            assert!(wrong.parse::<Tint>().is_err(), "{wrong}");
        }
    }
}
