//! Several layers, stage by stage: each layer gives what it gives alone.

use glam::{DQuat, DVec3};
use rara::types::Splat;
use rara::{ClipOp, Layer, LayerState, Mode, Placement, Raster, Scene, Settings, ShFormat};

use crate::stages::frame::{self, Stages};

/// Placements by powers of two, which round no number.
pub fn placements() -> [Placement; 3] {
    let turn = DQuat::from_axis_angle(DVec3::new(0.3, 0.9, -0.2).normalize(), 0.4);
    let at = |shift: DVec3, turn, scale| Placement::new(shift, turn, scale).expect("a placement");
    [
        at(DVec3::new(0.1, 0.0, -0.2), turn, 0.5),
        Placement::IDENTITY,
        at(DVec3::new(0.0, 0.3, 0.2), turn.inverse(), 2.0),
    ]
}

/// A frame's splats: number in the scene, splat, and the whole cutoff record of a cut one.
fn frame_splats(stages: &mut Stages, stride: usize) -> Vec<(u32, Splat, Vec<[f32; 4]>)> {
    let records: Vec<[f32; 4]> = stages.read("cut_records");
    let splat_gaussians = stages.splat_gaussians();
    let splats = stages.splats();
    let numbers = stages.numbers_in_view(splats.len());
    let both = splat_gaussians.iter().zip(numbers.into_iter().zip(splats));
    both.map(|([_, cut], (number, splat))| {
        let record = match *cut as usize {
            cut if cut < records.len() => records[cut * stride..][..stride].to_vec(),
            _ => Vec::new(),
        };
        (number, splat, record)
    })
    .collect()
}

#[test]
fn each_layers_splats_and_records_are_those_of_the_layer_alone() {
    let mut stages = Stages::new();
    let parts = [300, 257, 2_000].map(frame::scene);
    let states = placements().map(|placement| LayerState::default().placement(placement));
    let layers = parts.iter().zip(states);
    let scene: Scene<'_> = layers
        .map(|(part, state)| Layer::new("part", part).with(state))
        .collect();
    let whole = frame::scene(2_000);
    let mut cut = 0;
    for camera in frame::views(&whole) {
        for (mode, planes, op) in [
            (Mode::None, 0, ClipOp::And),
            (Mode::Exact, 1, ClipOp::And),
            (Mode::Exact, 3, ClipOp::Or),
            (Mode::Rara, 2, ClipOp::And),
        ] {
            let clip = frame::clip(&whole, planes, op);
            let settings = Settings::default().mode(mode).raster(Raster::Quad);
            stages
                .headless
                .load_as(scene.clone(), ShFormat::Float)
                .expect("uploads");
            stages.draw(&camera, &clip, &settings);
            let stride = 4 + planes;
            let together = frame_splats(&mut stages, stride);
            let mut first = 0;
            let mut from = 0;
            for (part, state) in parts.iter().zip(&states) {
                let (placement, unit) = (state.placement, state.placement.scale() as f32);
                let end = first + part.len() as u32;
                let own = together[from..]
                    .iter()
                    .take_while(|(number, ..)| (first..end).contains(number));
                let own: Vec<_> = own.collect();
                from += own.len();
                stages.headless.load(part).expect("uploads");
                stages.draw(
                    &camera.in_scene(&placement),
                    &clip.in_scene(&placement),
                    &settings,
                );
                let alone = frame_splats(&mut stages, stride);
                let mut alone = alone.into_iter().filter(|(_, splat, _)| {
                    // The near cut is at a fifth of the scene's units, not of the layer's.
                    unit * splat.curvature_depth[3] >= 0.2
                });
                for (number, splat, record) in own {
                    if splat.curvature_depth[3] / unit < 0.2 {
                        continue;
                    }
                    let (its, mut as_alone, its_record) = alone.next().expect("as many survive");
                    assert_eq!(*number, first + its, "in the order of the scene");
                    as_alone.curvature_depth[3] *= unit;
                    if splat.conic_cut[2] < -1e30 {
                        // This is the record's number, which counts the layers before.
                        as_alone.conic_cut[2] = splat.conic_cut[2];
                    }
                    let bytes = |splat: &Splat| bytemuck::bytes_of(splat).to_vec();
                    assert!(bytes(splat) == bytes(&as_alone), "{splat:?} {as_alone:?}");
                    assert_eq!(record.is_empty(), its_record.is_empty());
                    cut += usize::from(!record.is_empty());
                    if let Some(&[.., flags]) = record.first() {
                        // A record with lines of sight or a curve has a header, and behind it an entry for each
                        // surface.
                        let (flags, is_carried) = (flags as u32, flags as u32 & 0xff == 0);
                        let header = if is_carried { 3.. } else { 0.. };
                        let used = header.start..3 + (flags >> 8) as usize;
                        assert_eq!(record[used.clone()], its_record[used], "{number}");
                    }
                }
                assert!(alone.next().is_none(), "as many survive");
                first = end;
            }
            assert_eq!(from, together.len(), "every splat is a layer's");
        }
    }
    assert!(cut > 500, "{cut} were cut");
}
