//! The text of clips and predicates, whose planes and slabs may lie at shares of the scene.

use std::str::FromStr;

use rara::clip::Expression;
use rara::{Bounds, Error, Result, Shape};

use super::axis::Axis;

/// A clip, or another thing with shapes in it, as it was typed.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Region<T = Expression> {
    /// One that says itself where it lies.
    Fixed(T),
    /// One that lies at shares of the scene: its text, and what that means in an example of a scene.
    Relative(String, T),
}

impl Region {
    pub(super) fn shape(text: &str) -> Result<Self> {
        Self::parse(text, |text| text.parse::<Shape>().map(Expression::Shape))
    }
}

impl<T: FromStr<Err = Error>> FromStr for Region<T> {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self> {
        Self::parse(text, str::parse)
    }
}

impl<T> Region<T> {
    fn parse(text: &str, parse: fn(&str) -> Result<T>) -> Result<Self> {
        let some = Bounds {
            min: glam::DVec3::ZERO,
            max: glam::DVec3::ONE,
        };
        let fixed = fixed(text, &some)?;
        if fixed == text {
            return parse(text).map(Self::Fixed);
        }
        // What is wrong with it is found before the scene is read.
        let example = parse(&fixed).map_err(|error| {
            Error::Invalid(format!(
                "{error}, in '{fixed}', where shares are replaced by an example"
            ))
        })?;
        Ok(Self::Relative(text.into(), example))
    }

    /// What it is in some scene: in all but the places at shares it is that in every scene.
    pub(super) fn example(&self) -> &T {
        let (Self::Fixed(one) | Self::Relative(_, one)) = self;
        one
    }
}

impl<T: FromStr<Err = Error> + Clone> Region<T> {
    /// What it is in a scene, whose bounds are asked for if it lies at shares of them: those of a large one take a while.
    pub(super) fn resolve(&self, bounds: impl FnOnce() -> Bounds) -> Result<T> {
        match self {
            Self::Fixed(one) => Ok(one.clone()),
            Self::Relative(text, _) => fixed(text, &bounds())?.parse(),
        }
    }
}

/// The text in which `plane:AXIS=SHARE%` and `slab:AXIS=FROM%..TO%` are replaced by what they mean within bounds.
fn fixed(text: &str, bounds: &Bounds) -> Result<String> {
    let mut fixed = String::new();
    let mut rest = text;
    while let Some((at, kind)) = ["plane:", "slab:"]
        .iter()
        .filter_map(|kind| Some((rest.find(kind)?, *kind)))
        .min()
    {
        let (before, behind) = rest.split_at(at + kind.len());
        fixed += before;
        rest = behind;
        let end = rest.find([',', ')']).unwrap_or(rest.len());
        let Some((name, shares)) = rest[..end].split_once('=') else {
            continue;
        };
        let typed = format!("{kind}{}", &rest[..end]);
        let wrong = |what: &str| Error::Invalid(format!("'{typed}': {what}"));
        // The other side is the outside of the shape.
        let axis = Axis::parse(name.trim()).filter(|_| !name.contains('!'));
        let axis = axis.ok_or_else(|| {
            wrong("expected one of the axes x, y, z, sagittal, coronal and axial")
        })?;
        let (low, high) = (bounds.min.dot(axis.along), bounds.max.dot(axis.along));
        let position = |text: &str| {
            let share = text
                .trim()
                .strip_suffix('%')
                .and_then(|n| n.parse::<f64>().ok());
            let share = share.filter(|share| share.is_finite());
            let share = share.ok_or_else(|| {
                wrong("expected shares in percent, as in plane:x=40% or slab:x=40%..60%")
            });
            share.map(|share| low + (high - low) * share / 100.0)
        };
        let normal = axis.along;
        fixed += &format!("{},{},{},", normal.x, normal.y, normal.z);
        fixed += &match (kind, shares.split_once("..")) {
            ("plane:", None) => format!("{}", -position(shares)?),
            ("slab:", Some((from, to))) => {
                let (from, to) = (position(from)?, position(to)?);
                if from >= to {
                    return Err(wrong("the first share has to be the smaller one"));
                }
                format!("{},{}", -from, to - from)
            }
            ("plane:", Some(_)) => {
                return Err(wrong("a plane lies at one share; a slab lies between two"));
            }
            _ => {
                return Err(wrong(
                    "a slab lies between two shares, as in slab:x=40%..60%",
                ));
            }
        };
        rest = &rest[end..];
    }
    Ok(fixed + rest)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    fn bounds() -> Bounds {
        Bounds {
            min: DVec3::new(-1.0, 2.0, 10.0),
            max: DVec3::new(1.0, 4.0, 30.0),
        }
    }

    #[test]
    fn planes_and_slabs_lie_at_shares_of_the_bounds() {
        for (typed, means) in [
            ("plane:x=25%", "plane:1,0,0,0.5"),
            ("!plane:axial=50%", "!plane:0,0,1,-20"),
            ("slab:coronal=25%..75%", "slab:0,1,0,-2.5,1"),
            (
                "any(plane:z=0%, not(slab:x= 0% .. 100% ))",
                "any(plane:0,0,1,-10, not(slab:1,0,0,1,2))",
            ),
            (
                "all(plane:1,0,0,3, plane:y=150%)",
                "all(plane:1,0,0,3, plane:0,1,0,-5)",
            ),
        ] {
            let region: Region = typed.parse().expect(typed);
            assert!(matches!(region, Region::Relative(..)), "{typed}");
            let meant: Expression = means.parse().expect(means);
            assert_eq!(region.resolve(bounds).expect(typed), meant, "{typed}");
        }
        let typed = "all(plane:1,0,0,3, sphere:0,0,0,1)";
        let region: Region = typed.parse().expect(typed);
        assert_eq!(region, Region::Fixed(typed.parse().expect(typed)));
    }

    #[test]
    fn what_lies_nowhere_is_refused_before_there_is_a_scene() {
        for (typed, says) in [
            ("plane:w=40%", "sagittal"),
            ("plane:!x=40%", "sagittal"),
            ("plane:x=40", "in percent"),
            ("plane:x=nan%", "in percent"),
            ("plane:x=1%..2%", "a slab lies between two"),
            ("slab:x=40%", "between two shares"),
            ("slab:x=60%..40%", "the smaller one"),
            ("slab:x=4%..40", "in percent"),
            ("all(plane:x=40%", "is missing, in 'all(plane:1,0,0,-0.4'"),
        ] {
            let error = typed.parse::<Region>().expect_err(typed).to_string();
            assert!(error.contains(says), "{typed}: {error}");
        }
        assert!(Region::shape("all(plane:x=4%)").is_err() && Region::shape("plane:x=4%").is_ok());
    }
}
