//! Properties of every splat, plane and pixel, however odd.

use super::*;
use proptest::prelude::*;
use rara_scene::settings::{ExactForm, Miss};

/// A cut splat, a pixel and the way it is weighted.
#[derive(Debug, Clone)]
pub(super) struct Case {
    pub(super) one: One,
    /// Normals and distances from the centre in deviations of the splat along them.
    pub(super) planes: Vec<(DVec3, f64)>,
    pub(super) op: ClipOp,
    pub(super) settings: Settings,
    pub(super) projection: Projection,
    /// The pixel's offset from the centre, deviations of the footprint.
    pub(super) offset: [f64; 2],
}

pub(super) fn directions() -> impl Strategy<Value = DVec3> {
    let axis = (0..3_usize, any::<bool>())
        .prop_map(|(i, up)| DVec3::AXES[i] * if up { 1.0 } else { -1.0 });
    let any = [-1.0..1.0, -1.0..1.0, -1.0..1.0_f64];
    let any = any
        .prop_map(DVec3::from)
        .prop_filter_map("a direction", DVec3::try_normalize);
    prop_oneof![1 => axis, 3 => any]
}

pub(super) fn splats() -> impl Strategy<Value = One> {
    // Needles, pancakes, points; on the axis, at the edge of the view, about the eye.
    let scale =
        prop_oneof![1 => Just(0.0_f32), 9 => (-6.0..2.0_f32).prop_map(|e| 10.0_f32.powf(e))];
    let scale = [scale.clone(), scale.clone(), scale];
    let position = [-0.35..0.35_f32, -0.35..0.35_f32, -0.6..2.0_f32];
    let rotation = (directions(), -3.2..3.2_f64)
        .prop_map(|(axis, angle)| Quat::from_axis_angle(axis.as_vec3(), angle as f32));
    (position, scale, rotation, 0.005..1.0_f32).prop_map(
        |([x, y, depth], scale, rotation, opacity)| {
            let z = 10.0_f32.powf(depth);
            One {
                position: [x * z, y * z, z],
                scale,
                rotation: rotation.normalize(),
                opacity,
                ..One::default()
            }
        },
    )
}

fn settings() -> impl Strategy<Value = Settings> {
    let exact = prop::sample::select(vec![ExactForm::Auto, ExactForm::Beam, ExactForm::Affine])
        .prop_map(|form| mode(Mode::Exact).form(form));
    let rara = (
        prop::sample::select(vec![Miss::Keep, Miss::Drop, Miss::Peak]),
        0.5..4.0_f32,
    )
        .prop_map(|(miss, sigma)| mode(Mode::Rara).miss(miss).sigma(sigma));
    prop_oneof![2 => exact, 1 => rara].prop_map(|settings| settings.trace_all(true))
}

pub(super) fn cases(planes: impl Into<prop::collection::SizeRange>) -> impl Strategy<Value = Case> {
    let planes = prop::collection::vec((directions(), -4.0..4.0_f64), planes);
    let op = prop::sample::select(vec![ClipOp::And, ClipOp::Or]);
    let offset = [-3.0..3.0_f64, -3.0..3.0_f64];
    let projection = prop::sample::select(vec![Projection::Perspective, Projection::Orthographic]);
    (splats(), planes, op, settings(), projection, offset).prop_map(
        |(one, planes, op, settings, projection, offset)| Case {
            one,
            planes,
            op,
            settings,
            projection,
            offset,
        },
    )
}

impl Case {
    pub(super) fn planes(&self) -> Vec<Plane> {
        let through = |(normal, deviations): &(DVec3, f64)| {
            let normal = *normal;
            let plane = plane_through(&self.one, normal, *deviations);
            // A point has no deviations: move the plane by world units instead.
            if self.one.scale == [0.0; 3] {
                Plane::new(normal, plane.offset() + deviations).unwrap()
            } else {
                plane
            }
        };
        self.planes.iter().map(through).collect()
    }

    /// The weight under other planes; nothing if the splat is out of view.
    pub(super) fn weight<T: Real>(&self, planes: &[Plane]) -> Option<f64> {
        self.cut::<T>(planes).map(|(weight, _)| weight)
    }

    /// The same, and the record that it came from.
    pub(super) fn cut<T: Real>(&self, planes: &[Plane]) -> Option<(f64, SplatCut<T>)> {
        self.seen(&self.view(), planes)
    }

    /// The same for another view.
    pub(super) fn seen<T: Real>(
        &self,
        view: &ViewTransform<T>,
        planes: &[Plane],
    ) -> Option<(f64, SplatCut<T>)> {
        let scene = scene(&[self.one]);
        let footprint = Footprint::new(&scene, 0, view)?;
        let clip = clip(self.op, planes);
        let cut =
            cutoff::cutoff(&scene, 0, &footprint, view, &clip, &self.settings).expect("traced");
        let (dx, dy) = self.pixel(&footprint);
        Some((cut.weight(dx, dy).wide(), cut))
    }

    pub(super) fn view<T: Real>(&self) -> ViewTransform<T> {
        ViewTransform::new(&self.camera(1.0))
    }

    /// The camera of a world whose unit is so many times as large.
    pub(super) fn camera(&self, unit: f64) -> Camera {
        let focal = match self.projection {
            Projection::Perspective => 500.0,
            Projection::Orthographic => 30.0 / unit,
        };
        camera(640, 480, focal).projection(self.projection)
    }

    /// The pixel's offset from the centre in pixels.
    pub(super) fn pixel<T: Real>(&self, footprint: &Footprint<T>) -> (T, T) {
        let [k0, k1, k2] = footprint.conic;
        let dx = T::of(self.offset[0]) / k0;
        (dx, (T::of(self.offset[1]) - k1 * dx) / k2)
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(2000) })]

    #[test]
    fn weights_are_shares(case in cases(1..5)) {
        let planes = case.planes();
        let weights = [case.weight::<f64>(&planes), case.weight::<f32>(&planes)];
        for w in weights.into_iter().flatten() {
            prop_assert!((0.0..=1.0).contains(&w), "{w}");
        }
    }

    #[test]
    fn more_is_visible_as_a_plane_retreats(case in cases(1..4), step in 0.0..2.0_f64) {
        let planes = case.planes();
        let mut moved = planes.clone();
        let extent = f64::from(case.one.scale.into_iter().fold(1e-3_f32, f32::max));
        moved[0] = Plane::new(planes[0].normal(), planes[0].offset() + step * extent).unwrap();
        if let (Some(before), Some(after)) = (case.weight::<f64>(&planes), case.weight::<f64>(&moved)) {
            // Two and three planes are integrated to 1e-6; four and more, which do not occur here, are estimated.
            let most = match planes.len() {
                1 => 1e-12,
                _ => 1e-6,
            };
            prop_assert!(after >= before - most, "{before}, then {after}");
        }
    }

    #[test]
    fn a_plane_twice_is_the_plane_once(case in cases(1..4), copied in 0..3_usize) {
        let planes = case.planes();
        let mut doubled = planes.clone();
        doubled.push(planes[copied % planes.len()]);
        prop_assert_eq!(case.weight::<f64>(&planes), case.weight::<f64>(&doubled));
        prop_assert_eq!(case.weight::<f32>(&planes), case.weight::<f32>(&doubled));
    }

    #[test]
    fn complementary_halves_are_the_whole(mut case in cases(1..2)) {
        if case.settings.mode == Mode::Rara {
            case.settings.miss = Miss::Peak; // the other readings keep, or drop, both halves
        }
        let planes = case.planes();
        if let (Some(a), Some(b)) = (case.weight::<f64>(&planes), case.weight::<f64>(&[opposite(&planes[0])])) {
            let on_the_plane = a == 1.0 && b == 1.0; // a point, or a peak, on the plane belongs to both
            // Thin splats far away make much of the last digit of the plane's distance.
            prop_assert!((a + b - 1.0).abs() < 1e-6 || on_the_plane, "{a} + {b}");
        }
    }

    #[test]
    fn the_order_of_planes_does_not_matter(case in cases(2..5)) {
        let mut planes = case.planes();
        let before = case.weight::<f64>(&planes);
        planes.reverse();
        prop_assert_eq!(before, case.weight::<f64>(&planes));
    }

    #[test]
    fn planes_that_keep_a_splat_whole_change_nothing(case in cases(1..4), normal in directions()) {
        let planes = case.planes();
        let mut more = planes.clone();
        more.push(Plane::new(normal, 1e6).unwrap());
        if case.op == ClipOp::And {
            prop_assert_eq!(case.weight::<f64>(&planes), case.weight::<f64>(&more));
        } else if let Some(w) = case.weight::<f64>(&more) {
            prop_assert!(w == 1.0 || case.settings.miss == Miss::Drop, "{w}");
        }
    }
}
