//! How many fragments of a frame count, by the reference in single precision: their alpha is 1/255 or more, in a pixel
//! that the splats before have not saturated.

use rara::{Camera, Clip, Decay, Gaussians, Placement, Settings};
use rara_base::parallel::in_parallel;
use rara_reference::{Splat, ViewTransform, classify, compact, project, sort, splat};

/// Rows that a thread counts in at a time.
const BAND: u32 = 16;

pub(super) fn count(scene: &Gaussians, camera: &Camera, settings: &Settings) -> u64 {
    let placement = Placement::IDENTITY.of_origin(scene.origin());
    let view = ViewTransform::<f32>::in_layer(camera, &placement);
    let sides = classify::classify(scene, &view, &Clip::default(), settings);
    let drawn = compact::compact(&sides);
    let project = |&index: &u32| project::project(scene, index as usize, &view, settings);
    let mut splats: Vec<_> = drawn.iter().filter_map(project).collect();
    sort::sort(&mut splats, settings.order_of(camera, [scene.training()]));

    let [width, height] = view.size;
    let mut members = vec![Vec::new(); height.div_ceil(BAND) as usize];
    for splat in &splats {
        if let Some((first, last)) = splat.footprint.span(1, height, 0.0) {
            for band in first / BAND..=last / BAND {
                members[band as usize].push(splat);
            }
        }
    }
    let bands = (0..height).step_by(BAND as usize).zip(&members);
    let counts = in_parallel(bands, |(top, splats)| {
        in_band(splats, top..height.min(top + BAND), width, settings)
    });
    counts.into_iter().sum()
}

/// Counts those in some rows, of splats that are sorted front to back.
fn in_band(
    splats: &[&Splat<f32>],
    rows: std::ops::Range<u32>,
    width: u32,
    settings: &Settings,
) -> u64 {
    let saturated = settings.precision.transmittance_min;
    let mut light = vec![1.0_f32; (width * (rows.end - rows.start)) as usize];
    let mut count = 0;
    for splat in splats {
        let (footprint, [x, y]) = (&splat.footprint, splat.footprint.screen_centre);
        let spans = (
            footprint.span(0, width, 0.0),
            footprint.span(1, rows.end, 0.0),
        );
        let (Some((left, right)), Some((top, bottom))) = spans else {
            continue;
        };
        for row in top.max(rows.start)..=bottom {
            for column in left..=right {
                let light = &mut light[((row - rows.start) * width + column) as usize];
                let at = [column as f32 + 0.5 - x, row as f32 + 0.5 - y];
                if *light < saturated {
                    continue;
                }
                if let Some(alpha) = splat::alpha(splat, at[0], at[1], Decay::Depth) {
                    *light *= 1.0 - alpha;
                    count += 1;
                }
            }
        }
    }
    count
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DVec3, Quat, Vec3};

    #[test]
    fn fragments_count_until_a_pixel_is_saturated() {
        let eye = DVec3::new(0.0, 0.0, -4.0);
        let camera =
            Camera::look_at(eye, DVec3::ZERO, DVec3::NEG_Y, 50.0, (37, 41)).expect("a view");
        let count = |copies, scale, opacity| {
            let mut scene = Gaussians::default();
            for _ in 0..copies {
                let scale = Vec3::splat(scale);
                scene.push(Vec3::ZERO, scale, Quat::IDENTITY, opacity, &[0.0; 3]);
            }
            super::count(&scene, &camera, &Settings::default())
        };
        // Larger than the picture: 1/100 of the light is left, then 1e-4, then 1e-6, where 4e-6 are enough.
        assert_eq!(count(10, 200.0, 1.0), 3 * 37 * 41);
        assert_eq!(count(10, 200.0, 0.1), 10 * 37 * 41);
        let small = count(1, 0.1, 0.5);
        assert!((10..200).contains(&small), "{small}");
        assert_eq!(count(5, 0.1, 0.003), 0, "below 1/255");
    }
}
