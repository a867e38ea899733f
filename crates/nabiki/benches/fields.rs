//! What fields cost that differ from place to place, beside the bytes alone: `cargo bench -p nabiki --bench fields`.
//!
//! 20,000 strands of 20 segments around a head, in rows of sixteen points as the step asks for them, on all cores. The
//! figures are the fastest of the rounds, in ns a point.

use std::hint::black_box;
use std::sync::Arc;
use std::time::Instant;

use glam::Vec3;
use nabiki::Ellipsoid;
use nabiki::field::{
    Falloff, Fan, FanField, Field, Flow, FlowField, Keyframe, KeyframedField, ROW, Turbulence, TurbulenceField,
    VectorRow,
};
use rayon::prelude::*;

const ROUNDS: usize = 41;
const ROWS: usize = 20_000 * 20 / ROW;
const HEAD: Ellipsoid = Ellipsoid { center: Vec3::ZERO, half_axes: Vec3::new(9.5, 11.0, 8.0) };

fn main() {
    let turbulence = |octaves, near_head| -> Arc<dyn Field> {
        let settings = Turbulence { octaves, near_head, ..Turbulence::default() };
        Arc::new(TurbulenceField::new(&settings, HEAD, &[], &[Vec3::X]).expect("settings in range"))
    };
    let fields: Vec<(&str, Arc<dyn Field>)> = vec![
        ("turbulence, 1 octave", turbulence(1, 4.0)),
        ("turbulence, 1 octave, no head", turbulence(1, 0.0)),
        ("turbulence, 2 octaves", turbulence(2, 4.0)),
        ("flow round the head", flow()),
        ("fan", fan()),
    ];
    let points = points();
    let mut forces = vec![VectorRow::default(); ROWS];
    let mut bytes = f64::INFINITY;
    let mut times = vec![f64::INFINITY; fields.len()];
    for _ in 0..ROUNDS {
        bytes = bytes.min(time(&points, &mut forces, |points, forces| *forces = *points));
        for (time_of, (_, field)) in times.iter_mut().zip(&fields) {
            *time_of = time_of.min(time(&points, &mut forces, |points, forces| field.at_row(points, 7, forces)));
        }
    }
    println!("threads: {}", rayon::current_num_threads());
    println!("{:<32} {bytes:>7.2} ns a point", "bytes only");
    for ((name, _), time) in fields.iter().zip(times) {
        println!("{name:<32} {time:>7.2} ns a point");
    }
}

fn flow() -> Arc<dyn Field> {
    let wind = KeyframedField::new(&[Keyframe { through: 100, vector: Vec3::NEG_X }]).expect("one keyframe");
    Arc::new(FlowField::new(&Flow::default(), Arc::new(wind), HEAD, &[]).expect("settings in range"))
}

fn fan() -> Arc<dyn Field> {
    let settings = Fan {
        position: Vec3::new(40.0, 0.0, 0.0),
        direction: Vec3::NEG_X,
        strength: 50.0,
        spread: 30.0,
        falloff: Falloff::default(),
        envelope: Vec::new(),
    };
    Arc::new(FanField::new(&settings, "fan[0]").expect("settings in range"))
}

/// Rows of points on their way out from the head, row by row along sixteen strands.
fn points() -> Vec<VectorRow> {
    (0..ROWS)
        .map(|row| {
            let (block, segment) = (row / 20, row % 20);
            let place = |lane: usize| {
                let s = (block * ROW + lane) as f32;
                let y = 1.0 - s / 20_000.0;
                let (sin, cos) = (s * 2.399_963).sin_cos();
                let out = Vec3::new((1.0 - y * y).sqrt() * sin, y, (1.0 - y * y).sqrt() * cos);
                out * (HEAD.half_axes + segment as f32)
            };
            let places: [Vec3; ROW] = std::array::from_fn(place);
            [0, 1, 2].map(|axis| places.map(|p| p[axis]))
        })
        .collect()
}

/// ns a point.
fn time(points: &[VectorRow], forces: &mut [VectorRow], fill: impl Fn(&VectorRow, &mut VectorRow) + Sync) -> f64 {
    let start = Instant::now();
    points.par_chunks(160).zip(forces.par_chunks_mut(160)).for_each(|(points, forces)| {
        for (points, forces) in points.iter().zip(forces) {
            fill(points, forces);
        }
    });
    black_box(forces);
    1e9 * start.elapsed().as_secs_f64() / (ROWS * ROW) as f64
}
