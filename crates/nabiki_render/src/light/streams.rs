//! Light that hair scatters, in two streams: away from the lamp and back to it (Zinke et al. 2008, with all numbers of reversals).

use std::f32::consts::PI;

/// Sine of the inclination to the hair at which even light meets it in the mean: int sin cos^2 / int cos^2.
///
/// What light loses on its way through hair goes by how it crosses that hair, not by how the hair that shows it is seen: hair that
/// points at the eye reflects all there is, and does not make clear what lies before it.
pub const MIDDLING: f32 = 4.0 / (3.0 * PI);

/// Hair as a medium: what each fibre does with light of middling inclination (red, green, blue).
#[derive(Clone, Copy, Default)]
pub struct Medium {
    /// The parts that it passes on, and sends back.
    pub forward: [f32; 3],
    pub back: [f32; 3],
    /// See [`sent_back`] and [`decay`].
    pub whole: [f32; 3],
    pub decay: [f32; 3],
}

impl Medium {
    /// Of fibres with these parts at middling inclination.
    pub fn of(forward: [f32; 3], back: [f32; 3]) -> Self {
        let of_each = |of: fn(f32, f32) -> f32| std::array::from_fn(|c| of(forward[c], back[c]));
        Self { forward, back, whole: of_each(sent_back), decay: of_each(decay) }
    }
}

/// The part of even light that hair without end sends back, of which each fibre passes on the part `a` and sends back `b`.
///
/// One fibre more before it changes nothing: R = b + a^2 R / (1 - b R), whose smaller root this is. It is the sum over all
/// numbers of reversals, of which Zinke et al. (2008) take one and three.
#[inline(always)]
pub fn sent_back(a: f32, b: f32) -> f32 {
    let q = 1.0 - a * a + b * b;
    2.0 * b / (q + (q * q - 4.0 * b * b).max(0.0).sqrt()).max(1e-12)
}

/// How fast scattered light grows less in hair of which each fibre passes on the part `a` and sends back `b`: e^-decay for each fibre
/// on the straight way.
///
/// Two streams that go straight on and back would have sqrt((1 - a)^2 - b^2). Scattered light goes aslant, and so farther: of the
/// eigenvalues of transport across parallel fibres, with the azimuths of all lobes, this is within 6 % for hair from blond to black.
#[inline(always)]
pub fn decay(a: f32, b: f32) -> f32 {
    let lost = (1.0 - a).max(0.0);
    let two_ways = (lost * lost - b * b).max(1e-6).sqrt();
    two_ways * (1.7 - 0.7 * two_ways)
}

/// Of light that falls onto a slab of hair, the parts that go away from the lamp and back to it at a place within: hair without end would
/// send back the part `whole`, and what grows less by `decay` arrives there with `before` and leaves the hair behind with `behind`.
#[inline(always)]
pub fn slab(whole: f32, before: f32, behind: f32) -> [f32; 2] {
    let (far, sent) = (behind * behind, whole * whole);
    // Of clear hair and no hair behind it nothing is left of either: nothing is scattered there.
    let part = before / (1.0 - sent * before * before * far).max(1e-6);
    [(1.0 - sent * far) * part, whole * (1.0 - far) * part]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::light::fibre::{COLUMNS, ROWS, Table};

    #[test]
    fn scattered_light_grows_less_as_it_does_across_parallel_fibres() {
        // Red, green and blue of blond hair, red of brown and green of red hair, and black hair (absorption per radius).
        for absorption in [0.05, 0.10, 0.25, 0.57, 0.76, 3.4] {
            let table = Table::new([absorption; 3], 1.55, 0.3);
            let row = 0.4 * (ROWS - 1) as f32;
            let of_row = table.row(row);
            // Which part of its light a fibre turns by each of these angles, from straight on.
            const STEPS: usize = 96;
            let angle = |i: usize| (i as f32) * 2.0 * PI / STEPS as f32;
            let turned: Vec<f32> = (0..STEPS)
                .map(|i| {
                    let lobes = table.lobes(row, (PI - angle(i)).abs() * COLUMNS as f32 / PI);
                    (lobes[0] + lobes[1] + lobes[4] + of_row.rest[0]) * 2.0 * PI / STEPS as f32
                })
                .collect();
            // Light that falls off as e^-kx has I = P I / (1 - k cos): that operator's largest eigenvalue is 1 for the true k.
            let eigenvalue = |k: f32| {
                let mut light = vec![1.0_f32; STEPS];
                let mut value = 0.0;
                for _ in 0..200 {
                    let next: Vec<f32> = (0..STEPS)
                        .map(|i| {
                            let scattered: f32 = (0..STEPS).map(|j| turned[(i + STEPS - j) % STEPS] * light[j]).sum();
                            scattered / (1.0 - k * angle(i).cos())
                        })
                        .collect();
                    value = next.iter().copied().fold(0.0, f32::max);
                    light = next.iter().map(|l| l / value).collect();
                }
                value
            };
            let (mut low, mut high) = (0.0, 0.999);
            for _ in 0..14 {
                let k = 0.5 * (low + high);
                if eigenvalue(k) < 1.0 { low = k } else { high = k }
            }
            let fitted = decay(of_row.forward[0], of_row.back[0]);
            assert!((fitted / low - 1.0).abs() < 0.06, "{absorption}: {fitted} for {low}");
        }
    }

    #[test]
    fn a_slab_loses_nothing_of_clear_hair_and_is_the_sum_of_its_layers() {
        // Between two places no light arises: the streams differ by what gets through, here for hair that takes nearly nothing.
        let (a, b) = (0.9, 0.0999);
        let (whole, lost) = (sent_back(a, b), decay(a, b));
        let at = |n: f32| slab(whole, (-lost * n).exp(), (-lost * (8.0 - n)).exp());
        let net = |n: f32| at(n)[0] - at(n)[1];
        assert!((net(0.0) - net(8.0)).abs() < 0.05 * net(0.0), "{} {}", net(0.0), net(8.0));
        assert!((at(0.0)[0] - 1.0).abs() < 1e-5 && at(8.0)[1].abs() < 1e-5);
        // The same place reached in two slabs: the first, with what the second sends back.
        let (a, b) = (0.8, 0.1);
        let (whole, lost) = (sent_back(a, b), decay(a, b));
        let through = |n: f32| (-lost * n).exp();
        let [_, sent] = slab(whole, 1.0, through(3.0));
        let [away, back] = slab(whole, through(2.0), through(3.0));
        assert!((back - sent * away).abs() < 1e-6);
        // Deep hair sends back what hair without end does, and black hair nothing on its way.
        assert!((slab(whole, 1.0, through(100.0))[1] - whole).abs() < 1e-5);
        assert_eq!(slab(0.0, 0.25, 0.5), [0.25, 0.0]);
        assert!([[1.0, 1.0, 1.0], [1.0, 0.0, 1.0]].iter().all(|&[r, n, m]| slab(r, n, m) == [0.0; 2]));
    }

    #[test]
    fn what_hair_sends_back_is_the_sum_of_all_reversals_and_no_more_than_arrives() {
        for (a, b) in [(0.05, 0.04), (0.5, 0.3), (0.75, 0.2), (0.3, 0.65), (0.8, 0.15), (0.0, 0.5), (0.0, 0.0)] {
            // Layer upon layer: each new one before those that are there sends back what goes to and fro between them.
            let mut sum = 0.0_f64;
            for _ in 0..2000 {
                sum = b + a * a * sum / (1.0 - b * sum);
            }
            // A few roundings; the root takes the half of the digits where a + b is near 1.
            assert!((f64::from(sent_back(a as f32, b as f32)) - sum).abs() < 1e-5, "{a} {b}");
            assert!(sum < 1.0);
        }
        // Clear hair sends back all, to the root of a rounding.
        for b in [0.1, 0.5, 0.9] {
            assert!((sent_back(1.0 - b, b) - 1.0).abs() < 3e-3, "{b}");
        }
    }
}
