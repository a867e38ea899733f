//! Whole numbers in few bits: adaptive Golomb-Rice codes.
//!
//! A number is told as its difference from what was to be expected. Small differences take few bits, and how small
//! they usually are is learnt, kind by kind, from those already told (as in Weinberger, Seroussi and Sapiro, "The
//! LOCO-I lossless image compression algorithm", 2000).

/// Kinds of numbers, each with its own usual size.
#[derive(Clone, Copy, Debug)]
pub enum Kind {
    /// Counts and planes of grids.
    Grid,
    /// Lengths of runs of equal values.
    Run,
    /// Coordinates of vertices.
    Vertex,
    /// Distances at coarse nodes.
    Coarse,
    /// Distances at fine nodes.
    Fine,
}

/// How many [`Kind`]s there are.
pub const KINDS: usize = 5;

/// One way of telling numbers: writing or reading.
pub trait Coder {
    /// Whether it reads: then no value need be known.
    const READS: bool;

    /// Tells `value`, of which `expected` is known to both sides; a reader puts what it reads there.
    fn code(&mut self, kind: Kind, expected: i32, value: &mut i32);
}

/// Quotients from this on are followed by the whole number in 32 bits.
pub const LONGEST_QUOTIENT: u32 = 24;

/// The usual size of one kind of number.
#[derive(Clone, Copy, Debug)]
pub struct Usual {
    sum: u64,
    count: u64,
}

impl Usual {
    /// Before any is known.
    pub const UNKNOWN: Self = Self { sum: 64, count: 4 };

    /// Bits below the quotient.
    pub fn low_bits(self) -> u32 {
        (self.sum / self.count).max(1).ilog2()
    }

    /// Takes note of a number.
    pub fn note(&mut self, folded: u32) {
        self.sum += u64::from(folded);
        self.count += 1;
        if self.count == 64 {
            self.sum /= 2;
            self.count /= 2;
        }
    }
}

/// 0, 1, 2, 3, ... as 0, -1, 1, -2, ...
pub fn unfold(folded: u32) -> i32 {
    (folded >> 1) as i32 ^ -((folded & 1) as i32)
}
