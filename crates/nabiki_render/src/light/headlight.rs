//! The head in the way of a lamp: its outline and depth as the lamp sees it.

use glam::Vec3;
use nabiki::Mesh;

use super::lamps::Lamp;

/// Side of a cell (cm) of a head's map, unless the mesh is so large that this would make too many.
const CELL: f32 = 0.12;
const MOST_CELLS: f32 = 1500.0;

/// Distances of the head from a lamp.
pub struct HeadShadow {
    toward: Vec3,
    axes: [Vec3; 2],
    low: [f32; 2],
    cell: f32,
    size: [usize; 2],
    /// Nearest distance in each cell (cm), infinite where the head is not.
    distance: Vec<f32>,
    /// Depth over which a shadow sets in (cm).
    soft: f32,
    /// Cells on each side that are averaged.
    blur: i32,
}

impl HeadShadow {
    /// Draws the head as the lamp sees it.
    pub fn new(lamp: &Lamp, head: &Mesh) -> Self {
        let right = lamp.toward.any_orthonormal_vector();
        let axes = [right, lamp.toward.cross(right)];
        let seen: Vec<[f32; 3]> =
            head.positions.iter().map(|p| [p.dot(axes[0]), p.dot(axes[1]), -p.dot(lamp.toward)]).collect();
        let limit = |i: usize, f: fn(f32, f32) -> f32, from: f32| seen.iter().map(|p| p[i]).fold(from, f);
        let low = [0, 1].map(|i| limit(i, f32::min, f32::INFINITY));
        let high = [0, 1].map(|i| limit(i, f32::max, f32::NEG_INFINITY));
        let extent = (high[0] - low[0]).max(high[1] - low[1]).max(0.0);
        let cell = CELL.max(extent / MOST_CELLS);
        let size = if seen.is_empty() { [0, 0] } else { [0, 1].map(|i| ((high[i] - low[i]) / cell) as usize + 2) };
        let mut distance = vec![f32::INFINITY; size[0] * size[1]];
        for triangle in &head.triangles {
            let corners = triangle.map(|v| {
                let p = seen[v as usize];
                [(p[0] - low[0]) / cell, (p[1] - low[1]) / cell, p[2]]
            });
            draw(corners, size, &mut distance);
        }
        let blur = (0.5 + 2.5 * lamp.spread.tan() / cell).clamp(1.0, 6.0) as i32;
        let soft = 0.25 + 1.2 * cell * blur as f32;
        Self { toward: lamp.toward, axes, low, cell, size, distance, soft, blur }
    }

    /// Part of the lamp that the head leaves visible from a place on a hair, 0..1: with a narrow border.
    #[inline]
    pub fn visible_from_hair(&self, p: Vec3) -> f32 {
        let (base, part, distance) = self.place(p);
        let upper =
            self.lit(base[0], base[1], distance) * (1.0 - part[0]) + self.lit(base[0] + 1, base[1], distance) * part[0];
        let lower = self.lit(base[0], base[1] + 1, distance) * (1.0 - part[0])
            + self.lit(base[0] + 1, base[1] + 1, distance) * part[0];
        upper + (lower - upper) * part[1]
    }

    /// Part of the lamp that the head leaves visible from a place on the skin, 0..1: as soft as the lamp is wide.
    pub fn visible_from_skin(&self, p: Vec3) -> f32 {
        let (base, part, distance) = self.place(p);
        let (mut lit, mut all) = (0.0, 0.0);
        let reach = self.blur;
        for dy in -reach..=reach + 1 {
            for dx in -reach..=reach + 1 {
                // A box that slides smoothly over the cells.
                let weight = edge(dx, part[0], reach) * edge(dy, part[1], reach);
                all += weight;
                lit += weight * self.lit(base[0] + dx, base[1] + dy, distance);
            }
        }
        lit / all
    }

    /// Cell, place within it and distance from the lamp.
    #[inline]
    fn place(&self, p: Vec3) -> ([i32; 2], [f32; 2], f32) {
        let place = [0, 1].map(|i| (p.dot(self.axes[i]) - self.low[i]) / self.cell);
        let base = place.map(f32::floor);
        (base.map(|b| b as i32), [place[0] - base[0], place[1] - base[1]], -p.dot(self.toward))
    }

    #[inline]
    fn lit(&self, x: i32, y: i32, distance: f32) -> f32 {
        if x < 0 || y < 0 || x as usize >= self.size[0] || y as usize >= self.size[1] {
            return 1.0;
        }
        let behind = distance - self.distance[y as usize * self.size[0] + x as usize];
        // Skin does not shade itself: the shadow sets in some way behind the surface.
        1.0 - ((behind - self.soft) / self.soft).clamp(0.0, 1.0)
    }
}

fn edge(d: i32, part: f32, reach: i32) -> f32 {
    if d == -reach {
        1.0 - part
    } else if d == reach + 1 {
        part
    } else {
        1.0
    }
}

/// Keeps the nearest distance of a triangle in the cells it covers.
fn draw([a, b, c]: [[f32; 3]; 3], size: [usize; 2], distance: &mut [f32]) {
    let area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    if area == 0.0 || !area.is_finite() {
        return;
    }
    let span = |i: usize| {
        let low = a[i].min(b[i]).min(c[i]).max(0.0) as usize;
        let high = a[i].max(b[i]).max(c[i]).max(0.0) as usize + 1;
        low..high.min(size[i])
    };
    for y in span(1) {
        for x in span(0) {
            let p = [x as f32, y as f32];
            let side = |q: [f32; 3], r: [f32; 3]| (r[0] - q[0]) * (p[1] - q[1]) - (r[1] - q[1]) * (p[0] - q[0]);
            let (u, v, w) = (side(b, c) / area, side(c, a) / area, side(a, b) / area);
            if u >= 0.0 && v >= 0.0 && w >= 0.0 {
                let here = &mut distance[y * size[0] + x];
                *here = here.min(u * a[2] + v * b[2] + w * c[2]);
            }
        }
    }
}
