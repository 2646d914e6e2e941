//! Editing: Gaussians that a host's shaders write on the device.

use ash::vk;

use super::Renderer;
use super::choose;
use super::shared::SharedPipelines;
use crate::passes::{CheckedEdit, LayerEdit, SceneBuffers, edit_needs};
use crate::types::PlainGaussian;
use rara_base::counted::counted;
use rara_base::error::Result;
use rara_gpu::{Bindings, Buffer, BufferDesc, Device, Draws, Location, Recorder};

/// An editor lets the host's own shaders overwrite the Gaussians of a layer between frames: a scene that bends, a brush that
/// paints and erases.
///
/// It has a [buffer](Self::buffer) of [`PlainGaussian`]s, plain floats in the order of the Gaussians' numbers in the layer,
/// which the host's shaders or copies write. [`record`](Self::record) then packs them to where the scene has them, and finds
/// the bounds of their blocks anew. A frame draws the same as with a scene that was uploaded with these Gaussians,
/// where the [bounds](LayerEdit::bounds) of the edit are theirs.
///
/// ```no_run
/// # use rara::{LayerEdit, LayerEditor, Renderer, Result, SceneBuffers, ash::vk};
/// # fn bend(renderer: &Renderer, scene: &mut SceneBuffers, cmd: vk::CommandBuffer) -> Result<()> {
/// let count = scene.layers()[0].gaussians();
/// let mut editor = LayerEditor::new(renderer, scene, count)?; // kept as long as the renderer
/// // ... a dispatch of the host's writes position_opacity and rotation of `count` Gaussians to editor.buffer() ...
/// let bent = LayerEdit::of(0..count).positions(true).rotations(true);
/// // SAFETY: `cmd` is recording outside a rendering scope, and scene and editor live until it has executed.
/// unsafe { editor.record(cmd, scene, 0, &bent)? };
/// // ... Renderer::configure, prepare and draw, as for each frame ...
/// # Ok(())
/// # }
/// ```
///
/// **What is written.** The numbers are not checked, as with [`Gaussians::positions_mut`](crate::Gaussians::positions_mut):
/// rotations are unit quaternions, standard deviations are not negative, opacities are 0 to 1, and everything is finite. A
/// number that is not so can make its own Gaussian look wrong or vanish, but no other one. An erased Gaussian has opacity 0. A
/// colour `c` from 0 to 1 is the coefficient `(c - 0.5) / 0.28209479`. Members that no edit reads may hold anything.
///
/// **Synchronisation.** The commands of [`record`](Self::record) begin with a barrier behind all dispatches, draws and copies
/// that are earlier in the queue, so that the host needs none between the writes of a compute, vertex, mesh or fragment shader
/// or of a copy, and the edit. [`Renderer::prepare`] begins with one that waits for edits. Only before it writes into the buffer
/// again, the host waits, by a barrier from compute shaders to what writes it, for the edit to have read it. With
/// [`RendererDesc::compute_family`](super::RendererDesc::compute_family) the barriers wait for dispatches and copies alone.
#[derive(Debug)]
pub struct LayerEditor {
    device: Device,
    bindings: Bindings,
    draws: Draws,
    pipelines: SharedPipelines,
    plain: Buffer,
    room: u32,
}

impl LayerEditor {
    /// An editor beside a renderer, with a buffer for so many Gaussians at a time: for the whole of a layer, or for the most
    /// that an edit changes. It takes 64 bytes of device memory for each. Its pipeline is compiled for this scene; others may
    /// have to reach their buffers in another way, and then compile it again with their first edit.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::Error::Memory) and [`Error::Budget`](crate::Error::Budget) where there is no room, and
    /// [`Error::Invalid`](crate::Error::Invalid) for a scene of another device.
    pub fn new(renderer: &Renderer, scene: &SceneBuffers, gaussians: u32) -> Result<Self> {
        let device = renderer.device.clone();
        scene.check(&device)?;
        let size = u64::from(gaussians) * size_of::<PlainGaussian>() as u64;
        let what = format!("an editor of {}", counted(gaussians, "Gaussian"));
        device.check_budget(&what, size, 0)?;
        let desc = BufferDesc {
            name: "plain",
            size,
            location: Location::GpuOnly,
        };
        let mut editor = Self {
            plain: device.create_buffer(&desc)?,
            device,
            bindings: renderer.desc.bindings,
            draws: renderer.desc.draws(),
            pipelines: renderer.pipelines.sharing(),
            room: gaussians,
        };
        editor.compile(scene)?;
        Ok(editor)
    }

    /// The buffer that the host writes [`PlainGaussian`]s to, the first one that is edited at its begin. It was created as a
    /// storage buffer and to be copied to and from, and belongs to the editor.
    pub fn buffer(&self) -> vk::Buffer {
        self.plain.handle()
    }

    /// The device address of the buffer; 0 where the device was opened without addresses.
    pub fn address(&self) -> vk::DeviceAddress {
        self.plain.address()
    }

    /// How many Gaussians the buffer is for.
    pub fn room(&self) -> u32 {
        self.room
    }

    /// Bytes of device memory that the editor takes.
    pub fn bytes(&self) -> u64 {
        self.plain.size()
    }

    /// Makes the pipeline for a scene, if there is none yet, and returns how it reaches its buffers.
    fn compile(&mut self, scene: &SceneBuffers) -> Result<Bindings> {
        let largest = self.plain.size().max(scene.largest());
        let bindings = choose::bindings(self.device.support(), self.bindings, largest)?;
        self.pipelines.ensure(&self.device, bindings, &edit_needs)?;
        Ok(bindings)
    }

    /// Records an edit of a layer, of the number that it has in [`SceneBuffers::layers`]. Nothing waits: frames that were
    /// submitted before show the layer as it was, those that are configured afterwards as it is. A frame that was configured
    /// before, and a [`Cut`](super::Cut), are configured anew, and clones of the scene cannot be drawn any more, as after
    /// [`SceneBuffers::replace_layer_with`]. An edit of nothing records nothing. [`SceneBuffers::estimated_pairs`] goes on to
    /// be of the Gaussians that were uploaded.
    ///
    /// # Safety
    /// `cmd` is recording on the renderer's device, outside a rendering scope, and will be submitted to the queue of the
    /// renderer's own commands of [`Renderer::prepare`]. Scene and editor live until it has executed. If it is never submitted, the scene is not
    /// drawn any more.
    ///
    /// # Errors
    /// [`Error::Invalid`](crate::Error::Invalid) for a number that no layer has, for more Gaussians than the layer has or the
    /// editor is for, for bounds that are no box, for a layer that is a part of Gaussians that a selection has divided, and for
    /// a scene that cannot be drawn. Nothing has been recorded then, and the scene is as it was.
    pub unsafe fn record(
        &mut self,
        cmd: vk::CommandBuffer,
        scene: &mut SceneBuffers,
        index: usize,
        edit: &LayerEdit,
    ) -> Result<()> {
        scene.check(&self.device)?;
        let checked = CheckedEdit::new(scene, index, edit, self.room)?;
        if edit.is_empty() {
            return Ok(());
        }
        let bindings = self.compile(scene)?;
        // SAFETY: the caller vouches for `cmd`, and keeps the buffers alive until it has executed.
        let mut recorder = unsafe { Recorder::begin(&self.device, cmd, self.draws, None) };
        let pipelines = self.pipelines.get(bindings);
        checked.record(&mut recorder, pipelines, &self.plain, scene);
        Ok(())
    }
}
