//! Device memory from a host's own functions: the picture is the same, and all of it comes back.

use std::ffi::{CStr, c_void};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use super::*;
use crate::results::assert_fails;
use rara::ash;
use rara_c::boundary::{RARA_ERROR_INVALID, RARA_ERROR_MEMORY, RaraResult};
use rara_c::lent::*;

/// A host that gives each request memory of its own, a little behind its beginning.
struct Lender {
    device: ash::Device,
    types: vk::PhysicalDeviceMemoryProperties,
    lent: AtomicUsize,
    most: AtomicUsize,
    refuses: AtomicBool,
}

impl Lender {
    fn new(host: &AdoptDesc) -> Self {
        Self {
            device: host.device.clone(),
            // SAFETY: both belong together and are alive.
            types: unsafe {
                let instance = &host.instance;
                instance.get_physical_device_memory_properties(host.physical_device)
            },
            lent: AtomicUsize::new(0),
            most: AtomicUsize::new(0),
            refuses: AtomicBool::new(false),
        }
    }
}

unsafe extern "C" fn allocate(
    user: *mut c_void,
    request: *const RaraMemoryRequest,
    memory: *mut RaraMemory,
) -> vk::Result {
    // SAFETY: `user` is the lender, which outlives the device; the others are as RaraAllocate says.
    let (lender, asked, memory) = unsafe { (&*user.cast::<Lender>(), &*request, &mut *memory) };
    if lender.refuses.load(Ordering::Relaxed) {
        return vk::Result::ERROR_OUT_OF_DEVICE_MEMORY;
    }
    assert_eq!(asked.struct_size, size_of::<RaraMemoryRequest>());
    // SAFETY: it ends in NUL.
    assert!(!unsafe { CStr::from_ptr(asked.name) }.is_empty());
    assert_eq!(memory.struct_size, size_of::<RaraMemory>());
    let mapped = asked.memory_use != RARA_MEMORY_USE_DEVICE;
    let needed = match mapped {
        true => vk::MemoryPropertyFlags::HOST_VISIBLE | vk::MemoryPropertyFlags::HOST_COHERENT,
        false => vk::MemoryPropertyFlags::DEVICE_LOCAL,
    };
    let types = lender.types.memory_types_as_slice().iter().enumerate();
    let mut fit = types.filter(|(index, kind)| {
        asked.memory_type_bits >> index & 1 == 1 && kind.property_flags.contains(needed)
    });
    let (index, _) = fit.next().expect("a type of memory");
    let offset = asked.alignment.max(64);
    let mut address =
        vk::MemoryAllocateFlagsInfo::default().flags(vk::MemoryAllocateFlags::DEVICE_ADDRESS);
    let info = vk::MemoryAllocateInfo::default()
        .allocation_size(offset + asked.size)
        .memory_type_index(index as u32)
        .push_next(&mut address);
    // SAFETY: the device is alive, the type is one of its own, and what is mapped is the memory's.
    unsafe {
        memory.memory = lender.device.allocate_memory(&info, None).expect("memory");
        if mapped {
            let flags = vk::MemoryMapFlags::empty();
            let begin = lender
                .device
                .map_memory(memory.memory, 0, vk::WHOLE_SIZE, flags);
            memory.mapped = begin.expect("mapped").byte_add(offset as usize);
        }
    }
    memory.offset = offset;
    let lent = lender.lent.fetch_add(1, Ordering::Relaxed) + 1;
    lender.most.fetch_max(lent, Ordering::Relaxed);
    memory.user = lent as *mut c_void;
    vk::Result::SUCCESS
}

unsafe extern "C" fn free(user: *mut c_void, memory: *const RaraMemory) {
    // SAFETY: as above; the memory is what was lent, and the device is done with it.
    unsafe {
        let (lender, memory) = (&*user.cast::<Lender>(), &*memory);
        assert!(
            !memory.user.is_null() && memory.offset >= 64,
            "as it was lent"
        );
        lender.device.free_memory(memory.memory, None);
        lender.lent.fetch_sub(1, Ordering::Relaxed);
    }
}

#[test]
fn a_hosts_memory_draws_the_same_bytes_and_comes_back() {
    let folder = Folder::new("c-frames-lent");
    let (path, scene) = saved(&folder, Kind::General, 2_000);
    with_host(true, |host, device| {
        let lent = host.lend();
        let lender = Lender::new(&lent);
        let user = std::ptr::from_ref(&lender).cast_mut().cast::<c_void>();
        // SAFETY: the system's loader; the host and the lender outlive what is made here.
        unsafe {
            let entry = Entry::load().expect("a Vulkan loader");
            let ours = Ours::described(&entry, &lent, &path, |desc| {
                desc.allocate = Some(allocate);
                desc.free = Some(free);
                desc.allocator_user = user;
            });
            let uploaded = ours.uploaded();
            assert!(lender.lent.load(Ordering::Relaxed) > 0);
            assert!(rara_device_bytes(ours.device) > 0);
            for raster in [Raster::Tiles, Raster::Quad] {
                let world = World::new(&scene, raster);
                let canvas = world.canvas(&lent, device);
                let drawn = world.drawn_in_c(ours.device, &canvas, |_| uploaded);
                assert!(drawn == world.drawn(device, &canvas), "{raster:?}");
            }
            lender.refuses.store(true, Ordering::Relaxed);
            let (mut none, format) = (null_mut(), RARA_SH_FORMAT_PACKED);
            let result: RaraResult = rara_scene_buffers_upload(
                ours.device,
                &one_layer(ours.gaussians),
                1,
                format,
                &mut none,
            );
            assert_fails(result, RARA_ERROR_MEMORY, "ERROR_OUT_OF_DEVICE_MEMORY");
            assert!(none.is_null());
            rara_scene_buffers_destroy(uploaded);
            rara_gaussians_destroy(ours.gaussians);
            assert_eq!(rara_device_bytes(ours.device), 0);
            rara_device_destroy(ours.device);
            assert!(lender.most.load(Ordering::Relaxed) > 10);
            assert_eq!(
                lender.lent.load(Ordering::Relaxed),
                0,
                "all of it came back"
            );

            let mut desc: RaraAdoptDesc = std::mem::zeroed();
            assert_ok(rara_adopt_desc_default(&mut desc, size_of_val(&desc)));
            desc.get_instance_proc_addr = Some(entry.static_fn().get_instance_proc_addr);
            desc.instance = lent.instance.handle();
            desc.physical_device = lent.physical_device;
            (desc.device, desc.queue) = (lent.device.handle(), lent.queue);
            desc.allocate = Some(allocate);
            let refused = rara_device_adopt(&desc, &mut null_mut());
            assert_fails(refused, RARA_ERROR_INVALID, "desc->free is null");
        }
    });
}
