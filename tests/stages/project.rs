//! Stage `project`: place, shape and colour of each splat.

use glam::{DMat4, Quat, Vec3};
use rara::{Camera, Clip, Gaussians, Projection, Raster, Settings, ShFormat};
use rara_reference::{ViewTransform, harmonics, project, vec3};

use crate::stages::frame::{self, Stages};
use crate::stages::ties::{largest, ulps};

/// How far apart device and twin are, each in units in the last place of what it was computed from.
#[derive(Debug, Default, Clone, Copy)]
struct Apart {
    depth: f32,
    centre: f32,
    shape: f32,
    colour: f32,
    /// Of antialiased Gaussians; others have their own.
    opacity: f32,
}

#[test]
fn splats_are_the_twins() {
    let mut worst = Apart::default();
    frame::for_each_scene(|stages, scene| {
        for camera in frame::views(scene) {
            stages.draw(&camera, &Clip::default(), &quads());
            if !scene.is_empty() {
                compare(stages, &camera, &mut worst);
            }
        }
    });
    println!("{worst:?}");
    // Sums of three products, and what a division and a root add.
    assert!(worst.depth <= 4.0, "{worst:?}");
    assert!(worst.centre <= 16.0, "{worst:?}");
    assert!(worst.shape <= 16.0, "{worst:?}");
    assert!(worst.colour <= 16.0, "{worst:?}");
}

/// Gaussians around a pixel's size, so that what makes up for the low-pass is anything from nearly nothing to one.
#[test]
fn opacities_of_antialiased_gaussians_are_the_twins() {
    let mut scene = frame::scene(3_000);
    for (index, scale) in scene.scales_mut().iter_mut().enumerate() {
        *scale *= [1.0, 0.3, 0.03][index % 3];
    }
    scene.set_antialiased(true);
    let mut stages = Stages::new();
    stages.load(&scene);
    let mut worst = Apart::default();
    for camera in frame::views(&scene) {
        stages.draw(&camera, &Clip::default(), &quads());
        compare(&mut stages, &camera, &mut worst);
    }
    println!("{worst:?}");
    assert!(worst.opacity <= 16.0 && worst.shape <= 16.0, "{worst:?}");
}

fn quads() -> Settings {
    Settings::default().raster(Raster::Quad)
}

fn compare(stages: &mut Stages, camera: &Camera, worst: &mut Apart) {
    let view = ViewTransform::<f32>::new(camera);
    let splat_gaussians = stages.splat_gaussians();
    let numbers = stages.numbers_in_view(splat_gaussians.len());
    let splats = stages.splats();
    for ((splat, number), [index, _]) in splats.iter().zip(numbers).zip(splat_gaussians) {
        let index = index as usize;
        let Some(twin) = project::project(&stages.scene, index, &view, &quads()) else {
            continue; // a tie of stage classify
        };
        assert_eq!(number, stages.numbers[index]);
        let [cx, cy, k0, k1] = splat.centre_conic;
        let [k2, opacity, z, _] = splat.conic_cut;
        let opaque = stages.scene.opacities()[index];
        if stages.scene.is_antialiased() {
            // The determinant's root has the shape's condition.
            let gradients = twin.footprint.gradients;
            let condition = condition(gradients.b.map(|b| Vec3::new(b.x, b.y, b.z)));
            let apart = ulps(opacity, twin.footprint.opacity, opaque) / condition;
            worst.opacity = worst.opacity.max(apart);
        } else {
            assert_eq!(opacity, opaque);
        }
        assert!(z > 1e30, "nothing is cut");
        let f = &twin.footprint;
        let distance = f.relative.largest();
        worst.depth = worst
            .depth
            .max(ulps(splat.curvature_depth[3], f.view_centre.z, distance));
        // A pixel's place follows from a slope, which is off by the centre's error over the depth.
        for (ours, axis) in [(cx, 0), (cy, 1)] {
            let slope = (f.screen_centre[axis] - view.principal[axis]) / view.focal[axis];
            let size = match view.projection {
                Projection::Orthographic => view.focal[axis] * distance,
                _ => view.focal[axis] * distance / f.view_centre.z * (1.0 + slope.abs()),
            };
            worst.centre = worst.centre.max(ulps(ours, f.screen_centre[axis], size));
        }
        // The factors' rounding, against the cancellation that the twin in double precision finds.
        let [t0, t1, t2] = f.conic;
        let size = t1.hypot(t2);
        let condition = condition(f.gradients.b.map(|b| Vec3::new(b.x, b.y, b.z)));
        let of = |ours, theirs, size| ulps(ours, theirs, size) / condition;
        let shape = of(k0, t0, 0.0).max(of(k1, t1, size)).max(of(k2, t2, 0.0));
        worst.shape = worst.shape.max(shape);
        let basis = basis_at(view.direction(f.relative));
        for channel in 0..3 {
            let terms = stages.scene.sh_of(index).iter().skip(channel).step_by(3);
            let sizes = terms.zip(basis).map(|(c, basis)| (c * basis).abs());
            let size = 0.5 + sizes.sum::<f32>();
            let apart = ulps(splat.colour_cut[channel], twin.colour[channel], size);
            worst.colour = worst.colour.max(apart);
        }
    }
}

fn basis_at(direction: rara_reference::Vec3<f32>) -> [f32; 16] {
    harmonics::basis(direction * (1.0 / direction.length()))
}

/// How much more than single precision's rounding the footprint's gradients carry into its shape: the low-pass is 0.3
/// square pixels, whatever the gradients' length.
fn condition([b1, b2]: [Vec3; 2]) -> f32 {
    let size = largest(b1).max(largest(b2));
    1.0 + size
}

/// The sixteen basis functions of 3DGS in the direction (2, -3, 6) / 7, from the definition of the associated Legendre
/// polynomials with the Condon-Shortley phase, orders -l to l, in rational arithmetic, not from any formula here.
const OBLIQUE: [f64; 16] = [
    0.282_094_791_773_878_1,
    0.209_401_076_529_822_8,
    0.418_802_153_059_645_6,
    -0.139_600_717_686_548_6,
    -0.133_781_440_480_662_8,
    0.401_344_321_441_988_3,
    0.379_757_190_814_258_8,
    -0.267_562_880_961_325_6,
    -0.055_742_266_866_942_8,
    0.015_482_193_321_690_4,
    -0.303_387_789_898_134,
    0.523_670_551_572_988_5,
    0.215_419_573_914_993_8,
    -0.349_113_701_048_659,
    -0.126_411_579_124_222_5,
    0.079_131_210_310_861_8,
];

#[test]
fn the_harmonics_are_those_of_3dgs() {
    let way = vec3(2.0_f64, -3.0, 6.0) * (1.0 / 7.0);
    for (index, (ours, literal)) in harmonics::basis(way).into_iter().zip(OBLIQUE).enumerate() {
        assert!((ours - literal).abs() < 1e-12, "{index}: {ours}, {literal}");
    }
    let mut stages = Stages::new();
    for (index, literal) in OBLIQUE.into_iter().enumerate() {
        let mut scene = frame::one(
            Vec3::new(2.0, -3.0, 6.0),
            Vec3::splat(0.1),
            Quat::IDENTITY,
            0.9,
        );
        scene.set_sh_degree(3);
        scene.sh_mut().fill(0.0);
        // Red grows with the function, green falls; both stay above 0.
        scene.sh_mut()[3 * index] = 0.25;
        scene.sh_mut()[3 * index + 1] = -0.25;
        stages.load(&scene);
        stages.draw(&ahead(), &Clip::default(), &quads());
        let [red, green, blue, _] = stages.splats()[0].colour_cut.map(f64::from);
        let want = 0.25 * literal;
        assert!((red - 0.5 - want).abs() < 3e-7, "{index}: red {red}");
        assert!((green - 0.5 + want).abs() < 3e-7, "{index}: green {green}");
        assert_eq!(blue, 0.5);
        let picture = stages.headless.picture().expect("reads back");
        let pixels = picture.pixels.iter().filter(|pixel| pixel[3] > 0.5);
        let shown: Vec<_> = pixels.map(|[r, _, _, a]| f64::from(r / a)).collect();
        assert!(!shown.is_empty());
        assert!(
            shown.iter().all(|r| (r - 0.5 - want).abs() < 1e-6),
            "{index}"
        );
    }
}

/// A view from the origin along z, wide enough for what is well beside its axis.
fn ahead() -> Camera {
    Camera::from_world_to_camera(DMat4::IDENTITY, (40.0, 40.0, 48.0, 48.0), (96, 96))
        .expect("a camera at the origin")
}

/// Coefficients that a format holds exactly are read as they are: the format's integers, its scales, and where each lies.
#[test]
fn stored_harmonics_are_read_as_they_were() {
    let mut stages = Stages::new();
    let scales = [0.015_625_f32, 2.0, 0.000_488_281_25]; // of degrees 1, 2 and 3: powers of two, far apart
    for degree in [1, 2, 3] {
        for format in [
            ShFormat::Float,
            ShFormat::Half,
            ShFormat::Packed,
            ShFormat::Byte,
        ] {
            let mut scene = Gaussians::default();
            for place in 0..5 {
                let at = Vec3::new(place as f32 - 2.0, 0.3 * place as f32, 5.0);
                scene.append(&frame::one(at, Vec3::splat(0.1), Quat::IDENTITY, 0.9));
            }
            scene.set_sh_degree(degree);
            let stride = 3 * scene.sh_coefficients();
            for (k, value) in scene.sh_mut().iter_mut().enumerate() {
                let (number, channel) = (k % stride / 3, k % 3);
                let at = (k * 7919 % 401) as f32 - 200.0;
                let scale = scales[[0, 0, 1, 2][(number as f32).sqrt() as usize]];
                // The largest coefficient of a degree sets its scale.
                let is_first = [1, 4, 9].contains(&number) && channel == 0;
                *value = match format {
                    _ if number == 0 => 0.5 + at / 1024.0,
                    ShFormat::Half => at / 1024.0,
                    ShFormat::Byte if number == 1 && channel == 0 => 1.5,
                    ShFormat::Byte => 1.5 * (at / 2.0).trunc() / 127.0,
                    _ if is_first => scale,
                    _ => scale * at / if channel == 2 { 511.0 } else { 1023.0 },
                };
            }
            stages.load_as(&scene, format);
            stages.draw(&ahead(), &Clip::default(), &quads());
            let mut worst = Apart::default();
            compare(&mut stages, &ahead(), &mut worst);
            assert_eq!(stages.splats().len(), 5);
            assert!(
                worst.colour <= 16.0,
                "{format:?}, degree {degree}: {worst:?}"
            );
        }
    }
}

/// The quad covers the contour on which alpha falls to 1/255, and is hardly larger than the smallest rectangle around it.
#[test]
fn quads_are_the_contours_rectangles() {
    let mut stages = Stages::new();
    let scene = frame::scene(50_000);
    stages.load(&scene);
    for camera in frame::views(&scene) {
        stages.draw(&camera, &Clip::default(), &quads());
        let splats = stages.splats();
        for (splat, quad) in splats.iter().zip(stages.quads(splats.len())) {
            let [_, _, k0, k1] = splat.centre_conic.map(f64::from);
            let [k2, opacity, ..] = splat.conic_cut.map(f64::from);
            let extent = (2.0 * (255.0 * opacity).max(1.0).ln()).sqrt();
            let [ax, ay] = quad.first.map(f64::from);
            let [bx, by] = quad.second.map(f64::from);
            let [mx, my] = quad.middle.map(f64::from);
            let (a, b) = (ax.hypot(ay), bx.hypot(by));
            for step in 0..32 {
                let turn = f64::from(step) / 32.0 * std::f64::consts::TAU;
                // On the contour: u = k0 dx and v = k1 dx + k2 dy lie on a circle.
                let dx = extent * turn.cos() / k0;
                let dy = (extent * turn.sin() - k1 * dx) / k2;
                let s = ((dx - mx) * ax + (dy - my) * ay) / (a * a);
                let t = ((dx - mx) * bx + (dy - my) * by) / (b * b);
                assert!(
                    s.abs() <= 1.0 && t.abs() <= 1.0,
                    "{s} {t}: {splat:?} {quad:?}"
                );
            }
            if mx == 0.0 && my == 0.0 {
                // The area of the ellipse's rectangle is 4 K^2 over the factors' determinant.
                let least = extent * extent / (k0 * k2);
                assert!(a * b >= least, "{splat:?}");
                let most = 1.003 * least + 0.05 * (a + b);
                assert!(a * b <= most, "{} against {least}: {splat:?}", a * b);
            }
        }
    }
}
