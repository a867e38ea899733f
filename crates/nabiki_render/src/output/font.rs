//! A stroke alphabet for captions: each glyph is a handful of polylines on a small grid.

/// Strokes of a glyph: pairs of digits (x to the right, y up; the baseline at 2, small letters to 6, capitals to 8),
/// strokes parted by spaces. Then its width.
fn glyph(c: char) -> (&'static str, f32) {
    match c {
        '0' => ("030718384743321203", 5.0),
        '1' => ("072822 1232", 4.0),
        '2' => ("071838474602 0242", 5.0),
        '3' => ("0718384746352515 354443321203", 5.0),
        '4' => ("32380444", 5.0),
        '5' => ("480805354443321203", 5.0),
        '6' => ("473818070312324344351504", 5.0),
        '7' => ("084812", 5.0),
        '8' => ("183847463515060718 15040312324344 3544", 5.0),
        '9' => ("031232434738180706154546", 5.0),
        'a' => ("0516364542 4414031232 3243", 5.0),
        'b' => ("0802 05163645433212 1203", 5.0),
        'c' => ("4536160503123243", 5.0),
        'd' => ("4842 45361605031232 3243", 5.0),
        'e' => ("04444536160503123243", 5.0),
        'f' => ("38281712 0636", 4.0),
        'g' => ("4641301001 453616050312 123243", 5.0),
        'h' => ("0802 0516364542", 5.0),
        'i' => ("1612 1817", 2.0),
        'j' => ("161100 1817", 2.0),
        'k' => ("0802 3603 0432", 4.0),
        'l' => ("181322", 3.0),
        'm' => ("0602 05162522 25364542", 5.0),
        'n' => ("0602 0516364542", 5.0),
        'o' => ("160503123243453616", 5.0),
        'p' => ("0600 051636454332 321203", 5.0),
        'q' => ("4640 453616050312 123243", 5.0),
        'r' => ("0602 04162636", 4.0),
        's' => ("453616051434433212 1203", 5.0),
        't' => ("18132232 0636", 4.0),
        'u' => ("0603123243 4642", 5.0),
        'v' => ("062246", 5.0),
        'w' => ("0612253246", 5.0),
        'x' => ("0642 4602", 5.0),
        'y' => ("0622 4610", 5.0),
        'z' => ("06460242", 5.0),
        'F' => ("480802 0535", 5.0),
        '-' => ("1434", 5.0),
        '+' => ("0545 2723", 5.0),
        '=' => ("0646 0444", 5.0),
        '.' => ("1212", 3.0),
        ',' => ("131201", 3.0),
        ':' => ("1212 1515", 3.0),
        '(' => ("28161422", 3.0),
        ')' => ("08161402", 3.0),
        '/' => ("0238", 4.0),
        _ => ("", 3.0),
    }
}

/// Width of a caption whose capitals are `height` tall.
pub fn width(text: &str, height: f32) -> f32 {
    text.chars().map(|c| glyph(c).1 + 1.0).sum::<f32>() * height / 6.0
}

/// The polylines of a caption whose first glyph stands at `x` on the baseline `y` (pixels, y down).
pub fn strokes(text: &str, x: f32, y: f32, height: f32) -> Vec<Vec<[f32; 2]>> {
    let unit = height / 6.0;
    let mut at = x;
    let mut all = Vec::new();
    for c in text.chars() {
        let (code, advance) = glyph(c);
        for stroke in code.split(' ') {
            let digits: Vec<f32> = stroke.bytes().map(|b| f32::from(b - b'0')).collect();
            all.push(digits.chunks_exact(2).map(|p| [at + p[0] * unit, y - (p[1] - 2.0) * unit]).collect());
        }
        at += (advance + 1.0) * unit;
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_glyph_is_made_of_whole_strokes_within_its_width() {
        for c in "0123456789abcdefghijklmnopqrstuvwxyzF-+=.,:()/".chars() {
            let (code, width) = glyph(c);
            for stroke in code.split(' ') {
                assert!(stroke.len() >= 4 && stroke.len() % 2 == 0, "{c}: {stroke}");
                for p in stroke.as_bytes().chunks_exact(2) {
                    assert!(f32::from(p[0] - b'0') < width && p[1] <= b'8', "{c}: {stroke}");
                }
            }
        }
    }
}
