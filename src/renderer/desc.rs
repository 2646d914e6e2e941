//! What a renderer is created with, and what of it a device has to support.

use ash::vk;

use crate::depth::DepthMap;
use crate::error::{Error, Result};
use crate::gpu::{Attachments, Bindings, DepthAttachment, Device, Target};

/// What a renderer is created with: [`RendererDesc::new`] for the usual, fields changed where a host wants otherwise.
#[derive(Debug, Clone, Copy)]
pub struct RendererDesc {
    /// Format of the colour attachment that [`Renderer::draw`](super::Renderer::draw) draws into. It must be blendable;
    /// splats are trained to be blended as stored, so sRGB formats, which blend in linear light, give another picture.
    pub color_format: vk::Format,
    /// The depth attachment of the host's scope, which splats are tested against; `None` if it has none.
    pub depth: Option<DepthDesc>,
    /// The target of [`Renderer::draw_depth`](super::Renderer::draw_depth); `None` where that is not called, and then
    /// costs nothing.
    pub expected_depth: Option<ExpectedDepthDesc>,
    /// Samples a pixel of the attachments. A splat's colour is computed once a pixel, its depth is tested for each sample.
    pub samples: vk::SampleCountFlags,
    /// Dynamic rendering, or a classic render pass.
    pub target: Target,
    /// Whether buffers are reached by address (fast) or bound (the validation layer can watch them). With
    /// [`Bindings::Bound`] a frame whose buffers exceed the device's binding size still uses addresses.
    pub bindings: Bindings,
    /// Whether to take timestamps around the stages.
    pub timing: bool,
    /// Whether to count what the stages do, too, where the device was opened for it; only with `timing`.
    pub statistics: bool,
    /// Whether a frame takes over what the one before has computed and this one would compute again, to the same bytes.
    /// The host then submits every frame that it prepares, in order, or calls
    /// [`Renderer::forget`](super::Renderer::forget).
    pub reuse: bool,
    /// How many recorded frames may be unfinished at once, 1 or more; [`Renderer`](super::Renderer) says what the host
    /// promises.
    pub frames_in_flight: u32,
}

/// The host's depth attachment. Splats behind what it holds are hidden, none is written into it. A splat is at one depth,
/// that of its centre, in all of its pixels: the depth by which splats are ordered. Opaque things go first, then splats.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DepthDesc {
    /// Its format, with or without stencil.
    pub format: vk::Format,
    /// Whether a dynamic rendering scope has the same image as stencil attachment too.
    pub stencil: bool,
    /// What it holds for a depth, on ordinary or reversed depth;
    /// [`Renderer::set_depth_map`](super::Renderer::set_depth_map) changes it from frame to frame.
    pub map: DepthMap,
    /// Whether the host shows each frame's depth to
    /// [`Renderer::prepare_behind`](super::Renderer::prepare_behind), before its scope. Tiles need that; without it
    /// they are replaced by quads.
    pub readable: bool,
}

/// Where expected depths are drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ExpectedDepthDesc {
    /// Format of the scope's only colour attachment, of two channels or more: blendable, and best of 32-bit floats.
    pub format: vk::Format,
    /// Dynamic rendering, or a classic render pass of its own.
    pub target: Target,
}

impl ExpectedDepthDesc {
    /// In dynamic rendering.
    pub const fn new(format: vk::Format) -> Self {
        Self {
            format,
            target: Target::DYNAMIC,
        }
    }
}

impl DepthDesc {
    /// Without stencil, and not readable.
    pub const fn new(format: vk::Format, map: DepthMap) -> Self {
        Self {
            format,
            stencil: false,
            map,
            readable: false,
        }
    }
}

impl RendererDesc {
    /// One colour attachment of one sample in dynamic rendering; buffers by address, no timestamps, nothing reused, one
    /// frame in flight.
    pub const fn new(color_format: vk::Format) -> Self {
        Self {
            color_format,
            depth: None,
            expected_depth: None,
            samples: vk::SampleCountFlags::TYPE_1,
            target: Target::DYNAMIC,
            bindings: Bindings::Address,
            timing: false,
            statistics: false,
            reuse: false,
            frames_in_flight: 1,
        }
    }

    /// What pipelines draw into.
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

    /// What the pipeline of expected depths draws into.
    pub(super) fn expected_depth(&self) -> Option<Attachments> {
        self.expected_depth.map(|expected| Attachments {
            color: expected.format,
            target: expected.target,
            ..self.attachments()
        })
    }

    /// Whether a device can draw into such attachments; the error says what it cannot.
    pub(super) fn check(&self, device: &Device) -> Result<()> {
        self.check_color(device, self.color_format)?;
        if let Some(expected) = self.expected_depth {
            self.check_color(device, expected.format)?;
        }
        let as_depth = vk::FormatFeatureFlags::DEPTH_STENCIL_ATTACHMENT;
        if let Some(depth) = self.depth {
            let format = depth.format;
            if !device.format_features(format).contains(as_depth) {
                return Err(Error::Device(format!(
                    "{} cannot test depths in {format:?}; every device can in D16_UNORM and in D32_SFLOAT or X8_D24_UNORM_PACK32",
                    device.info().name
                )));
            }
        }
        Ok(())
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
