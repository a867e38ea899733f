//! Skin that is lit once, and looked at from several places close to one another.

use glam::Vec3;

use super::{SkinPixel, SkinView};
use crate::camera::View;
use crate::raster::TILE;

/// Light that skin sends toward the eye, by where it is.
pub struct LitSkin<'a> {
    view: View,
    pixels: &'a [SkinPixel],
    light: Vec<[f32; 3]>,
    /// The pieces in each pixel of the view.
    pieces: Vec<[u32; 2]>,
    /// The mean of each solid, for what the view sees nothing of.
    means: Vec<[f32; 3]>,
    /// How far from where it should be (pixels) a lit place is looked for.
    reach: i32,
}

const NONE: u32 = u32::MAX;
/// Where within a pixel its surface is lit, if it covers all of it (pixels).
const LIT_AT: f32 = 0.375;
/// Places so far apart (cm, and pixels) are not the same surface.
const APART: f32 = 0.3;
const APART_PIXELS: f32 = 1.5;

impl<'a> LitSkin<'a> {
    /// Of a view that stands still, with the light of each of its pieces of skin. `beside`: by how many pixels what lies behind moves
    /// against what is before it.
    pub fn new(skin: &'a SkinView, view: View, light: Vec<[f32; 3]>, beside: f32) -> Self {
        let [width, height] = view.size.map(|s| s as usize);
        let across = width.div_ceil(TILE);
        let mut pieces = vec![[NONE; 2]; width * height];
        for tile in 0..across * height.div_ceil(TILE) {
            for i in skin.tile(tile) {
                let pixel = usize::from(skin.pixels[i].pixel);
                let (x, y) = (tile % across * TILE + pixel % TILE, tile / across * TILE + pixel / TILE);
                if x < width && y < height {
                    let slot = &mut pieces[y * width + x];
                    slot[usize::from(slot[0] != NONE)] = i as u32;
                }
            }
        }
        let solids = skin.pixels.iter().map(|p| usize::from(p.solid) + 1).max().unwrap_or(0);
        let mut sums = vec![[0.0_f64; 4]; solids];
        for (place, light) in skin.pixels.iter().zip(&light) {
            let sum = &mut sums[usize::from(place.solid)];
            (0..3).for_each(|c| sum[c] += f64::from(light[c]));
            sum[3] += 1.0;
        }
        let means = sums.into_iter().map(|s| [0, 1, 2].map(|c| (s[c] / s[3].max(1.0)) as f32)).collect();
        Self { view, pixels: &skin.pixels, light, pieces, means, reach: beside.ceil() as i32 + 2 }
    }

    /// The light of a place on a solid (head space, cm): between the four pixels about it, or of the nearest that the view sees.
    pub fn at(&self, solid: u16, position: Vec3) -> [f32; 3] {
        let p = self.view.project(position);
        let [x, y] = [p.x, p.y].map(|c| c - LIT_AT);
        let (left, top) = (x.floor(), y.floor());
        let (right, bottom) = (x - left, y - top);
        let apart = APART + APART_PIXELS / self.view.pixels_per_cm(p.z);
        let mut sum = [0.0; 4];
        for (dx, dy, weight) in [
            (0, 0, (1.0 - right) * (1.0 - bottom)),
            (1, 0, right * (1.0 - bottom)),
            (0, 1, (1.0 - right) * bottom),
            (1, 1, right * bottom),
        ] {
            if let Some((i, off)) = self.nearest(left as i32 + dx, top as i32 + dy, solid, position)
                && off < apart * apart
            {
                let light = self.light[i];
                sum = [
                    sum[0] + weight * light[0],
                    sum[1] + weight * light[1],
                    sum[2] + weight * light[2],
                    sum[3] + weight,
                ];
            }
        }
        if sum[3] > 1e-3 {
            return [0, 1, 2].map(|c| sum[c] / sum[3]);
        }
        self.nearest_about(left as i32, top as i32, solid, position)
    }

    /// The piece of a solid in a pixel that lies nearest to a place, and how far off it is (cm, squared).
    fn nearest(&self, x: i32, y: i32, solid: u16, position: Vec3) -> Option<(usize, f32)> {
        let [width, height] = self.view.size.map(|s| s as i32);
        if !(0..width).contains(&x) || !(0..height).contains(&y) {
            return None;
        }
        let of = |&i: &u32| (i as usize, self.pixels[i as usize].position.distance_squared(position));
        self.pieces[y as usize * width as usize + x as usize]
            .iter()
            .filter(|&&i| i != NONE && self.pixels[i as usize].solid == solid)
            .map(of)
            .min_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// The light of the nearest place, in squares about a pixel, each larger than the one before, until one has any and the next none
    /// nearer.
    fn nearest_about(&self, x: i32, y: i32, solid: u16, position: Vec3) -> [f32; 3] {
        let mut best: Option<(usize, f32)> = None;
        for ring in 0..=self.reach {
            let found = (-ring..=ring)
                .flat_map(|d| [(d, -ring), (d, ring), (-ring, d), (ring, d)])
                .filter_map(|(dx, dy)| self.nearest(x + dx, y + dy, solid, position))
                .min_by(|a, b| a.1.total_cmp(&b.1));
            let nearer = found.filter(|found| best.is_none_or(|best| found.1 < best.1));
            if best.is_some() && nearer.is_none() {
                break;
            }
            best = nearer.or(best);
        }
        let mean = || self.means.get(usize::from(solid)).copied().unwrap_or_default();
        best.map_or_else(mean, |(i, _)| self.light[i])
    }
}
