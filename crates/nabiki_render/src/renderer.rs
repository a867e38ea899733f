//! One frame, from strands to light.

use glam::Vec3;
use nabiki::{Mesh, Strands};
use rayon::prelude::*;

use crate::RenderError;
use crate::camera::{NEAR, View};
use crate::colour;
use crate::curve::{Curves, drawable};
use crate::frame::{Frame, NO_DEPTH, linear_from_srgb};
use crate::light::kajiya::KajiyaKay;
use crate::light::lamps::lamps;
use crate::raster::bins::Bins;
use crate::raster::oversample::{Corner, OversampledTile};
use crate::raster::{Node, TILE};
use crate::settings::Picture;

/// Draws frames of strands on a head. It keeps its working memory from frame to frame.
pub struct Renderer {
    picture: Picture,
    head: Mesh,
    normals: Vec<Vec3>,
    curves: Curves,
    nodes: Vec<Node>,
    bins: Bins,
}

impl Renderer {
    /// For the settings of a scene and the head of its character (head space, cm).
    ///
    /// # Errors
    /// If a setting is out of range, or the head has a vertex that is not finite or a triangle without vertices.
    pub fn new(picture: &Picture, head: &Mesh) -> Result<Self, RenderError> {
        picture.check()?;
        if let Some(v) = head.positions.iter().position(|&p| !drawable(p)) {
            let p = head.positions[v];
            return Err(RenderError::Geometry(format!(
                "vertex {v} of the head lies at {p}: every coordinate must be a number within 1e7 cm"
            )));
        }
        if let Some(t) = head.triangles.iter().position(|t| t.iter().any(|&v| v as usize >= head.positions.len())) {
            let vertices = head.positions.len();
            return Err(RenderError::Geometry(format!(
                "triangle {t} of the head names a vertex beyond its {vertices}"
            )));
        }
        Ok(Self {
            picture: picture.clone(),
            head: head.clone(),
            normals: head.vertex_normals(),
            curves: Curves::default(),
            nodes: Vec::new(),
            bins: Bins::default(),
        })
    }

    /// The settings it draws with.
    pub fn picture(&self) -> &Picture {
        &self.picture
    }

    /// Draws one frame of strands (head space, cm).
    ///
    /// # Errors
    /// If a point of a strand is not finite: which one.
    pub fn draw(&mut self, strands: &Strands, view: &View) -> Result<Frame, RenderError> {
        self.curves.build(strands, &[], &self.picture.hair, view)?;
        self.shade(view);
        self.bins.fill(&self.nodes, view.size, 0.0);
        let corners = self.head_corners(view);
        Ok(self.oversampled(view, &corners))
    }

    fn shade(&mut self, view: &View) {
        let look = &self.picture.hair;
        let colour = colour::albedo(colour::absorption(look), look.azimuthal_roughness);
        let model = KajiyaKay::new(colour, look.roughness.to_radians());
        let lamps = lamps(&self.picture.lights, view);
        let sky = self.picture.sky.strength * 0.5;
        self.curves
            .nodes
            .par_iter()
            .map(|n| {
                let p = view.project(n.position);
                if p.z < NEAR {
                    return Node { radius: -1.0, strand: n.strand, ..Node::default() };
                }
                let eye = view.toward_eye(n.position);
                let mut light = colour.map(|c| c * sky);
                for lamp in &lamps {
                    let part = model.reflected(n.tangent, lamp.toward, eye);
                    light = std::array::from_fn(|c| light[c] + part[c] * lamp.strength[c]);
                }
                let thin = ((n.along - 1.0 + look.taper) / look.taper.max(1e-6)).clamp(0.0, 1.0);
                let width = look.width * (1.0 - thin * (1.0 - look.tip));
                let seen = n.tangent + eye * eye.dot(-n.tangent);
                let across = [seen.dot(view.right), -seen.dot(view.up)];
                let length = across[0].hypot(across[1]);
                let direction = if length > 1e-6 { across.map(|c| c / length) } else { [0.0; 2] };
                Node {
                    at: [p.x, p.y],
                    depth: p.z,
                    radius: 0.5 * width * view.pixels_per_cm(p.z),
                    light,
                    direction,
                    motion: [0.0; 2],
                    strand: n.strand,
                }
            })
            .collect_into_vec(&mut self.nodes);
    }

    fn head_corners(&self, view: &View) -> Vec<Corner> {
        let lamps = lamps(&self.picture.lights, view);
        let skin = self.picture.head.color.map(linear_from_srgb);
        let soft = self.picture.head.softness;
        self.head
            .positions
            .par_iter()
            .zip(&self.normals)
            .map(|(&position, normal)| {
                let p = view.project(position);
                let mut light = [self.picture.sky.strength * (0.75 + 0.25 * normal.y); 3];
                for lamp in &lamps {
                    let facing = ((normal.dot(lamp.toward) + soft) / (1.0 + soft)).max(0.0);
                    light = std::array::from_fn(|c| light[c] + lamp.strength[c] * facing);
                }
                Corner { at: [p.x, p.y], depth: p.z, light: std::array::from_fn(|c| light[c] * skin[c]) }
            })
            .collect()
    }

    fn oversampled(&self, view: &View, corners: &[Corner]) -> Frame {
        let [width, height] = view.size.map(|s| s as usize);
        let tiles = self.bins.tiles;
        let mut triangles = vec![Vec::new(); tiles[0] * tiles[1]];
        for (t, triangle) in self.head.triangles.iter().enumerate() {
            let c = triangle.map(|v| corners[v as usize]);
            if c.iter().any(|c| c.depth < NEAR) {
                continue;
            }
            let span = |i: usize| {
                let low = c.iter().fold(f32::INFINITY, |m, c| m.min(c.at[i])) / TILE as f32;
                let high = c.iter().fold(f32::NEG_INFINITY, |m, c| m.max(c.at[i])) / TILE as f32;
                low.max(0.0) as usize..((high.max(-1.0) + 1.0) as usize).min(tiles[i])
            };
            for y in span(1) {
                for x in span(0) {
                    triangles[y * tiles[0] + x].push(t as u32);
                }
            }
        }

        let background = Backdrop::new(&self.picture, height);
        let mut rgba = vec![[0.0; 4]; width * height];
        let mut depth = vec![NO_DEPTH; width * height];
        let rows = rgba.par_chunks_mut(TILE * width).zip(depth.par_chunks_mut(TILE * width));
        rows.enumerate().for_each_init(
            || OversampledTile::new(self.picture.samples as usize),
            |tile, (row, (rgba, depth))| {
                for column in 0..tiles[0] {
                    let here = triangles[row * tiles[0] + column]
                        .iter()
                        .map(|&t| self.head.triangles[t as usize].map(|v| corners[v as usize]));
                    tile.draw([column, row], here, (&self.nodes, &self.bins), |x, y, light, nearest| {
                        let (px, py) = (column * TILE + x, row * TILE + y);
                        if px < width && py < height {
                            rgba[y * width + px] = background.behind(light, py);
                            depth[y * width + px] = nearest;
                        }
                    });
                }
            },
        );
        Frame { size: view.size, rgba, depth, layers: Vec::new() }
    }
}

/// What shows where nothing hides it.
struct Backdrop {
    rows: Vec<[f32; 4]>,
}

impl Backdrop {
    fn new(picture: &Picture, height: usize) -> Self {
        let look = &picture.background;
        let rows = (0..height)
            .map(|y| {
                if look.transparent {
                    return [0.0; 4];
                }
                let t = (y as f32 + 0.5) / height as f32;
                let shown: [f32; 3] = std::array::from_fn(|c| look.top[c] + (look.bottom[c] - look.top[c]) * t);
                let light = shown.map(|v| picture.tone.scene(linear_from_srgb(v)) * (-picture.exposure).exp2());
                [light[0], light[1], light[2], 1.0]
            })
            .collect();
        Self { rows }
    }

    fn behind(&self, light: [f32; 4], row: usize) -> [f32; 4] {
        let back = self.rows[row];
        std::array::from_fn(|c| light[c] + back[c] * (1.0 - light[3]))
    }
}
