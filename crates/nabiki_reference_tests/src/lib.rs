//! Where the shared reference data lie. The tests are in `tests/`; `cargo test` ignores them where the data are absent.

#![forbid(unsafe_code)]

use std::path::{Path, PathBuf};

/// The path of a file of the shared data, by its path there: `hair/sintel_hair_16pts.tfx`.
///
/// # Panics
/// Where it is not there: the folder is, or the test would have been ignored.
pub fn shared(name: &str) -> PathBuf {
    let path = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/data")).join(name);
    assert!(path.exists(), "{} is absent: the shared data are incomplete", path.display());
    path
}
