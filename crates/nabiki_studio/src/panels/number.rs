//! A number as a field that is dragged or typed into. What is typed and cannot be taken is refused in words, and leaves the
//! number as it was.

use std::cell::RefCell;
use std::ops::RangeInclusive;

use eframe::egui::{DragValue, Response, Ui, vec2};

use super::Commands;
use crate::command::Command;

/// A field for a number.
#[derive(Clone, Debug)]
pub struct Number<'a> {
    /// What it may be.
    pub range: RangeInclusive<f64>,
    /// What a drag by one point adds.
    pub step: f64,
    /// Most digits after the point; with none it is whole.
    pub decimals: usize,
    /// What stands before it.
    pub before: &'a str,
    /// Its unit.
    pub unit: &'a str,
    /// Width; as wide as it must be if none is given.
    pub wide: Option<f32>,
}

impl Default for Number<'_> {
    /// Any number that a scene can hold.
    fn default() -> Self {
        let range = f64::from(f32::MIN)..=f64::from(f32::MAX);
        Self { range, step: 1.0, decimals: 6, before: "", unit: "", wide: None }
    }
}

impl Number<'_> {
    /// Draws it. It takes what was typed when it is finished.
    pub fn ui(&self, ui: &mut Ui, number: &mut f64, commands: &mut Commands) -> Response {
        let was = *number;
        let refused = RefCell::new(None);
        let read = |text: &str| {
            let read = self.read(text, was);
            if read.is_none() {
                *refused.borrow_mut() = Some(text.trim().to_owned());
            }
            read
        };
        let field = DragValue::new(number).speed(self.step).max_decimals(self.decimals).range(self.range.clone());
        let field = field.prefix(self.before).suffix(suffix(self.unit)).custom_parser(read);
        // What is out of its range already stays so until a hand changes it.
        let field = field.update_while_editing(false).clamp_existing_to_range(false);
        let response = match self.wide {
            Some(wide) => ui.add_sized(vec2(wide, ui.spacing().interact_size.y), field),
            None => ui.add(field),
        };
        // Other programs may set it without typing.
        if *number != was && !self.may_be(*number) {
            *number = was;
        }
        if let Some(text) = refused.into_inner().filter(|text| !text.is_empty()) {
            commands.push(Command::Say(format!("\"{text}\" is not taken: {}", self.wanted())));
        }
        response
    }

    fn may_be(&self, number: f64) -> bool {
        number.is_finite() && self.range.contains(&number) && (self.decimals > 0 || number.fract() == 0.0)
    }

    fn read(&self, text: &str, was: f64) -> Option<f64> {
        let bare: String = text.chars().filter(|c| !c.is_whitespace()).collect();
        let read = bare.replace('\u{2212}', "-").parse::<f64>().ok()?;
        // A number that was only looked at keeps the digits that are not shown.
        let shown =
            (0.500_001 * 10.0_f64.powi(-(self.decimals as i32))).max(16.0 * f64::from(f32::EPSILON) * was.abs());
        if read == was || (self.decimals > 0 && (read - was).abs() <= shown) {
            return Some(was);
        }
        self.may_be(read).then_some(read)
    }

    fn wanted(&self) -> String {
        let what = if self.decimals == 0 { "a whole number" } else { "a number" };
        let (least, most) = (*self.range.start(), *self.range.end());
        // Beyond that, ends are those of what a file can hold.
        match (least > -1e15, most < 1e15) {
            (true, true) => format!("it must be {what} from {least} to {most}"),
            (true, false) => format!("it must be {what} of at least {least}"),
            _ => format!("it must be {what}"),
        }
    }
}

fn suffix(unit: &str) -> String {
    match unit {
        "" => String::new(),
        "degrees" => "\u{b0}".to_owned(),
        unit => format!(" {unit}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_number_of_the_range_is_refused() {
        let whole = Number { range: 1.0..=5e6, decimals: 0, ..Number::default() };
        for text in ["nan", "inf", "1e99", "-5", "0", "2.5", "5000001", "five", ""] {
            assert_eq!(whole.read(text, 60.0), None, "{text}");
        }
        assert_eq!(whole.read(" 5 000 ", 60.0), Some(5000.0));
        let any = Number::default();
        assert_eq!((any.read("1e99", 0.0), any.read("NaN", 0.0), any.read("-inf", 0.0)), (None, None, None));
        assert_eq!(any.read("\u{2212}2.5", 0.0), Some(-2.5));
        assert!(whole.wanted().contains("whole number from 1 to 5000000") && !any.wanted().contains("from"));
    }

    #[test]
    fn a_number_that_was_only_looked_at_keeps_what_is_not_shown() {
        let field = Number { range: 0.0..=10.0, decimals: 2, ..Number::default() };
        assert_eq!(field.read("57.65", 57.654_321), Some(57.654_321), "even out of its range");
        assert_eq!(field.read("5.66", 5.654_321), Some(5.66));
    }
}
