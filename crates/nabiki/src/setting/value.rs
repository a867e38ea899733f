//! The types of settings: their checks, and their values as data.

use std::path::PathBuf;

use glam::{Vec2, Vec3};

use super::{Datum, Kind, Place, Range, refused};
use crate::error::SettingError;

/// A type of a setting.
pub trait Value {
    /// Its description.
    const KIND: Kind;

    /// Refuses a value outside `range`. `at` is its name.
    ///
    /// # Errors
    /// The value is outside the range, which the error contains.
    fn check(&self, at: &Place, range: &Range) -> Result<(), SettingError>;

    /// The value as data.
    fn datum(&self) -> Datum;
}

macro_rules! numbers {
    ($($type:ident)*) => {$(
        impl Value for $type {
            const KIND: Kind = Kind::Number;

            fn check(&self, at: &Place, range: &Range) -> Result<(), SettingError> {
                if is_within(*self, range) { Ok(()) } else { refused(at, self, range.remedy()) }
            }

            fn datum(&self) -> Datum {
                number(*self)
            }
        }
    )*};
}

numbers!(f32 f64);

/// A number of 32 or 64 bits.
trait Number: Copy + PartialOrd + std::fmt::Display {
    fn of(bound: f64) -> Self;
    fn is_finite(self) -> bool;
}

impl Number for f32 {
    fn of(bound: f64) -> Self {
        bound as Self
    }

    fn is_finite(self) -> bool {
        self.is_finite()
    }
}

impl Number for f64 {
    fn of(bound: f64) -> Self {
        bound
    }

    fn is_finite(self) -> bool {
        self.is_finite()
    }
}

fn is_within<T: Number>(value: T, range: &Range) -> bool {
    value.is_finite()
        && range.above.is_none_or(|above| value > T::of(above))
        && range.least.is_none_or(|least| value >= T::of(least))
        && range.most.is_none_or(|most| value <= T::of(most))
}

fn number<T: Number>(value: T) -> Datum {
    Datum::Number(value.to_string().parse().unwrap_or(f64::NAN))
}

macro_rules! wholes {
    ($($type:ident)*) => {$(
        impl Value for $type {
            #[allow(clippy::unnecessary_cast, clippy::cast_possible_wrap, reason = "one text for all types")]
            const KIND: Kind = Kind::Whole {
                least: $type::MIN as i64,
                // The range of TOML.
                most: if $type::MAX as u64 > i64::MAX as u64 { i64::MAX } else { $type::MAX as i64 },
            };

            fn check(&self, at: &Place, range: &Range) -> Result<(), SettingError> {
                let value = *self as i128;
                let low = range.least.is_some_and(|least| value < least as i128);
                let high = range.most.is_some_and(|most| value > most as i128);
                if low || high { refused(at, self, range.whole_remedy()) } else { Ok(()) }
            }

            fn datum(&self) -> Datum {
                Datum::Whole(*self as i64)
            }
        }
    )*};
}

wholes!(u32 u64 usize i32);

macro_rules! texts {
    ($($type:ident $kind:ident $text:expr;)*) => {$(
        impl Value for $type {
            const KIND: Kind = Kind::$kind;

            fn check(&self, _: &Place, _: &Range) -> Result<(), SettingError> {
                Ok(())
            }

            fn datum(&self) -> Datum {
                $text(self)
            }
        }
    )*};
}

texts! {
    bool Flag |flag: &bool| Datum::Flag(*flag);
    String Text |text: &String| Datum::Text(text.clone());
    PathBuf Path |path: &PathBuf| Datum::Text(path.to_string_lossy().into_owned());
}

/// Refuses a group of numbers if one is out of range.
fn check_each<T: Number>(
    values: &[T],
    shown: impl std::fmt::Display,
    at: &Place,
    range: &Range,
) -> Result<(), SettingError> {
    if values.iter().all(|&value| is_within(value, range)) {
        return Ok(());
    }
    let which = if matches!(range.unit, "sRGB" | "linear") { "each of red, green and blue" } else { "each number" };
    refused(at, shown, format!("{which} {}", range.remedy()))
}

macro_rules! vectors {
    ($($type:ident $count:literal)*) => {$(
        impl Value for $type {
            const KIND: Kind = Kind::Numbers($count);

            fn check(&self, at: &Place, range: &Range) -> Result<(), SettingError> {
                check_each(&self.to_array(), self, at, range)
            }

            fn datum(&self) -> Datum {
                Datum::List(self.to_array().map(number).to_vec())
            }
        }
    )*};
}

vectors!(Vec2 2 Vec3 3);

impl<const N: usize> Value for [f32; N] {
    const KIND: Kind = Kind::Numbers(N);

    fn check(&self, at: &Place, range: &Range) -> Result<(), SettingError> {
        check_each(self, format!("{self:?}"), at, range)
    }

    fn datum(&self) -> Datum {
        Datum::List(self.map(number).to_vec())
    }
}

impl Value for [u32; 2] {
    const KIND: Kind = Kind::Wholes(2);

    fn check(&self, at: &Place, range: &Range) -> Result<(), SettingError> {
        if self.iter().all(|&side| is_within(f64::from(side), range)) {
            return Ok(());
        }
        refused(at, format!("{} x {}", self[0], self[1]), format!("each number {}", range.remedy()))
    }

    fn datum(&self) -> Datum {
        Datum::List(self.map(|side| Datum::Whole(side.into())).to_vec())
    }
}

impl<T: Value> Value for Option<T> {
    const KIND: Kind = T::KIND;

    fn check(&self, at: &Place, range: &Range) -> Result<(), SettingError> {
        self.as_ref().map_or(Ok(()), |value| value.check(at, range))
    }

    fn datum(&self) -> Datum {
        self.as_ref().map_or(Datum::Open, Value::datum)
    }
}

impl<T: Value> Value for Vec<T> {
    const KIND: Kind = Kind::List(&T::KIND);

    fn check(&self, at: &Place, range: &Range) -> Result<(), SettingError> {
        self.iter().enumerate().try_for_each(|(i, value)| value.check(&at.entry(i), range))
    }

    fn datum(&self) -> Datum {
        Datum::List(self.iter().map(Value::datum).collect())
    }
}
