//! Everything out of whatever opens as an Alembic archive; attributes always fit the strands.
#![no_main]

use std::io::Cursor;

use libfuzzer_sys::fuzz_target;
use nabiki_alembic::ArchiveReader;
use nabiki_exchange::GroomReader;
use nabiki_fuzz::within_budget;

fuzz_target!(|bytes: &[u8]| {
    within_budget(bytes.len(), || {
        let Ok(mut file) = ArchiveReader::new(Cursor::new(bytes.to_vec())) else { return };
        let _ = file.contents();
        for (frame, segments) in [(0, None), (1, Some(3)), (usize::MAX, None)] {
            if let Ok(hair) = file.hair(frame, segments) {
                hair.check_lengths().unwrap();
                assert!(hair.strands.points().iter().all(|p| p.is_finite()));
            }
        }
        let _ = file.mesh();
        let _ = file.motion("head");
    });
});
