//! The report on what was put right in a mesh, for people and for statistics.

use std::fmt;

use rara_base::counted::{counted, grouped};

/// What was changed in a mesh that was not as it should be.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct MeshReport {
    /// Vertices that were joined with another one at exactly their place.
    pub welded: u64,
    /// Faces left out because they have no area.
    pub degenerate: u64,
    /// Faces without an area that stay, since they close the surface between their neighbours.
    pub slivers: u64,
    /// Faces left out because another one has the same corners.
    pub duplicate: u64,
    /// Faces whose front and back were exchanged.
    pub turned: u64,
    /// Open edges that were closed, each by a face to the middle of its hole.
    pub closed: u64,
    /// The surfaces that are connected in themselves.
    pub shells: u64,
    /// How many of them are cavities.
    pub cavities: u64,
    /// Sentences that say what else a reader left out or assumed.
    pub notes: Vec<String>,
}

impl MeshReport {
    /// True when nothing had to be put right. Joined vertices do not count, since some formats have each once for every face.
    pub fn is_clean(&self) -> bool {
        self.lines().is_empty()
    }

    /// One sentence for each kind of change; none for a clean mesh.
    pub fn lines(&self) -> Vec<String> {
        let faces = |count: u64| counted(grouped(count), "face");
        let mut lines = Vec::new();
        let mut add = |count: u64, line: &dyn Fn() -> String| {
            if count > 0 {
                lines.push(line());
            }
        };
        add(self.degenerate, &|| {
            format!("dropped {} without an area", faces(self.degenerate))
        });
        add(self.slivers, &|| {
            format!(
                "kept {} without an area, which the surface needs to be closed",
                faces(self.slivers)
            )
        });
        add(self.duplicate, &|| {
            format!(
                "dropped {} that another has the corners of",
                faces(self.duplicate)
            )
        });
        add(self.turned, &|| {
            format!("turned {} round", faces(self.turned))
        });
        add(self.closed, &|| {
            format!(
                "closed {}, each to the middle of its hole",
                counted(grouped(self.closed), "open edge")
            )
        });
        lines.extend_from_slice(&self.notes);
        lines
    }
}

impl fmt::Display for MeshReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.lines()[..] {
            [] => f.write_str("nothing dropped or repaired"),
            lines => f.write_str(&lines.join("; ")),
        }
    }
}
