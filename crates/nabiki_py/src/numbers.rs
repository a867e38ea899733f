//! Numbers that Python gives as arguments. One out of its range is refused by its name, where Python's own conversion would speak of
//! integers that overflow.

use nabiki::dynamics::Motion;
use pyo3::exceptions::PyOverflowError;
use pyo3::inspect::PyStaticExpr;
use pyo3::prelude::*;
use pyo3::type_hint_identifier;

use crate::error;
use crate::values::shown;

macro_rules! whole {
    ($($(#[$doc:meta])* $name:ident($of:ty) = $thing:literal, $least:expr, $most:expr;)*) => {
        $(
            $(#[$doc])*
            #[derive(Clone, Copy)]
            pub struct $name(pub $of);

            impl FromPyObject<'_, '_> for $name {
                type Error = PyErr;

                const INPUT_TYPE: PyStaticExpr = type_hint_identifier!("builtins", "int");

                fn extract(given: Borrowed<'_, '_, PyAny>) -> PyResult<Self> {
                    within($thing, &given, i64::from($least), i64::from($most)).map(|number| Self(number as $of))
                }
            }
        )*
    };
}

const MOST_FRAMES: i32 = Motion::MOST_FRAMES as i32;

whole! {
    /// How many strands: the first of the scene's.
    Strands(usize) = "strands", 1, u32::MAX;
    /// The number of a frame; how many there are, the scene or file knows.
    FrameNumber(u32) = "frame", 0, u32::MAX;
    /// Segments of each strand.
    Segments(usize) = "segments", 1, u32::MAX;
    /// The number of frame 0 on a time line.
    FirstFrame(i32) = "first_frame", -MOST_FRAMES, MOST_FRAMES;
}

/// A whole number of a range.
fn within(thing: &str, given: &Bound<'_, PyAny>, least: i64, most: i64) -> PyResult<i64> {
    match given.extract() {
        Ok(number) if (least..=most).contains(&number) => Ok(number),
        Err(refused) if !refused.is_instance_of::<PyOverflowError>(given.py()) => Err(refused),
        _ => {
            let way_out = format!("must be a whole number from {least} to {most}");
            Err(error::argument(given.py(), thing, shown(given), &way_out))
        }
    }
}

/// The strength that no force of a field goes beyond.
pub struct Strongest(pub f32);

impl FromPyObject<'_, '_> for Strongest {
    type Error = PyErr;

    const INPUT_TYPE: PyStaticExpr = type_hint_identifier!("builtins", "float");

    fn extract(given: Borrowed<'_, '_, PyAny>) -> PyResult<Self> {
        match given.extract::<f64>() {
            Ok(strongest) if (strongest as f32).is_finite() && strongest >= 0.0 => Ok(Self(strongest as f32)),
            Err(refused) if !refused.is_instance_of::<PyOverflowError>(given.py()) => Err(refused),
            _ => {
                let way_out = "must be a finite strength of at least 0";
                Err(error::argument(given.py(), "strongest", shown(&given), way_out))
            }
        }
    }
}
