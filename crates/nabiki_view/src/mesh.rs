//! The head and other bodies as triangles, and the scalp darkened by the roots that stand in it.

use std::collections::HashMap;

use bytemuck::{Pod, Zeroable};
use glam::{Affine3A, IVec3, Vec3};
use nabiki::Mesh;
use nabiki_groom::face::Paint;

/// A corner of a triangle (head space, cm).
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Corner {
    /// Where.
    pub place: [f32; 3],
    /// Part of the skin that hair too short to be drawn covers, 0..1.
    pub stubble: f32,
    /// Outward, unit.
    pub normal: [f32; 3],
    /// Share of the skin's sheen that what is painted over it leaves, 0..1.
    pub sheen: f32,
    /// Linear.
    pub colour: [f32; 3],
    /// Keeps the numbers at their places.
    pub pad_too: f32,
}

/// The colours of a head.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Skin {
    /// Bare skin (linear).
    pub colour: [f32; 3],
    /// The colour of a mass of its hair (linear), if the face of the built-in bust is to be painted.
    pub hair_of_face: Option<[f32; 3]>,
}

impl Skin {
    fn at(&self, p: Vec3) -> [f32; 3] {
        self.hair_of_face.map_or(self.colour, |hair| Paint::at(p).over(self.colour, hair))
    }

    /// Brows and lashes have none of it, and what is darker than bare skin has less.
    fn sheen(&self, painted: [f32; 3]) -> f32 {
        (painted.iter().sum::<f32>() / self.colour.iter().sum::<f32>().max(1e-6)).min(1.0)
    }
}

/// Triangles for the card.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Surface {
    /// Corners.
    pub corners: Vec<Corner>,
    /// Three of them each.
    pub indices: Vec<u32>,
}

impl Surface {
    /// A body in its own space, of a colour (linear).
    pub fn of(mesh: &Mesh, colour: [f32; 3]) -> Self {
        let corners = mesh.positions.iter().zip(mesh.vertex_normals()).map(|(&place, normal)| Corner {
            place: place.to_array(),
            normal: normal.to_array(),
            colour,
            sheen: 1.0,
            ..Corner::default()
        });
        Self { corners: corners.collect(), indices: mesh.triangles.iter().flatten().copied().collect() }
    }

    /// The same with the vertices of `mesh` at other places, if it bends.
    pub fn bent(&self, mesh: &Mesh, vertices: Option<&[Vec3]>) -> Self {
        let mut bent = self.clone();
        if let Some(vertices) = vertices {
            let mesh = Mesh { positions: vertices.to_vec(), triangles: mesh.triangles.clone(), ..Mesh::default() };
            for ((corner, place), normal) in bent.corners.iter_mut().zip(vertices).zip(mesh.vertex_normals()) {
                (corner.place, corner.normal) = (place.to_array(), normal.to_array());
            }
        }
        bent
    }

    /// The head, `shade` square centimetres of stubble standing on each root, which stands for `share` of them.
    pub fn head(mesh: &Mesh, skin: Skin, roots: &[Vec3], shade: f32, share: f32) -> Self {
        let scalp = Scalp::new(roots, share);
        let mut surface = Self::of(mesh, skin.colour);
        for corner in &mut surface.corners {
            corner.colour = skin.at(corner.place.into());
            corner.sheen = skin.sheen(corner.colour);
            corner.stubble = 1.0 - (-shade * share * scalp.density(corner.place.into())).exp();
        }
        surface
    }

    /// Another surface beside it, moved into head space.
    pub fn add(&mut self, other: &Self, head_from_body: &Affine3A) {
        let first = self.corners.len() as u32;
        self.corners.extend(other.corners.iter().map(|corner| Corner {
            place: head_from_body.transform_point3(corner.place.into()).to_array(),
            normal: head_from_body.transform_vector3(corner.normal.into()).to_array(),
            ..*corner
        }));
        self.indices.extend(other.indices.iter().map(|i| first + i));
    }
}

/// Roots by the cell they stand in.
struct Scalp {
    reach: f32,
    cells: HashMap<IVec3, Vec<Vec3>>,
}

impl Scalp {
    /// Few roots that stand for many tint farther about them: as far as to their neighbours.
    fn new(roots: &[Vec3], share: f32) -> Self {
        let reach = (0.16 * share.max(1.0).sqrt()).clamp(0.8, 3.2);
        let mut cells: HashMap<IVec3, Vec<Vec3>> = HashMap::new();
        for &root in roots {
            cells.entry((root / reach).floor().as_ivec3()).or_default().push(root);
        }
        Self { reach, cells }
    }

    /// Roots a square centimetre about a place; near ones count more.
    fn density(&self, place: Vec3) -> f32 {
        let home = (place / self.reach).floor().as_ivec3();
        let squared = self.reach * self.reach;
        let mut sum = 0.0;
        for i in 0..27 {
            let cell = home + IVec3::new(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
            for root in self.cells.get(&cell).into_iter().flatten() {
                sum += (1.0 - root.distance_squared(place) / squared).max(0.0);
            }
        }
        sum * 2.0 / (std::f32::consts::PI * squared)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stubble_covers_where_roots_stand_and_nowhere_else() {
        let plane = Mesh {
            positions: vec![Vec3::ZERO, Vec3::new(30.0, 0.0, 0.0), Vec3::new(0.0, 0.0, 30.0)],
            triangles: vec![[0, 2, 1]],
            ..Mesh::default()
        };
        for share in [1.0_f32, 64.0] {
            let spacing = 0.2 * share.sqrt();
            let roots: Vec<Vec3> = (-40..=40)
                .flat_map(|i| (-40..=40).map(move |j| Vec3::new(i as f32, 0.0, j as f32) * spacing))
                .filter(|p| p.length() < 12.0)
                .collect();
            let shade = 0.03;
            let skin = Skin { colour: [0.5; 3], hair_of_face: None };
            let surface = Surface::head(&plane, skin, &roots, shade, share);
            // Roots spread evenly cover as much, however few stand for all; a lattice beats by a fifth of the density at most.
            let whole = 1.0 - (-shade / 0.04_f32).exp();
            assert!((surface.corners[0].stubble - whole).abs() < 0.15, "{share}: {}", surface.corners[0].stubble);
            assert_eq!(surface.corners[1].stubble, 0.0);
        }
    }

    #[test]
    fn a_body_is_where_its_pose_has_it() {
        let triangle =
            Mesh { positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y], triangles: vec![[0, 1, 2]], ..Mesh::default() };
        let mut all = Surface::of(&triangle, [0.1; 3]);
        let turned = Affine3A::from_rotation_translation(glam::Quat::from_rotation_y(std::f32::consts::PI), Vec3::Z);
        all.add(&Surface::of(&triangle, [0.2; 3]), &turned);
        assert_eq!(all.indices, [0, 1, 2, 3, 4, 5]);
        let corner = all.corners[4];
        assert!(Vec3::from(corner.place).distance(Vec3::new(-1.0, 0.0, 1.0)) < 1e-6);
        assert!(Vec3::from(corner.normal).distance(-Vec3::Z) < 1e-6);
        assert_eq!((corner.colour, corner.stubble), ([0.2; 3], 0.0));
    }
}
