//! Predicates: which Gaussians of a set a selection takes.

use super::{Gaussians, Part, Property, SH_0};
use crate::clip::Expression;
use crate::clusters::Clusters;
use crate::placement::Placement;
use rara_base::counted::counted;
use rara_base::error::{Error, Result, shortened};

/// The condition of a selection: it takes the Gaussians that fulfil this tree of comparisons and regions. It parses from text:
/// `opacity>0.5`, `size<=0.01`, `label in 3,4` or `label in 1..7`, and `inside(sphere:0,0,0,1)`, joined by `and`, `or`, `not`
/// and `( )`, where `not` goes before `and` and that before `or`.
///
/// ```
/// # use rara_scene as rara;
/// use rara::scene::{self, Predicate};
///
/// let scene = scene::generate(scene::Kind::General, 1000, 1);
/// let faint: Predicate = "opacity<0.5 and not inside(sphere:0,0,0,0.1)".parse()?;
/// let [rest, taken] = faint.split(scene, &[])?;
/// assert_eq!(rest.numbers.len() + taken.numbers.len(), 1000);
/// assert!(taken.gaussians.opacities().iter().all(|&opacity| opacity < 0.5));
/// # Ok::<(), rara::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Predicate {
    /// The centre is in the region.
    Inside(Expression),
    /// The attribute compares so with the number.
    Compare(Attribute, Comparison, f64),
    /// The attribute is in one of the ranges, each of which holds both of its ends.
    In(Attribute, Vec<[f64; 2]>),
    /// All of them; at least one.
    All(Vec<Predicate>),
    /// Any of them; at least one.
    Any(Vec<Predicate>),
    /// Not this.
    Not(Box<Predicate>),
}

/// A number of a Gaussian that predicates compare.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum Attribute {
    /// The opacity at its centre, 0 to 1.
    Opacity,
    /// The largest standard deviation of the Gaussian, in the units of the scene.
    Size,
    /// The number of Gaussians in its [cluster](Clusters), itself included: small where it floats by itself.
    ClusterSize,
    /// Red of its colour of degree 0, which is that from all sides where there are no higher degrees: 0 to 1 or beyond.
    Red,
    /// Green of the same.
    Green,
    /// Blue of the same.
    Blue,
    /// A property of this name that its file has beside those of a Gaussian.
    Property(String),
}

/// How two numbers compare.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Comparison {
    /// `<`
    Less,
    /// `<=`
    LessOrEqual,
    /// `>`
    Greater,
    /// `>=`
    GreaterOrEqual,
    /// `=`
    Equal,
    /// `!=`
    NotEqual,
}

impl Comparison {
    fn holds(self, a: f64, b: f64) -> bool {
        match self {
            Self::Less => a < b,
            Self::LessOrEqual => a <= b,
            Self::Greater => a > b,
            Self::GreaterOrEqual => a >= b,
            Self::Equal => a == b,
            // What is no number is neither equal nor unequal to one.
            Self::NotEqual => !a.is_nan() && a != b,
        }
    }
}

impl Predicate {
    /// The names of the properties that it compares, each once: those to ask [`load_with`](super::load_with) for.
    pub fn properties(&self) -> Vec<&str> {
        let mut names = Vec::new();
        self.collect(&mut names);
        names.sort_unstable();
        names.dedup();
        names
    }

    fn collect<'a>(&'a self, names: &mut Vec<&'a str>) {
        match self {
            Self::Compare(Attribute::Property(name), ..)
            | Self::In(Attribute::Property(name), _) => names.push(name),
            Self::Inside(_) | Self::Compare(..) | Self::In(..) => {}
            Self::All(all) | Self::Any(all) => all.iter().for_each(|one| one.collect(names)),
            Self::Not(one) => one.collect(names),
        }
    }

    /// For each Gaussian whether the predicate takes it. `placement` is that of the Gaussians: regions and sizes are the
    /// scene's. Numbers that are stored in single precision are compared in single precision, so that `=0.1` finds a
    /// stored 0.1; a value that is no number fulfils no comparison.
    ///
    /// # Errors
    /// [`Error::Invalid`] for a property that is not among `properties`, or that has another number of values.
    pub fn select(
        &self,
        gaussians: &Gaussians,
        properties: &[Property],
        placement: &Placement,
    ) -> Result<Vec<bool>> {
        let placement = &placement.of_origin(gaussians.origin());
        let each = |holds: &dyn Fn(usize) -> bool| (0..gaussians.len()).map(holds).collect();
        let select = |one: &Self| one.select(gaussians, properties, placement);
        Ok(match self {
            Self::Inside(expression) => {
                let region = expression.clip().in_scene(placement);
                each(&|i| region.keeps(gaussians.positions()[i].as_dvec3()))
            }
            Self::Compare(attribute, comparison, number) => {
                let values = Values::of_attribute(attribute, gaussians, properties, placement)?;
                let number = values.rounded(*number);
                each(&|i| comparison.holds((values.get)(i), number))
            }
            Self::In(attribute, ranges) => {
                let values = Values::of_attribute(attribute, gaussians, properties, placement)?;
                let ranges: Vec<_> = ranges
                    .iter()
                    .map(|ends| ends.map(|end| values.rounded(end)))
                    .collect();
                each(&|i| {
                    let value = (values.get)(i);
                    ranges
                        .iter()
                        .any(|&[low, high]| low <= value && value <= high)
                })
            }
            Self::All(all) => joined(vec![true; gaussians.len()], all, select, |a, b| a & b)?,
            Self::Any(any) => joined(vec![false; gaussians.len()], any, select, |a, b| a | b)?,
            Self::Not(one) => select(one)?.into_iter().map(|taken| !taken).collect(),
        })
    }

    /// Divides Gaussians, which are placed as they are, into those that it leaves and those that it takes.
    ///
    /// # Errors
    /// The errors of [`select`](Self::select) and [`Gaussians::into_parts`].
    pub fn split(&self, gaussians: Gaussians, properties: &[Property]) -> Result<[Part; 2]> {
        let taken = self.select(&gaussians, properties, &Placement::IDENTITY)?;
        let part_of: Vec<u32> = taken.into_iter().map(u32::from).collect();
        let mut parts = gaussians.into_parts(&part_of, 2)?.into_iter();
        Ok([(); 2].map(|()| parts.next().unwrap_or_default()))
    }
}

/// Joins what each of the predicates takes.
fn joined(
    mut taken: Vec<bool>,
    predicates: &[Predicate],
    select: impl Fn(&Predicate) -> Result<Vec<bool>>,
    join: fn(bool, bool) -> bool,
) -> Result<Vec<bool>> {
    for predicate in predicates {
        for (taken, other) in taken.iter_mut().zip(select(predicate)?) {
            *taken = join(*taken, other);
        }
    }
    Ok(taken)
}

/// An attribute's values.
struct Values<'a> {
    get: Box<dyn Fn(usize) -> f64 + 'a>,
    single: bool,
}

impl<'a> Values<'a> {
    fn of_attribute(
        attribute: &Attribute,
        gaussians: &'a Gaussians,
        properties: &'a [Property],
        placement: &Placement,
    ) -> Result<Self> {
        let colour = |channel: usize| -> Box<dyn Fn(usize) -> f64 + 'a> {
            Box::new(move |i| {
                f64::from((0.5 + SH_0 * f64::from(gaussians.sh_of(i)[channel])) as f32)
            })
        };
        let unit = placement.scale();
        let get: Box<dyn Fn(usize) -> f64 + 'a> = match attribute {
            Attribute::Opacity => Box::new(|i| gaussians.opacities()[i].into()),
            Attribute::Size => Box::new(move |i| {
                let size = f64::from(gaussians.scales()[i].max_element());
                f64::from((unit * size) as f32)
            }),
            Attribute::ClusterSize => {
                let clusters = Clusters::of(gaussians);
                Box::new(move |i| clusters.size_at(i).into())
            }
            Attribute::Red => colour(0),
            Attribute::Green => colour(1),
            Attribute::Blue => colour(2),
            Attribute::Property(name) => {
                let property = properties.iter().find(|property| property.name == *name);
                let Some(property) = property else {
                    return Err(Error::Invalid(format!(
                        "the property `{}` was not loaded; ask for it by its name",
                        shortened(name)
                    )));
                };
                if property.values.len() != gaussians.len() {
                    return Err(Error::Invalid(format!(
                        "the property `{}` has {} for {}; give one each",
                        shortened(name),
                        counted(property.values.len(), "value"),
                        counted(gaussians.len(), "Gaussian")
                    )));
                }
                return Ok(Self {
                    get: Box::new(|i| property.values[i]),
                    single: property.single,
                });
            }
        };
        Ok(Self { get, single: true })
    }

    /// A number as it would be stored among the values.
    fn rounded(&self, number: f64) -> f64 {
        match self.single {
            true => f64::from(number as f32),
            false => number,
        }
    }
}

#[cfg(test)]
mod tests;
