//! Stage `cutoff`: the records of the cut splats, by which pixels weigh them.

use glam::Vec3;
use rara::{Camera, Clip, ClipOp, ExactForm, Mode, Raster, Settings};
use rara_reference::{
    Footprint, HalfSpace, Real, SplatCut, Vec3 as Vector, ViewTransform, cutoff, vec3,
};

use crate::stages::frame::{self, Stages};

/// The flags of a record: the planes are on each pixel's line of sight; the splat reaches behind the eye; a plane's z is
/// a polynomial; the planes are the complements of a union's.
const BEAM: u32 = 1;
const FRONT: u32 = 2;
const CURVE: u32 = 4;
const UNION: u32 = 8;

/// How far apart device and twin are.
#[derive(Debug, Default, Clone, Copy)]
struct Apart {
    /// In a plane's distance, deviations, where a pixel sees something of it.
    z: f64,
    /// In the records' gradients and planes, as shares of the largest component.
    gradients: f32,
    planes: f32,
    /// In the alpha of fitted curves.
    curves: f64,
    /// How many records there are of each kind: carried, curves, beams, beams before the eye.
    kinds: [usize; 4],
    /// How many records of intersections and of unions had their planes compared, and how many hold another number of
    /// them.
    compared: [usize; 2],
    other: usize,
}

#[test]
fn records_are_the_twins() {
    let mut worst = Apart::default();
    let mut rounding = 32.0;
    frame::for_each_scene(|stages, scene| {
        // A division on a GPU may be 2.5 units in the last place off, where a CPU's is half a unit.
        rounding = if stages.is_cpus() { 32.0 } else { 48.0 };
        for camera in frame::views(scene) {
            for (mode, form, planes, op) in [
                (Mode::Exact, ExactForm::Affine, 1, ClipOp::And),
                (Mode::Exact, ExactForm::Affine, 3, ClipOp::Or),
                (Mode::Exact, ExactForm::Beam, 3, ClipOp::And),
                (Mode::Exact, ExactForm::Beam, 3, ClipOp::Or),
                (Mode::Exact, ExactForm::Auto, 1, ClipOp::And),
                (Mode::Rara, ExactForm::Auto, 2, ClipOp::And),
                (Mode::Rara, ExactForm::Auto, 2, ClipOp::Or),
            ] {
                let settings = Settings::default()
                    .mode(mode)
                    .form(form)
                    .raster(Raster::Quad);
                let clip = frame::clip(scene, planes, op);
                let counts = stages.draw(&camera, &clip, &settings).counts;
                if counts.cutoff > 0 {
                    compare(stages, &camera, &clip, &settings, &mut worst);
                }
            }
        }
    });
    println!("{worst:?}");
    // A ten-thousandth of a deviation is a hundredth of a level of 8 bits.
    assert!(worst.z <= 1e-4, "{worst:?}");
    assert!(worst.gradients <= rounding * f32::EPSILON, "{worst:?}");
    assert!(worst.planes <= 32.0 * f32::EPSILON, "{worst:?}");
    // Twice the fit's tolerance: pixels lie between its samples.
    assert!(worst.curves <= 3e-4, "{worst:?}");
    assert!(worst.kinds.iter().all(|&count| count > 20), "{worst:?}");
    assert!(worst.compared.iter().all(|&count| count > 100), "{worst:?}");
    // A plane at the edge of the band may cut in only one of the two.
    let all = worst.compared[0] + worst.compared[1];
    assert!(worst.other <= 1 + all / 1_000, "{worst:?}");
}

fn compare(
    stages: &mut Stages,
    camera: &Camera,
    clip: &Clip,
    settings: &Settings,
    worst: &mut Apart,
) {
    let records: Vec<[f32; 4]> = stages.read("cut_records");
    let stride = 4 + clip.surfaces.len();
    let cut = stages.counts().cutoff as usize;
    let cutoffs: Vec<u32> = stages.read("cutoffs");
    let (single, double) = (
        ViewTransform::<f32>::new(camera),
        ViewTransform::<f64>::new(camera),
    );
    for (record, index) in records.chunks(stride).zip(&cutoffs[..cut]) {
        let index = *index as usize;
        let Some(footprint) = Footprint::new(&stages.scene, index, &single) else {
            continue; // a tie of stage classify
        };
        let twin = cutoff::cutoff(&stages.scene, index, &footprint, &single, clip, settings);
        let Some(twin) = twin else { continue };
        // Along true rays a record's gradients are those of a pixel on the principal axis.
        let aside = [0, 1].map(|axis| footprint.screen_centre[axis] - single.principal[axis]);
        let flags = record[0][3] as u32;
        let count = (flags >> 8) as usize;
        let is_alone = count == 1 && settings.mode == Mode::Exact && flags & FRONT == 0;
        let is_union = clip.op == ClipOp::Or && clip.surfaces.len() > 1 && !is_alone;
        assert_eq!(flags & UNION != 0, is_union, "{index}: flags {flags}");
        match (&twin, flags & (BEAM | CURVE)) {
            (SplatCut::Affine { planes, .. }, 0) => {
                assert!(planes.len() == 1 && count == 1);
                worst.kinds[0] += 1;
                assert_eq!(record[4], [0.0; 4], "no curvature");
                compare_z(&record[3], planes[0].z, &footprint, worst);
            }
            (SplatCut::Affine { planes, .. }, BEAM) => {
                if planes.len() == count {
                    worst.kinds[2] += 1;
                    let still = vec3(0.0, 0.0, 0.0);
                    compare_rays(record, footprint.gradients.b, still, [0.0; 2], worst);
                }
            }
            (SplatCut::Beam(beam), BEAM) => {
                assert_eq!(beam.front.is_some(), flags & FRONT != 0, "{index}");
                worst.kinds[2 + usize::from(flags & FRONT != 0)] += 1;
                compare_rays(record, beam.gradients.b, beam.lean, aside, worst);
                compare_planes(&record[3..], (count, is_union), &beam.half_spaces, worst);
                if let Some(front) = &beam.front {
                    let front = std::slice::from_ref(front);
                    compare_planes(&record[3 + count..], (1, false), front, worst);
                }
            }
            (SplatCut::Chord(chord), BEAM) => {
                let lean = chord.lean;
                compare_rays(record, chord.gradients, lean, aside, worst);
                compare_planes(&record[3..], (count, is_union), &chord.half_spaces, worst);
            }
            (SplatCut::Beam(_), _) => {
                worst.kinds[usize::from(flags & CURVE != 0)] += 1;
                let Some(truth) = Footprint::new(&stages.scene, index, &double) else {
                    continue;
                };
                let exact = cutoff::cutoff(&stages.scene, index, &truth, &double, clip, settings);
                if let Some(exact) = exact {
                    compare_curve(record, flags, &truth, &exact, worst);
                }
            }
            (twin, kind) => panic!("{index}: a record of kind {kind} for {twin:?}"),
        }
    }
}

/// Offsets within the contour of 1/255, in pixels and in deviations.
fn within<T: Real>(f: &Footprint<T>) -> impl Iterator<Item = ([f64; 2], [f64; 2])> {
    let [k0, k1, k2] = f.conic.map(T::wide);
    let reach = f.extent.wide();
    (0..25).map(move |step| {
        let turn = f64::from(step) * 2.399_963;
        let r = reach * (f64::from(step) / 24.0).sqrt();
        let (u, v) = (r * turn.cos(), r * turn.sin());
        let dx = u / k0;
        ([dx, (v - k1 * dx) / k2], [u, v])
    })
}

fn compare_z(ours: &[f32; 4], theirs: [f32; 3], f: &Footprint<f32>, worst: &mut Apart) {
    for ([dx, dy], _) in within(f) {
        let at = |z: [f32; 3]| {
            let [z0, zx, zy] = z.map(f64::from);
            z0 + zx * dx + zy * dy
        };
        let (ours, theirs) = (at([ours[0], ours[1], ours[2]]), at(theirs));
        // Beyond six deviations all or nothing is left.
        if ours.abs().min(theirs.abs()) < 6.0 {
            worst.z = worst.z.max((ours - theirs).abs());
        }
    }
}

fn compare_rays(
    record: &[[f32; 4]],
    gradients: [Vector<f32>; 2],
    lean: Vector<f32>,
    aside: [f32; 2],
    worst: &mut Apart,
) {
    let scale = record[1][3];
    let rows = [
        (gradients[0], aside[0]),
        (gradients[1], aside[1]),
        (lean, 0.0),
    ];
    for (ours, (gradient, aside)) in record.iter().zip(rows) {
        let ours = Vec3::new(ours[0], ours[1], ours[2]) / scale;
        let twin = gradient + lean * aside;
        let apart = (ours - Vec3::new(twin.x, twin.y, twin.z))
            .abs()
            .max_element();
        let size = gradient.largest() + lean.largest() * aside.abs();
        worst.gradients = worst.gradients.max(apart / size.max(f32::MIN_POSITIVE));
    }
    let low_pass = 0.3 * scale * scale;
    assert!((record[2][3] - low_pass).abs() <= 4.0 * f32::EPSILON * low_pass);
}

fn compare_planes(
    records: &[[f32; 4]],
    (count, is_union): (usize, bool),
    planes: &[HalfSpace<f32>],
    worst: &mut Apart,
) {
    if planes.len() != count {
        worst.other += 1;
        return;
    }
    worst.compared[usize::from(is_union)] += 1;
    let sign = if is_union { -1.0 } else { 1.0 };
    for (&[x, y, z, distance], plane) in records.iter().zip(planes) {
        let size = plane.normal.largest();
        if size > 0.0 {
            let ours = sign * Vec3::new(x, y, z);
            let twin = Vec3::new(plane.normal.x, plane.normal.y, plane.normal.z) / size;
            let apart = (ours - twin).abs().max_element();
            let offset = plane.offset / size;
            let far = (sign * distance - offset).abs() / offset.abs().max(1.0);
            worst.planes = worst.planes.max(apart).max(far);
        }
    }
}

fn compare_curve(
    record: &[[f32; 4]],
    flags: u32,
    f: &Footprint<f64>,
    exact: &SplatCut<f64>,
    worst: &mut Apart,
) {
    let wide = |row: usize| record[row].map(f64::from);
    for ([dx, dy], [u, v]) in within(f) {
        let z = if flags & CURVE == 0 {
            let ([z, zx, zy, _], [xx, xy, yy, _]) = (wide(3), wide(4));
            z + zx * dx + zy * dy + xx * dx * dx + xy * dx * dy + yy * dy * dy
        } else {
            let ([at, su, sv, _], [uu, uv, vv, vvvv]) = (wide(0), wide(1));
            let ([uuu, uuv, uvv, vvv], [uuuu, uuuv, uuvv, uvvv]) = (wide(2), wide(3));
            let square = uu * u * u + uv * u * v + vv * v * v;
            let cube = uuu * u.powi(3) + uuv * u * u * v + uvv * u * v * v + vvv * v.powi(3);
            let fourth = uuuu * u.powi(4) + uuuv * u.powi(3) * v + uuvv * u * u * v * v;
            at + su * u + sv * v + square + cube + fourth + uvvv * u * v.powi(3) + vvvv * v.powi(4)
        };
        let alpha = f.opacity * (-0.5 * (u * u + v * v)).exp();
        let apart = alpha * (z.phi() - exact.weight(dx, dy)).abs();
        worst.curves = worst.curves.max(apart);
    }
}
