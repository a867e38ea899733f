//! Numbers and colours of the vertices of a mesh, as painted weights and vertex colours.

use nabiki::Mesh;
use nabiki::hair::{Role, Values};

use crate::attributes::Whatever;
use crate::{Budget, Problem};

/// The most names of weights that a mesh keeps. A mesh has a few; to look up many more for each of many parts takes long.
const MOST_NAMES: usize = 250;

/// What the vertices of a part of a mesh have by a name: a number each, or a colour.
#[derive(Clone, Debug, PartialEq)]
pub struct Painted {
    /// Name in the file.
    pub name: String,
    /// Numbers of each value: 1, or 3 or 4 of a colour.
    pub extent: usize,
    /// Those of all vertices, one value after another.
    pub numbers: Vec<f32>,
}

/// What values of a mesh belong to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PaintedOn {
    /// The vertices.
    Vertices,
    /// The corners of the polygons.
    Corners,
}

/// The polygons that values belong to.
#[derive(Clone, Copy, Debug)]
pub struct Canvas<'a> {
    /// How many vertices there are.
    pub vertices: usize,
    /// The vertices that corners name, polygon after polygon.
    pub corners: &'a [i64],
}

impl Painted {
    /// Whether values can be weights: single numbers, or three or four numbers that are no place or direction.
    pub fn may_be(role: Role, extent: usize) -> bool {
        match extent {
            1 => role == Role::Plain,
            3 | 4 => matches!(role, Role::Plain | Role::Colour),
            _ => false,
        }
    }

    /// The weights that an attribute of these values is; `None` if it is none. A vertex takes the value of the first corner
    /// that names it, and one that no corner names has 0.
    ///
    /// # Errors
    /// Another number of values than there are vertices or corners, or too many for the budget.
    pub fn of(
        name: &str,
        whatever: &Whatever,
        on: PaintedOn,
        canvas: Canvas<'_>,
        budget: &Budget,
    ) -> Result<Option<Self>, Problem> {
        let extent = whatever.extent;
        if !Self::may_be(whatever.role, extent) {
            return Ok(None);
        }
        let count = match &whatever.values {
            Values::Words(_) => return Ok(None),
            // Whole numbers from 0 to 255 are no colour.
            Values::Integers(_) if extent > 1 => return Ok(None),
            values => values.len(),
        };
        let (expected, what) = match on {
            PaintedOn::Vertices => (canvas.vertices, "vertices"),
            PaintedOn::Corners => (canvas.corners.len(), "corners"),
        };
        if count != expected.saturating_mul(extent) {
            return Err(Problem(format!("{} for {expected} {what}", count / extent)));
        }
        budget.take_list::<f32>(count.max(canvas.vertices.saturating_mul(extent)), name)?;
        let numbers: Vec<f32> = match &whatever.values {
            Values::Floats(values) => values.clone(),
            Values::Doubles(values) => values.iter().map(|&value| value as f32).collect(),
            Values::Integers(values) => values.iter().map(|&value| value as f32).collect(),
            Values::Words(_) => return Ok(None),
        };
        let numbers = match on {
            PaintedOn::Vertices => numbers,
            PaintedOn::Corners => of_first_corners(&numbers, extent, canvas),
        };
        Ok(Some(Self { name: name.to_owned(), extent, numbers }))
    }

    /// Adds them to a mesh whose vertices from `first` on they belong to.
    ///
    /// # Errors
    /// Why they are left out: there are too many of them.
    pub fn add_to(&self, mesh: &mut Mesh, first: usize, budget: &Budget) -> Result<(), Problem> {
        let names = if self.extent == 1 { 1 } else { 1 + self.extent };
        if mesh.weights_named(&self.name).is_none() && mesh.weights.len() + names > MOST_NAMES {
            return Err(Problem(format!("a mesh keeps at most {MOST_NAMES} attributes and channels")));
        }
        let known = mesh.weights_named(&self.name).map_or(0, |of| of.values.len());
        if known > first {
            return Err(Problem("another attribute has the same name".to_owned()));
        }
        // Those before it may get noughts.
        let vertices = first.saturating_add(self.numbers.len() / self.extent);
        budget.take_list::<f32>((vertices - known).saturating_mul(names), &self.name)?;
        match self.extent {
            1 => mesh.add_weights(&self.name, first, self.numbers.iter().copied()),
            channels => mesh.add_colours(&self.name, first, channels, &self.numbers),
        }
        Ok(())
    }
}

/// Of each vertex the value of the first corner that names it; 0 where none does, or where it is past the vertices.
fn of_first_corners(numbers: &[f32], extent: usize, canvas: Canvas<'_>) -> Vec<f32> {
    let mut of_vertices = vec![0.0; canvas.vertices * extent];
    // The last to be written is the first corner.
    for (&vertex, value) in canvas.corners.iter().zip(numbers.chunks_exact(extent)).rev() {
        let vertex = usize::try_from(vertex).ok().filter(|&vertex| vertex < canvas.vertices);
        if let Some(vertex) = vertex {
            of_vertices[vertex * extent..(vertex + 1) * extent].copy_from_slice(value);
        }
    }
    of_vertices
}

#[cfg(test)]
mod tests {
    use glam::Vec3;
    use nabiki::hair::Stored;

    use super::*;

    const CANVAS: Canvas<'_> = Canvas { vertices: 3, corners: &[2, 0, 1, 0, 2, 1] };

    fn painted(role: Role, extent: usize, values: Values, on: PaintedOn) -> Result<Option<Painted>, Problem> {
        let whatever = Whatever { role, extent, stored: Stored::F32, single: false, per: None, values };
        Painted::of("w", &whatever, on, CANVAS, &Budget::of(0))
    }

    #[test]
    fn a_vertex_has_the_value_of_its_first_corner() {
        let of_vertices = painted(Role::Plain, 1, Values::Floats(vec![0.25, 0.5, 1.0]), PaintedOn::Vertices);
        let corners = vec![1.0, 0.25, 0.5, 9.0, 9.0, 9.0];
        let of_corners = painted(Role::Plain, 1, Values::Doubles(corners), PaintedOn::Corners).unwrap();
        assert_eq!(of_corners, of_vertices.unwrap());
        assert_eq!(of_corners.unwrap().numbers, [0.25, 0.5, 1.0]);
    }

    #[test]
    fn what_is_no_weight_is_none_and_a_wrong_number_of_values_is_said() {
        let none = |role, extent, values| painted(role, extent, values, PaintedOn::Vertices).unwrap().is_none();
        assert!(none(Role::Normal, 3, Values::Floats(vec![0.0; 9])));
        assert!(none(Role::TextureCoordinate, 2, Values::Floats(vec![0.0; 6])));
        assert!(none(Role::Plain, 1, Values::Words(vec![String::new(); 3])));
        assert!(none(Role::Colour, 3, Values::Integers(vec![255; 9])));
        let said = |on| painted(Role::Colour, 3, Values::Floats(vec![0.0; 6]), on).unwrap_err().0;
        assert_eq!(said(PaintedOn::Vertices), "2 for 3 vertices");
        assert_eq!(said(PaintedOn::Corners), "2 for 6 corners");
    }

    /// Each part takes from the budget what it adds: three hundred parts as much as one with all vertices. A second attribute of the
    /// same name is left out.
    #[test]
    fn parts_cost_what_they_add_and_names_are_not_taken_twice() {
        let (mut mesh, budget) = (Mesh::default(), Budget::of(0));
        let part = Painted { name: "Cd".to_owned(), extent: 4, numbers: vec![0.5; 4 * 4000] };
        for i in 0..300 {
            part.add_to(&mut mesh, 4000 * i, &budget).unwrap();
        }
        assert_eq!(mesh.weights_named("Cd.a").unwrap().values.len(), 4000 * 300);
        let again = part.add_to(&mut mesh, 4000 * 299, &budget).unwrap_err().0;
        assert_eq!(again, "another attribute has the same name");
    }

    #[test]
    fn a_part_without_them_has_nought() {
        let mut mesh = Mesh { positions: vec![Vec3::ZERO; 5], ..Mesh::default() };
        let colour = Painted { name: "Cd".to_owned(), extent: 3, numbers: vec![0.5; 6] };
        colour.add_to(&mut mesh, 2, &Budget::of(0)).unwrap();
        let of = mesh.weights_named("Cd").unwrap();
        assert_eq!([0, 1, 2, 3, 4].map(|v| of.at(v)), [0.0, 0.0, 0.5, 0.5, 0.0]);
        for i in 0..MOST_NAMES {
            let number = Painted { name: i.to_string(), extent: 1, numbers: vec![1.0; 5] };
            assert_eq!(number.add_to(&mut mesh, 0, &Budget::of(0)).is_ok(), i + 4 < MOST_NAMES, "{i}");
        }
    }
}
