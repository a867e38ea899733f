//! The words of a text, taken one after the other, with the line of the last for errors.

use crate::error::{Error, Result};

/// What is left of a text.
pub(super) struct Words<'a> {
    text: &'a str,
    /// Where the last word begins (bytes).
    last: usize,
    /// Where what is left begins (bytes).
    rest: usize,
    /// Whether a text in quotes is one word.
    quotes: bool,
}

impl<'a> Words<'a> {
    /// Words between spaces.
    pub fn plain(text: &'a str) -> Self {
        Self { text, last: 0, rest: 0, quotes: false }
    }

    /// The same, but for texts in quotes, which are one word each.
    pub fn quoted(text: &'a str) -> Self {
        Self { quotes: true, ..Self::plain(text) }
    }

    /// Whether no word is left.
    pub fn is_at_end(&self) -> bool {
        self.text[self.rest..].trim_ascii_start().is_empty()
    }

    /// The next word; `wanted` says what should stand there.
    pub fn next(&mut self, wanted: &str) -> Result<&'a str> {
        let rest = &self.text[self.rest..];
        self.last = self.rest + rest.len() - rest.trim_ascii_start().len();
        let rest = rest.trim_ascii_start();
        let length = if self.quotes && rest.starts_with('"') { quoted(rest) } else { unquoted(rest) };
        let Some(length) = length else {
            return Err(Error::new(format!("ends before {wanted}: is it complete?")));
        };
        self.rest = self.last + length;
        Ok(&rest[..length])
    }

    /// The rest of the line, or as much of it as stands before `end`; `wanted` says what it should be.
    pub fn line_before(&mut self, end: char, wanted: &str) -> Result<&'a str> {
        self.next(wanted)?;
        let rest = &self.text[self.last..];
        let length = rest.find(['\n', '\r', end]).unwrap_or(rest.len());
        self.rest = self.last + length;
        match rest[..length].trim_ascii_end() {
            "" => Err(self.refusal(&rest[..end.len_utf8()], &format!("{wanted} expected here"))),
            line => Ok(line),
        }
    }

    /// Takes `wanted` itself; capitals do not count, and a number may follow its colon at once.
    pub fn expect(&mut self, wanted: &str) -> Result<()> {
        match self.next(wanted)? {
            found
                if wanted.ends_with(':')
                    && found.get(..wanted.len()).is_some_and(|w| w.eq_ignore_ascii_case(wanted)) =>
            {
                self.rest = self.last + wanted.len();
                Ok(())
            }
            found if found.eq_ignore_ascii_case(wanted) => Ok(()),
            found => Err(self.refusal(found, &format!("{wanted} expected here"))),
        }
    }

    /// A finite number, which is `what`.
    pub fn number(&mut self, what: &str) -> Result<f64> {
        let word = self.next("a number")?;
        match word.parse::<f64>() {
            Ok(x) if x.is_finite() => Ok(x),
            _ => Err(self.refusal(word, &format!("{what} must be a finite number"))),
        }
    }

    /// An error about the last word.
    pub fn refusal(&self, word: &str, why: &str) -> Error {
        Error::new(format!("\"{word:.40}\": {why}")).at_line(Some(self.line()))
    }

    /// The line of the last word, from 1; counted when it is asked for, which is once.
    pub fn line(&self) -> usize {
        1 + self.text.as_bytes()[..self.last].iter().filter(|&&byte| byte == b'\n').count()
    }
}

fn unquoted(rest: &str) -> Option<usize> {
    let end = rest.bytes().position(|byte| byte.is_ascii_whitespace()).unwrap_or(rest.len());
    Some(end).filter(|&end| end > 0)
}

/// Up to and with the closing quotation mark.
fn quoted(rest: &str) -> Option<usize> {
    let mut escaped = false;
    let closing = rest.bytes().skip(1).position(|byte| {
        let closes = byte == b'"' && !escaped;
        escaped = byte == b'\\' && !escaped;
        closes
    });
    closing.map(|at| at + 2)
}
