//! Hosts of every kind project points by their matrices, and the camera made of these to the same pixels and depths.

use glam::dcamera::{lh, rh};
use glam::{DQuat, DVec2};
use proptest::prelude::*;

use super::*;

/// The conventions that hosts have, apart from those of their views.
#[derive(Debug, Clone, Copy)]
enum Api {
    OpenGl,
    Vulkan,
    Direct3D,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Depths {
    Ordinary,
    Reversed,
    Infinite,
    ReversedInfinite,
    Orthographic,
    ReversedOrthographic,
}

/// What the host does to its matrices besides.
#[derive(Debug, Clone)]
struct Host {
    api: Api,
    left_handed: bool,
    depths: Depths,
    /// The view's own axes are flipped, as of hosts whose y points down or that look along +z.
    flips: [bool; 3],
    /// The world is a model whose x is mirrored and whose units are this long.
    model: Option<f64>,
    /// Quarters by which the display is turned.
    quarters: u8,
    eye: DVec3,
    turn: DQuat,
    /// Left, right, bottom and top at a distance of 1.
    window: [f64; 4],
    /// Of a pixel.
    jitter: [f64; 2],
    near: f64,
    far: f64,
}

const SIZE: (u32, u32) = (1281, 720);

impl Host {
    fn ndc(&self) -> Ndc {
        let ndc = match self.api {
            Api::OpenGl => Ndc::OPENGL,
            Api::Vulkan => Ndc::VULKAN,
            Api::Direct3D => Ndc::DIRECT3D,
        };
        ndc.reversed(matches!(self.depths, Depths::ReversedOrthographic))
    }

    fn flip(&self) -> DMat4 {
        let sign = |flips| if flips { -1.0 } else { 1.0 };
        DMat4::from_scale(self.flips.map(sign).into())
    }

    fn view(&self) -> DMat4 {
        let (forward, up) = (self.turn * DVec3::Z, self.turn * DVec3::Y);
        let view = match self.left_handed {
            true => lh::view::look_to_mat4(self.eye, forward, up),
            false => rh::view::look_to_mat4(self.eye, forward, up),
        };
        let model = self.model.map_or(DMat4::IDENTITY, |unit| {
            DMat4::from_scale(DVec3::new(-unit, unit, unit))
        });
        self.flip() * view * model
    }

    fn projection(&self) -> DMat4 {
        use Depths::*;
        let (near, far) = (self.near, self.far);
        let (near, far) = match self.depths {
            Reversed | ReversedOrthographic => (far, near),
            Infinite => (near, 1e3),
            _ => (near, far),
        };
        let is_flat = matches!(self.depths, Orthographic | ReversedOrthographic);
        let at = if is_flat { 1.0 } else { near };
        let [l, r, b, t] = self.window.map(|edge| edge * at);
        let make = match (self.api, self.left_handed, is_flat) {
            (Api::OpenGl, true, true) => lh::proj::opengl::orthographic,
            (Api::OpenGl, true, false) => lh::proj::opengl::frustum,
            (Api::OpenGl, false, true) => rh::proj::opengl::orthographic,
            (Api::OpenGl, false, false) => rh::proj::opengl::frustum,
            (Api::Vulkan, true, true) => lh::proj::vulkan::orthographic,
            (Api::Vulkan, true, false) => lh::proj::vulkan::frustum,
            (Api::Vulkan, false, true) => rh::proj::vulkan::orthographic,
            (Api::Vulkan, false, false) => rh::proj::vulkan::frustum,
            (Api::Direct3D, true, true) => lh::proj::directx::orthographic,
            (Api::Direct3D, true, false) => lh::proj::directx::frustum,
            (Api::Direct3D, false, true) => rh::proj::directx::orthographic,
            (Api::Direct3D, false, false) => rh::proj::directx::frustum,
        };
        let mut projection = make(l, r, b, t, near, far);
        // Far goes to infinity: the depth that is 1 or, reversed, 0 there.
        let w = projection.z_axis.w;
        match self.depths {
            Infinite => (projection.z_axis.z, projection.w_axis.z) = (w, -near),
            ReversedInfinite => (projection.z_axis.z, projection.w_axis.z) = (0.0, near),
            _ => {}
        }
        let size = DVec2::new(SIZE.0.into(), SIZE.1.into());
        let jitter = (2.0 * DVec2::from(self.jitter) / size).extend(0.0);
        let quarter =
            DMat4::from_rotation_z(f64::from(self.quarters) * std::f64::consts::FRAC_PI_2);
        DMat4::from_translation(jitter) * quarter * projection * self.flip()
    }

    /// The pixel and the value in the depth buffer of a point, and whether it is in front of the host's eye.
    fn seen(&self, point: DVec3) -> (DVec2, f64, bool) {
        let clip = self.projection() * self.view() * point.extend(1.0);
        let ndc = clip.truncate() / clip.w;
        let size = DVec2::new(SIZE.0.into(), SIZE.1.into());
        let (y, z) = match self.api {
            Api::OpenGl => (-ndc.y, 0.5 * (ndc.z + 1.0)),
            Api::Vulkan => (ndc.y, ndc.z),
            Api::Direct3D => (-ndc.y, ndc.z),
        };
        ((DVec2::new(ndc.x, y) + 1.0) / 2.0 * size, z, clip.w > 0.0)
    }
}

fn hosts() -> impl Strategy<Value = Host> {
    use Depths::*;
    let api = prop::sample::select(vec![Api::OpenGl, Api::Vulkan, Api::Direct3D]);
    let all = vec![
        Ordinary,
        Reversed,
        Infinite,
        ReversedInfinite,
        Orthographic,
        ReversedOrthographic,
    ];
    let depths = prop::sample::select(all);
    let unit = prop::option::of(0.1..10.0_f64);
    let turn = [-1.0..1.0_f64, -1.0..1.0, -1.0..1.0, -1.0..1.0]
        .prop_map(DQuat::from_array)
        .prop_filter("a rotation", |turn| turn.length() > 0.1);
    let edge = || -0.3..1.2_f64;
    (
        (api, any::<bool>(), depths, any::<[bool; 3]>()),
        (unit, 0..4_u8, [-9.0..9.0_f64, -9.0..9.0, -9.0..9.0], turn),
        ([edge(), edge(), edge(), edge()], [-0.5..0.5_f64, -0.5..0.5]),
        (0.01..0.5_f64, 5.0..500.0_f64),
    )
        .prop_map(
            |(
                (api, left_handed, depths, flips),
                (model, quarters, eye, turn),
                lens,
                (near, far),
            )| {
                let ([l, r, b, t], jitter) = lens;
                Host {
                    api,
                    left_handed,
                    depths,
                    flips,
                    model,
                    quarters,
                    eye: eye.into(),
                    turn: turn.normalize(),
                    window: [-l.max(-0.2) - 0.3, r + 0.5, -b.max(-0.2) - 0.3, t + 0.5],
                    jitter,
                    near,
                    far,
                }
            },
        )
}

/// The pixel of a point and its depth along the camera's axis, by the numbers that every stage takes.
fn projected(camera: &Camera, point: DVec3) -> (DVec2, f64) {
    let seen = camera.rotation * (point - camera.eye);
    let over = match camera.projection {
        Projection::Perspective => seen.z,
        Projection::Orthographic => 1.0,
    };
    let pixel = DVec2::new(camera.fx * seen.x, camera.fy * seen.y) / over;
    (pixel + DVec2::new(camera.cx, camera.cy), seen.z)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2_000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_hosts_points_are_at_its_pixels_and_depths(
        host in hosts(),
        points in prop::collection::vec([-20.0..20.0_f64, -20.0..20.0, -20.0..20.0], 8),
    ) {
        let made = Camera::of_projection(host.view(), host.projection(), host.ndc(), SIZE);
        let (camera, map) = made.expect("a camera");
        let square = camera.rotation * camera.rotation.transpose() - DMat3::IDENTITY;
        prop_assert!(square.to_cols_array().iter().all(|v| v.abs() < 1e-12));
        for point in points.into_iter().map(DVec3::from) {
            let (pixel, value, in_front) = host.seen(point);
            let (ours, depth) = projected(&camera, point);
            let apart = (ours - pixel).length();
            prop_assert!(apart <= 1e-9 * (pixel.length() + 1e3), "{ours} is not {pixel}");
            if camera.projection == Projection::Perspective {
                prop_assert_eq!(depth > 0.0, in_front);
            }
            let at = map.at(depth);
            let kept = value.clamp(0.0, 1.0);
            prop_assert!(depth <= 0.0 || (at - kept).abs() <= 1e-9, "{at} is not {value} at {depth}");
        }
        let reversed = matches!(
            host.depths,
            Depths::Reversed | Depths::ReversedInfinite | Depths::ReversedOrthographic
        );
        prop_assert_eq!(map.is_reversed(), reversed);
    }

    /// Single precision rounds a rotation by 6e-8, the eye by that of its distance, and nothing else.
    #[test]
    fn matrices_in_single_precision_are_as_good_as_they_are(host in hosts()) {
        let host = Host { quarters: 0, ..host };
        let rounded = |matrix: DMat4| matrix.as_mat4().as_dmat4();
        let (view, projection) = (rounded(host.view()), rounded(host.projection()));
        let made = Camera::of_projection(view, projection, host.ndc(), SIZE);
        let (camera, _) = made.expect("a camera");
        let point = host.eye + host.turn * DVec3::new(0.5, -0.3, 4.0);
        let point = host.model.map_or(point, |unit| point * DVec3::new(-1.0, 1.0, 1.0) / unit);
        let (pixel, ..) = host.seen(point);
        let (ours, _) = projected(&camera, point);
        prop_assert!((ours - pixel).length() < 0.02, "{ours} is not {pixel}");
        // A host that inverts the camera's own matrix rounds twice more, and the last row too.
        let mut inverted = host.view().as_mat4().inverse().inverse();
        inverted.w_axis.w = f32::from_bits(inverted.w_axis.w.to_bits() - 1);
        let made = Camera::of_projection(inverted.as_dmat4(), projection, host.ndc(), SIZE);
        let (ours, _) = projected(&made.expect("a camera").0, point);
        prop_assert!((ours - pixel).length() < 0.1, "{ours} is not {pixel}");
    }
}

/// A left-handed host mirrors the world where it sees it as it is, and not where its model undoes that.
#[test]
fn only_a_mirror_leaves_a_mirror() {
    let (eye, up) = (DVec3::new(1.0, 2.0, -5.0), DVec3::Y);
    let projection = lh::proj::directx::perspective(0.8, 1.5, 0.1, 50.0);
    let view = lh::view::look_at_mat4(eye, DVec3::ZERO, up);
    let mirror = DMat4::from_scale(DVec3::new(1.0, 1.0, -1.0));
    let made = |view| Camera::of_projection(view, projection, Ndc::DIRECT3D, (300, 200));
    let [(plain, _), (model, _)] = [view, view * mirror].map(|view| made(view).expect("a camera"));
    assert!((plain.rotation.determinant() + 1.0).abs() < 1e-12);
    assert!((model.rotation.determinant() - 1.0).abs() < 1e-12);
    assert!(plain.eye.distance(eye) < 1e-12);
    // The same camera that a right-handed program makes by hand, where y is up.
    let by_hand = Camera::look_at(
        DVec3::new(1.0, 2.0, 5.0),
        DVec3::ZERO,
        up,
        0.8_f64.to_degrees(),
        (300, 200),
    )
    .expect("a view");
    assert!(model.rotation.abs_diff_eq(by_hand.rotation, 1e-12));
    assert!(model.eye.distance(by_hand.eye) < 1e-12);
    let lens = |camera: &Camera| [camera.fx, camera.fy, camera.cx, camera.cy];
    let both = lens(&model).into_iter().zip(lens(&by_hand));
    assert!(both.into_iter().all(|(a, b)| (a - b).abs() < 1e-9));
}

/// What lies behind an orthographic near plane is not nearer than what is drawn, wherever the view has its origin.
#[test]
fn an_orthographic_eye_is_before_the_near_plane() {
    for (near, far) in [(-10.0, 40.0), (0.0, 5.0), (3.0, 9.0)] {
        for reversed in [false, true] {
            let (a, b) = if reversed { (far, near) } else { (near, far) };
            let projection = rh::proj::directx::orthographic(-2.0, 2.0, -1.0, 1.0, a, b);
            let ndc = Ndc::DIRECT3D.reversed(reversed);
            let made = Camera::of_projection(DMat4::IDENTITY, projection, ndc, (400, 200));
            let (camera, map) = made.expect("a camera");
            let at_near = projected(&camera, DVec3::new(0.3, 0.2, -near)).1;
            assert!(at_near > 0.19999, "{at_near}");
            let value = if reversed { 1.0 } else { 0.0 };
            assert!((map.at(at_near) - value).abs() < 1e-12);
            let is_moved = camera.eye != DVec3::ZERO;
            assert_eq!(is_moved, near < 0.2, "{near}: {}", camera.eye);
        }
    }
}

#[test]
fn what_is_no_camera_is_refused_by_name() {
    let view = rh::view::look_at_mat4(DVec3::new(0.5, 1.0, 4.0), DVec3::ZERO, DVec3::Y);
    let projection = rh::proj::directx::perspective(0.8, 1.5, 0.1, 50.0);
    let flat = rh::proj::directx::orthographic(-1.0, 3.0, -1.0, 1.0, 0.1, 50.0);
    let refusal = |view, projection| {
        let made = Camera::of_projection(view, projection, Ndc::DIRECT3D, (300, 200));
        made.expect_err("refused").to_string()
    };
    let with = |matrix: DMat4, row: usize, column: usize, value: f64| {
        let mut entries = matrix.to_cols_array();
        entries[4 * column + row] = value;
        DMat4::from_cols_array(&entries)
    };
    let stretched = view * DMat4::from_scale(DVec3::new(1.0, 1.0, 1.01));
    let cases = [
        (
            with(view, 1, 3, f64::NAN),
            projection,
            "view matrix has NaN in row 1, column 3",
        ),
        (view.transpose(), projection, "view matrix's last row is"),
        (view.transpose(), projection, "transpose it"),
        (projection * view, projection, "without a projection"),
        (
            with(view * 0.0, 3, 3, 1.0),
            projection,
            "view matrix is singular",
        ),
        (
            stretched,
            projection,
            "view matrix shears, or scales unevenly",
        ),
        (with(view, 0, 1, 0.4), projection, "square to each other"),
        (
            view,
            with(projection, 2, 2, f64::INFINITY),
            "projection matrix has inf in row 2, column 2",
        ),
        (
            view,
            projection.transpose(),
            "projection matrix's last row is",
        ),
        (view, flat.transpose(), "transpose it"),
        (view, projection * 0.0, "projection matrix is singular"),
        (
            view,
            with(projection, 0, 0, 0.0),
            "its row 0 makes a picture of 0 pixels",
        ),
        (
            view,
            with(flat, 1, 1, 0.0),
            "its row 1 makes a picture of 0 pixels",
        ),
        (view, with(projection, 0, 1, 0.3), "shears the picture"),
        (
            view,
            with(projection, 2, 0, 0.3),
            "not a function of the distance alone",
        ),
        (
            view,
            with(flat, 2, 1, 0.3),
            "not a function of the distance alone",
        ),
        (view, with(projection, 2, 3, 0.0), "its depth is"),
        (
            view,
            with(flat, 2, 2, 0.0),
            "gives every point the same depth",
        ),
    ];
    for (view, projection, expected) in cases {
        let message = refusal(view, projection);
        assert!(message.contains(expected), "{message}: not {expected}");
    }
    let made = Camera::of_projection(view, projection, Ndc::DIRECT3D, (0, 200));
    let message = made.expect_err("no picture").to_string();
    assert!(message.contains("0x200"), "{message}");
}
