//! Text for display. Names may come from foreign files, so characters that control a terminal or change the direction
//! of text are shown as `\x1b` and the like.

use std::fmt::{self, Display, Write};

/// Displays text as one line, whatever it contains.
///
/// ```
/// use nabiki_io::screen::OneLine;
///
/// assert_eq!(OneLine("hair\n\u{1b}[2J").to_string(), r"hair\n\x1b[2J");
/// ```
pub struct OneLine<T>(pub T);

/// Displays text with its lines.
pub struct Lines<T>(pub T);

impl<T: Display> Display for OneLine<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(Escaping { to: f, lines: false }, "{}", self.0)
    }
}

impl<T: Display> Display for Lines<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(Escaping { to: f, lines: true }, "{}", self.0)
    }
}

/// Names, parted by commas, each in one line.
pub(crate) fn list(names: &[impl Display]) -> String {
    names.iter().map(|name| OneLine(name).to_string()).collect::<Vec<_>>().join(", ")
}

/// Whether a character may affect more than its own place on a screen: control characters, separators of lines or
/// paragraphs, and characters that change the direction of text.
pub fn is_unsafe(c: char) -> bool {
    // Unicode's property Bidi_Control.
    let turns = matches!(c, '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    c.is_control() || turns || matches!(c, '\u{2028}' | '\u{2029}')
}

struct Escaping<'a, 'f> {
    to: &'a mut fmt::Formatter<'f>,
    /// Whether a new line may begin.
    lines: bool,
}

impl Write for Escaping<'_, '_> {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        let mut rest = text;
        while let Some(at) = rest.find(|c| is_unsafe(c) && !(self.lines && c == '\n')) {
            self.to.write_str(&rest[..at])?;
            let mut after = rest[at..].chars();
            match after.next() {
                Some('\n') => self.to.write_str(r"\n")?,
                Some('\r') => self.to.write_str(r"\r")?,
                Some('\t') => self.to.write_str(r"\t")?,
                Some(c) if u32::from(c) < 0x100 => write!(self.to, r"\x{:02x}", u32::from(c))?,
                Some(c) => write!(self.to, r"\u{:04x}", u32::from(c))?,
                None => {}
            }
            rest = after.as_str();
        }
        self.to.write_str(rest)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_that_a_screen_obeys_is_left() {
        let all: String = (0..0x3000).filter_map(char::from_u32).collect();
        let (line, lines) = (OneLine(&all).to_string(), Lines(&all).to_string());
        assert!(!line.contains(is_unsafe));
        assert!(lines.split('\n').count() == 2 && !lines.replace('\n', "").contains(is_unsafe));
        // ESC, DEL, a CSI of one byte, an override, a parting of lines.
        let odd = "\u{1b}]0;x\u{7} \u{7f} \u{9b}2J \u{202e} \u{2028} \r\t\n";
        assert_eq!(OneLine(odd).to_string(), r"\x1b]0;x\x07 \x7f \x9b2J \u202e \u2028 \r\t\n");
    }

    #[test]
    fn all_else_stays_as_it_is() {
        for name in [
            "",
            "hair",
            "\u{98a8}\u{306b}\u{9761}\u{304f}",
            r"C:\hair\new",
            "na\u{ef}ve \u{1f468}\u{200d}\u{1f9b0}",
            "\u{5e9}",
        ] {
            assert_eq!(OneLine(name).to_string(), name);
        }
        assert_eq!(Lines("a\nb").to_string(), "a\nb");
        assert_eq!(list(&["a", "b\n"]), r"a, b\n");
    }
}
