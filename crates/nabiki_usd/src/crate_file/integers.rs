//! Packing of bytes with LZ4, and of integers as differences before that.

/// Most bytes that one LZ4 block holds here; longer data is packed in several.
const CHUNK: usize = 127 * 1024 * 1024;
/// Bytes one byte of LZ4 can stand for at most.
const MOST_GROWTH: usize = 255;

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

/// Unpacks what must be `size` bytes at most.
pub fn unpack(packed: &[u8], size: usize) -> Result<Vec<u8>, String> {
    let too_short = || "a packed table that ends too early".to_owned();
    let (&chunks, mut rest) = packed.split_first().ok_or_else(too_short)?;
    if size / MOST_GROWTH > packed.len() {
        return Err(format!("{} packed bytes that claim to hold {size}", packed.len()));
    }
    let block = |bytes: &[u8], room: usize| {
        lz4_flex::block::decompress(bytes, room).map_err(|e| format!("a table that cannot be unpacked: {e}"))
    };
    if chunks == 0 {
        return block(rest, size);
    }
    let mut bytes = Vec::new();
    for _ in 0..chunks {
        let (length, after) = rest.split_first_chunk::<4>().ok_or_else(too_short)?;
        let length = usize::try_from(i32::from_le_bytes(*length)).map_err(|_| too_short())?;
        let (part, after) = after.split_at_checked(length).ok_or_else(too_short)?;
        bytes.extend(block(part, size - bytes.len())?);
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

/// Unpacks `count` integers of `WIDTH` bytes, 4 or 8, as 64-bit ones.
pub fn unpack_integers<const WIDTH: usize>(packed: &[u8], count: usize) -> Result<Vec<i64>, String> {
    let too_short = || "a table of integers that ends too early".to_owned();
    if count == 0 {
        return Ok(Vec::new());
    }
    // A run of one difference is a byte for each four integers before LZ4, which can shorten it further.
    if count / (4 * MOST_GROWTH) > packed.len() {
        return Err(format!("{} packed bytes that claim to hold {count} integers", packed.len()));
    }
    let codes_length = count.div_ceil(4);
    let coded = unpack(packed, WIDTH + codes_length + WIDTH * count)?;
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
        values.push(value);
    }
    Ok(values)
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
    fn counts_that_cannot_be_true_are_refused_before_memory_is_taken() {
        let packed = pack_integers(&[1, 2, 3]);
        assert!(unpack_integers::<4>(&packed, usize::MAX / 64).is_err());
        assert!(unpack(&packed, usize::MAX).is_err());
    }
}
