//! Where the vertices of each frame are in the texture.

/// Limits of a texture that engines and graphics cards have in common.
pub(super) const MOST_WIDTH: u64 = 8192;
pub(super) const MOST_HEIGHT: u64 = 16_384;
/// Bytes of a vertex of a ribbon in the mesh, with its indices.
const VERTEX_BYTES: u64 = 48;

/// The vertices of a frame fill some rows, and the next frame follows below.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Layout {
    pub vertices: usize,
    pub frames: usize,
    pub width: usize,
    /// Rows of each frame.
    pub rows: usize,
}

impl Layout {
    /// As few rows as the limits allow, equally full: a frame leaves fewer texels unused than it has rows.
    ///
    /// # Errors
    /// What does not fit into a texture or its mesh, without the way out.
    pub fn new(vertices: u64, frames: u64) -> Result<Self, String> {
        let rows = vertices.div_ceil(MOST_WIDTH).max(1);
        let height = rows.saturating_mul(frames);
        if height > MOST_HEIGHT {
            return Err(format!(
                "{frames} frames of {vertices} vertices need a texture of {MOST_WIDTH} x {height} texels, but \
                 {MOST_WIDTH} x {MOST_HEIGHT} is the limit"
            ));
        }
        if vertices * VERTEX_BYTES > u64::from(u32::MAX) {
            return Err(format!("a .glb holds less than 4 GiB, and {vertices} vertices take more"));
        }
        let [vertices, frames, width, rows] = [vertices, frames, vertices.div_ceil(rows), rows].map(|n| n as usize);
        Ok(Self { vertices, frames, width, rows })
    }

    pub fn height(&self) -> usize {
        self.rows * self.frames
    }

    /// The frame and the vertex of a texel; `None` if it is unused.
    pub fn at(&self, x: usize, y: usize) -> Option<(usize, usize)> {
        let vertex = y % self.rows * self.width + x;
        (vertex < self.vertices).then_some((y / self.rows, vertex))
    }

    /// The centre of a vertex's texel in the first frame. v runs from the top, as in glTF.
    pub fn uv(&self, vertex: usize) -> [f32; 2] {
        let part = |at: usize, of: usize| ((at as f64 + 0.5) / of as f64) as f32;
        [part(vertex % self.width, self.width), part(vertex / self.width, self.height())]
    }

    /// From a frame to the next, in v.
    pub fn v_of_a_frame(&self) -> f64 {
        self.rows as f64 / self.height() as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_vertex_has_its_own_texel_and_few_are_unused() {
        for vertices in [1, 2, 8191, 8192, 8193, 20_000, 90_001] {
            let layout = Layout::new(vertices, 3).unwrap();
            let Layout { width, rows, .. } = layout;
            assert!(width as u64 <= MOST_WIDTH && (width * rows) as u64 - vertices < rows as u64, "{layout:?}");
            let texels = (0..layout.height()).flat_map(|y| (0..width).map(move |x| (x, y)));
            let used: Vec<_> = texels.filter_map(|(x, y)| layout.at(x, y)).collect();
            let wanted: Vec<_> = (0..3).flat_map(|n| (0..vertices as usize).map(move |v| (n, v))).collect();
            assert!(used == wanted, "{layout:?}");
        }
    }

    #[test]
    fn what_fits_into_no_texture_is_refused_with_its_numbers() {
        let layout = Layout::new(MOST_WIDTH, MOST_HEIGHT).unwrap();
        assert_eq!((layout.width, layout.height()), (8192, 16_384));
        assert_eq!(
            Layout::new(MOST_WIDTH + 1, MOST_HEIGHT / 2 + 1).unwrap_err(),
            "8193 frames of 8193 vertices need a texture of 8192 x 16386 texels, but 8192 x 16384 is the limit"
        );
        assert!(Layout::new(100_000_000, 1).is_err(), "no .glb holds so many vertices");
    }
}
