//! From lit nodes to the frame's pixels, tile by tile.

use rayon::prelude::*;

use super::Renderer;
use super::blocks::blocks_of_tiles;
use crate::backdrop::Backdrop;
use crate::camera::View;
use crate::curve::Curves;
use crate::frame::{Frame, Layer, NO_DEPTH};
use crate::light::sky::OnSkin;
use crate::raster::bins::{Bins, Row};
use crate::raster::coverage::{CoverageTile, Watch};
use crate::raster::oversample::OversampledTile;
use crate::raster::{Node, TILE};
use crate::shutter::Shot;
use crate::skin::{SkinLight, SkinPixel, SkinView};

/// What a frame is drawn from: hair and skin as one shot sees them.
pub(super) struct Drawing<'a> {
    pub shot: &'a Shot,
    pub nodes: &'a [Node],
    pub bins: &'a Bins,
    pub skin: &'a SkinView,
}

/// Light from a place on the skin, by its number; none from a head that is not drawn.
pub(super) trait LightOnSkin: Fn(usize, &SkinPixel, Option<&mut OnSkin>) -> Option<[f32; 3]> + Sync {}

impl<F: Fn(usize, &SkinPixel, Option<&mut OnSkin>) -> Option<[f32; 3]> + Sync> LightOnSkin for F {}

impl Renderer {
    pub(super) fn compose<const LAYERS: bool>(
        &self,
        seen: &Drawing,
        backdrop: &Backdrop,
        on_skin: impl LightOnSkin,
    ) -> Frame {
        let Drawing { shot, nodes, bins, skin } = *seen;
        let view = &shot.middle;
        let mut frame = empty(view, LAYERS);
        let blocks = blocks_of_tiles(&mut frame);
        let recession = if self.curves.velocities.is_empty() {
            0.0
        } else {
            nodes.par_iter().map(|n| n.recession.abs()).reduce(|| 0.0, f32::max)
        };
        let work = || (CoverageTile::new(recession), Row::default(), self.occluded_sky().map(OnSkin::new));
        blocks.into_par_iter().for_each_init(work, |(work, hair, sky), mut out| {
            let row = out.row;
            bins.row(row, &out.columns, nodes, true, hair);
            for column in out.columns.clone() {
                let tile = row * bins.tiles[0] + column;
                let pieces = hair.tile(column);
                let range = skin.tile(tile);
                let pixels = &skin.pixels[range.clone()];
                if pixels.is_empty() && hair.is_empty(column) {
                    out.put(column, |_, y| (backdrop.behind([0.0; 4], row * TILE + y), NO_DEPTH, None));
                    continue;
                }
                let light = |i: usize| on_skin(range.start + i, &pixels[i], sky.as_mut());
                let skin = (pixels, light);
                let mut watch = LayerWatch {
                    curves: &self.curves,
                    nodes,
                    skin: pixels,
                    shot,
                    layers: vec![Layer::default(); if LAYERS { TILE * TILE } else { 0 }],
                };
                if LAYERS {
                    work.draw([column, row], pieces, skin, &mut watch);
                } else {
                    work.draw([column, row], pieces, skin, &mut ());
                }
                out.put(column, |i, y| {
                    let drawn = work.drawn(i);
                    let layer = watch.layers.get(i).copied();
                    (backdrop.behind(drawn.light, row * TILE + y), drawn.depth, layer)
                });
            }
        });
        frame
    }

    pub(super) fn oversample(&self, seen: &Drawing, backdrop: &Backdrop, on_skin: impl LightOnSkin) -> Frame {
        let Drawing { shot, nodes, bins, skin } = *seen;
        let view = &shot.middle;
        let mut frame = empty(view, false);
        let samples = self.picture.samples as usize;
        let blocks = blocks_of_tiles(&mut frame);
        blocks.into_par_iter().for_each_init(
            || (OversampledTile::new(samples), Row::default(), self.occluded_sky().map(OnSkin::new)),
            |(work, hair, sky), mut out| {
                let row = out.row;
                bins.row(row, &out.columns, nodes, false, hair);
                for column in out.columns.clone() {
                    let tile = row * bins.tiles[0] + column;
                    let range = skin.tile(tile);
                    let pixels = &skin.pixels[range.clone()];
                    let light: Vec<_> = range.zip(pixels).map(|(i, p)| on_skin(i, p, sky.as_mut())).collect();
                    work.draw([column, row], hair.tile(column).map(|(piece, _)| piece), (pixels, &light));
                    out.put(column, |i, y| {
                        let (light, depth) = work.pixel(i);
                        (backdrop.behind(light, row * TILE + y), depth, None)
                    });
                }
            },
        );
        frame
    }

    /// Light from place `i` on the skin; none from a head that is not drawn.
    pub(super) fn skin_light_of(
        &self,
        light: &SkinLight,
        i: usize,
        place: &SkinPixel,
        sky: Option<&mut OnSkin>,
    ) -> Option<[f32; 3]> {
        self.shows(place.solid).then(|| light.at(i, place, sky))
    }

    /// Whether a solid is drawn, and does not only hide.
    pub(super) fn shows(&self, solid: u16) -> bool {
        solid > 0 || self.picture.head.visible
    }
}

/// A frame of nothing, with room for layers or without.
pub(super) fn empty(view: &View, layers: bool) -> Frame {
    let pixels = view.size[0] as usize * view.size[1] as usize;
    Frame {
        size: view.size,
        rgba: filled([0.0; 4], pixels),
        depth: filled(NO_DEPTH, pixels),
        layers: filled(Layer::default(), if layers { pixels } else { 0 }),
    }
}

/// So many times the same: by all cores, since it is much memory that nobody has touched yet.
fn filled<T: Clone + Send + Sync>(value: T, count: usize) -> Vec<T> {
    rayon::iter::repeat_n(value, count).with_min_len(65_536).collect()
}

/// Gathers the layers of one tile.
struct LayerWatch<'a> {
    curves: &'a Curves,
    nodes: &'a [Node],
    skin: &'a [SkinPixel],
    shot: &'a Shot,
    layers: Vec<Layer>,
}

impl Watch for LayerWatch<'_> {
    #[inline(always)]
    fn hair(&mut self, pixel: usize, share: f32, along: f32, piece: u32) {
        let i = piece as usize;
        let direction = self.curves.nodes[i].tangent.lerp(self.curves.nodes[i + 1].tangent, along);
        let layer = &mut self.layers[pixel];
        for c in 0..3 {
            layer.direction[c] += share * direction[c];
        }
        for c in 0..2 {
            let (a, b) = (self.nodes[i].motion[c], self.nodes[i + 1].motion[c]);
            layer.motion[c] += share * (a + (b - a) * along);
        }
        layer.hair += share;
    }

    #[inline(always)]
    fn full(&mut self, pixel: usize, whole: f32) {
        let layer = &mut self.layers[pixel];
        layer.direction = layer.direction.map(|c| c * whole);
        layer.motion = layer.motion.map(|c| c * whole);
        layer.hair *= whole;
    }

    #[inline(always)]
    fn skin(&mut self, pixel: usize, share: f32, piece: usize) {
        let SkinPixel { solid, position, .. } = self.skin[piece];
        let motion = self.shot.motion_of_solid(solid, position);
        let layer = &mut self.layers[pixel];
        for c in 0..2 {
            layer.motion[c] += share * motion[c];
        }
        layer.head += share;
    }
}
