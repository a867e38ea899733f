//! Reading of text layers: one pass notes where values are, without turning them into numbers.

use std::collections::HashMap;
use std::str::FromStr;

use crate::Problem;
use crate::source::{Handle, PrimInfo};

/// Prims below prims, and brackets within brackets.
const DEEPEST: usize = 512;

type Parsed = (Vec<PrimInfo>, HashMap<String, Handle>);

/// Finds the prims of a layer and what it says about itself.
pub fn parse(text: &[u8]) -> Result<Parsed, Problem> {
    let mut parser = Parser { text, at: 0 };
    if !text.starts_with(b"#usda") && !text.starts_with(b"#sdf") {
        return Err(Problem::new("is no USD layer: it begins neither with #usda nor with PXR-USDC"));
    }
    let mut metadata = HashMap::new();
    let mut prims: Vec<PrimInfo> = Vec::new();
    // Prims whose braces are open.
    let mut open: Vec<usize> = Vec::new();
    if parser.peek() == Some(b'(') {
        parser.metadata(Some(&mut metadata))?;
    }
    while let Some(next) = parser.peek() {
        if next == b'}' {
            parser.at += 1;
            open.pop().ok_or_else(|| parser.problem("a closing brace too many"))?;
            continue;
        }
        if next == b';' {
            parser.at += 1;
            continue;
        }
        let word = parser.word()?;
        match word.as_str() {
            "def" | "over" | "class" => {
                let type_name = if parser.peek() == Some(b'"') { String::new() } else { parser.word()? };
                let name = parser.quoted()?;
                if parser.peek() == Some(b'(') {
                    parser.metadata(None)?;
                }
                parser.expect(b'{')?;
                let parent = open.last().copied();
                open.push(prims.len());
                if open.len() > DEEPEST {
                    return Err(parser.problem("prims nested deeper than any scene is"));
                }
                prims.push(PrimInfo { name, type_name, parent, attributes: HashMap::new() });
            }
            "variantSet" => {
                parser.quoted()?;
                parser.expect(b'=')?;
                parser.skip_value()?;
            }
            "reorder" => {
                parser.word()?;
                parser.expect(b'=')?;
                parser.skip_value()?;
            }
            _ if open.is_empty() => return Err(parser.problem(&format!("\"{word:.40}\" where a prim should begin"))),
            _ => parser.property(word, &mut prims[open[open.len() - 1]])?,
        }
    }
    match open.last() {
        Some(&prim) => Err(Problem(format!("ends within prim {}: is it whole?", prims[prim].name))),
        None => Ok((prims, metadata)),
    }
}

struct Parser<'a> {
    text: &'a [u8],
    at: usize,
}

impl Parser<'_> {
    fn problem(&self, what: &str) -> Problem {
        let line = self.text[..self.at.min(self.text.len())].iter().filter(|&&b| b == b'\n').count() + 1;
        Problem(format!("line {line}: {what}"))
    }

    /// The next byte that is neither blank nor comment.
    fn peek(&mut self) -> Option<u8> {
        while let Some(&byte) = self.text.get(self.at) {
            match byte {
                b'#' => self.at += self.text[self.at..].iter().position(|&b| b == b'\n').unwrap_or(self.text.len()),
                b if b.is_ascii_whitespace() => self.at += 1,
                b => return Some(b),
            }
        }
        None
    }

    fn expect(&mut self, wanted: u8) -> Result<(), Problem> {
        if self.peek() == Some(wanted) {
            self.at += 1;
            Ok(())
        } else {
            Err(self.problem(&format!("'{}' should stand here", wanted as char)))
        }
    }

    /// A run of letters, digits and what names and types hold.
    fn word(&mut self) -> Result<String, Problem> {
        self.peek();
        let rest = self.text.get(self.at..).unwrap_or_default();
        let is_part = |b: &u8| b.is_ascii_alphanumeric() || matches!(b, b'_' | b':' | b'.' | b'-' | b'+') || *b >= 0x80;
        let length = rest.iter().position(|b| !is_part(b)).unwrap_or(rest.len());
        if length == 0 {
            return Err(self.problem("a word should stand here"));
        }
        self.at += length;
        Ok(String::from_utf8_lossy(&rest[..length]).into_owned())
    }

    fn quoted(&mut self) -> Result<String, Problem> {
        self.peek();
        let start = self.at;
        self.skip_quoted()?;
        Ok(unquote(&self.text[start..self.at]))
    }

    fn skip_quoted(&mut self) -> Result<(), Problem> {
        let rest = &self.text[self.at.min(self.text.len())..];
        let quote = match rest.first() {
            Some(&q) if q == b'"' || q == b'\'' => q,
            _ => return Err(self.problem("a name in quotation marks should stand here")),
        };
        let long = rest.starts_with(&[quote; 3]);
        let width = if long { 3 } else { 1 };
        let mut i = width;
        while i < rest.len() {
            match rest[i] {
                b'\\' => i += 2,
                q if q == quote && (!long || rest[i..].starts_with(&[quote; 3])) => {
                    self.at += i + width;
                    return Ok(());
                }
                _ => i += 1,
            }
        }
        Err(self.problem("quotation marks that are never closed"))
    }

    /// Passes over one value and gives its place.
    fn skip_value(&mut self) -> Result<Handle, Problem> {
        let first = self.peek();
        let start = self.at;
        match first {
            Some(b'[' | b'(' | b'{') => self.skip_brackets()?,
            Some(b'"' | b'\'') => self.skip_quoted()?,
            Some(b'@') => self.skip_until(b'@')?,
            Some(b'<') => self.skip_until(b'>')?,
            _ => {
                self.word()?;
            }
        }
        Ok((start as u64, (self.at - start) as u64))
    }

    fn skip_until(&mut self, end: u8) -> Result<(), Problem> {
        let rest = &self.text[self.at + 1..];
        let found = rest.iter().position(|&b| b == end).ok_or_else(|| self.problem("a path that is never closed"))?;
        self.at += found + 2;
        Ok(())
    }

    fn skip_brackets(&mut self) -> Result<(), Problem> {
        let mut depth = 0;
        loop {
            match self.peek() {
                Some(b'[' | b'(' | b'{') => {
                    depth += 1;
                    self.at += 1;
                }
                Some(b']' | b')' | b'}') => {
                    depth -= 1;
                    self.at += 1;
                }
                Some(b'"' | b'\'') => self.skip_quoted()?,
                Some(b'@') => self.skip_until(b'@')?,
                Some(_) => self.at += 1,
                None => return Err(self.problem("a bracket that is never closed: is the file whole?")),
            }
            if depth == 0 {
                return Ok(());
            }
        }
    }

    /// Passes over metadata in parentheses, noting `name = value` where wanted.
    fn metadata(&mut self, mut into: Option<&mut HashMap<String, Handle>>) -> Result<(), Problem> {
        let Some(into) = into.as_mut() else { return self.skip_brackets() };
        self.expect(b'(')?;
        loop {
            match self.peek() {
                Some(b')') => {
                    self.at += 1;
                    return Ok(());
                }
                Some(b'"' | b'\'') => self.skip_quoted()?,
                Some(b';' | b',') => self.at += 1,
                Some(_) => {
                    let mut name = self.word()?;
                    while self.peek().is_some_and(|b| b != b'=') {
                        name = self.word()?;
                    }
                    self.expect(b'=')?;
                    let value = self.skip_value()?;
                    into.insert(name, value);
                }
                None => return Err(self.problem("a parenthesis that is never closed: is the file whole?")),
            }
        }
    }

    /// A property of `prim` whose first word was `first`.
    fn property(&mut self, first: String, prim: &mut PrimInfo) -> Result<(), Problem> {
        let mut words = vec![first];
        loop {
            match self.peek() {
                Some(b'[') => {
                    self.at += 1;
                    self.expect(b']')?;
                }
                Some(b'=' | b'(' | b'}' | b';') | None => break,
                // A property without a value ends where the next line begins.
                Some(_) if words.len() >= 2 && self.line_ended() && !is_prefix(&words[words.len() - 2]) => break,
                Some(_) => words.push(self.word()?),
            }
            if words.len() > 8 {
                return Err(self.problem("a property of too many words"));
            }
        }
        let is_relation = words.iter().any(|w| w == "rel");
        let [.., _, name] = &words[..] else {
            return Err(self.problem(&format!("\"{:.40}\" where a property should stand", words[0])));
        };
        let (name, samples) = match name.strip_suffix(".timeSamples") {
            Some(name) => (name, true),
            None => (name.as_str(), false),
        };
        let connection = name.ends_with(".connect");
        if self.peek() == Some(b'=') {
            self.at += 1;
            if is_relation || connection {
                self.skip_value()?;
            } else if samples {
                let found = self.samples()?;
                prim.attributes.entry(name.to_owned()).or_default().samples = found;
            } else {
                let value = self.skip_value()?;
                prim.attributes.entry(name.to_owned()).or_default().default = Some(value);
            }
        }
        if self.peek() == Some(b'(') {
            self.skip_brackets()?;
        }
        Ok(())
    }

    /// Whether the blanks just passed over hold the end of a line.
    fn line_ended(&self) -> bool {
        let before = &self.text[..self.at];
        before.iter().rev().take_while(|b| b.is_ascii_whitespace()).any(|&b| b == b'\n')
    }

    fn samples(&mut self) -> Result<Vec<(f64, Handle)>, Problem> {
        self.expect(b'{')?;
        let mut found = Vec::new();
        loop {
            match self.peek() {
                Some(b'}') => {
                    self.at += 1;
                    break;
                }
                Some(b',') => self.at += 1,
                _ => {
                    // A time code's word takes the colon after it along.
                    let word = self.word()?;
                    let number = word.trim_end_matches(':');
                    let time = f64::from_str(number).ok().filter(|t| t.is_finite());
                    let time = time.ok_or_else(|| self.problem(&format!("\"{word:.40}\" is no time code")))?;
                    if number.len() == word.len() {
                        self.expect(b':')?;
                    }
                    found.push((time, self.skip_value()?));
                }
            }
        }
        found.sort_by(|a, b| a.0.total_cmp(&b.0));
        Ok(found)
    }
}

/// Words before a type.
fn is_prefix(word: &str) -> bool {
    matches!(word, "custom" | "uniform" | "varying" | "config" | "prepend" | "append" | "add" | "delete")
}

/// Numbers of a value, whatever brackets stand between them; `inf` and `nan` count, words do not.
pub fn numbers<T: FromStr>(text: &[u8], (start, length): Handle) -> Result<Vec<T>, Problem> {
    let value = &text[start as usize..(start + length) as usize];
    let mut found = Vec::new();
    let is_part = |b: u8| b.is_ascii_alphanumeric() || matches!(b, b'.' | b'-' | b'+');
    for word in value.split(|&b| !is_part(b)).filter(|w| !w.is_empty()) {
        let word = std::str::from_utf8(word).unwrap_or_default();
        match word.parse() {
            Ok(number) => found.push(number),
            Err(_) if word == "None" => {}
            Err(_) => return Err(Problem(format!("byte {start}: \"{word:.40}\" among numbers"))),
        }
    }
    Ok(found)
}

/// Words in quotation marks of a value.
pub fn words(text: &[u8], (start, length): Handle) -> Vec<String> {
    let end = (start + length) as usize;
    let mut parser = Parser { text: &text[..end], at: start as usize };
    let mut found = Vec::new();
    while let Some(byte) = parser.peek() {
        if matches!(byte, b'"' | b'\'') {
            match parser.quoted() {
                Ok(word) => found.push(word),
                Err(_) => break,
            }
        } else {
            parser.at += 1;
        }
    }
    found
}

/// The text between quotation marks.
fn unquote(quoted: &[u8]) -> String {
    let width = if quoted.len() >= 6 && quoted[..3] == [quoted[0]; 3] { 3 } else { 1 };
    let inside = String::from_utf8_lossy(&quoted[width..quoted.len() - width]);
    if !inside.contains('\\') {
        return inside.into_owned();
    }
    let mut letters = inside.chars();
    let mut text = String::new();
    while let Some(c) = letters.next() {
        match c {
            '\\' => match letters.next() {
                Some('n') => text.push('\n'),
                Some('r') => text.push('\r'),
                Some('t') => text.push('\t'),
                Some(c) => text.push(c),
                None => {}
            },
            c => text.push(c),
        }
    }
    text
}
