//! A map of what a lamp sees: drawn, blurred, and looked at in blocks.

/// The least distance on a map in blocks of cells.
pub struct Blocks {
    side: usize,
    size: [usize; 2],
    /// In each block and in those beside it.
    least: Vec<f32>,
}

impl Blocks {
    /// In blocks of `side` times `side` cells of a map.
    pub fn new(distance: &[f32], map: [usize; 2], side: usize) -> Self {
        let size = map.map(|length| length.div_ceil(side));
        let mut own = vec![f32::INFINITY; size[0] * size[1]];
        for (y, row) in distance.chunks_exact(map[0].max(1)).enumerate() {
            for (cells, least) in row.chunks(side).zip(&mut own[y / side * size[0]..]) {
                *least = cells.iter().fold(*least, |least, &d| if d < least { d } else { least });
            }
        }
        let beside = |at: usize, length: usize| at.saturating_sub(1)..(at + 2).min(length);
        let about = |i: usize| {
            let (x, y) = (i % size[0], i / size[0]);
            let rows = beside(y, size[1]).map(|y| &own[y * size[0]..][beside(x, size[0])]);
            rows.flatten().copied().fold(f32::INFINITY, f32::min)
        };
        Self { side, size, least: (0..own.len()).map(about).collect() }
    }

    /// The least about a place (cells); beyond the map at its edge.
    pub fn least(&self, x: f32, y: f32) -> f32 {
        let at = |x: f32, length: usize| (x.max(0.0) as usize / self.side).min(length - 1);
        self.least[at(y, self.size[1]) * self.size[0] + at(x, self.size[0])]
    }
}

/// The mean over `radius` cells to both sides along one axis; lines side by side. Compiled for each width of vectors that machines have; one is
/// chosen at run time.
pub struct Blur<'a> {
    pub cells: &'a [[f32; 2]],
    pub size: [usize; 2],
    pub axis: usize,
    pub radius: usize,
    pub out: &'a mut [[f32; 2]],
}

/// Lines that are blurred together.
const LINES: usize = 8;

impl pulp::NullaryFnOnce for Blur<'_> {
    type Output = ();

    #[inline(always)]
    fn call(mut self) {
        let lines = self.size[1 - self.axis];
        let whole = lines - lines % LINES;
        (0..whole).step_by(LINES).for_each(|line| self.lines::<LINES>(line));
        (whole..lines).for_each(|line| self.lines::<1>(line));
    }
}

impl Blur<'_> {
    #[inline(always)]
    fn lines<const N: usize>(&mut self, line: usize) {
        let (length, row) = (self.size[self.axis], self.size[0]);
        let (step, aside) = if self.axis == 0 { (1, row) } else { (row, 1) };
        let first = line * aside;
        let per = 1.0 / (2 * self.radius + 1) as f64;
        // A sum that slides along the line, in double precision so that nothing is left over at its end.
        let mut sum = [[0.0_f64; 2]; N];
        for i in 0..length + self.radius {
            let entering = (i < length).then_some(first + i * step);
            let leaving = i.checked_sub(2 * self.radius + 1).map(|j| first + j * step);
            let of = |at: Option<usize>| -> [[f32; 2]; N] {
                at.map_or([[0.0; 2]; N], |at| std::array::from_fn(|n| self.cells[at + n * aside]))
            };
            let (entering, leaving) = (of(entering), of(leaving));
            for n in 0..N {
                for c in 0..2 {
                    sum[n][c] += f64::from(entering[n][c]) - f64::from(leaving[n][c]);
                }
            }
            if let Some(j) = i.checked_sub(self.radius) {
                for (n, sum) in sum.iter().enumerate() {
                    self.out[first + j * step + n * aside] = sum.map(|s| (s * per) as f32);
                }
            }
        }
    }
}

/// Keeps the nearest distance of triangles in the cells they cover. Compiled for each width of vectors that machines have; one is chosen at run
/// time.
pub struct Draw<'a> {
    pub triangles: &'a [[u32; 3]],
    /// On the map (cells), and the distance.
    pub corners: &'a [[f32; 3]],
    pub size: [usize; 2],
    pub distance: &'a mut [f32],
}

/// Cells of a row that are drawn together.
const CELLS: usize = 8;

impl pulp::NullaryFnOnce for Draw<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self { triangles, corners, size, distance } = self;
        for triangle in triangles {
            let [a, b, c] = triangle.map(|v| corners[v as usize]);
            let area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
            if area == 0.0 || !area.is_finite() {
                continue;
            }
            let (turn, depths) = (area.signum(), [a[2], b[2], c[2]].map(|depth| depth / area));
            let span = |i: usize| {
                let low = a[i].min(b[i]).min(c[i]).max(0.0) as usize;
                let high = a[i].max(b[i]).max(c[i]).max(0.0) as usize + 1;
                low..high.min(size[i])
            };
            let columns = span(0);
            let sides = [(b, c), (c, a), (a, b)];
            for y in span(1) {
                let row = &mut distance[y * size[0]..][..size[0]];
                for first in columns.clone().step_by(CELLS) {
                    let mut areas = [[0.0_f32; CELLS]; 3];
                    for (areas, (q, r)) in areas.iter_mut().zip(sides) {
                        let (across, along, down) = (r[0] - q[0], r[1] - q[1], y as f32 - q[1]);
                        for (n, area) in areas.iter_mut().enumerate() {
                            *area = across * down - along * ((first + n) as f32 - q[0]);
                        }
                    }
                    let mut least = [0.0_f32; CELLS];
                    let mut found = [0.0_f32; CELLS];
                    for n in 0..CELLS {
                        let [u, v, w] = [areas[0][n], areas[1][n], areas[2][n]];
                        let (tu, tv, tw) = (u * turn, v * turn, w * turn);
                        let least_two = if tu < tv { tu } else { tv };
                        least[n] = if least_two < tw { least_two } else { tw };
                        found[n] = u * depths[0] + v * depths[1] + w * depths[2];
                    }
                    for n in 0..CELLS {
                        found[n] = if least[n] >= 0.0 { found[n] } else { f32::INFINITY };
                    }
                    if let Some(here) = row[first..].first_chunk_mut::<CELLS>() {
                        for n in 0..CELLS {
                            here[n] = if found[n] < here[n] { found[n] } else { here[n] };
                        }
                    } else {
                        row[first..].iter_mut().zip(found).for_each(|(here, found)| *here = here.min(found));
                    }
                }
            }
        }
    }
}
