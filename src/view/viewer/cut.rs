//! A clip that is shown, and the one of its shapes that is held.

use glam::DVec3;
use rara::clip::Expression;
use rara::{Clip, ClipOp, Placement, Plane, Shape};

use super::numbers::stands_at;

/// Expressions of shapes, which of the shapes is held, and whether they cut at all.
#[derive(Debug, Clone)]
pub struct ClipEditor {
    pub(super) on: bool,
    /// One expression at least; shapes come before larger expressions, as flags are read.
    expressions: Vec<Expression>,
    op: ClipOp,
    /// How many of the expressions, from the first, are a section's. They cut layers that have clips of their own as well.
    of_section: usize,
    /// The number of the held shape, among all shapes as they are written.
    held: usize,
    /// The point that the held shape is turned about and scaled from, once it was moved; until then it is its middle.
    pivot: Option<DVec3>,
    centre: DVec3,
}

impl ClipEditor {
    /// A clip as it was typed; without one a plane through the middle of the scene, which is off at first.
    pub fn new(clip: Vec<Expression>, op: ClipOp, centre: DVec3) -> Self {
        let mut expressions = clip;
        expressions.sort_by_key(|expression| !matches!(expression, Expression::Shape(_)));
        for shape in expressions.iter_mut().flat_map(Expression::shapes_mut) {
            *shape = inside(*shape);
        }
        let on = !expressions.is_empty();
        if !on {
            expressions.push(Expression::Shape(across(DVec3::X, centre)));
        }
        Self {
            on,
            expressions,
            op,
            of_section: 0,
            held: 0,
            pivot: None,
            centre,
        }
    }

    /// A section, whose plane is the first of its shapes and is held, and what else clips.
    pub fn of_section(section: Vec<Expression>, others: Vec<Expression>, centre: DVec3) -> Self {
        Self {
            of_section: section.len(),
            ..Self::new([section, others].concat(), ClipOp::And, centre)
        }
    }

    /// The middle of the scene.
    pub(super) fn centre(&self) -> DVec3 {
        self.centre
    }

    /// True where some of it is a section's, whether it is on or off.
    pub(super) fn has_section(&self) -> bool {
        self.of_section > 0
    }

    /// What of it cuts layers that have clips of their own as well: the shapes of a section.
    pub fn section(&self) -> &[Expression] {
        self.expressions()
            .get(..self.of_section)
            .unwrap_or_default()
    }

    /// The region that it keeps.
    pub fn clip(&self) -> Clip {
        match self.on {
            true => Clip::joined(self.expressions.iter().map(Expression::clip), self.op),
            false => Clip::default(),
        }
    }

    /// Its expressions; none while it is off.
    pub fn expressions(&self) -> &[Expression] {
        match self.on {
            true => &self.expressions,
            false => &[],
        }
    }

    /// How its expressions combine.
    pub fn op(&self) -> ClipOp {
        self.op
    }

    /// All shapes in it, whether it is on or off.
    pub(super) fn shapes(&self) -> Vec<Shape> {
        let expressions = self.expressions.iter();
        expressions.flat_map(Expression::shapes).collect()
    }

    /// The number of the held shape among them.
    pub(super) fn held(&self) -> usize {
        self.held
    }

    pub(super) fn shape(&self) -> Shape {
        let shapes = self.shapes();
        shapes[self.held.min(shapes.len() - 1)]
    }

    /// The held shape where its clip keeps what every shape keeps, and what else is in it; `None` where it is within a larger
    /// expression, or where its clip is off.
    pub(super) fn held_apart(&self) -> Option<(Shape, Vec<Expression>)> {
        let mut others = self.expressions().to_vec();
        if self.op != ClipOp::And && others.len() > 1 {
            return None;
        }
        // Shapes come first, so that the number of the held shape is that of its expression.
        match others.get(self.held)? {
            Expression::Shape(shape) => {
                let shape = *shape;
                others.remove(self.held);
                Some((shape, others))
            }
            _ => None,
        }
    }

    /// The shapes of a section that also cut layers with clips of their own on a face of the held shape; none if that is a section's.
    pub(super) fn section_beside_held(&self) -> &[Expression] {
        match self.held < self.of_section {
            true => &[],
            false => self.section(),
        }
    }

    /// The middle of the held shape; of planes and slabs the point nearest to the middle of the scene when it was taken hold
    /// of, which moves with them.
    pub(super) fn middle(&self) -> DVec3 {
        self.pivot.unwrap_or(self.shape().middle(self.centre))
    }

    pub(super) fn next(&mut self) {
        self.held = (self.held + 1) % self.shapes().len();
        self.pivot = None;
    }

    /// Puts another shape in the held one's place, and switches the clip on.
    pub(super) fn set(&mut self, shape: Shape) {
        self.pivot = None;
        self.replace(shape);
    }

    fn replace(&mut self, shape: Shape) {
        let shapes = self.expressions.iter_mut().flat_map(Expression::shapes_mut);
        if let Some(held) = shapes.into_iter().nth(self.held) {
            *held = inside(shape);
        }
        self.on = true;
    }

    /// Keeps the other side of the held shape.
    pub(super) fn flip(&mut self) {
        let shape = self.shape();
        self.replace(match shape.as_plane() {
            Some(plane) => plane.flipped().into(),
            None => shape.complement(),
        });
    }

    /// Scales, turns and moves the held shape. One whose numbers overflow stays where it was.
    pub(super) fn place(&mut self, placement: &Placement) {
        if let Ok(shape) = self.shape().placed(placement) {
            self.pivot = Some(placement.to_world(self.middle()));
            self.replace(shape);
        }
    }

    /// A plane through the middle of the scene, across an axis.
    pub(super) fn across(&self, axis: DVec3) -> Shape {
        across(axis, self.centre)
    }

    /// A few words on the held shape, for the title: `plane at 0.5000`, `outside of sphere 2 of 3`.
    pub(super) fn words(&self) -> String {
        let (shape, count) = (self.shape(), self.shapes().len());
        let mut words = match shape.is_outside() {
            true => "outside of ".to_owned(),
            false => String::new(),
        };
        words += shape.solid().name();
        if count > 1 {
            words += &format!(" {} of {count}", self.held + 1);
        }
        if let Some(plane) = shape.as_plane() {
            words += &format!(" at {:.4}", stands_at(&plane));
        }
        words
    }
}

/// The same region, by its inside where that is a plane's: the outside of a half-space is a half-space, whose normal can be seen
/// and turned.
fn inside(shape: Shape) -> Shape {
    shape.as_plane().map_or(shape, Shape::from)
}

fn across(axis: DVec3, centre: DVec3) -> Shape {
    let plane = Plane::new(axis, -axis.dot(centre)).expect("an axis is finite and not zero");
    plane.into()
}

#[cfg(test)]
mod tests;
