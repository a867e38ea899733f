//! MurmurHash3 (x64, 128 bits; Austin Appleby, public domain), by which Alembic tells equal samples.

const C1: u64 = 0x87c3_7b91_1142_53d5;
const C2: u64 = 0x4cf5_ad43_2745_937f;

/// The hash of `bytes`, seeded with 0 as Alembic does.
pub fn digest(bytes: &[u8]) -> [u8; 16] {
    let (mut h1, mut h2) = (0u64, 0u64);
    let (blocks, tail) = bytes.as_chunks::<16>();
    for block in blocks {
        let (k1, k2) = block.split_at(8);
        h1 ^= scramble(word(k1), C1, 31, C2);
        h1 = h1.rotate_left(27).wrapping_add(h2).wrapping_mul(5).wrapping_add(0x52dc_e729);
        h2 ^= scramble(word(k2), C2, 33, C1);
        h2 = h2.rotate_left(31).wrapping_add(h1).wrapping_mul(5).wrapping_add(0x3849_5ab5);
    }
    let (low, high) = tail.split_at(tail.len().min(8));
    h2 ^= scramble(word(high), C2, 33, C1);
    h1 ^= scramble(word(low), C1, 31, C2);

    h1 ^= bytes.len() as u64;
    h2 ^= bytes.len() as u64;
    h1 = h1.wrapping_add(h2);
    h2 = h2.wrapping_add(h1);
    h1 = finish(h1);
    h2 = finish(h2);
    h1 = h1.wrapping_add(h2);
    h2 = h2.wrapping_add(h1);
    let mut hash = [0; 16];
    hash[..8].copy_from_slice(&h1.to_le_bytes());
    hash[8..].copy_from_slice(&h2.to_le_bytes());
    hash
}

/// Up to eight bytes as a number, the missing ones 0 (which `scramble` keeps at 0).
fn word(bytes: &[u8]) -> u64 {
    let mut all = [0; 8];
    all[..bytes.len()].copy_from_slice(bytes);
    u64::from_le_bytes(all)
}

fn scramble(k: u64, first: u64, turn: u32, second: u64) -> u64 {
    k.wrapping_mul(first).rotate_left(turn).wrapping_mul(second)
}

fn finish(mut h: u64) -> u64 {
    h = (h ^ (h >> 33)).wrapping_mul(0xff51_afd7_ed55_8ccd);
    h = (h ^ (h >> 33)).wrapping_mul(0xc4ce_b9fe_1a85_ec53);
    h ^ (h >> 33)
}

#[cfg(test)]
mod tests {
    use super::digest;

    #[test]
    fn digests_are_those_that_alembic_writes() {
        let points: Vec<u8> = (0..5).flat_map(|x| [x as f32, 0.0, 0.5]).flat_map(f32::to_le_bytes).collect();
        let expected = [212, 182, 34, 221, 169, 95, 51, 221, 17, 240, 150, 58, 113, 9, 55, 174];
        assert_eq!(digest(&points), expected, "array P of an archive written by Alembic 1.8.12");
        let expected = [0x16, 0xfe, 0x74, 0x83, 0x90, 0x5c, 0xce, 0x7a, 0x85, 0x67, 0x0e, 0x43, 0xe4, 0x67, 0x88, 0x77];
        assert_eq!(digest(&[1]), expected, "the scalar true, the same way");
    }
}
