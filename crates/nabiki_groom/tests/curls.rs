//! Laws of curls: what the groom winds, and about what.

use std::f32::consts::TAU;
use std::sync::LazyLock;

use nabiki::glam::{Vec2, Vec3, Vec3Swizzles};
use nabiki::{Head, Strands};
use nabiki_groom::roots::{Root, spread};
use nabiki_groom::style::{Curl, Length, Lift};
use nabiki_groom::{Hairline, Style, bust, groom};
use proptest::prelude::*;

static HEAD: LazyLock<Head> = LazyLock::new(bust);

/// A curl of chance only in hand and phase, which begins early.
const EVEN: Curl = Curl { radius: 0.6, pitch: 2.5, from: 0.1, flatness: 0.0, gather: 0.0, variation: 0.0, frizz: 0.0 };

/// Coordinates 60 cm from the origin are 2^-18 cm apart, and a step along the line is settled to 1e-9 of it.
const ROUNDING: f32 = 1e-5;

/// A style without chance or comb: hair that leaves downward hangs straight.
fn hanging(curl: Curl, length: f32) -> Style {
    let mut style = Style {
        lift_degrees: Lift { top: 90.0, sides: 90.0, back: 90.0, fringe: 90.0 },
        length: Length { top: length, sides: length, back: length, fringe: length },
        curl,
        ..Style::default()
    };
    (style.comb.away, style.parting.wobble) = (0.0, 0.0);
    let (variation, clumps) = (&mut style.variation, &mut style.clumps);
    (variation.length, variation.stiffness, variation.direction_degrees, variation.cut) = (0.0, 0.0, 0.0, 0.0);
    (clumps.gather, clumps.direction_degrees, clumps.wave) = (0.0, 0.0, 0.0);
    style
}

/// Roots off the head whose hair leaves downward.
fn in_the_air(places: impl IntoIterator<Item = Vec3>) -> Vec<Root> {
    places
        .into_iter()
        .map(|position| Root { position, normal: Vec3::NEG_Y, uv: Vec2::ZERO, above_hairline: 1.0 })
        .collect()
}

fn scattered() -> Vec<Root> {
    in_the_air((0..40).map(|i| Vec3::new(40.0 + 0.31 * i as f32, 30.0, -50.0 + 0.17 * i as f32)))
}

fn length_of(strand: &[Vec3]) -> f32 {
    strand.windows(2).map(|pair| pair[0].distance(pair[1])).sum()
}

/// Distance and angle of a point about the upright line through `middle`.
fn about(p: Vec3, middle: Vec3) -> (f32, f32) {
    let off = Vec2::new(p.x - middle.x, p.z - middle.z);
    (off.length(), off.y.atan2(off.x))
}

/// An angle as the nearest of those that differ from it by whole turns.
fn least(angle: f32) -> f32 {
    angle - TAU * (angle / TAU).round()
}

#[test]
fn hair_without_curls_keeps_its_bits_whatever_the_rest_of_the_table_says() {
    let roots = spread(&HEAD, &Hairline::default(), 200, 5).unwrap();
    let plain = groom(&HEAD, &roots, &Style::default(), 18, 1.0, 5).unwrap();
    let curl = Curl { pitch: 0.3, from: 0.9, flatness: 0.5, gather: 1.0, variation: 0.5, frizz: 0.5, radius: 0.0 };
    let none = Style { curl, ..Style::default() };
    assert_eq!(plain, groom(&HEAD, &roots, &none, 18, 1.0, 5).unwrap());
    let curled = Style { curl: Curl { radius: 0.3, ..EVEN }, ..Style::default() };
    assert_ne!(plain, groom(&HEAD, &roots, &curled, 72, 0.25, 5).unwrap());
}

/// Where the curl is whole every node of hair that hangs straight down is `radius` from its line, and turned from the node
/// before by 2 pi a pitch.
#[test]
fn hanging_hair_winds_to_a_helix_of_its_radius_and_pitch() {
    let (length, d) = (18.0, 0.3);
    let roots = scattered();
    let strands = groom(&HEAD, &roots, &hanging(EVEN, length), 60, d, 1).unwrap();
    let (mut left, mut right) = (0, 0);
    for (strand, root) in strands.iter().zip(&roots) {
        assert_eq!(strand.len(), 61);
        let whole = strand.iter().filter(|p| root.position.y - p.y > EVEN.from * length).collect::<Vec<_>>();
        assert!(whole.len() > 40, "{} nodes", whole.len());
        for pair in whole.windows(2) {
            let [(r, before), (_, after)] = [about(*pair[0], root.position), about(*pair[1], root.position)];
            assert!((r - EVEN.radius).abs() < 10.0 * ROUNDING, "{r}");
            let turned = least(after - before);
            let expected = TAU * (pair[0].y - pair[1].y) / EVEN.pitch;
            assert!((turned.abs() - expected).abs() < 10.0 * ROUNDING / EVEN.radius, "{turned} for {expected}");
            *(if turned > 0.0 { &mut right } else { &mut left }) += 1;
        }
        // sqrt(p^2 + (2 pi r)^2) of hair a pitch of the line; chords of n to the turn are longer by (pi / n)^2 / 6 or less.
        let turn = EVEN.pitch.hypot(TAU * EVEN.radius);
        let (first, last) = (whole[0], whole[whole.len() - 1]);
        let shrunk = (first.y - last.y) / ((whole.len() - 1) as f32 * d);
        let chord = (std::f32::consts::PI * d / turn).powi(2) / 6.0;
        assert!((shrunk * turn / EVEN.pitch - 1.0).abs() < chord, "{shrunk} for {}", EVEN.pitch / turn);
    }
    assert!(left > 100 && right > 100, "hands: {left} and {right}");
}

/// Between hair that is straight and hair that curls, length and number of segments are the same.
#[test]
fn a_strand_that_curls_keeps_its_length_and_segments_and_reaches_less_far() {
    let roots = scattered();
    let curled = groom(&HEAD, &roots, &hanging(EVEN, 18.0), 60, 0.3, 1).unwrap();
    let straight = groom(&HEAD, &roots, &hanging(Curl { radius: 0.0, ..EVEN }, 18.0), 60, 0.3, 1).unwrap();
    for (a, b) in curled.iter().zip(straight.iter()) {
        assert_eq!(a.len(), b.len());
        assert!((length_of(a) - length_of(b)).abs() < 60.0 * ROUNDING);
        assert!(a[60].distance(a[0]) < 0.75 * b[60].distance(b[0]));
    }
}

#[test]
fn flat_curls_wave_in_a_plane() {
    let roots = scattered();
    let strands = groom(&HEAD, &roots, &hanging(Curl { flatness: 1.0, ..EVEN }, 18.0), 60, 0.3, 1).unwrap();
    for (strand, root) in strands.iter().zip(&roots) {
        let far = strand.iter().map(|&p| p - root.position).max_by(|a, b| a.xz().length().total_cmp(&b.xz().length()));
        let far = far.unwrap().xz();
        // A wave of 2.5 cm is met by some node within 0.15 cm of its height.
        assert!((EVEN.radius - far.length()).abs() < EVEN.radius * (TAU * 0.15 / EVEN.pitch).powi(2), "{far}");
        for p in strand {
            let across = (p - root.position).xz().perp_dot(far.normalize());
            assert!(across.abs() < 10.0 * ROUNDING, "{across} cm out of the plane");
        }
    }
}

/// Strands of one clump that hang straight wind about the line of the clump, wherever they are rooted: at one height they
/// are at one place.
#[test]
fn the_hair_of_a_clump_closes_to_one_lock() {
    let mut style = hanging(Curl { gather: 1.0, ..EVEN }, 18.0);
    style.clumps.size = 12.0;
    let middle = Vec3::new(40.0, 30.0, -50.0);
    let roots = in_the_air((0..60).map(|i| middle + Vec3::new(0.0, 0.04, 0.03) * i as f32));
    let strands = groom(&HEAD, &roots, &style, 60, 0.3, 1).unwrap();
    let mut kept = 0;
    for (a, b) in strands.iter().zip(strands.iter().skip(1)) {
        // Two heights between neighbouring nodes of `a`: straight chords there differ by less than their sagitta.
        let sagitta = 0.3 * 0.3 / (8.0 * EVEN.radius);
        let apart = a[30..50].iter().map(|p| nearest(*p, b)).fold(0.0, f32::max);
        kept += usize::from(apart < sagitta + 10.0 * ROUNDING);
    }
    // 2.4 cm of the side of a cell of 12 cm cross the border of a clump three times at the most.
    assert!(kept >= 56, "{kept} of 59 neighbours lie on each other");
}

/// Distance of a point from a polyline.
fn nearest(p: Vec3, line: &[Vec3]) -> f32 {
    let to = |pair: &[Vec3]| {
        let (a, along) = (pair[0], pair[1] - pair[0]);
        let t = ((p - a).dot(along) / along.length_squared()).clamp(0.0, 1.0);
        p.distance(a + along * t)
    };
    line.windows(2).map(to).fold(f32::INFINITY, f32::min)
}

/// What the refusal offers is accepted, and what is a little more refused.
#[test]
fn segments_too_long_for_a_turn_are_refused_with_the_longest_that_will_do() {
    let refused = |curl: Curl, segment: f32| groom(&HEAD, &[], &Style { curl, ..Style::default() }, 1000, segment, 1);
    for curl in [EVEN, Curl { flatness: 1.0, ..EVEN }, Curl { variation: 0.5, frizz: 0.3, pitch: 1.0, ..EVEN }] {
        let error = refused(curl, 1.0).unwrap_err();
        assert_eq!(error.thing, "hair.segment_length");
        let offered = error.remedy.strip_prefix("must be at most ").unwrap().split(':').next().unwrap();
        let longest: f32 = offered.parse().unwrap();
        assert!(refused(curl, longest).is_ok(), "{error}");
        assert!(refused(curl, longest + 0.002).is_err(), "{error}");
    }
}

#[test]
fn curls_out_of_range_are_refused_by_their_key() {
    let cases = [
        ("radius = -0.1", "radius"),
        ("radius = nan", "radius"),
        ("radius = 3.0", "radius"),
        ("pitch = 0.0", "pitch"),
        ("from = 0.0", "from"),
        ("flatness = 1.1", "flatness"),
        ("gather = 2.0", "gather"),
        ("variation = 0.7", "variation"),
        ("frizz = inf", "frizz"),
    ];
    for (text, key) in cases {
        let curl: Curl = toml::from_str(text).unwrap();
        let error = Style { curl, ..Style::default() }.check().expect_err(text);
        assert_eq!(error.thing, format!("hair.style.curl.{key}"), "{text}");
    }
}

/// A cut is made on the line: the tip lies within the radius of the plane, and less than a segment's turn beyond it.
#[test]
fn a_cut_of_curls_ends_within_their_radius_of_the_plane() {
    let mut style = hanging(EVEN, 18.0);
    let level = 24.0;
    let cut = format!("point = [0, {level}, 0]\nnormal = [0, -1, 0]");
    style.cuts.push(toml::from_str(&cut).unwrap());
    let strands = groom(&HEAD, &scattered(), &style, 60, 0.3, 1).unwrap();
    for strand in strands.iter() {
        let tip = strand[strand.len() - 1];
        assert!((tip.y - level).abs() < 0.02, "{tip}");
        assert!(strand.len() < 61);
    }
}

fn clear_of_the_head(strands: &Strands) -> Result<(), TestCaseError> {
    for strand in strands.iter() {
        let d = strand[0].distance(strand[1]);
        for pair in strand.windows(2) {
            prop_assert!(pair[1].is_finite());
            prop_assert!((pair[0].distance(pair[1]) - d).abs() < 2e-5, "{} and {d}", pair[0].distance(pair[1]));
            prop_assert!(HEAD.distance(pair[1]) > 0.0, "{} lies {} cm deep", pair[1], -HEAD.distance(pair[1]));
        }
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, failure_persistence: None, ..ProptestConfig::default() })]

    /// Whatever curls a head can wear, hair is finite, its segments equal, its nodes out of the head. Not among them: curls of
    /// 6 cm gathered into clumps of 5, half a head wide, which now and then reach a millimetre into it.
    #[test]
    fn curls_that_a_head_can_wear_grow_out_of_it(
        pitch in 0.3..6.0f32, slope in 0.0..0.7f32, from in 0.01..1.0f32, flatness in 0.0..=1.0f32,
        gather in 0.0..=1.0f32, variation in 0.0..=0.6f32, frizz in 0.0..=0.6f32, size in 0.2..3.0f32,
        length in 0.5..30.0f32, level in -12.0..8.0f32,
    ) {
        let curl = Curl { radius: slope * pitch, pitch, from, flatness, gather, variation, frizz };
        let mut style =
            Style { curl, length: Length { top: length, sides: length, back: length, fringe: length }, ..Style::default() };
        style.clumps.size = size;
        let cut = format!("point = [0, {level}, 0]\nnormal = [0, -1, 0]\nshortest = 1.0");
        style.cuts.push(toml::from_str(&cut).unwrap());
        let segment = pitch * 0.4 / Curl::SEGMENTS_A_TURN;
        let roots = spread(&HEAD, &Hairline::default(), 24, 5).unwrap();
        clear_of_the_head(&groom(&HEAD, &roots, &style, 2500, segment, 3).unwrap())?;
    }
}
