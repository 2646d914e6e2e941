//! `--clip`, `--clip-file` and `--clip-op`: from their text to surfaces.

use std::path::{Path, PathBuf};

use clap::Args;
use rara::clip::{Expression, NamedClip, clips_to_json, load_clips};
use rara::{Clip, ClipOp, Plane, Shape};

use super::failure::Failure;
use super::output;
use super::values;

/// The clip: the parts to cut away.
#[derive(Debug, Args)]
#[command(next_help_heading = "Clip")]
pub(super) struct ClipArgs {
    /// A shape whose inside stays visible (repeatable): plane:nx,ny,nz,d keeps n.x + d >= 0; slab:nx,ny,nz,d,thickness
    /// begins at such a plane; box:cx,cy,cz,hx,hy,hz[,qw,qx,qy,qz] has a centre, half sizes and a rotation;
    /// sphere:cx,cy,cz,r; ellipsoid:cx,cy,cz,rx,ry,rz[,qw,qx,qy,qz]; cylinder:ax,ay,az,bx,by,bz,r lies between two discs;
    /// capsule:ax,ay,az,bx,by,bz,r is within r of a stretch of a line; cone:ax,ay,az,bx,by,bz,r has its tip at a and a disc
    /// around b. A leading ! keeps the outside, in single quotes: '!box:0,0,0,1,1,1'
    #[arg(long, value_name = "SHAPE", value_parser = shape, allow_hyphen_values = true)]
    clip: Vec<Shape>,
    /// An expression of shapes (repeatable): all(...) keeps what all of its operands keep, any(...) what any of them does,
    /// not(...) what its operand does not, as in 'all(box:0,0,0,1,1,1, not(sphere:1,0,0,.5))'
    #[arg(long, value_name = "EXPRESSION", value_parser = values::expression, allow_hyphen_values = true)]
    clip_expr: Vec<Expression>,
    /// The clips of a JSON file (repeatable): a list of planes, {"normal":[x,y,z],"d":d}, or of expressions as trees,
    /// {"clip":{"all":[...]}}, as --save-clip writes them, each with a "name" or without. :NAME takes only those of that
    /// name, or the one of that number (from 0)
    #[arg(long, value_name = "FILE[:NAME]")]
    clip_file: Vec<String>,
    /// Write the clip that the flags make to a JSON file, which --clip-file reads; a section's own plane is not in it
    #[arg(long, value_name = "FILE")]
    save_clip: Option<PathBuf>,
    /// How several shapes combine: visible in all of them, or in any
    #[arg(long, value_name = "OP", default_value = "and")]
    clip_op: ClipOp,
}

impl ClipArgs {
    /// The clip that the flags mean; reads its files.
    pub(super) fn meant(&self) -> Result<Clip, Failure> {
        let expressions = self.expressions()?;
        Ok(match &expressions[..] {
            [] => Clip::default(),
            all => Clip::joined(all.iter().map(Expression::clip), self.op()),
        })
    }

    /// The shapes and expressions that the flags mean; reads their files, and saves the clip where that is wanted.
    pub(super) fn expressions(&self) -> Result<Vec<Expression>, Failure> {
        let mut expressions: Vec<_> = self.clip.iter().copied().map(Expression::Shape).collect();
        for text in &self.clip_file {
            expressions.extend(from_file(text)?);
        }
        expressions.extend(self.clip_expr.iter().cloned());
        self.save(&expressions, "--clip, --clip-expr or --clip-file")?;
        Ok(expressions)
    }

    /// Writes the clip to a file as one expression, where that is wanted; `flags` are those that give one.
    fn save(&self, expressions: &[Expression], flags: &str) -> Result<(), Failure> {
        let Some(path) = &self.save_clip else {
            return Ok(());
        };
        let clip = match (expressions, self.op()) {
            ([], _) => {
                return Err(Failure::Usage(format!(
                    "--save-clip: there is no clip to save; give one by {flags}"
                )));
            }
            ([only], _) => only.clone(),
            (all, ClipOp::And) => Expression::All(all.into()),
            (all, ClipOp::Or) => Expression::Any(all.into()),
        };
        let name = path
            .file_stem()
            .unwrap_or_default()
            .to_string_lossy()
            .into();
        Ok(output::text(
            path,
            &clips_to_json(&[NamedClip { name, clip }]),
        )?)
    }

    /// The shapes and expressions that clip beside planes that files name, and saves them where that is wanted: those files clip
    /// nothing by themselves.
    pub(super) fn beside_planes(&self) -> Result<Vec<Expression>, Failure> {
        let shapes = self.clip.iter().copied().map(Expression::Shape);
        let typed: Vec<_> = shapes.chain(self.clip_expr.iter().cloned()).collect();
        self.save(
            &typed,
            "--clip or --clip-expr: a section's plane is not saved",
        )?;
        Ok(typed)
    }

    /// All planes of the files, with their names.
    pub(super) fn planes(&self) -> Result<Vec<(String, Plane)>, Failure> {
        let mut planes = Vec::new();
        for file in &self.clip_file {
            let plane = |named: NamedClip| Some((named.name, named.clip.as_plane()?));
            planes.extend(load_clips(file.as_ref())?.into_iter().filter_map(plane));
        }
        Ok(planes)
    }

    /// How they combine.
    pub(super) fn op(&self) -> ClipOp {
        self.clip_op
    }
}

fn shape(text: &str) -> Result<Shape, String> {
    text.parse().map_err(|error: rara::Error| error.to_string())
}

/// The clips of `FILE` or `FILE:NAME`. Names and paths may hold colons: a file that exists goes before a name.
fn from_file(text: &str) -> Result<Vec<Expression>, Failure> {
    let is_file = |at: usize| Path::new(&text[..at]).is_file();
    let named = if is_file(text.len()) {
        None
    } else {
        let mut colons = text.match_indices(':').map(|(at, _)| at);
        colons.find(|at| is_file(*at))
    };
    let (path, name) = match named {
        Some(at) => (Path::new(&text[..at]), Some(&text[at + 1..])),
        None => (Path::new(text), None),
    };
    let clips = load_clips(path)?;
    let Some(name) = name else {
        return Ok(clips.into_iter().map(|named| named.clip).collect());
    };
    let of_name = clips.iter().filter(|named| named.name == name);
    let mut found: Vec<Expression> = of_name.map(|named| named.clip.clone()).collect();
    if found.is_empty() {
        let numbered = name.parse().ok().and_then(|n: usize| clips.get(n));
        found.extend(numbered.map(|named| named.clip.clone()));
    }
    if found.is_empty() {
        let meant = values::meant(name, clips.iter().map(|named| named.name.as_str()));
        return Err(Failure::Usage(format!(
            "--clip-file {text}: {} has {} clips, and none of that name or number (from 0){meant}",
            path.display(),
            clips.len()
        )));
    }
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    fn clip(shapes: &[&str], clip_op: ClipOp) -> Result<Clip, Failure> {
        let clip = shapes.iter().map(|s| shape(s).unwrap()).collect();
        let clip_file = Vec::new();
        ClipArgs {
            clip,
            clip_expr: Vec::new(),
            clip_file,
            save_clip: None,
            clip_op,
        }
        .meant()
    }

    fn keeps(clip: &Clip, x: f64, y: f64, z: f64) -> bool {
        clip.keeps(DVec3::new(x, y, z))
    }

    #[test]
    fn planes_flip() {
        let half = clip(&["plane:2,0,0,-1"], ClipOp::And).unwrap();
        assert!(keeps(&half, 0.6, 0.0, 0.0) && !keeps(&half, 0.4, 0.0, 0.0));
        let other = clip(&["!plane:2,0,0,-1"], ClipOp::And).unwrap();
        assert!(!keeps(&other, 0.6, 0.0, 0.0) && keeps(&other, 0.4, 0.0, 0.0));
    }

    #[test]
    fn boxes_keep_inside_or_outside_whatever_the_operation_says_when_alone() {
        for op in [ClipOp::And, ClipOp::Or] {
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
        let turned = clip(&["box:0,0,0,3,1,1,5,0,0,5"], ClipOp::And).unwrap();
        assert!(keeps(&turned, 0.0, 2.9, 0.0) && !keeps(&turned, 2.0, 0.0, 0.0));
    }

    #[test]
    fn shapes_of_any_kind_combine() {
        let flat = clip(&["box:0,0,0,1,1,1", "plane:1,0,0,0"], ClipOp::And).unwrap();
        assert!(flat.is_flat() && flat.surfaces.len() == 7);
        let bitten = clip(&["!box:0,0,0,1,1,1", "plane:1,0,0,0"], ClipOp::And).unwrap();
        assert!(keeps(&bitten, 1.5, 0.0, 0.0) && !keeps(&bitten, 0.5, 0.0, 0.0));
        let both = clip(&["box:0,0,0,1,1,1", "sphere:3,0,0,1"], ClipOp::Or).unwrap();
        assert!(keeps(&both, 0.5, 0.0, 0.0) && keeps(&both, 3.5, 0.0, 0.0));
        assert!(!keeps(&both, 1.5, 0.0, 0.0));
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
            "sphere:0,0,0,0",
            "cylinder:0,0,0,0,0,0,1",
            "cone:1",
            "",
        ] {
            assert!(shape(text).is_err(), "{text}");
        }
    }
}
