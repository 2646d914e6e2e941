//! Scenes by the host's own staging memory.

use std::cell::Cell;

use super::*;
use crate::results::assert_fails;
use rara_c::boundary::*;
use rara_c::staging::*;
use rara_gpu::{Buffer, BufferDesc, Location};

/// # Safety
/// As for `rara_scene_buffers_upload_with`.
unsafe fn upload_with(
    ours: &Ours,
    cmd: vk::CommandBuffer,
    staging: &RaraStaging,
    scene: *mut *mut RaraSceneBuffers,
) {
    let format = RARA_SH_FORMAT_PACKED;
    let upload = |staging: RaraStaging| {
        // SAFETY: the caller's promises.
        unsafe {
            rara_scene_buffers_upload_with(
                ours.device,
                cmd,
                &staging,
                &one_layer(ours.gaussians),
                1,
                format,
                scene,
            )
        }
    };
    let short = upload(RaraStaging {
        size: staging.size - 1,
        ..*staging
    });
    assert_fails(short, RARA_ERROR_INVALID, "bytes of staging memory");
    let unmapped = upload(RaraStaging {
        mapped: null_mut(),
        ..*staging
    });
    assert_fails(unmapped, RARA_ERROR_INVALID, "staging->mapped is null");
    let nowhere = upload(RaraStaging {
        buffer: vk::Buffer::null(),
        ..*staging
    });
    assert_fails(nowhere, RARA_ERROR_INVALID, "staging->buffer is null");
    let beyond = upload(RaraStaging {
        offset: u64::MAX - 8,
        ..*staging
    });
    assert_fails(beyond, RARA_ERROR_INVALID, "beyond any buffer");
    let newer = upload(RaraStaging {
        struct_size: size_of::<RaraStaging>() + 8,
        ..*staging
    });
    assert_fails(newer, RARA_ERROR_INVALID, "staging->struct_size is");
    assert_ok(upload(*staging));
}

#[test]
fn a_scene_by_the_hosts_own_staging_memory_is_the_same_bytes() {
    with_both(2_900, |scene, lent, device, ours| {
        let world = World::new(scene, Raster::Tiles);
        let canvas = world.canvas(lent, device);
        let truth = world.drawn(device, &canvas);
        let mut needed = 0;
        // SAFETY: the handles are alive, and the number may be overwritten.
        unsafe {
            let ask = |format, bytes: &mut u64| {
                rara_scene_buffers_staging_bytes(&one_layer(ours.gaussians), 1, format, bytes)
            };
            assert_fails(ask(4, &mut needed), RARA_ERROR_INVALID, "sh_format 4");
            assert_ok(ask(RARA_SH_FORMAT_PACKED, &mut needed));
        }
        assert_eq!(needed, SceneBuffers::staging_bytes(scene, ShFormat::Packed));
        let (_memory, staging) = staging(device, needed);
        let scene = Cell::new(null_mut());
        // SAFETY: the handles and the memory are alive; the scene is when its frame has been waited for.
        unsafe {
            let drawn = world.drawn_in_c(ours.device, &canvas, |cmd| {
                upload_with(ours, cmd, &staging, scene.as_ptr());
                scene.get()
            });
            assert!(drawn == truth);
            rara_scene_buffers_destroy(scene.get());
        }
    });
}

/// So many bytes of the host's memory, behind some that are not lent.
pub(super) fn staging(device: &Device, bytes: u64) -> (Buffer, RaraStaging) {
    let offset = 64;
    let mut memory = device
        .create_buffer(&BufferDesc {
            name: "host's staging",
            size: offset + bytes,
            location: Location::Upload,
        })
        .expect("a buffer");
    // SAFETY: the struct may hold any bytes, and has the room that the call is given.
    let mut staging = unsafe {
        let mut staging: RaraStaging = std::mem::zeroed();
        let size = size_of_val(&staging);
        assert_ok(rara_staging_default(&mut staging, size));
        staging
    };
    (staging.buffer, staging.offset) = (memory.handle(), offset);
    let first = memory.mapped_mut().pointer().cast::<u8>();
    // SAFETY: the offset lies inside.
    staging.mapped = unsafe { first.add(offset as usize) }.as_ptr().cast();
    staging.size = bytes as usize;
    (memory, staging)
}
