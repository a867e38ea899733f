//! What of a scene lies on the card from picture to picture.

use nabiki::Strands;
use nabiki_render::live::FibreTables;
use nabiki_render::settings::HairLook;

use super::pipelines::{RIBBON_BYTES, buffer};
use crate::hair;
use crate::mesh::Surface;

/// The tables of a look.
pub struct LookOnCard {
    pub look: HairLook,
    pub tables: FibreTables,
    pub lobes: wgpu::Buffer,
    pub rows: wgpu::Buffer,
    pub mediums: wgpu::Buffer,
}

impl LookOnCard {
    pub fn new(device: &wgpu::Device, queue: &wgpu::Queue, look: &HairLook) -> Self {
        let tables = FibreTables::new(look);
        let of = |label, bytes| buffer(device, queue, label, bytes, wgpu::BufferUsages::STORAGE);
        let lobes = of("lobes", bytemuck::cast_slice(&tables.lobes));
        let rows = of("rows", bytemuck::cast_slice(&tables.rows));
        let mediums = of("mediums", bytemuck::cast_slice(&tables.mediums));
        Self { look: *look, tables, lobes, rows, mediums }
    }
}

/// Strands of which only the points change.
pub struct StrandsOnCard {
    pub starts: Vec<u32>,
    /// Into how many a segment is cut.
    pub pieces: u32,
    /// Of a lock.
    pub hairs: u32,
    pub point_count: usize,
    pub points: wgpu::Buffer,
    pub marks: wgpu::Buffer,
    pub lights: wgpu::Buffer,
    pub ribbons: wgpu::Buffer,
    pub indices: wgpu::Buffer,
    pub index_count: u32,
}

impl StrandsOnCard {
    pub fn new(device: &wgpu::Device, queue: &wgpu::Queue, strands: &Strands, hairs: u32) -> Self {
        let point_count = strands.points().len();
        let pieces = hair::pieces(point_count * hairs as usize);
        let marks = hair::marks(strands);
        let triangles = hair::triangles(strands, pieces, hairs);
        let storage = wgpu::BufferUsages::STORAGE;
        let room = |label, bytes: u64, more| {
            let (size, usage) = (bytes.max(64), storage | more);
            device.create_buffer(&wgpu::BufferDescriptor { label: Some(label), size, usage, mapped_at_creation: false })
        };
        let filled = |label, bytes, usage| buffer(device, queue, label, bytes, usage);
        let (count, nodes) = (point_count as u64, point_count as u64 * u64::from(pieces * hairs));
        Self {
            starts: strands.starts().to_vec(),
            pieces,
            hairs,
            point_count,
            points: room("points", 12 * count, wgpu::BufferUsages::COPY_DST),
            marks: filled("marks", bytemuck::cast_slice(&marks), storage),
            lights: room("lights", 16 * count, wgpu::BufferUsages::empty()),
            ribbons: room("ribbons", 2 * RIBBON_BYTES * nodes, wgpu::BufferUsages::VERTEX),
            indices: filled("ribbon indices", bytemuck::cast_slice(&triangles), wgpu::BufferUsages::INDEX),
            index_count: triangles.len() as u32,
        }
    }
}

/// Triangles of bodies, and the light on their corners.
pub struct SurfaceOnCard {
    pub corners: wgpu::Buffer,
    pub corner_count: usize,
    pub lights: wgpu::Buffer,
    pub indices: wgpu::Buffer,
    pub index_count: u32,
}

impl SurfaceOnCard {
    pub fn new(device: &wgpu::Device, queue: &wgpu::Queue, surface: &Surface) -> Self {
        let Surface { corners, indices } = surface;
        let of = |label, bytes, usage| buffer(device, queue, label, bytes, usage);
        let read_and_drawn = wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::STORAGE;
        Self {
            corners: of("corners", bytemuck::cast_slice(corners), read_and_drawn),
            corner_count: corners.len(),
            lights: of("lights of corners", &vec![0; 16 * corners.len()], read_and_drawn),
            indices: of("skin indices", bytemuck::cast_slice(indices), wgpu::BufferUsages::INDEX),
            index_count: indices.len() as u32,
        }
    }
}
