//! Laws of a ponytail: its hair goes through the band, along the head and not through it.

use std::sync::LazyLock;

use glam::Vec3;
use nabiki::groom::style::{Length, Ponytail};
use nabiki::groom::{Style, groom};
use nabiki::roots::{Hairline, Root, spread};
use nabiki::{Head, Strands};

static HEAD: LazyLock<Head> = LazyLock::new(Head::builtin);
static ROOTS: LazyLock<Vec<Root>> = LazyLock::new(|| spread(&HEAD, &Hairline::default(), 800, 5).unwrap());

const TAIL: Ponytail = Ponytail { at: Vec3::new(-12.5, 6.0, 0.0), radius: 0.9, direction: Vec3::new(-1.0, 0.4, 0.0) };
const SEGMENT: f32 = 0.75;

fn tied(tail: Ponytail) -> Strands {
    let length = Length { top: 45.0, sides: 45.0, back: 45.0, fringe: 45.0 };
    let style = Style { ponytail: Some(tail), length, ..Style::default() };
    groom(&HEAD, &ROOTS, &style, 60, SEGMENT, 5).unwrap()
}

/// The walk ends within half a segment of a strand's own place in the band, and that lies within its radius.
#[test]
fn every_strand_passes_the_band() {
    for strand in tied(TAIL).iter() {
        let nearest = strand.iter().map(|p| p.distance(TAIL.at)).fold(f32::INFINITY, f32::min);
        assert!(nearest < TAIL.radius + 0.5 * SEGMENT + 1e-5, "from {}: {nearest} cm off", strand[0]);
    }
}

#[test]
fn tied_hair_lies_outside_the_head_in_segments_of_one_length() {
    for strand in tied(TAIL).iter() {
        for pair in strand.windows(2) {
            assert!(HEAD.distance(pair[1]) > 0.0, "{} lies {} cm deep", pair[1], -HEAD.distance(pair[1]));
            // As in tests/groom.rs: nodes are rounded to f32, 45 cm from the origin at most.
            assert!((pair[0].distance(pair[1]) - strand[0].distance(strand[1])).abs() < 1.6e-5);
        }
    }
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
