//! The head in the way of a lamp: its outline and depth as the lamp sees it, blurred once as the lamp is wide.

use glam::Vec3;
use nabiki::Mesh;

use super::lamps::Lamp;

/// Side of a cell (cm), unless the head is so large that this would make too many.
const CELL: f32 = 0.15;
const MOST_CELLS: f32 = 1500.0;
/// How far behind the head's surface (cm) its shadow begins, and over which depth it sets in.
const SOFT: f32 = 0.45;
/// Least blur (cm).
const BLUR: f32 = 0.4;

/// What a lamp sees of the head.
pub struct HeadShadow {
    toward: Vec3,
    axes: [Vec3; 2],
    low: [f32; 2],
    cell: f32,
    /// Radius of the blur (cm).
    blur: f32,
    size: [usize; 2],
    /// In each cell: the part of its surroundings that the head covers, and the head's mean distance there (cm).
    cells: Vec<[f32; 2]>,
}

impl HeadShadow {
    /// Draws the head as the lamp sees it.
    pub fn new(lamp: &Lamp, head: &Mesh) -> Self {
        let right = lamp.toward.any_orthonormal_vector();
        let axes = [right, lamp.toward.cross(right)];
        let seen: Vec<[f32; 3]> =
            head.positions.iter().map(|p| [p.dot(axes[0]), p.dot(axes[1]), -p.dot(lamp.toward)]).collect();
        let blur = BLUR.max(2.5 * lamp.spread.tan());
        let limit = |i: usize, f: fn(f32, f32) -> f32, from: f32| seen.iter().map(|p| p[i]).fold(from, f);
        let low = [0, 1].map(|i| limit(i, f32::min, f32::INFINITY) - 2.0 * blur);
        let high = [0, 1].map(|i| limit(i, f32::max, f32::NEG_INFINITY) + 2.0 * blur);
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
        // Covered part and distance times covered part: both can be averaged.
        let mut cells: Vec<[f32; 2]> =
            distance.iter().map(|&d| if d < f32::INFINITY { [1.0, d] } else { [0.0; 2] }).collect();
        let radius = (blur / cell).round() as usize;
        for _ in 0..2 {
            for axis in 0..2 {
                cells = blurred(&cells, size, axis, radius);
            }
        }
        for c in &mut cells {
            c[1] /= c[0].max(1e-6);
        }
        Self { toward: lamp.toward, axes, low, cell, blur, size, cells }
    }

    /// Part of the lamp that the head leaves visible from a place on its own skin with this unit normal, 0..1: skin aslant to the
    /// lamp is not taken to lie behind its own blurred surroundings.
    pub fn visible_from_skin(&self, p: Vec3, normal: Vec3) -> f32 {
        let facing = normal.dot(self.toward).clamp(0.1, 1.0);
        let steep = (1.0 - facing * facing).sqrt() / facing;
        self.visible(p + self.toward * (self.blur * steep))
    }

    /// Part of the lamp that the head leaves visible from a place, 0..1.
    #[inline]
    pub fn visible(&self, p: Vec3) -> f32 {
        let x = (p.dot(self.axes[0]) - self.low[0]) / self.cell;
        let y = (p.dot(self.axes[1]) - self.low[1]) / self.cell;
        let [width, height] = self.size;
        if !(x >= 0.0 && y >= 0.0 && x + 1.0 < width as f32 && y + 1.0 < height as f32) {
            return 1.0;
        }
        let (column, row) = (x as usize, y as usize);
        let (u, v) = (x - column as f32, y - row as f32);
        let at = row * width + column;
        let distance = -p.dot(self.toward);
        let hidden = |cell: [f32; 2]| cell[0] * ((distance - cell[1]) / SOFT - 1.0).clamp(0.0, 1.0);
        let upper = hidden(self.cells[at]) * (1.0 - u) + hidden(self.cells[at + 1]) * u;
        let lower = hidden(self.cells[at + width]) * (1.0 - u) + hidden(self.cells[at + width + 1]) * u;
        1.0 - (upper + (lower - upper) * v)
    }
}

/// The mean over `radius` cells to both sides along one axis.
fn blurred(cells: &[[f32; 2]], size: [usize; 2], axis: usize, radius: usize) -> Vec<[f32; 2]> {
    let mut out = vec![[0.0; 2]; cells.len()];
    let (length, step) = (size[axis], if axis == 0 { 1 } else { size[0] });
    let per = 1.0 / (2 * radius + 1) as f64;
    for line in 0..size[1 - axis] {
        let first = if axis == 0 { line * size[0] } else { line };
        // A sum that slides along the line, in double precision so that nothing is left over at its end.
        let mut sum = [0.0_f64; 2];
        for i in 0..length + radius {
            let entering = cells.get(first + i * step).filter(|_| i < length).copied().unwrap_or_default();
            let leaving = i.checked_sub(2 * radius + 1).map_or([0.0; 2], |j| cells[first + j * step]);
            for c in 0..2 {
                sum[c] += f64::from(entering[c]) - f64::from(leaving[c]);
            }
            if let Some(j) = i.checked_sub(radius) {
                out[first + j * step] = sum.map(|s| (s * per) as f32);
            }
        }
    }
    out
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_plate_hides_the_lamp_from_what_lies_behind_it_only() {
        let corners = [[-6.0, -6.0], [6.0, -6.0], [6.0, 6.0], [-6.0, 6.0]];
        let plate = Mesh {
            positions: corners.map(|[x, z]| Vec3::new(x, 0.0, z)).to_vec(),
            triangles: vec![[0, 1, 2], [0, 2, 3]],
        };
        let lamp = Lamp { toward: Vec3::Y, strength: [1.0; 3], spread: 0.03 };
        let shadow = HeadShadow::new(&lamp, &plate);
        let visible = |x: f32, y: f32| shadow.visible(Vec3::new(x, y, 0.3));
        assert_eq!(visible(0.0, 2.0), 1.0);
        assert!(visible(0.0, -2.0) < 1e-5);
        assert_eq!(visible(20.0, -2.0), 1.0);
        // At the edge, half of the blurred plate: within a cell of 1/3 of the blur's slope.
        assert!((visible(6.0, -2.0) - 0.5).abs() < 0.25);
        assert_eq!(HeadShadow::new(&lamp, &Mesh::default()).visible(Vec3::ZERO), 1.0);
    }
}
