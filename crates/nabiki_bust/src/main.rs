//! Writes `crates/nabiki_groom/src/bust/bust.bin` anew: `cargo run --release -p nabiki_bust`, after the bust has changed.

use std::io;

fn main() -> io::Result<()> {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../nabiki_groom/src/bust/bust.bin");
    let bytes = nabiki_bust::bake();
    std::fs::write(path, &bytes)?;
    println!("{} bytes", bytes.len());
    Ok(())
}
