//! Writing of text layers.

use std::io::{self, BufWriter, Read, Seek, SeekFrom, Write};

use glam::Vec3;

use crate::layer::{Attribute, Metadata, Prim, Value};

/// Room that the number of the last frame takes in the header, filled in at the end.
const END_WIDTH: usize = 24;

/// A text layer being written: header, prims whose samples are known, and one attribute of samples that stream.
pub struct TextWriter<W> {
    to: W,
    end_at: u64,
}

impl<W: Write + Seek> TextWriter<W> {
    /// Writes the header.
    pub fn new(mut to: W, metadata: &Metadata) -> io::Result<Self> {
        write!(
            to,
            "#usda 1.0\n(\n    defaultPrim = \"{}\"\n    doc = \"Written by Nabiki {}\"\n    framesPerSecond = {}\n    \
             metersPerUnit = {}\n    startTimeCode = {}\n    timeCodesPerSecond = {}\n    upAxis = \"{}\"\n    \
             endTimeCode = ",
            metadata.default_prim,
            env!("CARGO_PKG_VERSION"),
            metadata.frame_rate,
            metadata.meters_per_unit,
            metadata.start,
            metadata.frame_rate,
            if metadata.z_up { "Z" } else { "Y" },
        )?;
        let end_at = to.stream_position()?;
        writeln!(to, "{:END_WIDTH$}\n)\n", metadata.end)?;
        Ok(Self { to, end_at })
    }

    /// A part of a layer that is written apart, to be [`append`](Self::append)ed.
    pub fn part(to: W) -> Self {
        Self { to, end_at: 0 }
    }

    /// Writes what has been written apart.
    pub fn append<R: Read + Write + Seek>(&mut self, part: TextWriter<BufWriter<R>>) -> io::Result<()> {
        let mut part = part.to.into_inner().map_err(|e| e.into_error())?;
        part.seek(SeekFrom::Start(0))?;
        io::copy(&mut part, &mut self.to)?;
        Ok(())
    }

    /// Begins a prim; [`close`](Self::close) ends it.
    pub fn open(&mut self, name: &str, type_name: &str, schemas: &[&str], depth: usize) -> io::Result<()> {
        let pad = Pad(depth);
        let kind = if type_name.is_empty() { "over".to_owned() } else { format!("def {type_name}") };
        write!(self.to, "{pad}{kind} \"{name}\"")?;
        if !schemas.is_empty() {
            write!(self.to, " (\n{pad}    prepend apiSchemas = [\"{}\"]\n{pad})", schemas.join("\", \""))?;
        }
        writeln!(self.to, "\n{pad}{{")
    }

    /// Ends a prim.
    pub fn close(&mut self, depth: usize) -> io::Result<()> {
        writeln!(self.to, "{}}}", Pad(depth))
    }

    /// Writes a whole prim whose samples are time codes and values.
    pub fn prim(&mut self, prim: &Prim<(f64, Value)>, depth: usize) -> io::Result<()> {
        self.open(&prim.name, prim.type_name, prim.schemas, depth)?;
        for attribute in &prim.attributes {
            self.attribute(attribute, depth + 1)?;
        }
        for child in &prim.children {
            self.prim(child, depth + 1)?;
        }
        self.close(depth)
    }

    /// Writes an attribute.
    pub fn attribute(&mut self, attribute: &Attribute<(f64, Value)>, depth: usize) -> io::Result<()> {
        let Attribute { name, type_name, uniform, value, samples, interpolation } = attribute;
        let pad = Pad(depth);
        if let Some(value) = value {
            let uniform = if *uniform { "uniform " } else { "" };
            write!(self.to, "{pad}{uniform}{type_name} {name} = ")?;
            self.value(value)?;
            match interpolation {
                Some(word) => writeln!(self.to, " (\n{pad}    interpolation = \"{word}\"\n{pad})")?,
                None => writeln!(self.to)?,
            }
        }
        if !samples.is_empty() {
            self.begin_samples(name, type_name, depth)?;
            for (time, value) in samples {
                self.sample(*time, value, depth)?;
            }
            self.end_samples(depth)?;
        }
        Ok(())
    }

    /// Begins the samples of an attribute; then come [`sample`](Self::sample)s, then [`end_samples`](Self::end_samples).
    pub fn begin_samples(&mut self, name: &str, type_name: &str, depth: usize) -> io::Result<()> {
        writeln!(self.to, "{}{type_name} {name}.timeSamples = {{", Pad(depth))
    }

    /// Writes one sample.
    pub fn sample(&mut self, time: f64, value: &Value, depth: usize) -> io::Result<()> {
        write!(self.to, "{}{time}: ", Pad(depth + 1))?;
        self.value(value)?;
        writeln!(self.to, ",")
    }

    /// Writes one sample of points.
    pub fn points(&mut self, time: f64, points: &[Vec3], depth: usize) -> io::Result<()> {
        write!(self.to, "{}{time}: ", Pad(depth + 1))?;
        list(&mut self.to, points, |line, p| tuple(line, &p.to_array()))?;
        writeln!(self.to, ",")
    }

    /// Ends the samples.
    pub fn end_samples(&mut self, depth: usize) -> io::Result<()> {
        writeln!(self.to, "{}}}", Pad(depth))
    }

    /// Fills in the last time code.
    pub fn finish(mut self, end: f64) -> io::Result<W> {
        self.to.seek(SeekFrom::Start(self.end_at))?;
        write!(self.to, "{end:END_WIDTH$}")?;
        self.to.flush()?;
        Ok(self.to)
    }

    fn value(&mut self, value: &Value) -> io::Result<()> {
        if let Value::One(list) = value {
            let mut line = Vec::new();
            TextWriter { to: io::Cursor::new(&mut line), end_at: 0 }.value(list)?;
            // What stands between the brackets of a list of one.
            return self.to.write_all(&line[1..line.len() - 1]);
        }
        let to = &mut self.to;
        match value {
            Value::One(_) => Ok(()),
            Value::HalfTuples(extent, values) => tuples(to, *extent, values, |line, x| float(line, x.to_f32())),
            Value::Bools(values) | Value::Bytes(values) => list(to, values, |line, &x| display(line, x)),
            Value::Unsigned(values) => list(to, values, |line, &x| display(line, x)),
            Value::UnsignedLongs(values) => list(to, values, |line, &x| display(line, x)),
            Value::Blocked | Value::NoTargets => write!(to, "None"),
            Value::Token(word) => write!(to, "{}", Quoted(word)),
            Value::Tokens(words) | Value::Texts(words) => list(to, words, |line, word| display(line, Quoted(word))),
            Value::Double(x) => write!(to, "{}", Real(*x)),
            Value::Ints(values) => list(to, values, |line, &x| display(line, x)),
            Value::Longs(values) => list(to, values, |line, &x| display(line, x)),
            Value::Floats(values) => list(to, values, |line, &x| float(line, x)),
            Value::Pairs(values) => list(to, values, tuple),
            Value::Triples(values) => list(to, values, tuple),
            Value::IntTuples(extent, values) => tuples(to, *extent, values, |line, &x| display(line, x)),
            Value::FloatTuples(extent, values) => tuples(to, *extent, values, |line, &x| float(line, x)),
            Value::DoubleTuples(extent, values) => tuples(to, *extent, values, |line, &x| display(line, Real(x))),
            Value::Matrix(m) => {
                let row = |i: usize| {
                    let [a, b, c, d] = std::array::from_fn(|k| Real(m[4 * i + k]));
                    format!("({a}, {b}, {c}, {d})")
                };
                write!(to, "( {}, {}, {}, {} )", row(0), row(1), row(2), row(3))
            }
        }
    }
}

/// The word that USD has for what is no number; Rust's own, `NaN`, it refuses with the whole layer.
const NAN: &str = "nan";

/// A double in the words of USD.
struct Real(f64);

impl std::fmt::Display for Real {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        if self.0.is_nan() { f.write_str(NAN) } else { self.0.fmt(f) }
    }
}

/// The shortest digits that come back to the same bits.
fn float(line: &mut Vec<u8>, x: f32) {
    if x.is_nan() {
        return line.extend_from_slice(NAN.as_bytes());
    }
    let mut digits = zmij::Buffer::new();
    let digits = digits.format(x);
    line.extend_from_slice(digits.strip_suffix(".0").unwrap_or(digits).as_bytes());
}

fn tuple<const N: usize>(line: &mut Vec<u8>, numbers: &[f32; N]) {
    for (i, &x) in numbers.iter().enumerate() {
        line.extend_from_slice(if i == 0 { b"(" } else { b", " });
        float(line, x);
    }
    line.push(b')');
}

/// Bytes that points take in a list.
pub fn text_bytes(points: &[[f32; 3]]) -> u64 {
    // Of many points some tell enough: strands lie in any order of places, not of digits.
    const MOST_WRITTEN: usize = 10_000;
    let step = points.len().div_ceil(MOST_WRITTEN).max(1);
    let mut line = Vec::new();
    let mut written = 0;
    for point in points.iter().step_by(step) {
        tuple(&mut line, point);
        line.extend_from_slice(b", ");
        written += 1;
    }
    (line.len() as u64 * points.len() as u64).checked_div(written).unwrap_or(0)
}

/// Values of `extent` numbers each, those of 9 and 16 as matrices: rows within a pair of parentheses.
fn tuples<W: Write, T>(to: &mut W, extent: usize, values: &[T], one: impl Fn(&mut Vec<u8>, &T)) -> io::Result<()> {
    let row = |line: &mut Vec<u8>, numbers: &[T]| {
        for (i, x) in numbers.iter().enumerate() {
            line.extend_from_slice(if i == 0 { b"(" } else { b", " });
            one(line, x);
        }
        line.push(b')');
    };
    let side = match extent {
        9 => 3,
        16 => 4,
        other => other,
    };
    let all: Vec<&[T]> = values.chunks(extent).collect();
    list(to, &all, |line, numbers| match numbers {
        [x] => one(line, x),
        _ if side == extent => row(line, numbers),
        _ => {
            for (i, numbers) in numbers.chunks(side).enumerate() {
                line.extend_from_slice(if i == 0 { b"( " } else { b", " });
                row(line, numbers);
            }
            line.extend_from_slice(b" )");
        }
    })
}

fn display(line: &mut Vec<u8>, value: impl std::fmt::Display) {
    line.extend_from_slice(value.to_string().as_bytes());
}

/// Values between brackets, gathered into blocks: a call of the writer for every number would cost more than its digits.
fn list<W: Write, T>(to: &mut W, values: &[T], one: impl Fn(&mut Vec<u8>, &T)) -> io::Result<()> {
    const BLOCK: usize = 1 << 16;
    let mut line = Vec::with_capacity(BLOCK + 256);
    line.push(b'[');
    for (i, value) in values.iter().enumerate() {
        if i > 0 {
            line.extend_from_slice(b", ");
        }
        one(&mut line, value);
        if line.len() >= BLOCK {
            to.write_all(&line)?;
            line.clear();
        }
    }
    line.push(b']');
    to.write_all(&line)
}

/// Four blanks for each level.
struct Pad(usize);

impl std::fmt::Display for Pad {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        (0..self.0).try_for_each(|_| f.write_str("    "))
    }
}

/// Text in quotation marks.
struct Quoted<'a>(&'a str);

impl std::fmt::Display for Quoted<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("\"")?;
        for c in self.0.chars() {
            match c {
                '"' => f.write_str("\\\"")?,
                '\\' => f.write_str("\\\\")?,
                '\n' => f.write_str("\\n")?,
                '\r' => f.write_str("\\r")?,
                '\t' => f.write_str("\\t")?,
                // Three digits, so that none that follows is taken for one more.
                c if c.is_ascii_control() => write!(f, "\\{:03o}", u32::from(c))?,
                c => write!(f, "{c}")?,
            }
        }
        f.write_str("\"")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whether USD reads the file hangs on these: a layer with the word `NaN` it refuses whole.
    #[test]
    fn what_is_no_finite_number_has_the_words_of_usd() {
        let odd = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY];
        for value in [
            Value::Floats(odd.map(|x| x as f32).to_vec()),
            Value::HalfTuples(1, odd.map(half::f16::from_f64).to_vec()),
            Value::DoubleTuples(1, odd.to_vec()),
        ] {
            let mut text = Vec::new();
            TextWriter { to: io::Cursor::new(&mut text), end_at: 0 }.value(&value).unwrap();
            assert_eq!(std::str::from_utf8(&text), Ok("[nan, inf, -inf]"), "{value:?}");
        }
        assert_eq!(Real(f64::NAN).to_string(), "nan");
    }
}
