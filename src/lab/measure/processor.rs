//! Time that the processor has spent, which is steadier than elapsed time on a machine that does other things too.

/// Time that all threads of this process have spent on a processor so far, ms, as Linux's scheduler counts it; 0 where
/// there is no such count.
pub fn processor_ms() -> f64 {
    if !cfg!(any(target_os = "linux", target_os = "android")) {
        return 0.0; // other systems have no such files
    }
    let Ok(threads) = std::fs::read_dir("/proc/self/task") else {
        return 0.0;
    };
    let spent = |thread: std::fs::DirEntry| -> Option<f64> {
        let text = std::fs::read_to_string(thread.path().join("schedstat")).ok()?;
        text.split_whitespace().next()?.parse().ok()
    };
    threads.flatten().filter_map(spent).sum::<f64>() / 1e6
}
