//! The process itself: the signals that end it, and the folder in which drivers keep what they compile.

use std::ffi::OsString;
use std::path::Path;

/// Prepares the process, before it has a second thread.
pub(super) fn begin() {
    let variable = |name: &str| std::env::var_os(name);
    for (name, folder) in drivers_folders(variable) {
        // SAFETY: no other thread runs yet, so none reads the environment.
        unsafe { std::env::set_var(name, folder) };
    }
    #[cfg(unix)]
    signals::watch();
}

/// The variables that tell drivers where to keep what they compile, beside what rara keeps. They are only for a folder that
/// was named by `RARA_CACHE`: elsewhere a driver has a folder of its own, which others share. What somebody has set, stays.
fn drivers_folders(variable: impl Fn(&str) -> Option<OsString>) -> Vec<(&'static str, OsString)> {
    // Mesa (lavapipe, RADV, ANV and others) and NVIDIA's driver; each set as long as no variable of its row is.
    const ROWS: [(&str, &[&str]); 2] = [
        (
            "MESA_SHADER_CACHE_DIR",
            &["MESA_SHADER_CACHE_DIR", "MESA_GLSL_CACHE_DIR"],
        ),
        (
            "__GL_SHADER_DISK_CACHE_PATH",
            &["__GL_SHADER_DISK_CACHE_PATH"],
        ),
    ];
    let Some(own) = variable("RARA_CACHE").filter(|own| !own.is_empty()) else {
        return Vec::new();
    };
    // A driver's process may have another working directory.
    let Ok(own) = std::path::absolute(Path::new(&own)) else {
        return Vec::new();
    };
    let folder = own.join("driver");
    // Where it cannot be made, drivers do as they would.
    if folder
        .ancestors()
        .find(|part| part.exists())
        .is_none_or(|part| !part.is_dir())
    {
        return Vec::new();
    }
    let free = ROWS
        .iter()
        .filter(|(_, row)| row.iter().all(|name| variable(name).is_none()));
    free.map(|(name, _)| (*name, folder.clone().into()))
        .collect()
}

/// Makes the folder in which drivers keep what they compile, which NVIDIA's does not do by itself: before a device is opened,
/// and not by commands that need none.
pub fn make_drivers_folder() {
    let Some(own) = std::env::var_os("RARA_CACHE").filter(|own| !own.is_empty()) else {
        return;
    };
    // A driver that finds none keeps nothing.
    let _ = std::fs::create_dir_all(Path::new(&own).join("driver"));
}

#[cfg(unix)]
mod signals {
    use std::fs::File;
    use std::io::Write;
    use std::os::fd::AsFd;
    use std::sync::Arc;
    use std::sync::atomic::AtomicBool;
    use std::thread;

    use signal_hook::consts::{SIGABRT, SIGHUP, SIGINT, SIGTERM};
    use signal_hook::iterator::Signals;
    use signal_hook::{flag, low_level};

    use super::super::{film, output};

    /// What is said when something aborts: Rust where a small piece of memory is not to be had, and drivers.
    const ABORTED: &str = "the process was aborted, as happens when memory runs out or a driver gives up; draw a smaller \
        picture or fewer Gaussians, or let it have more memory (see ulimit -v)";

    /// Removes unfinished files when the process is told to end, and then ends it as the signal would have. A second signal
    /// ends it at once. What whoever started the process has it ignore, it ignores.
    pub(super) fn watch() {
        aborts();
        let heard: Vec<i32> = [SIGHUP, SIGINT, SIGTERM]
            .into_iter()
            .filter(|signal| !is_ignored(*signal))
            .collect();
        let told = Arc::new(AtomicBool::new(false));
        for &signal in &heard {
            // In this order: the first signal is what makes the next one the last.
            let last = flag::register_conditional_default(signal, told.clone());
            if last
                .and_then(|_| flag::register(signal, told.clone()))
                .is_err()
            {
                return;
            }
        }
        let Ok(mut signals) = Signals::new(heard) else {
            return;
        };
        let wait = move || {
            for signal in signals.forever() {
                output::settle();
                film::abandon();
                let what = match rara_base::files::abandon() {
                    0 => "no unfinished file was there",
                    _ => "the unfinished file is removed",
                };
                output::complain(format_args!("{}: interrupted; {what}", output::program()));
                let _ = low_level::emulate_default_handler(signal);
            }
        };
        // Without a thread the second signal ends the program.
        let _ = thread::Builder::new().name("signals".into()).spawn(wait);
    }

    /// True where the process was started to ignore a signal, as by nohup, or by a script in the background.
    fn is_ignored(signal: i32) -> bool {
        // SAFETY: all zeros are a sigaction, which the call overwrites; it changes nothing where no new one is given.
        unsafe {
            let mut now: libc::sigaction = std::mem::zeroed();
            libc::sigaction(signal, std::ptr::null(), &mut now) == 0
                && now.sa_sigaction == libc::SIG_IGN
        }
    }

    /// An abort becomes a sentence and exit status 1.
    fn aborts() {
        let Ok(stderr) = std::io::stderr().as_fd().try_clone_to_owned() else {
            return;
        };
        let stderr = File::from(stderr);
        let message = format!("{}: {ABORTED}\n", output::program());
        let explain = move || {
            let _ = (&stderr).write_all(message.as_bytes());
            low_level::exit(1);
        };
        // SAFETY: what runs in the signal's handler are the system calls write and _exit, which may.
        let _ = unsafe { low_level::register(SIGABRT, explain) };
    }
}

#[cfg(test)]
mod tests;
