//! scratch
use glam::DVec3;
use rara::scene::*;
use rara::*;
fn main() {
    let args: Vec<String> = std::env::args().collect();
    let scene = load(args[1].as_ref(), &mut |_, _| {}).unwrap().gaussians;
    let validation = std::env::var("VAL").is_ok();
    let mut h = Headless::new(&HeadlessDesc {
        device: None,
        validation,
    })
    .unwrap();
    eprintln!("{} {}", h.device_name(), h.driver());
    h.load(&scene).unwrap();
    let size: (u32, u32) = (std::env::var("W").map_or(512, |w| w.parse().unwrap()), 512);
    let b = Bounds::of(&scene);
    let cam = Camera::frame(&b, -DVec3::Y, 50.0, size).unwrap();
    let n = DVec3::new(0.9, 0.3, 0.2);
    let plane = |n: DVec3, s: f64| Plane::new(n, -n.dot(b.centre()) + s * b.radius()).unwrap();
    let clips = [
        Clip::default(),
        Clip {
            planes: vec![plane(n, 0.0)],
            op: ClipOp::And,
        },
        Clip {
            planes: vec![plane(n, 0.0), plane(DVec3::new(-0.8, 0.1, 0.7), 0.3)],
            op: ClipOp::And,
        },
        Clip {
            planes: vec![plane(n, 0.0), plane(DVec3::new(-0.8, 0.1, 0.7), 0.3)],
            op: ClipOp::Or,
        },
    ];
    for mode in [Mode::None, Mode::Hard, Mode::Rara, Mode::Exact] {
        for raster in [Raster::Quad, Raster::Mesh] {
            for (i, clip) in clips.iter().enumerate() {
                if (mode == Mode::None) != (i == 0) {
                    continue;
                }
                let s = Settings {
                    mode,
                    raster,
                    ..Settings::default()
                };
                h.render(&cam, clip, &s).unwrap();
                let f = h.render(&cam, clip, &s).unwrap();
                let p = h.picture().unwrap();
                let mut line = format!(
                    "{mode:?} {raster:?} clip{i} {:?} gpu {:.1} wall {:.1}",
                    f.counts, f.gpu_ms, f.wall_ms
                );
                for t in &f.passes {
                    line += &format!(" {} {:.2}", t.name, t.ms);
                }
                if std::env::var("REF").is_ok() {
                    let r = reference::render::<f64>(&scene, &cam, clip, &s);
                    let c = measure::compare(&p, &r.picture).unwrap();
                    line += &format!(" | ref {:?} {c:?}", r.counts);
                }
                println!("{line}");
                p.save(std::path::Path::new(&format!(
                    "/tmp/prep/{mode:?}_{raster:?}_{i}.png"
                )))
                .unwrap();
            }
        }
    }
}
