//! The attachments of a host that graphics pipelines draw into, in a dynamic rendering scope or a classic render pass.

use ash::vk;

/// The attachments of a rendering scope, as pipelines must know them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Attachments {
    /// Format of the only colour attachment.
    pub color: vk::Format,
    /// The depth attachment, where there is one.
    pub depth: Option<DepthAttachment>,
    /// Samples a pixel of all of them.
    pub samples: vk::SampleCountFlags,
    /// The scope they are attached to.
    pub target: Target,
}

/// A depth attachment.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct DepthAttachment {
    /// Its format, with or without stencil.
    pub format: vk::Format,
    /// True when the same image is the scope's stencil attachment too; unused with a render pass.
    pub stencil: bool,
    /// True when nearer is more.
    pub reversed: bool,
}

/// The kind of scope that a host draws in: [`Target::DYNAMIC`] or a [`render_pass`](Self::render_pass).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Target(pub(super) Option<(vk::RenderPass, u32)>);

impl Target {
    /// `vkCmdBeginRendering`: dynamic rendering.
    pub const DYNAMIC: Self = Self(None);

    /// A subpass of a classic render pass, or of any that is compatible with it.
    ///
    /// # Safety
    /// The render pass is of the device that pipelines are made on, has this subpass, and lives as long as pipelines are
    /// made for it: for a renderer, until its last `configure`.
    pub const unsafe fn render_pass(render_pass: vk::RenderPass, subpass: u32) -> Self {
        Self(Some((render_pass, subpass)))
    }
}

impl Attachments {
    /// One colour attachment of one sample in a dynamic rendering scope.
    pub const fn color(format: vk::Format) -> Self {
        Self {
            color: format,
            depth: None,
            samples: vk::SampleCountFlags::TYPE_1,
            target: Target::DYNAMIC,
        }
    }
}
