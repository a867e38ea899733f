//! The characters' files as they are committed.

use nabiki_bust::characters::ALL;

/// What one file, and what all of them, may take (bytes).
const EACH: usize = 600_000;
const TOGETHER: usize = 1_500_000;

#[test]
fn the_files_of_the_scenes_are_what_is_written_today() {
    let mut together = 0;
    for (name, make) in ALL {
        let path = format!("{}/../../scenes/characters/{name}", env!("CARGO_MANIFEST_DIR"));
        let file = std::fs::read(path).unwrap();
        assert!(file == make(), "run `cargo run --release -p nabiki_bust -- characters` to write {name} anew");
        assert!(file.len() < EACH, "{name} has {} bytes", file.len());
        together += file.len();
    }
    assert!(together < TOGETHER, "{together} bytes");
}
