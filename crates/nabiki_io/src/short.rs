//! Numbers for display.

use std::fmt;

/// A number with four significant digits.
pub struct Short(pub f32);

impl fmt::Display for Short {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let size = self.0.abs();
        if size == 0.0 {
            f.write_str("0")
        } else if (1e-4..1e6).contains(&size) {
            let decimals = (3 - size.log10().floor() as i32).max(0) as usize;
            let text = format!("{:.decimals$}", self.0);
            f.write_str(if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text })
        } else {
            write!(f, "{:.3e}", self.0)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        let texts = [0.0, 7e-5, 0.10149, 12.5, 18.0, 1234.56, -0.3333333, 2e9].map(|x| Short(x).to_string());
        assert_eq!(texts, ["0", "7.000e-5", "0.1015", "12.5", "18", "1235", "-0.3333", "2.000e9"]);
    }
}
