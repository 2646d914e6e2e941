use super::*;

fn pixel(camera: &Camera, p: DVec3) -> (f64, f64, f64) {
    let c = camera.rotation * (p - camera.eye);
    (
        camera.fx * c.x / c.z + camera.cx,
        camera.fy * c.y / c.z + camera.cy,
        c.z,
    )
}

#[test]
fn every_corner_is_in_the_picture_and_one_is_near_its_edge() {
    let boxes = [
        (DVec3::ZERO, DVec3::ONE),
        (DVec3::new(5.0, -3.0, 100.0), DVec3::new(9.0, -2.9, 101.0)),
    ];
    for (min, max) in boxes {
        for up in [-DVec3::Y, DVec3::Z, DVec3::Y, DVec3::new(0.3, -1.0, 0.9)] {
            for size in [(1024, 1024), (1920, 1080), (300, 900)] {
                let camera = Camera::frame(&Bounds { min, max }, up, 60.0, size).unwrap();
                let (w, h) = (f64::from(size.0), f64::from(size.1));
                let mut filled = 0.0_f64;
                for corner in (Bounds { min, max }).corners() {
                    let (x, y, z) = pixel(&camera, corner);
                    assert!(z > 0.2 && x > 0.0 && x < w && y > 0.0 && y < h);
                    filled = filled
                        .max((2.0 * x / w - 1.0).abs())
                        .max((2.0 * y / h - 1.0).abs());
                }
                assert!((filled - 0.9).abs() < 1e-9 || filled < 0.9, "{filled}");
                assert!(filled > 0.5, "{filled}");
            }
        }
    }
}

#[test]
fn orthographic_frames_hold_every_corner_and_one_is_near_an_edge() {
    let bounds = Bounds {
        min: DVec3::new(5.0, -3.0, 100.0),
        max: DVec3::new(9.0, -2.5, 101.0),
    };
    let up = DVec3::new(0.1, -1.0, 0.3);
    let mut cameras = Vec::new();
    for size in [(1024, 1024), (1920, 1080), (300, 900)] {
        cameras.push(Camera::frame_orthographic(&bounds, up, size).unwrap());
        for (normal, share) in [(DVec3::X, 0.1), (-DVec3::Z, 0.5), (DVec3::ONE, 0.9)] {
            let at = bounds.min.lerp(bounds.max, share);
            let plane = Plane::new(normal, -normal.dot(at)).unwrap();
            let camera = Camera::facing(&plane, &bounds, up, size).unwrap();
            assert!(camera.rotation.row(2).distance(normal.normalize()) < 1e-12);
            assert!(plane.distance(camera.eye) < -bounds.radius());
            cameras.push(camera);
        }
    }
    for camera in cameras {
        let filled = bounds.corners().iter().fold(0.0_f64, |filled, corner| {
            let p = camera.rotation * (*corner - camera.eye);
            let at = [camera.fx * p.x / camera.cx, camera.fy * p.y / camera.cy];
            assert!(p.z > 0.2);
            filled.max(at[0].abs()).max(at[1].abs())
        });
        assert!((filled - 0.9).abs() < 1e-9, "{filled}");
    }
}

#[test]
fn tiny_scenes_stay_beyond_the_near_plane() {
    let bounds = Bounds {
        min: DVec3::splat(-1e-3),
        max: DVec3::splat(1e-3),
    };
    let camera = Camera::frame(&bounds, -DVec3::Y, 60.0, (64, 64)).unwrap();
    assert!(
        bounds
            .corners()
            .iter()
            .all(|&corner| pixel(&camera, corner).2 > 0.2)
    );
}

#[test]
fn a_zero_up_is_an_error() {
    let bounds = Bounds {
        min: DVec3::ZERO,
        max: DVec3::ONE,
    };
    assert!(Camera::frame(&bounds, DVec3::ZERO, 60.0, (64, 64)).is_err());
}
