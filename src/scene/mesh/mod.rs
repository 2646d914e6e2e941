//! Closed meshes of triangles: files and lists of them, what is checked and put right, and where their inside is.
//!
//! A [`Mesh`] has its faces in the order of a hierarchy of boxes, by which all questions about it are answered. Its front is
//! outside: the corners of a face turn to the left as seen from there.

mod duplicates;
mod edges;
mod faces;
mod lines;
mod meet;
mod near;
mod orient;
mod outline;
mod packed;
#[cfg(feature = "formats")]
mod polygon;
#[cfg(feature = "formats")]
mod read;
mod report;
mod sets;
pub mod shapes;
mod tree;
mod weld;

use std::fmt;
use std::hash::{Hash, Hasher};
use std::sync::{Arc, OnceLock};

use glam::DVec3;

use self::edges::Edges;
use self::faces::Faces;
pub use self::near::Nearest;
use self::orient::Shells;
pub use self::packed::{PackedMesh, PackedNode};
pub use self::report::MeshReport;
pub use self::tree::{LEAF, MeshTree, Node};
use rara_base::error::{Error, Result};
use rara_base::fnv;
use rara_base::named;

/// The most faces of a mesh.
pub const MOST_FACES: usize = 1 << 26;

named! {
    /// What the inside of a mesh is, and what is asked of it for that.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
    pub enum MeshRule {
        /// The surface is closed and does not cut itself. Its faces are turned such that the front of each shell is outside, unless
        /// the shell is in another one, where it bounds a cavity, in which another may be, and so on.
        #[default]
        Closed = "closed",
        /// A point is inside where the winding number around it is not zero: faces may cut each other, and each keeps the direction
        /// that it has. What is open is closed first, each hole by faces from its rim to the middle of its vertices; a point behind a
        /// flat hole is then inside where the hole fills less than half of what is seen from it (a generalised winding number above
        /// 1/2).
        Winding = "winding",
    }
}

/// A closed mesh of triangles in double precision. Copies share its memory, and meshes are equal that have the same content.
#[derive(Clone)]
pub struct Mesh(Arc<Content>);

struct Content {
    /// Its faces are in the order of the tree.
    made: Faces,
    /// As [`Edges::twins`], once they are asked for.
    twins: OnceLock<Vec<u32>>,
    /// As [`Mesh::packed`], once it is asked for.
    packed: OnceLock<PackedMesh>,
    rule: MeshRule,
    tree: MeshTree,
    centre: DVec3,
    scale: f64,
    report: MeshReport,
    hash: u64,
}

impl Mesh {
    /// Makes a mesh of faces, each the numbers of three vertices, which turn to the left as seen from the front.
    ///
    /// # Errors
    /// [`Error::Invalid`] names the face or the edge at which it is not what the rule asks for, and what to do.
    pub fn from_triangles(vertices: &[DVec3], faces: &[[u32; 3]], rule: MeshRule) -> Result<Self> {
        Self::make(vertices, faces, rule, MeshReport::default()).map_err(Error::Invalid)
    }

    /// Reads a mesh from an OBJ, STL, PLY or glTF file, whichever it is by its content.
    ///
    /// # Errors
    /// [`Error::Io`] where it cannot be read, and [`Error::Format`] where it is no mesh, or not as the rule asks for.
    #[cfg(feature = "formats")]
    pub fn read(path: impl AsRef<std::path::Path>, rule: MeshRule) -> Result<Self> {
        let path = path.as_ref();
        let read = read::read(path)?;
        let made = Self::make(&read.vertices, &read.faces, rule, read.report);
        made.map_err(|message| Error::format(path, message))
    }

    fn make(
        vertices: &[DVec3],
        faces: &[[u32; 3]],
        rule: MeshRule,
        mut report: MeshReport,
    ) -> std::result::Result<Self, String> {
        if faces.len() > MOST_FACES {
            return Err(format!(
                "the mesh has {} faces, and at most {MOST_FACES} are read; simplify it",
                faces.len()
            ));
        }
        let mut made = weld::welded(vertices, faces, rule, &mut report)?;
        if made.faces.is_empty() {
            return Err("the mesh has no faces with an area; export it again".into());
        }
        let mut edges = Edges::new(&made);
        let mut shells = match rule {
            MeshRule::Closed => {
                edges = weld::without_slivers(&mut made, edges, &mut report);
                edges.check(&made)?;
                Some(Shells::connect(&mut made, &edges)?)
            }
            MeshRule::Winding => {
                edges.close(&mut made, &mut report);
                None
            }
        };
        drop(edges);
        let (tree, order) = MeshTree::build(&made.vertices, &made.faces);
        made = made.in_order(&order);
        if let Some(shells) = &mut shells {
            shells.reorder(&order);
            meet::check(&made, &tree, meet::MOST_PAIRS)?;
            shells.face_outward(&mut made, &tree, &mut report);
        }
        let (low, high) = match tree.nodes().first() {
            Some(root) => (root.low, root.high),
            None => (DVec3::ZERO, DVec3::ZERO),
        };
        let mut content = Content {
            hash: 0,
            centre: low + 0.5 * (high - low),
            scale: 0.5 * (high - low).max_element(),
            made,
            twins: OnceLock::new(),
            packed: OnceLock::new(),
            rule,
            tree,
            report,
        };
        content.hash = content.hashed();
        Ok(Self(Arc::new(content)))
    }

    /// The vertices, no two at one place.
    pub fn vertices(&self) -> &[DVec3] {
        &self.0.made.vertices
    }

    /// The faces in the order of the tree, each the numbers of its vertices.
    pub fn faces(&self) -> &[[u32; 3]] {
        &self.0.made.faces
    }

    /// The corners of a face.
    #[inline]
    pub fn corners(&self, face: u32) -> [DVec3; 3] {
        self.0.made.corners(face as usize)
    }

    /// The rule that its inside is by.
    pub fn rule(&self) -> MeshRule {
        self.0.rule
    }

    /// The hierarchy of boxes over its faces.
    pub fn tree(&self) -> &MeshTree {
        &self.0.tree
    }

    /// What was put right in it.
    pub fn report(&self) -> &MeshReport {
        &self.0.report
    }

    /// The middle of its bounding box.
    pub fn centre(&self) -> DVec3 {
        self.0.centre
    }

    /// Half of the longest side of its bounding box.
    pub fn scale(&self) -> f64 {
        self.0.scale
    }

    /// The least and the greatest coordinates of its vertices.
    pub fn bounds(&self) -> [DVec3; 2] {
        let root = self.tree().nodes().first();
        root.map_or([DVec3::ZERO; 2], |root| [root.low, root.high])
    }

    /// A place relative to the centre, in units of the scale, as a [`PackedMesh`] has it.
    pub fn to_unit(&self, place: DVec3) -> DVec3 {
        (place - self.centre()) / self.scale()
    }

    /// A hash of the content, which is the same for meshes that are equal.
    pub fn content_hash(&self) -> u64 {
        self.0.hash
    }
}

impl Content {
    fn hashed(&self) -> u64 {
        let numbers = self.made.vertices.iter().flat_map(DVec3::to_array);
        let mut hash = fnv::with(fnv::NOTHING, numbers.map(f64::to_bits));
        hash = fnv::with(hash, self.made.faces.iter().flatten().copied());
        fnv::with(hash, [self.rule as u32])
    }
}

impl PartialEq for Mesh {
    fn eq(&self, other: &Self) -> bool {
        let (a, b) = (&*self.0, &*other.0);
        let is_same = || (&a.made, a.rule) == (&b.made, b.rule);
        Arc::ptr_eq(&self.0, &other.0) || (a.hash == b.hash && is_same())
    }
}

impl Eq for Mesh {}

impl Hash for Mesh {
    fn hash<H: Hasher>(&self, state: &mut H) {
        state.write_u64(self.0.hash);
    }
}

/// Only what tells meshes apart.
impl fmt::Debug for Mesh {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut shown = f.debug_struct("Mesh");
        shown.field("vertices", &self.vertices().len());
        shown.field("faces", &self.faces().len());
        shown.field("rule", &self.0.rule);
        shown.field("hash", &self.0.hash).finish()
    }
}

#[cfg(test)]
mod tests;
