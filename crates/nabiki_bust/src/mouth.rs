//! The lips.

use glam::Vec3;
use nabiki_groom::face;

use crate::shapes::{ridge, swell};

/// Raises the lips out of the face and parts them with a line.
pub(crate) fn add(p: Vec3, skin: f32) -> f32 {
    if p.x < 5.0 || p.y > -4.0 || p.y < -11.0 {
        return skin;
    }
    let mut skin = skin;
    // Groove between nose and lip, a soft edge on either side.
    let along = ridge(p.y + 6.0, 0.85);
    skin += along * (0.11 * ridge(p.z, 0.5) - 0.05 * ridge(p.z - 0.62, 0.4));
    // The corners are drawn in, and the cheek begins with a little fullness beside them.
    skin += 0.075 * swell(p, Vec3::new(8.1, -7.13, 2.95), Vec3::new(1.6, 1.1, 1.15));
    skin -= 0.03 * swell(p, Vec3::new(7.8, -7.2, 3.9), Vec3::new(1.8, 1.5, 1.0));
    skin - lips(p)
}

/// By how much the lips stand out.
fn lips(p: Vec3) -> f32 {
    let t = face::along_lips(p.z);
    if t >= 1.15 {
        return 0.0;
    }
    let [upper, lower] = face::lip_edges(p.z, t);
    let parting = face::lip_parting(p.z, t);
    let left = (1.0 - t * t).max(0.0);
    let ends = left * left.sqrt();
    let above = p.y - parting;
    let out =
        if above > 0.0 { UPPER.stands_out(above, upper - parting) } else { LOWER.stands_out(-above, parting - lower) };
    // The line on which they rest on one another is narrow and goes to the corners.
    ends * out - 0.1 * ridge(above, 0.15) * (2.4 * (1.02 - t)).clamp(0.0, 1.0)
}

/// A lip in profile.
struct Lip {
    /// How far it stands out (cm) where it is fullest.
    fullness: f32,
    /// By how much less where it rests on the other.
    rolled_in: f32,
    /// Where it is fullest, of the way from there to its edge.
    fullest: f32,
    /// How far beyond its edge (cm) it has gone over into the skin.
    skirt: f32,
}

/// The skin above the upper lip comes forward with it; the lower one curls out of a hollow.
const UPPER: Lip = Lip { fullness: 0.3, rolled_in: 0.14, fullest: 0.7, skirt: 1.1 };
const LOWER: Lip = Lip { fullness: 0.37, rolled_in: 0.18, fullest: 0.45, skirt: 0.7 };

impl Lip {
    /// By how much it stands out so far from the line between the lips, where it is so high.
    fn stands_out(&self, off: f32, height: f32) -> f32 {
        let full = self.fullest * height.max(0.05);
        if off < full {
            let v = 1.0 - off / full;
            return self.fullness - self.rolled_in * v * v;
        }
        let v = ((off - full) / (height + self.skirt - full)).min(1.0);
        self.fullness * (1.0 - v * v * (3.0 - 2.0 * v))
    }
}
