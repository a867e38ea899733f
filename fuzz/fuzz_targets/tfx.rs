//! Whatever is read as .tfx, of either version, can be written as version 4 with the same strands.
#![no_main]

use libfuzzer_sys::fuzz_target;
use nabiki_fuzz::within_budget;
use nabiki_io::tfx;

fuzz_target!(|bytes: &[u8]| {
    within_budget(bytes.len(), || {
        if let Ok(hair) = tfx::from_bytes(bytes) {
            hair.check_lengths().unwrap();
            let mut written = Vec::new();
            tfx::to_writer(&hair, &mut written).unwrap();
            assert_eq!(tfx::from_bytes(&written).unwrap().strands, hair.strands);
        }
    });
});
