use std::sync::LazyLock;
use std::sync::atomic::{AtomicUsize, Ordering};

use nabiki::Head;
use nabiki::glam::{Vec2, Vec3};

use super::{Hairline, MOST, Root, spread, spread_first, spread_first_while};
use crate::bust;

static BUST: LazyLock<Head> = LazyLock::new(bust);

fn roots(count: usize, seed: u64) -> Vec<Root> {
    spread(&BUST, &Hairline::default(), count, seed).unwrap()
}

/// The scalp's area (cm2) by counting what share of all triangles' area bears hair.
fn scalp_area() -> f32 {
    let hairline = Hairline::default();
    let mesh = &BUST.mesh;
    (mesh.triangles.iter())
        .map(|t| t.map(|v| mesh.positions[v as usize]))
        .filter(|[a, b, c]| hairline.above(&BUST.ellipsoid, (*a + *b + *c) / 3.0) > 0.0)
        .map(|[a, b, c]| 0.5 * (b - a).cross(c - a).length())
        .sum()
}

fn nearest_spacings(roots: &[Root]) -> Vec<f32> {
    roots
        .iter()
        .enumerate()
        .map(|(i, p)| {
            let others = roots.iter().enumerate().filter(|(j, _)| *j != i);
            others.map(|(_, q)| p.position.distance_squared(q.position)).fold(f32::INFINITY, f32::min).sqrt()
        })
        .collect()
}

#[test]
fn roots_lie_on_the_skin_and_point_out_of_it() {
    for root in roots(2000, 1) {
        assert!(BUST.distance(root.position).abs() < 1e-3);
        assert!((root.normal.length() - 1.0).abs() < 1e-5);
        assert!(BUST.outward(root.position).dot(root.normal) > 0.95);
    }
}

#[test]
fn more_roots_than_their_candidates_can_be_counted_are_refused_by_name() {
    let refused = spread_first(&BUST, &Hairline::default(), MOST + 1, 1, 1).unwrap_err();
    assert_eq!(refused.to_string(), "hair.strands = 800000001: must be at most 800000000: grow fewer");
}

#[test]
fn the_same_seed_gives_the_same_roots_and_another_gives_others() {
    let (first, other) = (roots(500, 7), roots(500, 8));
    assert_eq!(first, roots(500, 7));
    assert!(first.iter().zip(&other).filter(|(a, b)| a == b).count() < 5);
    let one_thread = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    assert_eq!(first, one_thread.install(|| roots(500, 7)));
}

// n points that keep the distance r on an area A cannot do better than the hexagonal lattice, r^2 = 2 A / (sqrt(3) n).
// Poisson discs drawn at random come to 0.7 of that r, the farthest of five candidates a root to a little more; points
// thrown independently to nothing.
#[test]
fn every_beginning_of_the_order_is_blue_noise() {
    let all = roots(3000, 3);
    let area = scalp_area();
    for n in [50, 300, 1000, 3000] {
        let spacings = nearest_spacings(&all[..n]);
        let hexagonal = (2.0 * area / (3.0_f32.sqrt() * n as f32)).sqrt();
        let least = spacings.iter().copied().fold(f32::INFINITY, f32::min) / hexagonal;
        let mean = spacings.iter().sum::<f32>() / n as f32 / hexagonal;
        println!("{n}: least {least}, mean {mean}");
        assert!((0.6..1.0).contains(&least), "{n} roots: least spacing {least} of the hexagonal");
        assert!(mean > 0.7, "{n} roots: mean spacing {mean} of the hexagonal");
    }
}

#[test]
fn face_ears_and_nape_are_free() {
    for Root { position: p, .. } in roots(5000, 2) {
        let on_face = p.x > 4.5 && p.y < 5.0 && p.z.abs() < 5.5;
        let on_ear = p.z.abs() > 8.05 || (p.x > -3.0 && p.x < 0.0 && p.y < 0.8);
        assert!(!on_face && !on_ear && p.y > -8.0, "{p}");
    }
}

#[test]
fn hair_grows_over_the_forehead_at_the_back_and_before_the_ears() {
    let all = roots(5000, 2);
    let any = |test: &dyn Fn(Vec3) -> bool| all.iter().any(|p| test(p.position));
    assert!(any(&|p| p.x > 7.0 && p.z.abs() < 1.0));
    assert!(any(&|p| p.x < -6.0 && p.y < -6.0));
    assert!(any(&|p| p.x > 0.5 && p.y < 0.0 && p.z > 5.0));
    assert!(any(&|p| p.x > 0.5 && p.y < 0.0 && p.z < -5.0));
    assert!(any(&|p| p.y > 10.5));
}

// Left and right of the parting differ by a boundary effect only: roots within half a spacing of the middle, which is
// 20 cm long and 0.3 cm wide of 600 cm2.
#[test]
fn both_sides_get_the_same_share() {
    let all = roots(4000, 11);
    let right = all.iter().filter(|p| p.position.z > 0.0).count() as f32 / all.len() as f32;
    assert!((right - 0.5).abs() < 0.01, "{right}");
}

/// As many roots, but for the same effect, where the same skin is cut into sixteen times as many triangles.
#[test]
fn roots_are_spread_by_area_and_not_by_triangles() {
    let mut head = BUST.clone();
    for _ in 0..2 {
        let mesh = &mut head.mesh;
        for [a, b, c] in std::mem::take(&mut mesh.triangles) {
            let [p, q, r] = [a, b, c].map(|v| mesh.positions[v as usize]);
            if p.z + q.z + r.z < 0.0 {
                mesh.triangles.push([a, b, c]);
                continue;
            }
            let [d, e, f] = [0, 1, 2].map(|i| mesh.positions.len() as u32 + i);
            mesh.positions.extend([p.midpoint(q), q.midpoint(r), r.midpoint(p)]);
            mesh.triangles.extend([[a, d, f], [d, b, e], [f, e, c], [d, e, f]]);
        }
    }
    let all = spread(&head, &Hairline::default(), 2000, 11).unwrap();
    let right = all.iter().filter(|p| p.position.z > 0.0).count() as f32 / all.len() as f32;
    assert!((right - 0.5).abs() < 0.014, "{right}");
}

#[test]
fn no_hair_grows_on_the_ears_however_low_the_line_runs_about_them() {
    let low = Hairline { above_ears: 1.45, ..Hairline::default() };
    let all = spread(&BUST, &low, 4000, 2).unwrap();
    let farthest = all.iter().map(|root| root.position.z.abs()).fold(0.0, f32::max);
    // The skull is widest above the ears, at 8 cm; they stand out beside it.
    assert!(farthest < 8.3, "{farthest}");
    assert!(all.iter().any(|root| root.position.y < -1.0 && (-3.0..1.0).contains(&root.position.x)), "it runs low");
}

#[test]
fn the_line_rises_over_the_temples_and_passes_through_its_settings() {
    let line = Hairline::default();
    assert_eq!(line.depth(0.0), line.forehead);
    assert!(line.depth(0.61) < line.forehead);
    assert!((line.depth(1.35) - line.sideburns).abs() < 1e-6);
    assert!((line.depth(1.75) - line.above_ears).abs() < 1e-6);
    assert!((line.depth(3.0) - line.nape).abs() < 1e-6);
    for i in 0..314 {
        let step = line.depth(0.01 * (i + 1) as f32) - line.depth(0.01 * i as f32);
        assert!(step.abs() < 0.1, "no jump at {}", 0.01 * i as f32);
    }
}

#[test]
fn behind_the_ears_the_line_comes_down_so_much_farther_forward() {
    let line = Hairline::default();
    let forward = 0.25;
    let moved = Hairline { behind_ears: forward, ..line.clone() };
    for i in 0..=314 {
        let around = 0.01 * i as f32;
        let depth = moved.depth(around);
        if around <= 1.62 {
            assert_eq!(depth, line.depth(around), "over the ears and before them nothing changes");
        } else if around < 2.72 - forward {
            assert!((depth - line.depth((around + forward).max(1.88))).abs() < 1e-5, "at {around}");
        } else {
            assert!((depth - line.nape).abs() < 1e-5, "at {around}");
        }
    }
}

#[test]
fn settings_off_the_head_are_refused_by_name() {
    let refused = |hairline: Hairline| spread(&BUST, &hairline, 10, 1).unwrap_err().to_string();
    let text = refused(Hairline { forehead: f32::NAN, ..Hairline::default() });
    assert!(text.starts_with("hair.hairline.forehead = NaN"), "{text}");
    let text = refused(Hairline { nape: 9.0, ..Hairline::default() });
    assert!(text.starts_with("hair.hairline.nape = 9"), "{text}");
    let bald = Hairline { forehead: 0.0, sideburns: 0.0, above_ears: 0.0, nape: 0.0, fade: 1.0, ..Hairline::default() };
    assert!(refused(bald).starts_with("hair.hairline leaves almost no scalp"));
}

#[test]
fn no_roots_are_no_trouble() {
    assert!(roots(0, 1).is_empty());
    assert_eq!(roots(1, 1).len(), 1);
}

// Candidates depend on the count alone, and the order of choice on the candidates.
#[test]
fn the_first_of_the_whole_are_the_first_alone() {
    let (all, line) = (roots(3000, 4), Hairline::default());
    for shown in [0, 1, 300, 3000, 9000] {
        let first = spread_first(&BUST, &line, 3000, shown, 4).unwrap();
        assert_eq!(first, all[..shown.min(3000)], "{shown} of 3000");
    }
}

#[test]
fn roots_that_are_wanted_no_more_are_given_up_while_they_are_drawn_and_while_they_are_chosen() {
    let line = Hairline::default();
    // Of 10,000 roots; how often it is asked, where it is to go on so many times.
    let asked = |shown: usize, times: usize| {
        let asked = AtomicUsize::new(0);
        let goes_on = || asked.fetch_add(1, Ordering::Relaxed) < times;
        let roots = spread_first_while(&BUST, &line, 10_000, shown, 4, &goes_on).unwrap();
        (roots, asked.into_inner())
    };
    let (all, times) = asked(10_000, usize::MAX);
    assert_eq!(all, Some(roots(10_000, 4)));
    // To choose one root, every candidate is looked at once: too few to be asked.
    let (_, times_drawn) = asked(1, usize::MAX);
    assert!(times_drawn > 10 && times > times_drawn, "{times_drawn} of {times}");
    for goes_on in [0, 1, times_drawn - 1, times_drawn] {
        let (given_up, asked) = asked(10_000, goes_on);
        // Other threads may be within one draw each.
        assert!(given_up.is_none() && asked <= goes_on + rayon::current_num_threads(), "{asked} for {goes_on}");
    }
}

#[test]
fn texture_coordinates_are_those_of_the_mesh_where_it_has_them() {
    for root in roots(500, 6) {
        assert!((root.uv - BUST.ellipsoid.uv(root.position)).abs().max_element() < 1e-3, "{root:?}");
    }
    // Linear over each triangle, a linear function of the place is met but for rounding and for the step onto the
    // sampled skin.
    let linear = |p: Vec3| Vec2::new(0.02 * p.x + 0.5, 0.01 * p.y - 0.015 * p.z);
    let mut head = bust();
    let at_corners = |t: &[u32; 3]| t.map(|v| linear(head.mesh.positions[v as usize]));
    head.mesh.corner_uvs = Some(head.mesh.triangles.iter().map(at_corners).collect());
    for root in spread(&head, &Hairline::default(), 500, 6).unwrap() {
        assert!((root.uv - linear(root.position)).abs().max_element() < 1e-3, "{root:?}");
    }
}

// Every edge is a seam here: each triangle lies at a place of the texture of its own, named by its number.
#[test]
fn a_root_beside_a_seam_has_the_texture_coordinates_of_its_own_side() {
    let mut head = bust();
    head.mesh.corner_uvs =
        Some((0..head.mesh.triangles.len()).map(|t| [Vec2::new(t as f32, -(t as f32)); 3]).collect());
    for root in spread(&head, &Hairline::default(), 500, 6).unwrap() {
        let t = root.uv.x as usize;
        assert_eq!(root.uv.to_array(), [t as f32, -(t as f32)]);
        let corners = head.mesh.triangles[t].map(|v| head.mesh.positions[v as usize]);
        // The step onto the sampled skin takes some hundredths of a millimetre.
        let [low, high] = nabiki::strands::bounds(&corners);
        let (low, high) = (low - 0.01, high + 0.01);
        assert!(root.position.cmpge(low).all() && root.position.cmple(high).all(), "{root:?} in {corners:?}");
    }
}

#[test]
fn a_hairline_wanders_as_far_as_it_is_told_and_not_where_it_is_told_nothing() {
    let straight = Hairline::default();
    let wandering = Hairline { wander: 0.1, ..Hairline::default() };
    let unit = 0.5 * (BUST.ellipsoid.half_axes.x + BUST.ellipsoid.half_axes.z);
    let (mut low, mut high) = (0.0_f32, 0.0_f32);
    for root in roots(3000, 4) {
        let above = straight.above(&BUST.ellipsoid, root.position);
        // A root was drawn on a triangle, some hundredths of a millimetre from the sampled skin.
        assert!((root.above_hairline - above).abs() * unit < 0.01);
        let off = wandering.above(&BUST.ellipsoid, root.position) - above;
        (low, high) = (low.min(off), high.max(off));
        // It is a line: a millimetre on, it has moved by less than its waves are steep along z, 0.5 17 + 0.3 27 + 0.2 47 a unit.
        let beside = root.position + Vec3::new(0.0, 0.0, 0.1);
        let moved = wandering.above(&BUST.ellipsoid, beside) - straight.above(&BUST.ellipsoid, beside) - off;
        assert!(moved.abs() < 0.1 * 26.0 * 0.1 / unit + 1e-5, "{moved}");
    }
    assert!((-0.1..-0.07).contains(&low) && (0.07..0.1).contains(&high), "{low} {high}");
}
