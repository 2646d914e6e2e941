//! The description from which a renderer is created, and how a device has to support it.

use ash::vk;

use rara_base::error::{Error, Result};
use rara_base::setters;
use rara_gpu::{Attachments, Bindings, DepthAttachment, Device, Draws, Target};
use rara_scene::depth::DepthMap;

/// The encoding of the colours in a host's colour attachment. Splats are trained, and blended, in sRGB-encoded colours; the
/// result is converted to the encoding of the host.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[non_exhaustive]
pub enum ColorSpace {
    /// The attachment has sRGB-encoded colours. Splats are blended over its pixels without a conversion.
    #[default]
    Stored,
    /// The attachment has linear light, as in a host that lights in HDR and encodes its picture afterwards. Splats are blended
    /// as stored; the resulting picture is converted to linear light once and blended `over` the host's pixels. Only tiles do
    /// so: another [`Raster`](crate::Raster) is refused, and so is a depth that is not [readable](DepthDesc::readable).
    /// [`Show::Count`](crate::Show::Count), [`Show::Mean`](crate::Show::Mean) and [`Show::Strongest`](crate::Show::Strongest),
    /// which are numbers, stay as they are.
    Linear,
}

setters! {
    /// The description from which a renderer is created: [`RendererDesc::new`] is the usual one, and a host sets what it wants
    /// otherwise.
    #[derive(Debug, Clone, Copy)]
    #[non_exhaustive]
    pub struct RendererDesc {
        /// Format of the colour attachment that [`Renderer::draw`](super::Renderer::draw) draws into. It must be blendable;
        /// splats are trained to be blended as stored, so sRGB formats, which blend in linear light, are for
        /// [`ColorSpace::Linear`].
        pub color_format: vk::Format,
        /// The meaning of the attachment's numbers.
        pub color_space: ColorSpace,
        /// The depth attachment of the host's scope, which splats are tested against; `None` if it has none.
        pub depth: Option<DepthDesc>,
        /// The target of [`Renderer::draw_depth`](super::Renderer::draw_depth); `None` where that is not called, and then
        /// costs nothing.
        pub expected_depth: Option<ExpectedDepthDesc>,
        /// The target of [`Renderer::draw_motion`](super::Renderer::draw_motion); `None` where that is not called, and then
        /// costs nothing.
        pub motion: Option<MotionDesc>,
        /// Samples a pixel of the attachments. A splat's colour is computed once a pixel, its depth is tested for each sample.
        pub samples: vk::SampleCountFlags,
        /// Dynamic rendering, or a classic render pass.
        pub target: Target,
        /// The way to reach buffers: by address or bound, where the validation layer can watch them, or some of either;
        /// [`Bindings::suiting`] says which is faster on a device. A device that lacks what this way needs uses another, and
        /// with [`Bindings::Bound`] so does a frame whose buffers exceed the device's binding size. Without addresses such a
        /// frame is refused.
        pub bindings: Bindings,
        /// True to take timestamps around the stages.
        pub timing: bool,
        /// True to count also what the stages do, where the device was opened for it; only with `timing`.
        pub statistics: bool,
        /// True to let a frame take over results of the one before that it would compute again to the same bytes. The host
        /// then submits every frame that it prepares, in order, or calls [`Renderer::forget`](super::Renderer::forget).
        pub reuse: bool,
        /// How many recorded frames may be unfinished at once, from 1 to [`MAX_FRAMES`](Self::MAX_FRAMES);
        /// [`Renderer`](super::Renderer) says what the host promises.
        pub frames_in_flight: u32,
        /// The queue family of the command buffers that [`Renderer::prepare`](super::Renderer::prepare) records into, where they
        /// are submitted to another queue than the draws, as one without graphics: one of
        /// [`AdoptDesc::shared_families`](crate::gpu::AdoptDesc::shared_families), or the device's own. The host then orders
        /// the two by semaphores, as [`Renderer`](super::Renderer) says. `None` where both are submitted to the device's queue.
        pub compute_family: Option<u32>,
    }
}

/// The host's depth attachment. Splats behind its depths are hidden. A splat is hidden in all of its pixels by one depth, that of
/// its centre, by which splats are ordered, unless `soft` is set. Opaque things are drawn first, then splats.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct DepthDesc {
    /// The format of the attachment, with or without stencil.
    pub format: vk::Format,
    /// True when a dynamic rendering scope has the same image as stencil attachment too.
    pub stencil: bool,
    /// The buffer's value for a depth, on ordinary or reversed depth;
    /// [`Renderer::set_depth_map`](super::Renderer::set_depth_map) changes it from frame to frame.
    pub map: DepthMap,
    /// True when the host gives each frame's depth to [`Renderer::prepare`](super::Renderer::prepare),
    /// before its scope: an image of one sample, into which a host of several resolves its depth. Tiles need that; without it
    /// they are replaced by quads, whose samples are tested each.
    pub readable: bool,
    /// An alpha above 0 and at most 1 from which a pixel's depth is written, so that what the host draws later meets the splats
    /// and the cut through them; `None` where no depth is. Draws write the depth of the splat with which the pixel's alpha
    /// reaches so much, front to back: the mean, on the pixel's line of sight, of what the clip leaves of it, as in
    /// [`draw_depth`](super::Renderer::draw_depth). Pixels that stay below keep the host's depth, as do those whose depth is
    /// nearer. It needs `readable` and tiles. In the host's scope the attachment can be written.
    pub write_alpha: Option<f32>,
    /// True to hide of each splat what lies behind the host's depth, on each pixel's line of sight, as a clip there would cut it:
    /// splats that half-covering meshes go through end smoothly. Else a splat is hidden whole, by the depth of its centre. It
    /// needs `readable` and tiles.
    pub soft: bool,
    /// True when [`Renderer::prepare`](super::Renderer::prepare) is given a view of the depth to sample
    /// ([`DepthImage::view`](crate::gpu::DepthImage::view)) in place of an image to copy, for hosts whose depth is no source of
    /// transfers. It needs `readable` and `VK_KHR_push_descriptor`.
    pub sampled: bool,
}

setters!(DepthDesc {
    stencil: bool,
    readable: bool,
    write_alpha: Option<f32>,
    soft: bool,
    sampled: bool,
});

/// The target of expected depths.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct ExpectedDepthDesc {
    /// Format of the scope's only colour attachment: blendable, of two floats or more, best of 32 bits.
    pub format: vk::Format,
    /// Dynamic rendering, or a classic render pass of its own.
    pub target: Target,
}

setters!(ExpectedDepthDesc { target: Target });

impl ExpectedDepthDesc {
    /// A target in dynamic rendering.
    pub const fn new(format: vk::Format) -> Self {
        Self {
            format,
            target: Target::DYNAMIC,
        }
    }
}

/// The target of motion.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct MotionDesc {
    /// Format of the scope's only colour attachment: blendable, of two floats or more; the third is for the layer's number, which
    /// 16 bits hold exactly up to 2048.
    pub format: vk::Format,
    /// The alpha, from 0 to 1, from which a pixel of splats gets their motion; others keep what the host has drawn.
    pub least_alpha: f32,
    /// Dynamic rendering, or a classic render pass of its own.
    pub target: Target,
}

setters!(MotionDesc {
    least_alpha: f32,
    target: Target,
});

impl MotionDesc {
    /// A target in dynamic rendering, of pixels that splats cover by half or more.
    pub const fn new(format: vk::Format) -> Self {
        Self {
            format,
            least_alpha: 0.5,
            target: Target::DYNAMIC,
        }
    }
}

impl DepthDesc {
    /// An attachment without stencil, and not readable.
    pub const fn new(format: vk::Format, map: DepthMap) -> Self {
        Self {
            format,
            stencil: false,
            map,
            readable: false,
            write_alpha: None,
            soft: false,
            sampled: false,
        }
    }
}

impl RendererDesc {
    /// The most [`frames_in_flight`](Self::frames_in_flight).
    pub const MAX_FRAMES: u32 = 16;

    /// One colour attachment of one sample in dynamic rendering; buffers by address, no timestamps, nothing reused, one
    /// frame in flight.
    pub const fn new(color_format: vk::Format) -> Self {
        Self {
            color_format,
            color_space: ColorSpace::Stored,
            depth: None,
            expected_depth: None,
            motion: None,
            samples: vk::SampleCountFlags::TYPE_1,
            target: Target::DYNAMIC,
            bindings: Bindings::Address,
            timing: false,
            statistics: false,
            reuse: false,
            frames_in_flight: 1,
            compute_family: None,
        }
    }

    /// The attachments that pipelines draw into.
    pub(super) fn attachments(&self) -> Attachments {
        Attachments {
            color: self.color_format,
            depth: self.depth.map(|depth| DepthAttachment {
                format: depth.format,
                stencil: depth.stencil,
                reversed: depth.map.is_reversed(),
            }),
            samples: self.samples,
            target: self.target,
        }
    }

    /// The attachments that the pipeline of expected depths draws into.
    pub(super) fn expected_depth_attachments(&self) -> Option<Attachments> {
        self.expected_depth
            .map(|expected| self.in_place_of_colours(expected.format, expected.target))
    }

    /// The attachments that the pipeline of motion draws into.
    pub(super) fn motion_attachments(&self) -> Option<Attachments> {
        self.motion
            .map(|motion| self.in_place_of_colours(motion.format, motion.target))
    }

    fn in_place_of_colours(&self, color: vk::Format, target: Target) -> Attachments {
        Attachments {
            color,
            target,
            ..self.attachments()
        }
    }

    /// Checks that there can be such attachments, and that a device can draw into them; the error says what it cannot.
    pub(super) fn check(&self, device: &Device) -> Result<()> {
        if !(1..=Self::MAX_FRAMES).contains(&self.frames_in_flight) {
            return Err(Error::Invalid(format!(
                "RendererDesc::frames_in_flight is {}; it must be from 1 to {}",
                self.frames_in_flight,
                Self::MAX_FRAMES
            )));
        }
        self.check_family(device)?;
        self.check_color(device, self.color_format)?;
        if self.blends_stored_as_light() {
            log::warn!(
                "RendererDesc::color_format is {:?}, in which devices blend in linear light, and RendererDesc::color_space is ColorSpace::Stored: \
                 colours come out wrong; draw into a UNORM view of the image, or set ColorSpace::Linear",
                self.color_format
            );
        }
        if self.color_space == ColorSpace::Linear && self.hides_from_tiles() {
            log::warn!(
                "RendererDesc::color_space is Linear and DepthDesc::readable is not set: only tiles convert colours, and they need \
                 the host's depth before its scope, so that only scenes of linear light will be drawn"
            );
        }
        let targets = [
            Some(self.target),
            self.expected_depth.map(|expected| expected.target),
            self.motion.map(|motion| motion.target),
        ];
        for target in targets.into_iter().flatten() {
            self.check_view(target)?;
        }
        if let Some(expected) = self.expected_depth {
            let what = "ExpectedDepthDesc::format";
            self.check_floats(device, expected.format, what)?;
        }
        if let Some(MotionDesc {
            format,
            least_alpha,
            ..
        }) = self.motion
        {
            self.check_floats(device, format, "MotionDesc::format")?;
            if !(0.0..=1.0).contains(&least_alpha) {
                return Err(Error::Invalid(format!(
                    "MotionDesc::least_alpha is {least_alpha}; it must be from 0 to 1"
                )));
            }
            if self.hides_from_tiles() {
                return Err(Error::Invalid(
                    "RendererDesc::motion is set and DepthDesc::readable is not: tiles find the motion, and need the \
                     host's depth before its scope"
                        .into(),
                ));
            }
        }
        self.depth
            .map_or(Ok(()), |depth| self.check_depth(device, depth))
    }

    /// Checks that the view that is drawn into is one of its scope's, and that tiles draw into it.
    fn check_view(&self, target: Target) -> Result<()> {
        if !target.has_its_view() {
            return Err(Error::Invalid(
                "a target of RendererDesc is in a view that its view mask lacks".into(),
            ));
        }
        match target.view() {
            Some(_) if self.hides_from_tiles() => Err(Error::Invalid(
                "a target of RendererDesc has a view mask and DepthDesc::readable is not set: tiles draw into one view of \
                 several, and need the host's depth before its scope"
                    .into(),
            )),
            _ => Ok(()),
        }
    }

    /// The draws that the barriers of compute commands are between.
    pub(super) fn draws(&self) -> Draws {
        self.compute_family
            .map_or(Draws::Around, |_| Draws::Elsewhere)
    }

    /// Checks that the commands of a frame can be recorded for the family that is asked for.
    fn check_family(&self, device: &Device) -> Result<()> {
        let Some(family) = self.compute_family else {
            return Ok(());
        };
        let refuse = |what: &str| {
            Err(Error::Invalid(format!(
                "RendererDesc::compute_family is {family}, {what}"
            )))
        };
        match device.queue_flags(family) {
            None => refuse(
                "which rara's memory is not shared with: name it in AdoptDesc::shared_families",
            ),
            Some(flags) if !flags.contains(vk::QueueFlags::COMPUTE) => {
                refuse("which lacks compute")
            }
            Some(flags) if flags.contains(vk::QueueFlags::GRAPHICS) => Ok(()),
            Some(_)
                if self
                    .depth
                    .is_some_and(|depth| depth.readable && !depth.sampled) =>
            {
                refuse(
                    "which lacks graphics, and DepthDesc::readable is set: Vulkan copies depths only in a family with graphics; \
                 set DepthDesc::sampled, and give a view",
                )
            }
            Some(_) if self.statistics => refuse(
                "which lacks graphics, and RendererDesc::statistics is set, which counts what draws do too",
            ),
            Some(_) => Ok(()),
        }
    }

    /// True when splats are tested against a depth that tiles cannot read.
    pub(super) fn hides_from_tiles(&self) -> bool {
        self.depth.is_some_and(|depth| !depth.readable)
    }

    /// True when the device would take colours as they are stored for linear light.
    fn blends_stored_as_light(&self) -> bool {
        self.color_space == ColorSpace::Stored && SRGB.contains(&self.color_format)
    }

    fn check_depth(&self, device: &Device, depth: DepthDesc) -> Result<()> {
        let format = depth.format;
        let Some((_, stencil)) = DEPTHS.iter().find(|(known, _)| *known == format) else {
            return Err(Error::Invalid(format!(
                "DepthDesc::format is {format:?}, which has no depth"
            )));
        };
        if depth.stencil && !stencil {
            return Err(Error::Invalid(format!(
                "DepthDesc::stencil is set and {format:?} has none"
            )));
        }
        if let Some(alpha) = depth
            .write_alpha
            .filter(|alpha| !(*alpha > 0.0 && *alpha <= 1.0))
        {
            return Err(Error::Invalid(format!(
                "DepthDesc::write_alpha is {alpha}; it must be above 0 and at most 1"
            )));
        }
        let of_tiles = [
            (
                "write_alpha",
                "find the depths",
                depth.write_alpha.is_some(),
            ),
            ("soft", "hide parts of splats", depth.soft),
            ("sampled", "sample depths", depth.sampled),
        ];
        if let Some((field, act, _)) = of_tiles.iter().find(|(.., set)| *set && !depth.readable) {
            return Err(Error::Invalid(format!(
                "DepthDesc::{field} is set without DepthDesc::readable: tiles {act}, and need the host's own before its scope"
            )));
        }
        let name = &device.info().name;
        if depth.sampled && !device.support().push_descriptor {
            return Err(Error::Device(format!(
                "{name} cannot sample a host's depth (DepthDesc::sampled): it lacks VK_KHR_push_descriptor or was made without; \
                 give the image, to be copied"
            )));
        }
        let as_depth = vk::FormatFeatureFlags::DEPTH_STENCIL_ATTACHMENT;
        if !device.format_features(format).contains(as_depth) {
            return Err(Error::Device(format!(
                "{name} cannot test depths in {format:?}; every device can in D16_UNORM and in D32_SFLOAT or X8_D24_UNORM_PACK32"
            )));
        }
        let usage = vk::ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT;
        if !device.sample_counts(format, usage).contains(self.samples) {
            return Err(Error::Device(format!(
                "{name} cannot test depths in {format:?} with samples {:?}",
                self.samples
            )));
        }
        Ok(())
    }

    /// Checks the format of a target that holds no colours.
    fn check_floats(&self, device: &Device, format: vk::Format, what: &str) -> Result<()> {
        match FLOATS.contains(&format) {
            true => self.check_color(device, format),
            false => Err(Error::Invalid(format!(
                "{what} is {format:?}: two floats or more are needed, as of R32G32_SFLOAT"
            ))),
        }
    }

    fn check_color(&self, device: &Device, color: vk::Format) -> Result<()> {
        let name = &device.info().name;
        let refuse = |what: String| Err(Error::Device(format!("{name} cannot {what}")));
        let blending = vk::FormatFeatureFlags::COLOR_ATTACHMENT
            | vk::FormatFeatureFlags::COLOR_ATTACHMENT_BLEND;
        if !device.format_features(color).contains(blending) {
            return refuse(format!(
                "blend into {color:?}; every device can into R8G8B8A8_UNORM and R16G16B16A16_SFLOAT"
            ));
        }
        let usage = vk::ImageUsageFlags::COLOR_ATTACHMENT;
        let samples = self.samples;
        if samples.as_raw().count_ones() != 1
            || !device.sample_counts(color, usage).contains(samples)
        {
            return refuse(format!(
                "draw into {color:?} with samples {samples:?}; draw splats into an image of one sample after the host's own is resolved"
            ));
        }
        Ok(())
    }
}

/// Formats with a depth, and whether they have a stencil too.
const DEPTHS: [(vk::Format, bool); 6] = [
    (vk::Format::D16_UNORM, false),
    (vk::Format::X8_D24_UNORM_PACK32, false),
    (vk::Format::D32_SFLOAT, false),
    (vk::Format::D16_UNORM_S8_UINT, true),
    (vk::Format::D24_UNORM_S8_UINT, true),
    (vk::Format::D32_SFLOAT_S8_UINT, true),
];

/// Formats that devices decode before they blend, and encode afterwards.
const SRGB: [vk::Format; 5] = [
    vk::Format::R8G8B8_SRGB,
    vk::Format::B8G8R8_SRGB,
    vk::Format::R8G8B8A8_SRGB,
    vk::Format::B8G8R8A8_SRGB,
    vk::Format::A8B8G8R8_SRGB_PACK32,
];

/// Formats of two floats or more.
const FLOATS: [vk::Format; 6] = [
    vk::Format::R16G16_SFLOAT,
    vk::Format::R16G16B16_SFLOAT,
    vk::Format::R16G16B16A16_SFLOAT,
    vk::Format::R32G32_SFLOAT,
    vk::Format::R32G32B32_SFLOAT,
    vk::Format::R32G32B32A32_SFLOAT,
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stored_colours_in_a_view_that_blends_in_linear_light_are_noticed() {
        let desc = RendererDesc::new;
        assert!(desc(vk::Format::B8G8R8A8_SRGB).blends_stored_as_light());
        assert!(!desc(vk::Format::B8G8R8A8_UNORM).blends_stored_as_light());
        let linear = desc(vk::Format::B8G8R8A8_SRGB).color_space(ColorSpace::Linear);
        assert!(!linear.blends_stored_as_light());
    }
}
