//! Buffers: what is written, copied and freed.

use super::*;
use rara::Error;

#[test]
fn uploads_in_chunks_come_back() {
    clean(|device| {
        let data: Vec<u32> = (0..(40 << 20) / 4)
            .map(|i: u32| i.wrapping_mul(2_654_435_761))
            .collect();
        let large = on_device(device, "large", &data);
        assert!(read(device, &large, data.len()) == data);

        device.upload(&large, 12, &[1, 2, 3, 4, 5]).unwrap();
        assert_eq!(
            device.download_range(&large, 11, 7).unwrap()[1..6],
            [1, 2, 3, 4, 5]
        );
    });
}

#[test]
fn sizes_are_rounded_up_and_freed() {
    clean(|device| {
        let empty = buffer(device, "empty", 0, Location::GpuOnly);
        assert_eq!(empty.size(), 16);
        assert!(empty.address() != 0 && empty.address().is_multiple_of(16));
        let large = buffer(device, "large", 100 << 20, Location::GpuOnly);
        assert!(device.device_bytes() >= large.size() + 16);
        drop(large);
        assert!(device.device_bytes() < 1 << 20);
    });
}

#[test]
fn what_does_not_fit_is_an_error_that_names_it() {
    clean(|device| {
        let desc = BufferDesc {
            name: "splats",
            size: 1 << 50,
            location: Location::GpuOnly,
        };
        let error = device.create_buffer(&desc).unwrap_err();
        assert!(matches!(error, Error::Memory(_)));
        assert!(
            error.to_string().contains("\"splats\" of 1048576.00 GiB"),
            "{error}"
        );
    });
}

#[test]
fn fills_updates_and_copies_reach_mapped_memory() {
    clean(|device| {
        let mut source = buffer(device, "source", 256, Location::Upload);
        source.mapped_mut().write(0, &[0xAB; 256]);
        let middle = buffer(device, "middle", 1 << 20, Location::GpuOnly);
        let target = buffer(device, "target", 1 << 20, Location::Readback);
        let update: Vec<u8> = (0..200_000_u32).map(|i| (i % 251) as u8).collect();
        record(device, None, |recorder| {
            recorder.fill(&middle, 0, middle.size(), 0x01020304);
            recorder.update(&middle, 1024, &update);
            recorder.copy(
                &source,
                &middle,
                &[vk::BufferCopy {
                    src_offset: 0,
                    dst_offset: 16,
                    size: 256,
                }],
            );
            recorder.copy(
                &middle,
                &target,
                &[vk::BufferCopy {
                    src_offset: 0,
                    dst_offset: 0,
                    size: 1 << 20,
                }],
            );
            recorder.ready_for_host(&[&target]);
        });
        let bytes = target.mapped();
        assert_eq!(bytes[..16], [4, 3, 2, 1].repeat(4));
        assert!(bytes[16..272].iter().all(|byte| *byte == 0xAB));
        assert!(bytes[1024..][..update.len()] == update);
        assert_eq!(bytes[(1 << 20) - 4..], [4, 3, 2, 1]);
    });
}

#[test]
fn memory_is_listed_by_name() {
    clean(|device| {
        let _one = buffer(device, "pairs", 1 << 20, Location::GpuOnly);
        let _other = buffer(device, "pairs", 17 << 20, Location::GpuOnly);
        let _small = buffer(device, "counts", 64, Location::Readback);
        let parts = device.memory_by_name();
        let names: Vec<_> = parts.iter().map(|of| of.name.as_str()).collect();
        assert_eq!(names, ["pairs", "counts"]);
        assert!(parts[0].bytes >= 18 << 20, "{parts:?}");
        let sum: u64 = parts.iter().map(|of| of.bytes).sum();
        assert_eq!(sum, device.device_bytes());
    });
}
