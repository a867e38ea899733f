//! Skin that carries roots: a mesh that deforms from frame to frame, in head space.
//!
//! A root belongs to a place of the skin at rest: the nearest triangle, and its weights there. In another frame the place
//! is elsewhere and turned, and takes the strand along: see docs/motion-forms.md, Skin.

use std::collections::HashMap;
use std::sync::Arc;

use glam::{DMat3, DQuat, DVec3, Vec3};

use crate::distance::{Nearest, weights};
use crate::error::SettingError;
use crate::mesh::{Mesh, vertex_normals};
use crate::strands::{Strands, bounds};

/// A mesh at rest that carries roots, and its shape in every frame, if known beforehand.
#[derive(Clone, Debug)]
pub struct Skin {
    /// All triangles of the mesh: they determine the normals.
    mesh: Arc<[[u32; 3]]>,
    /// For every vertex of the mesh, the first one at the same place at rest, so that a seam has one normal.
    same: Arc<[u32]>,
    /// The vertices that a [`SkinFrame`] keeps, by their numbers in the mesh.
    kept: Arc<[u32]>,
    /// The triangles that carry roots, by their corners among `kept`.
    triangles: Arc<[[u32; 3]]>,
    /// Finds the triangle at rest, of all that the mesh has, and where each of these is among `triangles`; [`LEFT_OUT`] where it is not.
    nearest: Arc<Nearest>,
    numbers: Arc<[u32]>,
    rest: SkinFrame,
    /// From frame 0 on. Empty for a skin at rest.
    frames: Arc<[SkinFrame]>,
    /// The frame before frame 0: the motion continued backward.
    before: Option<Arc<SkinFrame>>,
}

/// A triangle that carries no root.
const LEFT_OUT: u32 = u32::MAX;

impl PartialEq for Skin {
    fn eq(&self, other: &Self) -> bool {
        // All else follows from these.
        (&self.mesh, &self.same, &self.kept, &self.triangles)
            == (&other.mesh, &other.same, &other.kept, &other.triangles)
            && (&self.rest, &self.frames) == (&other.rest, &other.frames)
    }
}

/// A skin in one frame, from [`Skin::frame`].
#[derive(Clone, Debug, PartialEq)]
pub struct SkinFrame {
    points: Vec<Vec3>,
    normals: Vec<Vec3>,
}

impl SkinFrame {
    /// Gives all its numbers, for identifying it.
    pub fn numbers(&self, take: &mut dyn FnMut(&[f32])) {
        [&self.points, &self.normals].into_iter().flatten().for_each(|v| take(&v.to_array()));
    }

    /// The frame before this one if the motion to `next` is continued backward.
    #[must_use]
    pub fn continued_back_from(&self, next: &Self) -> Self {
        self.between(next, -1.0)
    }

    /// Interpolates each vertex to `next` linearly; `part` is 0 here and 1 there.
    #[must_use]
    pub fn between(&self, next: &Self, part: f32) -> Self {
        let mix = |a: &[Vec3], b: &[Vec3]| a.iter().zip(b).map(|(a, b)| *a + part * (*b - *a)).collect();
        Self { points: mix(&self.points, &next.points), normals: mix(&self.normals, &next.normals) }
    }
}

impl Skin {
    /// A skin with this shape at rest (head space, cm). Triangles without an area carry no roots. `thing` names the mesh in
    /// errors.
    ///
    /// # Errors
    /// A mesh without a triangle that has an area, with a vertex that is not finite, or a triangle whose vertex it lacks.
    pub fn new(mesh: &Mesh, thing: &str) -> Result<Self, SettingError> {
        let refused = |what: &str| Err(SettingError::new(thing, "", what));
        if mesh.triangles.iter().flatten().any(|&v| v as usize >= mesh.positions.len()) {
            return refused("has a triangle with a vertex that it lacks: give a valid mesh");
        }
        if mesh.positions.iter().any(|p| !p.is_finite()) {
            return refused("has a vertex that is not finite: every coordinate must be a finite number");
        }
        let (same, kept) = (mesh.first_at_place(), (0..mesh.positions.len() as u32).collect::<Arc<[u32]>>());
        let rest = shaped(&mesh.positions, &mesh.triangles, &same, &kept);
        let carries = |triangle: &&[u32; 3]| axes(&rest, triangle, DVec3::splat(1.0 / 3.0)).is_some();
        let triangles: Arc<[_]> = mesh.triangles.iter().filter(carries).copied().collect();
        if triangles.is_empty() {
            return refused("has no triangle with an area, so it carries no hair: give a mesh of the skin");
        }
        Ok(Self {
            mesh: mesh.triangles.as_slice().into(),
            same: same.into(),
            kept,
            nearest: Arc::new(Nearest::new(&rest.points, &triangles)),
            numbers: (0..triangles.len() as u32).collect(),
            triangles,
            rest,
            frames: Arc::default(),
            before: None,
        })
    }

    /// The same skin with only the triangles that carry these strands. Its frames need less memory. Take all hair and its
    /// carriers: other strands would get the nearest of these triangles.
    #[must_use]
    pub fn under(&self, hair: &[&Strands]) -> Self {
        let mut used = vec![false; self.numbers.len()];
        for strand in hair.iter().flat_map(|strands| strands.iter()) {
            used[self.nearest.triangle(strand[0])] = true;
        }
        let (mut vertices, mut kept, mut triangles) = (HashMap::new(), Vec::new(), Vec::new());
        let mut vertex = |v: u32| {
            *vertices.entry(v).or_insert_with(|| {
                kept.push(v);
                kept.len() as u32 - 1
            })
        };
        let numbers = self.numbers.iter().zip(used).map(|(&number, used)| {
            let own = self.triangles.get(number as usize).filter(|_| used);
            own.map_or(LEFT_OUT, |own| {
                triangles.push(own.map(&mut vertex));
                triangles.len() as u32 - 1
            })
        });
        let numbers = numbers.collect();
        let cut = |frame: &SkinFrame| {
            let some = |all: &[Vec3]| kept.iter().map(|&v| all[v as usize]).collect();
            SkinFrame { points: some(&frame.points), normals: some(&frame.normals) }
        };
        Self {
            numbers,
            rest: cut(&self.rest),
            frames: self.frames.iter().map(cut).collect(),
            before: self.before.as_deref().map(|before| Arc::new(cut(before))),
            kept: kept.iter().map(|&v| self.kept[v as usize]).collect(),
            triangles: triangles.into(),
            ..self.clone()
        }
    }

    /// The skin with the vertices of the mesh at other places (head space, cm), in the mesh's order.
    ///
    /// # Errors
    /// Another number of vertices than at rest, and a vertex that is not finite.
    pub fn frame(&self, positions: &[Vec3]) -> Result<SkinFrame, SettingError> {
        if positions.len() != self.same.len() {
            let (now, rest) = (positions.len(), self.same.len());
            let remedy =
                format!("its skin has {rest} at rest: skin that carries hair keeps its vertices in every frame");
            return Err(SettingError::new("", format!("{now} vertices"), remedy));
        }
        match positions.iter().position(|p| !p.is_finite()) {
            Some(v) => {
                let remedy = "every coordinate must be a finite number";
                Err(SettingError::new(format!("vertex {v}"), positions[v], remedy))
            }
            None => Ok(shaped(positions, &self.mesh, &self.same, &self.kept)),
        }
    }

    /// The same skin with its shape in every frame from frame 0 on. After the last one it stays.
    #[must_use]
    pub fn with_frames(self, frames: Vec<SkinFrame>) -> Self {
        let before = match &frames[..] {
            [first, second, ..] if first != second => Some(Arc::new(first.continued_back_from(second))),
            _ => None,
        };
        Self { frames: frames.into(), before, ..self }
    }

    /// Number of triangles that carry roots.
    #[must_use]
    #[expect(clippy::len_without_is_empty, reason = "there is at least one")]
    pub fn len(&self) -> usize {
        self.triangles.len()
    }

    /// The box around all that carries hair, in all frames; `None` for a skin that stays at rest.
    #[must_use]
    pub fn bounds(&self) -> Option<[Vec3; 2]> {
        let boxes = self.frames.iter().map(|frame| bounds(&frame.points));
        boxes.reduce(|[low, high], [from, to]| [low.min(from), high.max(to)])
    }

    /// Its frames; none for a skin that stays at rest.
    #[must_use]
    pub fn frames(&self) -> &[SkinFrame] {
        &self.frames
    }

    /// The shape at rest.
    #[must_use]
    pub fn rest(&self) -> &SkinFrame {
        &self.rest
    }

    /// Its shape in a frame, in the frame before and in the one before that.
    pub(crate) fn around(&self, frame: u32) -> [&SkinFrame; 3] {
        [0, 1, 2].map(|back| match frame.checked_sub(back) {
            Some(frame) => self.at(frame),
            None => self.before.as_deref().unwrap_or_else(|| self.at(0)),
        })
    }

    /// Its shape in a frame.
    pub(crate) fn at(&self, frame: u32) -> &SkinFrame {
        self.frames.get(frame as usize).or(self.frames.last()).unwrap_or(&self.rest)
    }

    /// The same motion, resampled from `of` to `frames` frames.
    pub(crate) fn resampled(&self, of: u32, frames: u32) -> Self {
        if self.frames.len() < 2 {
            return self.clone();
        }
        let at = |n: u32| {
            let place = f64::from(n) * f64::from(of) / f64::from(frames);
            self.at(place as u32).between(self.at(place as u32 + 1), place.fract() as f32)
        };
        self.clone().with_frames((0..=frames).map(at).collect())
    }

    /// Of every frame at which the triangle of a root has no area, so that it gives no turn: the number of such roots.
    #[must_use]
    pub fn folded(&self, hair: &Strands) -> Vec<(u32, usize)> {
        let places = self.places(hair.iter().map(|strand| strand[0]));
        let count = |frame: &SkinFrame| places.iter().filter(|place| place.axes_in(frame).is_none()).count();
        let counts = self.frames.iter().zip(0..).map(|(frame, n)| (n, count(frame)));
        counts.filter(|&(_, count)| count > 0).collect()
    }

    /// The place of a root at rest.
    pub(crate) fn place(&self, root: Vec3) -> SkinPlace {
        let number = self.numbers[self.nearest.triangle(root)];
        if number != LEFT_OUT {
            return SkinPlace::new(self, root, number as usize);
        }
        // Hair that the skin was not cut for.
        let places = (0..self.triangles.len()).map(|triangle| SkinPlace::new(self, root, triangle));
        let distance = |place: &SkinPlace| place.rest.distance_squared(place.root);
        places.min_by(|a, b| distance(a).total_cmp(&distance(b))).expect("a skin has a triangle")
    }

    /// The places of some roots at rest.
    pub(crate) fn places(&self, roots: impl Iterator<Item = Vec3>) -> Vec<SkinPlace> {
        roots.map(|root| self.place(root)).collect()
    }
}

/// A frame that keeps some vertices of the mesh.
fn shaped(positions: &[Vec3], mesh: &[[u32; 3]], same: &[u32], kept: &[u32]) -> SkinFrame {
    let normals = vertex_normals(positions, mesh, |v| same[v] as usize);
    let normals = kept.iter().map(|&v| normals[same[v as usize] as usize]).collect();
    SkinFrame { points: kept.iter().map(|&v| positions[v as usize]).collect(), normals }
}

/// A place of the skin that carries a root.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SkinPlace {
    corners: [u32; 3],
    /// Of the corners.
    weights: DVec3,
    /// Where it is at rest.
    rest: DVec3,
    /// None where the triangle has no area, so that it never turns.
    axes: Option<DMat3>,
    root: DVec3,
}

impl SkinPlace {
    fn new(skin: &Skin, root: Vec3, triangle: usize) -> Self {
        let corners = skin.triangles[triangle];
        let weights = weights(corners.map(|v| skin.rest.points[v as usize]), root).as_dvec3();
        let root = root.as_dvec3();
        let mut place = Self { corners, weights, rest: DVec3::ZERO, axes: None, root };
        place.rest = place.at(&skin.rest);
        place.axes = place.axes_in(&skin.rest);
        place
    }

    fn at(&self, frame: &SkinFrame) -> DVec3 {
        let [a, b, c] = self.corners.map(|v| frame.points[v as usize].as_dvec3());
        self.weights.x * a + self.weights.y * b + self.weights.z * c
    }

    fn axes_in(&self, frame: &SkinFrame) -> Option<DMat3> {
        axes(frame, &self.corners, self.weights)
    }

    /// The turn of the skin from rest, exactly none where it has not moved. Where the triangle has no area, none.
    pub fn turn(&self, frame: &SkinFrame) -> DQuat {
        match self.axes.zip(self.axes_in(frame)) {
            Some((rest, axes)) if axes != rest => DQuat::from_mat3(&(axes * rest.transpose())).normalize(),
            _ => DQuat::IDENTITY,
        }
    }

    /// Where the skin has carried a point of the strand; `turn` is that of the frame.
    pub fn carried(&self, frame: &SkinFrame, turn: DQuat, point: DVec3) -> DVec3 {
        let away = point - self.rest;
        point + (self.at(frame) - self.rest) + (turn * away - away)
    }

    /// Where the skin has carried the root; `turn` is that of the frame.
    pub fn root_on(&self, frame: &SkinFrame, turn: DQuat) -> DVec3 {
        self.carried(frame, turn, self.root)
    }

    /// Where the skin has carried the root.
    pub fn root(&self, frame: &SkinFrame) -> DVec3 {
        self.root_on(frame, self.turn(frame))
    }
}

/// Axes that turn with the skin at a place of a triangle; none if the triangle has no area or the normals there cancel.
fn axes(frame: &SkinFrame, corners: &[u32; 3], weights: DVec3) -> Option<DMat3> {
    let of = |all: &[Vec3]| corners.map(|v| all[v as usize].as_dvec3());
    let ([a, b, c], normals) = (of(&frame.points), of(&frame.normals));
    let normal = weights.x * normals[0] + weights.y * normals[1] + weights.z * normals[2];
    let (normal, _) = (normal.try_normalize()?, (b - a).cross(c - a).try_normalize()?);
    let across = normal.cross(b - a).try_normalize()?;
    Some(DMat3::from_cols(across.cross(normal), across, normal))
}
