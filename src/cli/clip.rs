//! `--clip`, `--clip-file` and `--clip-op`: from their text to surfaces.

use std::cell::LazyCell;
use std::path::{Path, PathBuf};

use clap::Args;
use glam::DVec3;
use rara::clip::{Expression, Lasso, NamedClip, are_alternatives, clips_to_json, load_clips};
use rara::{Bounds, Camera, Clip, ClipOp, Plane, Scene, Shape};

use super::failure::Failure;
use super::json_kind::{JsonKind, wanted};
use super::layer_names;
use super::output;
use super::values;
use super::views::Views;
use rara::scene::layers::{LayerClip, LoadedLayer, Region, SceneLayers};

/// The clip: the parts to cut away.
#[derive(Debug, Args)]
#[command(next_help_heading = "Clip")]
pub struct ClipArgs {
    /// Keep the inside of a shape (repeatable); '!SHAPE' keeps its outside
    #[arg(long, value_name = "SHAPE", value_parser = Region::shape, allow_hyphen_values = true, long_help = shapes())]
    clip: Vec<Region>,
    /// Keep what an expression of shapes keeps: all(...), any(...), not(...)
    ///
    /// all(...) keeps the points that all of its operands keep. any(...) keeps the points that at least one operand keeps.
    /// not(...) keeps the points that its operand does not keep. An example is
    /// 'all(box:0,0,0,1,1,1, not(sphere:1,0,0,.5))'. The flag is repeatable.
    #[arg(long, value_name = "EXPRESSION", value_parser = str::parse::<Region>, allow_hyphen_values = true)]
    clip_expr: Vec<Region>,
    /// Take clips from a JSON file (repeatable)
    ///
    /// The file is a list of clips. Each element is a plane, such as {"normal":[x,y,z],"d":d}, or a tree of shapes, such as
    /// {"clip":{"all":[...]}}. An element may have a "name". An element with a "layer" cuts only the layer of this name.
    /// --save-clip writes such files.
    ///
    /// FILE:NAME takes the clips with this name, or the clip with this number, which counts from 0. FILE:* takes all clips. The
    /// clips that a file has for single layers are taken with any of these, unless NAME is the name of one of them: then only that one
    /// is taken. FILE alone takes all other clips if there is only one or if they have no names; else rara asks for a name.
    #[arg(long, value_name = "FILE[:NAME]")]
    clip_file: Vec<String>,
    /// Write the clip to a JSON file for --clip-file
    ///
    /// The plane of a --section is not written. Shares such as x=40% are written as coordinates. rara view writes the clip
    /// that it shows when the window closes.
    #[arg(long, value_name = "FILE", value_parser = values::json_file())]
    save_clip: Option<PathBuf>,
    /// Keep what is inside all shapes (and), or inside at least one of them (or)
    #[arg(long, value_name = "OP", value_parser = values::named::<ClipOp>(), default_value = ClipOp::default().name())]
    clip_op: ClipOp,
}

fn shapes() -> String {
    let usages: Vec<&str> = Expression::usages().collect();
    format!(
        "Keep the inside of a shape (repeatable); '!SHAPE' keeps its outside\n\n{}\n\nThe numbers may be shares of the scene's \
         robust bounds, which rara info prints. plane:x=40% is perpendicular to the x axis, at 40 % of the way from the smallest x \
         of the bounds to the largest, and keeps the side of larger x. slab:z=40%..60% lies between two such planes. In other \
         shapes, a share in place of a coordinate is a position between the ends of the bounds along this axis. A share in place \
         of a half size, or of a radius of an ellipsoid, is a share of the side of the bounds along its axis; any other radius is \
         a share of the longest side. sphere:50%,50%,50%,20% therefore has its centre in the middle of the bounds, and a radius of \
         20 % of their longest side.\n\nIn a shell, put single quotes around a leading !: '!box:0,0,0,1,1,1'.",
        usages.join("\n")
    )
}

/// The clip that flags make, before the scene is known in which parts of it may lie at shares.
#[derive(Debug, Clone, Default)]
pub struct Regions {
    all: Vec<Region>,
    op: ClipOp,
    /// The clips of single layers that files have.
    layers: Vec<(String, LayerClip)>,
    save: Option<PathBuf>,
    /// A shape of whose inside alone the others keep something.
    within: Option<Shape>,
    /// Polygons in the first picture, which become regions once that is known.
    lassos: Vec<Lasso>,
}

impl Regions {
    /// The same inside of a shape alone.
    pub(super) fn within(self, shape: Shape) -> Self {
        Self {
            within: Some(shape),
            ..self
        }
    }

    /// How the [expressions](Self::expressions) combine.
    pub(super) fn op(&self) -> ClipOp {
        match self.within {
            Some(_) => ClipOp::And,
            None => self.op,
        }
    }

    pub(super) fn is_empty(&self) -> bool {
        self.all.is_empty() && self.within.is_none() && self.lassos.is_empty()
    }

    /// Makes the lassos regions, as the first of these cameras sees them once the scene is known. Returns the cameras, which then
    /// are.
    pub(super) fn see_lassos(&mut self, views: Views, scene: &Scene<'_>) -> Result<Views, Failure> {
        if self.lassos.is_empty() {
            return Ok(views);
        }
        let views = views.in_scene(scene)?;
        for lasso in std::mem::take(&mut self.lassos) {
            let camera = &views[0].camera;
            let seen = lasso
                .expression(camera)
                .map_err(|error| Failure::Usage(format!("--lasso: {error}")))?;
            self.all.push(Region::Fixed(seen));
        }
        Ok(Views::Given(views))
    }

    pub(super) fn expressions(&self, scene: &Scene<'_>) -> rara::Result<Vec<Expression>> {
        let bounds = LazyCell::new(|| Bounds::of(scene.clone()));
        let typed = self.all.iter().map(|region| region.resolve(|| *bounds));
        let mut all = typed.collect::<rara::Result<Vec<_>>>()?;
        if let Some(within) = self.within {
            if self.op == ClipOp::Or && all.len() > 1 {
                all = vec![Expression::Any(all)];
            }
            all.push(Expression::Shape(within));
        }
        Ok(all)
    }

    /// The clip in an example of a scene, together with other expressions.
    pub(super) fn example(&self, others: Option<Expression>) -> Clip {
        let all = self.all.iter().map(|region| region.example().clone());
        let (eye, up) = (DVec3::NEG_Z, DVec3::NEG_Y);
        let camera = Camera::look_at(eye, DVec3::ZERO, up, 50.0, (1024, 1024));
        let lassos =
            (self.lassos.iter()).filter_map(|lasso| lasso.expression(camera.as_ref().ok()?).ok());
        joined(
            &all.chain(lassos).chain(others).collect::<Vec<_>>(),
            self.op,
        )
    }

    /// Gives layers the clips that files have for them, unless a flag says otherwise, and saves all clips where that is wanted.
    pub fn settle(&self, loaded: &mut SceneLayers) -> Result<(), Failure> {
        for (name, clip) in &self.layers {
            for layer in layer_names::named(loaded, "--clip-file", name)? {
                if layer.clip == layer.listed.clip {
                    layer.clip = Some(clip.clone());
                }
            }
        }
        if !self.is_empty() {
            layer_names::tell_own_clips(loaded);
        }
        Ok(self.save(loaded)?)
    }

    pub fn clip(&self, scene: &Scene<'_>) -> rara::Result<Clip> {
        Ok(joined(&self.expressions(scene)?, self.op()))
    }

    /// Writes the clip, and the layers' own clips, where that is wanted.
    fn save(&self, loaded: &SceneLayers) -> rara::Result<()> {
        let Some(path) = &self.save else {
            return Ok(());
        };
        let own = |layer: &LoadedLayer| Some((layer.name.clone(), layer.clip.clone()?));
        let layers = loaded.layers.iter().filter_map(own);
        save(
            path,
            self.expressions(&loaded.scene())?,
            self.op(),
            layers.collect(),
        )
    }
}

/// Writes a clip to a file as one expression, and the layers' own clips.
pub(super) fn save(
    path: &Path,
    mut all: Vec<Expression>,
    op: ClipOp,
    layers: Vec<(String, LayerClip)>,
) -> rara::Result<()> {
    let clip = match (all.len(), op) {
        (1, _) => all.remove(0),
        (0, _) | (_, ClipOp::And) => Expression::All(all),
        (_, ClipOp::Or) => Expression::Any(all),
    };
    let name = path
        .file_stem()
        .unwrap_or_default()
        .to_string_lossy()
        .into();
    let of_all = NamedClip {
        name,
        clip,
        layer: None,
    };
    let of_one = |(name, clip): (String, LayerClip)| NamedClip {
        name: name.clone(),
        clip: clip.expression(),
        layer: Some(name),
    };
    let clips: Vec<_> = std::iter::once(of_all)
        .chain(layers.into_iter().map(of_one))
        .collect();
    output::text(path, &clips_to_json(&clips))
}

impl ClipArgs {
    /// The file that the clip is to be written to once it is known, which is not when the flags are read.
    #[cfg(feature = "view")]
    pub(super) fn take_save(&mut self) -> Option<PathBuf> {
        self.save_clip.take()
    }

    /// The clip that the flags mean; reads its files.
    pub fn meant(&self) -> Result<Regions, Failure> {
        self.meant_beside(&[])
    }

    /// The same beside polygons in a picture.
    pub(super) fn meant_beside(&self, lassos: &[Lasso]) -> Result<Regions, Failure> {
        let mut all = self.clip.clone();
        let mut layers = Vec::new();
        for text in &self.clip_file {
            for NamedClip { clip, layer, .. } in from_file(text)? {
                match layer {
                    Some(layer) => layers.push((layer, LayerClip::from_expression(clip))),
                    None => all.push(Region::Fixed(clip)),
                }
            }
        }
        all.extend(self.clip_expr.iter().cloned());
        let flags = "--clip, --clip-expr or --clip-file";
        let regions = self.regions((all, lassos), flags)?;
        Ok(Regions { layers, ..regions })
    }

    /// The regions beside planes that files name, where those files clip nothing else.
    pub(super) fn beside_planes(&self) -> Result<Regions, Failure> {
        let typed = self.clip.iter().chain(&self.clip_expr).cloned();
        self.regions(
            (typed.collect(), &[]),
            "--clip or --clip-expr: a section's plane is not saved",
        )
    }

    /// Regions that combine, and are saved, as the flags say; `flags` are those that give one.
    fn regions(
        &self,
        (all, lassos): (Vec<Region>, &[Lasso]),
        flags: &str,
    ) -> Result<Regions, Failure> {
        if self.save_clip.is_some() && all.is_empty() && lassos.is_empty() {
            return Err(Failure::Usage(format!(
                "--save-clip: there is no clip to save; give one by {flags}"
            )));
        }
        Ok(Regions {
            all,
            op: self.clip_op,
            layers: Vec::new(),
            save: self.save_clip.clone(),
            within: None,
            lassos: lassos.to_vec(),
        })
    }

    /// All planes of the files, with their names.
    pub(super) fn planes(&self) -> Result<Vec<(String, Plane)>, Failure> {
        let mut planes = Vec::new();
        for file in &self.clip_file {
            let plane = |named: NamedClip| Some((named.name, named.clip.as_plane()?));
            planes.extend(load(file.as_ref())?.into_iter().filter_map(plane));
        }
        Ok(planes)
    }
}

/// What expressions keep together; everything where there is none.
pub(super) fn joined(all: &[Expression], op: ClipOp) -> Clip {
    match all {
        [] => Clip::default(),
        all => Clip::joined(all.iter().map(Expression::clip), op),
    }
}

/// The name that stands for all clips of a file.
const ALL: &str = "*";

fn load(path: &Path) -> Result<Vec<NamedClip>, Failure> {
    load_clips(path).map_err(|error| wanted(JsonKind::Clips, path, error))
}

/// The clips of `FILE` or `FILE:NAME`. Names and paths may hold colons: a file that exists goes before a name.
fn from_file(text: &str) -> Result<Vec<NamedClip>, Failure> {
    let is_file = |at: &usize| Path::new(&text[..*at]).is_file();
    let named = if is_file(&text.len()) {
        None
    } else {
        let colons = || text.match_indices(':').map(|(at, _)| at);
        let is_named_so = |at: &usize| text[..*at].ends_with(".json");
        colons()
            .find(is_file)
            .or_else(|| colons().find(is_named_so))
    };
    let (path, name) = match named {
        Some(at) => (Path::new(&text[..at]), Some(&text[at + 1..])),
        None => (Path::new(text), None),
    };
    let clips = load(path)?;
    let name = match name {
        Some(ALL) => None,
        None if are_alternatives(&clips) => {
            let of_all = clips.iter().filter(|named| named.layer.is_none());
            let names: Vec<_> = of_all.map(|named| named.name.as_str()).collect();
            return Err(Failure::Usage(format!(
                "--clip-file {text}: {} has {}; give one of them, as in {}:{}, or all of them together by {}:{ALL}",
                path.display(),
                listed(&names),
                path.display(),
                names[0],
                path.display(),
            )));
        }
        other => other,
    };
    let Some(name) = name else {
        return Ok(clips);
    };
    let of_name = clips.iter().filter(|named| named.name == name);
    let mut found: Vec<NamedClip> = of_name.cloned().collect();
    if found.is_empty() {
        let numbered = name.parse().ok().and_then(|n: usize| clips.get(n));
        found.extend(numbered.cloned());
    }
    if found.is_empty() {
        let names: Vec<_> = clips.iter().map(|named| named.name.as_str()).collect();
        let meant = values::meant(name, names.iter().copied());
        return Err(Failure::Usage(format!(
            "--clip-file {text}: no clip has the name or the number (from 0) '{name}'; {} has {}{meant}",
            path.display(),
            listed(&names)
        )));
    }
    if found.iter().any(|named| named.layer.is_none()) {
        // One of the clips of all: those of single layers belong to each of them.
        found.retain(|named| named.layer.is_none());
        found.extend(clips.into_iter().filter(|named| named.layer.is_some()));
    }
    Ok(found)
}

/// The number of clips of these names, and as many of the names as a line holds.
fn listed(names: &[&str]) -> String {
    const NAMED: usize = 8;
    let count = output::counted(names.len() as u64, "clip");
    let more = match names.len().saturating_sub(NAMED) {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    let names = &names[..names.len().min(NAMED)];
    format!("{count}: {}{more}", names.join(", "))
}

#[cfg(test)]
mod tests;
