//! Every frame of whatever opens as a motion cache.
#![no_main]

use libfuzzer_sys::fuzz_target;
use nabiki_fuzz::within_budget;
use nabiki_io::cache::Reader;

fuzz_target!(|bytes: &[u8]| {
    within_budget(bytes.len(), || {
        if let Ok(mut cache) = Reader::from_bytes(bytes) {
            for frame in 0..cache.frame_count() {
                let _ = cache.hair(frame);
            }
        }
    });
});
