//! What the sculptor wrote, read again: its numbers, and the mesh that they make.

use nabiki::Mesh;
use nabiki::glam::Vec3;

use super::layout::{self, POSITION, Quantised};
use super::numbers::{Coder, KINDS, Kind, LONGEST_QUOTIENT, Usual, unfold};

/// The numbers in what was written.
pub fn numbers(baked: &[u8]) -> Quantised {
    let mut bust = Quantised::default();
    layout::code(&mut bust, &mut Reader::new(baked));
    bust
}

/// Reads numbers bit by bit, the highest bit of a byte first; past the end it reads noughts.
struct Reader<'a> {
    bytes: &'a [u8],
    /// Bits taken from `bytes` and not yet read, uppermost first.
    ahead: u64,
    count: u32,
    usual: [Usual; KINDS],
}

impl<'a> Reader<'a> {
    fn new(bytes: &'a [u8]) -> Self {
        Self { bytes, ahead: 0, count: 0, usual: [Usual::UNKNOWN; KINDS] }
    }

    /// Makes at least 56 bits ready.
    fn fill(&mut self) {
        while self.count <= 56 {
            let (byte, rest) = self.bytes.split_first().map_or((0, self.bytes), |(byte, rest)| (*byte, rest));
            self.bytes = rest;
            self.ahead |= u64::from(byte) << (56 - self.count);
            self.count += 8;
        }
    }

    /// The next `count` bits, of those made ready: 1 to 32.
    fn take(&mut self, count: u32) -> u32 {
        let bits = (self.ahead >> (64 - count)) as u32;
        self.ahead <<= count;
        self.count -= count;
        bits
    }
}

impl Coder for Reader<'_> {
    const READS: bool = true;

    fn code(&mut self, kind: Kind, expected: i32, value: &mut i32) {
        let usual = self.usual[kind as usize];
        self.fill();
        let quotient = self.ahead.leading_ones().min(LONGEST_QUOTIENT);
        let folded = if quotient == LONGEST_QUOTIENT {
            self.take(LONGEST_QUOTIENT);
            self.take(32)
        } else {
            self.take(quotient + 1);
            let low = usual.low_bits();
            quotient << low | if low > 0 { self.take(low) } else { 0 }
        };
        self.usual[kind as usize].note(folded);
        *value = expected + unfold(folded);
    }
}

/// Both halves of the mesh: the vertices of the right one and of the middle come first.
pub fn mesh(bust: &Quantised) -> Mesh {
    let counts = [0, 1, 2].map(|axis| bust.planes[axis].len());
    let [nx, ny, _] = counts;
    let cells = layout::skin_cells(counts, &bust.inside);
    let index = |[i, j, layer]: [usize; 3]| (layer * ny + j) * nx + i;
    let mut vertex_in = vec![0_u32; counts.iter().product()];
    for (vertex, &cell) in cells.iter().enumerate() {
        vertex_in[index(cell)] = vertex as u32;
    }
    let mut positions: Vec<Vec3> =
        bust.vertices.iter().map(|v| POSITION * Vec3::from_array(v.map(|i| i as f32))).collect();
    let mut mirrored = Vec::with_capacity(cells.len());
    for (vertex, cell) in cells.iter().enumerate() {
        let p = positions[vertex];
        mirrored.push(if cell[2] == 0 { vertex as u32 } else { positions.len() as u32 });
        if cell[2] > 0 {
            positions.push(Vec3::new(p.x, p.y, -p.z));
        }
    }

    let mut triangles = Vec::with_capacity(4 * cells.len());
    for &cell in cells.iter().filter(|cell| cell[2] > 0) {
        // The edges from the cell's lowest corner along each axis, and the four cells about each.
        let [i, j, plane] = [cell[0], cell[1], cell[2] - 1];
        let start = bust.inside[index([i, j, plane])];
        for axis in 0..3 {
            let end = [i + usize::from(axis == 0), j + usize::from(axis == 1), plane + usize::from(axis == 2)];
            if bust.inside[index(end)] == start {
                continue;
            }
            let (next, last) = ((axis + 1) % 3, (axis + 2) % 3);
            let back = |along: &[usize]| {
                let mut cell = cell;
                along.iter().for_each(|&axis| cell[axis] -= 1);
                vertex_in[index(cell)]
            };
            let mut quad = [back(&[next, last]), back(&[last]), back(&[]), back(&[next])];
            if !start {
                quad.reverse();
            }
            triangles.extend(halves(&bust.vertices, quad));
        }
    }
    let right = triangles.len();
    for t in 0..right {
        let [a, b, c] = triangles[t].map(|v| mirrored[v as usize]);
        triangles.push([a, c, b]);
    }
    Mesh { positions, triangles, ..Mesh::default() }
}

/// A quadrilateral as two triangles, cut along its shorter diagonal.
fn halves(vertices: &[[i32; 3]], [a, b, c, d]: [u32; 4]) -> [[u32; 3]; 2] {
    let squared = |v: u32, w: u32| {
        let (v, w) = (vertices[v as usize], vertices[w as usize]);
        (0..3).map(|i| i64::from(v[i] - w[i]).pow(2)).sum::<i64>()
    };
    if squared(a, c) <= squared(b, d) { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] }
}
