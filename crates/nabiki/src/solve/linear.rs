//! Small systems of linear equations.

/// A symmetric n x n matrix and a right side: the normal equations of a least-squares problem.
#[derive(Clone, Debug)]
pub(super) struct Normal {
    pub n: usize,
    /// Row by row; only the part on and below the diagonal counts.
    pub matrix: Vec<f64>,
    /// Minus the gradient.
    pub right: Vec<f64>,
}

impl Normal {
    pub fn new(n: usize) -> Self {
        Self { n, matrix: vec![0.0; n * n], right: vec![0.0; n] }
    }

    /// Adds one weighted residual with its derivatives.
    pub fn add(&mut self, weight: f64, residual: f64, derivatives: &[f64]) {
        for (i, &a) in derivatives.iter().enumerate() {
            let weighted = weight * a;
            self.right[i] -= weighted * residual;
            let row = &mut self.matrix[i * self.n..i * self.n + i + 1];
            for (sum, &b) in row.iter_mut().zip(derivatives) {
                *sum += weighted * b;
            }
        }
    }

    pub fn diagonal(&self, i: usize) -> f64 {
        self.matrix[i * self.n + i]
    }

    /// The decrease of the weighted sum of squares by a step if the problem were linear: 2 b.x - x.Ax.
    pub fn expected(&self, step: &[f64]) -> f64 {
        let n = self.n;
        let mut sum = 0.0;
        for i in 0..n {
            let below: f64 = (0..i).map(|j| self.matrix[i * n + j] * step[j]).sum();
            sum += step[i] * (2.0 * self.right[i] - 2.0 * below - self.diagonal(i) * step[i]);
        }
        sum
    }

    /// Fixes one number.
    pub fn hold(&mut self, i: usize) {
        let n = self.n;
        for j in 0..n {
            self.matrix[i * n + j] = 0.0;
            self.matrix[j * n + i] = 0.0;
        }
        self.matrix[i * n + i] = 1.0;
        self.right[i] = 0.0;
    }

    /// x of (A + diag(damping)) x = b, by Cholesky's method; `None` if the matrix is not positive definite.
    pub fn solved(&self, damping: &[f64]) -> Option<Vec<f64>> {
        let n = self.n;
        let mut lower = self.matrix.clone();
        for (i, damping) in damping.iter().enumerate() {
            lower[i * n + i] += damping;
        }
        for i in 0..n {
            for j in 0..=i {
                let dot: f64 = (0..j).map(|k| lower[i * n + k] * lower[j * n + k]).sum();
                let rest = lower[i * n + j] - dot;
                lower[i * n + j] = if i == j {
                    if rest.is_nan() || rest <= 0.0 {
                        return None;
                    }
                    rest.sqrt()
                } else {
                    rest / lower[j * n + j]
                };
            }
        }
        let mut x = self.right.clone();
        for i in 0..n {
            let dot: f64 = (0..i).map(|k| lower[i * n + k] * x[k]).sum();
            x[i] = (x[i] - dot) / lower[i * n + i];
        }
        for i in (0..n).rev() {
            let dot: f64 = (i + 1..n).map(|k| lower[k * n + i] * x[k]).sum();
            x[i] = (x[i] - dot) / lower[i * n + i];
        }
        Some(x)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn least_squares_are_found_and_singular_systems_are_not() {
        let rows = [[1.0, 2.0, 0.5], [0.0, -1.0, 3.0], [4.0, 1.0, 1.0], [2.0, 2.0, -1.0]];
        let answer = [0.3, -2.0, 5.0];
        let mut normal = Normal::new(3);
        for row in &rows {
            let value: f64 = row.iter().zip(&answer).map(|(a, x)| a * x).sum();
            normal.add(2.0, -value, row);
        }
        let found = normal.solved(&[0.0; 3]).unwrap();
        assert!(found.iter().zip(&answer).all(|(a, b)| (a - b).abs() < 1e-12), "{found:?}");
        // All of the sum of squares is gained.
        let squares: f64 =
            rows.iter().map(|row| 2.0 * row.iter().zip(&answer).map(|(a, x)| a * x).sum::<f64>().powi(2)).sum();
        assert!((normal.expected(&found) - squares).abs() < 1e-9 * squares);
        normal.hold(1);
        assert_eq!(normal.solved(&[0.0; 3]).unwrap()[1], 0.0);
        let mut flat = Normal::new(2);
        flat.add(1.0, 1.0, &[1.0, 0.0]);
        assert!(flat.solved(&[0.0; 2]).is_none());
        assert!(flat.solved(&[0.0, 1.0]).is_some());
    }
}
