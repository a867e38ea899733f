//! The window's icon: a few strands in the wind.

/// Width and height (pixels).
pub const SIDE: u32 = 64;

/// Red, green, blue, alpha of each pixel, row by row from the top.
pub fn pixels() -> Vec<u8> {
    (0..SIDE * SIDE).flat_map(|n| pixel((n % SIDE) as f32 + 0.5, (n / SIDE) as f32 + 0.5)).collect()
}

fn pixel(x: f32, y: f32) -> [u8; 4] {
    let side = SIDE as f32;
    let corner = 12.0;
    let [dx, dy] = [x, y].map(|at| (corner - at.min(side - at)).max(0.0));
    let alpha = (corner + 0.5 - dx.hypot(dy)).clamp(0.0, 1.0);
    let mut colour = [30.0, 30.0, 32.0];
    for strand in 0..6 {
        let s = strand as f32;
        // From the crown at the right they stream to the left and sink.
        let along = ((54.0 - x) / (44.0 - 3.0 * s)).clamp(0.0, 1.0);
        let height = 14.0 + 2.0 * s + (4.0 + 6.5 * s) * along * along - 3.0 * (3.0 * along + 0.4 * s).sin();
        let thick = 2.4 * (1.0 - 0.75 * along);
        let within = 54.0 - x >= 0.0 && 54.0 - x <= 44.0 - 3.0 * s;
        let cover = if within { (thick - (y - height).abs() + 0.5).clamp(0.0, 1.0) } else { 0.0 };
        let ink = [236.0 - 12.0 * s, 172.0 - 16.0 * s, 98.0 - 8.0 * s];
        colour = std::array::from_fn(|c| colour[c] + cover * (ink[c] - colour[c]));
    }
    let [r, g, b] = colour.map(|c| c.round().clamp(0.0, 255.0) as u8);
    [r, g, b, (255.0 * alpha).round() as u8]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_has_all_its_pixels_and_round_corners() {
        let pixels = pixels();
        assert_eq!(pixels.len(), (4 * SIDE * SIDE) as usize);
        assert_eq!(pixels[3], 0);
        let middle = 4 * (SIDE * SIDE / 2 + SIDE / 2) as usize;
        assert_eq!(pixels[middle + 3], 255);
    }
}
