//! What is counted of ways.

use std::f64::consts::TAU;

use glam::DVec3;

pub fn mean(numbers: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = numbers.fold((0.0, 0), |(sum, count), x| (sum + x, count + 1));
    sum / f64::from(count.max(1))
}

fn about_mean(way: &[DVec3]) -> Vec<DVec3> {
    let middle = way.iter().sum::<DVec3>() / way.len() as f64;
    way.iter().map(|p| *p - middle).collect()
}

/// Of two ways through the same frames, about their means.
pub fn correlation(a: &[DVec3], b: &[DVec3]) -> f64 {
    let (a, b) = (about_mean(a), about_mean(b));
    let dot = |a: &[DVec3], b: &[DVec3]| a.iter().zip(b).map(|(a, b)| a.dot(*b)).sum::<f64>();
    dot(&a, &b) / (dot(&a, &a) * dot(&b, &b)).sqrt()
}

/// The part of the sum of squares of all ways that three shapes in time, the best ones, explain.
pub fn share_of_three(ways: &[Vec<DVec3>]) -> f64 {
    let frames = ways[0].len();
    let mut gram = vec![0.0; frames * frames];
    for way in ways {
        for i in 0..frames {
            for j in 0..frames {
                gram[i * frames + j] += way[i].dot(way[j]);
            }
        }
    }
    let all: f64 = (0..frames).map(|i| gram[i * frames + i]).sum();
    let mut found = 0.0;
    for _ in 0..3 {
        let mut x: Vec<f64> = (0..frames).map(|i| 1.0 + (i as f64).sin()).collect();
        let mut size = 0.0;
        for _ in 0..300 {
            let next: Vec<f64> = (0..frames).map(|i| (0..frames).map(|j| gram[i * frames + j] * x[j]).sum()).collect();
            size = next.iter().map(|x| x * x).sum::<f64>().sqrt();
            x = next.into_iter().map(|x| x / size).collect();
        }
        found += size;
        for i in 0..frames {
            for j in 0..frames {
                gram[i * frames + j] -= size * x[i] * x[j];
            }
        }
    }
    found / all
}

/// The part of the energy of all ways about their means that lies above a frequency (a frame).
pub fn share_above(ways: &[Vec<DVec3>], frequency: f64) -> f64 {
    let frames = ways[0].len();
    let (mut above, mut all) = (0.0, 0.0);
    for way in ways {
        let way = about_mean(way);
        for k in 1..=frames / 2 {
            let power = power(&way, k as f64 / frames as f64);
            all += power;
            above += if k as f64 / frames as f64 > frequency { power } else { 0.0 };
        }
    }
    above / all
}

/// Of the part of a way with a frequency (a frame).
pub fn power(way: &[DVec3], frequency: f64) -> f64 {
    let (mut cos, mut sin) = (DVec3::ZERO, DVec3::ZERO);
    for (n, p) in way.iter().enumerate() {
        let (s, c) = (TAU * frequency * n as f64).sin_cos();
        (cos, sin) = (cos + c * *p, sin + s * *p);
    }
    cos.length_squared() + sin.length_squared()
}
