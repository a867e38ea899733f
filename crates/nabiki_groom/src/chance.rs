//! What chance decides of a strand: draws that do not depend on order.

pub(crate) use nabiki::chance::Chance;

/// Channels of chance, one use each.
pub(crate) mod channel {
    pub const LENGTH: u64 = 0;
    pub const STRAY: u64 = 1;
    pub const DEPTH: u64 = 2;
    pub const PHASE: u64 = 3;
    pub const SIDE: u64 = 4;
    pub const STIFFNESS: u64 = 5;
    pub const CUT: u64 = 6;
    pub const ROOT: u64 = 7;
    pub const TILT: u64 = 8;
    /// Two of them.
    pub const WOBBLE: u64 = 9;
    pub const EDGE: u64 = 11;
    /// Radius, pitch, turn and hand of a clump's curls; radius and turn of a strand's.
    pub const CURL: u64 = 12;
    /// Place within the band of a ponytail.
    pub const BAND: u64 = 16;
    pub const BABY: u64 = 17;
}
