//! Scenes that stand turned, scaled and moved in a world.

use super::*;
use rara::glam::DQuat;
use rara::{DepthDesc, DepthMap, Placement, Plane};

/// A scene's Gaussians where a placement puts them, their spherical harmonics turned with them.
fn placed(scene: &Gaussians, placement: &Placement) -> Gaussians {
    let mut placed = scene.clone();
    let turn = placement.rotation().as_quat();
    for i in 0..scene.len() {
        let position = scene.positions()[i].as_dvec3();
        placed.positions_mut()[i] = placement.to_world(position).as_vec3();
        placed.scales_mut()[i] = scene.scales()[i] * placement.scale() as f32;
        placed.rotations_mut()[i] = (turn * scene.rotations()[i]).normalize();
    }
    let matrix = harmonics_turned(placement.rotation());
    let count = scene.sh_coefficients();
    for (to, from) in placed
        .sh_mut()
        .chunks_exact_mut(3 * count)
        .zip(scene.sh().chunks_exact(3 * count))
    {
        for (row, to) in to.chunks_exact_mut(3).enumerate() {
            for (channel, to) in to.iter_mut().enumerate() {
                let term =
                    |column: usize| matrix[row][column] * f64::from(from[3 * column + channel]);
                *to = (0..count).map(term).sum::<f64>() as f32;
            }
        }
    }
    placed
}

const BASIS: usize = 16;

/// The matrix that turns coefficients of spherical harmonics: a turned function in the direction `d` is the function in
/// the direction of `d` turned back, whatever the basis. It is found by least squares over many directions.
fn harmonics_turned(rotation: DQuat) -> [[f64; BASIS]; BASIS] {
    let basis = |d: DVec3| rara_reference::harmonics::basis(rara_reference::vec3(d.x, d.y, d.z));
    // Columns: the matrix of the normal equations, then their right sides.
    let mut rows = [[0.0; 2 * BASIS]; BASIS];
    for i in 0..400 {
        let z = 1.0 - (f64::from(i) + 0.5) / 200.0;
        let turn = f64::from(i) * 2.399_963;
        let d = DVec3::new(turn.cos(), turn.sin(), 0.0) * (1.0 - z * z).sqrt() + DVec3::Z * z;
        let (here, back) = (basis(d), basis(rotation.inverse() * d));
        for (row, a) in rows.iter_mut().zip(here) {
            for j in 0..BASIS {
                row[j] += a * here[j];
                row[BASIS + j] += a * back[j];
            }
        }
    }
    for i in 0..BASIS {
        let pivot = rows[i][i];
        rows[i] = rows[i].map(|v| v / pivot);
        let row = rows[i];
        for (j, other) in rows.iter_mut().enumerate() {
            let factor = if i == j { 0.0 } else { other[i] };
            other
                .iter_mut()
                .zip(row)
                .for_each(|(a, b)| *a -= factor * b);
        }
    }
    rows.map(|row| std::array::from_fn(|j| row[BASIS + j]))
}

/// Two placements whose scenes stand beside and behind each other.
fn placements() -> [Placement; 2] {
    let turn = |x, y, z, w| DQuat::from_xyzw(x, y, z, w).normalize();
    [
        Placement::new(DVec3::new(0.4, 0.2, 3.0), turn(0.3, -0.5, 0.2, 0.9), 1.7),
        Placement::new(DVec3::new(-0.5, -0.1, 0.0), turn(-0.6, 0.1, 0.7, 0.3), 0.45),
    ]
    .map(|placement| placement.expect("finite numbers"))
}

fn world_camera() -> Camera {
    let eye = DVec3::new(0.6, -0.8, -3.5);
    let camera = Camera::look_at(eye, DVec3::new(0.0, 0.1, 1.0), DVec3::NEG_Y, 55.0, SIZE);
    camera.expect("a view")
}

fn world_clip() -> Clip {
    let plane = |normal: DVec3, offset| Plane::new(normal, offset).expect("a normal");
    Clip::of(
        [
            plane(DVec3::new(0.8, 0.3, 0.1), 0.1),
            plane(DVec3::new(0.1, -0.2, 0.9), 0.4),
        ],
        ClipOp::Or,
    )
}

/// Degree 0, where only places turn, and degree 3, where colours turn with them.
#[test]
fn a_placed_scene_is_the_picture_of_its_gaussians_placed() {
    let (camera, clip) = (world_camera(), world_clip());
    for degree in [0, 3] {
        let mut scene = generate(Kind::General, 3_000, 7);
        scene.set_sh_degree(degree);
        // Colours that change with the direction by about a third.
        let count = 3 * scene.sh_coefficients();
        for (i, coefficient) in scene.sh_mut().iter_mut().enumerate() {
            if i % count >= 3 {
                *coefficient = 0.3 * (i as f32 * 1.7).sin();
            }
        }
        for placement in placements() {
            let (inside, near) = (camera.in_scene(&placement), clip.in_scene(&placement));
            let ours = headless(&scene, &inside, &near);
            let theirs = headless(&placed(&scene, &placement), &camera, &clip);
            assert!(ours.pixels.iter().any(|pixel| pixel[3] > 0.5));
            let (worst, most) = (
                apart(&ours.pixels, &theirs.pixels, 0.0),
                apart(&ours.pixels, &theirs.pixels, 0.002),
            );
            eprintln!("degree {degree}: {worst}/255, {most}/255 for 99.8 %");
            assert!(
                most < 0.1 && worst < 4.0,
                "degree {degree}: {worst}/255, {most}/255"
            );
        }
    }
}

/// The farther scene is drawn first; both are tested against the same mesh on reversed depth.
#[test]
fn two_placed_scenes_stand_in_one_picture_with_a_mesh() {
    let scenes = [
        generate(Kind::General, 3_000, 7),
        generate(Kind::Layers, 3_000, 3),
    ];
    let (camera, clip, placements) = (world_camera(), world_clip(), placements());
    let map = DepthMap::reversed(0.3, f64::INFINITY).expect("0 < near < far");
    // The mesh is before the middle of the farther scene and behind most of the nearer one.
    let mesh_depth = (camera.rotation * (placements[0].position() - camera.eye)).z - 0.05;
    let rect = vk::Rect2D {
        offset: vk::Offset2D { x: 30, y: 20 },
        extent: vk::Extent2D {
            width: 50,
            height: 45,
        },
    };
    let mut truth = vec![[0.0_f32; 4]; (SIZE.0 * SIZE.1) as usize];
    for (scene, placement) in scenes.iter().zip(&placements) {
        let placed = placed_before(scene, placement, None);
        let before = placed_before(scene, placement, Some((&camera, mesh_depth)));
        let whole = headless(&placed, &camera, &clip);
        let part = headless(&before, &camera, &clip);
        for (i, below) in truth.iter_mut().enumerate() {
            let (x, y) = (i as u32 % SIZE.0, i as u32 / SIZE.0);
            let hidden = (30..80).contains(&x) && (20..65).contains(&y);
            let pixel = if hidden { &part } else { &whole }.pixels[i];
            *below = [0, 1, 2, 3].map(|c| pixel[c] + (1.0 - pixel[3]) * below[c]);
        }
    }
    with_host(true, |host, device| {
        let mut canvas = CanvasDesc::new(SIZE, FLOATS);
        canvas.depth = vk::Format::D32_SFLOAT;
        canvas.far = 0.0;
        canvas.meshes = vec![(rect, map.at(mesh_depth) as f32)];
        let canvas = Canvas::new(&host.lend(), device, canvas);
        let buffers = scenes
            .each_ref()
            .map(|scene| SceneBuffers::upload(device, scene, ShFormat::Float).expect("uploads"));
        for way in [Raster::Tiles, Raster::Quad] {
            let desc = desc().depth(Some(
                DepthDesc::new(vk::Format::D32_SFLOAT, map).readable(true),
            ));
            let first = Renderer::new(device, desc).expect("a renderer");
            let second = first.sharing(desc).expect("another");
            let renderers = [first, second].map(RefCell::new);
            let mut configured = Vec::new();
            for ((renderer, buffers), placement) in renderers.iter().zip(&buffers).zip(&placements)
            {
                let mut renderer = renderer.borrow_mut();
                renderer.set_placement(*placement);
                let frame = renderer.configure(buffers, &camera, &clip, &raster(way));
                configured.push(frame.expect("configures"));
            }
            let depth = canvas.depth_image(0, 0);
            let prepared = RefCell::new(Vec::new());
            let before = |cmd| {
                let frames = configured.drain(..);
                for ((renderer, buffers), frame) in renderers.iter().zip(&buffers).zip(frames) {
                    let mut renderer = renderer.borrow_mut();
                    // SAFETY: recording outside a scope, the depth is ready to be copied, and all is waited for.
                    let frame = unsafe { renderer.prepare(cmd, buffers, Some(&depth), frame) };
                    prepared.borrow_mut().push(frame.expect("prepares"));
                }
            };
            let inside = |cmd| {
                canvas.viewport(cmd, 0, 0, SIZE);
                for (renderer, frame) in renderers.iter().zip(&*prepared.borrow()) {
                    // SAFETY: inside the canvas's scope, after both were prepared.
                    let drawn = unsafe { renderer.borrow_mut().draw(cmd, [0.0; 2], frame) };
                    drawn.expect("draws");
                }
            };
            let [pixels, _] = canvas.draw(before, inside);
            let (worst, most) = (apart(&pixels, &truth, 0.0), apart(&pixels, &truth, 0.002));
            eprintln!("{way:?}: {worst}/255, {most}/255 for 99.8 %");
            assert!(
                most < 0.1 && worst < 4.0,
                "{way:?}: {worst}/255, {most}/255"
            );
        }
    });
}

/// A scene's Gaussians in the world, or, with a limit, those that are nearer than it.
fn placed_before(
    scene: &Gaussians,
    placement: &Placement,
    limit: Option<(&Camera, f64)>,
) -> Gaussians {
    let mut all = placed(scene, placement);
    if let Some((camera, limit)) = limit {
        for i in 0..all.len() {
            let relative = all.positions()[i].as_dvec3() - camera.eye;
            if (camera.rotation * relative).z > limit {
                all.opacities_mut()[i] = 0.0;
            }
        }
    }
    all
}
