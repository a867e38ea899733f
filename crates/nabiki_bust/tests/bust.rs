//! The bust as it is sculpted, and as the head reads it.

use std::sync::LazyLock;

use glam::{Vec3, vec3};
use nabiki::Head;
use nabiki_bust::{bake, field};

static BUST: LazyLock<Head> = LazyLock::new(nabiki_groom::bust);

fn scattered(count: usize) -> impl Iterator<Item = Vec3> {
    (0..count).map(|i| {
        let [a, b, c] = [0.618_034, 0.754_878, 0.569_84].map(|g: f32| (i as f32 * g).fract() - 0.5);
        vec3(30.0 * a, 46.0 * b - 10.0, 42.0 * c)
    })
}

#[test]
fn the_file_that_the_head_reads_is_what_is_written_today() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../nabiki_groom/src/bust/bust.bin");
    let file = std::fs::read(path).unwrap();
    assert!(file == bake(), "run `cargo run --release -p nabiki_bust` to write the bust anew");
}

#[test]
fn the_field_is_the_same_on_both_sides() {
    for p in scattered(4000) {
        assert_eq!(field(p), field(vec3(p.x, p.y, -p.z)), "{p}");
    }
}

#[test]
fn every_vertex_is_on_the_zero_set() {
    let off = BUST.mesh.positions.iter().map(|&p| field(p).abs()).fold(0.0, f32::max);
    assert!(off < 0.01, "{off}");
}

/// The same mesh measured by the head itself, on other nodes: they differ by what either rounds or interpolates.
#[test]
fn the_distance_that_is_stored_is_that_of_the_mesh() {
    let measured = Head::from_mesh(BUST.mesh.clone(), Some(BUST.ellipsoid)).unwrap();
    let mut near = 0;
    for p in scattered(20_000) {
        let (stored, exact) = (BUST.distance(p), BUST.exact_distance(p));
        assert_eq!(exact, measured.exact_distance(p), "{p}");
        if exact.abs() < 0.4 {
            near += 1;
            // Half a step of interpolation across a crease, as at the rims of the ears, and half a quantum.
            assert!((stored - exact).abs() < 0.17, "{p}: {stored} for {exact}");
        } else {
            assert_eq!(stored < 0.0, exact < 0.0, "{p}");
            assert!((stored - exact).abs() < 0.05 * exact.abs() + 0.65, "{p}: {stored} for {exact}");
        }
    }
    assert!(near > 300, "{near} places near the skin");
}

/// At a node of the stored distance nothing is interpolated: it is exact to half a quantum of 1/1024 cm, and to the
/// rounding of the place.
#[test]
fn at_its_nodes_the_stored_distance_is_exact_to_half_a_quantum() {
    let step = 333.0 / 1024.0;
    let mut near = 0;
    for node in 0..400_000 {
        let p = step * vec3((node % 80) as f32 - 40.0, (node / 80 % 100) as f32 - 60.0, (node / 8000) as f32);
        let stored = BUST.distance(p);
        if stored.abs() < 0.5 {
            near += 1;
            let exact = BUST.exact_distance(p);
            assert!((stored - exact).abs() < 0.5 / 1024.0 + 1e-5, "{p}: {stored} for {exact}");
        }
    }
    assert!(near > 1000, "{near} nodes near the skin");
}

// Shapes out of reach are left out of the sum, which must not show as a seam. A blended edge or a groove 0.1 cm deep
// and 0.2 cm wide is the steepest that there is.
#[test]
fn near_its_skin_the_bust_has_no_jumps() {
    let step = 0.02;
    for axis in 0..3 {
        let (along, i, j) = (Vec3::AXES[axis], (axis + 1) % 3, (axis + 2) % 3);
        let (low, high) = (vec3(-14.0, -32.0, 0.0), vec3(12.0, 12.0, 20.0));
        for line in 0..400 {
            let mut p = low;
            p[i] += (high - low)[i] * (line as f32 * 0.618_034).fract();
            p[j] += (high - low)[j] * (line as f32 * 0.754_878).fract();
            let mut before = field(p);
            while p[axis] < high[axis] {
                let next = p + step * along;
                let value = field(next);
                let near = value.abs().min(before.abs()) < 0.3;
                assert!(!near || (value - before).abs() < 3.0 * step, "from {before} to {value} at {next}");
                (p, before) = (next, value);
            }
        }
    }
}
