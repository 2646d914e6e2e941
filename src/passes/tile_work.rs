//! How the invocations of a workgroup share its tile.

use rara_base::limits;
use rara_gpu::DeviceShape;

/// How the invocations of a workgroup share its tile.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct TileWork {
    /// Pixels that an invocation owns, one above the other.
    pub(super) rows: u32,
    /// True when subgroups load splats together.
    pub(super) subgroups: bool,
}

impl TileWork {
    /// The sharing that suits a device. Its subgroups can shuffle if their size is not 0.
    pub(crate) fn suiting(shape: DeviceShape, subgroup_size: u32) -> Self {
        let is_cpu = shape == DeviceShape::Cpu;
        let rows = if is_cpu { limits::TILE_HEIGHT } else { 1 };
        let invocations = limits::TILE_WIDTH * (limits::TILE_HEIGHT / rows);
        Self {
            rows,
            // The shader counts on subgroups without gaps, which come together again after each branch. CPU drivers run
            // them like that, as vectors under a mask; Vulkan does not promise it unless it is asked for. On GPUs a batch goes
            // through shared memory, which asks for nothing.
            subgroups: is_cpu && subgroup_size > 0 && invocations.is_multiple_of(subgroup_size),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_whole_subgroups_of_cpu_drivers_load_together() {
        for (shape, size, subgroups) in [
            (DeviceShape::Cpu, 4, true),
            (DeviceShape::Cpu, 8, true),
            (DeviceShape::Cpu, 16, false),
            (DeviceShape::Cpu, 0, false),
            (DeviceShape::Gpu { subgroup: 32 }, 32, false),
        ] {
            assert_eq!(
                TileWork::suiting(shape, size).subgroups,
                subgroups,
                "{size}"
            );
        }
    }
}
