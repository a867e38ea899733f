//! Laws of the hairstyle as a whole, for every style that is shipped.

use nabiki::groom::{Style, groom};
use nabiki::pores::{Hairline, Pore, spread};
use nabiki::{Head, Strands};
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

const SCENES: [(&str, &str); 3] = [
    ("gust", include_str!("../../../scenes/gust.toml")),
    ("bob", include_str!("../../../scenes/bob.toml")),
    ("short", include_str!("../../../scenes/short.toml")),
];

struct Styled {
    name: &'static str,
    hair: Hair,
    head: Head,
    pores: Vec<Pore>,
    strands: Strands,
}

impl Styled {
    fn groom(&self, pores: &[Pore], seed: u64) -> Strands {
        groom(&self.head, pores, &self.hair.style, self.hair.segments, self.hair.segment_length, seed).unwrap()
    }
}

fn each_style() -> impl Iterator<Item = Styled> {
    let head = Head::builtin();
    SCENES.into_iter().map(move |(name, text)| {
        let hair = toml::from_str::<Scene>(text).unwrap_or_else(|e| panic!("{name}: {e}")).hair;
        let pores = spread(&head, &hair.hairline, 1500, 5).unwrap();
        let strands = groom(&head, &pores, &hair.style, hair.segments, hair.segment_length, 5).unwrap();
        Styled { name, hair, head: head.clone(), pores, strands }
    })
}

/// A node keeps `volume.gap` from the skin as the distance is sampled; the roots lie on the skin, as the pores do.
/// So do the middles of segments. Rounding a node to f32 moves it by less than 2e-6 cm, its distance by no more.
#[test]
fn no_node_lies_inside_the_head() {
    for styled in each_style() {
        let Styled { name, head, strands, .. } = &styled;
        for strand in strands.iter() {
            assert!(head.distance(strand[0]) > -1e-3, "{name}: root {} in the skin", strand[0]);
            for &p in &strand[1..] {
                assert!(head.distance(p) > 0.0, "{name}: {p} lies {} cm deep", -head.distance(p));
            }
            for pair in strand.windows(2) {
                let middle = pair[0].midpoint(pair[1]);
                assert!(head.distance(middle) > -1e-3, "{name}: {middle} lies {} cm deep", -head.distance(middle));
            }
        }
    }
}

/// Nodes are computed in f64 and stored in f32: 30 cm from the origin they are 2^-19 cm apart, and the length of a
/// segment errs by at most sqrt(3) of that.
#[test]
fn segments_of_a_strand_are_equal_to_rounding_and_no_longer_than_asked() {
    for Styled { name, hair, strands, .. } in each_style() {
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
fn strand_by_strand_they_start_at_their_pores() {
    for Styled { name, pores, strands, .. } in each_style() {
        assert_eq!(strands.len(), pores.len());
        for (strand, pore) in strands.iter().zip(&pores) {
            assert_eq!(strand[0], pore.position, "{name}");
        }
    }
}

#[test]
fn same_seed_same_bits_for_any_threads_and_any_subset() {
    for styled in each_style() {
        let alone = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
        let again = alone.install(|| styled.groom(&styled.pores, 5));
        assert_eq!(styled.strands, again, "{}", styled.name);

        let chosen: Vec<usize> = (0..styled.pores.len()).rev().step_by(7).collect();
        let some: Vec<Pore> = chosen.iter().map(|&i| styled.pores[i]).collect();
        assert_eq!(styled.strands.select(&chosen), styled.groom(&some, 5), "{}", styled.name);

        assert_ne!(styled.strands, styled.groom(&styled.pores, 6), "{}: the seed changes nothing", styled.name);
    }
}

#[test]
fn hair_is_finite_and_within_its_length_of_the_root() {
    for Styled { name, strands, .. } in each_style() {
        for strand in strands.iter() {
            let length: f32 = strand.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
            for p in strand {
                assert!(p.is_finite() && p.distance(strand[0]) <= length * 1.0001, "{name}: {p}");
            }
        }
    }
}
