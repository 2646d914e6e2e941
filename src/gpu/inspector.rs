//! The notes that a device takes of what it is given, for tests.

use std::sync::Mutex;

use ash::{khr, vk};

/// A shader of a pipeline, as it was asked for and as the driver has compiled it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CompiledShader {
    pub name: &'static str,
    /// The shader's file in `glsl/`.
    pub file: String,
    /// The pipeline's specialisation constants: id and value.
    pub constants: Vec<(u32, u32)>,
    /// Invocations of the whole subgroups that are asked for; 0 where the driver may choose.
    pub asked_subgroup: u32,
    /// Invocations of the subgroups that it is compiled for; 0 where the driver does not say.
    pub subgroup: u32,
    /// The driver's numbers by the driver's names; none where it has no `VK_KHR_pipeline_executable_properties`.
    pub numbers: Vec<(String, u64)>,
}

/// The commands of a recording.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct RecordedCommands {
    /// How many barriers there are.
    pub barriers: u32,
    /// The stages that they name.
    pub stages: vk::PipelineStageFlags2,
    /// The dispatches in order.
    pub dispatches: Vec<DispatchNote>,
}

#[derive(Debug, Clone, PartialEq, Eq)]
pub struct DispatchNote {
    pub name: &'static str,
    pub groups: DispatchedGroups,
}

/// The workgroups of a dispatch.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum DispatchedGroups {
    Count(u32),
    /// As many as a command says.
    Indirect {
        /// The debug name of the buffer that holds it.
        buffer: String,
        /// The command's place in it, bytes.
        offset: u64,
    },
}

pub(super) struct Inspector {
    /// Where the driver tells what it has compiled.
    pub(super) executables: Option<khr::pipeline_executable_properties::Device>,
    pub(super) compiled: Mutex<Vec<CompiledShader>>,
    pub(super) recorded: Mutex<RecordedCommands>,
}
