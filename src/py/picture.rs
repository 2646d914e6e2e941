//! Pictures.

use std::path::PathBuf;

use numpy::{PyArrayDescrMethods, PyUntypedArray, PyUntypedArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use rara::{FrameStats, Picture as RaraPicture};
use rara_reference::comparison;

use crate::arrays::{Array, numbers, owned, view};
use crate::errors::{invalid, plain, raised};

/// A picture: red, green, blue and alpha in 32-bit floats, the colours premultiplied by alpha, row by row from the top left.
///
/// `Picture(pixels)` copies an array [height, width, 4]. `numpy.asarray(picture)` and `picture.array` are read-only float32
/// arrays over the picture's own memory. A notebook shows a picture by itself.
#[pyclass(frozen, module = "rara")]
pub(crate) struct Picture {
    picture: RaraPicture,
    stats: Option<FrameStats>,
}

impl Picture {
    pub(crate) fn new(picture: RaraPicture, stats: Option<FrameStats>) -> Self {
        Self { picture, stats }
    }
}

#[pymethods]
impl Picture {
    #[new]
    fn of_pixels(pixels: &Bound<'_, PyAny>) -> PyResult<Self> {
        let given = pixels.cast::<PyUntypedArray>();
        if given.is_ok_and(|array| array.dtype().kind() != b'f') {
            let message = "pixels is an array of integers; give floats, premultiplied, from 0 to 1";
            return Err(invalid(message));
        }
        let array = numbers::<f32>(pixels, "pixels", &[None, None, Some(4)])?;
        let side = |at: usize| u32::try_from(array.shape()[at]).map_err(invalid);
        let (height, width) = (side(0)?, side(1)?);
        let pixels = array.as_slice()?.as_chunks().0.to_vec();
        let picture = RaraPicture {
            width,
            height,
            pixels,
        };
        Ok(Self::new(picture, None))
    }

    /// Reads a .png or .exr file.
    #[staticmethod]
    fn load(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        let picture = py.detach(|| RaraPicture::load(path)).map_err(raised)?;
        Ok(Self::new(picture, None))
    }

    /// Width and height, pixels.
    #[getter]
    fn size(&self) -> (u32, u32) {
        (self.picture.width, self.picture.height)
    }

    /// The pixels: float32 [height, width, 4], premultiplied, read-only, no copy.
    #[getter]
    fn array<'py>(this: &Bound<'py, Self>) -> PyResult<Array<'py, f32>> {
        let picture = &this.get().picture;
        view(this, picture.pixels.as_flattened(), &shape(picture))
    }

    #[pyo3(signature = (dtype=None, copy=None))]
    fn __array__<'py>(
        this: &Bound<'py, Self>,
        dtype: Option<&Bound<'py, PyAny>>,
        copy: Option<bool>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let array = Self::array(this)?.into_any();
        match (dtype, copy) {
            (None, Some(true)) => array.call_method0("copy"),
            (None, _) => Ok(array),
            (Some(dtype), _) => array.call_method1("astype", (dtype,)),
        }
    }

    /// The pixels as a .png file has them: uint8 [height, width, 4], straight (not premultiplied), round(255 c).
    fn rgba8<'py>(&self, py: Python<'py>) -> PyResult<Array<'py, u8>> {
        let bytes = py.detach(|| self.picture.to_rgba8());
        owned(py, bytes, &shape(&self.picture))
    }

    /// The bytes of a .png file.
    #[pyo3(name = "_repr_png_")]
    fn png<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let bytes = py.detach(|| self.picture.to_png()).map_err(raised)?;
        Ok(PyBytes::new(py, &bytes))
    }

    /// Writes a .png (8 bits, straight), .exr or .npy file (32-bit floats, premultiplied).
    fn save(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        py.detach(|| self.picture.save(path)).map_err(raised)
    }

    /// Times and counts of the frame, as `rara render --json` has them; None for a picture that no renderer has drawn.
    #[getter]
    fn stats(&self, py: Python<'_>) -> PyResult<Option<Py<PyAny>>> {
        let stats = self.stats.as_ref();
        stats.map(|stats| plain(py, stats)).transpose()
    }

    fn __repr__(&self) -> String {
        let (width, height) = self.size();
        format!("<rara.Picture: {width}x{height}>")
    }
}

fn shape(picture: &RaraPicture) -> [usize; 3] {
    [picture.height as usize, picture.width as usize, 4]
}

/// Compares two pictures of one size, rara.Picture or arrays [height, width, 4]: the largest difference "max", the mean "l1" and
/// "rmse" in units of 1/255, "psnr" in decibels (None where they are equal), "ssim", the share "share_over_2" of pixels that
/// differ by more than 2/255, and how much more ("leak") and less ("loss") light the first one has.
#[pyfunction]
pub(crate) fn compare(
    py: Python<'_>,
    a: &Bound<'_, PyAny>,
    b: &Bound<'_, PyAny>,
) -> PyResult<Py<PyAny>> {
    let (a, b) = (Picture::of_pixels(a)?, Picture::of_pixels(b)?);
    let compare = || comparison::compare(&a.picture, &b.picture);
    plain(py, &py.detach(compare).map_err(raised)?)
}
