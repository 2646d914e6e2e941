//! The text of a clip, whose planes and slabs may lie at shares of the scene.

use rara::clip::Expression;
use rara::{Bounds, Result, Shape};

use super::axis::Axis;

/// A clip as it was typed.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Region {
    /// A clip that says itself where it lies.
    Fixed(Expression),
    /// The text of a clip that lies at shares of the scene.
    Relative(String),
}

impl Region {
    /// An expression of shapes.
    pub(super) fn expression(text: &str) -> std::result::Result<Self, String> {
        Self::parse(text, str::parse)
    }

    /// A single shape.
    pub(super) fn shape(text: &str) -> std::result::Result<Self, String> {
        Self::parse(text, |text| text.parse::<Shape>().map(Expression::Shape))
    }

    fn parse(
        text: &str,
        parse: fn(&str) -> Result<Expression>,
    ) -> std::result::Result<Self, String> {
        let some = Bounds {
            min: glam::DVec3::ZERO,
            max: glam::DVec3::ONE,
        };
        let fixed = fixed(text, &some)?;
        // What is wrong with it is found before the scene is read.
        let parsed = parse(&fixed).map_err(|error| match fixed == text {
            true => error.to_string(),
            false => format!("{error}, in '{fixed}', where shares are replaced by an example"),
        })?;
        Ok(match fixed == text {
            true => Self::Fixed(parsed),
            false => Self::Relative(text.into()),
        })
    }

    /// The clip in a scene, whose bounds are asked for if it lies at shares of them: those of a large one take a while.
    pub(super) fn of(&self, bounds: impl FnOnce() -> Bounds) -> Result<Expression> {
        match self {
            Self::Fixed(expression) => Ok(expression.clone()),
            Self::Relative(text) => {
                let fixed = fixed(text, &bounds()).map_err(rara::Error::Invalid)?;
                fixed.parse()
            }
        }
    }
}

/// The text of a clip in which `plane:AXIS=SHARE%` and `slab:AXIS=FROM%..TO%` are replaced by what they mean within bounds.
fn fixed(text: &str, bounds: &Bounds) -> std::result::Result<String, String> {
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
        let wrong = |what: &str| format!("'{typed}': {what}");
        // The other side is the outside of the shape.
        let axis = Axis::of(name.trim()).filter(|_| !name.contains('!'));
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
            let region = Region::expression(typed).expect(typed);
            assert!(matches!(region, Region::Relative(..)), "{typed}");
            let meant: Expression = means.parse().expect(means);
            assert_eq!(region.of(bounds).expect(typed), meant, "{typed}");
        }
        let typed = "all(plane:1,0,0,3, sphere:0,0,0,1)";
        let region = Region::expression(typed).expect(typed);
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
            let error = Region::expression(typed).expect_err(typed);
            assert!(error.contains(says), "{typed}: {error}");
        }
        assert!(Region::shape("all(plane:x=4%)").is_err() && Region::shape("plane:x=4%").is_ok());
    }
}
