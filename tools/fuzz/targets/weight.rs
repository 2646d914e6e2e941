//! Any Gaussian that a loader may hand out, any planes, any camera: the reference's weights are shares and its alphas
//! opacities, in double and in single precision.
#![no_main]

use glam::{DMat4, DQuat, DVec3, Quat, Vec3, Vec4};
use libfuzzer_sys::fuzz_target;
use rara_reference::{Footprint, Real, ViewTransform, cutoff, project, splat};
use rara::{
    Camera, Clip, ClipOp, ExactForm, Gaussians, Miss, Mode, Plane, Projection, Settings,
};

/// Numbers from the input, and zeros once it is used up.
struct Numbers<'a>(&'a [u8]);

impl Numbers<'_> {
    fn byte(&mut self) -> u8 {
        self.0.split_off_first().copied().unwrap_or_default()
    }

    fn f32(&mut self) -> f32 {
        f32::from_le_bytes([0; 4].map(|_: u8| self.byte()))
    }

    fn vec3(&mut self) -> Vec3 {
        Vec3::new(self.f32(), self.f32(), self.f32())
    }
}

fn scene(numbers: &mut Numbers) -> Option<Gaussians> {
    let (position, scale) = (numbers.vec3(), numbers.vec3().abs());
    let rotation = Vec4::from((numbers.vec3(), numbers.f32())).as_dvec4();
    let opacity = numbers.f32().abs().fract();
    let largest = rotation.abs().max_element();
    let finite = position.is_finite() && scale.is_finite() && rotation.is_finite();
    if !finite || largest == 0.0 || !opacity.is_finite() {
        return None;
    }
    let rotation = Quat::from_vec4((rotation / largest).normalize().as_vec4());
    let mut scene = Gaussians::default();
    scene.push(position, scale, rotation, opacity, &[1.0; 3]);
    Some(scene)
}

fn camera(numbers: &mut Numbers) -> Option<Camera> {
    let turn = DQuat::from_euler(
        glam::EulerRot::XYZ,
        f64::from(numbers.byte()) / 40.0,
        f64::from(numbers.byte()) / 40.0,
        0.0,
    );
    let (eye, focal) = (numbers.vec3().as_dvec3(), f64::from(numbers.f32().abs()));
    let matrix = DMat4::from_quat(turn) * DMat4::from_translation(-eye);
    Camera::from_world_to_camera(matrix, (focal, focal, 32.0, 24.0), (64, 48)).ok()
}

fn settings(choice: u8) -> Settings {
    let form =
        [ExactForm::Auto, ExactForm::Beam, ExactForm::Affine][usize::from(choice & 3).min(2)];
    let miss = [Miss::Keep, Miss::Drop, Miss::Peak][usize::from((choice >> 2) & 3).min(2)];
    Settings::default()
.mode(if choice & 16 == 0 {
            Mode::Exact
        } else {
            Mode::Rara
        })
.form(form)
.miss(miss)
.trace_all(choice & 32 != 0)
}

fn check<T: Real>(scene: &Gaussians, camera: &Camera, clip: &Clip, settings: &Settings) {
    let view = ViewTransform::<T>::new(camera);
    let Some(mut splat) = project::project(scene, 0, &view, settings) else {
        return;
    };
    splat.cut = cutoff::cutoff(scene, 0, &splat.footprint, &view, clip, settings);
    let footprint: &Footprint<T> = &splat.footprint;
    assert!(footprint.conic.iter().all(|k| k.is_finite()));
    let [x, y] = footprint.screen_centre.map(T::wide);
    // The pixel nearest to the centre, and one some way off.
    let nearest = [
        x.clamp(0.0, 63.0).floor() + 0.5,
        y.clamp(0.0, 47.0).floor() + 0.5,
    ];
    for pixel in [nearest, [0.5, 0.5], [40.5, 30.5]] {
        let (dx, dy) = (
            T::of(pixel[0]) - footprint.screen_centre[0],
            T::of(pixel[1]) - footprint.screen_centre[1],
        );
        let falloff = footprint.power(dx, dy).wide();
        let Some(alpha) = splat::alpha(&splat, dx, dy, settings.decay_law()) else {
            continue;
        };
        let alpha = alpha.wide();
        assert!(
            (0.0..=0.990_001).contains(&alpha),
            "{alpha} at {pixel:?}, {falloff}: {splat:?}"
        );
        if let Some(cut) = &splat.cut {
            let w = cut.weight(dx, dy).wide();
            assert!((0.0..=1.0).contains(&w), "{w} at {pixel:?}: {splat:?}");
        }
    }
}

fuzz_target!(|bytes: &[u8]| {
    let mut numbers = Numbers(bytes);
    let choice = numbers.byte();
    let Some(scene) = scene(&mut numbers) else {
        return;
    };
    let Some(camera) = camera(&mut numbers) else {
        return;
    };
    let camera = camera.projection(match choice & 128 {
        0 => Projection::Perspective,
        _ => Projection::Orthographic,
    });
    let mut planes = Vec::new();
    while planes.len() < 4 && !numbers.0.is_empty() {
        let (normal, offset): (DVec3, f64) = (numbers.vec3().as_dvec3(), numbers.f32().into());
        planes.extend(Plane::new(normal, offset));
    }
    let op = if choice & 64 == 0 {
        ClipOp::And
    } else {
        ClipOp::Or
    };
    let (clip, settings) = (Clip::of(planes, op), settings(choice));
    check::<f64>(&scene, &camera, &clip, &settings);
    check::<f32>(&scene, &camera, &clip, &settings);
});
