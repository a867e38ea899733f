//! `cargo run --release -p nabiki_bust` writes `crates/nabiki_groom/src/bust/bust.bin` anew, after the bust has changed.
//! With `-- characters`, it writes the characters of the scenes into `scenes/characters`.

use std::io;

fn main() -> io::Result<()> {
    let root = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");
    let files = match std::env::args().nth(1).as_deref() {
        None => vec![("crates/nabiki_groom/src/bust/bust.bin".to_owned(), nabiki_bust::bake())],
        Some("characters") => {
            std::fs::create_dir_all(format!("{root}/scenes/characters"))?;
            let wanted = std::env::args().nth(2);
            let is_wanted = |name: &str| wanted.as_deref().is_none_or(|wanted| name.starts_with(wanted));
            let makers = nabiki_bust::characters::ALL.iter().filter(|(name, _)| is_wanted(name));
            makers.map(|(name, make)| (format!("scenes/characters/{name}"), make())).collect()
        }
        Some(other) => return Err(io::Error::other(format!("{other}: give nothing, or `characters`"))),
    };
    for (path, bytes) in files {
        std::fs::write(format!("{root}/{path}"), &bytes)?;
        println!("{path}: {} bytes", bytes.len());
    }
    Ok(())
}
