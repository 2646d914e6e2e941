//! What of a scene is in a picture that shows all of it, and the cameras that hold it.

use glam::{DMat3, DVec2, DVec3, Vec3Swizzles};
use rara::{Camera, Layer, Plane, Result, Scene};
use rara_base::limits::ALPHA_MIN_INVERSE;

use super::linked::{WeightedPoint, framed};
use super::reach::Reach;

/// Share of the picture that is filled.
const FILL: f64 = 0.92;
/// Nothing is nearer than this depth, as splats nearer than 0.2 are culled.
const NEAREST: f64 = 0.25;
/// The share of the greatest opacity in the scene that one shows which is looked at to find what is linked.
const FAINT: f64 = 0.02;
/// The share of it out to which a Gaussian links others.
const AT_REACH: f64 = 0.1;
/// The alpha out to which a Gaussian is drawn.
const SEEN: f64 = 1.0 / ALPHA_MIN_INVERSE as f64;
/// The largest Gaussian that is a tip of what it is linked to, as a share of the radius of what is framed.
const TIP: f64 = 0.1;
/// How far small Gaussians that nothing links may reach out of the box around what is framed, as a share of its half sides, and be
/// held too: the picture shows them, and becomes hardly smaller.
const BESIDE: f64 = 0.2;
/// The most Gaussians of a layer that are looked at.
const SAMPLE: usize = 1 << 19;
/// Of all directions from the middle, so many lines and columns have a farthest Gaussian each: those decide how all others are
/// held, but for half a thousandth.
const LINES: usize = 64;
const COLUMNS: usize = 128;

/// The visible part of a scene that a camera frames.
#[derive(Debug)]
pub struct Visible {
    /// The outermost in each direction, which decide, and how far they reach.
    outermost: Vec<Option<(f64, Reach)>>,
    middle: DVec3,
    radius: f64,
}

impl Visible {
    /// Returns the part of a scene that a camera frames. For each visible layer, this is the largest connected part, and
    /// further parts that are dense for their size. Clips have no effect, so that pictures with and without a clip have the
    /// same camera.
    pub fn of(scene: &Scene<'_>) -> Self {
        Self::chosen(scene, false)
    }

    /// Returns nearly all of a scene: everything except Gaussians that hardly show. It is for pictures that must show
    /// everything.
    pub fn nearly_all_of(scene: &Scene<'_>) -> Self {
        Self::chosen(scene, true)
    }

    /// Returns the middle of the box around the visible part.
    pub fn middle(&self) -> DVec3 {
        self.middle
    }

    /// Returns half of the diagonal of the box around the visible part, in world units.
    pub fn radius(&self) -> f64 {
        self.radius
    }

    fn chosen(scene: &Scene<'_>, generous: bool) -> Self {
        let all = AllReaches::new(scene);
        let (mut chosen, mut cells) = (Vec::new(), Vec::new());
        for layer in &all.layers {
            let count = layer.gaussians().len();
            let sample = (0..count).step_by(step(count));
            let weighed = sample.filter_map(|index| all.weighed(layer, index));
            let (framed, of_layer) = framed(&weighed.collect::<Vec<_>>(), generous);
            chosen.extend(framed);
            cells.push(of_layer);
        }
        let mut held = Self::holding(chosen);
        let (least, most) = box_around(held.all());
        let beside = BESIDE / 2.0 * (most - least);
        let is_beside = |one: &Reach| {
            let across = one.across(DMat3::IDENTITY);
            (one.centre - across).cmpge(least - beside).all()
                && (one.centre + across).cmple(most + beside).all()
        };
        // Tips that were not looked at, and faint ones, reach out of what they are linked to.
        for (layer, cells) in all.layers.iter().zip(cells) {
            let count = layer.gaussians().len();
            for index in 0..count {
                let is_weighed = index % step(count) == 0 && all.weighed(layer, index).is_some();
                let is_small =
                    |one: &Reach| one.across(DMat3::IDENTITY).max_element() <= TIP * held.radius;
                let Some(reach) = all.reach(layer, index).filter(is_small) else {
                    continue;
                };
                let (place, far) = held.place(&reach);
                let is_farther = held.outermost[place].is_none_or(|(most, _)| far > most);
                let is_linked = || !is_weighed && cells.links(reach.centre);
                if is_farther && (is_beside(&reach) || is_linked()) {
                    held.outermost[place] = Some((far, reach));
                }
            }
        }
        held.measured()
    }

    /// What holds all of these; a box about the origin where there are none.
    fn holding(mut all: Vec<Reach>) -> Self {
        if all.is_empty() {
            all.push(Reach {
                centre: DVec3::ZERO,
                axes: DMat3::from_diagonal(DVec3::splat(0.5)),
            });
        }
        let (middle, radius) = middle_and_radius(all.iter());
        let mut held = Self {
            outermost: vec![None; LINES * COLUMNS],
            middle,
            radius,
        };
        for one in all {
            let (place, far) = held.place(&one);
            let place = &mut held.outermost[place];
            if place.is_none_or(|(farthest, _)| far > farthest) {
                *place = Some((far, one));
            }
        }
        held
    }

    /// The same with the middle and the radius of what it holds.
    fn measured(self) -> Self {
        let (middle, radius) = middle_and_radius(self.all());
        Self {
            middle,
            radius,
            ..self
        }
    }

    /// The direction from the middle in which a Gaussian is, by its number, and how far it reaches.
    fn place(&self, one: &Reach) -> (usize, f64) {
        let off = one.centre - self.middle;
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
        (line * COLUMNS + share(turn, COLUMNS), far)
    }

    fn all(&self) -> impl Iterator<Item = &Reach> {
        self.outermost.iter().flatten().map(|(_, one)| one)
    }

    /// Centres relative to a point and what reaches from them, in a camera's axes.
    fn seen(&self, rotation: DMat3, from: DVec3) -> impl Iterator<Item = Reach> + '_ {
        self.all().map(move |one| Reach {
            centre: rotation * (one.centre - from),
            axes: rotation * one.axes,
        })
    }

    /// The perspective camera in the place nearest to all of it from which all of it is in the picture, and in its middle.
    pub(super) fn near(&self, camera: Camera) -> Camera {
        let whole = slopes(&camera);
        // The planes at the picture's edges, by where they pass the depth 0.
        let (mut right, mut left) = (DVec2::NEG_INFINITY, DVec2::NEG_INFINITY);
        let mut nearest = f64::INFINITY;
        for one in self.seen(camera.rotation, camera.eye) {
            let at = one.centre;
            let [beyond, before] = beyond(&one, whole);
            right = right.max(at.xy() + beyond - whole * at.z);
            left = left.max(-at.xy() + before - whole * at.z);
            nearest = nearest.min(at.z - one.along(DVec3::Z) - NEAREST);
        }
        let z = ((right + left) / (-2.0 * whole)).min_element().min(nearest);
        let eye = ((right - left) / 2.0).extend(z);
        camera.eye(camera.eye + camera.rotation.transpose() * eye)
    }

    /// How far from a point an eye has to be that looks at it with this perspective camera's lens and axes.
    pub(super) fn distance(&self, camera: &Camera, from: DVec3) -> f64 {
        let whole = slopes(camera);
        let distances = self.seen(camera.rotation, from).map(|one| {
            let at = one.centre;
            let [beyond, before] = beyond(&one, whole);
            let aside = (at.xy() + beyond).max(before - at.xy()) / whole;
            aside.max_element().max(one.along(DVec3::Z) + NEAREST) - at.z
        });
        distances.fold(NEAREST, f64::max)
    }

    /// The pixels of a world unit at which an orthographic camera with these axes holds all of it around a point.
    pub(super) fn scale(&self, camera: &Camera, around: DVec3) -> f64 {
        let seen = self.seen(camera.rotation, around);
        let most = seen.map(|one| one.centre.xy().abs() + one.across(DMat3::IDENTITY).xy());
        let half = DVec2::new(camera.cx, camera.cy) * FILL;
        (half / most.fold(DVec2::splat(f64::MIN_POSITIVE), DVec2::max)).min_element()
    }

    /// Its middle in the picture of an orthographic camera with these axes, as deep as its middle is.
    pub(super) fn middle_across(&self, rotation: DMat3) -> DVec3 {
        let seen = || self.seen(rotation, self.middle);
        let across = |one: &Reach| one.across(DMat3::IDENTITY);
        let least = seen().map(|one| one.centre - across(&one));
        let most = seen().map(|one| one.centre + across(&one));
        let (least, most) = (least.reduce(DVec3::min), most.reduce(DVec3::max));
        let off = (least.unwrap_or_default() + most.unwrap_or_default()) / 2.0;
        self.middle + rotation.transpose() * off.with_z(0.0)
    }

    /// The place of an orthographic eye whose picture has this point in its middle: before all of it.
    pub(super) fn before(&self, rotation: DMat3, point: DVec3) -> DVec3 {
        let forward = rotation.row(2);
        let away = 2.0 * self.radius + NEAREST;
        point - forward * (away + forward.dot(point - self.middle).max(0.0))
    }

    /// Returns an orthographic camera that looks at a plane along its normal, from the side that the plane cuts away. Its
    /// picture shows everything visible, and does not change if the plane moves along its normal.
    ///
    /// # Errors
    /// [`Error::Invalid`](rara::Error::Invalid) if `up` is along the plane's normal, or if there is no picture of that size.
    pub fn facing(&self, plane: &Plane, up: DVec3, size: (u32, u32)) -> Result<Camera> {
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

/// How far it reaches over the planes through its centre that are parallel to those at the edges with these slopes, along the
/// picture: over the right and the lower, and over the left and the upper.
fn beyond(one: &Reach, whole: DVec2) -> [DVec2; 2] {
    let over = |side: f64| {
        DVec2::new(
            one.along(DVec3::new(side, 0.0, -whole.x)),
            one.along(DVec3::new(0.0, side, -whole.y)),
        )
    };
    [over(1.0), over(-1.0)]
}

/// Gaussians as they are drawn.
pub(super) struct AllReaches<'s> {
    /// Those that are shown.
    pub(super) layers: Vec<&'s Layer<'s>>,
    strongest: f64,
}

impl<'s> AllReaches<'s> {
    pub(super) fn new(scene: &'s Scene<'s>) -> Self {
        let layers = scene.layers().iter();
        let layers: Vec<_> = layers.filter(|layer| layer.state().visible).collect();
        let opacities = layers.iter().flat_map(|layer| {
            let share = f64::from(layer.state().opacity);
            let own = layer.gaussians().opacities().iter();
            own.map(move |opacity| share * f64::from(*opacity))
        });
        let strongest = opacities.fold(0.0, f64::max);
        Self { layers, strongest }
    }

    fn opacity(layer: &Layer<'_>, index: usize) -> f64 {
        f64::from(layer.state().opacity) * f64::from(layer.gaussians().opacities()[index])
    }

    /// How far one reaches that is drawn.
    pub(super) fn reach(&self, layer: &Layer<'_>, index: usize) -> Option<Reach> {
        let opacity = Self::opacity(layer, index);
        let faintest = SEEN.min(AT_REACH * self.strongest);
        let is_drawn = opacity > 0.0 && opacity >= faintest;
        is_drawn.then(|| Self::out_to(faintest, layer, index))
    }

    /// How far one reaches, out to an alpha.
    fn out_to(alpha: f64, layer: &Layer<'_>, index: usize) -> Reach {
        let (gaussians, placement) = (layer.gaussians(), layer.placement());
        let sigmas = (2.0 * (Self::opacity(layer, index) / alpha).max(1.0).ln()).sqrt();
        let turn = placement.rotation() * gaussians.rotations()[index].as_dquat();
        let scales = placement.scale() * gaussians.scales()[index].as_dvec3();
        Reach {
            centre: placement.to_world(gaussians.positions()[index].as_dvec3()),
            axes: DMat3::from_quat(turn) * DMat3::from_diagonal(sigmas * scales),
        }
    }

    /// One that shows.
    fn weighed(&self, layer: &Layer<'_>, index: usize) -> Option<WeightedPoint> {
        let opacity = Self::opacity(layer, index);
        let shows = opacity >= FAINT * self.strongest;
        let drawn = shows.then(|| self.reach(layer, index))??;
        let size = f64::from(layer.gaussians().scales()[index].max_element());
        Some(WeightedPoint {
            reach: Self::out_to(AT_REACH * self.strongest, layer, index),
            drawn,
            opacity,
            size: layer.placement().scale() * size,
        })
    }
}

/// The step between the Gaussians that are looked at, of so many.
fn step(count: usize) -> usize {
    count.div_ceil(SAMPLE).max(1)
}

/// The middle of the box that holds these, and half of its diagonal.
fn middle_and_radius<'a>(all: impl Iterator<Item = &'a Reach>) -> (DVec3, f64) {
    let (least, most) = box_around(all);
    ((least + most) / 2.0, (most - least).length() / 2.0)
}

/// The corners of the box that holds these.
fn box_around<'a>(all: impl Iterator<Item = &'a Reach>) -> (DVec3, DVec3) {
    let (mut least, mut most) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for one in all {
        let across = one.across(DMat3::IDENTITY);
        (least, most) = (
            least.min(one.centre - across),
            most.max(one.centre + across),
        );
    }
    (least, most)
}

/// The tangents of half of the angles that a camera sees, and fills.
fn slopes(camera: &Camera) -> DVec2 {
    DVec2::new(camera.cx / camera.fx, camera.cy / camera.fy) * FILL
}
