//! Numbers out of text: fast, and to the last bit what the standard library makes of them.

use std::str::FromStr;

use crate::Problem;

/// Powers of ten that a double holds exactly.
const TENS: [f64; 23] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20,
    1e21, 1e22,
];
const WHOLE_TENS: [u64; 9] = [1, 10, 100, 1_000, 10_000, 100_000, 1_000_000, 10_000_000, 100_000_000];
/// Decimal digits that always fit into 64 bits.
const MOST_DIGITS: usize = 19;

/// A number that text can hold.
pub trait Number: FromStr {
    /// `digits` times ten to the `tens`, rounded once; `None` where that is not known to come out so.
    fn scaled(negative: bool, digits: u64, tens: i32) -> Option<Self>;

    /// What a word stands for that is neither a plain decimal number nor one to the standard library.
    fn from_word(word: &str) -> Option<Self> {
        match word {
            "true" => Self::scaled(false, 1, 0),
            "false" => Self::scaled(false, 0, 0),
            _ => None,
        }
    }
}

impl Number for f64 {
    fn scaled(negative: bool, digits: u64, tens: i32) -> Option<Self> {
        if digits > 1 << 53 {
            return None;
        }
        // Both operands are exact, so that the one operation rounds once.
        let power = *TENS.get(tens.unsigned_abs() as usize)?;
        let size = if tens < 0 { digits as f64 / power } else { digits as f64 * power };
        Some(if negative { -size } else { size })
    }
}

impl Number for f32 {
    fn scaled(negative: bool, digits: u64, tens: i32) -> Option<Self> {
        let wide = f64::scaled(negative, digits, tens)?;
        // Rounding to a double and then to a single is rounding once, unless the double lies midway between two
        // singles: any other lies on the same side of that middle as the number itself.
        let midway = wide.to_bits() & 0x1fff_ffff == 0x1000_0000;
        let normal = (f64::from(f32::MIN_POSITIVE)..f64::from(f32::MAX)).contains(&wide.abs());
        ((normal && !midway) || digits == 0).then_some(wide as f32)
    }
}

impl Number for i64 {
    fn scaled(negative: bool, digits: u64, tens: i32) -> Option<Self> {
        let size = i64::try_from(digits).ok().filter(|_| tens == 0)?;
        Some(if negative { -size } else { size })
    }

    /// Numbers from 2^63 on keep their 64 bits.
    fn from_word(word: &str) -> Option<Self> {
        match word {
            "true" => Some(1),
            "false" => Some(0),
            _ => word.parse().ok().map(u64::cast_signed),
        }
    }
}

/// Numbers being read out of a value that comes in parts.
pub struct Numbers<T> {
    /// The numbers so far, whatever brackets stand between them.
    pub found: Vec<T>,
    /// Parentheses that are open.
    open: usize,
    comment: Comment,
}

/// What of a comment was read last.
#[derive(Clone, Copy, PartialEq)]
enum Comment {
    None,
    /// A slash, which may begin one.
    Slash,
    Line,
    Block,
    /// A star in a block, which a slash would close.
    Star,
}

/// Whether a byte can be part of a number or of what stands for one.
pub fn is_part(byte: u8) -> bool {
    byte.is_ascii_alphanumeric() || matches!(byte, b'.' | b'-' | b'+')
}

impl<T: Number> Numbers<T> {
    /// None so far.
    pub fn new() -> Self {
        Self { found: Vec::new(), open: 0, comment: Comment::None }
    }

    /// Reads on in text that neither begins nor ends within a number. `inf`, `nan`, `true` and `false` count, other words
    /// do not.
    pub fn read(&mut self, text: &[u8]) -> Result<(), Problem> {
        let mut at = 0;
        while let Some(&byte) = text.get(at) {
            if self.comment != Comment::None {
                self.comment = match (self.comment, byte) {
                    (Comment::Line, b'\n') | (Comment::Star, b'/') => Comment::None,
                    (Comment::Block | Comment::Star, b'*') => Comment::Star,
                    (Comment::Star, _) => Comment::Block,
                    (Comment::Slash, b'/') => Comment::Line,
                    (Comment::Slash, b'*') => Comment::Block,
                    (Comment::Slash, _) => {
                        self.comment = Comment::None;
                        continue;
                    }
                    (comment, _) => comment,
                };
                at += 1;
            } else if !is_part(byte) {
                match byte {
                    b'(' => self.open += 1,
                    b')' => self.open = self.open.checked_sub(1).ok_or_else(unmatched)?,
                    b'#' => self.comment = Comment::Line,
                    b'/' => self.comment = Comment::Slash,
                    _ => {}
                }
                at += 1;
            } else if let Some((number, length)) = quick(&text[at..]) {
                self.found.push(number);
                at += length;
            } else {
                let rest = &text[at..];
                let word = &rest[..rest.iter().position(|&b| !is_part(b)).unwrap_or(rest.len())];
                at += word.len();
                let word = std::str::from_utf8(word).unwrap_or_default();
                match word.parse() {
                    Ok(number) => self.found.push(number),
                    Err(_) if word == "None" => {}
                    Err(_) => {
                        let number = T::from_word(word);
                        self.found.push(number.ok_or_else(|| Problem(format!("\"{word:.40}\" is not a number")))?);
                    }
                }
            }
        }
        Ok(())
    }

    /// The numbers, once all parts have been read.
    pub fn all(self) -> Result<Vec<T>, Problem> {
        if self.open == 0 { Ok(self.found) } else { Err(unmatched()) }
    }
}

fn unmatched() -> Problem {
    Problem::new("its parentheses do not match")
}

/// The number at the beginning of `text` and its length, where it is a plain decimal one.
fn quick<T: Number>(text: &[u8]) -> Option<(T, usize)> {
    let negative = text.first() == Some(&b'-');
    let mut at = usize::from(negative);
    let mut value = 0;
    let mut count = digits(text, &mut at, &mut value);
    let mut tens = 0;
    if text.get(at) == Some(&b'.') {
        at += 1;
        let decimals = digits(text, &mut at, &mut value);
        tens = -(decimals as i32);
        count += decimals;
    }
    if count == 0 || count > MOST_DIGITS {
        return None;
    }
    if let Some(b'e' | b'E') = text.get(at) {
        at += 1;
        let below = text.get(at) == Some(&b'-');
        at += usize::from(below || text.get(at) == Some(&b'+'));
        let mut exponent = 0;
        if !(1..=3).contains(&digits(text, &mut at, &mut exponent)) {
            return None;
        }
        tens += if below { -(exponent as i32) } else { exponent as i32 };
    }
    if text.get(at).is_some_and(|&b| is_part(b)) {
        return None;
    }
    Some((T::scaled(negative, value, tens)?, at))
}

/// Appends the decimal digits at `at` to `value`, and gives their number. More than 64 bits hold are lost.
fn digits(text: &[u8], at: &mut usize, value: &mut u64) -> usize {
    let first = *at;
    while let Some(block) = text[*at..].first_chunk::<8>() {
        // Eight letters at once: each lane 0 to 9 for a digit, anything else for what is none.
        let lanes = u64::from_le_bytes(*block) ^ 0x3030_3030_3030_3030;
        // The highest bit of the first lane beyond 9 and perhaps of some after it.
        let beyond = (lanes.wrapping_add(0x7676_7676_7676_7676) | lanes) & 0x8080_8080_8080_8080;
        let count = beyond.trailing_zeros() as usize / 8;
        if count == 0 {
            return *at - first;
        }
        // The digits go to the end, zeros before them.
        *value = value.wrapping_mul(WHOLE_TENS[count]).wrapping_add(eight_digits(lanes << (64 - 8 * count)));
        *at += count;
        if count < 8 {
            return *at - first;
        }
    }
    while let Some(digit) = text.get(*at).map(|b| b.wrapping_sub(b'0')).filter(|&d| d < 10) {
        *value = value.wrapping_mul(10).wrapping_add(digit.into());
        *at += 1;
    }
    *at - first
}

/// Eight digits, the first in the lowest lane: neighbours are joined to pairs, pairs to fours, fours to eight.
fn eight_digits(lanes: u64) -> u64 {
    let pairs = lanes.wrapping_mul(10).wrapping_add(lanes >> 8) & 0x00ff_00ff_00ff_00ff;
    let fours = pairs.wrapping_mul(100).wrapping_add(pairs >> 16) & 0x0000_ffff_0000_ffff;
    fours.wrapping_mul(10_000).wrapping_add(fours >> 32) & 0xffff_ffff
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// What [`Numbers`] makes of text that comes in two parts, and what the standard library does.
    fn both<T: Number + Copy>(words: &[String], cut: usize) -> (Vec<T>, Vec<T>) {
        let mut numbers = Numbers::new();
        let cut = cut.min(words.len());
        numbers.read((words[..cut].join(", ") + ", ").as_bytes()).unwrap();
        numbers.read(words[cut..].join(" ").as_bytes()).unwrap();
        let known = words.iter().map(|w| w.parse().ok().unwrap()).collect();
        (numbers.all().unwrap(), known)
    }

    #[test]
    fn middles_edges_and_long_numbers_are_rounded_as_the_standard_library_rounds_them() {
        // Next to and on the middle of two singles; the smallest and greatest; what 64 bits do not hold.
        let words = [
            "16777217",
            "16777217.000000001",
            "16777216.999999999",
            "16777219",
            "1.00000005960464477539062",
            "1.00000005960464477539063",
            "1.1754942e-38",
            "1e-45",
            "3.4028235e38",
            "3.4028236e38",
            "1e999",
            "1e-999",
            "-0",
            "-0.0",
            "+1.5",
            ".5",
            "5.",
            "00000000000000000000000000001",
            "123456789012345678901234567890",
            "9007199254740993",
            "inf",
            "-inf",
        ];
        let words = words.map(str::to_owned);
        let (found, known) = both::<f32>(&words, 5);
        assert_eq!(
            found.iter().map(|x| x.to_bits()).collect::<Vec<_>>(),
            known.iter().map(|x| x.to_bits()).collect::<Vec<_>>()
        );
        let (found, known) = both::<f64>(&words, 9);
        assert_eq!(
            found.iter().map(|x| x.to_bits()).collect::<Vec<_>>(),
            known.iter().map(|x| x.to_bits()).collect::<Vec<_>>()
        );
    }

    #[test]
    fn what_is_no_number_is_refused() {
        for text in ["1x", "--1", "1.2.3", "e5", "1e", "1e+", "0x10", "1_", ".", "-", "None1", "(1, 2", "1)"] {
            let mut numbers = Numbers::<f32>::new();
            let result = numbers.read(text.as_bytes()).and_then(|()| numbers.all());
            // An underscore is no part of a number: what stands before it is one.
            assert_eq!(result.is_err(), text != "1_", "{text}");
        }
        let mut whole = Numbers::<i64>::new();
        assert!(whole.read(b"[1, -2, None] # 3.5 is no integer\n 4").is_ok());
        assert_eq!(whole.all().unwrap(), [1, -2, 4]);
        assert!(Numbers::<i64>::new().read(b"3.5").is_err());
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 2000, failure_persistence: None, ..ProptestConfig::default() })]

        #[test]
        fn every_single_and_double_comes_back(bits in prop::collection::vec(any::<u64>(), 1..20), cut in 0..20usize) {
            let finite = bits.iter().map(|&b| f64::from_bits(b)).filter(|x| x.is_finite());
            let mut words: Vec<String> = finite.flat_map(|x| [format!("{x}"), format!("{x:e}"), format!("{x:.7}")]).collect();
            words.extend(bits.iter().map(|&b| format!("{}", f32::from_bits(b as u32))).filter(|w| w != "NaN"));
            words.extend(bits.iter().map(|&b| format!("{:.9e}", f32::from_bits(b as u32))).filter(|w| w != "NaN"));
            let (found, known) = both::<f64>(&words, cut);
            prop_assert_eq!(found.iter().map(|x| x.to_bits()).collect::<Vec<_>>(), known.iter().map(|x| x.to_bits()).collect::<Vec<_>>());
            let (found, known) = both::<f32>(&words, cut);
            prop_assert_eq!(found.iter().map(|x| x.to_bits()).collect::<Vec<_>>(), known.iter().map(|x| x.to_bits()).collect::<Vec<_>>());
        }

        #[test]
        fn decimals_of_any_length_come_back(words in prop::collection::vec("-?[0-9]{1,10}(\\.[0-9]{0,14})?(e-?[0-9]{1,2})?", 1..30)) {
            let (found, known) = both::<f32>(&words, 7);
            prop_assert_eq!(found, known);
            let (found, known) = both::<f64>(&words, 7);
            prop_assert_eq!(found, known);
        }
    }
}
