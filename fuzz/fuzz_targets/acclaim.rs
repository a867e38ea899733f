//! Motion out of an .amc with the .asf before it, a zero byte between them. Every error is one line.
#![no_main]

use libfuzzer_sys::fuzz_target;
use nabiki_fuzz::within_budget;
use nabiki_io::motion::{self, Axis, MotionSource};

fuzz_target!(|text: &str| {
    within_budget(text.len(), || {
        let Some((skeleton, motion)) = text.split_once('\0') else { return };
        let source = MotionSource {
            file: "motion.amc".into(),
            skeleton: Some("skeleton.asf".into()),
            unit_cm: Some(1.0),
            up: Some(Axis::PlusY),
            facing: Some(Axis::PlusZ),
            frames_per_second: Some(60.0),
            ..MotionSource::default()
        };
        let read = motion::track(&source, motion, Some(skeleton)).and_then(|track| track.head_motion(&source, 24.0));
        if let Err(error) = read {
            assert!(!error.to_string().contains('\n'), "{error}");
        }
    });
});
