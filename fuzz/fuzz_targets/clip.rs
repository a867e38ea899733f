//! Motion of a node out of a .glb. Every error is one line.
#![no_main]

use libfuzzer_sys::fuzz_target;
use nabiki_fuzz::within_budget;
use nabiki_io::motion::{self, MotionSource};

fuzz_target!(|bytes: &[u8]| {
    within_budget(bytes.len(), || {
        // Without a path, so that buffers in files of their own are not looked for.
        if let Err(error) = motion::clip(&MotionSource::default(), bytes, 24.0) {
            assert!(!error.to_string().contains('\n'), "{error}");
        }
    });
});
