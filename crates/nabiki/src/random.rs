//! Random numbers that do not depend on what was drawn before: SplitMix64 (Steele, Lea and Flood, "Fast splittable
//! pseudorandom number generators", 2014).

/// 2^64 over the golden ratio, odd: the step between the counters of one stream.
pub const GOLDEN_GAMMA: u64 = 0x9e37_79b9_7f4a_7c15;

/// The random number of a counter: one step of SplitMix64 from the state `counter`.
pub fn mix(counter: u64) -> u64 {
    finalise(counter.wrapping_add(GOLDEN_GAMMA))
}

/// The finaliser alone: a bijection in which every bit of the answer depends on every bit of `z`; it keeps 0.
pub fn finalise(z: u64) -> u64 {
    let z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// A random number as a float in [0, 1), from its upper bits.
pub fn unit(random: u64) -> f64 {
    (random >> 11) as f64 / (1_u64 << 53) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_stream_of_seed_1234567_is_the_published_one() {
        // The values that the authors' Java code and Vigna's C code give for this seed (Rosetta Code, "Pseudo-random
        // numbers/Splitmix64").
        let published = [
            6_457_827_717_110_365_317,
            3_203_168_211_198_807_973,
            9_817_491_932_198_370_423,
            4_593_380_528_125_082_431,
            16_408_922_859_458_223_821,
        ];
        let stream: Vec<u64> =
            (0..5).map(|n: u64| mix(1_234_567_u64.wrapping_add(n.wrapping_mul(GOLDEN_GAMMA)))).collect();
        assert_eq!(stream, published);
    }
}
