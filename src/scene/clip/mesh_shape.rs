//! Meshes of files as shapes of an expression: scaled, turned and moved.

use std::fmt;
use std::path::{Path, PathBuf};

use glam::{DQuat, DVec3};
#[cfg(feature = "json")]
use serde::{Deserialize, Serialize};

use super::Inside;
#[cfg(feature = "formats")]
use crate::mesh::Mesh;
use crate::mesh::MeshRule;
use crate::placement::Placement;
use crate::text_reader::number;
use rara_base::error::{Error, Result, shortened};

/// The inside of the mesh of a file, scaled, turned and moved. It parses from the text that follows `mesh:`, which is the file and then
/// these parts in any order: `cutter.stl;scale=0.5;turn=1,0,0,0;at=0,0,2;winding`.
#[derive(Debug, Clone, PartialEq)]
pub struct MeshShape {
    path: PathBuf,
    inside: Inside,
}

impl MeshShape {
    /// How it is written as text, and what that means: its text in [`Expression::usages`](super::Expression::usages).
    pub(super) const USAGE: &str = "mesh:FILE is the inside of a closed mesh (.obj, .stl, .ply, .gltf or .glb). \
         mesh:FILE;scale=S;turn=W,X,Y,Z;at=X,Y,Z scales it, turns it by a quaternion and then moves it. mesh:FILE;winding takes a mesh that \
         is open or cuts itself, too: its inside is where the winding number is not zero.";

    /// Makes the shape of a mesh. The path names it in texts.
    pub fn new(path: impl Into<PathBuf>, inside: Inside) -> Self {
        Self {
            path: path.into(),
            inside,
        }
    }

    /// Reads the mesh of a file.
    ///
    /// # Errors
    /// The errors of [`Mesh::read`].
    #[cfg(feature = "formats")]
    pub fn read(path: impl AsRef<Path>, rule: MeshRule, placement: Placement) -> Result<Self> {
        let mesh = Mesh::read(path.as_ref(), rule)?;
        Ok(Self::new(path.as_ref(), Inside::new(mesh, placement)))
    }

    #[cfg(not(feature = "formats"))]
    fn read(path: &Path, _: MeshRule, _: Placement) -> Result<Self> {
        let what = "this build reads no files of meshes; build it with the feature `formats`";
        Err(Error::format(path, what))
    }

    /// Reads the text that follows `mesh:`.
    pub(super) fn parse(text: &str) -> Result<Self> {
        let mut parts = text.split(';').map(str::trim);
        let path = Path::new(parts.next().unwrap_or_default());
        if path.as_os_str().is_empty() {
            let what = "a mesh needs a file, as in mesh:cutter.stl";
            return Err(Error::Invalid(what.into()));
        }
        let (mut position, mut rotation, mut scale) = (DVec3::ZERO, DQuat::IDENTITY, 1.0);
        let mut rule = MeshRule::default();
        for part in parts {
            match part.split_once('=') {
                Some(("at", value)) => position = DVec3::from_array(numbers(value)?),
                Some(("turn", value)) => {
                    let [w, x, y, z] = numbers(value)?;
                    rotation = DQuat::from_xyzw(x, y, z, w);
                }
                Some(("scale", value)) => scale = number(value)?,
                _ => {
                    rule = part.parse().map_err(|_| {
                        Error::Invalid(format!(
                            "'{}' is not a part of a mesh; use scale=s, turn=qw,qx,qy,qz, at=x,y,z, closed or winding",
                            shortened(part)
                        ))
                    })?;
                }
            }
        }
        Self::read(path, rule, Placement::new(position, rotation, scale)?)
    }

    /// Returns the file of the mesh.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Returns the inside of the mesh where it stands.
    pub fn inside(&self) -> &Inside {
        &self.inside
    }

    /// Returns the mesh after it was scaled, then turned, then moved, as a scene with this placement is.
    ///
    /// # Errors
    /// The errors of [`Placement::new`], where numbers overflow.
    pub fn placed(&self, placement: &Placement) -> Result<Self> {
        Ok(Self::new(&self.path, self.inside.placed(placement)?))
    }

    /// Returns the middle of its bounds, world units.
    pub fn middle(&self) -> DVec3 {
        let inside = &self.inside;
        inside.placement().to_world(inside.mesh().centre())
    }

    /// The mesh at a share of the way to another place of it, if both are the same mesh.
    pub(super) fn between(&self, other: &Self, share: f64) -> Option<Result<Self>> {
        if share == 0.0 || share == 1.0 {
            return Some(Ok(if share == 0.0 { self } else { other }.clone()));
        }
        let mesh = self.inside.mesh();
        let [from, to] = [self, other].map(|one| *one.inside.placement());
        let placement = Placement::new(
            from.position().lerp(to.position(), share),
            from.rotation().slerp(to.rotation(), share),
            from.scale() + share * (to.scale() - from.scale()),
        );
        let at = |placement| Self::new(&self.path, Inside::new(mesh.clone(), placement));
        (mesh == other.inside.mesh()).then(|| placement.map(at))
    }

    /// The numbers of its placement that are not those of the identity.
    fn moves(&self) -> Moves {
        let placement = self.inside.placement();
        let DQuat { x, y, z, w } = placement.rotation();
        let position = placement.position();
        Moves {
            scale: (placement.scale() != 1.0).then(|| placement.scale()),
            turn: ((x, y, z) != (0.0, 0.0, 0.0)).then_some([w, x, y, z]),
            at: (position != DVec3::ZERO).then(|| position.to_array()),
        }
    }
}

/// The parts of a placement that do something.
struct Moves {
    scale: Option<f64>,
    turn: Option<[f64; 4]>,
    at: Option<[f64; 3]>,
}

fn numbers<const N: usize>(text: &str) -> Result<[f64; N]> {
    let numbers: Vec<f64> = text.split(',').map(number).collect::<Result<_>>()?;
    let count = numbers.len();
    let wrong = |_| Error::Invalid(format!("'{text}' has {count} numbers; give {N}"));
    numbers.try_into().map_err(wrong)
}

/// The text that follows `mesh:`.
impl fmt::Display for MeshShape {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.path.display())?;
        let Moves { scale, turn, at } = self.moves();
        if let Some(scale) = scale {
            write!(f, ";scale={scale}")?;
        }
        if let Some([w, x, y, z]) = turn {
            write!(f, ";turn={w},{x},{y},{z}")?;
        }
        if let Some([x, y, z]) = at {
            write!(f, ";at={x},{y},{z}")?;
        }
        match self.inside.mesh().rule() {
            MeshRule::Closed => Ok(()),
            rule => write!(f, ";{rule}"),
        }
    }
}

/// A mesh as JSON has it.
#[cfg(feature = "json")]
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct MeshRecord {
    file: PathBuf,
    #[serde(skip_serializing_if = "Option::is_none")]
    rule: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    scale: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    turn: Option<[f64; 4]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    at: Option<[f64; 3]>,
}

/// Its file by its whole path, so that the text means the same wherever it is saved.
#[cfg(feature = "json")]
impl From<&MeshShape> for MeshRecord {
    fn from(mesh: &MeshShape) -> Self {
        let Moves { scale, turn, at } = mesh.moves();
        let rule = mesh.inside.mesh().rule();
        Self {
            file: std::path::absolute(&mesh.path).unwrap_or_else(|_| mesh.path.clone()),
            rule: (rule != MeshRule::default()).then(|| rule.to_string()),
            scale,
            turn,
            at,
        }
    }
}

#[cfg(feature = "json")]
impl TryFrom<MeshRecord> for MeshShape {
    type Error = Error;

    fn try_from(record: MeshRecord) -> Result<Self> {
        let [w, x, y, z] = record.turn.unwrap_or([1.0, 0.0, 0.0, 0.0]);
        let placement = Placement::new(
            record.at.unwrap_or_default().into(),
            DQuat::from_xyzw(x, y, z, w),
            record.scale.unwrap_or(1.0),
        )?;
        let rule = record.rule.map(|rule| rule.parse()).transpose()?;
        Self::read(&record.file, rule.unwrap_or_default(), placement)
    }
}

#[cfg(all(test, feature = "formats", feature = "json"))]
mod tests;
