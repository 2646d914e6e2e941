//! Notes of the code that pipelines are compiled to and of the commands that are recorded, for tests of what a frame costs.
//! Only a device that was opened for it takes notes.

use std::sync::{Mutex, PoisonError};

use ash::{khr, vk};

use super::desc::DeviceDesc;
use super::device::Device;
use super::failure::failed;
use super::inspector::{
    CompiledShader, DispatchNote, DispatchedGroups, Inspector, RecordedCommands,
};
use super::instance::Instance;
use super::recorder::Groups;
use super::requirements::offers;
use super::shader::Shader;
use rara_base::error::Result;

impl Device {
    /// As [`headless`](Self::headless), but the device notes what its pipelines are compiled to and which commands are
    /// recorded.
    #[doc(hidden)]
    pub fn headless_inspected(desc: &DeviceDesc) -> Result<Self> {
        let extension = khr::pipeline_executable_properties::NAME;
        let instance = Instance::new(&desc.application_name, desc.validation, &[])?;
        let candidates = instance.devices()?;
        let usable = candidates.iter().filter(|(_, info)| info.support.is_ok());
        let explains = usable.map(|(physical, _)| {
            // SAFETY: the instance is alive, and the device is its own.
            unsafe {
                instance
                    .raw
                    .enumerate_device_extension_properties(*physical)
            }
            .is_ok_and(|extensions| offers(&extensions, extension))
        });
        let needed = match explains.collect::<Vec<_>>() {
            all if all.iter().all(|explains| *explains) => vec![extension],
            _ => Vec::new(),
        };
        let device = Self::open(instance.into(), candidates, desc, &needed)?;
        let executables = (!needed.is_empty()).then(|| {
            khr::pipeline_executable_properties::Device::new(device.instance(), device.raw())
        });
        let inspector = Inspector {
            executables,
            compiled: Mutex::default(),
            recorded: Mutex::default(),
        };
        let set = device.inner.inspector.set(inspector);
        assert!(set.is_ok(), "a device that was just opened has none yet");
        Ok(device)
    }

    /// The shaders of all pipelines so far.
    #[doc(hidden)]
    pub fn compiled_shaders(&self) -> Vec<CompiledShader> {
        let compiled = self.inspector().map(|notes| notes.compiled.lock());
        let compiled = compiled.map(|lock| lock.unwrap_or_else(PoisonError::into_inner).clone());
        compiled.unwrap_or_default()
    }

    /// The commands of the recording that was begun last.
    #[doc(hidden)]
    pub fn recorded(&self) -> RecordedCommands {
        let mut found = RecordedCommands::default();
        self.note(|recorded| found = recorded.clone());
        found
    }

    /// The flags that pipelines are created with.
    pub(super) fn pipeline_flags(&self) -> vk::PipelineCreateFlags {
        match self.inspector() {
            Some(Inspector {
                executables: Some(_),
                ..
            }) => vk::PipelineCreateFlags::CAPTURE_STATISTICS_KHR,
            _ => vk::PipelineCreateFlags::empty(),
        }
    }

    /// Notes a new pipeline of these shaders; `asked_subgroup` is 0 where no size was asked for.
    pub(super) fn note_pipeline(
        &self,
        (name, pipeline): (&'static str, vk::Pipeline),
        shaders: &[&Shader],
        constants: &[(u32, u32)],
        asked_subgroup: u32,
    ) -> Result<()> {
        let Some(notes) = self.inspector() else {
            return Ok(());
        };
        let executables = notes.executables.as_ref();
        let executables = executables.map(|calls| Executable::all(calls, pipeline));
        let executables = executables.transpose()?.unwrap_or_default();
        let compiled = shaders.iter().map(|shader| {
            let own = executables.iter().find(|e| e.stages.contains(shader.stage));
            CompiledShader {
                name,
                file: shader.file.into(),
                constants: constants.to_vec(),
                asked_subgroup,
                subgroup: own.map_or(0, |executable| executable.subgroup),
                numbers: own.map_or(Vec::new(), |executable| executable.numbers.clone()),
            }
        });
        let mut all = notes
            .compiled
            .lock()
            .unwrap_or_else(PoisonError::into_inner);
        all.extend(compiled);
        Ok(())
    }

    /// Begins the notes of a recording.
    pub(super) fn note_recording(&self) {
        self.note(|recorded| *recorded = RecordedCommands::default());
    }

    pub(super) fn note_barrier(&self, stages: vk::PipelineStageFlags2) {
        self.note(|recorded| {
            recorded.barriers += 1;
            recorded.stages |= stages;
        });
    }

    pub(super) fn note_dispatch(&self, name: &'static str, groups: Groups<'_>) {
        let groups = || match groups {
            Groups::Count(count) => DispatchedGroups::Count(count),
            Groups::Indirect(args, offset) => DispatchedGroups::Indirect {
                buffer: args.name().to_owned(),
                offset,
            },
        };
        self.note(|recorded| {
            let groups = groups();
            recorded.dispatches.push(DispatchNote { name, groups });
        });
    }

    fn note(&self, change: impl FnOnce(&mut RecordedCommands)) {
        if let Some(notes) = self.inspector() {
            change(
                &mut notes
                    .recorded
                    .lock()
                    .unwrap_or_else(PoisonError::into_inner),
            );
        }
    }

    fn inspector(&self) -> Option<&Inspector> {
        self.inner.inspector.get()
    }
}

/// A part of a pipeline, as the driver has compiled it.
struct Executable {
    stages: vk::ShaderStageFlags,
    subgroup: u32,
    numbers: Vec<(String, u64)>,
}

impl Executable {
    /// The parts of a pipeline that was created with [`Device::pipeline_flags`].
    fn all(
        calls: &khr::pipeline_executable_properties::Device,
        pipeline: vk::Pipeline,
    ) -> Result<Vec<Self>> {
        let info = vk::PipelineInfoKHR::default().pipeline(pipeline);
        // SAFETY: the pipeline is new and alive, and the feature was enabled where the functions were loaded.
        let parts = unsafe { calls.get_pipeline_executable_properties(&info) }
            .map_err(failed("vkGetPipelineExecutablePropertiesKHR"))?;
        let parts = parts.iter().enumerate().map(|(index, part)| {
            let info = vk::PipelineExecutableInfoKHR::default()
                .pipeline(pipeline)
                .executable_index(index as u32);
            // SAFETY: as above; the pipeline was created to keep its statistics.
            let numbers = unsafe { calls.get_pipeline_executable_statistics(&info) }
                .map_err(failed("vkGetPipelineExecutableStatisticsKHR"))?;
            Ok(Self {
                stages: part.stages,
                subgroup: part.subgroup_size,
                numbers: numbers.iter().map(number).collect(),
            })
        });
        parts.collect()
    }
}

/// A driver's number and its name.
fn number(statistic: &vk::PipelineExecutableStatisticKHR<'_>) -> (String, u64) {
    use vk::PipelineExecutableStatisticFormatKHR as Format;
    let name = statistic.name_as_c_str().unwrap_or(c"?").to_string_lossy();
    // SAFETY: the format says which of the fields the driver has written.
    let value = unsafe {
        match statistic.format {
            Format::BOOL32 => statistic.value.b32.into(),
            Format::INT64 => statistic.value.i64.max(0) as u64,
            Format::FLOAT64 => statistic.value.f64 as u64,
            _ => statistic.value.u64,
        }
    };
    (name.into_owned(), value)
}
