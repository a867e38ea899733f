//! What there is to do in each strip of a map, in the order of the nodes.

use std::ops::Range;

use super::Scene;
use super::edges::Edges;
use super::item::Item;
use super::map::Map;
use crate::light::headlight::SolidShadows;

/// What some nodes or places ask for and lay down in a strip, each with the slab that it lies in.
#[derive(Default)]
pub struct List {
    pub items: Vec<Item>,
    pub slabs: Vec<u16>,
}

impl List {
    #[inline(always)]
    fn push(&mut self, item: Item, slab: u16) {
        self.items.push(item);
        self.slabs.push(slab);
    }
}

/// A list for each strip of a map.
pub struct Lists<'a> {
    pub map: &'a Map,
    pub edges: &'a Edges,
    pub lists: &'a mut [List],
}

impl Lists<'_> {
    pub fn clear(&mut self) {
        for list in &mut *self.lists {
            list.items.clear();
            list.slabs.clear();
        }
    }

    /// Lists what some nodes read, and the parts of the pieces that begin at them.
    pub fn add_hair(&mut self, scene: &Scene, solids: Option<&SolidShadows>, nodes: Range<usize>) {
        let map = self.map;
        let seen = |i: usize| {
            let p = scene.nodes[i].position;
            (map.project(p), solids.is_some_and(|solids| solids.is_dark(p)))
        };
        let mut next = None;
        for i in nodes {
            let (here, in_the_dark) = next.take().unwrap_or_else(|| seen(i));
            if scene.asked[i] && !in_the_dark {
                self.add_reader(Item::reads(here, i), here.z);
            }
            if scene.nodes.get(i + 1).is_none_or(|next| next.strand != scene.nodes[i].strand) {
                continue;
            }
            let (there, to_the_dark) = *next.insert(seen(i + 1));
            if !(in_the_dark && to_the_dark) {
                map.cut(here, there, scene.thickness(i), |item, distance| self.add_part(item, distance));
            }
        }
    }

    /// Lists the receivers that are places on the skin.
    pub fn add_skin(&mut self, scene: &Scene, receivers: Range<usize>) {
        for i in receivers {
            let place = &scene.skin[i - scene.nodes.len()];
            if place.normal.dot(self.map.toward) > scene.least_facing {
                let at = self.map.project(place.at);
                self.add_reader(Item::reads(at, i), at.z);
            }
        }
    }

    #[inline(always)]
    fn add_reader(&mut self, item: Item, distance: f32) {
        if let Some(strip) = self.edges.strip_of(item.at[1]) {
            self.lists[strip].push(item, self.map.slab(distance));
        }
    }

    /// What reaches over an edge is in the lists of both sides.
    #[inline(always)]
    fn add_part(&mut self, item: Item, distance: f32) {
        let slab = self.map.slab(distance);
        for strip in self.edges.strips_about(item.at[1], item.half_height()) {
            self.lists[strip].push(item, slab);
        }
    }
}
