//! A device and Gaussians of `rara.h`.

use std::ffi::CString;
use std::path::{Path, PathBuf};
use std::ptr::null;

use super::*;
use rara::scene::{generate, load, save_ply};

/// The handles that stay the same while frames are drawn in C.
pub(super) struct Ours {
    pub(super) device: *mut RaraDevice,
    pub(super) gaussians: *mut RaraGaussians,
}

impl Ours {
    /// # Safety
    /// The host and its loader outlive what is returned.
    pub(super) unsafe fn new(entry: &Entry, host: &AdoptDesc, path: &Path) -> Self {
        // SAFETY: the caller's promise.
        unsafe { Self::shaped(entry, host, path, RARA_SHAPE_AUTO) }
    }

    /// The same with pipelines for a kind of machine.
    ///
    /// # Safety
    /// As for `new`.
    pub(super) unsafe fn shaped(
        entry: &Entry,
        host: &AdoptDesc,
        path: &Path,
        shape: RaraShape,
    ) -> Self {
        // SAFETY: the caller's promise.
        unsafe { Self::described(entry, host, path, |desc| desc.shape = shape) }
    }

    /// The same with more in the description of the device.
    ///
    /// # Safety
    /// As for `new`, and what is added is as its fields say.
    pub(super) unsafe fn described(
        entry: &Entry,
        host: &AdoptDesc,
        path: &Path,
        add: impl FnOnce(&mut RaraAdoptDesc),
    ) -> Self {
        let mut device = null_mut();
        // SAFETY: the caller's promise; the others are alive, or to be overwritten.
        unsafe {
            let mut desc: RaraAdoptDesc = std::mem::zeroed();
            assert_ok(rara_adopt_desc_default(&mut desc, size_of_val(&desc)));
            desc.get_instance_proc_addr = Some(entry.static_fn().get_instance_proc_addr);
            desc.instance = host.instance.handle();
            desc.physical_device = host.physical_device;
            desc.device = host.device.handle();
            (desc.queue, desc.queue_family) = (host.queue, host.queue_family);
            desc.mesh_shader = host.mesh_shader.into();
            desc.push_descriptor = host.push_descriptor.into();
            desc.debug_utils = host.debug_utils.into();
            desc.full_subgroups = host.full_subgroups.into();
            desc.pipeline_statistics = host.pipeline_statistics.into();
            desc.api_version = host.api_version;
            add(&mut desc);
            assert_ok(rara_device_adopt(&desc, &mut device));
        }
        let gaussians = loaded_in_c(path);
        Self { device, gaussians }
    }

    /// Uploads its Gaussians to its device.
    pub(super) fn uploaded(&self) -> *mut RaraSceneBuffers {
        let (mut scene, format) = (null_mut(), RARA_SH_FORMAT_PACKED);
        // SAFETY: both are alive, and the pointer may be overwritten.
        assert_ok(unsafe {
            rara_scene_buffers_upload(
                self.device,
                &one_layer(self.gaussians),
                1,
                format,
                &mut scene,
            )
        });
        scene
    }
}

/// Writes so many made-up Gaussians to a file, and loads them from it: a file has opacities and scales in another form.
pub(super) fn saved(folder: &Folder, kind: Kind, count: usize) -> (PathBuf, Gaussians) {
    saved_as(folder, &generate(kind, count, 5))
}

/// The same of these Gaussians.
pub(super) fn saved_as(folder: &Folder, made: &Gaussians) -> (PathBuf, Gaussians) {
    let path = folder.join("scene.ply");
    save_ply(&path, made).expect("a temporary file");
    let loaded = load(&path, &mut |_, _| ()).expect("loads");
    (path, loaded.gaussians)
}

pub(super) fn loaded_in_c(path: &Path) -> *mut RaraGaussians {
    let mut gaussians = null_mut();
    let name = CString::new(path.to_str().expect("UTF-8")).expect("no NUL");
    // SAFETY: the name ends in NUL, and the pointer may be overwritten.
    assert_ok(unsafe { rara_gaussians_load(name.as_ptr(), null(), 0, &mut gaussians) });
    gaussians
}
