//! Numbers into bits, the highest bit of a byte first.

use crate::layout::{self, Quantised};
use crate::numbers::{Coder, KINDS, Kind, LONGEST_QUOTIENT, Usual};

/// All numbers of `bust`, in order.
pub(crate) fn all(bust: &mut Quantised) -> Vec<u8> {
    let mut writer = Writer { bytes: Vec::new(), bits: 0, count: 0, usual: [Usual::UNKNOWN; KINDS] };
    layout::code(bust, &mut writer);
    writer.put(0, 7);
    writer.bytes
}

/// 0, -1, 1, -2, ... as 0, 1, 2, 3, ...
fn fold(difference: i32) -> u32 {
    ((difference << 1) ^ (difference >> 31)) as u32
}

struct Writer {
    bytes: Vec<u8>,
    /// The last `count` bits, not yet a byte.
    bits: u64,
    count: u32,
    usual: [Usual; KINDS],
}

impl Writer {
    /// The lowest `count` bits of a number: at most 32.
    fn put(&mut self, number: u32, count: u32) {
        self.bits = self.bits << count | u64::from(number);
        self.count += count;
        while self.count >= 8 {
            self.count -= 8;
            self.bytes.push((self.bits >> self.count) as u8);
        }
        self.bits &= (1 << self.count) - 1;
    }
}

impl Coder for Writer {
    const READS: bool = false;

    fn code(&mut self, kind: Kind, expected: i32, value: &mut i32) {
        let usual = &mut self.usual[kind as usize];
        let (folded, low) = (fold(*value - expected), usual.low_bits());
        usual.note(folded);
        let quotient = folded >> low;
        if quotient >= LONGEST_QUOTIENT {
            self.put((1 << LONGEST_QUOTIENT) - 1, LONGEST_QUOTIENT);
            self.put(folded, 32);
        } else {
            // As many ones, and a nought.
            self.put((1 << (quotient + 1)) - 2, quotient + 1);
            self.put(folded & ((1 << low) - 1), low);
        }
    }
}
