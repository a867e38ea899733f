//! What the motion is measured against: point masses on rigid links, a few hundred steps a frame. It shares nothing with the steppers
//! but the meaning of the settings.

use glam::{DQuat, DVec3};

/// Steps a frame: lengths, stiff joints and whips are resolved.
const STEPS: u32 = 200;

/// What moves a strand, with lengths in cm and times in frames; masses are those of a strand of 1 a cm.
#[derive(Clone, Debug)]
pub struct Properties {
    /// What a force of 1 accelerates by: A = d dt^2 / (lambda L^2).
    pub of_force: f64,
    /// Weight (cm a frame squared).
    pub weight: DVec3,
    /// EI / lambda at the joint before each segment.
    pub bending: Vec<f64>,
    /// Hold of each segment, as an acceleration.
    pub hold: Vec<f64>,
    /// What a speed through the air loses of itself in a frame, of the node behind each segment.
    pub drag: Vec<f64>,
}

/// A strand that hangs in balance at rest, in the world.
#[derive(Clone, Debug)]
pub struct Chain {
    of: Properties,
    lengths: Vec<f64>,
    masses: Vec<f64>,
    rest: Vec<DVec3>,
    /// The force across each segment, times its length, that supports the weight beyond at rest.
    supports: Vec<DVec3>,
    points: Vec<DVec3>,
    velocities: Vec<DVec3>,
}

impl Chain {
    pub fn new(points: &[DVec3], of: Properties) -> Self {
        let ways: Vec<DVec3> = points.windows(2).map(|w| w[1] - w[0]).collect();
        let lengths: Vec<f64> = ways.iter().map(|way| way.length()).collect();
        let n = ways.len();
        let masses = (0..n).map(|i| 0.5 * (lengths[i] + lengths.get(i + 1).unwrap_or(&0.0))).collect::<Vec<_>>();
        let rest: Vec<DVec3> = ways.iter().map(|way| way.normalize()).collect();
        let beyond = |i: usize| masses[i..].iter().sum::<f64>() * lengths[i] * of.weight;
        let supports = (0..n).map(|i| -beyond(i).reject_from_normalized(rest[i])).collect();
        Self { of, lengths, masses, rest, supports, points: points.to_vec(), velocities: vec![DVec3::ZERO; n + 1] }
    }

    /// Its points in the frames from 0 on. `force`: at a place, in the step to a frame; `root`: how far it is moved at a time.
    pub fn run(
        mut self,
        frames: u32,
        force: impl Fn(DVec3, u32) -> DVec3,
        root: impl Fn(f64) -> DVec3,
    ) -> Vec<Vec<DVec3>> {
        let mut film = vec![self.points.clone()];
        let from = self.points[0];
        for frame in 1..=frames {
            for step in 1..=STEPS {
                let time = f64::from(frame - 1) + f64::from(step) / f64::from(STEPS);
                self.step(1.0 / f64::from(STEPS), |p| force(p, frame), from + root(time));
            }
            film.push(self.points.clone());
        }
        film
    }

    fn step(&mut self, h: f64, force: impl Fn(DVec3) -> DVec3, root: DVec3) {
        let bent = self.bent();
        let before = self.points.clone();
        for i in 1..self.points.len() {
            let acceleration = self.of.of_force * force(before[i]) + self.of.weight + bent[i] / self.masses[i - 1];
            let velocity = self.velocities[i] + h * acceleration;
            self.velocities[i] = velocity / (1.0 + h * self.of.drag[i - 1]);
            self.points[i] += h * self.velocities[i];
        }
        self.points[0] = root;
        self.shorten();
        for (velocity, (now, before)) in self.velocities.iter_mut().zip(self.points.iter().zip(before)) {
            *velocity = (*now - before) / h;
        }
    }

    /// The force of joints and hold on every node.
    fn bent(&self) -> Vec<DVec3> {
        let n = self.lengths.len();
        let directions: Vec<DVec3> = self.points.windows(2).map(|w| (w[1] - w[0]).normalize()).collect();
        let mut frame = DQuat::IDENTITY;
        let mut moments = vec![DVec3::ZERO; n + 1];
        for i in 0..n {
            let carried = frame * self.rest[i];
            let apart = if i == 0 { 0.5 * self.lengths[0] } else { 0.5 * (self.lengths[i - 1] + self.lengths[i]) };
            moments[i] = self.of.bending[i] / apart * directions[i].cross(carried);
            frame = DQuat::from_rotation_arc(carried, directions[i]) * frame;
        }
        let mut forces = vec![DVec3::ZERO; n + 1];
        let mut beyond = 0.0;
        for i in (0..n).rev() {
            let held = self.of.hold[i] * (beyond + 0.5 * self.lengths[i]) * self.lengths[i];
            beyond += self.lengths[i];
            // Less, the more the segment is turned along its support.
            let support = self.supports[i];
            let across = 1.0 - directions[i].dot(support.normalize_or_zero()).powi(2);
            let on_head = held * self.rest[i] + across.powi(2) * support;
            let torque = moments[i] - moments[i + 1] + directions[i].cross(on_head);
            let couple = torque.cross(directions[i]) / self.lengths[i];
            forces[i + 1] += couple;
            forces[i] -= couple;
        }
        forces
    }

    /// Brings all links back to their lengths at once, by forces along them.
    fn shorten(&mut self) {
        let n = self.lengths.len();
        let inverse = |node: usize| if node == 0 { 0.0 } else { 1.0 / self.masses[node - 1] };
        for _ in 0..4 {
            let links: Vec<DVec3> = self.points.windows(2).map(|w| w[1] - w[0]).collect();
            // Thomas's algorithm.
            let (mut upper, mut pulls) = (vec![0.0; n], vec![0.0; n]);
            for i in 0..n {
                let too_long = 0.5 * (links[i].length_squared() - self.lengths[i].powi(2));
                let lower = if i == 0 { 0.0 } else { -inverse(i) * links[i].dot(links[i - 1]) };
                let (above, pull) = if i == 0 { (0.0, 0.0) } else { (upper[i - 1], pulls[i - 1]) };
                let middle = (inverse(i) + inverse(i + 1)) * links[i].length_squared() - lower * above;
                upper[i] = if i + 1 == n { 0.0 } else { -inverse(i + 1) * links[i].dot(links[i + 1]) / middle };
                pulls[i] = (too_long - lower * pull) / middle;
            }
            for i in (0..n - 1).rev() {
                pulls[i] -= upper[i] * pulls[i + 1];
            }
            for i in 0..n {
                let along = links[i] * pulls[i];
                self.points[i + 1] -= inverse(i + 1) * along;
                self.points[i] += inverse(i) * along;
            }
        }
    }
}

/// omega_1 .. omega_3 over sqrt(g / L) of a strand that is clamped at its top and hangs, by gamma = w L^3 / EI: Ritz's method with
/// y = x^2 .. x^11, of EI y'''' - (w (L - s) y')' = rho A omega^2 y.
pub fn frequencies(gamma: f64) -> [f64; 3] {
    const N: usize = 10;
    let power = |i: usize| (i + 2) as f64;
    let (mut stiff, mut mass) = ([[0.0; N]; N], [[0.0; N]; N]);
    for i in 0..N {
        for j in 0..N {
            let (a, b) = (power(i), power(j));
            let bent = a * (a - 1.0) * b * (b - 1.0) / (a + b - 3.0) / gamma;
            let hung = a * b * (1.0 / (a + b - 1.0) - 1.0 / (a + b));
            (stiff[i][j], mass[i][j]) = (bent + hung, 1.0 / (a + b + 1.0));
        }
    }
    // Inverse iteration in the mass's inner product, one mode after the other.
    let dot = |a: &[f64; N], b: &[f64; N]| -> f64 {
        (0..N).map(|i| a[i] * (0..N).map(|j| mass[i][j] * b[j]).sum::<f64>()).sum()
    };
    let mut modes: Vec<[f64; N]> = Vec::new();
    std::array::from_fn(|mode| {
        let mut x: [f64; N] = std::array::from_fn(|i| if i == mode { 1.0 } else { 0.1 / (i + 1) as f64 });
        let mut omega = 0.0;
        for _ in 0..200 {
            for known in &modes {
                let part = dot(known, &x);
                (0..N).for_each(|i| x[i] -= part * known[i]);
            }
            let size = dot(&x, &x).sqrt();
            x.iter_mut().for_each(|x| *x /= size);
            let loaded: [f64; N] = std::array::from_fn(|i| (0..N).map(|j| mass[i][j] * x[j]).sum());
            let next = solved(stiff, loaded);
            omega = 1.0 / dot(&next, &next).sqrt().sqrt();
            x = next;
        }
        let size = dot(&x, &x).sqrt();
        modes.push(x.map(|x| x / size));
        omega
    })
}

/// Gaussian elimination with pivots.
fn solved<const N: usize>(mut a: [[f64; N]; N], mut b: [f64; N]) -> [f64; N] {
    for k in 0..N {
        let pivot = (k..N).max_by(|&i, &j| a[i][k].abs().total_cmp(&a[j][k].abs())).expect("a row is left");
        a.swap(k, pivot);
        b.swap(k, pivot);
        for i in k + 1..N {
            let part = a[i][k] / a[k][k];
            (k..N).for_each(|j| a[i][j] -= part * a[k][j]);
            b[i] -= part * b[k];
        }
    }
    for k in (0..N).rev() {
        b[k] = (b[k] - (k + 1..N).map(|j| a[k][j] * b[j]).sum::<f64>()) / a[k][k];
    }
    b
}
