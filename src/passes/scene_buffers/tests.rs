//! Uploads by the library and by a host.

use super::*;
use crate::passes::sh_storage;
use crate::types::{Block, Gaussian};
use rara_gpu::{BufferDesc, Location, testing};
use rara_scene::{Kind, Layer, generate};

#[test]
fn a_host_uploads_the_same_bytes() {
    let device = testing::device();
    for (counts, format) in [
        (vec![0], ShFormat::Float),
        (vec![1], ShFormat::Packed),
        (vec![3_000], ShFormat::Float),
        (vec![2_999], ShFormat::Half),
        (vec![2_049], ShFormat::Packed),
        (vec![300], ShFormat::Byte),
        (vec![300, 0, 1, 257], ShFormat::Packed),
        (vec![0, 513, 1, 0], ShFormat::Byte),
    ] {
        let parts = counts.iter().map(|&count| generate(Kind::Layers, count, 1));
        let mut parts: Vec<_> = parts.collect();
        parts[0].set_sh_degree(0); // other layers may have more
        let scene: Scene<'_> = parts.iter().map(|part| Layer::new("part", part)).collect();
        let whole = SceneBuffers::upload(&device, &scene, format).expect("uploads");
        let needed = SceneBuffers::staging_bytes(&scene, format) as usize;
        let mut lent = device
            .create_buffer(&BufferDesc {
                name: "lent",
                size: needed as u64 + 64,
                location: Location::Upload,
            })
            .expect("a buffer");
        let buffer = lent.handle();
        let ours = device.submit_and_wait(|cmd| {
            fn lend(buffer: vk::Buffer, bytes: WriteOnly<'_>) -> Staging<'_> {
                let offset = 32;
                Staging {
                    buffer,
                    offset,
                    bytes,
                }
            }
            let mut bytes = lent.mapped_mut();
            // SAFETY: `cmd` is recording, and everything outlives the wait for it.
            unsafe {
                if needed > 0 {
                    let short = lend(buffer, bytes.part(32..32 + needed - 1));
                    let error = SceneBuffers::upload_with(&device, cmd, short, &scene, format);
                    let text = error.expect_err("a byte is missing").to_string();
                    assert!(text.contains("staging_bytes"), "{text}");
                }
                let fitting = lend(buffer, bytes.part(32..32 + needed));
                SceneBuffers::upload_with(&device, cmd, fitting, &scene, format)
            }
        });
        let ours = ours.expect("uploads");
        let pairs = [
            (&whole.gaussians, &ours.gaussians),
            (&whole.sh, &ours.sh),
            (&whole.blocks, &ours.blocks),
        ];
        // Of each layer by itself: nobody writes what is between them.
        let words = sh_storage::words(format, 3 * sh_coefficients(scene.sh_degree()));
        for layer in whole.layers() {
            let first = layer.first_block * limits::BLOCK_SIZE;
            let blocks = layer.gaussians().div_ceil(limits::BLOCK_SIZE);
            for ((theirs, ours), (at, count, size)) in pairs.into_iter().zip([
                (first, layer.gaussians(), size_of::<Gaussian>()),
                (first, layer.gaussians(), words * size_of::<u32>()),
                (layer.first_block, blocks, size_of::<Block>()),
            ]) {
                let (at, length) = (u64::from(at) * size as u64, u64::from(count) * size as u64);
                let read = |buffer| device.download_range(buffer, at, length);
                let [theirs, ours] = [theirs, ours].map(|b| read(b).expect("reads back"));
                assert!(theirs == ours, "{counts:?}, {format:?}");
            }
        }
        let facts = |b: &SceneBuffers| {
            (
                b.reordered,
                b.count,
                b.sh_degree,
                b.sh_format,
                b.layers.clone(),
            )
        };
        assert_eq!(facts(&whole), facts(&ours));
    }
    assert_eq!(device.close(), Vec::<String>::new());
}
