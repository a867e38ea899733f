//! Light on a hair seen from afar: a rough dielectric cylinder with pigment inside and tilted scales.
//!
//! The lobes are those of Marschner et al. (2003): R is reflected at the surface (white), TT passes through, TRT is
//! reflected inside once and carries the pigment's colour; all further bounces are gathered in one smooth lobe. Along the hair each lobe
//! has the energy-conserving shape of d'Eon et al. (2011); around it, the attenuation and the logistic distribution of Chiang et
//! al. (2016) are integrated over the width of the fibre, once, into tables. Inclinations are counted from the plane normal to the
//! hair, positive toward the tip.

use std::f32::consts::PI;

use super::approx::{exp_of_negative, scaled_bessel};
use super::streams::{MIDDLING, Medium};
use crate::colour::absorption;
use crate::settings::HairLook;

/// Rows of a table, by the sine of the eye's inclination.
pub const ROWS: usize = 24;
/// Its columns, by azimuth 0..pi between lamp and eye.
pub const COLUMNS: usize = 64;
/// Offsets across the fibre over which the tables integrate.
const OFFSETS: usize = 160;
/// Grades of pigment among the strands.
pub const GRADES: usize = 8;

/// Azimuthal part of the lobes for one pigment: R (one number), TT and TRT (red, green, blue each).
pub type Lobes = [f32; 8];

/// Tables of one grade of pigment.
pub struct Table {
    /// `ROWS` x (`COLUMNS` + 1) entries.
    lobes: Vec<Lobes>,
    rows: Vec<Row>,
    /// Many such hairs.
    pub medium: Medium,
}

/// What depends on the eye's inclination only.
#[derive(Clone, Copy, Default)]
pub struct Row {
    /// All further bounces (red, green, blue): evenly around the fibre.
    pub rest: [f32; 3],
    /// Part of the light that goes on forward, and back, in even light from one side.
    pub forward: [f32; 3],
    pub back: [f32; 3],
}

/// The fibre model for one look of hair.
pub struct Fibre {
    /// From the least pigment to the most.
    pub grades: Vec<Table>,
    /// Shapes along the hair of R, TT and TRT, and their variances (rad^2).
    pub spread: [Longitudinal; 3],
    pub variances: [f32; 3],
    /// Tilt of the scales (rad).
    pub tilt: f32,
}

/// Shape of a lobe along the hair: d'Eon et al. (2011), equation 7.
#[derive(Clone, Copy)]
pub struct Longitudinal {
    per_variance: f32,
    norm: f32,
}

impl Longitudinal {
    pub fn new(variance: f32) -> Self {
        let per_variance = 1.0 / variance;
        Self { per_variance, norm: per_variance / (1.0 - (-2.0 * per_variance).exp()) }
    }

    /// The same within vector code.
    #[inline(always)]
    pub fn of(variance: f32) -> Self {
        let per_variance = 1.0 / variance;
        Self { per_variance, norm: per_variance / (1.0 - exp_of_negative(-2.0 * per_variance)) }
    }

    /// Density over directions: its integral times cos is 1 over all inclinations of the lamp. Arguments are the sines and
    /// cosines of the lamp's and the eye's inclination.
    #[inline(always)]
    pub fn at(&self, sin_lamp: f32, cos_lamp: f32, sin_eye: f32, cos_eye: f32) -> f32 {
        let a = cos_lamp * cos_eye * self.per_variance;
        let b = sin_lamp * sin_eye * self.per_variance;
        self.norm * scaled_bessel(a) * exp_of_negative((a - b - self.per_variance).min(0.0))
    }
}

impl Fibre {
    pub fn new(look: &HairLook) -> Self {
        use rayon::prelude::*;
        let base = absorption(look);
        let grades = (0..GRADES)
            .into_par_iter()
            .map(|g| {
                let deviation = 2.0 * g as f32 / (GRADES - 1) as f32 - 1.0;
                let pigment = (1.6 * look.variation * deviation).exp();
                Table::new(base.map(|a| a * pigment), look.refraction, look.azimuthal_roughness)
            })
            .collect();
        let variances = Self::variances(look);
        Self { grades, spread: variances.map(Longitudinal::new), variances, tilt: look.scale_tilt.to_radians() }
    }

    /// Variances along the hair of R, TT and TRT (rad^2).
    pub fn variances(look: &HairLook) -> [f32; 3] {
        let rough = 2.0 * look.roughness.to_radians();
        [rough, 0.5 * rough, 2.0 * rough].map(|r| r * r)
    }

    /// By how much each lobe turns for scales tilted by `tilt` (rad): R toward the root, the others toward the tip
    /// (Marschner et al. 2003, table 1).
    #[inline(always)]
    pub fn turns(tilt: f32) -> [f32; 3] {
        [2.0 * tilt, -tilt, -3.0 * tilt]
    }
}

impl Table {
    pub fn new(absorption: [f32; 3], refraction: f32, azimuthal_roughness: f32) -> Self {
        let b = azimuthal_roughness;
        let scale = (PI / 8.0).sqrt() * (0.265 * b + 1.194 * b * b + 5.372 * b.powi(22));
        let mut lobes = vec![[0.0; 8]; ROWS * (COLUMNS + 1)];
        let mut rows = vec![Row::default(); ROWS];
        for (r, row) in rows.iter_mut().enumerate() {
            let sin_eye = (r as f32 / (ROWS - 1) as f32).min(0.9995);
            let entries = &mut lobes[r * (COLUMNS + 1)..(r + 1) * (COLUMNS + 1)];
            fill(row, entries, sin_eye, absorption, refraction, scale);
        }
        let mut table = Self { lobes, rows, medium: Medium::default() };
        let Row { forward, back, .. } = table.row(MIDDLING * (ROWS - 1) as f32);
        table.medium = Medium::of(forward, back);
        table
    }

    /// The lobes, row after row.
    pub fn lobes_by_row(&self) -> &[Lobes] {
        &self.lobes
    }

    /// The rows.
    pub fn rows(&self) -> &[Row] {
        &self.rows
    }

    /// Interpolated lobes at a place between rows and columns (counted from 0 to `ROWS` - 1 and `COLUMNS`).
    #[inline(always)]
    pub fn lobes(&self, row: f32, column: f32) -> Lobes {
        let (r, c) = ((row as usize).min(ROWS - 2), (column as usize).min(COLUMNS - 1));
        let (v, u) = (row - r as f32, column - c as f32);
        let at = r * (COLUMNS + 1) + c;
        let (a, b) = (&self.lobes[at], &self.lobes[at + 1]);
        let (d, e) = (&self.lobes[at + COLUMNS + 1], &self.lobes[at + COLUMNS + 2]);
        let mut mixed = [0.0; 8];
        for i in 0..8 {
            let upper = a[i] + (b[i] - a[i]) * u;
            let lower = d[i] + (e[i] - d[i]) * u;
            mixed[i] = upper + (lower - upper) * v;
        }
        mixed
    }

    /// Interpolated row.
    #[inline(always)]
    pub fn row(&self, row: f32) -> Row {
        let r = (row as usize).min(ROWS - 2);
        let v = row - r as f32;
        let (a, b) = (&self.rows[r], &self.rows[r + 1]);
        let mut mixed = Row::default();
        for c in 0..3 {
            mixed.rest[c] = a.rest[c] + (b.rest[c] - a.rest[c]) * v;
            mixed.forward[c] = a.forward[c] + (b.forward[c] - a.forward[c]) * v;
            mixed.back[c] = a.back[c] + (b.back[c] - a.back[c]) * v;
        }
        mixed
    }
}

/// Integrates one row over the width of the fibre.
fn fill(row: &mut Row, entries: &mut [Lobes], sin_eye: f32, absorption: [f32; 3], refraction: f32, scale: f32) {
    let cos_eye = (1.0 - sin_eye * sin_eye).sqrt();
    let cos_inside = (1.0 - (sin_eye / refraction).powi(2)).sqrt();
    // Bravais' index: refraction as the cross-section of the fibre sees it.
    let across = (refraction * refraction - sin_eye * sin_eye).sqrt() / cos_eye;
    let mut energy = [0.0_f32; 7];
    for k in 0..OFFSETS {
        let h = (2 * k + 1) as f32 / OFFSETS as f32 - 1.0;
        let share = 1.0 / OFFSETS as f32;
        let (outside, inside) = (h.asin(), (h / across).asin());
        let surface = fresnel(cos_eye * (1.0 - h * h).sqrt(), refraction);
        let passed = absorption.map(|a| (-2.0 * a * inside.cos() / cos_inside).exp());
        let tt = passed.map(|t| (1.0 - surface).powi(2) * t);
        let trt: [f32; 3] = std::array::from_fn(|c| tt[c] * passed[c] * surface);
        for c in 0..3 {
            row.rest[c] += share * trt[c] * passed[c] * surface / (1.0 - passed[c] * surface) / (2.0 * PI);
        }
        let weights = [surface, tt[0], tt[1], tt[2], trt[0], trt[1], trt[2]].map(|w| w * share);
        let exits = [0.0, 1.0, 2.0].map(|p| 2.0 * p * inside - 2.0 * outside + p * PI);
        for (column, entry) in entries.iter_mut().enumerate() {
            let azimuth = PI * column as f32 / COLUMNS as f32;
            for (i, weight) in weights.iter().enumerate() {
                let turned = (azimuth - exits[i.div_ceil(3)] + PI).rem_euclid(2.0 * PI) - PI;
                entry[i] += weight * logistic(turned, scale);
            }
        }
        for (e, w) in energy.iter_mut().zip(weights) {
            *e += w;
        }
    }
    // What is interpolated later must hold exactly the energy that each lobe carries.
    let quadrature = |entries: &[Lobes], i: usize| {
        let ends = 0.5 * (entries[0][i] + entries[COLUMNS][i]);
        (entries[1..COLUMNS].iter().map(|e| e[i]).sum::<f32>() + ends) * 2.0 * PI / COLUMNS as f32
    };
    for i in 0..7 {
        let correction = energy[i] / quadrature(entries, i).max(1e-12);
        entries.iter_mut().for_each(|e| e[i] *= correction);
    }
    for c in 0..3 {
        let half = COLUMNS / 2;
        let all = |e: &Lobes| e[0] + e[1 + c] + e[4 + c];
        let ends = 0.5 * (all(&entries[0]) + all(&entries[half]));
        let back = (entries[1..half].iter().map(all).sum::<f32>() + ends) * 2.0 * PI / COLUMNS as f32;
        let rest = PI * row.rest[c];
        let total = energy[0] + energy[1 + c] + energy[4 + c];
        row.back[c] = back + rest;
        row.forward[c] = total - back + rest;
    }
}

/// The logistic distribution of azimuths about an exit, cut off half a turn away (rad; per rad).
fn logistic(x: f32, scale: f32) -> f32 {
    let density = |x: f32| {
        let e = (-x.abs() / scale).exp();
        e / (scale * (1.0 + e).powi(2))
    };
    let within = |x: f32| 1.0 / (1.0 + (-x / scale).exp());
    density(x) / (within(PI) - within(-PI))
}

/// Part of unpolarised light that a smooth dielectric reflects.
fn fresnel(cos: f32, refraction: f32) -> f32 {
    let sin_inside = (1.0 - cos * cos).max(0.0).sqrt() / refraction;
    let cos_inside = (1.0 - sin_inside * sin_inside).max(0.0).sqrt();
    let s = (cos - refraction * cos_inside) / (cos + refraction * cos_inside);
    let p = (refraction * cos - cos_inside) / (refraction * cos + cos_inside);
    0.5 * (s * s + p * p)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Reflected part of even light from everywhere, by quadrature over all directions of the lamp.
    fn returned(absorption: [f32; 3], sin_eye: f32, channel: usize) -> f32 {
        let look = HairLook::default();
        let model = Fibre::new(&look);
        let table = Table::new(absorption, look.refraction, look.azimuthal_roughness);
        let row = sin_eye.abs() * (ROWS - 1) as f32;
        let eye = sin_eye.asin();
        let mut sum = 0.0;
        let steps = 512;
        for i in 0..steps {
            let lamp = PI * ((i as f32 + 0.5) / steps as f32 - 0.5);
            let m: [f32; 3] = std::array::from_fn(|p| {
                let turned = eye + Fibre::turns(model.tilt)[p];
                model.spread[p].at(lamp.sin(), lamp.cos(), turned.sin(), turned.cos().abs())
            });
            let mut around = 0.0;
            for k in 0..COLUMNS {
                let lobes = table.lobes(row, k as f32 + 0.5);
                let n = m[0] * lobes[0] + m[1] * lobes[1 + channel] + m[2] * lobes[4 + channel];
                around += (n + m[2] * table.row(row).rest[channel]) * 2.0 * PI / COLUMNS as f32;
            }
            sum += around * lamp.cos() * PI / steps as f32;
        }
        sum
    }

    #[test]
    fn a_clear_fibre_returns_all_of_an_even_light() {
        for sin_eye in [0.0, 0.3, -0.6, 0.9] {
            // 6e-3: the promised error of the Bessel function; 1e-3 more for the quadrature.
            let all = returned([0.0; 3], sin_eye, 0);
            assert!((all - 1.0).abs() < 7e-3, "{sin_eye}: {all}");
        }
    }

    #[test]
    fn pigment_only_takes_light_away_and_leaves_the_white_reflection() {
        let mut before = 1.1;
        for absorption in [0.0, 0.1, 0.5, 2.0, 50.0] {
            let now = returned([absorption; 3], 0.2, 1);
            assert!(now < before);
            before = now;
        }
        // With everything else absorbed, the Fresnel reflection averaged over the width of the fibre is left.
        let surface = (0..10_000)
            .map(|k| {
                let h = (k as f32 + 0.5) / 5_000.0 - 1.0;
                fresnel(0.96_f32.sqrt() * (1.0 - h * h).sqrt(), HairLook::default().refraction) / 10_000.0
            })
            .sum::<f32>();
        assert!((before - surface).abs() < 7e-3, "{before} {surface}");
    }

    #[test]
    fn forward_and_back_make_the_whole() {
        let table = Table::new([0.1, 0.4, 1.0], 1.55, 0.35);
        let clear = Table::new([0.0; 3], 1.55, 0.35);
        for r in 0..ROWS {
            let row = clear.row(r as f32);
            for c in 0..3 {
                // A few hundred roundings of sums near 1.
                assert!((row.forward[c] + row.back[c] - 1.0).abs() < 1e-4);
                let dark = table.row(r as f32);
                assert!(dark.forward[c] < row.forward[c] && dark.back[c] < row.back[c]);
            }
        }
    }

    #[test]
    fn the_surface_reflection_turns_toward_the_root_and_the_inner_one_toward_the_tip() {
        let look = HairLook::default();
        let model = Fibre::new(&look);
        // The eye's inclination at which a lobe is brightest, for a lamp in the normal plane.
        let brightest = |p: usize| {
            (-400..400)
                .map(|i| i as f32 / 400.0)
                .max_by(|&x, &y| {
                    let value = |eye: f32| {
                        let turned = eye + Fibre::turns(model.tilt)[p];
                        model.spread[p].at(0.0, 1.0, turned.sin(), turned.cos())
                    };
                    value(x).total_cmp(&value(y))
                })
                .unwrap()
        };
        assert!(brightest(0) < 0.0 && brightest(1) > 0.0 && brightest(2) > brightest(1));
    }

    #[test]
    fn each_lobe_is_brightest_where_its_tilted_scales_send_it_and_as_wide_as_it_should_be() {
        let look = HairLook { roughness: 3.0, scale_tilt: 2.5, ..HairLook::default() };
        let model = Fibre::new(&look);
        let (tilt, rough) = (look.scale_tilt.to_radians(), 2.0 * look.roughness.to_radians());
        // Scales lean from the normal by the tilt: their mirror turns by twice that, and what passes in or out of them by some of it
        // (Marschner et al. 2003, table 1); widths are as 2 : 1 : 4 (there too), counted for the half angle.
        for (p, (turn, width)) in [(-2.0, 1.0), (1.0, 0.5), (3.0, 2.0)].into_iter().enumerate() {
            let steps = 4000;
            let (mut sum, mut middle, mut square) = (0.0_f64, 0.0_f64, 0.0_f64);
            for i in 0..steps {
                let eye = PI * ((i as f32 + 0.5) / steps as f32 - 0.5);
                let turned = eye + Fibre::turns(model.tilt)[p];
                let value = f64::from(model.spread[p].at(0.0, 1.0, turned.sin(), turned.cos().abs()));
                (sum, middle) = (sum + value, middle + value * f64::from(eye));
                square += value * f64::from(eye).powi(2);
            }
            (middle, square) = (middle / sum, square / sum - (middle / sum).powi(2));
            let (turn, width) = (turn * tilt, width * rough);
            // Nothing turns it besides; the shape is that of a bell for small widths, to the square of the width.
            assert!((middle - f64::from(turn)).abs() < 1e-3, "lobe {p}: {middle} for {turn}");
            assert!(
                (square.sqrt() / f64::from(width) - 1.0).abs() < f64::from(width * width),
                "lobe {p}: {}",
                square.sqrt()
            );
        }
    }

    #[test]
    fn a_dielectric_reflects_as_fresnel_says() {
        for n in [1.3_f32, 1.55, 2.0] {
            // Head-on ((n - 1) / (n + 1))^2, at grazing all; at Brewster's angle, tan = n, nothing of one polarisation, and of the other
            // ((n^2 - 1) / (n^2 + 1))^2.
            assert!((fresnel(1.0, n) - ((n - 1.0) / (n + 1.0)).powi(2)).abs() < 1e-6);
            assert!((fresnel(0.0, n) - 1.0).abs() < 1e-6);
            let brewster = ((n * n - 1.0) / (n * n + 1.0)).powi(2);
            assert!((fresnel((1.0 + n * n).sqrt().recip(), n) - 0.5 * brewster).abs() < 1e-6);
        }
    }

    #[test]
    fn the_surface_mirrors_as_a_cylinder_does_brightest_toward_the_lamp() {
        // A ray that meets the cylinder at the angle g to its normal goes back at 2 g from where it came: with the width spread over
        // azimuths, fresnel(g) cos(g) / 4 for each radian.
        for row in [0, ROWS / 2] {
            let cos_eye = (1.0 - (row as f32 / (ROWS - 1) as f32).powi(2)).sqrt();
            let table = Table::new([0.3; 3], 1.55, 0.2);
            for column in (0..50).step_by(7) {
                let half = 0.5 * PI * column as f32 / COLUMNS as f32;
                let mirrored = 0.25 * half.cos() * fresnel(cos_eye * half.cos(), 1.55);
                let found = table.lobes(row as f32, column as f32)[0];
                // Roughness spreads it over a tenth of a radian or so; from 130 degrees on Fresnel's rise is as steep as that.
                assert!((found / mirrored - 1.0).abs() < 0.05, "{row} {column}: {found} for {mirrored}");
            }
        }
    }

    #[test]
    fn light_that_is_not_bent_goes_straight_on_and_loses_by_the_way_that_it_goes_inside() {
        // Of the refraction of what is around it nothing is left but pigment: a disc of radius 1, which an inclined ray crosses aslant.
        let absorption = [0.1, 0.7, 3.0];
        let table = Table::new(absorption, 1.0, 0.05);
        for row in [0, 12, 18] {
            let cos = (1.0 - (row as f32 / (ROWS - 1) as f32).powi(2)).sqrt();
            for (c, absorption) in absorption.into_iter().enumerate() {
                let steps = 2000;
                let chord = |k: usize| (1.0 - ((2 * k + 1) as f32 / steps as f32 - 1.0).powi(2)).sqrt();
                let left = |k: usize| (-2.0 * absorption * chord(k) / cos).exp() / steps as f32;
                let (left, found) = ((0..steps).map(left).sum::<f32>(), table.row(row as f32).forward[c]);
                // The middle of 160 strips stands for each; the chord is steep at the edge.
                assert!((found - left).abs() < 2e-3, "{row} {c}: {found} for {left}");
                assert!(table.row(row as f32).back[c] < 1e-3, "{row} {c}");
            }
        }
    }

    #[test]
    fn an_inclined_fibre_bends_light_about_itself_as_refraction_in_space_does() {
        use glam::{Vec2, Vec3, vec3};
        let n = 1.55;
        for row in [0, 8, 16, 20] {
            let sin = row as f32 / (ROWS - 1) as f32;
            let cos = (1.0 - sin * sin).sqrt();
            let table = Table::new([0.0; 3], n, 0.1);
            // The mean square of the angle about the fibre between the ways in and out, of what passes through.
            let (mut sum, mut square) = (0.0, 0.0);
            for k in 0..4000 {
                let h = (2 * k + 1) as f32 / 4000.0 - 1.0;
                let (way, normal) = (vec3(cos, 0.0, sin), vec3(-(1.0 - h * h).sqrt(), h, 0.0));
                let into = -way.dot(normal);
                let inside: Vec3 = way / n + normal * (into / n - (1.0 - (1.0 - into * into) / (n * n)).sqrt());
                // Both surfaces turn it alike.
                let turned = 2.0 * Vec2::X.angle_to(inside.truncate());
                let passes = (1.0 - fresnel(into, n)).powi(2);
                (sum, square) = (sum + passes, square + passes * turned * turned);
            }
            let (mut found, mut all) = (0.0, 0.0);
            for column in 0..=COLUMNS {
                let (share, aside) =
                    (table.lobes(row as f32, column as f32)[1], PI * (1.0 - column as f32 / COLUMNS as f32));
                let ends = if column % COLUMNS == 0 { 0.5 } else { 1.0 };
                (all, found) = (all + ends * share, found + ends * share * aside * aside);
            }
            // Roughness adds its own variance, that of a logistic distribution.
            let scale = (PI / 8.0).sqrt() * (0.265 * 0.1 + 1.194 * 0.01);
            let expected = square / sum + (PI * scale).powi(2) / 3.0;
            assert!((found / all / expected - 1.0).abs() < 0.02, "{row}: {} for {expected}", found / all);
        }
    }
}
