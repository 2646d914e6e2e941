//! How cost and error grow with one property of the scene or of the cut, the others left alone.

use rara::scene::{Kind, generate};
use rara::{
    Camera, Clip, ClipOp, Gaussians, Headless, Layer, Mode, Plane, Result, Scene, Settings,
};
use serde::{Deserialize, Serialize};

use crate::bench::{time, truth_settings};
use crate::cases::{CaseCut, Source, cases};
use crate::charts::{Axis, Plot, Series as Line};
use crate::frames::{MODES, picture};
use crate::measure;
use crate::table::Table;

#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub(super) enum Property {
    /// The ratio of a Gaussian's longest axis to the others.
    Anisotropy,
    /// The place of the plane, and so how many splats it cuts.
    Place,
    Resolution,
    Count,
    /// The number of planes that cut the scene.
    Planes,
}

impl Property {
    pub(super) const ALL: [Self; 5] = [
        Self::Anisotropy,
        Self::Place,
        Self::Resolution,
        Self::Count,
        Self::Planes,
    ];

    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Anisotropy => "anisotropy",
            Self::Place => "share of cut splats",
            Self::Resolution => "resolution",
            Self::Count => "count",
            Self::Planes => "planes",
        }
    }

    fn axis(self) -> Axis {
        match self {
            Self::Anisotropy => Axis::log("longest axis over the others"),
            Self::Place => Axis::linear("splats that the plane cuts (% of those in view)"),
            Self::Resolution => Axis::log("width and height (px)"),
            Self::Count => Axis::log("Gaussians"),
            Self::Planes => Axis::linear("planes"),
        }
    }

    /// The values, where a scene has `count` Gaussians and a picture `size` pixels.
    fn values(self, count: usize, size: u32) -> Vec<f64> {
        let scaled =
            |base: f64, factors: &[f64]| factors.iter().map(|f| (base * f).round()).collect();
        match self {
            Self::Anisotropy => vec![1.0, 2.0, 5.0, 10.0, 20.0, 50.0],
            Self::Place => vec![0.05, 0.2, 0.35, 0.5, 0.65, 0.8, 0.95],
            Self::Resolution => scaled(f64::from(size), &[0.25, 0.5, 1.0, 2.0]),
            Self::Count => scaled(count as f64, &[0.1, 0.3, 1.0, 3.0]),
            Self::Planes => vec![1.0, 2.0, 3.0, 4.0, 6.0, 8.0],
        }
    }
}

/// A mode's name, milliseconds a frame, and L1 against the truth (of 255).
type Costs = (String, f64, f64);

#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct Point {
    /// The value; for [`Property::Place`] the percentage of the splats in view that are cut.
    pub x: f64,
    pub modes: Vec<Costs>,
}

#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct Series {
    pub property: Property,
    pub points: Vec<Point>,
}

/// Measures one property on generated surfaces of `count` Gaussians in pictures of `size` pixels.
pub(super) fn series(
    headless: &mut Headless,
    property: Property,
    (count, size, frames): (usize, u32, u32),
) -> Result<Series> {
    let mut points = Vec::new();
    for value in property.values(count, size) {
        let count = if property == Property::Count {
            value as usize
        } else {
            count
        };
        let size = if property == Property::Resolution {
            value as u32
        } else {
            size
        };
        let mut gaussians = generate(Kind::General, count.max(1), 11);
        if property == Property::Anisotropy {
            stretch(&mut gaussians, value as f32);
        }
        let source = [Source {
            name: property.name().into(),
            gaussians,
        }];
        let cases = cases(&source, glam::DVec3::NEG_Y, (size, size))?;
        let case = cases
            .into_iter()
            .find(|case| case.cut == CaseCut::Face)
            .expect("a case of each cut");
        let clip = match property {
            Property::Place => case.at(value)?,
            Property::Planes => planes(&case.camera, &case.at(0.5)?, value as u32)?,
            _ => case.at(0.5)?,
        };
        let scene = Scene::from_iter([Layer::new("series", &source[0].gaussians)]);
        let (point, cut) = point(headless, &scene, &case.camera, &clip, frames)?;
        points.push(Point {
            x: if property == Property::Place {
                cut
            } else {
                value
            },
            modes: point,
        });
    }
    points.sort_by(|a, b| a.x.total_cmp(&b.x));
    Ok(Series { property, points })
}

/// Time and error of each mode, and the percentage of the splats in view that are cut.
fn point(
    headless: &mut Headless,
    scene: &Scene<'_>,
    camera: &Camera,
    clip: &Clip,
    frames: u32,
) -> Result<(Vec<Costs>, f64)> {
    let base = Settings::default();
    headless.load_as(scene, base.precision.sh)?;
    let truth = rara_reference::render::<f64>(scene, camera, clip, &truth_settings(&base)).picture;
    let settings = MODES.map(|(_, mode)| (clip, base.mode(mode)));
    let times = time(headless, scene, camera, &settings, frames)?;
    let mut modes = Vec::new();
    let mut share = 0.0;
    for ((name, _), ((_, settings), times)) in MODES.iter().zip(settings.iter().zip(times)) {
        let (drawn, stats) = picture(headless, camera, clip, settings)?;
        let counts = stats.counts;
        let seen = counts.visible + counts.cutoff + counts.invisible;
        if settings.mode == Mode::Exact {
            share = 100.0 * f64::from(counts.cutoff) / f64::from(seen.max(1));
        }
        modes.push((
            (*name).into(),
            times.cost,
            measure::differences(&drawn, &truth)?.l1,
        ));
    }
    Ok((modes, share))
}

/// Makes the longest axis of each Gaussian longer and the others shorter, so that the volume stays.
fn stretch(gaussians: &mut Gaussians, ratio: f32) {
    for scales in gaussians.scales_mut() {
        let volume = (scales.x * scales.y * scales.z).max(f32::MIN_POSITIVE);
        let short = (volume / ratio).cbrt();
        let longest = scales.max_position();
        *scales = glam::Vec3::splat(short);
        scales[longest] = short * ratio;
    }
}

/// Planes around the middle of the picture that the clip's plane is turned into; each of them cuts the scene.
fn planes(camera: &Camera, clip: &Clip, count: u32) -> Result<Clip> {
    let first = clip.surfaces[0]
        .as_plane()
        .expect("the case is cut by a plane");
    let (right, down) = (camera.rotation.row(0), camera.rotation.row(1));
    let turned = |k: u32| {
        if k == 0 {
            return Ok(first);
        }
        let angle = std::f64::consts::TAU * f64::from(k) / f64::from(count);
        let normal = first.normal() + 0.7 * (angle.cos() * right + angle.sin() * down);
        Plane::new(
            normal,
            first.offset() * normal.length() + 0.1 * normal.length(),
        )
    };
    Ok(Clip::of(
        (0..count).map(turned).collect::<Result<Vec<_>>>()?,
        ClipOp::And,
    ))
}

pub(super) fn charts(series: &Series) -> [Plot; 2] {
    let property = series.property;
    let chart = |what: &str, y: &str, first: usize, value: fn(&Costs) -> f64| {
        let line = |index: usize| {
            let points = series.points.iter();
            let points = points.map(|p| (p.x, value(&p.modes[index]), String::new()));
            Line {
                name: MODES[index].0.into(),
                points: points.collect(),
            }
        };
        Plot {
            title: format!("{what} by {}", property.name()),
            x: property.axis(),
            y: Axis::log(y),
            series: (first..MODES.len()).map(line).collect(),
            joined: true,
            front: Vec::new(),
        }
    };
    [
        chart("Cost", "cost (ms per frame)", 0, |costs| costs.1),
        // The first mode cuts nothing.
        chart("Error", "L1 against the truth (of 255)", 1, |costs| costs.2),
    ]
}

pub(super) fn table(all: &[Series]) -> Table {
    let note = "Generated surfaces; everything but the property stays. Cost: milliseconds per frame, as in the table of run \
        time against error. L1 is on a scale of 0 to 255.";
    let columns = ["property", "value"].map(String::from).into_iter();
    let modes = MODES
        .iter()
        .flat_map(|(name, _)| [format!("{name}: cost"), format!("{name}: L1")]);
    let mut table = Table::new("Cost and error by one property", note, columns.chain(modes));
    for series in all {
        for point in &series.points {
            let first = [series.property.name().into(), point.x.into()];
            let modes = point
                .modes
                .iter()
                .flat_map(|(_, ms, l1)| [(*ms).into(), (*l1).into()]);
            table.row(first.into_iter().chain(modes));
        }
    }
    table
}
