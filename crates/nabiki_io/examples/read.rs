//! Reads the hair of files into head space, for an engine. docs/guides/game.md shows it.
//!
//!     cargo run --release -p nabiki_io --example read -- groom.usdc

use std::path::Path;

use nabiki::Strands;
use nabiki_io::hair::{Cleaning, import};
use nabiki_io::{Axis, Placement, Result, declared_space};

/// The hair of a file in head space: cm, y up, the face along +x.
fn strands_of(file: &Path) -> Result<Strands> {
    // USD stores unit and up axis. No format stores where the face looks.
    let space = declared_space(file)?;
    let up = space.up.unwrap_or(Axis::PlusY);
    let facing = Axis::PlusX;
    let placement = Placement { unit: space.unit.unwrap_or_default(), up, facing, ..Placement::default() };
    let (hair, _report) = import(file, &placement, &Cleaning::default())?;
    Ok(hair.strands)
}

fn main() -> Result<()> {
    for file in std::env::args().skip(1) {
        let hair = strands_of(file.as_ref())?;
        println!("{file}: {} strands, {} segments", hair.len(), hair.segment_count());
    }
    Ok(())
}
