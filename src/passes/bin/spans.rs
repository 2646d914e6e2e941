//! Finds the spans of each row of tiles, by runs of consecutive splats, then their splats in each of the row's tiles. The runs
//! are few and long, as suits processors.

use crate::passes::bin::lists::{self, pairs};
use crate::passes::eye_plan::EyePlan;
use crate::passes::recording::{Groups, Recording, counted};
use crate::passes::shaders::{
    span_count, span_scan, span_scatter, tile_count, tile_scan, tile_scatter,
};
use crate::passes::storage::{buffers, memory};
use crate::passes::{project, shared, sort};

memory! { EyePlan:
    /// Of each run the number of its spans in each row of tiles, and of its pairs.
    span_counts: |plan| scratch(plan, (rows(plan) + 1) * u64::from(plan.data.tiles.span_runs));
    row_begins: |plan| scratch(plan, rows(plan) + 1);
    span_splats: |plan| scratch(plan, pairs(plan));
    span_columns: |plan| scratch(plan, pairs(plan));
    /// Of each part of a row of tiles the splats in each column.
    column_counts: |plan| {
        let tiles = &plan.data.tiles;
        let parts = rows(plan) * u64::from(tiles.row_parts);
        scratch(plan, parts * (u64::from(tiles.tile_columns) + 1))
    };
}

/// Rows of tiles.
fn rows(plan: &EyePlan) -> u64 {
    (plan.data.tiles.tile_count / plan.data.tiles.tile_columns).into()
}

/// Bytes of so many words where these pipelines run.
fn scratch(plan: &EyePlan, words: u64) -> u64 {
    lists::scratch(plan, true, words)
}

pub(super) fn record(recording: &mut Recording<'_, '_, EyePlan>) {
    // The buffers that the sort has left over have room for the masks in the order of depth.
    let [mask_origins, masks_above, masks_below] = sort::spare(recording.plan);
    let order = sort::order(recording.plan);
    let buffers = buffers!(span_count {
        shared::MEMORY => [frame, counts],
        project::MEMORY => [splats, tile_masks],
        MEMORY => [span_counts];
        order, mask_origins, masks_above, masks_below,
    });
    recording.dispatch(buffers, (), counted!(span_count_groups));
    let buffers = buffers!(span_scan {
        shared::MEMORY => [frame, counts],
        MEMORY => [span_counts, row_begins],
    });
    recording.dispatch(buffers, (), Groups::Count(1));
    let buffers = buffers!(span_scatter {
        shared::MEMORY => [frame, counts],
        project::MEMORY => [splats],
        MEMORY => [span_counts, span_splats, span_columns];
        order, mask_origins, masks_above, masks_below,
    });
    recording.dispatch(buffers, (), counted!(span_groups));
    let buffers = buffers!(tile_count {
        shared::MEMORY => [frame],
        MEMORY => [row_begins, column_counts, span_columns],
    });
    recording.dispatch(buffers, (), counted!(part_groups));
    let buffers = buffers!(tile_scan {
        shared::MEMORY => [frame],
        MEMORY => [row_begins, column_counts];
        tile_begins: &lists::MEMORY.tile_begins,
    });
    recording.dispatch(buffers, (), counted!(row_groups));
    let buffers = buffers!(tile_scatter {
        shared::MEMORY => [frame, counts],
        MEMORY => [row_begins, column_counts, span_splats, span_columns];
        tile_splats: &lists::MEMORY.tile_splats,
    });
    recording.dispatch(buffers, (), counted!(part_groups));
    lists::record_coarse(recording);
}
