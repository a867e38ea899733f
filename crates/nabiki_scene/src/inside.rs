//! How much of the hair lies inside the head, frame by frame.

use std::fmt;

use nabiki::{Head, Strands};
use rayon::prelude::*;

/// Nodes inside the head in one frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct InsideFrame {
    /// The frame.
    pub frame: u32,
    /// Share of the nodes, but for the roots, that lie inside, 0..1.
    pub share: f64,
    /// How deep the deepest of them lies (cm); 0 where none is inside.
    pub depth: f32,
}

impl InsideFrame {
    /// Of the hair as it is in `frame`.
    pub fn of(frame: u32, head: &Head, strands: &Strands) -> Self {
        let strand = |s: usize| {
            strands.strand(s)[1..]
                .iter()
                .map(|&p| head.depth(p))
                .filter(|&depth| depth > 0.0)
                .fold((0_u64, 0.0_f32), |(count, deepest), depth| (count + 1, deepest.max(depth)))
        };
        let sum = |a: (u64, f32), b: (u64, f32)| (a.0 + b.0, a.1.max(b.1));
        let (count, depth) = (0..strands.len()).into_par_iter().with_min_len(64).map(strand).reduce(|| (0, 0.0), sum);
        Self { frame, share: count as f64 / strands.segment_count() as f64, depth }
    }
}

/// Nodes inside the head over a whole motion.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Inside {
    /// Frame 0.
    pub rest: InsideFrame,
    /// The frame with the largest share; the first of several.
    pub worst: InsideFrame,
    /// The last frame.
    pub last: InsideFrame,
    /// The deepest node of all frames.
    pub deepest: InsideFrame,
}

impl Inside {
    /// Takes in the next frame; each once, from 0 on.
    pub fn add(&mut self, now: InsideFrame) {
        if now.frame == 0 {
            *self = Self { rest: now, worst: now, last: now, deepest: now };
        }
        self.last = now;
        if now.share > self.worst.share {
            self.worst = now;
        }
        if now.depth > self.deepest.depth {
            self.deepest = now;
        }
    }
}

impl fmt::Display for Inside {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let percent = |frame: InsideFrame| 100.0 * frame.share;
        write!(
            f,
            "  inside  {:.2} % of the nodes are inside the head at frame {} ({:.2} % at rest, at worst {:.2} % at frame \
             {})",
            percent(self.last),
            self.last.frame,
            percent(self.rest),
            percent(self.worst),
            self.worst.frame,
        )?;
        if self.deepest.depth > 0.0 {
            write!(f, "\n          the deepest {:.2} cm at frame {}", self.deepest.depth, self.deepest.frame)?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_worst_frame_is_the_first_of_the_largest_share() {
        let mut inside = Inside::default();
        for (frame, share, depth) in [(0, 0.1, 0.2), (1, 0.4, 0.1), (2, 0.4, 0.9), (3, 0.2, 0.3)] {
            inside.add(InsideFrame { frame, share, depth });
        }
        let frames = [inside.rest, inside.worst, inside.deepest, inside.last].map(|f| f.frame);
        assert_eq!(frames, [0, 1, 2, 3]);
    }
}
