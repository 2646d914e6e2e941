//! The renderer: a device, and the scene on it.

use std::sync::{Mutex, MutexGuard, PoisonError};

use pyo3::prelude::*;
use pyo3::types::{PyDict, PyString};
use rara::ash::vk::{Extent2D, Offset2D, Rect2D};
use rara::clip::Expression;
use rara::gpu::list_devices;
use rara::{
    Aov, Clip, Error, Headless, HeadlessDesc, PipelineCache, Preset, Result, Scene, Settings,
    ShFormat, Shape,
};
use rara_shots::{Panorama, Slice};

use crate::arrays::{Array, owned};
use crate::camera::{CameraOf, Size, camera_of};
use crate::clip::ClipOf;
use crate::errors::{check_room, choice, invalid, raised};
use crate::picture::Picture;
use crate::scene::{Layer, SceneOf};

/// The native part of `rara.Renderer`.
#[pyclass(frozen, subclass, module = "rara")]
pub(crate) struct Renderer {
    state: Mutex<State>,
    /// The device's name.
    #[pyo3(get)]
    device: String,
    /// The driver's name and version.
    #[pyo3(get)]
    driver: String,
}

struct State {
    headless: Headless,
    /// The scene on the device, if its upload has succeeded.
    shown: Option<(Vec<Layer>, ShFormat)>,
}

impl State {
    /// Brings a scene to the device. Of a scene whose Gaussians are there already, only states and clips of layers change.
    fn show(&mut self, of: &SceneOf, scene: Scene<'_>, format: ShFormat) -> Result<()> {
        let is_there = self.shown.take().is_some_and(|(layers, shown)| {
            let mut all = layers.iter().zip(&of.layers);
            shown == format && layers.len() == of.layers.len() && all.all(|(a, b)| a.is_of(b))
        });
        if is_there {
            for (index, layer) in scene.layers().iter().enumerate() {
                // What is set again counts as a change, for which the next frame computes more.
                let there = &self.headless.layers()[index];
                let changes = (there.state() != layer.state(), there.clip() != layer.clip());
                if changes.0 {
                    self.headless.set_layer_state(index, layer.state())?;
                }
                if changes.1 {
                    self.headless.set_layer_clip(index, layer.clip().cloned())?;
                }
            }
        } else {
            self.headless.load_as(scene, format)?;
        }
        self.shown = Some((of.layers.clone(), format));
        Ok(())
    }
}

/// A picture that is asked for: its scene, camera, clip, section (a clip that also cuts layers with clips of their own), size and
/// settings.
pub(crate) type Request<'py> = (
    SceneOf,
    Option<CameraOf>,
    Option<ClipOf>,
    Option<ClipOf>,
    Option<Size>,
    Bound<'py, PyDict>,
);

/// The same, once the scene is known.
pub(crate) struct Frame<'a> {
    of: &'a SceneOf,
    scene: Scene<'a>,
    camera: rara::Camera,
    clip: Clip,
    settings: Settings,
}

/// Acts on the frame of a request while other threads of Python run.
fn act<R: Send>(
    py: Python<'_>,
    (of, camera, clip, section, size, settings): &Request<'_>,
    act: impl FnOnce(Frame<'_>) -> Result<R> + Send,
) -> PyResult<R> {
    let settings = settings_of(settings)?;
    let given = camera.as_ref().map(|camera| &camera.0);
    let acted = py.detach(|| {
        let camera = camera_of(given, size.as_ref().map(|size| size.0), of)?;
        let pixels = u64::from(camera.width) * u64::from(camera.height);
        check_room(pixels, 64, "pixels")?; // so much takes one while it is drawn and read back
        let in_scene = |clip: &ClipOf| clip.0.region.resolve(|| of.bounds());
        let section: Vec<_> = section.iter().map(in_scene).collect::<Result<_>>()?;
        let mut all: Vec<_> = clip.iter().map(in_scene).collect::<Result<_>>()?;
        all.extend_from_slice(&section);
        act(Frame {
            of,
            scene: of.scene(&section)?,
            camera,
            clip: match all.is_empty() {
                true => Clip::default(),
                false => Expression::All(all).clip(),
            },
            settings,
        })
    });
    acted.map_err(raised)
}

/// The settings of keyword arguments, by the names of the command line with `_` for `-`.
fn settings_of(given: &Bound<'_, PyDict>) -> PyResult<Settings> {
    let mut settings = Settings::default();
    for (name, value) in given.iter().filter(|(_, value)| !value.is_none()) {
        let name: String = name.extract()?;
        let text = match (value.cast::<PyString>(), value.extract::<[f64; 3]>()) {
            (Ok(text), _) => text.to_string(),
            (_, Ok([r, g, b])) => format!("{r},{g},{b}"),
            _ => value.str()?.to_string().to_lowercase(),
        };
        match &name[..] {
            "preset" => settings.precision = choice::<Preset>("preset", &text)?.precision(),
            _ => settings
                .set(&name.replace('_', "-"), &text)
                .map_err(raised)?,
        }
    }
    Ok(settings)
}

impl Renderer {
    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Lets the device work at a request.
    fn work<R: Send>(
        &self,
        py: Python<'_>,
        request: &Request<'_>,
        work: impl FnOnce(&mut Headless, (&rara::Camera, &Clip, &Settings)) -> Result<R> + Send,
    ) -> PyResult<R> {
        act(py, request, |frame| {
            let mut state = self.state();
            state.show(frame.of, frame.scene, frame.settings.precision.sh)?;
            let seen = (&frame.camera, &frame.clip, &frame.settings);
            work(&mut state.headless, seen)
        })
    }
}

#[pymethods]
impl Renderer {
    #[new]
    #[pyo3(signature = (device=None, *, validation=false, cache=None))]
    fn new(
        py: Python<'_>,
        device: Option<&Bound<'_, PyAny>>,
        validation: bool,
        cache: Option<String>,
    ) -> PyResult<Self> {
        let device = device.map(|device| device.str().map(|text| text.to_string()));
        let cache = match cache.as_deref() {
            None => PipelineCache::User,
            Some("") => PipelineCache::Off,
            Some(folder) => PipelineCache::Folder(folder.into()),
        };
        let desc = HeadlessDesc::default().device(device.transpose()?);
        let desc = desc.validation(validation).pipeline_cache(cache);
        let headless = py.detach(|| Headless::new(&desc)).map_err(raised)?;
        Ok(Self {
            device: headless.device_name().to_owned(),
            driver: headless.driver().to_owned(),
            state: Mutex::new(State {
                headless,
                shown: None,
            }),
        })
    }

    fn _render(&self, py: Python<'_>, request: Request<'_>) -> PyResult<Picture> {
        self.work(py, &request, |headless, (camera, clip, settings)| {
            let stats = headless.render(camera, clip, settings)?;
            Ok(Picture::new(headless.picture()?, Some(stats)))
        })
    }

    fn _channels<'py>(
        &self,
        py: Python<'py>,
        request: Request<'_>,
        names: Vec<String>,
    ) -> PyResult<Vec<Array<'py, f32>>> {
        let aovs = names.iter().map(|name| choice::<Aov>("names", name));
        let aovs = aovs.collect::<PyResult<Vec<_>>>()?;
        let (size, channels) = self.work(py, &request, |headless, frame| {
            Ok((
                [frame.0.height as usize, frame.0.width as usize],
                headless.channels(&aovs, frame)?,
            ))
        })?;
        channels
            .into_iter()
            .map(|channel| owned(py, channel.values, &size))
            .collect()
    }

    /// For each pixel of a rectangle left, top, width, height: the layer, the Gaussian's number in the scene and its alpha.
    fn _pick<'py>(
        &self,
        py: Python<'py>,
        request: Request<'_>,
        rect: [u32; 4],
    ) -> PyResult<[Bound<'py, PyAny>; 3]> {
        let [x, y, width, height] = rect;
        let corner = |at: u32| i32::try_from(at).map_err(|_| invalid("rect is beyond the picture"));
        let rect = Rect2D {
            offset: Offset2D {
                x: corner(x)?,
                y: corner(y)?,
            },
            extent: Extent2D { width, height },
        };
        let picks = self.work(py, &request, |headless, (camera, clip, settings)| {
            headless.pick(camera, clip, settings, rect)
        })?;
        let all = || picks.pixels.iter();
        let layers = all().map(|pick| pick.map_or(-1, |pick| pick.layer as i64));
        let numbers = all().map(|pick| pick.map_or(-1, |pick| i64::from(pick.number)));
        let alphas = all().map(|pick| pick.map_or(0.0, |pick| pick.alpha));
        let size = [height as usize, width as usize];
        Ok([
            owned(py, layers.collect(), &size)?.into_any(),
            owned(py, numbers.collect(), &size)?.into_any(),
            owned::<f32>(py, alphas.collect(), &size)?.into_any(),
        ])
    }

    fn _slice(&self, py: Python<'_>, request: Request<'_>, plane: ClipOf) -> PyResult<Picture> {
        act(py, &request, |frame| {
            let shapes = plane.0.region.resolve(|| frame.of.bounds())?.shapes();
            let plane = shapes.first().and_then(Shape::as_plane);
            let plane = plane.ok_or_else(|| Error::Invalid("section: it has no plane".into()))?;
            let mut state = self.state();
            state.shown = None;
            let slice = Slice::new(&frame.scene, &plane);
            slice.load(&mut state.headless, &frame.settings)?;
            let seen = (&frame.camera, &frame.clip, &frame.settings);
            let mut picture = slice.picture(&mut state.headless, seen, None)?;
            if let Some(background) = frame.settings.background {
                picture.put_before(background);
            }
            Ok(Picture::new(picture, None))
        })
    }

    fn _panorama(&self, py: Python<'_>, request: Request<'_>, width: u32) -> PyResult<Picture> {
        let panorama = Panorama::new((width, width / 2)).map_err(raised)?;
        check_room(panorama.face_pixels(), 64, "pixels").map_err(raised)?;
        self.work(py, &request, |headless, (camera, clip, settings)| {
            let faces = panorama.faces(camera).map(|face| {
                headless.render(&face, clip, settings)?;
                headless.picture()
            });
            let [front, right, back, left, up, down] = faces;
            let faces = [front?, right?, back?, left?, up?, down?];
            Ok(Picture::new(panorama.assembled(&faces), None))
        })
    }

    /// Device memory in use, bytes.
    #[getter]
    fn device_bytes(&self, py: Python<'_>) -> u64 {
        py.detach(|| self.state().headless.device_bytes())
    }

    fn __repr__(&self) -> String {
        format!("<rara.Renderer: {} ({})>", self.device, self.driver)
    }
}

/// The picture of the reference in double precision.
#[pyfunction]
pub(crate) fn truth(py: Python<'_>, request: Request<'_>) -> PyResult<Picture> {
    act(py, &request, |frame| {
        frame.scene.check()?;
        let seen = (&frame.camera, &frame.clip, &frame.settings);
        let truth = rara_reference::render::<f64>(&frame.scene, seen.0, seen.1, seen.2);
        Ok(Picture::new(truth.picture, None))
    })
}

/// Lists the Vulkan devices: name, driver, and the reason for which rara cannot use one, or None.
#[pyfunction]
pub(crate) fn devices(py: Python<'_>) -> PyResult<Vec<(String, String, Option<String>)>> {
    let list = py.detach(list_devices).map_err(raised)?.into_iter();
    let row = |device: rara::gpu::DeviceInfo| (device.name, device.driver, device.support.err());
    Ok(list.map(row).collect())
}
