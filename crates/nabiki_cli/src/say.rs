//! What a command tells on the standard output.

use std::fmt;
use std::io::{ErrorKind, Write};

use nabiki_scene::{Error, Result};

/// A line of report, like `println!`, but work goes on when nobody listens any more (`nabiki run ... | head`).
macro_rules! say {
    ($($told:tt)*) => {{
        let _ = $crate::say::line(format_args!($($told)*));
    }};
}
pub(crate) use say;

/// Writes a line.
pub fn line(told: fmt::Arguments) -> std::io::Result<()> {
    writeln!(std::io::stdout(), "{told}")
}

/// Writes what the whole command is for; whoever stops reading has read enough.
pub fn answer(told: impl fmt::Display) -> Result<()> {
    match line(format_args!("{told}")) {
        Err(e) if e.kind() != ErrorKind::BrokenPipe => Err(Error::refused(format!("standard output: {e}"))),
        _ => Ok(()),
    }
}
