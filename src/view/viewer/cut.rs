//! A clip that is shown, and the one of its shapes that is held: a prism is one of them here.

use glam::DVec3;
use rara::clip::{Expression, Lasso};
use rara::{Camera, Clip, ClipOp, Placement, Plane, Shape};

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
    pub(super) fn shapes(&self) -> Vec<&Expression> {
        let expressions = self.expressions.iter();
        expressions.flat_map(Expression::leaves).collect()
    }

    /// The number of the held shape among them.
    pub(super) fn held(&self) -> usize {
        self.held
    }

    /// The held shape; none in a clip that keeps everything.
    pub(super) fn shape(&self) -> Option<&Expression> {
        let shapes = self.shapes();
        shapes.get(self.held).or(shapes.last()).copied()
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
        let middle = self.shape().map(|shape| shape.middle(self.centre));
        self.pivot.or(middle).unwrap_or(self.centre)
    }

    pub(super) fn next(&mut self) {
        self.held = (self.held + 1) % self.shapes().len().max(1);
        self.pivot = None;
    }

    /// Puts another shape in the held one's place, and switches the clip on.
    pub(super) fn set(&mut self, shape: Shape) {
        self.pivot = None;
        self.replace(Expression::Shape(inside(shape)));
    }

    fn replace(&mut self, shape: Expression) {
        let mut shapes = self.expressions.iter_mut().flat_map(Expression::leaves_mut);
        match shapes.nth(self.held) {
            Some(held) => *held = shape,
            None => {
                self.held = 0;
                self.expressions.insert(0, shape);
            }
        }
        self.on = true;
    }

    /// Keeps the other side of the held shape.
    pub(super) fn flip(&mut self) {
        let mut before = self.held;
        for expression in &mut self.expressions {
            if flip(expression, &mut before) {
                break;
            }
        }
        self.on = true;
    }

    /// Scales, turns and moves the held shape. One whose numbers overflow stays where it was.
    pub(super) fn place(&mut self, placement: &Placement) {
        if let Some(Ok(shape)) = self.shape().map(|shape| shape.placed(placement)) {
            self.pivot = Some(placement.to_world(self.middle()));
            self.replace(shape);
        }
    }

    /// Keeps of what is kept what a lasso keeps in a camera's picture.
    ///
    /// # Errors
    /// The errors of [`Lasso::expression`].
    pub(super) fn lasso(&mut self, camera: &Camera, lasso: &Lasso) -> rara::Result<()> {
        let added = lasso.expression(camera)?;
        if !self.on {
            self.expressions.clear();
        } else if self.op == ClipOp::Or && self.expressions.len() > 1 {
            let all = std::mem::take(&mut self.expressions);
            self.expressions.push(Expression::Any(all));
        }
        self.expressions.push(added);
        (self.op, self.on, self.pivot) = (ClipOp::And, true, None);
        self.held = self.shapes().len() - 1;
        Ok(())
    }

    /// A plane through the middle of the scene, across an axis.
    pub(super) fn across(&self, axis: DVec3) -> Shape {
        across(axis, self.centre)
    }

    /// A few words on the held shape, for the title: `plane at 0.5000`, `outside of sphere 2 of 3`.
    pub(super) fn words(&self) -> String {
        let (shape, count) = (self.shape(), self.shapes().len());
        let mut words = match shape {
            Some(Expression::Shape(shape)) if shape.is_outside() => {
                format!("outside of {}", shape.solid().name())
            }
            Some(shape) => shape.name().to_owned(),
            None => "whole".into(),
        };
        if count > 1 {
            words += &format!(" {} of {count}", self.held + 1);
        }
        if let Some(plane) = shape.and_then(Expression::as_plane) {
            words += &format!(" at {:.4}", stands_at(&plane));
        }
        words
    }
}

/// Makes an expression keep the other side of its shape of this number, which is counted down; says whether it has that one.
fn flip(expression: &mut Expression, before: &mut usize) -> bool {
    match expression {
        Expression::All(all) | Expression::Any(all) => all.iter_mut().any(|one| flip(one, before)),
        Expression::Not(inner)
            if *before == 0 && matches!(**inner, Expression::Prism(_) | Expression::Mesh(_)) =>
        {
            let kept = (**inner).clone();
            *expression = kept;
            true
        }
        Expression::Not(inner) => flip(inner, before),
        Expression::Shape(_) | Expression::Prism(_) | Expression::Mesh(_) if *before > 0 => {
            *before -= 1;
            false
        }
        Expression::Shape(shape) => {
            *shape = match shape.as_plane() {
                Some(plane) => plane.flipped().into(),
                None => shape.complement(),
            };
            true
        }
        Expression::Prism(_) | Expression::Mesh(_) => {
            *expression = Expression::Not(Box::new(expression.clone()));
            true
        }
        _ => false,
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
