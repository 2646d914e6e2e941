//! Prisms over polygons: regions whose cross-section along an axis is a simple polygon with holes, and cones over polygons of a
//! picture.

use std::cmp::Ordering;
use std::fmt;

use glam::{DMat3, DQuat, DVec2, DVec3};

use super::{Clip, ClipOp, Plane};
use crate::axis::Axis;
use crate::placement::Placement;
use crate::text_reader::{joined, number};
use rara_base::error::{Error, Result, shortened};

/// The points whose place across an axis is inside a polygon, and outside of all its holes: without end along the axis, or between
/// two heights. It parses from the text that follows `polygon:`, as `z;0,0;2,0;2,1;0,1` or, with heights and a hole,
/// `z=-1..4;0,0;9,0;9,9;0,9|3,3;6,3;6,6`. The corners are (x, y) across z, (x, z) across y and (y, z) across x, world units. The axis
/// may be any direction, as `0,0.6,0.8`: its corners are those across the nearest axis, turned with it the shortest way.
///
/// A prism may also be the cone of all lines of sight through a polygon in a picture: see [`Lasso`](super::Lasso).
#[derive(Debug, Clone, PartialEq)]
pub struct Prism {
    base: PrismBase,
    /// The polygon and its holes, each as its corners.
    rings: Vec<Vec<DVec2>>,
    heights: Option<[f64; 2]>,
    /// The region that all of it keeps.
    clip: Clip,
}

/// The space in which the corners of a prism's polygon lie.
#[derive(Debug, Clone, PartialEq)]
pub enum PrismBase {
    /// An axis of the scene, as it was written: one of `x`, `y` and `z` or of their anatomical names.
    Axis(String),
    /// Any direction, which is not zero.
    Direction(DVec3),
    /// An eye and the axes of its picture, right, down and forward, of length 1 and perpendicular to each other. A corner (u, v) is
    /// the line of sight through `eye + forward + u right + v down`; heights are depths, and nothing behind the eye is kept.
    Eye {
        /// The place of the eye, world units.
        eye: DVec3,
        /// The direction to the right in the picture.
        right: DVec3,
        /// The direction down in the picture.
        down: DVec3,
    },
}

/// The axes of the corners' numbers, the axis of the heights, and the place where all edges' planes meet, if they do.
struct Frame {
    u: DVec3,
    v: DVec3,
    along: DVec3,
    eye: Option<DVec3>,
}

impl PrismBase {
    fn frame(&self) -> Result<Frame> {
        let invalid = |what: &str| Err(Error::Invalid(what.into()));
        let (u, v, along, eye) = match self {
            Self::Axis(name) => {
                let named = Axis::parse(name).filter(|_| !name.contains('!'));
                let Some(along) = named.map(|axis| axis.along) else {
                    return Err(Error::Invalid(format!(
                        "a polygon cannot have the axis '{}': give a direction such as 0,0.6,0.8, or one of the axes x, y, z, sagittal, \
                         coronal and axial",
                        shortened(name)
                    )));
                };
                let [u, v] = across(along);
                (u, v, along, None)
            }
            Self::Direction(direction) => {
                let Some(along) = direction.try_normalize() else {
                    return invalid("the direction of a polygon is zero or not finite: give X,Y,Z");
                };
                // The direction is turned from the nearest axis, as which its opposite counts.
                let sizes = along.abs();
                let axis = match () {
                    () if sizes.z >= sizes.x.max(sizes.y) => DVec3::Z,
                    () if sizes.y >= sizes.x => DVec3::Y,
                    () => DVec3::X,
                };
                let turn = DQuat::from_rotation_arc(axis * along.dot(axis).signum(), along);
                let [u, v] = across(axis).map(|one| turn * one);
                (u, v, along, None)
            }
            Self::Eye { eye, right, down } => {
                let along = right.cross(*down);
                let axes = DMat3::from_cols(*right, *down, along);
                let is_rotation = (axes.transpose() * axes).abs_diff_eq(DMat3::IDENTITY, 1e-6);
                if !(eye.is_finite() && is_rotation) {
                    return invalid(
                        "a polygon of a picture needs a finite eye, and directions to the right and down that are perpendicular and of length 1",
                    );
                }
                (*right, *down, along, Some(*eye))
            }
        };
        Ok(Frame { u, v, along, eye })
    }

    /// The axes of the corners' numbers.
    pub(super) fn across(&self) -> Result<[DVec3; 2]> {
        self.frame().map(|frame| [frame.u, frame.v])
    }
}

/// Two axes across one of the scene's: those of a corner's numbers.
fn across(along: DVec3) -> [DVec3; 2] {
    match along {
        DVec3::X => [DVec3::Y, DVec3::Z],
        DVec3::Y => [DVec3::X, DVec3::Z],
        _ => [DVec3::X, DVec3::Y],
    }
}

impl Prism {
    /// How it is written as text, and what that means: its text in [`Expression::usages`](super::Expression::usages).
    pub(super) const USAGE: &str = "polygon:AXIS;u,v;u,v;... has these corners, and goes on without end along AXIS, which is x, y, z or a direction X,Y,Z. \
         The corners are (x, y) along z, (x, z) along y and (y, z) along x. Along another direction they are those of the \
         nearest axis, turned with it. A | begins the corners of a hole. polygon:z=0..2;... ends at \
         these two heights along the axis. polygon:FILE and polygon:AXIS;FILE take the corners from a .geojson file.";

    /// Makes the prism of a polygon and its holes. A ring may repeat its first corner at its end.
    ///
    /// # Errors
    /// [`Error::Invalid`] for another axis, for a ring of fewer than three corners or without an area, for rings whose edges cross or
    /// touch, for a hole that is not in the polygon, and where the first height is not below the second.
    pub fn new(base: PrismBase, rings: &[Vec<DVec2>], heights: Option<[f64; 2]>) -> Result<Self> {
        let invalid = |what: String| Err(Error::Invalid(format!("a polygon {what}")));
        let frame = base.frame()?;
        if let Some([low, high]) = heights
            && low.partial_cmp(&high) != Some(Ordering::Less)
        {
            return invalid(format!(
                "goes from height {low} to height {high}: the first height has to be below the second"
            ));
        }
        let cleaned: Vec<Vec<DVec2>> = rings.iter().map(|ring| without_repeats(ring)).collect();
        let Some(outer) = cleaned.first() else {
            return invalid("needs corners, as in polygon:z;0,0;2,0;2,1".into());
        };
        for (number, ring) in cleaned.iter().enumerate() {
            if let Some(corner) = ring.iter().find(|corner| !corner.is_finite()) {
                return invalid(format!("has a corner that is not finite: {corner}"));
            }
            if ring.len() < 3 {
                return invalid(format!(
                    "has too few corners: {} has {}, and needs three corners that are not on one line",
                    called(number),
                    ring.len()
                ));
            }
        }
        if let Some([a, b]) = crossing(&cleaned) {
            return invalid(format!(
                "has edges that cross or touch: that {} and that {}; move a corner of one of them",
                edge_text(&cleaned, a),
                edge_text(&cleaned, b)
            ));
        }
        let is_inside = |ring: &[DVec2]| winds_around(outer, ring[0]);
        if let Some(number) = (1..cleaned.len()).find(|&number| !is_inside(&cleaned[number])) {
            return invalid(format!(
                "has a hole outside of its outline: {}; move it into the outline",
                called(number)
            ));
        }
        let clip = frame.lowered(&cleaned, heights)?;
        clip.check()?;
        Ok(Self {
            base,
            rings: rings.to_vec(),
            heights,
            clip,
        })
    }

    /// The region that it keeps.
    pub fn clip(&self) -> Clip {
        self.clip.clone()
    }

    /// The space of the corners.
    pub fn base(&self) -> &PrismBase {
        &self.base
    }

    /// The direction of the axis, or of the middle of the picture.
    pub fn along(&self) -> DVec3 {
        let frame = self.base.frame();
        frame.map_or(DVec3::Z, |frame| frame.along)
    }

    /// The polygon and its holes, each as its corners, world units, or of a picture's cone shares of the depth.
    pub fn rings(&self) -> &[Vec<DVec2>] {
        &self.rings
    }

    /// The heights along the axis between which it lies, world units, if it ends.
    pub fn heights(&self) -> Option<[f64; 2]> {
        self.heights
    }

    /// The edges of its outline between two heights, or between its own where these lie within.
    pub fn edges(&self, [low, high]: [f64; 2]) -> Vec<[DVec3; 2]> {
        let Ok(frame) = self.base.frame() else {
            return Vec::new(); // it was one when the prism was made
        };
        let own = self.heights.unwrap_or([low, high]);
        let mut heights = [own[0].max(low), own[1].min(high)];
        if frame.eye.is_some() {
            heights[0] = heights[0].max(1e-2 * heights[1]); // at the eye all edges meet
        }
        let mut edges = Vec::new();
        for ring in &self.rings {
            for (at, corner) in ring.iter().enumerate() {
                let next = ring[(at + 1) % ring.len()];
                edges.push(heights.map(|height| frame.point(*corner, height)));
                edges.extend(
                    heights.map(|height| [*corner, next].map(|one| frame.point(one, height))),
                );
            }
        }
        edges
    }

    /// Returns the prism after it was scaled, then turned, then moved, as a scene with this placement is.
    ///
    /// # Errors
    /// The errors of [`new`](Self::new), where numbers overflow.
    pub fn placed(&self, placement: &Placement) -> Result<Self> {
        let (turn, scale) = (placement.rotation(), placement.scale());
        let frame = self.base.frame()?;
        let scaled = |heights: [f64; 2]| heights.map(|height| scale * height);
        if let PrismBase::Eye { eye, right, down } = self.base {
            let base = PrismBase::Eye {
                eye: placement.to_world(eye),
                right: turn * right,
                down: turn * down,
            };
            return Self::new(base, &self.rings, self.heights.map(scaled));
        }
        let along = turn * frame.along;
        let base = match along == frame.along {
            true => self.base.clone(),
            false => PrismBase::Direction(along),
        };
        let placed = base.frame()?;
        let corner = |corner: &DVec2| {
            let point = placement.to_world(frame.point(*corner, 0.0));
            DVec2::new(point.dot(placed.u), point.dot(placed.v))
        };
        let ring = |ring: &Vec<DVec2>| ring.iter().map(corner).collect();
        let rings: Vec<Vec<DVec2>> = self.rings.iter().map(ring).collect();
        let start = placement.position().dot(placed.along);
        let heights = self.heights.map(scaled);
        Self::new(
            base,
            &rings,
            heights.map(|ends| ends.map(|end| start + end)),
        )
    }

    /// The prism's middle, world units: that of the bounds of its corners, halfway between its heights or else as high as `near`.
    pub fn middle(&self, near: DVec3) -> DVec3 {
        let corners = || self.rings.iter().flatten().copied();
        let low = corners().reduce(DVec2::min).unwrap_or_default();
        let high = corners().reduce(DVec2::max).unwrap_or_default();
        let height = match self.heights {
            Some([low, high]) => low.midpoint(high),
            None => self.height(near),
        };
        let frame = self.base.frame();
        frame.map_or(near, |frame| frame.point(low.midpoint(high), height))
    }

    /// The height of a point along the axis, or its depth.
    pub fn height(&self, point: DVec3) -> f64 {
        let frame = self.base.frame();
        frame.map_or(0.0, |frame| {
            frame.along.dot(point - frame.eye.unwrap_or_default())
        })
    }

    /// The prism at a share of the way to another one of as many corners in the same space, if that is one.
    pub(super) fn between(&self, other: &Self, share: f64) -> Option<Result<Self>> {
        let counts = |prism: &Self| prism.rings.iter().map(Vec::len).collect::<Vec<_>>();
        if self.base.frame().ok()?.axes() != other.base.frame().ok()?.axes()
            || counts(self) != counts(other)
        {
            return None;
        }
        let mix = |a: f64, b: f64| a + (b - a) * share;
        let heights = match (self.heights, other.heights) {
            (Some(a), Some(b)) => Some([mix(a[0], b[0]), mix(a[1], b[1])]),
            (None, None) => None,
            _ => return None,
        };
        let pairs = self.rings.iter().zip(&other.rings);
        let ring = |(a, b): (&Vec<DVec2>, &Vec<DVec2>)| {
            a.iter().zip(b).map(|(a, b)| a.lerp(*b, share)).collect()
        };
        let rings: Vec<Vec<DVec2>> = pairs.map(ring).collect();
        Some(Self::new(self.base.clone(), &rings, heights))
    }

    /// Reads the text that follows `polygon:`.
    pub(super) fn read(text: &str) -> Result<Self> {
        let (base, heights, corners) = head(text)?;
        Self::new(base, &super::lasso::rings(corners)?, heights)
    }
}

/// The space, the heights and the rest of the text that follows `polygon:`.
pub(super) fn head(text: &str) -> Result<(PrismBase, Option<[f64; 2]>, &str)> {
    let (head, rest) = text.split_once(';').unwrap_or((text, ""));
    let (base, heights) = match head.split_once('=') {
        None => (head, None),
        Some((base, heights)) => {
            let (low, high) = heights.split_once("..").ok_or_else(|| {
                Error::Invalid(format!(
                    "'{}' is not two heights; give them as in polygon:z=0..2;...",
                    shortened(heights)
                ))
            })?;
            (base, Some([number(low)?, number(high)?]))
        }
    };
    let vector = |text: &str| -> Result<DVec3> {
        let numbers: Vec<f64> = text.split(',').map(number).collect::<Result<_>>()?;
        match numbers[..] {
            [x, y, z] => Ok(DVec3::new(x, y, z)),
            _ => Err(Error::Invalid(format!(
                "'{}' is not a direction; give three numbers",
                shortened(text.trim())
            ))),
        }
    };
    let base = base.trim();
    let base = match base.strip_prefix(FROM_EYE) {
        Some(eye) => {
            let [eye, right, down] = eye.split('/').collect::<Vec<_>>()[..] else {
                return Err(Error::Invalid(format!(
                    "'{}' is not an eye; give its place and the directions to the right and down: {FROM_EYE}x,y,z/x,y,z/x,y,z",
                    shortened(base)
                )));
            };
            PrismBase::Eye {
                eye: vector(eye)?,
                right: vector(right)?,
                down: vector(down)?,
            }
        }
        None if base.contains(',') => PrismBase::Direction(vector(base)?),
        None => PrismBase::Axis(base.into()),
    };
    Ok((base, heights, rest))
}

/// The text with which the space of an eye begins.
const FROM_EYE: &str = "from ";

impl Frame {
    fn axes(&self) -> (DVec3, DVec3, Option<DVec3>) {
        (self.u, self.v, self.eye)
    }

    /// The point at a corner's place and a height.
    fn point(&self, corner: DVec2, height: f64) -> DVec3 {
        let across = self.u * corner.x + self.v * corner.y;
        match self.eye {
            Some(eye) => eye + height * (self.along + across),
            None => across + height * self.along,
        }
    }

    /// The region as planes.
    fn lowered(&self, rings: &[Vec<DVec2>], heights: Option<[f64; 2]>) -> Result<Clip> {
        let mut all = Vec::new();
        for (number, ring) in rings.iter().enumerate() {
            let region = self.region(&formula(ring))?;
            all.push(match number {
                0 => region,
                _ => region.complement(),
            });
        }
        let start = self.eye.unwrap_or_default().dot(self.along);
        let low = heights.map(|heights| heights[0]).or(self.eye.map(|_| 0.0));
        let mut ends = Vec::new();
        if let Some(low) = low {
            ends.push(Plane::new(self.along, -(start + low))?);
        }
        if let Some([_, high]) = heights {
            ends.push(Plane::new(-self.along, start + high)?);
        }
        if !ends.is_empty() {
            all.push(Clip::of(ends, ClipOp::And));
        }
        Ok(Clip::joined(all, ClipOp::And))
    }

    fn region(&self, formula: &Formula) -> Result<Clip> {
        Ok(match formula {
            Formula::Edge(from, to) => {
                let inward = (to - from).perp();
                let normal = self.u * inward.x + self.v * inward.y;
                let offset = -inward.dot(*from);
                let plane = match self.eye {
                    // It goes through the eye, and through the edge in the picture.
                    Some(eye) => {
                        let normal = normal + self.along * offset;
                        Plane::new(normal, -normal.dot(eye))?
                    }
                    None => Plane::new(normal, offset)?,
                };
                Clip::of([plane], ClipOp::And)
            }
            Formula::Both(op, parts) => {
                let parts = parts.iter().map(|part| self.region(part));
                Clip::joined(parts.collect::<Result<Vec<_>>>()?, *op)
            }
        })
    }
}

impl fmt::Display for PrismBase {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let vector = |v: &DVec3| format!("{},{},{}", v.x, v.y, v.z);
        match self {
            Self::Axis(name) => f.write_str(name),
            Self::Direction(direction) => f.write_str(&vector(direction)),
            Self::Eye { eye, right, down } => {
                let [eye, right, down] = [eye, right, down].map(vector);
                write!(f, "{FROM_EYE}{eye}/{right}/{down}")
            }
        }
    }
}

/// The text that follows `polygon:`.
impl fmt::Display for Prism {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.base)?;
        if let Some([low, high]) = self.heights {
            write!(f, "={low}..{high}")?;
        }
        let ring =
            |ring: &Vec<DVec2>| joined(ring, ";", |corner| format!("{},{}", corner.x, corner.y));
        write!(f, ";{}", joined(&self.rings, "|", ring))
    }
}

/// How messages call a ring.
fn called(number: usize) -> String {
    match number {
        0 => "its outline".into(),
        hole => format!("hole {hole}"),
    }
}

fn edge_text(rings: &[Vec<DVec2>], (ring, edge): (usize, usize)) -> String {
    let [from, to] = ends(&rings[ring], edge);
    format!("from ({}, {}) to ({}, {})", from.x, from.y, to.x, to.y)
}

/// A ring without corners that repeat the one before or that lie between their neighbours, which change nothing.
fn without_repeats(ring: &[DVec2]) -> Vec<DVec2> {
    let is_between = |before: DVec2, corner: DVec2, after: DVec2| {
        let (a, b) = (corner - before, after - corner);
        a.perp_dot(b) == 0.0 && a.dot(b) > 0.0
    };
    let mut kept: Vec<DVec2> = Vec::new();
    for &corner in ring {
        if kept.last() == Some(&corner) {
            continue;
        }
        if let [.., before, last] = kept[..]
            && is_between(before, last, corner)
        {
            kept.pop();
        }
        kept.push(corner);
    }
    while kept.len() > 1 && kept.first() == kept.last() {
        kept.pop();
    }
    // The last corner and the first have neighbours beyond the ends of the list.
    while let [first, .., before, last] = kept[..]
        && is_between(before, last, first)
    {
        kept.pop();
    }
    while let [first, second, .., last] = kept[..]
        && is_between(last, first, second)
    {
        kept.remove(0);
    }
    kept
}

/// Twice the area, positive if the corners turn from the first axis to the second.
fn area(ring: &[DVec2]) -> f64 {
    let edges = (0..ring.len()).map(|edge| ends(ring, edge));
    // Counted from a corner, so that a place far from zero costs no digits.
    edges
        .map(|[a, b]| (a - ring[0]).perp_dot(b - ring[0]))
        .sum()
}

fn ends(ring: &[DVec2], edge: usize) -> [DVec2; 2] {
    [ring[edge], ring[(edge + 1) % ring.len()]]
}

/// True when a point is inside of a ring.
pub(super) fn winds_around(ring: &[DVec2], point: DVec2) -> bool {
    let crosses = |edge: &usize| {
        let [a, b] = ends(ring, *edge);
        let is_between = (a.y > point.y) != (b.y > point.y);
        is_between && point.x < a.x + (point.y - a.y) / (b.y - a.y) * (b.x - a.x)
    };
    (0..ring.len()).filter(crosses).count() % 2 == 1
}

/// Two edges that cross or touch and are not neighbours, or that fold back on each other: a ring and an edge of it each.
fn crossing(rings: &[Vec<DVec2>]) -> Option<[(usize, usize); 2]> {
    let of_ring = |number: usize| (0..rings[number].len()).map(move |edge| (number, edge));
    let mut edges: Vec<(usize, usize)> = (0..rings.len()).flat_map(of_ring).collect();
    let span = |&(ring, edge): &(usize, usize)| {
        let [a, b] = ends(&rings[ring], edge);
        [a.x.min(b.x), a.x.max(b.x)]
    };
    edges.sort_by(|a, b| span(a)[0].total_cmp(&span(b)[0]));
    for (at, a) in edges.iter().enumerate() {
        let last = span(a)[1];
        for b in edges[at + 1..].iter().take_while(|b| span(b)[0] <= last) {
            let count = rings[a.0].len();
            let are_neighbours = a.0 == b.0 && [1, count - 1].contains(&a.1.abs_diff(b.1));
            let [one, other] = [a, b].map(|(ring, edge)| ends(&rings[*ring], *edge));
            let meet = match are_neighbours {
                true => fold(one, other),
                false => touch(one, other),
            };
            if meet {
                return Some([*a, *b]);
            }
        }
    }
    None
}

/// True when two neighbours lie on each other.
fn fold([a, b]: [DVec2; 2], [c, d]: [DVec2; 2]) -> bool {
    let (along, back) = if b == c {
        (b - a, d - c)
    } else {
        (a - b, c - d)
    };
    along.perp_dot(back) == 0.0 && along.dot(back) < 0.0
}

/// True when two edges have a point in common.
fn touch([a, b]: [DVec2; 2], [c, d]: [DVec2; 2]) -> bool {
    let side = |from: DVec2, to: DVec2, point: DVec2| (to - from).perp_dot(point - from);
    let sides = [side(a, b, c), side(a, b, d), side(c, d, a), side(c, d, b)];
    if sides[0] * sides[1] < 0.0 && sides[2] * sides[3] < 0.0 {
        return true;
    }
    let is_on = |from: DVec2, to: DVec2, point: DVec2| {
        point.cmpge(from.min(to)).all() && point.cmple(from.max(to)).all()
    };
    (sides[0] == 0.0 && is_on(a, b, c))
        || (sides[1] == 0.0 && is_on(a, b, d))
        || (sides[2] == 0.0 && is_on(c, d, a))
        || (sides[3] == 0.0 && is_on(c, d, b))
}

/// A polygon as a combination of half-planes: the left sides of its edges, each of which appears once (Dobkin, Guibas, Hershberger
/// and Snoeyink 1988).
#[derive(Debug)]
enum Formula {
    /// The half-plane that is left of an edge.
    Edge(DVec2, DVec2),
    /// The region that all parts keep, or any of them.
    Both(ClipOp, Vec<Formula>),
}

/// The formula of a simple polygon. Its first and last corner along an axis divide it into two chains. The edges at a chain's ends
/// go on without end, and the polygon is what is left of both.
fn formula(ring: &[DVec2]) -> Formula {
    let mut ring = ring.to_vec();
    if area(&ring) < 0.0 {
        ring.reverse();
    }
    let first = (0..ring.len()).min_by(|a, b| in_order(ring[*a], ring[*b]));
    ring.rotate_left(first.unwrap_or(0));
    let last = (0..ring.len()).max_by(|a, b| in_order(ring[*a], ring[*b]));
    let last = last.unwrap_or(0);
    let back = [&ring[last..], &ring[..1]].concat();
    let chains = [of_chain(&ring[..=last]), of_chain(&back)];
    Formula::Both(ClipOp::And, chains.into())
}

/// The formula of what is left of a chain whose first and last edge go on without end. A corner that no other part of the chain goes
/// beyond divides it: its two parts keep together what both keep where it turns left, and what either does where it turns right.
fn of_chain(chain: &[DVec2]) -> Formula {
    let mut parts: Vec<(usize, usize)> = vec![(0, chain.len() - 1)];
    let mut nodes = Vec::new();
    // Parts whose formula is made of those behind them; a recursion could be as deep as the chain is long.
    let mut at = 0;
    while at < parts.len() {
        let (begin, end) = parts[at];
        let split = (end > begin + 1).then(|| begin + outermost(&chain[begin..=end]));
        nodes.push(split.map(|corner| {
            parts.extend([(begin, corner), (corner, end)]);
            (corner, parts.len() - 2)
        }));
        at += 1;
    }
    let mut made: Vec<Option<Formula>> = Vec::new();
    made.resize_with(parts.len(), || None);
    for (at, node) in nodes.iter().enumerate().rev() {
        made[at] = Some(match *node {
            None => Formula::Edge(chain[parts[at].0], chain[parts[at].1]),
            Some((corner, first)) => {
                let [before, after] = [
                    chain[corner] - chain[corner - 1],
                    chain[corner + 1] - chain[corner],
                ];
                let op = match before.perp_dot(after) > 0.0 {
                    true => ClipOp::And,
                    false => ClipOp::Or,
                };
                let mut parts = Vec::new();
                for part in [made[first].take(), made[first + 1].take()]
                    .into_iter()
                    .flatten()
                {
                    match part {
                        Formula::Both(of, inner) if of == op => parts.extend(inner),
                        other => parts.push(other),
                    }
                }
                Formula::Both(op, parts)
            }
        });
    }
    made.swap_remove(0)
        .unwrap_or(Formula::Both(ClipOp::And, Vec::new()))
}

/// The order of points along the first axis, and of those beside each other along the second.
fn in_order(a: DVec2, b: DVec2) -> Ordering {
    a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y))
}

/// The number of a corner between the ends of a chain that is farther in some direction than all else, also than where its ends go on
/// to.
fn outermost(chain: &[DVec2]) -> usize {
    let last = chain.len() - 1;
    let rays = [
        (chain[0] - chain[1]).normalize_or_zero(),
        (chain[last] - chain[last - 1]).normalize_or_zero(),
    ];
    let farthest = |direction: DVec2, aside: DVec2| {
        let place = |at: &usize| {
            let from = chain[*at] - chain[1];
            DVec2::new(direction.dot(from), aside.dot(from))
        };
        let farthest = (1..last).max_by(|a, b| in_order(place(a), place(b)));
        farthest.unwrap_or(1)
    };
    let between = rays[0] + rays[1];
    if between.length() > 1e-9 {
        let direction = -between.normalize();
        return farthest(direction, direction.perp());
    }
    // The ends go on in opposite directions: the chain may go beyond both on either side.
    let level = |direction: DVec2, at: usize| direction.dot(chain[at] - chain[1]);
    for direction in [rays[0].perp(), -rays[0].perp()] {
        let corner = farthest(direction, -rays[0]);
        if level(direction, corner) > level(direction, 1).max(level(direction, last - 1)) {
            return corner;
        }
    }
    // It lies between them: the line of one end bounds it.
    let direction = rays[0].perp();
    match level(direction, 1) >= level(direction, last - 1) {
        true => farthest(direction, -rays[0]),
        false => farthest(direction, -rays[1]),
    }
}

#[cfg(test)]
mod tests;
