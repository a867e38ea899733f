//! What happens when the program is told to end: Ctrl-C, a terminal that closes, a system that shuts down.

/// Removes unfinished files, then ends the program as shells expect of one that was interrupted.
pub fn remove_parts_on_signals() {
    const INTERRUPTED: i32 = 130;
    // Without a handler files are left as after a crash, and the next run to the same place removes them.
    let _ = ctrlc::set_handler(|| {
        nabiki_file::remove_unfinished();
        std::process::exit(INTERRUPTED);
    });
}
