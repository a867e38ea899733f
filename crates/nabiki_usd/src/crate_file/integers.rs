//! Packing of bytes with LZ4, and of integers as differences before that.

/// Most bytes that one LZ4 block holds here; longer data is packed in several.
const CHUNK: usize = 127 * 1024 * 1024;
/// Bytes one byte of LZ4 can stand for at most: a length goes on in bytes that each add up to 255 to it.
const MOST_GROWTH: usize = 255;

/// Integers that `bytes` can stand for at most: LZ4 stretches each byte to so many, and each of these is the code of four
/// integers.
pub fn most_integers(bytes: u64) -> u64 {
    bytes.saturating_mul(4 * MOST_GROWTH as u64)
}

/// Packs bytes: a count of chunks (0 for one without a length of its own), then LZ4 blocks.
pub fn pack(bytes: &[u8]) -> Vec<u8> {
    if bytes.len() <= CHUNK {
        let mut packed = vec![0];
        packed.extend(lz4_flex::block::compress(bytes));
        return packed;
    }
    let chunks = bytes.chunks(CHUNK);
    let mut packed = vec![chunks.len() as u8];
    for chunk in chunks {
        let block = lz4_flex::block::compress(chunk);
        packed.extend((block.len() as i32).to_le_bytes());
        packed.extend(block);
    }
    packed
}

/// Unpacks what must be `size` bytes at most, and cannot be that many if it is packed in too few.
pub fn unpack(packed: &[u8], size: usize) -> Result<Vec<u8>, String> {
    unpack_between(packed, size, size)
}

/// Unpacks what holds `least` bytes or more and `most` bytes at most. No room is made for what so few packed bytes
/// cannot hold.
fn unpack_between(packed: &[u8], least: usize, most: usize) -> Result<Vec<u8>, String> {
    let too_short = || "a packed table that ends too early".to_owned();
    let (&chunks, mut rest) = packed.split_first().ok_or_else(too_short)?;
    let holds = packed.len().saturating_mul(MOST_GROWTH);
    if least > holds {
        return Err(format!("{} packed bytes that claim to hold {least}", packed.len()));
    }
    let block = |bytes: &[u8], room: usize| {
        let room = room.min(bytes.len().saturating_mul(MOST_GROWTH));
        lz4_flex::block::decompress(bytes, room).map_err(|e| format!("a table that cannot be unpacked: {e}"))
    };
    if chunks == 0 {
        return block(rest, most);
    }
    let mut bytes = Vec::new();
    for _ in 0..chunks {
        let (length, after) = rest.split_first_chunk::<4>().ok_or_else(too_short)?;
        let length = usize::try_from(i32::from_le_bytes(*length)).map_err(|_| too_short())?;
        let (part, after) = after.split_at_checked(length).ok_or_else(too_short)?;
        bytes.extend(block(part, most - bytes.len())?);
        rest = after;
    }
    Ok(bytes)
}

/// Packs integers of 32 bits.
pub fn pack_integers(values: &[u32]) -> Vec<u8> {
    let mut last = 0u32;
    let differences: Vec<i32> = values
        .iter()
        .map(|&value| {
            let difference = value.wrapping_sub(last) as i32;
            last = value;
            difference
        })
        .collect();
    let mut counts = std::collections::BTreeMap::new();
    for &d in &differences {
        *counts.entry(d).or_insert(0usize) += 1;
    }
    let common = counts.into_iter().max_by_key(|&(d, n)| (n, d)).map_or(0, |(d, _)| d);
    let mut codes = vec![0u8; differences.len().div_ceil(4)];
    let mut rest = Vec::new();
    for (i, &d) in differences.iter().enumerate() {
        let code = if d == common {
            0
        } else if let Ok(small) = i8::try_from(d) {
            rest.extend(small.to_le_bytes());
            1
        } else if let Ok(small) = i16::try_from(d) {
            rest.extend(small.to_le_bytes());
            2
        } else {
            rest.extend(d.to_le_bytes());
            3
        };
        codes[i / 4] |= code << (2 * (i % 4));
    }
    let mut coded = common.to_le_bytes().to_vec();
    coded.extend(codes);
    coded.extend(rest);
    pack(&coded)
}

/// Unpacks `count` integers of `WIDTH` bytes, 4 or 8, each as `number` makes it of a 64-bit one.
pub fn unpack_integers_as<const WIDTH: usize, T>(
    packed: &[u8],
    count: usize,
    number: impl Fn(i64) -> T,
) -> Result<Vec<T>, String> {
    let too_short = || "a table of integers that ends too early".to_owned();
    if count == 0 {
        return Ok(Vec::new());
    }
    if count > most_integers(packed.len() as u64) as usize {
        return Err(format!("{} packed bytes that claim to hold {count} integers", packed.len()));
    }
    // Differences that are all the commonest one take no more than their codes; all others are at most as wide as the
    // integers.
    let codes_length = count.div_ceil(4);
    let least = WIDTH + codes_length;
    let coded = unpack_between(packed, least, least + WIDTH * count)?;
    let (common, rest) = coded.split_at_checked(WIDTH).ok_or_else(too_short)?;
    let (codes, mut rest) = rest.split_at_checked(codes_length).ok_or_else(too_short)?;
    let common = signed(common);
    let mut value = 0i64;
    let mut values = Vec::with_capacity(count);
    for i in 0..count {
        let width = match codes[i / 4] >> (2 * (i % 4)) & 3 {
            0 => 0,
            code => WIDTH >> (3 - code),
        };
        let difference = if width == 0 {
            common
        } else {
            let (bytes, after) = rest.split_at_checked(width).ok_or_else(too_short)?;
            rest = after;
            signed(bytes)
        };
        value = value.wrapping_add(difference);
        if WIDTH == 4 {
            value = i64::from(value as i32);
        }
        values.push(number(value));
    }
    Ok(values)
}

/// The same as 64-bit integers.
pub fn unpack_integers<const WIDTH: usize>(packed: &[u8], count: usize) -> Result<Vec<i64>, String> {
    unpack_integers_as::<WIDTH, i64>(packed, count, |value| value)
}

/// One to eight bytes as a signed number.
fn signed(bytes: &[u8]) -> i64 {
    let mut all = [if bytes.last().is_some_and(|&b| b >= 0x80) { 0xff } else { 0 }; 8];
    all[..bytes.len()].copy_from_slice(bytes);
    i64::from_le_bytes(all)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn integers_of_all_sizes_come_back() {
        let values: Vec<u32> = vec![0, 1, 2, 3, 200, 100_000, 100_001, u32::MAX, 5, 5, 5, 1 << 31, 0];
        let back = unpack_integers::<4>(&pack_integers(&values), values.len()).unwrap();
        assert_eq!(back.iter().map(|&x| x as u32).collect::<Vec<_>>(), values);
    }

    #[test]
    fn a_million_equal_integers_come_back_from_a_few_kilobytes() {
        // Counts of strands that are alike, as every groom has them; and the same as 64-bit ones, by the same rules.
        const COUNT: usize = 1_000_000;
        for value in [0u32, 2, 17, u32::MAX] {
            let packed = pack_integers(&vec![value; COUNT]);
            assert!(packed.len() < COUNT / 4 / 200, "{} bytes", packed.len());
            assert_eq!(unpack_integers::<4>(&packed, COUNT).unwrap(), vec![i64::from(value as i32); COUNT]);
        }
        let mut coded = 5i64.to_le_bytes().to_vec();
        coded.extend(vec![0; COUNT.div_ceil(4)]);
        let rising = unpack_integers::<8>(&pack(&coded), COUNT).unwrap();
        assert!(rising.iter().enumerate().all(|(i, &x)| x == 5 * (i as i64 + 1)));
    }

    #[test]
    fn every_length_of_a_run_comes_back() {
        for count in (1..70).chain([1300, 5529, 20_000, 100_000]) {
            let values = vec![19; count];
            let back = unpack_integers::<4>(&pack_integers(&values), count).unwrap();
            assert!(back.len() == count && back.iter().all(|&x| x == 19), "{count}");
        }
    }

    #[test]
    fn what_would_unpack_to_more_than_is_claimed_is_refused() {
        let packed = pack(&vec![7; 1 << 20]);
        assert!(unpack(&packed, 1 << 19).is_err());
        // More zeros than codes and differences of so many integers can be.
        assert!(unpack_integers::<4>(&pack(&vec![0; 1 << 20]), 1000).is_err());
        // As many integers as the bytes could stand for at the very most, and one more.
        let packed = pack_integers(&[1; 4000]);
        let most = most_integers(packed.len() as u64) as usize;
        for count in [most, most + 1, usize::MAX] {
            assert!(unpack_integers::<4>(&packed, count).is_err(), "{count}");
        }
    }

    #[test]
    fn counts_that_cannot_be_true_are_refused_before_memory_is_taken() {
        let packed = pack_integers(&[1, 2, 3]);
        assert!(unpack_integers::<4>(&packed, usize::MAX / 64).is_err());
        assert!(unpack(&packed, usize::MAX).is_err());
    }
}
