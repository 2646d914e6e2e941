//! What the processor has spent: steadier than time on a machine that does other things too.

/// Time that all threads of this process have spent on a processor so far, ms: what Linux's scheduler has counted. 0 where
/// it says nothing.
pub fn processor_ms() -> f64 {
    let Ok(threads) = std::fs::read_dir("/proc/self/task") else {
        return 0.0;
    };
    let spent = |thread: std::fs::DirEntry| -> Option<f64> {
        let text = std::fs::read_to_string(thread.path().join("schedstat")).ok()?;
        text.split_whitespace().next()?.parse().ok()
    };
    threads.flatten().filter_map(spent).sum::<f64>() / 1e6
}
