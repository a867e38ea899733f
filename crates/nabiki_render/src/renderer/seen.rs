//! Nodes of the hair as a picture sees them.

use glam::Vec3;

use crate::camera::NEAR;
use crate::curve::Curves;
use crate::focus::Spread;
use crate::raster::{Node, TILE};
use crate::shutter::Shot;
use crate::skin::SkinView;

/// What a shot sees of the hair.
pub(super) struct Seen<'a> {
    pub curves: &'a Curves,
    /// Half of the hair's thickness at each node (cm).
    pub radius: &'a [f32],
    pub shot: &'a Shot,
    pub skin: &'a SkinView,
    pub spread: Spread,
}

impl Seen<'_> {
    /// A node without its light.
    #[inline]
    pub fn node(&self, i: usize) -> Node {
        let (view, nodes) = (&self.shot.middle, &self.curves.nodes);
        let n = &nodes[i];
        let p = view.project(n.position);
        if p.z < NEAR {
            return Node { strand: n.strand, ..Node::default() };
        }
        let eye = view.toward_lens(n.position);
        let seen = n.tangent - eye * eye.dot(n.tangent);
        let across = [seen.dot(view.right), -seen.dot(view.up)];
        let length = (across[0] * across[0] + across[1] * across[1]).sqrt();
        let motion = self.curves.velocities.get(i).map_or(Vec3::ZERO, |&v| self.shot.motion(n.position, v));
        let hidden = self.behind_skin(p)
            && (motion == Vec3::ZERO || self.behind_skin(p - 0.5 * motion) && self.behind_skin(p + 0.5 * motion));
        Node {
            at: [p.x, p.y],
            depth: p.z,
            radius: self.radius[i] * view.pixels_per_cm(p.z),
            light: [0.0; 3],
            direction: if length > 1e-6 { across.map(|c| c / length) } else { [0.0; 2] },
            motion: [motion.x, motion.y],
            recession: motion.z,
            strand: n.strand,
            drawable: true,
            end: i == 0 || nodes[i - 1].strand != n.strand || nodes.get(i + 1).is_none_or(|o| o.strand != n.strand),
            hidden,
        }
    }

    /// Whether a place on the picture, as far as a lens spreads it, lies behind head or bodies.
    #[inline]
    fn behind_skin(&self, p: Vec3) -> bool {
        let size = self.shot.middle.size;
        let [width, height] = size.map(|s| s as f32);
        let spread = self.spread.at(p.z);
        let (left, top, right, bottom) = (p.x - spread, p.y - spread, p.x + spread, p.y + spread);
        if left < 0.0 || top < 0.0 || right >= width || bottom >= height {
            return false;
        }
        let across = (size[0] as usize).div_ceil(TILE);
        let tile = |at: f32| at as usize / TILE;
        (tile(top)..=tile(bottom))
            .all(|y| (tile(left)..=tile(right)).all(|x| p.z > self.skin.hidden_beyond[y * across + x] + 0.5))
    }
}
