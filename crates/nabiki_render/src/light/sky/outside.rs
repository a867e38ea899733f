//! Skin outside the box of cells about the hair, such as the shoulders': it keeps the sky from the hair, and sends light to it.
//!
//! Along each lattice direction the skin is followed to where its light comes into the box. What is found there is what a box about hair
//! and skin would have, with none of the cells between.

use glam::{IVec3, UVec3};
use rayon::prelude::*;

use super::directions::{Direction, LENGTHS};
use super::skin_cells::SkinCell;
use crate::light::approx::exp_of_negative;

/// What skin outside does along each lattice direction.
#[derive(Default)]
pub struct Outside {
    /// The farthest first of those that come into the box in the same cell.
    entering: Vec<Vec<Entering>>,
}

/// Skin that a lattice direction leads into the box.
#[derive(Clone, Copy)]
struct Entering {
    /// The cell of the box, by its number, and how many steps it is from there to the skin.
    cell: u32,
    steps: i32,
    skin: u32,
    /// What the skin leaves of light that goes on from it.
    through: f32,
    /// Whether the skin faces that way.
    sends: bool,
}

impl Outside {
    /// Finds where light that comes along the directions from skin, by number and cell (from the first cell of the box on), comes into a box
    /// of this size. Skin in the box does not count.
    pub fn lay_out(&mut self, skin: &[(u32, IVec3, SkinCell)], directions: &[Direction], size: UVec3) {
        self.entering.resize_with(directions.len(), Vec::new);
        self.entering.par_iter_mut().zip(directions).for_each(|(entering, direction)| {
            entering.clear();
            let step = IVec3::from(direction.step);
            let length = LENGTHS[direction.length_index()];
            entering.extend(skin.iter().filter_map(|&(skin, from, SkinCell { depth, normal, .. })| {
                let steps = steps_into(from, step, size)?;
                let c = (from + steps * step).as_uvec3();
                Some(Entering {
                    cell: c.x + size.x * (c.y + size.y * c.z),
                    steps,
                    skin,
                    through: exp_of_negative(-depth * length),
                    sends: direction.leaves(normal),
                })
            }));
            entering.sort_unstable_by_key(|e| (e.cell, -e.steps, e.skin));
        });
    }

    /// The skin that sends light into the box, by number; some of it more than once.
    pub fn senders(&self) -> impl Iterator<Item = u32> {
        self.entering.iter().flatten().filter(|e| e.sends).map(|e| e.skin)
    }

    /// Has what comes into the box along direction `n` lose what the skin takes.
    pub fn take(&self, n: usize, light: &mut [f32]) {
        self.entering[n].iter().for_each(|e| light[e.cell as usize] *= e.through);
    }

    /// Adds what skin sends into the box along direction `n`; `lit` is the light that falls onto it, by number.
    pub fn send(&self, n: usize, lit: &[f32], glow: &mut [f32]) {
        for e in &self.entering[n] {
            let glow = &mut glow[e.cell as usize];
            // As within the box, it starts in the skin's own cell and in the next.
            let sent = if e.sends { lit[e.skin as usize] * (1.0 - e.through) } else { 0.0 };
            *glow = (*glow + sent) * e.through + sent;
        }
    }
}

/// In how many steps one is in a box of this size, from a cell outside it.
fn steps_into(from: IVec3, step: IVec3, size: UVec3) -> Option<i32> {
    let (mut least, mut most) = (1, i32::MAX);
    for axis in 0..3 {
        let (from, last) = (from[axis], size[axis] as i32 - 1);
        match step[axis] {
            0 if from < 0 || from > last => return None,
            0 => {}
            1 => (least, most) = (least.max(-from), most.min(last - from)),
            _ => (least, most) = (least.max(from - last), most.min(from)),
        }
    }
    (least <= most).then_some(least)
}

#[cfg(test)]
mod tests {
    use glam::Vec3;
    use nabiki::Mesh;

    use super::super::tests::square;
    use super::super::{AT_ONCE, SkyMap};
    use super::SkinCell;
    use crate::camera::{Bounds, View};
    use crate::curve::{CurveNode, bounds};
    use crate::light::lamps::Lamp;
    use crate::settings::Camera;

    /// What arrives at hair is the same whether the box is about the hair alone or about the skin as well.
    #[test]
    fn what_arrives_does_not_depend_on_where_the_box_ends() {
        let nodes: Vec<CurveNode> = (0..400_u32)
            .map(|i| {
                let (strand, k) = (i / 8, (i % 8) as f32);
                let position = Vec3::new((strand % 7) as f32 - 3.0, 0.7 * k - 2.0, 0.8 * (strand / 7) as f32 - 2.5);
                CurveNode { position, strand, ..CurveNode::default() }
            })
            .collect();
        // Aslant below, behind it another, one beside the hair that reaches into the box, and one above that faces away.
        let mut head = square(Vec3::new(1.0, -9.0, 0.0), Vec3::new(0.0, 1.0, 6.0), Vec3::new(6.0, 2.0, 0.0));
        for other in [
            square(Vec3::new(2.0, -12.0, 1.0), 7.0 * Vec3::Z, 7.0 * Vec3::X),
            square(Vec3::new(-5.0, 0.0, 0.0), 9.0 * Vec3::Y, 4.0 * Vec3::Z),
            square(Vec3::new(0.0, 8.0, 0.0), 2.0 * Vec3::Z, 2.0 * Vec3::X),
        ] {
            let first = head.positions.len() as u32;
            head.positions.extend(other.positions);
            head.triangles.extend(other.triangles.iter().map(|t| t.map(|v| first + v)));
        }
        let body = square(Vec3::new(9.0, 1.0, 0.5), 4.0 * Vec3::Z, 5.0 * Vec3::Y);
        let about_all = nodes.iter().map(|node| node.position).chain(head.positions.iter().copied());
        let about_all =
            about_all.fold([Vec3::INFINITY, Vec3::NEG_INFINITY], |[low, high], p| [low.min(p), high.max(p)]);
        let lamps = [Lamp { toward: Vec3::new(0.6, 0.8, 0.0), strength: [1.0; 3], spread: 0.0 }];
        let view = View::new(&Camera { azimuth: 30.0, ..Camera::default() }, [64, 64], &Bounds::default());
        let found = |about: [Vec3; 2], head: &Mesh, bodies: &[Mesh]| {
            let mut sky = SkyMap::default();
            sky.lay_out(about, 0.0, (head, bodies), Vec3::Y, rayon::iter::empty());
            sky.fill(&nodes, &vec![0.05; nodes.len()]);
            let lit = |skin: &SkinCell| 1.0 + 0.1 * skin.place.x;
            sky.gather((&nodes, &vec![true; nodes.len()]), &view, &lamps, |_, _, skin| lit(skin));
            let of = |node: &CurveNode| {
                sky.at(&sky.places(&node.position.to_array().map(|c| [c])), 0).map(|number| number[0])
            };
            nodes.iter().map(of).collect::<Vec<[f32; AT_ONCE]>>()
        };
        let (about_hair, bodies) = (bounds(&nodes), [body]);
        let (alone, with_skin) = (found(about_hair, &head, &bodies), found(about_all, &head, &bodies));
        let open = found(about_hair, &Mesh::default(), &[]);
        let (mut furthest, mut shaded) = (0.0_f32, 0.0_f32);
        for ((alone, with_skin), open) in alone.iter().zip(&with_skin).zip(&open) {
            for n in 0..AT_ONCE {
                furthest = furthest.max((alone[n] - with_skin[n]).abs());
                shaded = shaded.max((alone[n] - open[n]).abs());
            }
        }
        // A dozen roundings of sums of fourteen numbers; and the skin does something.
        assert!(furthest < 1e-5 && shaded > 0.1, "{furthest}, {shaded}");
    }
}
