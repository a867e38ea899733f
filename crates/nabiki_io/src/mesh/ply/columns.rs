//! Numbers of the vertices of a .ply beside their places: colours and weights.

use nabiki::Mesh;
use nabiki_exchange::{Budget, Painted};

use super::{Element, Kind};
use crate::error::Result;
use crate::mesh::obj::COLOUR;

/// Those of an element, property by property.
pub(super) struct Columns<'a> {
    element: &'a Element,
    /// The numbers of each property that is read.
    columns: Vec<Option<Vec<f32>>>,
}

/// The properties of a colour.
const CHANNELS: [&str; 4] = ["red", "green", "blue", "alpha"];
/// What is no weight.
const NORMAL: [&str; 3] = ["nx", "ny", "nz"];

impl<'a> Columns<'a> {
    /// Those of the vertices, but for the properties that are read elsewhere. Other elements have none.
    pub fn of(element: &'a Element, elsewhere: &[Option<usize>]) -> Self {
        let is_read = |p: usize| {
            let property = &element.properties[p];
            element.name == "vertex"
                && property.list.is_none()
                && !elsewhere.contains(&Some(p))
                && !NORMAL.contains(&property.name.as_str())
        };
        Self { element, columns: (0..element.properties.len()).map(|p| is_read(p).then(Vec::new)).collect() }
    }

    /// Takes a number of property `p`.
    pub fn take(&mut self, p: usize, value: f64, budget: &Budget) -> Result<()> {
        if let Some(column) = &mut self.columns[p] {
            budget.take(size_of::<f32>() as u64, "properties of vertices")?;
            column.push(value as f32);
        }
        Ok(())
    }

    /// Adds the colour, and every other property by its name. Whole numbers of a colour are shares of the largest of their
    /// type; those of other properties stand for themselves.
    pub fn add_to(mut self, mesh: &mut Mesh, first: usize, budget: &Budget, lost: &mut Vec<String>) {
        let properties = &self.element.properties;
        let place = |name: &&str| properties.iter().position(|property| property.name == **name);
        let channels: Vec<usize> = CHANNELS.iter().map_while(place).collect();
        let mut all = Vec::new();
        if channels.len() >= 3 && channels.iter().all(|&p| self.columns[p].is_some()) {
            let mut parts: Vec<(Vec<f32>, f32)> = Vec::new();
            for p in channels {
                parts.push((self.columns[p].take().unwrap_or_default(), largest(properties[p].kind)));
            }
            let mut numbers: Vec<f32> = Vec::new();
            for v in 0..parts[0].0.len() {
                numbers.extend(parts.iter().map(|(column, full)| column[v] / full));
            }
            all.push(Painted { name: COLOUR.to_owned(), extent: parts.len(), numbers });
        }
        for (column, property) in self.columns.into_iter().zip(properties) {
            all.extend(column.map(|numbers| Painted { name: property.name.clone(), extent: 1, numbers }));
        }
        for painted in all {
            let added = painted.add_to(mesh, first, budget);
            lost.extend(added.err().map(|why| format!("{:.80}: {why}", painted.name)));
        }
    }
}

/// The number that stands for a full channel.
fn largest(kind: Kind) -> f32 {
    match kind {
        Kind::I8 => 127.0,
        Kind::U8 => 255.0,
        Kind::I16 => 32767.0,
        Kind::U16 => 65535.0,
        Kind::I32 => i32::MAX as f32,
        Kind::U32 => u32::MAX as f32,
        Kind::F32 | Kind::F64 => 1.0,
    }
}
