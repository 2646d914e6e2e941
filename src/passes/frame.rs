//! The frame, from its constants to the draw.

use crate::gpu::{Buffer, Recorder};
use crate::passes::stage::{Frame, STAGES};
use crate::passes::work::Work;

/// Records everything up to the draw. `readback` gets a copy of the counts for the host.
pub(crate) fn record(frame: &Frame<'_>, recorder: &mut Recorder<'_>, readback: &Buffer) {
    let (plan, b) = (frame.plan, frame.buffers);
    if plan.work != Work::Draw {
        recorder.label("frame", |r| {
            r.update(&b.frame, 0, bytemuck::bytes_of(&plan.data));
        });
    }
    for stage in STAGES.iter().filter(|stage| (stage.needed)(plan)) {
        recorder.pass(stage.name, |r| (stage.record)(frame, r));
    }
    if let Some(t) = b.tiles.as_ref().filter(|_| plan.is_tiled()) {
        recorder.ready_to_draw(&[&t.picture, &t.begins]);
    }
    if let Some(d) = b.depth.as_ref().filter(|_| plan.way.expects_depth) {
        recorder.ready_to_draw(&[&d.depths, &d.draw]);
    }
    recorder.label("counts", |r| {
        let all = ash::vk::BufferCopy::default().size(b.counts.size());
        r.copy(&b.counts, readback, &[all]);
        r.ready_for_host(&[readback]);
    });
    let order = &b.order[plan.sorted()];
    recorder.ready_to_draw(&[&b.frame, &b.counts, &b.splats, order, &b.cuts]);
}
