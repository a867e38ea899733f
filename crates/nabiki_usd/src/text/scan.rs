//! Text passed through a window: words, quotations, and the places of values that are only passed over.

use std::io::SeekFrom;

use crate::Problem;
use crate::source::{Handle, Source};

/// Bytes of text at hand at a time; about what a core's own cache holds.
pub const WINDOW: usize = 1 << 18;

/// Brackets within brackets.
const DEEPEST: usize = 512;

/// Text being read from front to back.
pub struct Scanner<'a> {
    from: &'a mut dyn Source,
    window: Vec<u8>,
    /// Next byte in the window.
    at: usize,
    /// Bytes of the text before the window.
    before: u64,
    /// Bytes of the text after the window.
    after: u64,
    /// Whether a line has ended since the last byte that is no blank.
    line_ended: bool,
}

impl<'a> Scanner<'a> {
    /// Reads the `length` bytes from `start` on, which the source has.
    pub fn new(from: &'a mut dyn Source, (start, length): Handle) -> Result<Self, Problem> {
        from.seek(SeekFrom::Start(start))?;
        Ok(Self { from, window: Vec::new(), at: 0, before: start, after: length, line_ended: false })
    }

    /// Which byte of the text is next.
    pub fn place(&self) -> u64 {
        self.before + self.at as u64
    }

    /// What is wrong here.
    pub fn problem(&mut self, what: &str) -> Problem {
        match self.line() {
            Ok(line) => Problem(format!("line {line}: {what}")),
            Err(problem) => problem,
        }
    }

    /// The line at which the scanner stands, counted from the start of the source.
    fn line(&mut self) -> Result<usize, Problem> {
        let place = self.place();
        self.from.seek(SeekFrom::Start(0))?;
        let mut line = 1;
        let mut left = place;
        let mut block = vec![0; WINDOW];
        while left > 0 {
            let block = &mut block[..left.min(WINDOW as u64) as usize];
            self.from.read_exact(block)?;
            line += block.iter().filter(|&&b| b == b'\n').count();
            left -= block.len() as u64;
        }
        self.from.seek(SeekFrom::Start(self.before + self.window.len() as u64))?;
        Ok(line)
    }

    /// Moves the window on once all of it has been read; `false` at the end of the text.
    fn fill(&mut self) -> Result<bool, Problem> {
        if self.at < self.window.len() {
            return Ok(true);
        }
        self.before += self.window.len() as u64;
        self.at = 0;
        self.window.resize(self.after.min(WINDOW as u64) as usize, 0);
        self.from.read_exact(&mut self.window)?;
        self.after -= self.window.len() as u64;
        Ok(!self.window.is_empty())
    }

    /// The next byte, whatever it is.
    fn here(&mut self) -> Result<Option<u8>, Problem> {
        Ok(if self.fill()? { Some(self.window[self.at]) } else { None })
    }

    /// The next byte that is neither blank nor comment.
    pub fn peek(&mut self) -> Result<Option<u8>, Problem> {
        while let Some(byte) = self.here()? {
            match byte {
                b'#' => self.skip_line()?,
                b'/' => match self.after_next()? {
                    Some(b'/') => self.skip_line()?,
                    Some(b'*') => self.skip_block()?,
                    _ => return Ok(Some(b'/')),
                },
                b if b.is_ascii_whitespace() => {
                    self.line_ended |= b == b'\n';
                    self.at += 1;
                }
                b => return Ok(Some(b)),
            }
        }
        Ok(None)
    }

    /// The byte after the next one.
    fn after_next(&mut self) -> Result<Option<u8>, Problem> {
        if self.at + 1 == self.window.len() && self.after > 0 {
            let more = self.after.min(WINDOW as u64 - 1);
            self.before += self.at as u64;
            self.window.drain(..self.at);
            self.at = 0;
            self.window.resize(1 + more as usize, 0);
            self.from.read_exact(&mut self.window[1..])?;
            self.after -= more;
        }
        Ok(self.window.get(self.at + 1).copied())
    }

    /// Passes over a comment up to the end of the line.
    fn skip_line(&mut self) -> Result<(), Problem> {
        while self.here()?.is_some_and(|b| b != b'\n') {
            self.at += 1;
        }
        Ok(())
    }

    /// Passes over a comment between `/*` and `*/`.
    fn skip_block(&mut self) -> Result<(), Problem> {
        self.at += 2;
        let mut starred = false;
        while let Some(byte) = self.here()? {
            self.at += 1;
            if starred && byte == b'/' {
                return Ok(());
            }
            starred = byte == b'*';
        }
        Err(self.problem("a comment is never closed"))
    }

    /// Passes over the byte that [`peek`](Self::peek) gave.
    pub fn pass(&mut self) {
        self.at += 1;
        self.line_ended = false;
    }

    /// Whether a line ended in the blanks just passed over.
    pub fn line_ended(&self) -> bool {
        self.line_ended
    }

    /// Passes over blanks and one byte, which must be `wanted`.
    pub fn expect(&mut self, wanted: u8) -> Result<(), Problem> {
        if self.peek()? == Some(wanted) {
            self.pass();
            Ok(())
        } else {
            Err(self.problem(&format!("'{}' expected here", wanted as char)))
        }
    }

    /// A run of letters, digits and what names and types hold.
    pub fn word(&mut self) -> Result<String, Problem> {
        let is_part = |b: u8| b.is_ascii_alphanumeric() || matches!(b, b'_' | b':' | b'.' | b'-' | b'+') || b >= 0x80;
        self.peek()?;
        let mut word = Vec::new();
        while let Some(byte) = self.here()?.filter(|&b| is_part(b)) {
            word.push(byte);
            self.pass();
        }
        if word.is_empty() {
            return Err(self.problem("a word expected here"));
        }
        Ok(String::from_utf8_lossy(&word).into_owned())
    }

    /// The text between the quotation marks that follow.
    pub fn quoted(&mut self) -> Result<String, Problem> {
        let quote = match self.peek()? {
            Some(q) if q == b'"' || q == b'\'' => q,
            _ => return Err(self.problem("a name in quotation marks expected here")),
        };
        let mut opening = 0;
        while opening < 3 && self.here()? == Some(quote) {
            opening += 1;
            self.pass();
        }
        if opening == 2 {
            return Ok(String::new());
        }
        let mut text = Vec::new();
        let mut closing = 0;
        while let Some(byte) = self.here()? {
            self.pass();
            match byte {
                b'\\' => {
                    let escaped = self.here()?.ok_or_else(|| Problem::new("ends within quotation marks"))?;
                    self.pass();
                    text.push(match escaped {
                        b'n' => b'\n',
                        b'r' => b'\r',
                        b't' => b'\t',
                        b'x' => self.digits(0, 16, 2)?,
                        b'0'..=b'7' => self.digits(escaped - b'0', 8, 2)?,
                        other => other,
                    });
                    closing = 0;
                    continue;
                }
                b if b == quote => closing += 1,
                _ => closing = 0,
            }
            text.push(byte);
            if closing == opening {
                text.truncate(text.len() - opening);
                return Ok(String::from_utf8_lossy(&text).into_owned());
            }
        }
        Err(self.problem("quotation marks are never closed"))
    }

    /// The byte that at most `most` further digits stand for, after one worth `value`.
    fn digits(&mut self, mut value: u8, base: u32, most: usize) -> Result<u8, Problem> {
        for _ in 0..most {
            let digit = self.here()?.and_then(|b| char::from(b).to_digit(base));
            let Some(digit) = digit else { break };
            value = value.wrapping_mul(base as u8).wrapping_add(digit as u8);
            self.pass();
        }
        Ok(value)
    }

    /// Passes over one value and gives its place.
    pub fn skip_value(&mut self) -> Result<Handle, Problem> {
        let first = self.peek()?;
        let start = self.place();
        match first {
            Some(b'[' | b'(' | b'{') => self.skip_brackets()?,
            Some(b'"' | b'\'') => {
                self.quoted()?;
            }
            Some(b'@') => self.skip_asset()?,
            Some(b'<') => self.skip_until(b'>')?,
            _ => {
                self.word()?;
            }
        }
        Ok((start, self.place() - start))
    }

    /// Passes over the path of a file, which three signs enclose where one is in it.
    fn skip_asset(&mut self) -> Result<(), Problem> {
        let mut opening = 0;
        while opening < 3 && self.here()? == Some(b'@') {
            opening += 1;
            self.pass();
        }
        if opening == 1 {
            return self.skip_to(b'@');
        }
        let mut closing = if opening == 2 { 3 } else { 0 };
        let mut escaped = false;
        while closing < 3 {
            let Some(byte) = self.here()? else { return Err(self.problem("a path is never closed")) };
            self.pass();
            // Of three after a backslash none closes.
            for _ in 0..2 {
                if byte == b'@' && escaped && self.here()? == Some(b'@') {
                    self.pass();
                }
            }
            closing = if byte == b'@' && !escaped { closing + 1 } else { 0 };
            escaped = byte == b'\\';
        }
        // Up to two more belong to the path.
        for _ in 0..2 {
            if opening == 3 && self.here()? == Some(b'@') {
                self.pass();
            }
        }
        Ok(())
    }

    fn skip_until(&mut self, end: u8) -> Result<(), Problem> {
        self.pass();
        self.skip_to(end)
    }

    fn skip_to(&mut self, end: u8) -> Result<(), Problem> {
        while let Some(byte) = self.here()? {
            self.pass();
            if byte == end {
                return Ok(());
            }
        }
        Err(self.problem("a path is never closed"))
    }

    /// Passes over brackets and all that is in them. Parentheses in a list are left to whoever reads its values: most
    /// of a file is lists of points.
    fn skip_brackets(&mut self) -> Result<(), Problem> {
        let mut open: Vec<u8> = Vec::new();
        loop {
            let in_list = open.last() == Some(&b'[');
            if in_list {
                self.skip_unmarked()?;
            }
            match self.peek()? {
                Some(b'(' | b')') if in_list => self.pass(),
                Some(bracket @ (b'[' | b'(' | b'{')) => {
                    if open.len() == DEEPEST {
                        return Err(self.problem("brackets are nested too deep"));
                    }
                    open.push(bracket);
                    self.pass();
                }
                Some(b']' | b')' | b'}') => {
                    open.pop();
                    self.pass();
                }
                Some(b'"' | b'\'') => {
                    self.quoted()?;
                }
                Some(b'@') => self.skip_asset()?,
                Some(_) => self.pass(),
                None => return Err(self.problem("a bracket is never closed: is the file complete?")),
            }
            if open.is_empty() {
                return Ok(());
            }
        }
    }

    /// Passes over bytes that mean nothing within a list of numbers.
    fn skip_unmarked(&mut self) -> Result<(), Problem> {
        // Closing and opening brackets and braces differ in three bits only, quotation marks and what begins comments in
        // one each; the few letters that share the others are let go by the caller.
        let is_mark = |b: u8| (b | 0x26 == 0x7f) | (b | 1 == b'#') | (b | 8 == b'/') | (b == b'@');
        while self.fill()? {
            let rest = &self.window[self.at..];
            let (blocks, _) = rest.as_chunks::<64>();
            // Whole blocks without a branch within them, so that they are compared many bytes at a time.
            let clear = |block: &&[u8; 64]| !block.iter().fold(false, |any, &b| any | is_mark(b));
            let clear = 64 * blocks.iter().take_while(clear).count();
            match rest[clear..].iter().position(|&b| is_mark(b)) {
                Some(more) => {
                    self.at += clear + more;
                    return Ok(());
                }
                None => self.at = self.window.len(),
            }
        }
        Ok(())
    }
}
