//! What a command tells on the standard output.

use std::fmt;
use std::io::{ErrorKind, Write};

use nabiki_io::screen::{Lines, OneLine, is_unsafe};
use nabiki_scene::{Error, Result};

/// A line of report, like `println!`, but work goes on when nobody listens any more (`nabiki run ... | head`).
macro_rules! say {
    ($($told:tt)*) => {{
        let _ = $crate::say::line(format_args!($($told)*));
    }};
}
pub(crate) use say;

/// Writes a line, or lines. All that a terminal would obey is escaped here, wherever it comes from.
pub fn line(told: fmt::Arguments) -> std::io::Result<()> {
    writeln!(std::io::stdout(), "{}", Lines(told))
}

/// Writes why the command failed: one line, on the standard error.
pub fn failure(error: impl fmt::Display) {
    // Who closed it does not want to know.
    let _ = writeln!(std::io::stderr(), "nabiki: {}", OneLine(error));
}

/// Says what the command line makes no sense for, and ends. What clap colours is as it is unless an argument holds what a terminal obeys.
pub fn misuse(error: &clap::Error) -> ! {
    let text = error.render().to_string();
    if error.use_stderr() && text.contains(|c| c != '\n' && is_unsafe(c)) {
        let _ = write!(std::io::stderr(), "{}", Lines(text));
        std::process::exit(error.exit_code());
    }
    error.exit()
}

/// Writes what the whole command is for; whoever stops reading has read enough.
pub fn answer(told: impl fmt::Display) -> Result<()> {
    match line(format_args!("{told}")) {
        Err(e) if e.kind() != ErrorKind::BrokenPipe => Err(Error::refused(format!("standard output: {e}"))),
        _ => Ok(()),
    }
}
