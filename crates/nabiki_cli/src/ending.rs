//! What happens when the program is told to end: Ctrl-C, a terminal that closes, a system that shuts down.

pub use self::system::remove_parts_on_signals;

#[cfg(unix)]
mod system {
    use std::io::Write;
    use std::sync::Arc;
    use std::sync::atomic::AtomicBool;

    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM, SIGXFSZ};
    use signal_hook::iterator::Signals;

    /// Removes unfinished files, then ends the program by the signal itself: a shell that sees that ends its loop, too. Signals that whoever
    /// started the program has it ignore, as `nohup` does, it ignores.
    pub fn remove_parts_on_signals() {
        // A file that may not grow any more is an error that is said, as a full disk is.
        let _ = signal_hook::flag::register(SIGXFSZ, Arc::new(AtomicBool::new(false)));
        let ignored = ignored();
        let ending = [SIGINT, SIGTERM, SIGHUP].into_iter().filter(|signal| ignored >> (signal - 1) & 1 == 0);
        // Without a handler files are left as after a crash, and the next run to the same place removes them.
        let Ok(mut signals) = Signals::new(ending) else { return };
        let watch = move || {
            let Some(signal) = signals.forever().next() else { return };
            nabiki_file::remove_unfinished();
            // Who pressed Ctrl-C knows it. A terminal that closed takes no more words.
            if let Some(name) = signal_hook::low_level::signal_name(signal).filter(|_| signal != SIGINT) {
                let _ = writeln!(std::io::stderr(), "nabiki: ended by {name}");
            }
            let _ = signal_hook::low_level::emulate_default_handler(signal);
        };
        // Without a thread, too.
        let _ = std::thread::Builder::new().name("ending".to_owned()).spawn(watch);
    }

    /// The signals that the program was started to ignore, a bit each from signal 1 on, where the system has a file that says so.
    fn ignored() -> u64 {
        let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
        let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
        mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).unwrap_or(0)
    }
}

#[cfg(not(unix))]
mod system {
    /// Removes unfinished files, then ends the program.
    pub fn remove_parts_on_signals() {
        const INTERRUPTED: i32 = 130;
        let _ = ctrlc::set_handler(|| {
            nabiki_file::remove_unfinished();
            std::process::exit(INTERRUPTED);
        });
    }
}
