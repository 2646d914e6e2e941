//! Editing: Gaussians that a host's shaders write on the device.

use rara::ash::vk;
use rara::glam::DVec3;
use rara::{Bounds, LayerEdit, LayerEditor};

use crate::boundary::{RaraResult, Versioned, guard, read, recording, versioned, write};
use crate::handles::{alive, alone, create, destroy, number};
use crate::layer_info::check_index;
use crate::renderer::RaraRenderer;
use crate::scene::RaraSceneBuffers;

/// Lets the host's own shaders overwrite the Gaussians of a layer between frames. It has a buffer of RaraPlainGaussian in the
/// order of the Gaussians' numbers in the layer, which shaders or copies of the host's write; rara_layer_editor_record packs
/// them to where the scene has them. Calls of several threads take turns.
pub struct RaraLayerEditor(LayerEditor);

/// A Gaussian as a host writes it to be edited: plain floats, of which an edit reads the fields that it names. The numbers are
/// not checked: one that is not as its field says can make its own Gaussian look wrong or vanish, but no other one. It never
/// grows.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default)]
pub struct RaraPlainGaussian {
    /// The centre x y z in the layer's units, relative to its origin.
    pub position: [f32; 3],
    /// The opacity, 0 to 1.
    pub opacity: f32,
    /// The standard deviations x y z in the layer's units, and a number that is not read.
    pub scale: [f32; 4],
    /// The rotation, a unit quaternion x y z w.
    pub rotation: [f32; 4],
    /// The constant coefficients of red, green and blue, (c - 0.5) / 0.28209479 of a colour c, and a number that is not read.
    pub colour: [f32; 4],
}

/// An edit of a layer: which of its Gaussians change, and what of them. Everything else stays as it is.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct RaraLayerEdit {
    /// Set by rara_layer_edit_default.
    pub struct_size: usize,
    /// The number in the layer of the first Gaussian that is edited, which is the first one of the editor's buffer. Default: 0.
    pub first: u32,
    /// How many are edited. Default: 0.
    pub count: u32,
    /// True if their centres are read. Default: false.
    pub positions: vk::Bool32,
    /// True if their standard deviations are read. Default: false.
    pub scales: vk::Bool32,
    /// True if their rotations are read. Default: false.
    pub rotations: vk::Bool32,
    /// True if their opacities are read. Default: false.
    pub opacities: vk::Bool32,
    /// True if their colours are read. Default: false.
    pub colours: vk::Bool32,
    /// True if they get one colour from all sides. Default: false.
    pub flat: vk::Bool32,
    /// True if the layer gets the box below; false, the default, if all centres stay in the box that it has.
    pub has_bounds: vk::Bool32,
    /// True if the Gaussians move to where the edit puts them, so that the next frame's motion (`motion_format` of
    /// RaraRendererDesc) shows how far; false, the default, if others take their place, which count as at rest. The first such
    /// edit of a scene takes 48 bytes of device memory for each of its Gaussians.
    pub moves: vk::Bool32,
    /// The least coordinates of the centres of all Gaussians of the layer after the edit, in its units and relative to its
    /// origin. Gaussians with a centre outside of the box may be drawn in a wrong order, and a box that is much too large sorts
    /// depths coarsely.
    pub bounds_min: [f64; 3],
    /// The greatest ones.
    pub bounds_max: [f64; 3],
}

versioned!(RaraLayerEdit);

impl From<RaraLayerEdit> for LayerEdit {
    fn from(edit: RaraLayerEdit) -> Self {
        let bounds = Bounds {
            min: DVec3::from(edit.bounds_min),
            max: DVec3::from(edit.bounds_max),
        };
        Self::of(edit.first..edit.first)
            .count(edit.count)
            .positions(edit.positions != 0)
            .scales(edit.scales != 0)
            .rotations(edit.rotations != 0)
            .opacities(edit.opacities != 0)
            .colours(edit.colours != 0)
            .flat(edit.flat != 0)
            .moves(edit.moves != 0)
            .bounds((edit.has_bounds != 0).then_some(bounds))
    }
}

/// An edit of nothing. `edit_size` is sizeof *edit.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_layer_edit_default(
    edit: *mut RaraLayerEdit,
    edit_size: usize,
) -> RaraResult {
    guard(|| write(edit, edit_size, &Versioned::BLANK, "edit"))
}

/// Makes an editor beside a renderer, with a buffer for so many Gaussians at a time: for the whole of a layer, or for the most
/// that an edit changes. It takes 64 bytes of device memory for each. Its pipeline is compiled for this scene.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_layer_editor_create(
    renderer: *const RaraRenderer,
    scene: *const RaraSceneBuffers,
    gaussians: u32,
    editor: *mut *mut RaraLayerEditor,
) -> RaraResult {
    create(editor, "editor", || {
        let renderer = alive(renderer, "renderer")?;
        let scene = alive(scene, "scene")?;
        let editor = LayerEditor::new(&renderer.0, &scene.buffers, gaussians)?;
        Ok(RaraLayerEditor(editor))
    })
}

/// The buffer that the host writes RaraPlainGaussian to, the first one that is edited at its begin; null for what is no editor
/// that is alive. It was created as a storage buffer and to be copied to and from, and belongs to the editor.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_layer_editor_buffer(editor: *const RaraLayerEditor) -> vk::Buffer {
    number(editor, "editor", |editor| editor.0.buffer())
}

/// The device address of the buffer; 0 where the device was created without addresses, and for what is no editor that is alive.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_layer_editor_address(editor: *const RaraLayerEditor) -> u64 {
    number(editor, "editor", |editor| editor.0.address())
}

/// Bytes of device memory that an editor takes, 0 for what is no editor that is alive.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_layer_editor_bytes(editor: *const RaraLayerEditor) -> u64 {
    number(editor, "editor", |editor| editor.0.bytes())
}

/// Records an edit of a layer. Nothing waits: frames that were submitted before show the layer as it was, those that are
/// configured afterwards as it is. A frame that was configured before, and a RaraCut, are configured anew. RARA_ERROR_INVALID
/// for a number that no layer has, for more Gaussians than the layer has or the editor is for, for bounds that are no box, and
/// for a layer of Gaussians that rara_gaussians_select has divided; nothing has been recorded then, and the scene is as it was.
///
/// Synchronisation: the commands begin with a barrier behind all dispatches, draws and copies that are earlier in the queue,
/// those of rara_renderer_prepare with one that waits for edits. Only before it writes into the buffer again, the host waits, by
/// a barrier from compute shaders to what writes it, for the edit to have read it. With `compute_family` of RaraRendererDesc the
/// barriers wait for dispatches and copies alone.
///
/// # Safety
/// `cmd` is recording outside a rendering scope, and will be submitted to the device's queue; if it never is, the scene is not
/// drawn any more. Scene and editor live until it has executed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_layer_editor_record(
    editor: *mut RaraLayerEditor,
    cmd: vk::CommandBuffer,
    scene: *mut RaraSceneBuffers,
    index: usize,
    edit: *const RaraLayerEdit,
) -> RaraResult {
    guard(|| {
        let mut editor = alone(editor, "editor")?;
        let cmd = recording(cmd)?;
        let mut scene = alone(scene, "scene")?;
        check_index(&scene, index)?;
        let edit = read(edit, Versioned::BLANK, "edit")?.into();
        editor.0.record(cmd, &mut scene.buffers, index, &edit)
    })
}

/// Frees an editor's memory; null is ignored. The host has waited for the edits, or calls
/// rara_device_destroy_after.
///
/// # Safety
/// `editor` is null, or alive and not used any more, not even by the device.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_layer_editor_destroy(editor: *mut RaraLayerEditor) {
    destroy(editor);
}
