//! Where things are, as Python says it: matrices, or places and turns.

use glam::{DMat3, DQuat, DVec3};
use nabiki::Pose;
use numpy::ndarray::ArrayView2;
use numpy::{PyReadonlyArray1, PyReadonlyArray2, PyReadonlyArray3};
use pyo3::prelude::*;
use pyo3::types::{PyList, PyTuple};

use crate::error;
use crate::given_arrays::{numbers, shape};

/// How far from a turn a matrix may be, and from 1 the length of a quaternion: as far as a pose may.
const NEAR: f64 = 1e-3;

/// What is no rotation and place, and what to do.
pub type NoPose = (String, &'static str);

/// The pose that a (4, 4) matrix is, or (position, quaternion).
pub fn pose(thing: &str, given: &Bound<'_, PyAny>) -> PyResult<Pose> {
    let py = given.py();
    let pair = match given.cast::<PyList>() {
        Ok(list) if list.len() == 2 => Some(list.to_tuple()),
        _ => given.cast::<PyTuple>().ok().filter(|given| given.len() == 2).cloned(),
    };
    let found = match pair {
        Some(pair) => {
            let position = row(&format!("{thing} position"), &pair.get_item(0)?)?;
            let quaternion = row(&format!("{thing} quaternion"), &pair.get_item(1)?)?;
            rotation_of(&DQuat::from_array(quaternion)).map(|rotation| (DVec3::from_array(position), rotation))
        }
        None => {
            let array = numbers(thing, given, "float64")?;
            let matrix: Option<PyReadonlyArray2<'_, f64>> = array.extract().ok();
            let Some(matrix) = matrix.filter(|matrix| matrix.as_array().dim() == (4, 4)) else {
                let way_out = "must be a matrix of shape (4, 4), or (position, quaternion)";
                return Err(error::argument(py, thing, shape(&array)?, way_out));
            };
            let matrix = matrix.as_array();
            of_matrix(std::array::from_fn(|i| std::array::from_fn(|j| matrix[[i, j]])))
        }
    };
    let (position, rotation) = found.map_err(|(value, way_out)| error::argument(py, thing, value, way_out))?;
    Ok(Pose { position_cm: position.as_vec3(), rotation: rotation.as_quat() })
}

/// The places and turns of an array (frames, 4, 4) of matrices.
pub fn way(thing: &str, given: &Bound<'_, PyAny>) -> PyResult<Vec<(DVec3, DQuat)>> {
    let py = given.py();
    let array = numbers(thing, given, "float64")?;
    let matrices: Option<PyReadonlyArray3<'_, f64>> = array.extract().ok();
    let matrices = matrices.filter(|all| matches!(all.as_array().dim(), (1.., 4, 4)));
    let Some(matrices) = matrices else {
        return Err(error::argument(py, thing, shape(&array)?, "must have the shape (frames, 4, 4)"));
    };
    let pose = |(n, matrix): (usize, ArrayView2<'_, f64>)| {
        of_matrix(std::array::from_fn(|i| std::array::from_fn(|j| matrix[[i, j]])))
            .map_err(|(value, way_out)| error::argument(py, &format!("{thing} frame {n}"), value, way_out))
    };
    matrices.as_array().outer_iter().enumerate().map(pose).collect()
}

/// So many finite numbers.
pub fn row<const N: usize>(thing: &str, given: &Bound<'_, PyAny>) -> PyResult<[f64; N]> {
    let py = given.py();
    let array = numbers(thing, given, "float64")?;
    let row: Option<PyReadonlyArray1<'_, f64>> = array.extract().ok();
    let Some(row) = row.filter(|row| row.as_array().len() == N) else {
        return Err(error::argument(py, thing, shape(&array)?, &format!("must have the shape ({N},)")));
    };
    let row: [f64; N] = std::array::from_fn(|i| row.as_array()[i]);
    // Of the numbers that hair is moved by.
    match row.iter().all(|&x| (x as f32).is_finite()) {
        true => Ok(row),
        false => Err(error::argument(py, thing, format!("{row:?}"), "must be finite numbers")),
    }
}

/// Place and turn of a matrix, by rows.
///
/// # Errors
/// A matrix that does anything else.
pub fn of_matrix([x, y, z, last]: [[f64; 4]; 4]) -> Result<(DVec3, DQuat), NoPose> {
    let rows = [x, y, z];
    if !rows.iter().chain([&last]).flatten().all(|&x| (x as f32).is_finite()) {
        return Err(("a matrix with numbers that are not finite".to_owned(), "every number must be finite"));
    }
    let position = DVec3::from_array(rows.map(|row| row[3]));
    if last.iter().zip([0.0, 0.0, 0.0, 1.0]).any(|(x, wanted)| (x - wanted).abs() > NEAR) {
        let way_out = "must be (0, 0, 0, 1), with the place in the last column: transpose a matrix that has it below";
        return Err((format!("a matrix whose last row is {last:?}"), way_out));
    }
    let matrix = DMat3::from_cols_array_2d(&rows.map(|row| [row[0], row[1], row[2]])).transpose();
    let axes = [matrix.x_axis, matrix.y_axis, matrix.z_axis];
    let lengths = axes.map(DVec3::length);
    if lengths.iter().any(|length| (length - 1.0).abs() > NEAR) {
        let way_out = "must only rotate and move: divide each column by its length, and scale the mesh";
        return Err((
            format!("a matrix that scales by {:.4}, {:.4}, {:.4}", lengths[0], lengths[1], lengths[2]),
            way_out,
        ));
    }
    let cosines = [axes[0].dot(axes[1]), axes[1].dot(axes[2]), axes[2].dot(axes[0])];
    if let Some(cosine) = cosines.iter().find(|cosine| cosine.abs() > NEAR) {
        let angle = cosine.clamp(-1.0, 1.0).acos().to_degrees();
        let way_out = "must only rotate and move: its columns must be orthogonal";
        return Err((format!("a matrix that shears, with {angle:.1} degrees between two columns"), way_out));
    }
    if matrix.determinant() < 0.0 {
        return Err(("a matrix that mirrors".to_owned(), "must only rotate and move: change the sign of one column"));
    }
    Ok((position, DQuat::from_mat3(&matrix).normalize()))
}

fn rotation_of(quaternion: &DQuat) -> Result<DQuat, NoPose> {
    let length = quaternion.length();
    match (length - 1.0).abs() <= NEAR {
        true => Ok(quaternion.normalize()),
        false => Err((format!("a quaternion of length {length}"), "must have the length 1, (x, y, z, w)")),
    }
}
