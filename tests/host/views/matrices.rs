//! Cameras of a host's matrices draw what those made by hand do, to the bit, with what its depth buffer hides.

use super::*;
use rara::glam::DMat3;
use rara::glam::dcamera::{lh, rh};
use rara::glam::{DMat4, DVec4};
use rara::{DepthDesc, DepthMap, Ndc, Projection};

/// A power of two, so that no focal length is rounded.
const VIEW: (u32, u32) = (128, 64);
const NEAR: f64 = 0.25;

/// A host's picture amid a mesh, in reversed, infinite depth.
fn drawn(
    canvas: &Canvas,
    scene: &SceneBuffers,
    renderer: &mut Renderer,
    seen: &Seen,
) -> Vec<[f32; 4]> {
    let (camera, map) = seen;
    renderer.set_depth_map(*map).expect("there is a depth");
    let settings = Settings::default();
    let clip = Clip::default();
    let configured = renderer.configure(scene, camera, &clip, &settings);
    let frame = Frame {
        behind: Some(canvas.depth_image(0, 0)),
        ..Frame::new(VIEW)
    };
    canvas.draw_frame(renderer, scene, configured, &frame)
}

type Seen = (Camera, DepthMap);

fn of_matrices(view: DMat4, projection: DMat4, ndc: Ndc) -> Seen {
    Camera::of_projection(view, projection, ndc, VIEW).expect("a camera")
}

/// Looks along the world's x axis at the scene about the origin, y up, and shows a unit of height at a distance of 1.
fn by_hand() -> Seen {
    let rotation = DMat3::from_cols(DVec3::Z, DVec3::NEG_Y, DVec3::X).transpose();
    let eye = DVec3::new(-3.0, 0.5, 0.25);
    let matrix = DMat4::from_mat3_translation(rotation, -(rotation * eye));
    let camera = Camera::from_world_to_camera(matrix, (64.0, 64.0, 64.5, 32.0), VIEW);
    let map = DepthMap::reversed(NEAR, f64::INFINITY);
    (camera.expect("a camera"), map.expect("depths"))
}

/// A lens of as many focal lengths a half-height, which sees half a pixel more on the left.
fn lens(projection: DMat4) -> DMat4 {
    let jitter = DMat4::from_translation(DVec3::new(1.0 / 128.0, 0.0, 0.0));
    let mut lens = projection;
    (lens.x_axis.x, lens.y_axis.y) = (1.0, 2.0 * lens.y_axis.y.signum());
    jitter * lens
}

#[test]
fn a_hosts_matrices_draw_the_picture_of_the_camera_made_by_hand() {
    let scene = generate(Kind::General, 3_000, 5);
    let (camera, map) = by_hand();
    let (eye, forward, up) = (camera.eye, DVec3::X, DVec3::Y);
    let flipped = DMat4::from_scale(DVec3::new(1.0, -1.0, 1.0));
    let right = rh::view::look_to_mat4(eye, forward, up);
    let left = lh::view::look_to_mat4(eye, forward, up);
    let infinite = rh::proj::directx::perspective_infinite_reverse(1.0, 2.0, NEAR);
    let vulkan = rh::proj::vulkan::perspective_infinite_reverse(1.0, 2.0, NEAR);
    let handed = lh::proj::directx::perspective_infinite_reverse(1.0, 2.0, NEAR);
    let hosts = [
        (right, lens(infinite), Ndc::DIRECT3D),
        (right, lens(vulkan), Ndc::VULKAN),
        (flipped * right, lens(infinite) * flipped, Ndc::DIRECT3D),
    ];
    // A left-handed host sees the same world in a mirror.
    let mirror = DMat3::from_diagonal(DVec3::new(-1.0, 1.0, 1.0));
    let mirrored = camera.rotation(mirror * camera.rotation);
    let orthographic = DMat4::from_cols(
        DVec4::new(0.5, 0.0, 0.0, 0.0),
        DVec4::new(0.0, 1.0, 0.0, 0.0),
        DVec4::new(0.0, 0.0, 0.125, 0.0),
        DVec4::new(1.0 / 128.0, 0.0, 1.0, 1.0),
    );
    let mut worlds: Vec<(Seen, Seen)> = hosts
        .map(|(view, projection, ndc)| ((camera, map), of_matrices(view, projection, ndc)))
        .to_vec();
    worlds.push((
        (mirrored, map),
        of_matrices(left, lens(handed), Ndc::DIRECT3D),
    ));
    let (flat, flat_map) = of_matrices(right, orthographic, Ndc::DIRECT3D.reversed(true));
    // The near plane is at the eye of the view, and nothing nearer than 0.2 is drawn.
    assert_eq!(flat.eye, eye - f64::from(0.2_f32) * forward);
    let by_hand = camera.projection(Projection::Orthographic).eye(flat.eye);
    worlds.push(((by_hand.fx(32.0).fy(32.0), flat_map), (flat, flat_map)));

    with_host(true, |host, device| {
        let desc = RendererDesc::new(FLOATS)
            .bindings(Bindings::Mixed)
            .depth(Some(
                DepthDesc::new(vk::Format::D32_SFLOAT, map).readable(true),
            ));
        let mut renderer = Renderer::new(device, desc).expect("a renderer");
        let uploaded = SceneBuffers::upload(device, &scene, ShFormat::Float).expect("uploads");
        let mut pictures: Vec<Vec<[f32; 4]>> = Vec::new();
        for (by_hand, made) in &worlds {
            assert_eq!(by_hand.1, made.1, "the depth map");
            let mut canvas = CanvasDesc::new(VIEW, FLOATS);
            (canvas.depth, canvas.far) = (vk::Format::D32_SFLOAT, 0.0);
            let rect = vk::Rect2D {
                offset: vk::Offset2D { x: 40, y: 10 },
                extent: vk::Extent2D {
                    width: 50,
                    height: 45,
                },
            };
            canvas.meshes = vec![(rect, by_hand.1.at(3.0) as f32)];
            let canvas = Canvas::new(&host.lend(), device, canvas);
            let [truth, ours] =
                [by_hand, made].map(|seen| drawn(&canvas, &uploaded, &mut renderer, seen));
            let drawn = truth.iter().filter(|pixel| pixel[1] > 0.05).count();
            assert!(drawn > 300, "{drawn} pixels");
            assert!(ours == truth, "{:?}", made.0);
            pictures.push(ours);
        }
        assert!(pictures[0] == pictures[1] && pictures[0] == pictures[2]);
        assert!(pictures[0] != pictures[3] && pictures[0] != pictures[4]);
    });
}
