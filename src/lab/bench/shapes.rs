//! What each shape costs and how far its cut is from the truth, beside a plane through the same point.

use std::f64::consts::TAU;

use crate::measure;
use glam::{DQuat, DVec2, DVec3};
use rara::clip::{Expression, Inside, MeshShape, Prism, PrismBase};
use rara::scene::Bounds;
use rara::{Camera, Headless, Mesh, MeshRule, Mode, Placement, Plane, Result, Scene, Settings};
use rara_scene::mesh::shapes;
use serde::Serialize;

use crate::frames::picture;

use super::clock::{self, Times};
use super::judge::{finite, truth_settings};

/// One region, drawn exactly and by centres.
#[derive(Debug, Serialize)]
pub(crate) struct ShapeRow {
    pub(crate) name: &'static str,
    /// The region as `--clip-expr` takes it.
    pub(crate) region: String,
    pub(crate) cutoff: u32,
    pub(crate) exact: Times,
    pub(crate) hard: Times,
    /// Errors against the exact cut in double precision, of 255.
    pub(crate) l1: f64,
    pub(crate) hard_l1: f64,
    /// Peak signal to noise ratio against the same mode in double precision, decibels.
    #[serde(serialize_with = "finite")]
    pub(crate) twin_psnr: f64,
}

/// Draws every region through the middle of the scene, in turn with the others.
pub(crate) fn lines(
    headless: &mut Headless,
    scene: &Scene<'_>,
    camera: &Camera,
    plane: Plane,
    look: &Settings,
    frames: u32,
) -> Result<Vec<ShapeRow>> {
    headless.load_as(scene, look.precision.sh)?;
    let regions = regions(&Bounds::of(scene.clone()), plane)?;
    let [exact, hard] = [Mode::Exact, Mode::Hard].map(|mode| look.mode(mode));
    let mut lines = Vec::new();
    for (name, region) in &regions {
        let clip = region.clip();
        let truth =
            |settings: &Settings| rara_reference::render::<f64>(scene, camera, &clip, settings);
        let cut = truth(&truth_settings(look)).picture;
        let (drawn, stats) = picture(headless, camera, &clip, &exact)?;
        let by_centres = picture(headless, camera, &clip, &hard)?.0;
        lines.push(ShapeRow {
            name,
            region: region.to_string(),
            cutoff: stats.counts.cutoff,
            exact: Times::default(),
            hard: Times::default(),
            l1: measure::compare(&drawn, &cut)?.l1,
            hard_l1: measure::compare(&by_centres, &cut)?.l1,
            twin_psnr: measure::psnr(&drawn, &truth(&exact).picture)?,
        });
    }
    let clips: Vec<_> = regions.iter().map(|(_, region)| region.clip()).collect();
    let both = clips.iter().flat_map(|clip| [(clip, exact), (clip, hard)]);
    let both: Vec<_> = both.collect();
    let mut times = clock::time(headless, scene, camera, &both, frames)?.into_iter();
    for line in &mut lines {
        line.exact = times.next().expect("two times a line");
        line.hard = times.next().expect("two times a line");
    }
    Ok(lines)
}

/// The plane, and shapes about as large as the scene whose surfaces touch it in the same point and keep the same side there;
/// then combinations of them, a sphere around everything, a prism, and meshes.
pub(crate) fn regions(bounds: &Bounds, plane: Plane) -> Result<Vec<(&'static str, Expression)>> {
    let normal = plane.normal();
    let middle = bounds.centre() - normal * plane.distance(bounds.centre());
    let radius = bounds.radius();
    let (across, aside) = normal.any_orthonormal_pair();
    let turned = DQuat::from_rotation_arc(DVec3::X, normal);
    let list = |vector: DVec3| format!("{},{},{}", vector.x, vector.y, vector.z);
    let near = middle + normal * (0.6 * radius);
    let [from, to] = [-1.5, 1.5].map(|half| list(near + across * (half * radius)));
    let (near, turned) = (list(near), format!("{},{}", turned.w, list(turned.xyz())));
    let plane = format!("{},{}", list(normal), plane.offset());
    let half = list(DVec3::new(0.6, 1.0, 1.0) * radius);
    let cuboid = format!("box:{near},{half},{turned}");
    let radii = list(DVec3::new(0.6, 1.0, 0.8) * radius);
    let sphere = |at: DVec3, share: f64| format!("sphere:{},{}", list(at), share * radius);
    let regions = [
        ("plane", format!("plane:{plane}")),
        ("slab", format!("slab:{plane},{}", 0.8 * radius)),
        ("box", cuboid.clone()),
        ("sphere", sphere(middle + normal * radius, 1.0)),
        ("ellipsoid", format!("ellipsoid:{near},{radii},{turned}")),
        ("cylinder", format!("cylinder:{from},{to},{}", 0.6 * radius)),
        ("capsule", format!("capsule:{from},{to},{}", 0.6 * radius)),
        ("cone", format!("cone:{from},{to},{}", 1.2 * radius)),
        (
            "box and not sphere",
            format!("all({cuboid}, not({}))", sphere(middle, 0.4)),
        ),
        (
            "sphere or sphere or plane",
            format!(
                "any({}, {}, plane:{plane})",
                sphere(middle + aside * (0.4 * radius), 0.3),
                sphere(middle - aside * (0.4 * radius), 0.3)
            ),
        ),
        ("sphere around everything", sphere(middle, 100.0)),
    ];
    let parsed = regions
        .into_iter()
        .map(|(name, text)| Ok((name, text.parse()?)));
    let mut all = parsed.collect::<Result<Vec<_>>>()?;
    // The same sphere as meshes, a box as one, and a prism that is as wide.
    let (cube, arc) = (DVec3::splat(1.0), DQuat::from_rotation_arc);
    let at = Placement::new(middle + normal * radius, arc(DVec3::Z, across), radius)?;
    let corner = |at: u32| DVec2::from_angle(f64::from(at) * (TAU / 24.0));
    let ring = (0..24).map(corner).collect();
    let prism = Prism::new(PrismBase::Axis("z".into()), &[ring], None)?.placed(&at)?;
    all.push(("polygon of 24 corners", Expression::Prism(prism)));
    let turned = arc(DVec3::X, normal);
    for (name, triangles, turn, centre) in [
        ("mesh of a box", shapes::cuboid(-cube, cube), turned, 0.6),
        (
            "mesh of 1280 faces",
            shapes::icosphere(3),
            DQuat::IDENTITY,
            1.0,
        ),
        (
            "mesh of 81 920 faces",
            shapes::icosphere(6),
            DQuat::IDENTITY,
            1.0,
        ),
    ] {
        let mesh = Mesh::from_triangles(&triangles.0, &triangles.1, MeshRule::Closed)?;
        let at = Placement::new(middle + normal * (centre * radius), turn, centre * radius)?;
        let shape = MeshShape::new(format!("{name}.obj"), Inside::new(mesh, at));
        all.push((name, Expression::Mesh(shape)));
    }
    Ok(all)
}
