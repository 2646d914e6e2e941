//! The quantities that splats can be coloured in.

use crate::types;

#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) enum SplatColours {
    #[default]
    Scene,
    /// The numbers of their Gaussians and layers.
    Numbers,
    /// The directions of their thinnest axes, turned to the eye, in the camera's frame.
    Normals,
    /// Red for the splats of this layer, green for those of the next one, blue for those of the one after it, and black.
    Layers(u32),
}

impl SplatColours {
    /// The shaders' name of it, `COLOURS_*`.
    pub(super) fn code(self) -> u32 {
        match self {
            Self::Scene => types::COLOURS_SCENE,
            Self::Numbers => types::COLOURS_NUMBERS,
            Self::Normals => types::COLOURS_NORMALS,
            Self::Layers(_) => types::COLOURS_LAYERS,
        }
    }

    /// The layer that is red.
    pub(super) fn first_layer(self) -> u32 {
        match self {
            Self::Layers(first) => first,
            Self::Scene | Self::Numbers | Self::Normals => 0,
        }
    }
}
