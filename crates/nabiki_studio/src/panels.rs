//! What is drawn of the session. Panels take it as it is and answer with commands.

pub mod dialogs;
pub mod fields;
pub mod files;
pub mod hands;
pub mod interval;
pub mod kept;
pub mod mend;
pub mod menu;
pub mod number;
pub mod page;
pub mod status;
pub mod theme;
pub mod timeline;
pub mod welcome;

use crate::command::Command;

/// What panels ask for, in the order in which it is to be done.
pub type Commands = Vec<Command>;
