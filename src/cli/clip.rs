//! `--clip`, `--clip-file` and `--clip-op`: from their text to surfaces.

use std::cell::LazyCell;
use std::path::{Path, PathBuf};

use clap::Args;
use rara::clip::{Expression, NamedClip, Solid, clips_to_json, load_clips};
use rara::{Bounds, Clip, ClipOp, Plane, Scene};

use super::failure::Failure;
use super::json_kind::JsonKind;
use super::output;
use super::region::Region;
use super::scene_file::LayerClip;
use super::scene_layers::{LoadedLayer, SceneLayers};
use super::values;

/// The clip: the parts to cut away.
#[derive(Debug, Args)]
#[command(next_help_heading = "Clip")]
pub(super) struct ClipArgs {
    /// Keep the inside of a shape (repeatable); '!SHAPE' keeps its outside
    #[arg(long, value_name = "SHAPE", value_parser = Region::shape, allow_hyphen_values = true, long_help = shapes())]
    clip: Vec<Region>,
    /// Keep what an expression of shapes keeps: all(...), any(...), not(...)
    ///
    /// all(...) keeps what all of its operands keep, any(...) what at least one keeps, not(...) what its operand
    /// does not keep, as in 'all(box:0,0,0,1,1,1, not(sphere:1,0,0,.5))'. The flag is repeatable.
    #[arg(long, value_name = "EXPRESSION", value_parser = str::parse::<Region>, allow_hyphen_values = true)]
    clip_expr: Vec<Region>,
    /// Take clips from a JSON file (repeatable)
    ///
    /// The file is a list of planes, {"normal":[x,y,z],"d":d}, or of expressions as trees, {"clip":{"all":[...]}},
    /// as --save-clip writes them, each with a "name" or without. :NAME takes the clips of that name, or the one of
    /// that number (from 0), and :* takes all of them. A file of several clips with names needs one of these. The
    /// file's clips of single layers are taken as well, unless the name is that of one of these.
    #[arg(long, value_name = "FILE[:NAME]")]
    clip_file: Vec<String>,
    /// Write the clip to a JSON file, which --clip-file reads
    ///
    /// A section's own plane is not in it. Shares of the scene are written as the places that they mean.
    #[arg(long, value_name = "FILE")]
    save_clip: Option<PathBuf>,
    /// Keep what is in all shapes, or what is in any of them
    #[arg(long, value_name = "OP", default_value = "and")]
    clip_op: ClipOp,
}

fn shapes() -> String {
    let usages: Vec<&str> = Solid::usages().collect();
    format!(
        "Keep the inside of a shape (repeatable); '!SHAPE' keeps its outside\n\n{} plane:x=40% lies across an axis at 40 % of \
         the scene's robust bounds and keeps what lies beyond; slab:z=40%..60% lies between two shares. Shells need single \
         quotes around a leading !: '!box:0,0,0,1,1,1'.",
        usages.join(" ")
    )
}

/// The clip that flags make, before the scene is known in which parts of it may lie at shares.
#[derive(Debug, Clone, Default)]
pub(super) struct Regions {
    all: Vec<Region>,
    op: ClipOp,
    /// The clips of single layers that files have.
    layers: Vec<(String, LayerClip)>,
    save: Option<PathBuf>,
}

impl Regions {
    pub(super) fn op(&self) -> ClipOp {
        self.op
    }

    pub(super) fn is_empty(&self) -> bool {
        self.all.is_empty()
    }

    pub(super) fn expressions(&self, scene: &Scene<'_>) -> rara::Result<Vec<Expression>> {
        let bounds = LazyCell::new(|| Bounds::of(scene.clone()));
        self.all
            .iter()
            .map(|region| region.resolve(|| *bounds))
            .collect()
    }

    /// Gives layers the clips that files have for them, unless a flag says otherwise, and saves all clips where that is wanted.
    pub(super) fn settle(&self, loaded: &mut SceneLayers) -> Result<(), Failure> {
        for (name, clip) in &self.layers {
            for layer in loaded.named("--clip-file", name)? {
                if layer.clip == layer.listed.clip {
                    layer.clip = Some(clip.clone());
                }
            }
        }
        Ok(self.save(loaded)?)
    }

    pub(super) fn clip(&self, scene: &Scene<'_>) -> rara::Result<Clip> {
        Ok(joined(&self.expressions(scene)?, self.op))
    }

    /// Writes the clip to a file as one expression, and the layers' own clips, where that is wanted.
    fn save(&self, loaded: &SceneLayers) -> rara::Result<()> {
        let Some(path) = &self.save else {
            return Ok(());
        };
        let mut all = self.expressions(&loaded.scene())?;
        let clip = match (all.len(), self.op) {
            (1, _) => all.remove(0),
            (_, ClipOp::And) => Expression::All(all),
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
        let of_one = |layer: &LoadedLayer| {
            Some(NamedClip {
                name: layer.name.clone(),
                clip: layer.clip.as_ref()?.expression(),
                layer: Some(layer.name.clone()),
            })
        };
        let layers = loaded.layers.iter().filter_map(of_one);
        let clips: Vec<_> = [of_all].into_iter().chain(layers).collect();
        output::text(path, &clips_to_json(&clips))
    }
}

impl ClipArgs {
    /// The clip that the flags mean; reads its files.
    pub(super) fn meant(&self) -> Result<Regions, Failure> {
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
        let regions = self.regions(all, "--clip, --clip-expr or --clip-file")?;
        Ok(Regions { layers, ..regions })
    }

    /// The regions beside planes that files name, where those files clip nothing else.
    pub(super) fn beside_planes(&self) -> Result<Regions, Failure> {
        let typed = self.clip.iter().chain(&self.clip_expr).cloned();
        self.regions(
            typed.collect(),
            "--clip or --clip-expr: a section's plane is not saved",
        )
    }

    /// Regions that combine, and are saved, as the flags say; `flags` are those that give one.
    fn regions(&self, all: Vec<Region>, flags: &str) -> Result<Regions, Failure> {
        if self.save_clip.is_some() && all.is_empty() {
            return Err(Failure::Usage(format!(
                "--save-clip: there is no clip to save; give one by {flags}"
            )));
        }
        Ok(Regions {
            all,
            op: self.clip_op,
            layers: Vec::new(),
            save: self.save_clip.clone(),
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

/// True for several clips that have names, of which one is meant. The clips of single layers are none of these.
pub(super) fn are_alternatives(clips: &[NamedClip]) -> bool {
    let of_all = clips.iter().filter(|clip| clip.layer.is_none()).count();
    let mut named = clips.iter().enumerate();
    of_all > 1 && named.any(|(number, clip)| clip.name != number.to_string())
}

fn load(path: &Path) -> Result<Vec<NamedClip>, Failure> {
    load_clips(path).map_err(|error| JsonKind::Clips.wanted(path, error))
}

/// The clips of `FILE` or `FILE:NAME`. Names and paths may hold colons: a file that exists goes before a name.
fn from_file(text: &str) -> Result<Vec<NamedClip>, Failure> {
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
    let clips = load(path)?;
    let name = match name {
        Some(ALL) => None,
        None if are_alternatives(&clips) => {
            let of_all = clips.iter().filter(|named| named.layer.is_none());
            let names: Vec<_> = of_all.map(|named| named.name.as_str()).collect();
            return Err(Failure::Usage(format!(
                "--clip-file {text}: {} has {}, {}: say which, as in {}:{}, or {}:{ALL} for all of them together",
                path.display(),
                output::counted(names.len() as u64, "clip"),
                names.join(", "),
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
        let meant = values::meant(name, clips.iter().map(|named| named.name.as_str()));
        return Err(Failure::Usage(format!(
            "--clip-file {text}: {} has {}, and none of that name or number (from 0){meant}",
            path.display(),
            output::counted(clips.len() as u64, "clip")
        )));
    }
    if found.iter().any(|named| named.layer.is_none()) {
        // One of the clips of all: those of single layers belong to each of them.
        found.retain(|named| named.layer.is_none());
        found.extend(clips.into_iter().filter(|named| named.layer.is_some()));
    }
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    fn clip(shapes: &[&str], clip_op: ClipOp) -> Result<Clip, Failure> {
        let clip = shapes.iter().map(|s| Region::shape(s).unwrap()).collect();
        let clip_file = Vec::new();
        let args = ClipArgs {
            clip,
            clip_expr: Vec::new(),
            clip_file,
            save_clip: None,
            clip_op,
        };
        Ok(args.meant()?.clip(&Scene::default())?)
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
            assert!(Region::shape(text).is_err(), "{text}");
        }
    }
}
