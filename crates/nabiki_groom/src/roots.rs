//! Roots: the points where hair grows out of the scalp, called pores in the paper (section 3.1).
//!
//! The paper places roots on the head ellipsoid E in place of the scalp. A real scalp differs from E by some
//! millimetres, and a root off the skin is visible, so roots are placed on the skin itself. E determines which part of
//! the skin is scalp. Roots are blue noise, and so is every beginning of their order: the first 300 of 20,000 are a
//! preview of them.

mod hairline;

use nabiki::glam::{Vec2, Vec3};
use nabiki::random::{GOLDEN_GAMMA, finalise, unit};
use nabiki::subset::{self, evenly_while};
use nabiki::{Head, SettingError};
use rayon::prelude::*;

pub use hairline::Hairline;

/// The root of a strand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Root {
    /// Position on the skin (head space, cm).
    pub position: Vec3,
    /// Outward normal of the skin there, of unit length.
    pub normal: Vec3,
    /// Texture coordinates of the skin there, v upward: those of the mesh, or [`Ellipsoid::uv`](nabiki::Ellipsoid::uv)
    /// of E if it has none.
    pub uv: Vec2,
    /// Height above the hairline, in the unit of [`Hairline`].
    pub above_hairline: f32,
}

/// Candidates for each root asked for: with more the spacing gains little, with fewer it shows.
const CANDIDATES: usize = 5;
/// Largest number of roots: candidates are counted in 32 bits.
pub const MOST: usize = 800_000_000;
const _: () = assert!(MOST <= u32::MAX as usize / CANDIDATES);
/// Places drawn at most for each candidate kept; a hairline that keeps less leaves no scalp to speak of.
const TRIES: u64 = 64;

/// Draws of a task, before each of which it is asked whether to go on.
const DRAWS_A_TASK: u64 = 4096;

/// A triangle smaller than this (mean half axes of E) bears no hair where none of its corners does.
const LARGE: f32 = 0.1;
/// So far below the hairline, in its unit, a corner still counts: farther than a small triangle reaches.
const BELOW: f32 = 0.15;

/// Refuses more than [`MOST`] roots.
///
/// # Errors
/// Names `hair.strands`.
pub fn check_count(count: usize) -> Result<(), SettingError> {
    if count <= MOST {
        return Ok(());
    }
    Err(SettingError::new("hair.strands", count, format!("must be at most {MOST}: grow fewer")))
}

/// The least memory (bytes) for spreading this many roots, however few of them are wanted.
pub fn least_bytes(count: usize) -> u64 {
    // The candidates, their places, and the cells that these lie in with number, place and gap.
    let each = size_of::<Root>() + size_of::<Vec3>() + subset::BYTES_A_POINT;
    (count as u64).saturating_mul((CANDIDATES * each) as u64)
}

/// Spreads `count` roots evenly within `hairline`, in farthest-first order. The same `seed` gives the same roots, bit
/// by bit.
///
/// # Errors
/// If the hairline is out of range or leaves none of the scalp, or for more than [`MOST`] roots.
pub fn spread(head: &Head, hairline: &Hairline, count: usize, seed: u64) -> Result<Vec<Root>, SettingError> {
    spread_first(head, hairline, count, count, seed)
}

/// The first `shown` of the roots of [`spread`], the same bit by bit, in less time than all.
///
/// # Errors
/// As for [`spread`].
pub fn spread_first(
    head: &Head,
    hairline: &Hairline,
    count: usize,
    shown: usize,
    seed: u64,
) -> Result<Vec<Root>, SettingError> {
    spread_first_while(head, hairline, count, shown, seed, &|| true).map(Option::unwrap_or_default)
}

/// Like [`spread_first`], but any thread calls `goes_on` regularly. If it returns `false`, the result is `None`.
///
/// # Errors
/// As for [`spread`].
pub fn spread_first_while(
    head: &Head,
    hairline: &Hairline,
    count: usize,
    shown: usize,
    seed: u64,
    goes_on: &(dyn Fn() -> bool + Sync),
) -> Result<Option<Vec<Root>>, SettingError> {
    hairline.check()?;
    check_count(count)?;
    let bald = || SettingError::new("hair.hairline", "", "leaves almost no scalp for hair: widen it");
    let scalp = Scalp::new(head, hairline);
    if scalp.upto.is_empty() {
        return Err(bald());
    }
    // They depend on the count and the seed only, so that the order is the same whatever part of it is wanted.
    let wanted = count.saturating_mul(CANDIDATES);
    let mut candidates: Vec<Root> = Vec::with_capacity(wanted);
    let mut drawn = 0_u64;
    while candidates.len() < wanted {
        if drawn > (wanted as u64).saturating_mul(TRIES).max(100_000) {
            return Err(bald());
        }
        let batch = (2 * (wanted - candidates.len())).max(1024) as u64;
        let task = |n: u64| {
            let from = drawn + n * DRAWS_A_TASK;
            let draws = from..(from + DRAWS_A_TASK).min(drawn + batch);
            goes_on().then(|| draws.filter_map(|i| scalp.draw(seed, i)).collect())
        };
        let found = (0..batch.div_ceil(DRAWS_A_TASK)).into_par_iter().map(task).collect::<Option<Vec<Vec<Root>>>>();
        let Some(found) = found else { return Ok(None) };
        candidates.extend(found.into_iter().flatten().take(wanted - candidates.len()));
        drawn += batch;
    }
    let places: Vec<Vec3> = candidates.iter().map(|root| root.position).collect();
    let Some(chosen) = evenly_while(&places, count.min(shown), &|| goes_on()) else { return Ok(None) };
    Ok(Some(chosen.into_par_iter().map(|i| onto_sampled_skin(head, candidates[i])).collect()))
}

/// The same root where the sampled distance is zero, some hundredths of a millimetre from the triangle: so that no
/// root lies inside the head by the measure that the groom goes by.
fn onto_sampled_skin(head: &Head, root: Root) -> Root {
    let mut position = root.position;
    for _ in 0..3 {
        position -= head.distance(position) * root.normal;
    }
    Root { position, ..root }
}

/// The triangles that may bear hair, and how to draw from them.
struct Scalp<'a> {
    head: &'a Head,
    hairline: &'a Hairline,
    normals: Vec<Vec3>,
    /// Numbers of the head's triangles.
    triangles: Vec<usize>,
    /// Area of the triangles up to and including each.
    upto: Vec<f64>,
}

impl<'a> Scalp<'a> {
    fn new(head: &'a Head, hairline: &'a Hairline) -> Self {
        let normals = head.mesh.vertex_normals();
        let mut scalp = Self { head, hairline, normals, triangles: vec![], upto: vec![] };
        let near = head.ellipsoid.scaled(1.6);
        let may_grow: Vec<bool> = (head.mesh.positions.par_iter().zip(&scalp.normals))
            .map(|(&p, &normal)| {
                near.value(p) < 0.0 && hairline.above(&head.ellipsoid, p) > -BELOW && scalp.is_skull(p, normal)
            })
            .collect();
        let large = LARGE * head.ellipsoid.half_axes.element_sum() / 3.0;
        let mut sum = 0.0;
        for (t, &triangle) in head.mesh.triangles.iter().enumerate() {
            let [a, b, c] = triangle.map(|v| head.mesh.positions[v as usize]);
            let extent = a.max(b).max(c) - a.min(b).min(c);
            let any = |test: &dyn Fn(u32) -> bool| triangle.iter().any(|&v| test(v));
            let wanted = any(&|v| may_grow[v as usize])
                || extent.max_element() > large && any(&|v| near.value(head.mesh.positions[v as usize]) < 0.0);
            let area = f64::from((b - a).cross(c - a).length());
            if area > 0.0 && wanted {
                sum += area;
                scalp.triangles.push(t);
                scalp.upto.push(sum);
            }
        }
        scalp
    }

    /// The `i`-th draw of the seed: a place uniform over the triangles' area, kept if hair grows there.
    fn draw(&self, seed: u64, i: u64) -> Option<Root> {
        let mut state = seed.wrapping_mul(0xD134_2543_DE82_EF95) ^ i.wrapping_mul(GOLDEN_GAMMA);
        let mut uniform = || {
            state = state.wrapping_add(GOLDEN_GAMMA);
            unit(finalise(state))
        };
        let area = uniform() * self.upto[self.upto.len() - 1];
        let t = self.triangles[self.upto.partition_point(|&upto| upto <= area).min(self.upto.len() - 1)];
        let triangle = self.head.mesh.triangles[t];
        let (mut u, mut v, chance) = (uniform() as f32, uniform() as f32, uniform() as f32);
        if u + v > 1.0 {
            (u, v) = (1.0 - u, 1.0 - v);
        }
        let mix = |[a, b, c]: [Vec3; 3]| a + (b - a) * u + (c - a) * v;
        let position = mix(triangle.map(|w| self.head.mesh.positions[w as usize]));
        let normal = mix(triangle.map(|w| self.normals[w as usize])).try_normalize()?;
        let grows = self.hairline.grows(&self.head.ellipsoid, position, chance) && self.is_skull(position, normal);
        grows.then(|| {
            let uv = match &self.head.mesh.corner_uvs {
                Some(uvs) => {
                    let [a, b, c] = uvs[t];
                    a + (b - a) * u + (c - a) * v
                }
                None => self.head.ellipsoid.uv(position),
            };
            let above_hairline = self.hairline.above(&self.head.ellipsoid, position);
            Root { position, normal, uv, above_hairline }
        })
    }

    /// Whether a place of the skin is the skull's outside: turned as E is there, and neither far within E, as the
    /// mouth's inside is, nor beyond E at the side, as the ears are.
    fn is_skull(&self, position: Vec3, normal: Vec3) -> bool {
        let e = &self.head.ellipsoid;
        let q = (position - e.center) / e.half_axes;
        // Below the middle, where E closes, the nape goes straight down.
        let outward = (Vec3::new(q.x, q.y.max(0.0), q.z) / e.half_axes).normalize_or_zero();
        let beyond = q.length() - 1.0;
        let beside = q.z.abs() > 0.75 * q.length() && q.y < 0.35;
        normal.dot(outward) > 0.5 && beyond > -0.25 && beyond < if beside { 0.06 } else { 0.35 }
    }
}

#[cfg(test)]
mod tests;
