//! Laws of the hairstyle as a whole, for every style that is shipped.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{LazyLock, Mutex};

use nabiki::glam::{DVec2, DVec3, Vec2, Vec3};
use nabiki::hair::Attributes;
use nabiki::{Head, Strands};
use nabiki_groom::cantilever::{Beam, Hold, Workspace};
use nabiki_groom::roots::{Root, spread};
use nabiki_groom::style::{Cut, Length, LeverArms, Lift, Region, Stiffness};
use nabiki_groom::{GUIDES, Growth, Hairline, Style, bust, groom, grow, grow_run_while};
use proptest::prelude::*;
use serde::Deserialize;

/// The tables of a scene that concern the groom.
#[derive(Deserialize)]
struct Scene {
    hair: Hair,
}

#[derive(Deserialize)]
struct Hair {
    segments: usize,
    segment_length: f32,
    #[serde(default)]
    hairline: Hairline,
    style: Style,
}

const SCENES: [(&str, &str); 5] = [
    ("gust", include_str!("../../../scenes/paper/gust.toml")),
    ("bob", include_str!("../../../scenes/bob.toml")),
    ("short", include_str!("../../../scenes/short.toml")),
    ("curls", include_str!("../../../scenes/curls.toml")),
    ("ponytail", include_str!("../../../scenes/ponytail.toml")),
];

struct Styled {
    name: &'static str,
    hair: Hair,
    roots: Vec<Root>,
    strands: Strands,
}

static HEAD: LazyLock<Head> = LazyLock::new(bust);

static STYLES: LazyLock<Vec<Styled>> = LazyLock::new(|| {
    let styled = |(name, text)| {
        let hair = toml::from_str::<Scene>(text).unwrap_or_else(|e| panic!("{name}: {e}")).hair;
        let roots = spread(&HEAD, &hair.hairline, 1500, 5).unwrap();
        let strands = groom(&HEAD, &roots, &hair.style, hair.segments, hair.segment_length, 5).unwrap();
        Styled { name, hair, roots, strands }
    };
    SCENES.into_iter().map(styled).collect()
});

impl Styled {
    fn groom(&self, roots: &[Root], seed: u64) -> Strands {
        groom(&HEAD, roots, &self.hair.style, self.hair.segments, self.hair.segment_length, seed).unwrap()
    }
}

fn style_named(name: &str) -> &'static Styled {
    STYLES.iter().find(|styled| styled.name == name).unwrap()
}

/// A style without chance, without clumps and without a comb: hair leaves along the normal and falls.
fn plain() -> Style {
    let mut style =
        Style { lift_degrees: Lift { top: 90.0, sides: 90.0, back: 90.0, fringe: 90.0 }, ..Style::default() };
    (style.comb.away, style.parting.wobble) = (0.0, 0.0);
    let (variation, clumps) = (&mut style.variation, &mut style.clumps);
    (variation.length, variation.stiffness, variation.direction_degrees, variation.cut) = (0.0, 0.0, 0.0, 0.0);
    (clumps.gather, clumps.direction_degrees, clumps.wave) = (0.0, 0.0, 0.0);
    style
}

/// A node keeps `volume.gap` from the skin as the distance is sampled; the roots lie on the skin, as the roots do.
/// So do the middles of segments. Rounding a node to f32 moves it by less than 2e-6 cm, its distance by no more.
#[test]
fn no_node_lies_inside_the_head() {
    for Styled { name, strands, .. } in STYLES.iter() {
        for strand in strands.iter() {
            assert!(HEAD.distance(strand[0]) > -1e-3, "{name}: root {} in the skin", strand[0]);
            for &p in &strand[1..] {
                assert!(HEAD.distance(p) > 0.0, "{name}: {p} lies {} cm deep", -HEAD.distance(p));
            }
            for pair in strand.windows(2) {
                let middle = pair[0].midpoint(pair[1]);
                assert!(HEAD.distance(middle) > -1e-3, "{name}: {middle} lies {} cm deep", -HEAD.distance(middle));
            }
        }
    }
}

/// Nodes are computed in f64 and stored in f32: 30 cm from the origin they are 2^-19 cm apart, and the length of a
/// segment errs by at most sqrt(3) of that.
#[test]
fn segments_of_a_strand_are_equal_to_rounding_and_no_longer_than_asked() {
    for Styled { name, hair, strands, .. } in STYLES.iter() {
        for strand in strands.iter() {
            let lengths: Vec<f32> = strand.windows(2).map(|pair| pair[0].distance(pair[1])).collect();
            assert!((1..=hair.segments).contains(&lengths.len()), "{name}: {} segments", lengths.len());
            for &length in &lengths {
                assert!(length <= hair.segment_length + 4e-6, "{name}: a segment of {length} cm");
                assert!((length - lengths[0]).abs() < 8e-6, "{name}: {lengths:?}");
            }
        }
    }
}

#[test]
fn strand_by_strand_they_start_at_their_roots() {
    for Styled { name, roots, strands, .. } in STYLES.iter() {
        assert_eq!(strands.len(), roots.len());
        for (strand, root) in strands.iter().zip(roots) {
            assert_eq!(strand[0], root.position, "{name}");
        }
    }
}

#[test]
fn same_seed_same_bits_for_any_threads_and_any_subset() {
    for styled in STYLES.iter() {
        let alone = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
        let again = alone.install(|| styled.groom(&styled.roots, 5));
        assert_eq!(styled.strands, again, "{}", styled.name);

        let chosen: Vec<usize> = (0..styled.roots.len()).rev().step_by(7).collect();
        let some: Vec<Root> = chosen.iter().map(|&i| styled.roots[i]).collect();
        assert_eq!(styled.strands.select(&chosen), styled.groom(&some, 5), "{}", styled.name);

        assert_ne!(styled.strands, styled.groom(&styled.roots, 6), "{}: the seed changes nothing", styled.name);
    }
}

#[test]
fn the_first_strands_of_the_whole_grow_alone_to_the_bit() {
    for Styled { name, hair, .. } in STYLES.iter() {
        let Hair { segments, segment_length, hairline, style } = hair;
        let growth =
            Growth { hairline, style, strands: 1200, segments: *segments, segment_length: *segment_length, seed: 9 };
        let whole = grow(&HEAD, &growth, 1200).unwrap();
        for shown in [0, 1, 300, 1200] {
            let first: Vec<usize> = (0..shown).collect();
            assert_eq!(grow(&HEAD, &growth, shown).unwrap(), whole.select(&first), "{name}: {shown} of 1200");
        }
        assert_eq!(grow(&HEAD, &growth, 5000).unwrap(), whole, "{name}: there are no more than all");
    }
}

#[test]
fn growth_is_given_up_when_it_is_told_to_be_and_is_the_same_otherwise() {
    let bob = style_named("bob");
    let Hair { segments, segment_length, hairline, style } = &bob.hair;
    let growth =
        Growth { hairline, style, strands: 1500, segments: *segments, segment_length: *segment_length, seed: 5 };
    let roots = spread(&HEAD, hairline, 1500, 5).unwrap();
    let told = Mutex::new(Vec::new());
    let grown = grow_run_while(&HEAD, &growth, &roots, 0, &|part| {
        told.lock().unwrap().push(part);
        true
    });
    assert_eq!(grown.unwrap(), Some(grow(&HEAD, &growth, 1500).unwrap()));
    let told = told.into_inner().unwrap();
    assert!(told.iter().all(|part| (0.0..1.0).contains(part)) && told.iter().any(|&part| part > 0.5), "{told:?}");
    // One thread asks before each stretch, and no more once it was told not to go on.
    let alone = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    let asked = AtomicUsize::new(0);
    let few = |_| asked.fetch_add(1, Ordering::Relaxed) < 2;
    assert_eq!(alone.install(|| grow_run_while(&HEAD, &growth, &roots, 0, &few)).unwrap(), None);
    assert!(asked.into_inner() < told.len() / 2, "it goes on to the end");
}

#[test]
fn grown_hair_carries_what_grooms_carry() {
    let bob = style_named("bob");
    let Hair { segments, segment_length, hairline, style } = &bob.hair;
    let growth =
        Growth { hairline, style, strands: 1500, segments: *segments, segment_length: *segment_length, seed: 5 };
    let hair = grow(&HEAD, &growth, 1500).unwrap();
    hair.check_lengths().unwrap();
    let Attributes { id, root_uv, group, group_names, guide, .. } = hair.attributes;
    assert_eq!(id.unwrap(), (0..1500).collect::<Vec<i64>>());
    let guide = guide.unwrap();
    assert!(guide[..GUIDES].iter().all(|&guide| guide) && !guide[GUIDES..].iter().any(|&guide| guide));
    for ((strand, uv), group) in hair.strands.iter().zip(root_uv.unwrap()).zip(group.unwrap()) {
        assert!(uv.iter().all(|share| (0.0..=1.0).contains(share)), "{uv:?}");
        // u is 1/2 at the front and runs toward +z.
        assert_eq!(uv[0] > 0.5, strand[0].z > 0.0, "{uv:?} at {}", strand[0]);
        let in_fringe = strand[0].z.abs() < style.fringe.half_width && strand[0].x > style.fringe.from;
        match group_names[&group].as_str() {
            "top" => assert!(strand[0].y > 0.45 * 11.0, "{}", strand[0]),
            "sides" => assert!(strand[0].x > -0.3 * 9.5, "{}", strand[0]),
            "back" => assert!(strand[0].x < 0.1 * 9.5, "{}", strand[0]),
            "fringe" => {}
            other => panic!("{other}"),
        }
        assert!(!in_fringe || group_names[&group] == "fringe", "{}", strand[0]);
    }
}

#[test]
fn hair_is_finite_and_within_its_length_of_the_root() {
    for Styled { name, strands, .. } in STYLES.iter() {
        for strand in strands.iter() {
            let length: f32 = strand.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
            for p in strand {
                assert!(p.is_finite() && p.distance(strand[0]) <= length * 1.0001, "{name}: {p}");
            }
        }
    }
}

/// Away from the head nothing touches the strand, and it must be the settled cantilever: up to the tolerance that a
/// groom settles to, 5e-5 rad over 18 cm, and rounding to f32.
#[test]
fn a_strand_off_the_head_is_the_cantilever() {
    let style = plain();
    for normal in [Vec3::X, Vec3::new(0.6, 0.8, 0.0), Vec3::new(0.0, -0.6, 0.8)] {
        let root = Root { position: Vec3::new(60.0, 40.0, -50.0), normal, uv: Vec2::ZERO, above_hairline: 1.0 };
        let strands = groom(&HEAD, &[root], &style, 18, 1.0, 1).unwrap();
        let beam = Beam { stiffness: 8.0, segment: 1.0, clamp: normal.as_dvec3().normalize(), hold: Hold::Clamped };
        let mut directions = Vec::new();
        beam.settle(&[DVec3::NEG_Y; 18], 1e-12, false, &mut directions, &mut Workspace::default());
        let mut p = root.position.as_dvec3();
        for (i, direction) in directions.iter().enumerate() {
            p += *direction;
            assert!((p - strands.strand(0)[i + 1].as_dvec3()).length() < 1e-3, "node {} from {normal}", i + 1);
        }
    }
}

/// The same of a fringe, under its comb: forward along x, aside along z, both down to 1/e over the comb's decay.
#[test]
fn a_fringe_off_the_head_is_the_cantilever_under_its_comb() {
    let mut style = plain();
    style.length = Length { top: 18.0, sides: 18.0, back: 18.0, fringe: 18.0 };
    style.stiffness = Stiffness { top: 2.0, sides: 2.0, back: 2.0, fringe: 2.0 };
    (style.fringe.half_width, style.fringe.forward) = (1.0, 1.5);
    let root = Root { position: Vec3::new(60.0, 40.0, 0.5), normal: Vec3::X, uv: Vec2::ZERO, above_hairline: 1.0 };
    for (aside, decay) in [(-0.8, 3.0), (0.8, 6.0), (0.0, 6.0)] {
        (style.fringe.aside, style.comb.decay) = (aside, decay);
        let strands = groom(&HEAD, &[root], &style, 18, 1.0, 1).unwrap();
        let beam = Beam { stiffness: 8.0, segment: 1.0, clamp: DVec3::X, hold: Hold::Clamped };
        let comb = DVec3::new(1.5, 0.0, f64::from(aside));
        let load = |i: usize| DVec3::NEG_Y + comb * (-(i as f64 + 0.5) / f64::from(decay)).exp();
        let mut directions = Vec::new();
        let loads: Vec<DVec3> = (0..18).map(load).collect();
        beam.settle(&loads, 1e-12, false, &mut directions, &mut Workspace::default());
        let mut p = root.position.as_dvec3();
        for (i, direction) in directions.iter().enumerate() {
            p += *direction;
            let node = strands.strand(0)[i + 1].as_dvec3();
            assert!((p - node).length() < 1e-3, "node {} aside by {aside}: {node}, not {p}", i + 1);
        }
    }
}

/// Straight hair of a clump hangs toward the clump's middle: of what its roots are apart its tips keep 1 - gather, and what they do not
/// come along near the root, where the clamp holds them: gather times sqrt(E I / w L) / L.
#[test]
fn the_tips_of_a_clump_draw_together() {
    let (length, d, gather) = (18.0_f32, 0.3, 0.8);
    let mut style = plain();
    style.length = Length { top: length, sides: length, back: length, fringe: length };
    style.stiffness = Stiffness { top: 2.0, sides: 2.0, back: 2.0, fringe: 2.0 };
    (style.clumps.gather, style.clumps.size) = (gather, 1.2);
    let place = |i: usize| Vec3::new(60.0, 40.0, -50.0) + Vec3::new(0.03, 0.0, 0.04) * i as f32;
    let root = |position| Root { position, normal: Vec3::NEG_Y, uv: Vec2::ZERO, above_hairline: 1.0 };
    let roots: Vec<Root> = (0..60).map(place).map(root).collect();
    let strands = groom(&HEAD, &roots, &style, 60, d, 1).unwrap();
    let tip = |i: usize| strands.strand(i)[60];
    let kept = (0..59).filter(|&i| {
        let share = tip(i).distance(tip(i + 1)) / place(i).distance(place(i + 1));
        let expected = 1.0 - gather * (1.0 - (8.0 / length).sqrt() / length);
        // The tension falls along the hair, and segments are straight: each of the order of d and of the clamp's reach over the length.
        (share - expected).abs() < gather * (d + (8.0 / length).sqrt()) / length
    });
    // Neighbours on the two sides of a border go apart: 3 cm cross cells of 1.2 cm and their neighbours' borders eight times at the most.
    let kept = kept.count();
    assert!(kept >= 51, "{kept} of 59 neighbours");
}

/// Hair that hangs swings to its sides in waves of the length and of about the height that are asked for, more and more over the first;
/// each clump is at another place of its waves.
#[test]
fn waves_have_their_length_and_height_begin_at_the_root_and_differ_from_clump_to_clump() {
    let (d, length, height, wave_length) = (0.25_f32, 18.0_f32, 0.3_f32, 4.0_f32);
    let mut style = plain();
    style.length = Length { top: length, sides: length, back: length, fringe: length };
    (style.clumps.wave, style.clumps.wave_length, style.clumps.size) = (height, wave_length, 1.0);
    // Two roots of a clump, as a rule, and the next pair in another.
    let place = |i: usize| Vec3::new(60.0, 40.0, -50.0) + Vec3::X * (3.0 * (i / 2) as f32 + 0.01 * (i % 2) as f32);
    let root = |i: usize| Root { position: place(i), normal: Vec3::NEG_Y, uv: Vec2::ZERO, above_hairline: 1.0 };
    let roots: Vec<Root> = (0..80).map(root).collect();
    let strands = groom(&HEAD, &roots, &style, 72, d, 1).unwrap();
    let per_wave = (wave_length / d) as usize;
    let angle = |i: f64| std::f64::consts::TAU * (i + 0.5) / per_wave as f64;
    // Each strand's own waves are up to a fifth higher; those of a clump lean from across, too.
    let steepest = 1.2 * std::f64::consts::TAU * f64::from(height / wave_length);
    let (mut phases, mut alike) = (DVec2::ZERO, 0.0);
    let slopes = |strand: &[Vec3]| -> Vec<DVec3> {
        let segments = strand.windows(2).map(|w| (w[1] - w[0]).as_dvec3());
        segments.map(|segment| segment.with_y(0.0) / -segment.y).collect()
    };
    let all: Vec<Vec<DVec3>> = strands.iter().map(slopes).collect();
    for (s, slopes) in all.iter().enumerate() {
        for (i, slope) in slopes[..4 * per_wave].iter().enumerate() {
            let most = steepest * ((i as f64 + 0.5) / per_wave as f64).min(1.0);
            // Points of 80 cm are rounded to 4e-6 cm, segments are 0.25 cm long and up to 40 degrees aslant.
            assert!(slope.length() < most / (1.0 - most) + 1e-4, "strand {s}, segment {i}: {slope}");
            if i >= per_wave && i < 3 * per_wave {
                let next = slopes[i + per_wave];
                assert!(slope.distance(next) < 1e-4, "strand {s}, segment {i}: {slope}, and a wave later {next}");
            }
        }
        // Where it goes over to the other side it is a quarter of a wave from its steepest: which side comes first is not to be seen.
        let turns = (per_wave..2 * per_wave).find(|&i| slopes[i].dot(slopes[i + 1]) <= 0.0).unwrap();
        let [before, after] = [turns, turns + 1].map(|i| slopes[i].length());
        let phase = 0.25 * std::f64::consts::TAU - angle(turns as f64 + before / (before + after));
        phases += DVec2::from_angle(2.0 * phase) / all.len() as f64;
    }
    for pair in all.chunks(2) {
        let product =
            |a: &[DVec3], b: &[DVec3]| -> f64 { (per_wave..3 * per_wave).map(|i| a[i].dot(b[i])).sum::<f64>() };
        let [a, b] = pair else { unreachable!() };
        alike += product(a, b) / (product(a, a) * product(b, b)).sqrt() / (all.len() / 2) as f64;
    }
    // Of 40 clumps the mean of directions of any angle is 1 / sqrt(40) long, and one in 8000 is three times as long (e^-9).
    assert!(phases.length() < 3.0 / 40.0_f64.sqrt(), "{phases} is the mean of all phases");
    // A strand's own chance deviates by half a radian: of two of a clump the cosine between is e^-1/4 in the mean, and a few pairs are none.
    assert!(alike > 0.5, "{alike} of their waves the two of a clump have alike");
}

/// Trimming stops within 0.01 cm of the plane; a strand that the cut would leave shorter than `shortest` may pass it.
#[test]
fn a_cut_takes_off_what_lies_beyond_its_plane() {
    let mut style = plain();
    let (point, normal) = (Vec3::new(0.0, -4.0, 0.0), Vec3::new(0.0, -2.0, 0.5));
    style.cuts.push(Cut { point, normal, region: None, shortest: 2.5 });
    let roots = &style_named("gust").roots;
    let strands = groom(&HEAD, roots, &style, 18, 1.0, 1).unwrap();
    let (mut ends_there, mut short) = (0, 0);
    for strand in strands.iter() {
        let length: f32 = strand.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
        let beyond = |p: Vec3| (p - point).dot(normal.normalize());
        let most = strand.iter().map(|&p| beyond(p)).fold(f32::NEG_INFINITY, f32::max);
        if length < 2.5001 {
            short += 1;
        } else {
            assert!(most < 0.011, "a strand of {length} cm passes the plane by {most} cm");
        }
        ends_there += usize::from(beyond(strand[strand.len() - 1]).abs() < 0.011);
    }
    assert!(2 * ends_there > strands.len(), "only {ends_there} of {} end on the plane", strands.len());
    assert!(short < strands.len() / 4, "{short} strands are left short");

    style.cuts[0].region = Some(Region::Fringe);
    let uncut = groom(&HEAD, roots, &style, 18, 1.0, 1).unwrap();
    assert_eq!(uncut.segment_count(), 18 * roots.len(), "a cut of the fringe cut something else");
}

#[test]
fn a_strand_has_the_fewest_segments_not_longer_than_asked() {
    let mut style = plain();
    for (length, segment, expected) in [(18.0, 1.0, 18), (17.3, 1.0, 18), (6.0, 0.5, 12), (0.7, 1.0, 1), (0.3, 0.1, 3)]
    {
        style.length = Length { top: length, sides: length, back: length, fringe: length };
        let strands = groom(&HEAD, &style_named("gust").roots[..40], &style, 18, segment, 1).unwrap();
        for strand in strands.iter() {
            assert_eq!(strand.len() - 1, expected, "{length} cm in segments of {segment} cm");
        }
    }
}

/// Where they pass the side of the head, hair from the parting lies farther out than hair from the side itself.
#[test]
fn upper_hair_lies_over_lower_hair() {
    let (mut upper, mut lower) = (Vec::new(), Vec::new());
    for strand in style_named("gust").strands.iter() {
        for p in &strand[1..] {
            if (2.0..5.0).contains(&p.y) && p.z.abs() > 5.0 {
                match strand[0].y {
                    y if y > 9.0 => upper.push(HEAD.distance(*p)),
                    y if y < 6.0 => lower.push(HEAD.distance(*p)),
                    _ => {}
                }
            }
        }
    }
    let mean = |d: &[f32]| d.iter().sum::<f32>() / d.len() as f32;
    assert!(upper.len() > 100 && lower.len() > 100, "{} and {} nodes", upper.len(), lower.len());
    assert!(mean(&upper) > 1.5 * mean(&lower), "{} cm over {} cm", mean(&upper), mean(&lower));
}

/// Between the eyes and the mouth; the nose stands out from there. One node in a thousand may be a stray hair's.
#[test]
fn no_hair_falls_over_the_face() {
    for Styled { name, strands, .. } in STYLES.iter() {
        let over_face = |p: &&Vec3| p.x > 7.0 && p.z.abs() < 2.5 && (-9.0..0.5).contains(&p.y);
        let found = strands.points().iter().filter(over_face).count();
        assert!(found * 1000 <= strands.points().len(), "{name}: {found} nodes before the face");
    }
}

/// Roots are drawn evenly and by chance: the mean side of n nodes strays by about its deviation over the root of the
/// number of strands (nodes of one strand stray together); four times that is allowed.
#[test]
fn styles_with_a_middle_parting_are_balanced() {
    for name in ["gust", "bob"] {
        let strands = &style_named(name).strands;
        let n = strands.points().len() as f32;
        let mean = strands.points().iter().map(|p| p.z).sum::<f32>() / n;
        let deviation = (strands.points().iter().map(|p| p.z * p.z).sum::<f32>() / n).sqrt();
        assert!(mean.abs() < 4.0 * deviation / (strands.len() as f32).sqrt(), "{name}: mean z {mean} cm");
    }
}

#[test]
fn what_cannot_be_styled_is_refused_by_its_key() {
    let cases: [(&str, &str); 12] = [
        ("stiffness = { top = 0.0 }", "hair.style.stiffness.top"),
        ("stiffness = { back = nan }", "hair.style.stiffness.back"),
        ("length = { sides = -3.0 }", "hair.style.length.sides"),
        ("lift_degrees = { top = 91.0 }", "hair.style.lift_degrees.top"),
        ("parting = { front = [inf, 0.0] }", "hair.style.parting.front"),
        ("comb = { decay = 0.0 }", "hair.style.comb.decay"),
        ("comb = { sweep = [0.0, nan, 0.0] }", "hair.style.comb.sweep"),
        ("volume = { thickness = -1.0 }", "hair.style.volume.thickness"),
        ("variation = { length = 1.0 }", "hair.style.variation.length"),
        ("clumps = { wave = 4.0, wave_length = 8.0 }", "hair.style.clumps.wave"),
        ("cuts = [{ point = [0, 0, 0], normal = [0, 0, 0] }]", "hair.style.cuts[0].normal"),
        ("length = { top = 18.5 }", "hair.style.length.top"),
    ];
    for (text, thing) in cases {
        let style: Style = toml::from_str(text).unwrap_or_else(|e| panic!("{text}: {e}"));
        let error = groom(&HEAD, &[], &style, 18, 1.0, 1).expect_err(text);
        assert_eq!(error.thing, thing, "{text}: {error}");
    }
    assert!(toml::from_str::<Style>("stifness = { top = 1.0 }").is_err());
    for (segments, length, thing) in [(0, 1.0, "hair.segments"), (18, 0.0, "hair.segment_length")] {
        assert_eq!(groom(&HEAD, &[], &Style::default(), segments, length, 1).unwrap_err().thing, thing);
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, failure_persistence: None, ..ProptestConfig::default() })]

    /// Whatever passes the check gives hair: finite, its segments equal, its nodes out of the head.
    #[test]
    fn any_style_that_passes_the_check_grows(
        stiffness in -1.0..2.0f32, lift in 0.0..=90.0f32, length in 0.5..40.0f32, segment in 0.2..3.0f32,
        away in 0.0..100.0f32, sweep in prop::array::uniform3(-50.0..50.0f32), decay in 0.1..20.0f32,
        thickness in 0.0..4.0f32, wave in 0.0..0.16f32, direction in 0.0..45.0f32, level in -12.0..8.0f32,
        straight in any::<bool>(),
    ) {
        let mut style = Style::default();
        let bend = 10f32.powf(stiffness);
        style.stiffness = Stiffness { top: bend, sides: bend, back: bend, fringe: bend };
        style.lift_degrees = Lift { top: lift, sides: lift, back: lift, fringe: lift };
        style.length = Length { top: length, sides: length, back: length, fringe: length };
        (style.comb.away, style.comb.sweep, style.comb.decay) = (away, Vec3::from(sweep), decay);
        style.fringe.half_width = 4.0;
        style.volume.thickness = thickness;
        style.clumps.wave = wave * style.clumps.wave_length;
        style.variation.direction_degrees = direction;
        style.lever_arms = if straight { LeverArms::Straight } else { LeverArms::Deformed };
        style.cuts.push(Cut { point: Vec3::Y * level, normal: Vec3::NEG_Y, region: None, shortest: 1.0 });
        let roots = &style_named("gust").roots[..40];
        let strands = groom(&HEAD, roots, &style, 200, segment, 3).unwrap();
        for strand in strands.iter() {
            let d = strand[0].distance(strand[1]);
            for pair in strand.windows(2) {
                prop_assert!(pair[1].is_finite());
                prop_assert!((pair[0].distance(pair[1]) - d).abs() < 2e-5, "{} and {}", pair[0].distance(pair[1]), d);
                prop_assert!(HEAD.distance(pair[1]) > 0.0, "{} lies {} cm deep", pair[1], -HEAD.distance(pair[1]));
            }
        }
    }
}

#[test]
fn baby_hair_grows_on_the_hairline_alone_and_leaves_all_other_hair_as_it_was() {
    let gust = style_named("gust");
    let mut style = gust.hair.style.clone();
    style.variation.baby_hair = 0.8;
    let with = groom(&HEAD, &gust.roots, &style, gust.hair.segments, gust.hair.segment_length, 5).unwrap();
    let length = |strand: &[Vec3]| strand.windows(2).map(|pair| pair[0].distance(pair[1])).sum::<f32>();
    let mut shortest = f32::INFINITY;
    for ((root, before), after) in gust.roots.iter().zip(gust.strands.iter()).zip(with.iter()) {
        if root.above_hairline >= 0.2 {
            assert_eq!(before, after);
        }
        // Cuts and draping may take as much from either; what is left of the longest is a fifth at least.
        shortest = shortest.min(length(after) / style.length.sides);
    }
    assert!((0.2..0.5).contains(&shortest), "{shortest}");
    assert_ne!(with, gust.strands);
}
