//! What of a scene is in a picture that shows all of it, and the cameras that hold it.

use glam::{DMat3, DVec2, DVec3, Vec3Swizzles};
use rara::{Camera, Plane, Scene};

use super::linked::{WeightedPoint, framed};
use super::reach::Reach;

/// Share of the picture that is filled.
const FILL: f64 = 0.92;
/// Nothing is nearer than this depth, as splats nearer than 0.2 are culled.
const NEAREST: f64 = 0.25;
/// Shares of the greatest opacity in the scene: of one that shows, and of what a Gaussian has to have at a place to reach there.
const FAINT: f64 = 0.02;
const AT_REACH: f64 = 0.1;
/// The most Gaussians of a layer that are looked at.
const SAMPLE: usize = 1 << 19;
/// Of all directions from the middle, so many lines and columns have a farthest Gaussian each: those decide how all others are
/// held, but for half a thousandth.
const LINES: usize = 64;
const COLUMNS: usize = 128;

/// What of a scene is framed.
#[derive(Debug)]
pub(in super::super) struct Visible {
    /// The outermost, which decide.
    outermost: Vec<Reach>,
    pub(in super::super) middle: DVec3,
    pub(in super::super) radius: f64,
}

impl Visible {
    /// What is framed of a scene: of each layer that is shown what is linked to most of it, and more where that weighs much for
    /// the room that it takes. Clips do not count, so that a picture with a clip and one without are taken from one place.
    pub(in super::super) fn from_scene(scene: &Scene<'_>) -> Self {
        Self::chosen(scene, false)
    }

    /// The same with all but what is hardly there, for pictures that have to hold what is asked for.
    pub(in super::super) fn nearly_all_of(scene: &Scene<'_>) -> Self {
        Self::chosen(scene, true)
    }

    fn chosen(scene: &Scene<'_>, generous: bool) -> Self {
        let layers = scene.layers().iter();
        let shown: Vec<_> = layers.filter(|layer| layer.state().visible).collect();
        let opacities = shown.iter().flat_map(|layer| {
            let share = f64::from(layer.state().opacity);
            let own = layer.gaussians().opacities().iter();
            own.map(move |opacity| share * f64::from(*opacity))
        });
        let strongest = opacities.fold(0.0, f64::max);
        let mut all = Vec::new();
        for layer in shown {
            let (state, gaussians) = (layer.state(), layer.gaussians());
            let placement = layer.placement();
            let step = gaussians.len().div_ceil(SAMPLE).max(1);
            let weighed = (0..gaussians.len()).step_by(step).filter_map(|index| {
                let opacity = f64::from(state.opacity) * f64::from(gaussians.opacities()[index]);
                let shows = opacity > 0.0 && opacity >= FAINT * strongest;
                let sigmas = (2.0 * (opacity / (AT_REACH * strongest)).max(1.0).ln()).sqrt();
                let turn = placement.rotation() * gaussians.rotations()[index].as_dquat();
                let scales = placement.scale() * gaussians.scales()[index].as_dvec3();
                let centre = gaussians.positions()[index].as_dvec3();
                let reach = Reach {
                    centre: placement.to_world(centre),
                    axes: DMat3::from_quat(turn) * DMat3::from_diagonal(sigmas * scales),
                };
                shows.then_some(WeightedPoint {
                    reach,
                    opacity,
                    size: scales.max_element(),
                })
            });
            all.extend(framed(&weighed.collect::<Vec<_>>(), generous));
        }
        Self::holding(all)
    }

    /// What holds all of these; a box about the origin where there are none.
    fn holding(mut all: Vec<Reach>) -> Self {
        if all.is_empty() {
            all.push(Reach {
                centre: DVec3::ZERO,
                axes: DMat3::from_diagonal(DVec3::splat(0.5)),
            });
        }
        let across = |one: &Reach| one.across(DMat3::IDENTITY);
        let least = all.iter().map(|one| one.centre - across(one));
        let most = all.iter().map(|one| one.centre + across(one));
        let least = least.reduce(DVec3::min).unwrap_or_default();
        let most = most.reduce(DVec3::max).unwrap_or_default();
        let middle = (least + most) / 2.0;
        let mut outermost = vec![None; LINES * COLUMNS];
        for one in &all {
            let off = one.centre - middle;
            let far = off.length() + one.across(DMat3::IDENTITY).max_element();
            let direction = off.normalize_or_zero();
            let share = |turned: f64, count: usize| {
                let number = (turned * count as f64) as usize;
                number.min(count - 1)
            };
            let line = share(
                direction.y.clamp(-1.0, 1.0).acos() / std::f64::consts::PI,
                LINES,
            );
            let turn = direction.z.atan2(direction.x) / std::f64::consts::TAU + 0.5;
            let place = &mut outermost[line * COLUMNS + share(turn, COLUMNS)];
            if place.is_none_or(|(farthest, _)| far > farthest) {
                *place = Some((far, *one));
            }
        }
        Self {
            outermost: outermost
                .into_iter()
                .flatten()
                .map(|(_, one)| one)
                .collect(),
            middle,
            radius: (most - least).length() / 2.0,
        }
    }

    /// Centres relative to a point and reaches, in a camera's axes.
    fn seen(&self, rotation: DMat3, from: DVec3) -> impl Iterator<Item = (DVec3, DVec3)> + '_ {
        let all = self.outermost.iter();
        all.map(move |one| (rotation * (one.centre - from), one.across(rotation)))
    }

    /// The perspective camera in the place nearest to all of it from which all of it is in the picture, and in its middle.
    pub(super) fn near(&self, camera: Camera) -> Camera {
        let whole = slopes(&camera);
        // The lines of sight at the picture's edges, by where they pass the depth 0.
        let (mut right, mut left) = (DVec2::NEG_INFINITY, DVec2::NEG_INFINITY);
        let mut nearest = f64::INFINITY;
        for (at, reach) in self.seen(camera.rotation, camera.eye) {
            right = right.max(at.xy() + reach.xy() - whole * at.z);
            left = left.max(-at.xy() + reach.xy() - whole * at.z);
            nearest = nearest.min(at.z - reach.z - NEAREST);
        }
        let z = ((right + left) / (-2.0 * whole)).min_element().min(nearest);
        let eye = ((right - left) / 2.0).extend(z);
        camera.eye(camera.eye + camera.rotation.transpose() * eye)
    }

    /// How far from a point an eye has to be that looks at it with this perspective camera's lens and axes.
    pub(super) fn distance(&self, camera: &Camera, from: DVec3) -> f64 {
        let whole = slopes(camera);
        let seen = self.seen(camera.rotation, from);
        let distances = seen.map(|(at, reach)| {
            let aside = (at.xy().abs() + reach.xy()) / whole;
            aside.max_element().max(reach.z + NEAREST) - at.z
        });
        distances.fold(NEAREST, f64::max)
    }

    /// The pixels of a world unit at which an orthographic camera with these axes holds all of it around a point.
    pub(super) fn scale(&self, camera: &Camera, around: DVec3) -> f64 {
        let seen = self.seen(camera.rotation, around);
        let most = seen.map(|(at, reach)| at.xy().abs() + reach.xy());
        let half = DVec2::new(camera.cx, camera.cy) * FILL;
        (half / most.fold(DVec2::splat(f64::MIN_POSITIVE), DVec2::max)).min_element()
    }

    /// Its middle in the picture of an orthographic camera with these axes, as deep as its middle is.
    pub(super) fn middle_across(&self, rotation: DMat3) -> DVec3 {
        let seen = || self.seen(rotation, self.middle);
        let least = seen().map(|(at, reach)| at - reach).reduce(DVec3::min);
        let most = seen().map(|(at, reach)| at + reach).reduce(DVec3::max);
        let off = (least.unwrap_or_default() + most.unwrap_or_default()) / 2.0;
        self.middle + rotation.transpose() * off.with_z(0.0)
    }

    /// The place of an orthographic eye whose picture has this point in its middle: before all of it.
    pub(super) fn before(&self, rotation: DMat3, point: DVec3) -> DVec3 {
        let forward = rotation.row(2);
        let away = 2.0 * self.radius + NEAREST;
        point - forward * (away + forward.dot(point - self.middle).max(0.0))
    }

    /// An orthographic camera that faces a plane square on from the side that it cuts away, and holds all that is visible,
    /// wherever along its normal the plane is.
    pub(in super::super) fn facing(
        &self,
        plane: &Plane,
        up: DVec3,
        size: (u32, u32),
    ) -> rara::Result<Camera> {
        let normal = plane.normal();
        let camera = Camera::orthographic(DVec3::ZERO, normal, up, 1.0, size)?;
        let middle = self.middle_across(camera.rotation);
        // Splats that the plane cuts may have their centres before it, and are seen all the same.
        let target = middle - normal * plane.distance(middle);
        let scale = self.scale(&camera, middle);
        let away = 2.0 * self.radius + NEAREST;
        Ok(camera.fx(scale).fy(scale).eye(target - normal * away))
    }
}

/// The tangents of half of the angles that a camera sees, and fills.
fn slopes(camera: &Camera) -> DVec2 {
    DVec2::new(camera.cx / camera.fx, camera.cy / camera.fy) * FILL
}
