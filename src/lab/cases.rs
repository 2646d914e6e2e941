//! The cases that the experiments and the user study share: scenes, each cut in three ways and seen from one side.

use std::path::PathBuf;

use glam::DVec3;
use rara::clip::Expression;
use rara::scene::{Bounds, Kind, generate, load};
use rara::{Camera, Clip, ClipOp, Error, Gaussians, Layer, Plane, Result, Scene, Shape};

#[derive(Debug)]
pub struct Source {
    pub name: String,
    pub gaussians: Gaussians,
}

/// Eight generated scenes of the three kinds, from `count` Gaussians each.
pub fn generated(count: usize) -> Vec<Source> {
    let all = [
        ("surfaces 1", Kind::General, count, 1),
        ("surfaces 2", Kind::General, count, 2),
        ("surfaces, coarse", Kind::General, count / 4, 3),
        ("hair 1", Kind::Strands, count, 1),
        ("hair 2", Kind::Strands, count, 2),
        ("hair, thin", Kind::Strands, count / 4, 3),
        ("anatomy", Kind::Layers, count, 1),
        ("anatomy, coarse", Kind::Layers, count / 4, 2),
    ];
    let source = |(name, kind, count, seed): (&str, Kind, usize, u64)| Source {
        name: name.into(),
        gaussians: generate(kind, count.max(1), seed),
    };
    all.into_iter().map(source).collect()
}

/// The scenes of these files, each under its file's name; without files, those that are [`generated`].
pub fn sources(files: &[PathBuf], count: usize) -> Result<Vec<Source>> {
    if files.is_empty() {
        return Ok(generated(count));
    }
    let source = |file: &PathBuf| {
        let stem = file.file_stem().unwrap_or(file.as_os_str());
        Ok(Source {
            name: stem.to_string_lossy().into(),
            gaussians: load(file, &mut |_, _| {})?.gaussians,
        })
    };
    files.iter().map(source).collect()
}

/// A name with nothing but letters, digits and hyphens, for files.
pub(crate) fn plain(name: &str) -> String {
    name.replace(|c: char| !c.is_ascii_alphanumeric(), "-")
}

/// The same names, with a number where an earlier one makes the same name of a file.
pub(crate) fn different(names: impl IntoIterator<Item = String>) -> Vec<String> {
    let mut all: Vec<String> = Vec::new();
    for name in names {
        let numbered = (2..).map(|number| format!("{name} ({number})"));
        let mut tried = std::iter::once(name.clone()).chain(numbered);
        let is_new = |name: &String| all.iter().all(|other| plain(other) != plain(name));
        all.push(tried.find(is_new).expect("numbers do not end"));
    }
    all
}

pub(crate) fn names(sources: &[Source], cases: &[Case]) -> Vec<String> {
    let of = |case: &Case| format!("{}, {}", sources[case.scene].name, case.cut.name());
    different(cases.iter().map(of))
}

impl Source {
    pub fn scene(&self) -> Scene<'_> {
        Scene::from_iter([Layer::new(&self.name, &self.gaussians)])
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum CaseCut {
    /// A cut by a plane that faces the camera obliquely, so that the cut surface is seen.
    Face,
    /// A cut by a plane that contains the direction of view, so that the cut is an edge.
    Edge,
    /// A cut by a ball that bites into the outline, from the left, above and before it.
    Bite,
}

impl CaseCut {
    pub const ALL: [Self; 3] = [Self::Face, Self::Edge, Self::Bite];

    pub fn name(self) -> &'static str {
        match self {
            Self::Face => "face",
            Self::Edge => "edge",
            Self::Bite => "bite",
        }
    }

    /// The normal of the plane that the visible side is beyond, or the direction in which the ball bites; a unit vector.
    fn direction(self, camera: &Camera) -> DVec3 {
        let [right, down, forward] = [0, 1, 2].map(|row| camera.rotation.row(row));
        match self {
            Self::Face => 0.6 * right + 0.8 * forward,
            Self::Edge => 0.8 * right + 0.6 * down,
            Self::Bite => (0.7 * right + 0.3 * down + 0.65 * forward).normalize(),
        }
    }
}

#[derive(Debug, Clone)]
pub struct Case {
    pub scene: usize,
    pub cut: CaseCut,
    pub camera: Camera,
    direction: DVec3,
    /// The places along the direction between which the cut moves: the 15th and the 85th percentile of the centres.
    range: [f64; 2],
    centre: DVec3,
}

impl Case {
    /// The direction along which the cut moves; a unit vector.
    pub fn direction(&self) -> DVec3 {
        self.direction
    }

    /// The cut at a share of its way, 0 to 1; 0.5 is where a single picture has it. Where the ball bites, it grows.
    pub fn at(&self, share: f64) -> Result<Clip> {
        let along = self.range[0] + share * (self.range[1] - self.range[0]);
        if self.cut != CaseCut::Bite {
            return Ok(Clip::of([Plane::new(self.direction, -along)?], ClipOp::And));
        }
        let reach = self.range[1] - self.range[0];
        let before = self.range[0] - 0.5 * reach - self.direction.dot(self.centre);
        let ball = Shape::sphere(
            self.centre + before * self.direction,
            along - self.range[0] + 0.5 * reach,
        )?;
        Ok(Expression::Shape(ball.complement()).clip())
    }
}

/// Every way of cutting each scene, in pictures of `size` pixels.
pub fn cases(scenes: &[Source], up: DVec3, size: (u32, u32)) -> Result<Vec<Case>> {
    let mut cases = Vec::new();
    for (scene, source) in scenes.iter().enumerate() {
        if source.gaussians.is_empty() {
            let message = "has no Gaussians, so that nothing can be cut; choose another one";
            return Err(Error::Invalid(format!(
                "the scene {:?} {message}",
                source.name
            )));
        }
        let camera = Camera::frame(&Bounds::of(&source.gaussians), up, 40.0, size)?;
        for cut in CaseCut::ALL {
            let direction = cut.direction(&camera);
            let along = |p: &glam::Vec3| direction.dot(p.as_dvec3());
            let mut places: Vec<f64> = source.gaussians.positions().iter().map(along).collect();
            places.sort_unstable_by(f64::total_cmp);
            let percentile = |p: usize| places[(places.len() - 1) * p / 100];
            cases.push(Case {
                scene,
                cut,
                camera,
                direction,
                range: [percentile(15), percentile(85)],
                centre: Bounds::of(&source.gaussians).centre(),
            });
        }
    }
    Ok(cases)
}

#[cfg(test)]
mod tests;
