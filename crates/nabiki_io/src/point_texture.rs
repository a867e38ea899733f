//! Moving hair for engines as a vertex-animation texture: an OpenEXR picture with the position of every vertex in every frame.
//!
//! Beside it are the mesh that it moves, a `.glb`, and a text on how to use both.

mod across;
mod layout;
mod mesh;
mod readme;

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use exr::prelude::{
    Encoding, Image, ImageAttributes, IntegerBounds, Layer, LayerAttributes, SpecificChannels, Vec2, WritableImage,
};
use glam::{DAffine3, Vec3};
use nabiki::Strands;
use nabiki::strands::{bounds, not_finite};
use nabiki_exchange::{Export, FrameSink};
use nabiki_file::PartFile;

use crate::gltf_write::{colour, gltf_from_file, on_head};
use across::Across;
use layout::Layout;

/// Where the mesh of a texture is written.
pub(crate) fn mesh_path(path: &Path) -> PathBuf {
    beside(path, ".glb")
}

/// Where the text about a texture is written.
pub(crate) fn text_path(path: &Path) -> PathBuf {
    beside(path, ".txt")
}

fn beside(path: &Path, ending: &str) -> PathBuf {
    let mut name = path.as_os_str().to_owned();
    name.push(ending);
    name.into()
}

/// Bytes that the positions of all vertices take until they are written.
pub(crate) fn held_bytes(export: &Export<'_>, half_width: Option<f32>) -> u64 {
    let all = vertices(export, half_width).saturating_mul(export.frames.into());
    all.saturating_mul(size_of::<Vec3>() as u64)
}

fn vertices(export: &Export<'_>, half_width: Option<f32>) -> u64 {
    export.hair.strands.points().len() as u64 * if half_width.is_some() { 2 } else { 1 }
}

/// A texture that is being written. Rows are compressed together, so it is made at the end.
pub(crate) struct PointTexture<'a> {
    texture: PartFile,
    mesh: PartFile,
    text: PartFile,
    /// The name of the texture's file.
    name: String,
    export: Export<'a>,
    /// Half the width of ribbons (m); `None` draws lines.
    half_width: Option<f32>,
    layout: Layout,
    gltf_from_file: DAffine3,
    /// The ribbons of the first frame, and the transform of the head in it.
    first: Option<(Across, DAffine3)>,
    /// The vertices of all frames.
    vertices: Vec<Vec3>,
    written: usize,
    room: Vec<Vec3>,
}

impl<'a> PointTexture<'a> {
    /// Begins the three files, for as many frames as the export says.
    ///
    /// # Errors
    /// What the disk says; hair that is not fit to be written, or too much of it.
    pub fn create(path: &Path, export: Export<'a>, half_width: Option<f32>) -> io::Result<Self> {
        export.check()?;
        let lines = if half_width.is_some() { ", or lines (--export-cards 0)" } else { "" };
        let way_out = format!("use fewer strands (simulate --strands N) or fewer frames{lines}");
        let layout = Layout::new(vertices(&export, half_width), export.frames.into());
        let layout = layout.map_err(|problem| invalid(format!("{problem}: {way_out}")))?;
        Ok(Self {
            texture: PartFile::create(path)?,
            mesh: PartFile::create(&mesh_path(path))?,
            text: PartFile::create(&text_path(path))?,
            name: path.file_name().unwrap_or_default().to_string_lossy().into_owned(),
            half_width,
            // At once: a list that grows is there twice when it moves.
            vertices: Vec::with_capacity(layout.vertices * layout.frames),
            layout,
            gltf_from_file: gltf_from_file(&export),
            first: None,
            written: 0,
            room: Vec::new(),
            export,
        })
    }
}

fn invalid(problem: String) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidInput, problem)
}

impl FrameSink for PointTexture<'_> {
    fn frame(&mut self, strands: &Strands, world_from_head: &DAffine3) -> io::Result<()> {
        // Refuses strands that do not match.
        self.export.points(strands, &mut self.room)?;
        let gltf_from_head = self.gltf_from_file * self.export.file_from_head;
        let world = gltf_from_head * *world_from_head;
        let points = strands.points().iter().map(|p| world.transform_point3(p.as_dvec3()));
        let begin = self.vertices.len();
        match self.half_width {
            None => self.vertices.extend(points.map(|p| p.as_vec3())),
            Some(half_width) => {
                let now = on_head(&gltf_from_head, strands);
                let parent = DAffine3::from_mat4(self.export.parent(world_from_head));
                let head = self.gltf_from_file * parent * self.gltf_from_file.inverse();
                let center = gltf_from_head.translation.as_vec3();
                let (first, _) = self.first.get_or_insert_with(|| (Across::new(&now, half_width, center), head));
                let sides = first.sides(&now).map(|side| head.transform_vector3(side.as_dvec3()));
                self.vertices.extend(points.zip(sides).flat_map(|(p, side)| [p - side, p + side]).map(|p| p.as_vec3()));
            }
        }
        self.written += 1;
        match not_finite(&self.vertices[begin..]) {
            Some(at) => Err(invalid(format!("vertex {at} is not finite: hair so far away cannot be written"))),
            None => Ok(()),
        }
    }

    fn finish(mut self: Box<Self>) -> io::Result<Option<String>> {
        let Layout { vertices, frames, width, rows } = self.layout;
        if self.written != frames {
            let written = self.written;
            return Err(invalid(format!("{written} frames were written of the {frames} that the texture has")));
        }
        let strands = &self.export.hair.strands;
        let turned = |(first, head): &(Across, DAffine3)| {
            first.normals.iter().map(|n| head.transform_vector3(n.as_dvec3()).as_vec3().normalize_or(Vec3::Y)).collect()
        };
        let of_mesh = mesh::Mesh {
            strands,
            vertices: &self.vertices[..vertices],
            normals: self.first.as_ref().map(turned),
            layout: &self.layout,
            colour: colour(&self.export),
        };
        mesh::write(&of_mesh, &mut self.mesh)?;
        let numbers = readme::Numbers {
            name: &self.name,
            layout: &self.layout,
            strands: strands.len(),
            ribbons: self.half_width.is_some(),
            frame_rate: self.export.frame_rate,
            first_frame: self.export.first_frame,
            bounds: bounds(&self.vertices),
        };
        self.text.write_all(readme::text(&numbers).as_bytes())?;
        let along = along(strands, self.half_width.is_some());
        write_texture(&self.layout, self.export.frame_rate, &self.vertices, &along, &mut self.texture)?;
        // The texture last: where it is, the others are.
        self.mesh.finish()?;
        self.text.finish()?;
        self.texture.finish()?;
        let of_rows = if rows == 1 { "row" } else { "rows" };
        Ok(Some(format!("{frames} frames of {vertices} vertices, each {rows} {of_rows} of {width} texels")))
    }
}

/// How far along its strand each vertex is: 0 at the root, 1 at the tip.
fn along(strands: &Strands, as_ribbons: bool) -> Vec<f32> {
    let each = if as_ribbons { 2 } else { 1 };
    let of_points = strands.iter().flat_map(|strand| {
        let last = (strand.len() - 1) as f32;
        (0..strand.len()).map(move |i| i as f32 / last)
    });
    of_points.flat_map(|along| std::iter::repeat_n(along, each)).collect()
}

fn write_texture(
    layout: &Layout,
    frame_rate: f64,
    vertices: &[Vec3],
    along: &[f32],
    to: &mut PartFile,
) -> io::Result<()> {
    let channels = SpecificChannels::rgba(|Vec2(x, y)| match layout.at(x, y) {
        Some((frame, vertex)) => {
            let Vec3 { x, y, z } = vertices[frame * layout.vertices + vertex];
            (x, y, z, along[vertex])
        }
        None => (0.0, 0.0, 0.0, 0.0),
    });
    let size = Vec2(layout.width, layout.height());
    let Layout { vertices, frames, rows, .. } = layout;
    // All in one attribute: the crate writes several of our own in another order each time. No name of the software:
    // by that name `nabiki run` knows its own pictures, and removes those that are out of date.
    let comments = format!(
        "vertex-animation texture: frames={frames} frames_per_second={frame_rate} vertices={vertices} rows_per_frame={rows}"
    );
    let attributes = LayerAttributes { comments: Some(comments.as_str().into()), ..LayerAttributes::default() };
    let layer = Layer::new(size, attributes, Encoding::SMALL_LOSSLESS, channels);
    let image = Image::empty(ImageAttributes::new(IntegerBounds::from_dimensions(size))).with_layer(layer);
    image.write().non_parallel().to_buffered(to).map_err(|e| match e {
        exr::error::Error::Io(e) => e,
        e => io::Error::other(e.to_string()),
    })
}

#[cfg(test)]
mod tests;
