//! Every frame of whatever opens as a motion cache, damaged or with the sums of what it holds.
#![no_main]

use libfuzzer_sys::fuzz_target;
use nabiki_fuzz::within_budget;
use nabiki_io::cache::Reader;
use twox_hash::XxHash3_64;

fuzz_target!(|bytes: &[u8]| {
    read(bytes);
    if let Some(bytes) = summed(bytes) {
        read(&bytes);
    }
});

fn read(bytes: &[u8]) {
    within_budget(bytes.len(), || {
        if let Ok(mut cache) = Reader::from_bytes(bytes) {
            for frame in 0..cache.frame_count() {
                let _ = cache.hair(frame);
            }
        }
    });
}

/// The same with its own sums, which no chance would find; `None` where it has no room for them.
fn summed(bytes: &[u8]) -> Option<Vec<u8>> {
    let points = u32::from_le_bytes(*bytes.get(16..)?.first_chunk()?) as usize;
    let frames_at = usize::try_from(u64::from_le_bytes(*bytes.get(32..)?.first_chunk()?)).ok()?;
    let at = bytes.windows(8).position(|tag| tag == b"sums    ")? + 16;
    let frames = bytes.get(frames_at..)?.chunks(points.checked_mul(12)?.checked_add(28)?);
    let all = std::iter::once(bytes.get(..at)?).chain(frames);
    let sums: Vec<u8> = all.flat_map(|part| XxHash3_64::oneshot(part).to_le_bytes()).collect();
    let mut bytes = bytes.to_vec();
    bytes.get_mut(at..)?.get_mut(..sums.len())?.copy_from_slice(&sums);
    Some(bytes)
}
