//! What a frame's pixels are made of, as numbers in the host's memory.

use rara::{Aov, Headless, Result};

use crate::boundary::{RaraResult, Versioned, guard, invalid, read, versioned, write};
use crate::camera::{self, RaraCamera};
use crate::clip::{self, RaraClip};
use crate::handles::alive;
use crate::renderer::RaraRenderer;
use crate::scene::RaraSceneBuffers;
use crate::settings::{self, RaraSettings};

/// Quantities that a pixel can have beside its colour (arbitrary output variables), one bit each. Means are over the pixel's
/// splats, by what each adds to alpha.
pub type RaraAovs = u32;
/// The mean depth of what the clip leaves, along the view axis, in world units; 0 in an empty pixel.
pub const RARA_AOV_DEPTH: RaraAovs = 1;
/// Three channels, x, y and z: the mean of the splats' thinnest axes, turned towards the eye, as a unit vector in world
/// coordinates; 0 in an empty pixel. On a cut surface too, these are the axes of the splats, not the normal of the surface.
pub const RARA_AOV_NORMAL: RaraAovs = 2;
/// The number, from 0, of the layer whose splats add most to alpha; -1 in an empty pixel.
pub const RARA_AOV_LAYER: RaraAovs = 4;
/// The mean share of the splats that the clip keeps, 1 if it cuts none of them; 0 in an empty pixel.
pub const RARA_AOV_WEIGHT: RaraAovs = 8;
/// The number of splats in the pixel, front to back, until the pixel is opaque.
pub const RARA_AOV_COUNT: RaraAovs = 16;

/// All quantities in the order of their bits, and how many channels each has.
const ALL: [(RaraAovs, Aov, usize); 5] = [
    (RARA_AOV_DEPTH, Aov::Depth, 1),
    (RARA_AOV_NORMAL, Aov::Normal, 3),
    (RARA_AOV_LAYER, Aov::Layer, 1),
    (RARA_AOV_WEIGHT, Aov::Weight, 1),
    (RARA_AOV_COUNT, Aov::Count, 1),
];

/// Room for channels of numbers, which rara_renderer_channels fills.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct RaraChannels {
    /// Set by rara_channels_default.
    pub struct_size: usize,
    /// The quantities: one bit or more.
    pub aovs: RaraAovs,
    /// The camera's picture width, pixels.
    pub width: u32,
    /// The camera's picture height, pixels.
    pub height: u32,
    /// Where the numbers are written: one channel after the other, in the order of the bits, each row by row from the top left.
    pub values: *mut f32,
    /// The number of values that `values` has room for: width times height for each channel. RARA_AOV_NORMAL has three channels,
    /// all others have one. Set by rara_channels_default.
    pub value_count: usize,
}

versioned!(RaraChannels);

impl RaraChannels {
    /// Checks the quantities, and returns them with how many numbers they have.
    fn wanted(&self) -> Result<(Vec<Aov>, usize)> {
        let known = ALL.iter().fold(0, |bits, (bit, ..)| bits | bit);
        if self.aovs == 0 || self.aovs & !known != 0 {
            return invalid(format!(
                "channels->aovs is {:#x}: give one or more of the bits of RaraAovs, {known:#x} for all",
                self.aovs
            ));
        }
        let wanted = ALL.iter().filter(|(bit, ..)| self.aovs & bit != 0);
        let (aovs, counts): (Vec<Aov>, Vec<usize>) =
            wanted.map(|&(_, aov, channels)| (aov, channels)).unzip();
        let sides = [self.width, self.height].map(|side| side as usize);
        let count = sides
            .iter()
            .try_fold(counts.iter().sum(), |count: usize, &side| {
                count.checked_mul(side)
            });
        match count.filter(|count| *count <= isize::MAX as usize / size_of::<f32>()) {
            Some(count) => Ok((aovs, count)),
            None => invalid(format!(
                "channels of {}x{} pixels are more than memory holds",
                self.width, self.height
            )),
        }
    }
}

/// Channels of these quantities, of pictures of `width` x `height` pixels; the host gives `values`, with room for
/// `value_count` numbers. `channels_size` is sizeof *channels.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_channels_default(
    channels: *mut RaraChannels,
    channels_size: usize,
    aovs: RaraAovs,
    width: u32,
    height: u32,
) -> RaraResult {
    guard(|| {
        let mut default = RaraChannels {
            aovs,
            width,
            height,
            ..Versioned::BLANK
        };
        let wanted = default.wanted();
        default.value_count = wanted.as_ref().map_or(0, |(_, count)| *count);
        // A struct that is null or of no version is named before anything else.
        write(channels, channels_size, &default, "channels")?;
        wanted.map(|_| ())
    })
}

/// Draws what a frame's pixels are made of, and waits for it: depths, normals, layers, weights and counts, as the program's
/// `--aov` does. It is for editors and measurements, not for each frame: every quantity takes a frame or more of its own. All of
/// its memory is freed again.
///
/// The renderer lends its device, its compiled pipelines and its placement; its frames, attachments and depths have no say,
/// and stay as they are. What `settings` show is ignored.
///
/// RARA_ERROR_INVALID where the sizes of `channels` are not the camera's, or too few or too many; after an error `values` are as
/// they were.
///
/// # Safety
/// `renderer` is alive, and no other thread changes it; nobody else uses the queue meanwhile; the other pointers are as for
/// rara_renderer_configure; `channels` is as its fields say, and nobody else uses its values.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_renderer_channels(
    renderer: *const RaraRenderer,
    scene: *const RaraSceneBuffers,
    camera: *const RaraCamera,
    clip: *const RaraClip,
    settings: *const RaraSettings,
    channels: *const RaraChannels,
) -> RaraResult {
    guard(|| {
        let renderer = alive(renderer, "renderer")?;
        let room = read(channels, Versioned::BLANK, "channels")?;
        let (aovs, count) = room.wanted()?;
        let camera = camera::camera(camera)?;
        if (room.width, room.height) != (camera.width, camera.height) {
            return invalid(format!(
                "channels->width and height are {}x{}, and the camera's {}x{}: give those",
                room.width, room.height, camera.width, camera.height
            ));
        }
        if room.value_count != count {
            return invalid(format!(
                "channels->value_count is {}, and such channels have {count} numbers: give room for just those",
                room.value_count
            ));
        }
        if room.values.is_null() {
            return invalid("channels->values is null");
        }
        let clip = clip::clip(clip, "clip")?.unwrap_or_default();
        let settings = settings::settings(settings)?;
        let scene = alive(scene, "scene")?;
        let mut headless = Headless::beside(&renderer.0)?;
        headless.show(scene.buffers.clone())?;
        let made = headless.channels(&aovs, (&camera, &clip, &settings))?;
        let made: Vec<f32> = made.into_iter().flat_map(|made| made.values).collect();
        if made.len() != count {
            return invalid("the channels have another size than the camera's picture");
        }
        // Bytes are copied, so that nothing has to be aligned.
        let bytes = count * size_of::<f32>();
        std::ptr::copy_nonoverlapping(made.as_ptr().cast::<u8>(), room.values.cast(), bytes);
        Ok(())
    })
}
