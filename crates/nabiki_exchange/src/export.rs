//! The settings of every exporter of moving hair, and the interface for its frames.

use std::io;

use glam::{DAffine3, DMat4, Vec3};

use nabiki::strands::not_finite;
use nabiki::{Hair, Mesh, Strands};

use crate::control::Course;
use crate::in_place::point;

/// A groom at rest, and how to write it.
#[derive(Clone, Debug)]
pub struct Export<'a> {
    /// The hair at rest (head space, cm). Its strands determine the number of points of each frame.
    pub hair: &'a Hair,
    /// The head to write as well (head space, cm), or `None`.
    pub head: Option<&'a Mesh>,
    /// Diameter of hair without widths (cm). `None` writes no widths; readers then use their own default.
    pub default_width: Option<f32>,
    /// Colour of hair without colours (linear RGB). `None` writes no colours.
    pub default_colour: Option<[f32; 3]>,
    /// Whether to write the points at rest as an attribute, for programs that transfer the hair to another head.
    pub rest: bool,
    /// Whether to write velocities with the points of each frame. They double the size.
    pub velocities: bool,
    /// Frames per second.
    pub frame_rate: f64,
    /// Number of the first frame.
    pub first_frame: i32,
    /// Number of frames that will be written, for formats that begin with it.
    pub frames: u32,
    /// Transform from head space to the space of the file's hair: the inverse of the import's transform, or the
    /// identity.
    pub file_from_head: DAffine3,
    /// The basis of the written control points, chosen so that curves pass through the points of the hair. Straight,
    /// except for samples over the curves of another file.
    pub course: Course,
    /// For samples over the curves of another file: whether a skeleton moves those curves.
    pub bound: bool,
    /// Length of the file's unit (m): 0.01 if `file_from_head` keeps centimetres.
    pub meters_per_unit: f64,
    /// Whether +z is up in the file; otherwise +y. This only declares the axis; `file_from_head` does the rotation.
    pub z_up: bool,
    /// Whether the head faces +x in the file, as it does where the hair comes from no file. Formats in which all faces
    /// look along another axis turn it.
    pub faces_x: bool,
}

impl<'a> Export<'a> {
    /// An export of hair without a head, in centimetres, y up, from frame 0 on.
    pub fn new(hair: &'a Hair, frame_rate: f64) -> Self {
        Self {
            hair,
            head: None,
            default_width: None,
            default_colour: None,
            rest: false,
            velocities: false,
            frame_rate,
            first_frame: 0,
            frames: 1,
            file_from_head: DAffine3::IDENTITY,
            course: Course::LINEAR,
            bound: false,
            meters_per_unit: 0.01,
            z_up: false,
            faces_x: false,
        }
    }

    /// Diameter by point in the file's unit, if the hair has any.
    pub fn widths(&self) -> Option<Vec<f32>> {
        let scale = self.file_from_head.matrix3.determinant().abs().cbrt() as f32;
        let points = self.hair.strands.points().len();
        let attributes = &self.hair.attributes;
        let constant = attributes.constant.width.or(self.default_width);
        let one = constant.map(|w| vec![w * scale; points]);
        attributes.width.as_ref().map(|w| w.iter().map(|w| w * scale).collect()).or(one)
    }

    /// The points at rest in the file's space.
    pub fn rest_points(&self) -> Vec<[f32; 3]> {
        let points = self.hair.strands.points().iter();
        points.map(|&p| point(&self.file_from_head, p).to_array()).collect()
    }

    /// Transparency by point, from 0 (opaque) to 1 (invisible); `None` if everything is opaque.
    pub fn transparency(&self) -> Option<Vec<f32>> {
        let attributes = &self.hair.attributes;
        let constant = attributes.constant.transparency.filter(|&t| t != 0.0);
        let one = constant.map(|t| vec![t; self.hair.strands.points().len()]);
        attributes.transparency.clone().or(one)
    }

    /// Refuses attributes of the wrong length, strands with fewer than two points, and an invalid frame rate, unit or
    /// colour.
    pub fn check(&self) -> io::Result<()> {
        let invalid = |problem: String| Err(io::Error::new(io::ErrorKind::InvalidInput, problem));
        if let Err(e) = self.hair.check_lengths() {
            return invalid(e.to_string());
        }
        if self.hair.strands.is_empty() {
            return invalid("there are no strands to write".to_owned());
        }
        if let Some(s) = self.hair.strands.iter().position(|strand| strand.len() < 2) {
            let n = self.hair.strands.strand(s).len();
            return invalid(format!("strand {s} has {n} points: a curve needs at least two; leave it out"));
        }
        if !(self.frame_rate.is_finite() && self.frame_rate > 0.0) {
            return invalid(format!("frame rate {}: must be a finite number above 0", self.frame_rate));
        }
        if !(self.meters_per_unit.is_finite() && self.meters_per_unit > 0.0) {
            return invalid(format!("meters per unit {}: must be a finite number above 0", self.meters_per_unit));
        }
        if let Some(color) = self.default_colour.filter(|c| !c.iter().all(|x| x.is_finite() && *x >= 0.0)) {
            return invalid(format!("colour {color:?}: must be finite and not below 0"));
        }
        Ok(())
    }

    /// The points of `strands` in the file's space, as control points of its curves: the points themselves, or `room`
    /// filled with them.
    ///
    /// # Errors
    /// If the strands do not match the groom, or a point is not finite.
    pub fn points<'p>(&self, strands: &'p Strands, room: &'p mut Vec<Vec3>) -> io::Result<&'p [Vec3]> {
        let invalid = |problem: String| Err(io::Error::new(io::ErrorKind::InvalidInput, problem));
        if strands.starts() != self.hair.strands.starts() {
            let (found, expected) = (strands.points().len(), self.hair.strands.points().len());
            return invalid(format!("{found} points in the frame, {expected} in the groom: strands must not change"));
        }
        let points = if self.file_from_head == DAffine3::IDENTITY && self.course == Course::LINEAR {
            strands.points()
        } else {
            room.clear();
            room.extend(strands.points().iter().map(|&p| point(&self.file_from_head, p)));
            self.course.control_points(strands, room);
            room
        };
        match not_finite(points) {
            Some(at) => invalid(format!("point {at} is {}: only finite points can be written", points[at])),
            None => Ok(points),
        }
    }

    /// The points of `strands` in the world of the file, with the head where it is.
    ///
    /// # Errors
    /// As [`points`](Self::points).
    pub fn world_points(
        &self,
        strands: &Strands,
        world_from_head: &DAffine3,
    ) -> io::Result<impl Iterator<Item = Vec3>> {
        let file_from_head = self.file_from_head * *world_from_head;
        let mut room = Vec::new();
        self.points(strands, &mut room)?;
        Ok(strands.points().iter().map(move |&p| point(&file_from_head, p)))
    }

    /// The points of the head in the file's space, and whether that space is mirrored.
    pub fn skin(&self, mesh: &Mesh) -> (Vec<Vec3>, bool) {
        let points = mesh.positions.iter().map(|&p| point(&self.file_from_head, p)).collect();
        (points, self.file_from_head.matrix3.determinant() < 0.0)
    }

    /// The transform of the prim or object above the hair, which moves with the head. For formats that multiply row
    /// vectors from the left, its columns are their rows.
    pub fn parent(&self, world_from_head: &DAffine3) -> DMat4 {
        if *world_from_head == DAffine3::IDENTITY {
            return DMat4::IDENTITY;
        }
        DMat4::from(self.file_from_head * *world_from_head * self.file_from_head.inverse())
    }
}

/// Velocities from differences of frames, one frame late. The velocities of a frame take its points exactly to those of
/// the next frame, as readers that move points along their velocities expect.
#[derive(Debug, Default)]
pub struct Velocities {
    last: Vec<Vec3>,
    found: Vec<Vec3>,
}

impl Velocities {
    /// The velocities (units per second) of the frame before `points`; `None` at the first frame.
    ///
    /// # Errors
    /// A velocity that is not finite.
    pub fn before(&mut self, points: &[Vec3], frame_rate: f64) -> io::Result<Option<&[Vec3]>> {
        let is_first = self.last.is_empty();
        self.found.clear();
        self.found.extend(points.iter().zip(&self.last).map(|(&p, &q)| (p - q) * frame_rate as f32));
        self.last.clear();
        self.last.extend_from_slice(points);
        match not_finite(&self.found) {
            Some(at) => {
                let problem = format!("point {at} moves at {}: only finite velocities can be written", self.found[at]);
                Err(io::Error::new(io::ErrorKind::InvalidInput, problem))
            }
            None => Ok((!is_first).then_some(&self.found)),
        }
    }

    /// The velocities of the last frame, continued from the frame before; `None` for hair with a single frame.
    pub fn of_last(&self) -> Option<&[Vec3]> {
        (!self.found.is_empty()).then_some(&self.found)
    }
}

/// A writer that takes the frames of the hair in order. The file gets its name when `finish` returns.
pub trait FrameSink: Send {
    /// Writes the next frame.
    ///
    /// `strands`: head space, cm, point for point those of the groom. `world_from_head`: where the head is in
    /// this frame (cm), identity for a head that rests.
    ///
    /// # Errors
    /// What the disk says, strands that do not match the groom, points that are not finite.
    fn frame(&mut self, strands: &Strands, world_from_head: &DAffine3) -> io::Result<()>;

    /// Completes the file and gives it its name. Returns what it holds, in words, where that is worth telling.
    ///
    /// # Errors
    /// What the disk says.
    fn finish(self: Box<Self>) -> io::Result<Option<String>>;
}
