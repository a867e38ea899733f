//! The pass of all blocks of strands through any number of frames, on all cores.

use std::ops::Range;

use glam::Vec3;
use pulp::NullaryFnOnce;

use super::VectorWidth;
use super::block::Block;

/// Blocks that a core takes at a time in a pass over one frame: enough to hide the hand-over, few enough to share 300
/// strands.
const GRAIN: usize = 8;

/// A form of the motion: packed hair, everything that does not change from frame to frame, and the step.
pub(super) trait Swept: Sync {
    /// The moving state of one segment of sixteen strands.
    type State: Copy + Send + Sync;
    /// The mode of a frame.
    type Plan<'a>: Sync;

    fn blocks(&self) -> &[Block];

    /// Takes one block through one frame, and writes its points where the caller wants them.
    fn frame(&self, block: &Block, plan: &Self::Plan<'_>, states: &mut [Self::State], page: Option<&mut [Vec3]>);
}

/// Takes every block through all `plans`, one block after another, so that its state stays in the nearest cache.
pub(super) fn sweep<F: Swept>(
    form: &F,
    plans: &[F::Plan<'_>],
    width: VectorWidth,
    states: &mut [F::State],
    pages: Pages,
) {
    let grain = (GRAIN / plans.len().max(1)).max(1);
    Sweep { form, plans, width, grain }.split(form.blocks(), states, pages);
}

/// Where points are written.
pub(super) enum Pages<'a> {
    /// Only those of the last frame.
    Last(&'a mut [Vec3]),
    /// Those of each frame.
    All(Vec<&'a mut [Vec3]>),
}

impl<'a> Pages<'a> {
    /// Splits each page after its first `points` points.
    fn split(self, points: usize) -> (Self, Self) {
        match self {
            Self::Last(page) => {
                let (near, far) = page.split_at_mut(points);
                (Self::Last(near), Self::Last(far))
            }
            Self::All(pages) => {
                let (near, far) = pages.into_iter().map(|page| page.split_at_mut(points)).unzip();
                (Self::All(near), Self::All(far))
            }
        }
    }

    /// Some points of frame `n` of `count`, if wanted.
    #[inline(always)]
    fn page(&mut self, n: usize, count: usize, points: Range<usize>) -> Option<&mut [Vec3]> {
        match self {
            Self::Last(page) if n + 1 == count => Some(&mut page[points]),
            Self::Last(_) => None,
            Self::All(pages) => Some(&mut pages[n][points]),
        }
    }
}

/// One pass over all blocks, halved between cores until pieces are small.
struct Sweep<'a, 'p, F: Swept> {
    form: &'a F,
    plans: &'a [F::Plan<'p>],
    width: VectorWidth,
    grain: usize,
}

impl<F: Swept> Clone for Sweep<'_, '_, F> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<F: Swept> Copy for Sweep<'_, '_, F> {}

impl<F: Swept> Sweep<'_, '_, F> {
    fn split(self, blocks: &[Block], states: &mut [F::State], pages: Pages) {
        if blocks.len() <= self.grain {
            return self.run(Piece { sweep: self, blocks, states, pages });
        }
        let (near, far) = blocks.split_at(blocks.len() / 2);
        let (near_states, far_states) = states.split_at_mut(near.iter().map(|b| b.segments as usize).sum());
        let (near_pages, far_pages) = pages.split(near.iter().map(Block::point_count).sum());
        rayon::join(|| self.split(near, near_states, near_pages), || self.split(far, far_states, far_pages));
    }

    fn run(self, piece: Piece<F>) {
        self.width.arch().dispatch(piece);
    }
}

/// Some blocks with their states and points, for one core.
struct Piece<'a, 'p, 's, F: Swept> {
    sweep: Sweep<'a, 'p, F>,
    blocks: &'a [Block],
    states: &'s mut [F::State],
    pages: Pages<'s>,
}

impl<F: Swept> NullaryFnOnce for Piece<'_, '_, '_, F> {
    type Output = ();

    #[inline(always)]
    fn call(mut self) {
        let plans = self.sweep.plans;
        let (mut states, mut first_point) = (self.states, 0);
        for block in self.blocks {
            let (mine, others) = states.split_at_mut(block.segments as usize);
            let points = first_point..first_point + block.point_count();
            (states, first_point) = (others, points.end);
            for (n, plan) in plans.iter().enumerate() {
                let page = self.pages.page(n, plans.len(), points.clone());
                self.sweep.form.frame(block, plan, mine, page);
            }
        }
    }
}
