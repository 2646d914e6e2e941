//! An edit leaves in the scene's buffers what an upload of the same numbers does.

use bytemuck::{Pod, cast_slice, pod_collect_to_vec};
use glam::{Quat, Vec3};

use super::*;
use crate::passes::sh_storage;
use crate::types::{Block, Gaussian, PlainGaussian};
use rara_gpu::{Bindings, BufferDesc, Device, Draws, Location, testing};
use rara_scene::{Gaussians, Kind, generate, sh_coefficients};

/// A scene on the device, of one layer, and the order of its Gaussians there.
struct Edited<'a> {
    device: &'a Device,
    scene: SceneBuffers,
    pipelines: Pipelines,
}

impl<'a> Edited<'a> {
    fn new(
        device: &'a Device,
        gaussians: &Gaussians,
        format: ShFormat,
        bindings: Bindings,
    ) -> Self {
        let mut pipelines = Pipelines::new(bindings);
        let mut keys = Vec::new();
        needs(&mut |key| keys.push(key));
        pipelines.ensure(device, keys).expect("compiles");
        Self {
            device,
            scene: SceneBuffers::upload(device, gaussians, format).expect("uploads"),
            pipelines,
        }
    }

    fn edit(&mut self, edit: &LayerEdit, plain: &[PlainGaussian]) {
        let buffer = self.device.create_buffer(&BufferDesc {
            name: "plain",
            size: size_of_val(plain) as u64,
            location: Location::GpuOnly,
        });
        let buffer = buffer.expect("a buffer");
        let uploaded = self.device.upload(&buffer, 0, cast_slice(plain));
        uploaded.expect("uploads");
        let checked = CheckedEdit::new(&self.scene, 0, edit, edit.count).expect("it fits");
        let done = self.device.submit_and_wait(|cmd| {
            // SAFETY: `cmd` is recording, and everything outlives the wait for it.
            let mut recorder = unsafe { Recorder::begin(self.device, cmd, Draws::Around, None) };
            checked.record(&mut recorder, &self.pipelines, &buffer, &mut self.scene);
            Ok(())
        });
        done.expect("runs");
    }

    fn read<T: Pod>(&self, buffer: &Buffer, count: usize) -> Vec<T> {
        let bytes = (count * size_of::<T>()) as u64;
        pod_collect_to_vec(
            &self
                .device
                .download_range(buffer, 0, bytes)
                .expect("reads back"),
        )
    }

    fn gaussians(&self) -> Vec<Gaussian> {
        self.read(&self.scene.gaussians, self.scene.count as usize)
    }

    fn blocks(&self) -> Vec<Block> {
        self.read(&self.scene.blocks, self.scene.block_count() as usize)
    }

    /// The numbers of the Gaussians in their order.
    fn order(&self) -> Vec<u32> {
        let numbers = self.gaussians().into_iter();
        numbers
            .map(|gaussian| gaussian.scale[3].to_bits())
            .collect()
    }
}

fn plain(gaussians: &Gaussians, range: Range<u32>) -> Vec<PlainGaussian> {
    let of = |index: usize| PlainGaussian {
        position_opacity: gaussians.positions()[index]
            .extend(gaussians.opacities()[index])
            .into(),
        scale: gaussians.scales()[index].extend(f32::NAN).into(),
        rotation: gaussians.rotations()[index].into(),
        colour: std::array::from_fn(|c| gaussians.sh_of(index).get(c).map_or(0.0, |v| *v)),
    };
    range.map(|index| of(index as usize)).collect()
}

/// Checks the bounds of blocks against those that an upload finds: the boxes are the same, and what follows from logarithms and
/// roots is hardly larger.
fn check_blocks(found: &[Block], expected: &[Block]) {
    assert_eq!(found.len(), expected.len());
    let is_close =
        |found: f32, least: f32| found == least || found > 0.99999 * least && found < 1.002 * least;
    for (found, expected) in found.iter().zip(expected) {
        let ([lx, ly, lz, reach], [hx, hy, hz, sigma]) = (found.low_reach, found.high_sigma);
        assert_eq!([lx, ly, lz], expected.low_reach[..3], "{expected:?}");
        assert_eq!([hx, hy, hz, sigma], expected.high_sigma);
        assert!(
            is_close(reach, expected.low_reach[3]),
            "{reach}, {expected:?}"
        );
        let scale = found.spanning_scale;
        assert!(
            is_close(scale, expected.spanning_scale),
            "{scale}, {expected:?}"
        );
    }
}

/// Changes Gaussians in every way that bounds depend on.
fn changed(gaussians: &Gaussians, range: Range<u32>) -> Gaussians {
    let mut changed = gaussians.clone();
    for index in range.start as usize..range.end as usize {
        let turn = index as f32;
        changed.positions_mut()[index] += Vec3::new(turn.sin(), 0.25, -0.5 * turn.cos());
        changed.scales_mut()[index] *= 0.5 + (index % 7) as f32;
        changed.rotations_mut()[index] = Quat::from_rotation_z(turn);
        changed.opacities_mut()[index] = (index % 101) as f32 / 100.0;
    }
    changed
}

#[test]
fn bounds_are_refitted_as_an_upload_finds_them() {
    let device = testing::device();
    for (bindings, antialiased) in [
        (Bindings::Bound, false),
        (Bindings::Address, true),
        (Bindings::Mixed, true),
    ] {
        let mut gaussians = generate(Kind::General, 2_000, 1);
        gaussians.set_antialiased(antialiased);
        let mut edited = Edited::new(&device, &gaussians, ShFormat::Packed, bindings);
        let order = edited.order();
        for range in [0..2_000, 700..900, 1_999..2_000] {
            let after = changed(&gaussians, range.clone());
            let edit = LayerEdit::of(range.clone())
                .positions(true)
                .scales(true)
                .rotations(true)
                .opacities(true);
            edited.edit(&edit, &plain(&after, range));
            check_blocks(&edited.blocks(), &block_order::blocks(&after, &order));
            for (gaussian, &number) in edited.gaussians().iter().zip(&order) {
                let expected = plain(&after, number..number + 1)[0];
                assert_eq!(gaussian.position_opacity, expected.position_opacity);
                assert_eq!(gaussian.scale[..3], expected.scale[..3]);
                assert_eq!(gaussian.scale[3].to_bits(), number);
                assert_eq!(gaussian.rotation, expected.rotation);
            }
            gaussians = after;
        }
    }
    assert_eq!(device.close(), Vec::<String>::new());
}

/// A Gaussian that is not finite has to be looked at, wherever the others of its block are; one that is too faint never.
#[test]
fn what_is_no_number_leaves_its_block_open() {
    let device = testing::device();
    let gaussians = generate(Kind::General, 1_000, 1);
    let mut edited = Edited::new(&device, &gaussians, ShFormat::Half, Bindings::Address);
    let order = edited.order();
    let mut after = gaussians.clone();
    let at = |place: usize| order[place] as usize;
    after.positions_mut()[at(3)].y = f32::NAN;
    after.positions_mut()[at(300)] = Vec3::splat(f32::INFINITY);
    after.opacities_mut()[at(300)] = 0.0;
    after.scales_mut()[at(600)].z = f32::INFINITY;
    let edit = LayerEdit::of(0..1_000)
        .positions(true)
        .scales(true)
        .opacities(true);
    edited.edit(&edit, &plain(&after, 0..1_000));
    check_blocks(&edited.blocks(), &block_order::blocks(&after, &order));
    let mut faint = gaussians.clone();
    faint.opacities_mut().fill(0.003);
    edited.edit(&edit, &plain(&faint, 0..1_000));
    let blocks = edited.blocks();
    check_blocks(&blocks, &block_order::blocks(&faint, &order));
    assert_eq!(blocks[0].low_reach[3], -1.0);
    assert_eq!(device.close(), Vec::<String>::new());
}

#[test]
fn colours_are_packed_as_an_upload_packs_them() {
    let device = testing::device();
    let odd = [
        0.0,
        -0.0,
        1.0,
        -2.5,
        1e-9,
        5.9e-8,
        -6.2e-8,
        8.9e-8,
        3.1e-5,
        6.1e-5,
        6.103e-5,
        0.1,
        1.000_488_3,
        1.001_464_8,
        2049.0,
        2051.0,
        65_504.0,
        65_519.0,
        65_520.0,
        -1e30,
        f32::INFINITY,
        f32::NAN,
        f32::MIN_POSITIVE,
        1e-42,
    ];
    for format in [
        ShFormat::Float,
        ShFormat::Half,
        ShFormat::Packed,
        ShFormat::Byte,
    ] {
        for degree in 0..=3 {
            let mut gaussians = generate(Kind::General, 300, 2);
            gaussians.set_sh_degree(degree);
            let mut edited = Edited::new(&device, &gaussians, format, Bindings::Address);
            let order = edited.order();
            let numbers = 3 * sh_coefficients(degree);
            for (is_flat, range) in [(false, 40..200), (true, 100..300)] {
                for index in range.clone() {
                    let sh = &mut gaussians.sh_mut()[index as usize * numbers..][..numbers];
                    if is_flat {
                        sh.fill(0.0);
                    }
                    for (c, to) in sh[..3].iter_mut().enumerate() {
                        *to = odd[(index as usize + 5 * c) % odd.len()];
                    }
                }
                let edit = LayerEdit::of(range.clone()).colours(true).flat(is_flat);
                edited.edit(&edit, &plain(&gaussians, range));
                let words = sh_storage::words(format, numbers);
                let found = edited.read::<u32>(&edited.scene.sh, 300 * words);
                for (found, &number) in found.chunks(words).zip(&order) {
                    let mut expected = Vec::new();
                    sh_storage::pack(format, gaussians.sh_of(number as usize), &mut expected);
                    let sh = &gaussians.sh_of(number as usize)[..3];
                    assert_eq!(found, expected, "{format:?}, degree {degree}, {sh:?}");
                }
            }
        }
    }
    assert_eq!(device.close(), Vec::<String>::new());
}
