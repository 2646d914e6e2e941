//! Sets of Gaussians from and to NumPy arrays.

use std::io::Cursor;
use std::path::PathBuf;
use std::sync::Arc;

use bytemuck::cast_slice;
use glam::{DAffine3, DMat4, DVec3, Quat, Vec3};
use numpy::{Element, PyUntypedArrayMethods};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use rara::scene::layers::FileNumbers;
use rara::scene::{
    self, Annotations, LoadOptions, Predicate, Property, SaveOptions, sh_coefficients, sh_of_colour,
};
use rara::{Error, GaussianArrays, Placement, Training};

use crate::arrays::{Array, fixed, numbers, owned, view};
use crate::errors::{check_room, choice, invalid, of_argument, raised};

/// The Gaussians of a set, with what a file has beside them. Nothing changes them.
#[derive(Debug, Default)]
pub(crate) struct Set {
    pub(crate) gaussians: rara::Gaussians,
    pub(crate) properties: Vec<Property>,
    pub(crate) annotations: Option<Annotations>,
    pub(crate) report: Report,
    /// Their place in a file, where a selection has divided it.
    pub(crate) numbers: Option<FileNumbers>,
}

/// What reading has dropped and repaired, with sentences about that.
#[derive(Debug, Clone, Default, IntoPyObject)]
pub(crate) struct Report {
    pub(crate) dropped: u64,
    pub(crate) repaired: u64,
    pub(crate) notes: Vec<String>,
}

/// A set of 3D Gaussians, which does not change.
///
/// `means` [N, 3] are the centres and `scales` [N, 3] the standard deviations, both in world units; `quats` [N, 4] are
/// rotations w, x, y, z, which are normalised; `opacities` [N] are from 0 to 1. The colours are either `colors` [N, 3],
/// red, green and blue from 0 to 1, or `sh` [N, K, 3], spherical harmonics of K = 1, 4, 9 or 16 coefficients.
/// All arrays are float32; other real numbers are converted. Each array is copied once.
/// `origin` is the point that the means are relative to, for scenes far from zero. `antialiased`, `low_pass` (square
/// pixels) and `alpha_max` say how the Gaussians were trained. `properties` are further numbers [N] by name.
///
/// InvalidError names the array that does not fit, and the first number in it that cannot be drawn.
#[pyclass(frozen, module = "rara")]
pub(crate) struct Gaussians(pub(crate) Arc<Set>);

impl From<Set> for Gaussians {
    fn from(set: Set) -> Self {
        Self(Arc::new(set))
    }
}

impl Set {
    /// Other Gaussians that come from these, each from that of a number here.
    pub(crate) fn derived(&self, gaussians: rara::Gaussians, sources: &[u32]) -> Gaussians {
        let properties = self.properties.iter().map(|one| one.of(sources));
        let (properties, report) = (properties.collect(), self.report.clone());
        Gaussians::from(Set {
            gaussians,
            properties,
            report,
            ..Set::default()
        })
    }
}

/// A read-only array over numbers of Gaussians, of which each has so many.
fn rows<'py, T: Element>(
    this: &Bound<'py, Gaussians>,
    of: impl Fn(&Set) -> &[T],
    each: &[usize],
) -> PyResult<Array<'py, T>> {
    let set = &this.get().0;
    view(this, of(set), &[&[set.gaussians.len()], each].concat())
}

#[pymethods]
impl Gaussians {
    #[new]
    #[pyo3(signature = (means, quats, scales, opacities, sh=None, *, colors=None, origin=[0.0; 3],
        antialiased=false, low_pass=0.3, alpha_max=0.99, properties=None))]
    #[allow(clippy::too_many_arguments)] // they have names in Python
    fn new(
        py: Python<'_>,
        means: &Bound<'_, PyAny>,
        quats: &Bound<'_, PyAny>,
        scales: &Bound<'_, PyAny>,
        opacities: &Bound<'_, PyAny>,
        sh: Option<&Bound<'_, PyAny>>,
        colors: Option<&Bound<'_, PyAny>>,
        origin: [f64; 3],
        antialiased: bool,
        low_pass: f32,
        alpha_max: f32,
        properties: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<Self> {
        let means = numbers::<f32>(means, "means", &[None, Some(3)])?;
        let count = Some(means.shape()[0]);
        let scales = numbers::<f32>(scales, "scales", &[count, Some(3)])?;
        let quats = numbers::<f32>(quats, "quats", &[count, Some(4)])?;
        let (sh_degree, sh) = match (sh, colors) {
            (Some(sh), None) => {
                let sh = numbers::<f32>(sh, "sh", &[count, None, Some(3)])?;
                let found = sh.shape()[1];
                let degree = (0..=3).find(|degree| sh_coefficients(*degree) == found);
                let refused = || {
                    invalid(format!(
                        "sh has K = {found} of [N, K, 3]; give 1, 4, 9 or 16"
                    ))
                };
                (degree.ok_or_else(refused)?, sh.as_slice()?.to_vec())
            }
            (None, Some(colors)) => {
                let colors = numbers::<f32>(colors, "colors", &[count, Some(3)])?;
                let colors = colors.as_slice()?;
                if let Some(at) = colors.iter().position(|colour| !colour.is_finite()) {
                    let (index, colour) = (at / 3, colors[at]);
                    return Err(invalid(format!(
                        "colors[{index}] is {colour}; give finite numbers"
                    )));
                }
                (
                    0,
                    colors.iter().map(|colour| sh_of_colour(*colour)).collect(),
                )
            }
            _ => return Err(PyTypeError::new_err("give either sh or colors")),
        };
        let quats = quats.as_slice()?.as_chunks().0;
        let turns: Vec<_> = quats.iter().map(unit).collect();
        if let Some(at) = turns.iter().position(|turn| !turn.is_finite()) {
            let message = format!("quats[{at}] is {:?}; give a rotation w, x, y, z", quats[at]);
            return Err(invalid(message));
        }
        let arrays = GaussianArrays {
            origin: origin.into(),
            positions: vectors(means.as_slice()?),
            scales: vectors(scales.as_slice()?),
            rotations: turns,
            opacities: numbers::<f32>(opacities, "opacities", &[count])?
                .as_slice()?
                .to_vec(),
            sh_degree,
            sh,
            training: Training::default()
                .antialiased(antialiased)
                .low_pass(low_pass)
                .alpha_max(alpha_max),
        };
        let properties = properties.into_iter().flat_map(|all| all.iter());
        let properties = properties.map(|(name, values)| {
            let name: String = name.extract()?;
            let values = numbers::<f64>(&values, &format!("properties['{name}']"), &[count])?;
            Ok(Property::new(name, values.as_slice()?.to_vec()))
        });
        let properties = properties.collect::<PyResult<_>>()?;
        let made = py.detach(|| rara::Gaussians::new(arrays));
        let gaussians = made.map_err(|error| match error {
            Error::Invalid(message) => invalid(message.replacen("positions[", "means[", 1)),
            other => raised(other),
        })?;
        Ok(Self::from(Set {
            gaussians,
            properties,
            ..Set::default()
        }))
    }

    /// Reads Gaussians from the bytes of a file in any format. `name` stands for the file in messages.
    #[staticmethod]
    #[pyo3(signature = (data, name="data"))]
    fn from_bytes(py: Python<'_>, data: &[u8], name: &str) -> PyResult<Self> {
        let options = LoadOptions::from(&["*"]);
        let read =
            || scene::load_from_with(Cursor::new(data), name.as_ref(), options, &mut |_, _| ());
        let (file, properties) = py.detach(read).map_err(raised)?;
        Ok(Self::from(Set {
            gaussians: file.gaussians,
            properties,
            annotations: file.annotations,
            report: Report {
                dropped: file.report.dropped,
                repaired: file.report.repaired,
                notes: file.report.lines(),
            },
            numbers: None,
        }))
    }

    fn __len__(&self) -> usize {
        self.0.gaussians.len()
    }

    fn __repr__(&self) -> String {
        let gaussians = &self.0.gaussians;
        let (count, degree) = (gaussians.len(), gaussians.sh_degree());
        format!("<rara.Gaussians: {count} of degree {degree}>")
    }

    /// Centres, world units from the origin: float32 [N, 3], read-only, no copy.
    #[getter]
    fn means<'py>(this: &Bound<'py, Self>) -> PyResult<Array<'py, f32>> {
        rows(this, |set| cast_slice(set.gaussians.positions()), &[3])
    }

    /// Standard deviations, world units: float32 [N, 3], read-only, no copy.
    #[getter]
    fn scales<'py>(this: &Bound<'py, Self>) -> PyResult<Array<'py, f32>> {
        rows(this, |set| cast_slice(set.gaussians.scales()), &[3])
    }

    /// Unit quaternions w, x, y, z: float32 [N, 4], a copy, since the library has w last.
    #[getter]
    fn quats<'py>(&self, py: Python<'py>) -> PyResult<Array<'py, f32>> {
        let rotations = self.0.gaussians.rotations();
        let numbers = rotations.iter().flat_map(|q| [q.w, q.x, q.y, q.z]);
        owned(py, numbers.collect(), &[rotations.len(), 4])
    }

    /// Opacities at the centres, 0 to 1: float32 [N], read-only, no copy.
    #[getter]
    fn opacities<'py>(this: &Bound<'py, Self>) -> PyResult<Array<'py, f32>> {
        rows(this, |set| set.gaussians.opacities(), &[])
    }

    /// Spherical harmonics: float32 [N, K, 3], read-only, no copy.
    #[getter]
    fn sh<'py>(this: &Bound<'py, Self>) -> PyResult<Array<'py, f32>> {
        let coefficients = this.get().0.gaussians.sh_coefficients();
        rows(this, |set| set.gaussians.sh(), &[coefficients, 3])
    }

    /// Numbers of each Gaussian beside those, by name: float64 [N], read-only, no copies.
    #[getter]
    fn properties<'py>(this: &Bound<'py, Self>) -> PyResult<Bound<'py, PyDict>> {
        let all = PyDict::new(this.py());
        for (at, one) in this.get().0.properties.iter().enumerate() {
            all.set_item(
                &one.name,
                rows(this, |set| &set.properties[at].values, &[])?,
            )?;
        }
        Ok(all)
    }

    /// The point that the means are relative to, world units.
    #[getter]
    fn origin(&self) -> [f64; 3] {
        self.0.gaussians.origin().into()
    }

    /// How they were trained, in words.
    #[getter]
    fn training(&self) -> String {
        self.0.gaussians.training().to_string()
    }

    /// The numbers of Gaussians that reading has "dropped" and "repaired", and "notes" about that.
    #[getter]
    fn report(&self) -> Report {
        self.0.report.clone()
    }

    /// Says of each Gaussian whether a predicate of `rara --select` takes it: bool [N]. "opacity<0.5 and label in 3,4" compares
    /// `opacity`, `size`, `cluster_size`, `red`, `green`, `blue` and `properties`; "inside(CLIP)" takes what a clip keeps.
    fn select<'py>(&self, py: Python<'py>, predicate: &str) -> PyResult<Array<'py, bool>> {
        let predicate: Predicate = predicate.parse().map_err(of_argument("predicate"))?;
        let set = &self.0;
        let select = || predicate.select(&set.gaussians, &set.properties, &Placement::IDENTITY);
        let taken = py.detach(select).map_err(of_argument("predicate"))?;
        owned(py, taken, &[set.gaussians.len()])
    }

    /// Returns the Gaussians of a mask, bool [N], with their properties.
    fn filter(&self, py: Python<'_>, mask: &Bound<'_, PyAny>) -> PyResult<Self> {
        let mask = numbers::<bool>(mask, "mask", &[Some(self.0.gaussians.len())])?;
        let mask: Vec<u32> = mask
            .as_slice()?
            .iter()
            .map(|taken| (*taken).into())
            .collect();
        let mut set = self.0.gaussians.clone();
        let parts = py.detach(|| set.divide(&mask, 2)).map_err(raised)?;
        let part = parts.into_iter().nth(1).unwrap_or_default();
        Ok(self.0.derived(part.gaussians, &part.numbers))
    }

    /// Returns the Gaussians moved by an affine matrix [4, 4], in double precision.
    fn transform(&self, py: Python<'_>, matrix: &Bound<'_, PyAny>) -> PyResult<Self> {
        let matrix = fixed::<16>(matrix, "matrix", [4, 4])?;
        if matrix[12..] != [0.0, 0.0, 0.0, 1.0] {
            return Err(invalid("matrix is not affine; its last row is 0, 0, 0, 1"));
        }
        let matrix = DAffine3::from_mat4(DMat4::from_cols_array(&matrix).transpose());
        let mut gaussians = self.0.gaussians.clone();
        let dropped = py.detach(|| gaussians.transform(&matrix));
        if let Some(first) = dropped.first() {
            let message = format!("matrix: it moves Gaussian {first} beyond single precision");
            return Err(invalid(message));
        }
        let all: Vec<u32> = (0..gaussians.len() as u32).collect();
        Ok(self.0.derived(gaussians, &all))
    }

    /// Writes them to a file in the format of its name, .ply, .compressed.ply, .spz, .sog or .glb, with their properties where
    /// the format has them. Returns the number of Gaussians with a number that the format had to limit.
    #[pyo3(signature = (path, *, up=None))]
    fn save(&self, py: Python<'_>, path: PathBuf, up: Option<[f64; 3]>) -> PyResult<u64> {
        let set = &self.0;
        let options = SaveOptions::default().annotations(set.annotations.clone());
        let options = options
            .properties(set.properties.clone())
            .up(up.map(DVec3::from));
        py.detach(|| scene::save_with(&path, &set.gaussians, &options))
            .map_err(raised)
    }
}

/// Makes Gaussians of a kind, "general", "strands" or "layers", by a seed: the same at every call.
#[pyfunction]
#[pyo3(signature = (kind, count, seed=1))]
pub(crate) fn generate(py: Python<'_>, kind: &str, count: u64, seed: u64) -> PyResult<Gaussians> {
    let kind = choice("kind", kind)?;
    check_room(count, 4 * (3 + 3 + 4 + 1 + 48), "Gaussians").map_err(raised)?;
    Ok(Gaussians::from(Set {
        gaussians: py.detach(|| scene::generate(kind, count as usize, seed)),
        ..Set::default()
    }))
}

fn vectors(numbers: &[f32]) -> Vec<Vec3> {
    let vectors = numbers.as_chunks().0.iter();
    vectors.map(|vector| Vec3::from_array(*vector)).collect()
}

/// The unit quaternion of w, x, y, z. One without a direction becomes none, and is refused.
fn unit(&[w, x, y, z]: &[f32; 4]) -> Quat {
    let given = Quat::from_xyzw(x, y, z, w);
    match given.is_normalized() {
        true => given,
        false => given.as_dquat().normalize().as_quat(),
    }
}
