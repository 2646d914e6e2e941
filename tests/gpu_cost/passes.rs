//! The commands of real frames, and what the model of GPUs (`rara_lab::measure::gpu_model`) takes for their invocations and their loads, held to each other and to
//! ceilings.

use std::collections::{BTreeMap, BTreeSet};

use rara::Raster;
use rara::types::{FrameCounts, FrameData};
use rara_base::limits;
use rara_gpu::{DispatchNote, DispatchedGroups};
use rara_lab::measure::gpu_model::{COSTS, FrameNumbers};

use crate::budget::{self, Rule, Table};
use crate::frames::{Drawn, Frame, Frames, LARGE, SMALL};
use crate::pipelines::declarations;

/// The fewest invocations that fill a large GPU, and the longest chain of loads that costs no more than a few hundredths of a
/// millisecond.
const FEWEST_INVOCATIONS: u64 = 16 << 10;
const MOST_LOADS: u64 = 64;
/// The Gaussians of the frame that these are about.
const GAUSSIANS: u64 = 5_000_000;

#[test]
fn passes_are_wide_short_and_frugal_at_five_million_gaussians() {
    let frames = Frames::on_a_gpus_pipelines((1920, 1080));
    let all = frames.all();
    let cut = all
        .iter()
        .find(|frame| frame.name == "tiles, exact, one plane");
    let numbers = heavy(numbers(&frames.draw(cut.expect("it is drawn"))));
    let (mut debts, mut moved) = (Table::new(), Table::new());
    for cost in &COSTS {
        let invocations = (cost.invocations)(&numbers);
        let loads = (cost.loads)(&numbers);
        if invocations < FEWEST_INVOCATIONS || loads > MOST_LOADS {
            let has = vec![("invocations", invocations), ("loads", loads)];
            debts.insert(cost.name.into(), has);
        }
        let of_thousand = (cost.bytes)(&numbers).div_ceil(GAUSSIANS / 1000);
        moved.insert(cost.name.into(), vec![("bytes", of_thousand)]);
    }
    frames.close();
    budget::check(BTreeMap::from([("passes".into(), debts)]), Rule::Debt);
    budget::check(BTreeMap::from([("bytes".into(), moved)]), Rule::Ceiling);
}

/// The numbers of a frame of five million Gaussians that are all in view, none of whose blocks is settled as a whole. The
/// picture's are those of another frame of its size.
fn heavy(picture: FrameNumbers) -> FrameNumbers {
    let gaussians = GAUSSIANS;
    let blocks = u64::div_ceil(gaussians, limits::BLOCK_SIZE.into());
    FrameNumbers {
        blocks,
        clip_blocks: blocks,
        view_blocks: blocks,
        kept_blocks: blocks,
        layers: 1,
        surfaces: 1,
        splats: gaussians,
        cut: gaussians / 20,
        changed: gaussians / 20,
        sort_passes: 3,
        tied: gaussians / 5, // a layer that is seen face on
        macro_pairs: 3 * gaussians / 2,
        masked_pairs: gaussians / 2,
        pairs: 3 * gaussians,
        filled_tiles: picture.tile_columns * picture.tile_rows / 2,
        several_tiles: picture.tile_columns * picture.tile_rows / 2,
        loaded: 3 * gaussians,
        ..picture
    }
}

/// The most dispatches and barriers of a frame whose clip cuts and which is drawn by tiles. Expected depths, which a host may
/// ask for besides, are a dispatch more.
const MOST: [u64; 2] = [32, 36];

#[test]
fn frames_have_the_commands_in_the_budget_and_the_invocations_that_passes_declare() {
    let frames = Frames::on_a_gpus_pipelines(SMALL);
    let (mut found, mut seen) = (Table::new(), BTreeSet::new());
    for frame in frames.all().iter().filter(|frame| frame.is_usual()) {
        let is_tiled = frame.raster == Raster::Tiles;
        if !is_tiled && !frame.is_counted() {
            continue;
        }
        let drawn = frames.draw(frame);
        if frame.is_counted() {
            let count = commands(frame, &drawn);
            let numbers = ["dispatches", "barriers"].into_iter().zip(count);
            found.insert(frame.name.clone(), numbers.collect());
        }
        if is_tiled {
            seen.extend(check_invocations(&frames, frame, &drawn));
        }
    }
    frames.close();
    budget::check(BTreeMap::from([("frames".into(), found)]), Rule::Ceiling);
    let frames = Frames::on_a_gpus_pipelines(LARGE);
    let first = &frames.all()[0];
    seen.extend(check_invocations(&frames, first, &frames.draw(first)));
    frames.close();
    let declared: BTreeSet<_> = COSTS.iter().map(|cost| cost.name).collect();
    assert_eq!(seen, declared, "some are declared that no frame has");
}

/// The dispatches and barriers of a frame.
fn commands(frame: &Frame, drawn: &Drawn) -> [u64; 2] {
    let recorded = &drawn.recorded;
    let count = [recorded.dispatches.len() as u64, recorded.barriers.into()];
    if frame.raster == Raster::Tiles && frame.planes > 0 && frame.moves == 0 {
        let most = [MOST[0] + u64::from(frame.wants_depth()), MOST[1]];
        assert!(
            count[0] <= most[0] && count[1] <= most[1],
            "{}: {count:?} dispatches and barriers, {most:?} are allowed whatever the budget says",
            frame.name
        );
    }
    count
}

/// Checks the workgroups of a frame's passes; returns their names.
fn check_invocations(frames: &Frames, frame: &Frame, drawn: &Drawn) -> BTreeSet<&'static str> {
    let numbers = numbers(drawn);
    let mut seen = BTreeSet::new();
    for dispatch in &drawn.recorded.dispatches {
        let cost = COSTS.iter().find(|cost| cost.name == dispatch.name);
        let cost = cost.unwrap_or_else(|| panic!("{}: no cost is declared", dispatch.name));
        let declared = (cost.invocations)(&numbers);
        let size = workgroup(frames, dispatch.name);
        let groups = groups(drawn, dispatch);
        // Passes of the sort that the keys do without have none.
        if groups == 0 {
            continue;
        }
        seen.insert(dispatch.name);
        assert_eq!(
            groups,
            declared.div_ceil(size),
            "{}: workgroups of {size} for {declared} invocations of {}: {numbers:?}",
            frame.name,
            dispatch.name
        );
    }
    seen
}

/// What a frame's working memory says of its numbers.
pub fn numbers(drawn: &Drawn) -> FrameNumbers {
    let bytes = drawn.buffer("frame");
    let data: FrameData = bytemuck::pod_read_unaligned(&bytes[..size_of::<FrameData>()]);
    let counts: FrameCounts = bytemuck::pod_read_unaligned(&drawn.buffer("counts"));
    let listed = |command: [u32; 4]| u64::from(command[3]);
    let bits = u32::BITS - (data.order.key_span >> data.order.key_shift).leading_zeros();
    let passes = bits.div_ceil(limits::SORT_BITS).max(1);
    FrameNumbers {
        blocks: data.scene.block_count.into(),
        clip_blocks: listed(counts.clip_groups),
        view_blocks: listed(counts.classify_groups),
        kept_blocks: listed(counts.compact_groups),
        layers: data.scene.layer_count.into(),
        splats: listed(counts.mesh_groups),
        cut: counts.cutoff.into(),
        changed: listed(counts.recut_groups),
        sort_passes: (passes - counts.sort_skipped).into(),
        tile_columns: data.tiles.tile_columns.into(),
        tile_rows: (data.tiles.tile_count / data.tiles.tile_columns).into(),
        macro_pairs: counts.macro_pairs.into(),
        pairs: counts.pairs.into(),
        filled_tiles: listed(counts.tile_groups),
        several_tiles: listed(counts.several_tile_groups),
        // Packed, as scenes are unless something else is asked for.
        sh_bytes: 4 * (1 + u64::from(data.scene.sh_coefficients)),
        record_bytes: 16 * u64::from(data.weight.cut_stride),
        ..FrameNumbers::default()
    }
}

/// The workgroups of a dispatch, by the command that its frame has left.
pub fn groups(drawn: &Drawn, dispatch: &DispatchNote) -> u64 {
    match &dispatch.groups {
        DispatchedGroups::Count(count) => (*count).into(),
        DispatchedGroups::Indirect { buffer, offset } => {
            let command = &drawn.buffer(buffer)[*offset as usize..][..12];
            let command: [u32; 3] = bytemuck::pod_read_unaligned(command);
            command.into_iter().map(u64::from).product()
        }
    }
}

/// Invocations of a workgroup of the pipelines of a name.
fn workgroup(frames: &Frames, name: &str) -> u64 {
    let shaders = frames.device.compiled_shaders();
    let shader = shaders.iter().find(|shader| shader.name == name);
    let shader = shader.expect("the pipeline was made");
    let declared = declarations(&shader.file);
    let mut sides = declared.workgroup;
    for (side, axis) in sides.iter_mut().zip(["x", "y", "z"]) {
        let constant = format!("local_size_{axis}");
        let constant = declared.constants.iter().find(|c| c.name == constant);
        let value = constant.and_then(|c| shader.constants.iter().find(|(id, _)| *id == c.id));
        *side = value.map_or(*side, |(_, value)| *value);
    }
    sides.into_iter().map(u64::from).product()
}
