//! A number as a field that is dragged or typed into. What is typed and cannot be taken is refused in words, and leaves the
//! number as it was.

use std::cell::RefCell;
use std::ops::RangeInclusive;

use eframe::egui::{DragValue, Key, Response, Ui, vec2};

use super::Commands;
use crate::command::Command;

/// What stands for several numbers that differ.
const MIXED: &str = "mixed";

/// A field for a number.
#[derive(Clone, Debug)]
pub struct Number<'a> {
    /// What it is, for who has typed what it does not take.
    pub what: &'a str,
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
    /// The word for the end of its range; with none it is a number like the others.
    pub most: &'a str,
    /// Whether it stands for several numbers that differ: it shows that, and is a number only once one is typed or dragged.
    pub mixed: bool,
    /// Width; as wide as it must be if none is given.
    pub wide: Option<f32>,
}

impl<'a> Number<'a> {
    /// Any number that a scene can hold.
    pub fn of(what: &'a str) -> Self {
        let range = f64::from(f32::MIN)..=f64::from(f32::MAX);
        Self { what, range, step: 1.0, decimals: 6, before: "", unit: "", most: "", mixed: false, wide: None }
    }

    /// Draws it. It takes what was typed when it is finished.
    pub fn ui(&self, ui: &mut Ui, number: &mut f64, commands: &mut Commands) -> Response {
        let was = *number;
        let typed = RefCell::new(None);
        // What Escape gives up egui reads all the same one picture later, when the field still has just lost the focus.
        let escape = ui.next_auto_id().with("given up");
        let is_given_up = ui.data(|data| data.get_temp::<bool>(escape)).is_some();
        let read = |text: &str| {
            if is_given_up {
                return None;
            }
            let read = self.read(text, was);
            *typed.borrow_mut() = Some((text.trim().to_owned(), read.is_some()));
            read
        };
        let mut field = DragValue::new(number).speed(self.step).max_decimals(self.decimals).range(self.range.clone());
        if !self.most.is_empty() && was >= *self.range.end() {
            field = field.custom_formatter(|_, _| self.most.to_owned());
        }
        if self.mixed {
            field = field.custom_formatter(|_, _| MIXED.to_owned());
        }
        let field = field.prefix(self.before).suffix(suffix(self.unit)).custom_parser(read);
        // What is out of its range already stays so until a hand changes it.
        let field = field.update_while_editing(false).clamp_existing_to_range(false);
        let response = match self.wide {
            Some(wide) => ui.add_sized(vec2(wide, ui.spacing().interact_size.y), field),
            None => ui.add(field),
        };
        let gives_up = response.lost_focus() && ui.input(|input| input.key_pressed(Key::Escape));
        ui.data_mut(|data| {
            data.remove::<bool>(escape);
            if gives_up {
                data.insert_temp(escape, true);
            }
        });
        // Other programs may set it without typing.
        if *number != was && !self.may_be(*number) {
            *number = was;
        }
        let about = self.what.to_owned();
        match typed.into_inner() {
            Some((text, false)) if !text.is_empty() => {
                commands.push(Command::Refuse { why: self.refusal(&text), about });
            }
            Some((text, true)) if self.mixed && text == MIXED => {}
            Some((_, true)) => commands.push(Command::Took(about)),
            _ if response.changed() => commands.push(Command::Took(about)),
            _ => {}
        }
        response
    }

    fn may_be(&self, number: f64) -> bool {
        number.is_finite() && self.range.contains(&number) && (self.decimals > 0 || number.fract() == 0.0)
    }

    fn read(&self, text: &str, was: f64) -> Option<f64> {
        let bare: String = text.chars().filter(|c| !c.is_whitespace()).collect();
        if !self.most.is_empty() && bare == self.most {
            return Some(*self.range.end());
        }
        if self.mixed && bare == MIXED {
            return Some(was);
        }
        let read = bare.replace('\u{2212}', "-").parse::<f64>().ok()?;
        // A number that was only looked at keeps the digits that are not shown.
        let shown =
            (0.500_001 * 10.0_f64.powi(-(self.decimals as i32))).max(16.0 * f64::from(f32::EPSILON) * was.abs());
        if read == was || (!self.mixed && self.decimals > 0 && (read - was).abs() <= shown) {
            return Some(was);
        }
        self.may_be(read).then_some(read)
    }

    /// The number that somebody typed, or what it must be.
    ///
    /// # Errors
    /// What is wanted.
    pub fn typed(&self, text: &str) -> Result<f64, String> {
        self.read(text, f64::NAN).ok_or_else(|| self.wanted().trim_start_matches("it must be ").to_owned())
    }

    fn refusal(&self, text: &str) -> String {
        format!("{}: \"{text}\" is not accepted: {}", self.what, self.wanted())
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
        let whole = Number { range: 1.0..=5e6, decimals: 0, ..Number::of("hair.strands") };
        for text in ["nan", "inf", "1e99", "-5", "0", "2.5", "5000001", "five", ""] {
            assert_eq!(whole.read(text, 60.0), None, "{text}");
        }
        assert_eq!(whole.read(" 5 000 ", 60.0), Some(5000.0));
        let any = Number::of("any");
        assert_eq!((any.read("1e99", 0.0), any.read("NaN", 0.0), any.read("-inf", 0.0)), (None, None, None));
        assert_eq!(any.read("\u{2212}2.5", 0.0), Some(-2.5));
        assert_eq!(
            whole.refusal("-5"),
            "hair.strands: \"-5\" is not accepted: it must be a whole number from 1 to 5000000"
        );
        assert!(!any.wanted().contains("from"));
        let upto = Number { most: "all", ..whole };
        assert_eq!((upto.read("all", 60.0), upto.read("most", 60.0)), (Some(5e6), None));
    }

    #[test]
    fn a_number_that_was_only_looked_at_keeps_what_is_not_shown() {
        let field = Number { range: 0.0..=10.0, decimals: 2, ..Number::of("any") };
        assert_eq!(field.read("57.65", 57.654_321), Some(57.654_321), "even out of its range");
        assert_eq!(field.read("5.66", 5.654_321), Some(5.66));
    }
}
