//! The lower quality of previews.

use glam::Vec3;

use crate::raster::TILE;
use crate::skin::{SkinPixel, SkinView};

/// The quality of light in a draft, whose few strands stand for many. Geometry, occlusion and shading of hair and skin
/// are those of the final picture.
///
/// Each strand absorbs as much light as the strands that it stands for, spread over the space between the strands
/// shown. Hair is therefore as deep, and as dark inside, as in the final picture. Cells as wide as that space lose no
/// detail and take a fraction of the time. The light that reaches skin through hair is computed once per 2 x 2 pixels.
/// Nothing that the hair's motion changes is kept between frames, so light does not flicker.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Draft {
    /// Number of strands whose light one strand absorbs (at least 1).
    pub stands_for: f32,
    /// Smallest side of the cells for light from sky and skin (cm); 0.55 in the final picture.
    pub sky_cell: f32,
    /// Smallest side of the cells of a lamp's shadow map of hair (cm); 0.05 in the final picture.
    pub lamp_cell: f32,
}

impl Draft {
    /// Widest cells (cm): in wider ones hair has hardly an inside and an outside.
    const SKY_CELL: f32 = 1.5;
    const LAMP_CELL: f32 = 0.8;
    /// The part of the light of those that it stands for which a strand takes: cells as wide spread hair beyond its surface, which
    /// would lie in its own shadow. Fitted.
    const TAKEN: f32 = 0.6;

    /// The draft for strands that each stand for `share` strands and are drawn `thicker` times as thick as one. Up to a
    /// limit, cells are wider than in the final picture by the ratio of the distances between strands.
    pub fn new(share: f32, thicker: f32) -> Self {
        let apart = share.max(1.0).sqrt();
        Self {
            stands_for: (Self::TAKEN * share / thicker.max(1.0)).max(1.0),
            sky_cell: (0.55 * apart).min(Self::SKY_CELL),
            lamp_cell: (0.05 * apart).min(Self::LAMP_CELL),
        }
    }
}

/// Places on skin that share what reaches them through hair: of a block of 2 x 2 pixels those that lie side by side on one surface.
#[derive(Default)]
pub(crate) struct Shared {
    /// Of each place on skin that is seen, the number of the one that it shares with others.
    pub number: Vec<u32>,
    /// The first place of each.
    pub first: Vec<u32>,
}

/// Farther apart in depth (cm), or turned from each other by more than this cosine, places are not of one surface.
const APART: f32 = 0.5;
const ALIKE: f32 = 0.9;

impl Shared {
    /// Of all places of a view, tile by tile.
    pub fn of(skin: &SkinView, tiles: usize) -> Self {
        let mut shared = Self::default();
        for tile in 0..tiles {
            // Of each block the last that was begun.
            let mut blocks = [None::<u32>; TILE * TILE / 4];
            for i in skin.tile(tile) {
                let place = &skin.pixels[i];
                let (x, y) = (usize::from(place.pixel) % TILE, usize::from(place.pixel) / TILE);
                let block = &mut blocks[y / 2 * (TILE / 2) + x / 2];
                let number = block.filter(|&n| one_surface(&skin.pixels[shared.first[n as usize] as usize], place));
                let number = number.unwrap_or_else(|| {
                    shared.first.push(i as u32);
                    shared.first.len() as u32 - 1
                });
                *block = Some(number);
                shared.number.push(number);
            }
        }
        shared
    }
}

fn one_surface(a: &SkinPixel, b: &SkinPixel) -> bool {
    a.solid == b.solid && (a.depth - b.depth).abs() < APART && Vec3::dot(a.normal, b.normal) > ALIKE
}
