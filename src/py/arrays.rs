//! NumPy arrays to and from what the library has.

use numpy::ndarray::{ArrayView, IxDyn};
use numpy::prelude::*;
use numpy::{
    Element, PyArrayDescr, PyArrayDyn, PyReadonlyArrayDyn, PyUntypedArray, get_array_module,
};
use pyo3::prelude::*;
use pyo3::types::IntoPyDict;

use crate::errors::invalid;

/// An array as a result.
pub(crate) type Array<'py, T> = Bound<'py, PyArrayDyn<T>>;

/// The shape that an argument must have: `None` stands for any length.
pub(crate) type Shape<'a> = &'a [Option<usize>];

/// The numbers of an argument: a NumPy array, whatever has `__array__` or DLPack, or nested sequences. They are copied only where
/// they are of another type or have gaps.
pub(crate) fn numbers<'py, T: Element>(
    given: &Bound<'py, PyAny>,
    name: &str,
    wanted: Shape<'_>,
) -> PyResult<PyReadonlyArrayDyn<'py, T>> {
    let py = given.py();
    let numpy = get_array_module(py)?;
    // Tensors that have gradients refuse to be arrays; the picture has none.
    let given = match given.hasattr("requires_grad")? {
        true => &given.call_method0("detach")?,
        false => given,
    };
    let convert = match given.hasattr("__dlpack__")? && !given.hasattr("__array__")? {
        true => "from_dlpack",
        false => "asarray",
    };
    let array = numpy.call_method1(convert, (given,));
    let array = array.map_err(|error| invalid(format!("{name}: {}", error.value(py))))?;
    let array = array.cast_into::<PyUntypedArray>()?;
    let expected = PyArrayDescr::of::<T>(py);
    let kinds: &[u8] = match expected.kind() {
        b'b' => b"b",
        _ => b"fiu",
    };
    if !kinds.contains(&array.dtype().kind()) {
        let dtype = array.dtype();
        return Err(invalid(format!(
            "{name} is an array of {dtype}; give one of {expected}"
        )));
    }
    let shape = array.shape();
    let fits =
        |(side, wanted): (&usize, &Option<usize>)| wanted.is_none_or(|wanted| wanted == *side);
    if shape.len() != wanted.len() || !shape.iter().zip(wanted).all(fits) {
        let wanted = wanted
            .iter()
            .map(|side| side.map_or("N".into(), |side| side.to_string()));
        let wanted = wanted.collect::<Vec<_>>().join(", ");
        return Err(invalid(format!(
            "{name} has the shape {shape:?}; give [{wanted}]"
        )));
    }
    let kwargs = [("dtype", expected)].into_py_dict(py)?;
    let whole = numpy.call_method("ascontiguousarray", (array,), Some(&kwargs))?;
    whole.extract()
}

/// The same of a fixed number of numbers, row by row.
pub(crate) fn fixed<const N: usize>(
    given: &Bound<'_, PyAny>,
    name: &str,
    shape: [usize; 2],
) -> PyResult<[f64; N]> {
    let array = numbers::<f64>(given, name, &shape.map(Some))?;
    Ok(array.as_slice()?.try_into()?)
}

/// A read-only array over numbers that an object owns: no copy.
pub(crate) fn view<'py, T: Element, O>(
    owner: &Bound<'py, O>,
    numbers: &[T],
    shape: &[usize],
) -> PyResult<Array<'py, T>> {
    let shaped = ArrayView::from_shape(IxDyn(shape), numbers).map_err(invalid)?;
    // SAFETY: callers give numbers of a frozen object, which stay in place as long as it lives, and the array keeps it alive.
    let array = unsafe { PyArrayDyn::borrow_from_array(&shaped, owner.clone().into_any()) };
    array.readwrite().make_nonwriteable();
    Ok(array)
}

/// An array that owns its numbers.
pub(crate) fn owned<'py, T: Element>(
    py: Python<'py>,
    numbers: Vec<T>,
    shape: &[usize],
) -> PyResult<Array<'py, T>> {
    numpy::PyArray1::from_vec(py, numbers).reshape(IxDyn(shape))
}
