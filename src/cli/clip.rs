//! `--clip` and `--clip-op`: shapes to half-spaces.

use clap::{Args, ValueEnum};
use glam::{DQuat, DVec3};
use rara::limits::MAX_CLIP_PLANES;
use rara::{Clip, ClipOp, Plane};

use super::failure::Failure;
use super::values;

/// What to cut away.
#[derive(Debug, Args)]
#[command(next_help_heading = "Clip")]
pub(super) struct ClipArgs {
    /// A shape whose inside stays visible (repeatable): plane:nx,ny,nz,d keeps n.x + d >= 0;
    /// box:cx,cy,cz,hx,hy,hz[,qw,qx,qy,qz] has a centre, half sizes and a rotation. A leading ! keeps the outside
    #[arg(long, value_name = "SHAPE", value_parser = shape, allow_hyphen_values = true)]
    clip: Vec<Shape>,
    /// How several shapes combine: visible in all of them, or in any
    #[arg(long, value_name = "OP", default_value = "and")]
    clip_op: Op,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Op {
    And,
    Or,
}

/// A shape as the half-spaces that bound what it keeps.
#[derive(Debug, Clone, PartialEq)]
struct Shape {
    planes: Vec<Plane>,
    /// How the shape's own planes combine; a single plane fits either way.
    op: ClipOp,
}

impl ClipArgs {
    /// The clip that was meant. All shapes have to fit one list of half-spaces with one operation.
    pub(super) fn meant(&self) -> Result<Clip, Failure> {
        let asked = match self.clip_op {
            Op::And => ClipOp::And,
            Op::Or => ClipOp::Or,
        };
        // One shape alone has nothing to combine with, so its own operation holds.
        let op = match self.clip.as_slice() {
            [only] if only.planes.len() > 1 => only.op,
            _ => asked,
        };
        if let Some(misfit) = self.clip.iter().find(|s| s.planes.len() > 1 && s.op != op) {
            let (what, other) = match misfit.op {
                ClipOp::And => ("the inside of a box", "and"),
                ClipOp::Or => ("the outside of a box (!box)", "or"),
            };
            return Err(Failure::Usage(format!(
                "{what} cannot be combined with other shapes by --clip-op {}: a clip is half-spaces joined either all by 'and' or all by 'or', and {what} needs '{other}'",
                if op == ClipOp::And { "and" } else { "or" },
            )));
        }
        let planes: Vec<Plane> = self.clip.iter().flat_map(|s| s.planes.clone()).collect();
        if planes.len() > MAX_CLIP_PLANES as usize {
            return Err(Failure::Usage(format!(
                "the --clip shapes make {} half-spaces (a box makes six), and a clip has at most {MAX_CLIP_PLANES}",
                planes.len()
            )));
        }
        Ok(Clip { planes, op })
    }
}

fn shape(text: &str) -> Result<Shape, String> {
    let (outside, shape) = match text.strip_prefix('!') {
        Some(rest) => (true, rest),
        None => (false, text),
    };
    let (kind, numbers) = shape
        .split_once(':')
        .ok_or("expected a shape like plane:1,0,0,-0.5 or box:0,0,0,1,1,1")?;
    let planes = match kind {
        "plane" => vec![plane(values::numbers::<4>(numbers)?)?],
        "box" => sides(&values::number_list(numbers)?)?.to_vec(),
        "sphere" | "cylinder" => {
            return Err(format!("a {kind} is not implemented yet; use plane or box"));
        }
        _ => return Err(format!("'{kind}' is not a shape; use plane or box")),
    };
    if !outside {
        return Ok(Shape {
            planes,
            op: ClipOp::And,
        });
    }
    let flipped = planes.iter().map(|p| Plane::new(-p.normal(), -p.offset()));
    let planes = flipped
        .collect::<rara::Result<_>>()
        .map_err(|e| e.to_string())?;
    Ok(Shape {
        planes,
        op: ClipOp::Or,
    })
}

fn plane([x, y, z, offset]: [f64; 4]) -> Result<Plane, String> {
    Plane::new(DVec3::new(x, y, z), offset).map_err(|e| e.to_string())
}

/// A box's six half-spaces, their normals pointing inwards.
fn sides(numbers: &[f64]) -> Result<[Plane; 6], String> {
    if numbers.len() != 6 && numbers.len() != 10 {
        return Err(format!(
            "a box has 6 numbers (centre, half sizes) or 10 (and a quaternion w,x,y,z), not {}",
            numbers.len()
        ));
    }
    let centre = DVec3::from_slice(numbers);
    let half = &numbers[3..6];
    if half.iter().any(|h| *h <= 0.0) {
        return Err("a box's half sizes are above zero".into());
    }
    let turn = match numbers.get(6..10) {
        None => DQuat::IDENTITY,
        Some(&[w, x, y, z]) => {
            let largest = [w, x, y, z]
                .into_iter()
                .fold(0.0_f64, |a, b| a.max(b.abs()));
            if largest == 0.0 {
                return Err("a box's quaternion cannot be zero".into());
            }
            DQuat::from_xyzw(x / largest, y / largest, z / largest, w / largest).normalize()
        }
        Some(_) => unreachable!("the range has four elements"),
    };
    let side = |index: usize| {
        let inward = if index < 3 { -1.0 } else { 1.0 };
        let normal = turn * (DVec3::AXES[index % 3] * inward);
        Plane::new(normal, half[index % 3] - normal.dot(centre)).map_err(|e| e.to_string())
    };
    Ok([side(0)?, side(1)?, side(2)?, side(3)?, side(4)?, side(5)?])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn clip(shapes: &[&str], clip_op: Op) -> Result<Clip, Failure> {
        let clip = shapes.iter().map(|s| shape(s).unwrap()).collect();
        ClipArgs { clip, clip_op }.meant()
    }

    fn keeps(clip: &Clip, x: f64, y: f64, z: f64) -> bool {
        let mut inside = clip
            .planes
            .iter()
            .map(|p| p.distance(DVec3::new(x, y, z)) >= 0.0);
        match clip.op {
            ClipOp::And => inside.all(|i| i),
            ClipOp::Or => inside.any(|i| i),
        }
    }

    #[test]
    fn planes_flip() {
        let half = clip(&["plane:2,0,0,-1"], Op::And).unwrap();
        assert!(keeps(&half, 0.6, 0.0, 0.0) && !keeps(&half, 0.4, 0.0, 0.0));
        let other = clip(&["!plane:2,0,0,-1"], Op::And).unwrap();
        assert!(!keeps(&other, 0.6, 0.0, 0.0) && keeps(&other, 0.4, 0.0, 0.0));
    }

    #[test]
    fn boxes_keep_inside_or_outside_whatever_the_operation_says_when_alone() {
        for op in [Op::And, Op::Or] {
            let inside = clip(&["box:1,2,3,0.5,1,2"], op).unwrap();
            let outside = clip(&["!box:1,2,3,0.5,1,2"], op).unwrap();
            for (point, within) in [
                ([1.4, 2.9, 4.9], true),
                ([0.6, 1.1, 1.1], true),
                ([1.6, 2.0, 3.0], false),
                ([1.0, 0.9, 3.0], false),
                ([1.0, 2.0, 5.1], false),
            ] {
                let [x, y, z] = point;
                assert_eq!(keeps(&inside, x, y, z), within, "{point:?}");
                assert_eq!(keeps(&outside, x, y, z), !within, "{point:?}");
            }
        }
    }

    #[test]
    fn a_box_turns_with_its_quaternion() {
        // A quarter turn about z, not normalised: the long side comes to lie along y.
        let turned = clip(&["box:0,0,0,3,1,1,5,0,0,5"], Op::And).unwrap();
        assert!(keeps(&turned, 0.0, 2.9, 0.0) && !keeps(&turned, 2.0, 0.0, 0.0));
    }

    #[test]
    fn only_one_operation_joins_all_half_spaces() {
        assert!(clip(&["box:0,0,0,1,1,1", "plane:1,0,0,0"], Op::And).is_ok());
        assert!(clip(&["!box:0,0,0,1,1,1", "plane:1,0,0,0"], Op::Or).is_ok());
        assert!(clip(&["!box:0,0,0,1,1,1", "plane:1,0,0,0"], Op::And).is_err());
        assert!(clip(&["box:0,0,0,1,1,1", "plane:1,0,0,0"], Op::Or).is_err());
        assert!(clip(&["box:0,0,0,1,1,1", "!box:0,0,0,2,2,2"], Op::And).is_err());
    }

    #[test]
    fn nonsense_is_refused() {
        for text in [
            "plane",
            "plane:1,2,3",
            "plane:0,0,0,1",
            "plane:nan,0,0,1",
            "plane:1,0,0,inf",
            "box:0,0,0,1,1",
            "box:0,0,0,1,0,1",
            "box:0,0,0,1,1,1,0,0,0,0",
            "sphere:0,0,0,1",
            "cylinder:0,0,0,1,1,1,1",
            "cone:1",
            "",
        ] {
            assert!(shape(text).is_err(), "{text}");
        }
        let many: Vec<&str> =
            std::iter::repeat_n("plane:1,0,0,0", MAX_CLIP_PLANES as usize + 1).collect();
        assert!(clip(&many, Op::And).is_err());
    }
}
