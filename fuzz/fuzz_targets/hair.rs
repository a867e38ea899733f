//! Whatever is read as .hair can be written and reads the same again.
#![no_main]

use libfuzzer_sys::fuzz_target;
use nabiki_fuzz::within_budget;
use nabiki_io::hair_file;

fuzz_target!(|bytes: &[u8]| {
    within_budget(bytes.len(), || {
        if let Ok(hair) = hair_file::from_bytes(bytes) {
            hair.check_lengths().unwrap();
            let mut written = Vec::new();
            hair_file::to_writer(&hair, "", &mut written).unwrap();
            assert_eq!(hair_file::from_bytes(&written).unwrap(), hair);
        }
    });
});
