//! The nearest of many places, and how much each of them counts.

/// How many places are mixed.
const MIXED: usize = 3;
/// A place as near as this counts alone (cm).
const SAME_CM: f64 = 1e-3;

/// The nearest places to a point, found one by one.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Nearest([(f64, u32); MIXED + 1]);

impl Default for Nearest {
    fn default() -> Self {
        Self([(f64::INFINITY, u32::MAX); MIXED + 1])
    }
}

impl Nearest {
    /// The distance (cm) beyond which a place changes nothing.
    pub fn reach(&self) -> f64 {
        self.0[MIXED].0
    }

    /// The distance to the nearest place (cm); infinite without any.
    pub fn distance(&self) -> f64 {
        self.0[0].0
    }

    /// Another place, at this distance (cm). Of places at the same distance, the lower number is the nearer one.
    pub fn offer(&mut self, distance: f64, number: u32) {
        let place = self.0.partition_point(|of| of.0 < distance || of.0 == distance && of.1 < number);
        if place <= MIXED {
            self.0[place..].rotate_right(1);
            self.0[place] = (distance, number);
        }
    }

    /// The places that count, nearest first, each with its weight: ((R - r) / (R r))^2 at the distance r, where R is that of
    /// the nearest place that does not count. So weights change smoothly.
    pub fn weights(&self) -> Vec<(u32, f64)> {
        let beyond = self.reach();
        let weight = |r: f64| if beyond.is_finite() { ((beyond - r) / (beyond * r)).powi(2) } else { r.powi(-2) };
        if self.distance() <= SAME_CM || beyond <= self.distance() {
            return vec![(self.0[0].1, 1.0)];
        }
        self.0[..MIXED].iter().filter(|of| of.0.is_finite()).map(|&(r, number)| (number, weight(r))).collect()
    }
}
