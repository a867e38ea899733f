//! Motion out of the same text as .bvh and as .csv. Every error is one line.
#![no_main]

use libfuzzer_sys::fuzz_target;
use nabiki_fuzz::within_budget;
use nabiki_io::motion::{self, Axis, MotionSource};

fuzz_target!(|text: &str| {
    within_budget(text.len(), || {
        for file in ["motion.bvh", "motion.csv"] {
            let source = MotionSource {
                file: file.into(),
                unit_cm: Some(1.0),
                up: Some(Axis::PlusY),
                facing: Some(Axis::PlusZ),
                ..MotionSource::default()
            };
            let read = motion::track(&source, text, None).and_then(|track| track.head_motion(&source, 24.0));
            if let Err(error) = read {
                assert!(!error.to_string().contains('\n'), "{error}");
            }
        }
    });
});
