//! Stage `bin`: which tiles a splat reaches, and the splats of each tile, front to back.

use glam::{DMat4, Quat, Vec3};
use rara::types::{Quad, Splat};
use rara::{Camera, Clip, ClipOp, ExactForm, Mode, Raster, Settings};
use rara_base::limits::{TILE_HEIGHT, TILE_WIDTH};
use rara_reference::bin::{self, Outline, Span};
use rara_reference::{Real, ViewTransform, project, sort};

use crate::stages::frame::{self, SIZE, Stages};
use crate::stages::sort::places;

/// How many deviations behind its plane a cut splat's weight counts as nothing.
const TRIM_DEVIATIONS: f32 = 4.55;

/// The splat's outline, from which the stage works.
fn outline<T: Real>(splat: &Splat, quad: &Quad) -> Outline<T> {
    let of = |x: f32| T::of(f64::from(x));
    let [cx, cy, k0, k1] = splat.centre_conic;
    let [k2, opacity, z, along] = splat.conic_cut;
    let ([ax, ay], [bx, by], [mx, my]) = (quad.first, quad.second, quad.middle);
    let side = |centre: f32, middle: f32, a: f32, b: f32| {
        let (middle, half) = (of(centre) + of(middle), of(a.abs()) + of(b.abs()));
        [middle - half, middle + half]
    };
    Outline {
        centre: [of(cx), of(cy)],
        conic: [of(k0), of(k1), of(k2)],
        opacity: of(opacity),
        quad: [side(cx, mx, ax, bx), side(cy, my, ay, by)],
        line: (z.abs() < 1e30).then(|| {
            assert_eq!(
                splat.curvature_depth[..3],
                [0.0; 3],
                "the affine form has none"
            );
            [of(z + TRIM_DEVIATIONS), of(along), of(splat.colour_cut[3])]
        }),
    }
}

/// Each splat's spans, found again from the tiles' lists, which are the stage's result.
fn listed(begins: &[u32], splats: &[u32], count: usize, columns: u32) -> Vec<Vec<Span>> {
    let mut spans = vec![Vec::<Span>::new(); count];
    for (tile, range) in (0..).zip(begins.windows(2)) {
        let (row, column) = (tile / columns, tile % columns);
        for &splat in &splats[range[0] as usize..range[1] as usize] {
            let spans = &mut spans[splat as usize];
            match spans.last_mut() {
                Some(last) if last.row == row && last.columns[1] == column => last.columns[1] += 1,
                _ => spans.push(Span {
                    row,
                    columns: [column, column + 1],
                }),
            }
        }
    }
    spans
}

/// The spans of a mask; `None` for a splat that has more tiles than a mask holds.
fn masked([origin, is_larger, above, below]: [u32; 4]) -> Option<Vec<Span>> {
    let rows = [above, below].map(u32::to_le_bytes).concat();
    let in_row = |(row, bits): (u32, u8)| {
        let first = (origin & 0xffff) + bits.trailing_zeros();
        (bits != 0).then(|| Span {
            row: (origin >> 16) + row,
            columns: [first, first + bits.count_ones()],
        })
    };
    (is_larger == 0).then(|| (0..).zip(rows).filter_map(in_row).collect())
}

/// The spans of a rectangle's word (glsl/rects.glsl) that needs no mask.
fn filled(word: u32) -> Vec<Span> {
    if word == u32::MAX {
        return Vec::new();
    }
    let [column, row] = [word & 0xfff, word >> 12 & 0xfff];
    let [columns, rows] = [(word >> 24 & 7) + 1, (word >> 27 & 7) + 1];
    let columns = [column, column + columns];
    (row..row + rows).map(|row| Span { row, columns }).collect()
}

/// Checks the lists of a frame of tiles whose splats have these quads; returns how many spans there are, and how many splats
/// have other spans than the twin finds, at a tie.
fn check(stages: &mut Stages, what: &str, quads: &[Quad]) -> [usize; 2] {
    let size = [SIZE.0, SIZE.1];
    let tiles = [size[0].div_ceil(TILE_WIDTH), size[1].div_ceil(TILE_HEIGHT)];
    let splats = stages.splats();
    let counts = stages.counts();
    assert_eq!(counts.has_room, 1, "{what}");
    let begins: Vec<u32> = stages.read("tile_begins");
    let begins = &begins[..(tiles[0] * tiles[1] + 1) as usize];
    let mut lists: Vec<u32> = stages.read("tile_splats");
    lists.truncate(counts.pairs as usize);
    let found = listed(begins, &lists, splats.len(), tiles[0]);
    // The lists are exactly those of the spans, in the order of depth.
    let (depths, numbers) = places(stages);
    let order = sort::order(&depths, &numbers);
    let twin = bin::bin(&found, &order, tiles);
    assert!((begins, &lists) == (&twin.0[..], &twin.1), "{what}");
    if stages.is_cpus() {
        check_rows(stages, what, &found, &order, tiles[1]);
    }
    // The spans are those of the splats' masks, and those of the twin except for ties.
    let masks: Vec<[u32; 4]> = stages.read("tile_masks");
    let rects = if stages.is_cpus() {
        &[]
    } else {
        masks[stages.scene.len()..].as_flattened()
    };
    let (mut all, mut ties) = (0, 0);
    assert_eq!(quads.len(), splats.len(), "{what}");
    for (index, (splat, quad)) in splats.iter().zip(quads).enumerate() {
        let ours = &found[index];
        // Pipelines for GPUs leave a mask only where a rectangle does not tell everything.
        let rect = rects.get(index).copied();
        let has_mask = rect.is_none_or(|rect| rect != u32::MAX && rect >= 1 << 30);
        if let Some(rect) = rect.filter(|_| !has_mask) {
            let filled = filled(rect);
            assert!(*ours == filled, "{what}: {ours:?} against {filled:?}");
        } else if let Some(masked) = masked(masks[index]) {
            assert!(*ours == masked, "{what}: {ours:?} against {masked:?}");
        }
        let single = outline::<f32>(splat, quad);
        let twin = single.spans(size, single.margin());
        all += twin.len();
        if *ours != twin {
            // They hold at least what the contour reaches, and at most what twice the margin allows.
            let truth = outline::<f64>(splat, quad);
            let least = truth.spans(size, 0.0);
            let most = truth.spans(size, 2.0 * truth.margin());
            assert!(
                holds(ours, &least) && holds(&most, ours),
                "{what}: {ours:?}, at least {least:?}, at most {most:?}: {splat:?}"
            );
            ties += 1;
        }
    }
    [all, ties]
}

/// Checks the spans of each row of tiles, from which the pipelines for CPU drivers make the lists.
fn check_rows(stages: &mut Stages, what: &str, found: &[Vec<Span>], order: &[u32], rows: u32) {
    let row_begins: Vec<u32> = stages.read("row_begins");
    let span_splats: Vec<u32> = stages.read("span_splats");
    let span_columns: Vec<u32> = stages.read("span_columns");
    let mut twin = vec![Vec::new(); rows as usize];
    for &splat in order {
        for span in &found[splat as usize] {
            twin[span.row as usize].push((splat, span.columns));
        }
    }
    for (row, spans) in twin.iter().enumerate() {
        let places = row_begins[row] as usize..row_begins[row + 1] as usize;
        let columns = |at: u32| [at & 0xffff, at >> 16];
        let ours = places.map(|at| (span_splats[at], columns(span_columns[at])));
        assert!(ours.eq(spans.iter().copied()), "{what}, row {row}");
    }
}

/// Says whether each span of `inner` is within one of `outer`.
fn holds(outer: &[Span], inner: &[Span]) -> bool {
    inner.iter().all(|inner| {
        outer.iter().any(|outer| {
            outer.row == inner.row
                && outer.columns[0] <= inner.columns[0]
                && outer.columns[1] >= inner.columns[1]
        })
    })
}

#[test]
fn tiles_hold_the_splats_that_the_twin_puts_there() {
    let [mut all, mut ties] = [0, 0];
    frame::for_each_scene(|stages, scene| {
        for (view, mode) in [(0, Mode::None), (1, Mode::None), (0, Mode::Exact)] {
            let settings = Settings::default().mode(mode).form(ExactForm::Affine);
            let clip = frame::clip(scene, 1, ClipOp::And);
            let camera = frame::views(scene)[view];
            // Frames of tiles leave no quads, whose sides bound the outlines.
            stages.draw(&camera, &clip, &settings.raster(Raster::Quad));
            let count = stages.splat_gaussians().len();
            let quads = stages.quads(count);
            stages.draw(&camera, &clip, &settings.raster(Raster::Tiles));
            if !scene.is_empty() && count > 0 {
                let [spans, apart] = check(stages, &format!("{}, {mode:?}", scene.len()), &quads);
                all += spans;
                ties += apart;
            }
        }
    });
    println!("{all} spans, {ties} splats with others than the twin's");
    assert!(all > 50_000, "{all}");
    // One in twenty thousand; with another margin than the twin's it would be one in a few hundred.
    assert!(ties * 20_000 <= all, "{ties} of {all}");
}

/// A splat whose contour of 1/255 runs through pixel centres at the corners of tiles: single precision may draw it there
/// or not, and tiles draw it where quads do.
#[test]
fn tiles_reach_pixel_centres_on_the_contour() {
    let mut stages = Stages::new();
    let mut camera =
        Camera::from_world_to_camera(DMat4::IDENTITY, (512.0, 512.0, 48.0, 40.0), (96, 80))
            .expect("a camera at the origin");
    let mut on_contour = 0;
    for step in 0..120 {
        let turn =
            Quat::from_rotation_z(0.37 * step as f32) * Quat::from_rotation_x(0.2 * step as f32);
        let scale = Vec3::new(0.02 + 0.002 * (step % 17) as f32, 0.004, 0.01);
        let opacity = [0.02, 0.2, 0.6, 0.99][step % 4];
        let scene = frame::one(Vec3::new(0.0, 0.0, 2.0), scale, turn, opacity);
        let base = project::project(
            &scene,
            0,
            &ViewTransform::<f64>::new(&camera),
            &Settings::default(),
        );
        let f = base.expect("in view").footprint;
        // The contour's ends to the left and to the right, above and below, each on the centre of a pixel that is the
        // first or the last of its tile.
        let [k0, k1, k2] = f.conic;
        let right = [f.extent / k0, -k1 / k2 * f.extent / k0];
        let k = (k0 * k0 + k1 * k1).sqrt();
        let below = [-k1 / k * f.extent / k0, f.extent * k / (k0 * k2)];
        let ends = [right, right.map(|x| -x), below, below.map(|x| -x)];
        let [dx, dy] = ends[step % 4];
        // A right or lower end is on the first pixel of a tile, a left or upper one on the last.
        let pixel = if step % 2 == 0 { 56.5 } else { 39.5 };
        (camera.cx, camera.cy) = (pixel - dx, pixel - dy);
        stages.load(&scene);
        let mut draw = |raster| {
            let settings = Settings::default().raster(raster);
            stages.draw(&camera, &Clip::default(), &settings);
            stages.headless.picture().expect("reads back")
        };
        let quads = draw(Raster::Quad);
        let tiles = draw(Raster::Tiles);
        for (at, (a, b)) in quads.pixels.iter().zip(&tiles.pixels).enumerate() {
            for (a, b) in a.iter().zip(b) {
                assert!(
                    (a - b).abs() <= 1e-4,
                    "step {step}, pixel {at}: {a} by quads, {b} by tiles"
                );
            }
        }
        let at = pixel as usize * 96 + pixel as usize;
        on_contour += usize::from(quads.pixels[at][3] > 0.0);
    }
    assert!(
        (20..=110).contains(&on_contour),
        "{on_contour} of 120 are drawn at their contour's end"
    );
}
