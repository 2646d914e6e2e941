//! `--section`: planes that the camera faces square on, and what it sees of the scene behind them.

use clap::Args;
use rara::clip::Expression;
use rara::scene::Axis;
use rara::{Bounds, Clip, ClipOp, Gaussians, Plane, Scene};
use rara_shots::{Face, Visible};

use super::camera::CameraArgs;
use super::clip::{ClipArgs, Regions, joined};
use super::failure::Failure;
use super::values;
use super::views::NamedView;

/// The sections to draw. Each is a picture of its own.
#[derive(Debug, Args)]
#[command(next_help_heading = "Sections")]
pub(super) struct SectionArgs {
    /// Cut across an axis and face the cut: axial=40%, z=10%..90%:9, z@12.5 (repeatable)
    ///
    /// AXIS=SHARE cuts across an axis, at a share of the extent of the robust bounds that rara info prints. SHARE is from 0 to 1,
    /// or from 0% to 100%. AXIS@POSITION cuts at a position along the axis, world units. FROM..TO:COUNT in place of a share or a
    /// position makes COUNT sections in equal steps. AXIS is x or sagittal, y or coronal, z or axial. NAME alone cuts at the plane of
    /// this name in the file of --clip-file, even if an axis has the same name; the other clips of the file are then not used. A !
    /// before AXIS or NAME, as in !axial=40%, looks from the other side. The picture has no perspective.
    #[arg(long, value_name = "AXIS=SHARE|NAME", value_parser = wanted, allow_hyphen_values = true)]
    section: Vec<SectionRequest>,
    /// Thickness of the kept slab, world units [default: no limit]
    #[arg(long, value_name = "T", value_parser = values::positive, allow_hyphen_values = true)]
    section_thickness: Option<f32>,
    /// Scale, world units per pixel [default: all that is visible fits]
    ///
    /// By default, all sections across one axis have the same scale.
    #[arg(long, value_name = "S", value_parser = values::positive, allow_hyphen_values = true)]
    section_scale: Option<f32>,
}

#[derive(Debug, Clone, PartialEq)]
enum SectionRequest {
    /// At shares of the bounds.
    Across { axis: Axis, shares: Steps },
    /// At positions in the world.
    At { axis: Axis, positions: Steps },
    /// A plane by its name, and whether it is seen from the other side.
    Named(String, bool),
}

/// Numbers in equal steps.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Steps {
    from: f64,
    to: f64,
    count: u32,
}

/// The most sections of one flag.
const MOST: u32 = 100_000;

/// A share of the scene.
fn share(text: &str) -> Result<f64, String> {
    values::exact_share(text.trim()).map_err(|_| {
        format!("'{text}' is not a share of the scene from 0 to 1, or from 0% to 100%")
    })
}

/// A position along an axis.
fn position(text: &str) -> Result<f64, String> {
    values::finite(text.trim()).map_err(|_| format!("'{text}' is not a position: give a number"))
}

impl Steps {
    fn parse(text: &str, number: fn(&str) -> Result<f64, String>) -> Result<Self, String> {
        let Some((from, rest)) = text.split_once("..") else {
            let only = number(text)?;
            return Ok(Self {
                from: only,
                to: only,
                count: 1,
            });
        };
        let (to, count) = rest.split_once(':').ok_or_else(|| {
            format!(
                "'{text}' does not say how many sections: write FROM..TO:COUNT, as in 10%..90%:9"
            )
        })?;
        match count.trim().parse() {
            Ok(count) if (1..=MOST).contains(&count) => Ok(Self {
                from: number(from)?,
                to: number(to)?,
                count,
            }),
            _ => Err(format!(
                "'{count}' is not a number of sections from 1 to {MOST}"
            )),
        }
    }

    /// Both ends included; the middle where there is one.
    fn all(self) -> impl Iterator<Item = f64> {
        let last = f64::from(self.count - 1);
        (0..self.count).map(move |index| match self.count {
            1 => (self.from + self.to) / 2.0,
            _ => {
                let step = f64::from(index) / last;
                self.from * (1.0 - step) + self.to * step
            }
        })
    }
}

fn wanted(text: &str) -> Result<SectionRequest, String> {
    let at = |name: &str| Axis::parse(name).map(|axis| (axis, &text[name.len() + 1..]));
    if let Some((axis, positions)) = text.split_once('@').and_then(|(name, _)| at(name)) {
        let positions = Steps::parse(positions, position)?;
        return Ok(SectionRequest::At { axis, positions });
    }
    let Some((name, shares)) = text.split_once('=') else {
        return match text {
            "" => Err(
                "expected an axis and a share, such as axial=50%, or the name of a plane".into(),
            ),
            name => Ok(match name.strip_prefix('!') {
                Some(name) => SectionRequest::Named(name.into(), true),
                None => SectionRequest::Named(name.into(), false),
            }),
        };
    };
    let axis = Axis::parse(name).ok_or_else(|| {
        format!("'{name}' is not an axis; the axes are axial (z), coronal (y) and sagittal (x), each with or without a leading !")
    })?;
    let shares = Steps::parse(shares, share)?;
    Ok(SectionRequest::Across { axis, shares })
}

/// Sections whose flags have been checked, before the scene is known.
#[derive(Debug)]
pub(super) struct Sections {
    planned: Vec<SectionPlan>,
    /// What else clips.
    shapes: Regions,
    seen: rara_shots::Sections,
}

#[derive(Debug)]
enum SectionPlan {
    /// A section across an axis, at a share of the bounds along it.
    Across(Axis, f64),
    /// A section across an axis, at a position along it.
    At(Axis, f64),
    /// A plane by its name.
    Plane(String, Plane),
}

#[derive(Debug)]
pub(super) struct Section {
    pub(super) view: NamedView,
    /// Its plane, and the one at its back where it has a thickness.
    pub(super) own: Vec<Expression>,
    /// What else clips.
    pub(super) others: Vec<Expression>,
    /// The plane that the camera faces, and what else clips.
    pub(super) cut: Face,
}

impl Section {
    pub(super) fn clip(&self) -> Clip {
        joined(&[&self.others[..], &self.own].concat(), ClipOp::And)
    }
}

impl SectionArgs {
    /// The sections that the flags mean, if any; reads the files of planes.
    pub(super) fn meant(
        &self,
        camera: &CameraArgs,
        clip: &ClipArgs,
    ) -> Result<Option<Sections>, Failure> {
        if self.section.is_empty() {
            return Ok(None);
        }
        if camera.places() {
            return Err(Failure::Usage(
                "--section places the camera itself: leave out --eye, --target, --fov-y, --ortho, --camera, --cameras, --clip-near, --clip-far and --near-cut; \
                 --up, --size and --section-scale change what it shows"
                    .into(),
            ));
        }
        let is_named = self
            .section
            .iter()
            .any(|s| matches!(s, SectionRequest::Named(..)));
        let (shapes, planes) = if is_named {
            (clip.beside_planes()?, clip.planes()?)
        } else {
            (clip.meant()?, Vec::new())
        };
        if shapes.op() != ClipOp::And {
            return Err(Failure::Usage(
                "a --section and the other shapes together keep what is inside all of them: leave out --clip-op or".into(),
            ));
        }
        let mut planned = Vec::new();
        for wanted in &self.section {
            match wanted {
                SectionRequest::Across { axis, shares } => {
                    planned.extend(
                        shares
                            .all()
                            .map(|share| SectionPlan::Across(axis.clone(), share)),
                    );
                }
                SectionRequest::At { axis, positions } => {
                    let all = positions.all();
                    planned.extend(all.map(|at| SectionPlan::At(axis.clone(), at)));
                }
                SectionRequest::Named(name, is_turned) => {
                    let before = planned.len();
                    let found = planes.iter().filter(|(of, _)| of == name);
                    let plane = |plane: &Plane| match is_turned {
                        true => plane.flipped(),
                        false => *plane,
                    };
                    let sign = if *is_turned { "!" } else { "" };
                    planned.extend(found.map(|(_, found)| {
                        SectionPlan::Plane(format!("{sign}{name}"), plane(found))
                    }));
                    if planned.len() == before {
                        return Err(unknown(name, planes.iter().map(|(name, _)| name.as_str())));
                    }
                }
            }
        }
        let seen = rara_shots::Sections::new(camera.chosen_size())
            .up(camera.chosen_up())
            .scale(self.section_scale.map(f64::from))
            .thickness(self.section_thickness.map(f64::from));
        let sections = Sections {
            planned,
            shapes,
            seen,
        };
        // Errors that do not depend on the scene are found before it is read.
        let nothing = Gaussians::default();
        sections
            .sections(&(&nothing).into())
            .map_err(Failure::usage)?;
        Ok(Some(sections))
    }
}

fn unknown<'a>(name: &str, names: impl Iterator<Item = &'a str>) -> Failure {
    let names: Vec<_> = names.collect();
    let why = match (Axis::parse(name), &names[..]) {
        (Some(_), _) => format!(
            "give a share of the scene along this axis, as in {name}=50%, or a position, as in {name}@12.5; no --clip-file has a \
             plane of this name"
        ),
        (None, []) => {
            "no --clip-file has a plane of this name; a section across an axis is written as axial=50%"
                .into()
        }
        (None, names) => {
            let meant = values::meant(name, names.iter().copied());
            format!(
                "no --clip-file has a plane of this name; there are {}{meant}",
                names.join(", ")
            )
        }
    };
    Failure::Usage(format!("--section {name}: {why}"))
}

impl Sections {
    pub(super) fn numbers(&self) -> impl Iterator<Item = usize> + use<> {
        0..self.planned.len()
    }

    pub(super) fn regions(&self) -> &Regions {
        &self.shapes
    }

    /// The clip of a section in an example of a scene. The plane of any section stands for that of each.
    pub(super) fn example(&self) -> Clip {
        let plane = Plane::new(glam::DVec3::X, 0.0).ok();
        self.shapes
            .example(plane.map(|plane| Expression::Shape(plane.into())))
    }

    pub(super) fn sections(&self, scene: &Scene<'_>) -> rara::Result<Vec<Section>> {
        let bounds = Bounds::of(scene.clone());
        let others = self.shapes.expressions(scene)?;
        let rest = joined(&others, ClipOp::And);
        let visible = Visible::nearly_all_of(scene);
        let section = |(number, planned): (usize, &SectionPlan)| {
            let (name, seen) = match planned {
                SectionPlan::Across(axis, share) => (
                    format!("{}={share}", axis.name),
                    self.seen.across((axis, *share), &bounds, &visible)?,
                ),
                SectionPlan::At(axis, at) => (
                    format!("{}@{at}", axis.name),
                    self.seen.across_at((axis, *at), &visible)?,
                ),
                SectionPlan::Plane(name, plane) => (name.clone(), self.seen.at(*plane, &visible)?),
            };
            Ok(Section {
                view: NamedView {
                    number,
                    name,
                    camera: seen.camera,
                },
                own: seen.shapes(),
                others: others.clone(),
                cut: Face {
                    plane: seen.plane,
                    rest: rest.clone(),
                },
            })
        };
        self.planned.iter().enumerate().map(section).collect()
    }
}

#[cfg(test)]
mod tests;
