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

/// The kind of scope that a host draws in: [`Target::DYNAMIC`] or a [`render_pass`](Self::render_pass), with a view mask or
/// without.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Target {
    /// The pass and its subpass; `None` for dynamic rendering.
    pub(super) pass: Option<(vk::RenderPass, u32)>,
    /// The scope's view mask, 0 for none.
    pub(super) view_mask: u32,
    /// The view that is drawn into, where there is a mask.
    view: u32,
}

impl Target {
    /// `vkCmdBeginRendering`: dynamic rendering.
    pub const DYNAMIC: Self = Self {
        pass: None,
        view_mask: 0,
        view: 0,
    };

    /// A subpass of a classic render pass, or of any that is compatible with it.
    ///
    /// # Safety
    /// The render pass is of the device that pipelines are made on, has this subpass, and lives as long as pipelines are
    /// made for it: for a renderer, until its last `configure`.
    pub const unsafe fn render_pass(render_pass: vk::RenderPass, subpass: u32) -> Self {
        Self {
            pass: Some((render_pass, subpass)),
            ..Self::DYNAMIC
        }
    }

    /// A scope of several views (multiview), whose mask is `VkRenderingInfo::viewMask` or that of the subpass: draws go into one of
    /// its views, as an eye's into its layer of the images, and leave the others alone. The device has the feature `multiview`
    /// enabled. Only tiles draw so.
    pub const fn in_view(self, view_mask: u32, view: u32) -> Self {
        Self {
            view_mask,
            view,
            ..self
        }
    }

    /// The view that is drawn into, where the scope has a mask of views.
    pub const fn view(&self) -> Option<u32> {
        match self.view_mask {
            0 => None,
            _ => Some(self.view),
        }
    }

    /// True unless the view that is drawn into is missing from the mask.
    #[doc(hidden)]
    pub fn has_its_view(&self) -> bool {
        self.view()
            .is_none_or(|view| self.view_mask.checked_shr(view).unwrap_or(0) & 1 != 0)
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
