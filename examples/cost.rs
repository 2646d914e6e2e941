//! cost of clip pipelines
use glam::DVec3;
use rara::scene::*;
use rara::*;
fn main() {
    let args: Vec<String> = std::env::args().collect();
    let scene = load(args[1].as_ref(), &mut |_, _| {}).unwrap().gaussians;
    let mut h = Headless::new(&HeadlessDesc {
        device: None,
        validation: false,
    })
    .unwrap();
    h.load(&scene).unwrap();
    let s: u32 = std::env::var("W").map_or(1024, |w| w.parse().unwrap());
    let b = Bounds::of(&scene);
    let cam = Camera::frame(&b, -DVec3::Y, 50.0, (s, s)).unwrap();
    let n = DVec3::new(0.9, 0.3, 0.2);
    let plane = |s: f64| Clip {
        planes: vec![Plane::new(n, -n.dot(b.centre()) + s * b.radius()).unwrap()],
        op: ClipOp::And,
    };
    let raster = match std::env::var("R").as_deref() {
        Ok("mesh") => Raster::Mesh,
        _ => Raster::Quad,
    };
    let cases = [
        ("none", Mode::None, Clip::default()),
        ("exact far", Mode::Exact, plane(1e6)),
        ("hard", Mode::Hard, plane(0.0)),
        ("rara", Mode::Rara, plane(0.0)),
        ("exact", Mode::Exact, plane(0.0)),
    ];
    let mut best = vec![(f64::MAX, f64::MAX, FrameStats::default()); cases.len()];
    for _ in 0..7 {
        for (i, (_, mode, clip)) in cases.iter().enumerate() {
            let f = h
                .render(
                    &cam,
                    clip,
                    &Settings {
                        mode: *mode,
                        raster,
                        ..Settings::default()
                    },
                )
                .unwrap();
            let splat = f.passes.iter().find(|p| p.name == "splat").unwrap().ms;
            if f.wall_ms < best[i].0 {
                best[i].0 = f.wall_ms;
                best[i].2 = f.clone();
            }
            best[i].1 = best[i].1.min(splat);
        }
    }
    for (c, b) in cases.iter().zip(&best) {
        println!(
            "{:10} wall {:.1} splat {:.1} drawn {} cut {} {:?}",
            c.0,
            b.0,
            b.1,
            b.2.counts.drawn,
            b.2.counts.cutoff,
            b.2.passes
                .iter()
                .map(|p| format!("{} {:.1}", p.name, p.ms))
                .collect::<Vec<_>>()
        );
    }
}
