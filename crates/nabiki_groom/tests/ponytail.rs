//! Laws of a ponytail: its hair goes through the band, along the head and not through it.

use std::sync::LazyLock;

use nabiki::glam::Vec3;
use nabiki::{Head, Strands};
use nabiki_groom::roots::{Root, spread};
use nabiki_groom::style::{Length, Ponytail};
use nabiki_groom::{Hairline, Style, bust, groom};

static HEAD: LazyLock<Head> = LazyLock::new(bust);
static ROOTS: LazyLock<Vec<Root>> = LazyLock::new(|| spread(&HEAD, &Hairline::default(), 800, 5).unwrap());

const TAIL: Ponytail = Ponytail { at: Vec3::new(-12.5, 6.0, 0.0), radius: 0.9, direction: Vec3::new(-1.0, 0.4, 0.0) };
const SEGMENT: f32 = 0.75;

fn tied(tail: Ponytail, segment: f32) -> Strands {
    let length = Length { top: 45.0, sides: 45.0, back: 45.0, fringe: 45.0 };
    let style = Style { ponytail: Some(tail), length, ..Style::default() };
    groom(&HEAD, &ROOTS, &style, (45.0 / segment).ceil() as usize, segment, 5).unwrap()
}

/// A strand's own place lies within the band's radius. It turns within half a segment of where it should to pass there; that
/// segments keep their length as the turn is spread over them moves it by less than another half.
#[test]
fn every_strand_passes_the_band() {
    for segment in [SEGMENT, 0.375] {
        for strand in tied(TAIL, segment).iter() {
            let nearest = strand.iter().map(|p| p.distance(TAIL.at)).fold(f32::INFINITY, f32::min);
            assert!(nearest < TAIL.radius + segment, "from {}: {nearest} cm off", strand[0]);
        }
    }
}

#[test]
fn tied_hair_lies_outside_the_head_in_segments_of_one_length() {
    for strand in tied(TAIL, SEGMENT).iter() {
        for pair in strand.windows(2) {
            assert!(HEAD.distance(pair[1]) > 0.0, "{} lies {} cm deep", pair[1], -HEAD.distance(pair[1]));
            // As in tests/groom.rs: nodes are rounded to f32, 45 cm from the origin at most.
            assert!((pair[0].distance(pair[1]) - strand[0].distance(strand[1])).abs() < 1.6e-5);
        }
    }
}

/// A turn that is spread as a bell of deviation sigma leaves d / (sigma sqrt(2 pi)) of itself to its middle joint, with segments
/// of length d: less than a third at 0.5 cm and 0.375 cm, so that no turn, 180 degrees at the most, is a kink there.
#[test]
fn hair_bends_into_the_band_without_kinks() {
    let mut bent = 0;
    for strand in tied(TAIL, 0.375).iter() {
        for joint in strand.windows(3).filter(|joint| joint[1].distance(TAIL.at) < 2.0) {
            let angle = (joint[1] - joint[0]).angle_between(joint[2] - joint[1]).to_degrees();
            assert!(angle < 60.0, "{angle} degrees at {}", joint[1]);
            bent += usize::from(angle > 10.0);
        }
    }
    assert!(bent > ROOTS.len(), "{bent} joints bend into the band");
}

#[test]
fn a_band_in_the_head_is_refused() {
    let style = |at| Style { ponytail: Some(Ponytail { at, ..TAIL }), ..Style::default() };
    let refused = |at| groom(&HEAD, &[], &style(at), 18, 1.0, 1).unwrap_err().thing;
    assert_eq!(refused(Vec3::new(-9.0, 6.0, 0.0)), "hair.style.ponytail.at");
    assert_eq!(refused(Vec3::new(f32::INFINITY, 6.0, 0.0)), "hair.style.ponytail.at");
    let still = Style { ponytail: Some(Ponytail { direction: Vec3::ZERO, ..TAIL }), ..Style::default() };
    assert_eq!(groom(&HEAD, &[], &still, 18, 1.0, 1).unwrap_err().thing, "hair.style.ponytail.direction");
}
