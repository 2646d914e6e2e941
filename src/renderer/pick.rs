//! Picking: the Gaussians that a part of a picture shows most of, found on the device and read when the frame is finished.

use std::collections::HashMap;

use ash::vk;

use super::Renderer;
use super::desc::{ColorSpace, RendererDesc};
use super::request::{FrameRequest, Kept};
use crate::passes::{SceneBuffers, TilePicture};
use rara_base::error::{Error, Result};
use rara_base::limits;
use rara_gpu::{Buffer, BufferDesc, Device, Location, Recorder, Target};
use rara_scene::camera::Camera;
use rara_scene::placement::Placement;
use rara_scene::precision::TargetFormat;
use rara_scene::settings::{Raster, Settings, Show};

/// A picker finds the Gaussians that add most to pixels, for a host that selects by a click or a rectangle.
///
/// [`record`](Self::record) draws the part of the picture that is asked about into memory of the picker's own, with the stages
/// of a frame: it takes the clip, layers and weights into account, and what lies outside the part is culled. Nothing of the
/// host's targets, of a [`Renderer`] or of the scene changes, and nothing waits. [`read`](Self::read) gives the answer once the
/// submission has finished. The host's depth is not looked at: splats are picked through what hides them.
///
/// ```no_run
/// # use rara::{Camera, Clip, Picker, Renderer, Result, SceneBuffers, Settings, ash::vk};
/// # fn clicked(renderer: &Renderer, scene: &SceneBuffers, camera: &Camera, clip: &Clip, cmd: vk::CommandBuffer) -> Result<()> {
/// let mut picker = Picker::new(renderer, 2)?; // kept as long as the renderer
/// let under_the_mouse = vk::Rect2D {
///     offset: vk::Offset2D { x: 320, y: 200 },
///     extent: vk::Extent2D { width: 1, height: 1 },
/// };
/// // SAFETY: `cmd` is recording outside a rendering scope, and is submitted with the frame.
/// let ticket = unsafe { picker.record(cmd, scene, camera, clip, &Settings::default(), under_the_mouse)? };
/// // ... two frames later, whose fence has been waited for:
/// // SAFETY: the submission has finished.
/// let picks = unsafe { picker.read(ticket)? };
/// if let Some(pick) = picks.strongest() {
///     println!("Gaussian {} of layer {}", pick.number, pick.layer);
/// }
/// # Ok(())
/// # }
/// ```
#[derive(Debug)]
pub struct Picker {
    renderer: Renderer,
    slots: Box<[Slot]>,
    recorded: u64,
}

/// A request that a [`Picker`] has recorded.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PickTicket {
    picker: u64,
    request: u64,
}

impl PickTicket {
    /// The picker's number and the request's, for a host that keeps numbers.
    pub const fn numbers(self) -> [u64; 2] {
        [self.picker, self.request]
    }

    /// The ticket of such numbers.
    pub const fn of_numbers([picker, request]: [u64; 2]) -> Self {
        Self { picker, request }
    }
}

/// The splat that adds most to a pixel's alpha.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Pick {
    /// The number of the splat's Gaussian in the scene: its number in its layer plus the room of all layers before
    /// ([`SceneLayer::room`](crate::SceneLayer::room)), which is the number of Gaussians that they were uploaded with where none
    /// was given room for more; or as [`Layer::numbered`](crate::Layer::numbered) says.
    pub number: u32,
    /// The number of its layer, in [`SceneBuffers::layers`].
    pub layer: usize,
    /// The alpha that the splat adds to the pixel, from 1/255 to 1. For several pixels, the sum.
    pub alpha: f32,
}

/// The splats that add most to the pixels of a rectangle.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Picks {
    /// The rectangle that was asked about, px.
    pub rect: vk::Rect2D,
    /// A pick for each pixel of the rectangle, row by row from the upper left; `None` if no splat adds at least 1/255.
    pub pixels: Vec<Option<Pick>>,
}

/// The memory of one request.
#[derive(Debug, Default)]
struct Slot {
    readback: Option<Buffer>,
    /// The rectangle, if the request was recorded; and whether it has any splat to find.
    asked: Option<(vk::Rect2D, bool)>,
}

impl Picker {
    /// A picker beside a renderer, whose compiled pipelines it shares and whose [placement](Renderer::set_placement) it takes.
    /// So many requests, from 1 to [`RendererDesc::MAX_FRAMES`], may be unfinished at once.
    ///
    /// # Errors
    /// As for [`Renderer::sharing`].
    pub fn new(renderer: &Renderer, in_flight: u32) -> Result<Self> {
        let renderer = renderer.alike(RendererDesc {
            // Nothing is drawn into a target, least of all into a render pass of the host's.
            target: Target::DYNAMIC,
            color_space: ColorSpace::Stored,
            depth: None,
            expected_depth: None,
            samples: vk::SampleCountFlags::TYPE_1,
            timing: false,
            statistics: false,
            reuse: false,
            frames_in_flight: in_flight,
            ..renderer.desc
        })?;
        Ok(Self {
            renderer,
            slots: (0..in_flight).map(|_| Slot::default()).collect(),
            recorded: 0,
        })
    }

    /// Places the scene in the world, as [`Renderer::set_placement`] does for what is drawn.
    pub fn set_placement(&mut self, placement: Placement) {
        self.renderer.set_placement(placement);
    }

    /// Records the question what the pixels of `rect` show most of, in the picture of `camera`. Of the settings, those count
    /// that say how splats are cut and projected. This allocates where it asks for more than any request before it, and the
    /// first request compiles what no frame needs: make one that nobody waits for.
    ///
    /// # Safety
    /// As for [`Renderer::prepare`], with requests in place of frames: of so many as [`new`](Self::new) was told, the first
    /// one has finished before one more is recorded, and all have before the picker is dropped. A [`Cut`](super::Cut) lives
    /// until the commands have executed.
    ///
    /// # Errors
    /// As for [`Renderer::configure`], and [`Error::Invalid`] for a rectangle that has no pixels or reaches out of the
    /// picture. Nothing is recorded then.
    pub unsafe fn record<'a>(
        &mut self,
        cmd: vk::CommandBuffer,
        scene: &SceneBuffers,
        camera: &Camera,
        kept: impl Into<Kept<'a>>,
        settings: &Settings,
        rect: vk::Rect2D,
    ) -> Result<PickTicket> {
        let part = part_of(camera, rect)?;
        let settings = settings
            .show(Show::Strongest)
            .raster(Raster::Auto)
            .background(None);
        let frame = self.renderer.configure_frame(&FrameRequest {
            picture: Some(TargetFormat::Float),
            whole: Some(camera),
            ..FrameRequest::in_flight(scene, &part, kept.into(), &settings)
        })?;
        let device = self.renderer.device.clone();
        let slot = &mut self.slots[(self.recorded % self.slots.len() as u64) as usize];
        slot.asked = None;
        let readback = slot.room(&device, rect.extent)?;
        let tiles = frame.picture().filter(|_| scene.count > 0);
        // SAFETY: the caller's promises are those asked for.
        unsafe { self.renderer.prepare(cmd, scene, None, frame) }?;
        if let Some(tiles) = &tiles {
            // SAFETY: the caller's promises are those of `prepare`; the tiles' buffers live as the frame's do, and the slot's
            // until its next request or the picker's end, which come after this one has finished.
            let mut recorder =
                unsafe { Recorder::begin(&device, cmd, self.renderer.draws(), None) };
            let [begins, pixels] = TilePicture::sizes(rect.extent, TargetFormat::Float);
            let [to, _] = sizes(rect.extent);
            let copy = |size, to| [vk::BufferCopy::default().size(size).dst_offset(to)];
            recorder.label("pick", |recorder| {
                recorder.copy(&tiles.begins, readback, &copy(begins, 0));
                recorder.copy(&tiles.pixels, readback, &copy(pixels, to));
                recorder.ready_for_host(&[readback]);
            });
        }
        slot.asked = Some((rect, tiles.is_some()));
        self.recorded += 1;
        Ok(PickTicket {
            picker: self.renderer.id,
            request: self.recorded - 1,
        })
    }

    /// The answer to a request.
    ///
    /// # Safety
    /// The submission in which the request was recorded has finished.
    ///
    /// # Errors
    /// [`Error::Invalid`] for another picker's request, and for one whose memory a later one has taken.
    pub unsafe fn read(&self, ticket: PickTicket) -> Result<Picks> {
        let slots = self.slots.len() as u64;
        if ticket.picker != self.renderer.id {
            return Err(Error::Invalid(
                "Picker::read was given another picker's request".into(),
            ));
        }
        let slot = &self.slots[(ticket.request % slots) as usize];
        let later = self.recorded.checked_sub(ticket.request);
        let is_held = later.is_some_and(|later| (1..=slots).contains(&later));
        let (Some((rect, has_splats)), Some(readback), true) =
            (slot.asked, &slot.readback, is_held)
        else {
            return Err(Error::Invalid(format!(
                "Picker::read was given request {}, which was never recorded or whose memory a later one has taken: read each \
                 before {slots} more are recorded",
                ticket.request
            )));
        };
        let pixels = match has_splats {
            true => decoded(rect.extent, readback.mapped()),
            false => vec![None; (rect.extent.width * rect.extent.height) as usize],
        };
        Ok(Picks { rect, pixels })
    }
}

impl Slot {
    /// The buffer in which the host reads the answer about so many pixels.
    fn room(&mut self, device: &Device, extent: vk::Extent2D) -> Result<&Buffer> {
        let size = sizes(extent).iter().sum();
        if self.readback.as_ref().is_none_or(|held| held.size() < size) {
            self.readback = None; // first: both together may not fit
            self.readback = Some(device.create_buffer(&BufferDesc {
                name: "pick_readback",
                size,
                location: Location::Readback,
            })?);
        }
        self.readback
            .as_ref()
            .ok_or_else(|| Error::Memory("there is no memory for picks".into()))
    }
}

impl Picks {
    /// The pick of a pixel of the picture; `None` also outside of the rectangle.
    pub fn at(&self, x: u32, y: u32) -> Option<Pick> {
        let (vk::Offset2D { x: left, y: top }, extent) = (self.rect.offset, self.rect.extent);
        let (x, y) = (
            x.checked_sub(left.try_into().ok()?)?,
            y.checked_sub(top.try_into().ok()?)?,
        );
        let is_inside = x < extent.width && y < extent.height;
        let at = y as usize * extent.width as usize + x as usize;
        self.pixels.get(at).copied().flatten().filter(|_| is_inside)
    }

    /// The Gaussians that some pixel shows most of, each once with the sum of what it adds to these pixels: the one of most
    /// first, and of equal ones that of the lower number.
    pub fn gaussians(&self) -> Vec<Pick> {
        let mut sums: HashMap<u32, Pick> = HashMap::new();
        for pick in self.pixels.iter().flatten() {
            let of_none = Pick {
                alpha: 0.0,
                ..*pick
            };
            sums.entry(pick.number).or_insert(of_none).alpha += pick.alpha;
        }
        let mut all: Vec<Pick> = sums.into_values().collect();
        all.sort_by(|a, b| b.alpha.total_cmp(&a.alpha).then(a.number.cmp(&b.number)));
        all
    }

    /// The first of [`gaussians`](Self::gaussians).
    pub fn strongest(&self) -> Option<Pick> {
        self.gaussians().first().copied()
    }
}

/// The camera of a part of a picture.
fn part_of(camera: &Camera, rect: vk::Rect2D) -> Result<Camera> {
    let vk::Extent2D { width, height } = rect.extent;
    let along = |from: i32, length: u32, whole: u32| {
        let is_inside = i64::from(from) + i64::from(length) <= i64::from(whole);
        from >= 0 && length > 0 && is_inside
    };
    let (x, y) = (rect.offset.x, rect.offset.y);
    if !along(x, width, camera.width) || !along(y, height, camera.height) {
        return Err(Error::Invalid(format!(
            "a pick of {width}x{height} px at {x}, {y} is not inside the picture of {}x{} px",
            camera.width, camera.height
        )));
    }
    Ok(camera
        .width(width)
        .height(height)
        .cx(camera.cx - f64::from(x))
        .cy(camera.cy - f64::from(y)))
}

/// Bytes of what is read back about so many pixels: of the tiles' begins, padded so that pixels begin at a multiple of their
/// own size, and of the pixels.
fn sizes(extent: vk::Extent2D) -> [u64; 2] {
    let [begins, pixels] = TilePicture::sizes(extent, TargetFormat::Float);
    let pixel = TargetFormat::Float.pixel_bytes();
    [begins.next_multiple_of(pixel), pixels]
}

/// The picks of what was read back.
fn decoded(extent: vk::Extent2D, bytes: &[u8]) -> Vec<Option<Pick>> {
    let (begins, pixels) = bytes.split_at(sizes(extent)[0] as usize);
    let [length, _] = TilePicture::sizes(extent, TargetFormat::Float);
    let begins = &begins[..length as usize];
    let pixels = TilePicture::decode(begins, pixels, extent, TargetFormat::Float);
    let pick = |[low, high, layer, alpha]: [f32; 4]| Pick {
        number: low as u32 | (high as u32) << 16,
        layer: layer as usize,
        alpha,
    };
    let shown = |pixel: [f32; 4]| (pixel[3] >= limits::ALPHA_MIN).then(|| pick(pixel));
    pixels.into_iter().map(shown).collect()
}
