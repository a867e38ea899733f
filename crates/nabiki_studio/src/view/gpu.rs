//! The card's side of the view: what lies on it, and one picture drawn.

mod headless;
mod pipelines;
mod target;
#[cfg(test)]
mod tests;

use std::sync::{Arc, Mutex, PoisonError};

use eframe::wgpu;
use glam::{Affine3A, Vec3};
use nabiki::Strands;
use nabiki_render::live::{self, FibreTables};
use nabiki_render::settings::HairLook;
use nabiki_render::tone_mapping::linear_from_srgb;
use nabiki_render::{Picture, View, colour};

use crate::take::Take;

use super::globals::{self, Globals, Locks, Show};
use super::hair;
use super::mesh::{Skin, Surface};
use super::volume::{Casting, Volume, VolumeMaker};
use pipelines::{Pipelines, RIBBON_BYTES, buffer};
use target::Target;

pub use pipelines::Line;

/// Hairs of a lock at most.
const MOST_HAIRS: u32 = 8;

/// What one picture is drawn from.
pub struct Drawing<'a> {
    /// The motion.
    pub take: &'a Take,
    /// The look.
    pub picture: &'a Picture,
    /// The frame of the motion.
    pub frame: u32,
    /// The camera (world).
    pub view: View,
    /// Lines among the hair (head space).
    pub lines: &'a [Line],
}

/// A card, and what of the scene lies on it.
pub struct Gpu {
    device: wgpu::Device,
    queue: wgpu::Queue,
    pipelines: Pipelines,
    target: Option<Target>,
    globals: wgpu::Buffer,
    show: wgpu::Buffer,
    fibre: Option<OnCard>,
    strands: Option<StrandsOnCard>,
    bodies: Option<Bodies>,
    volumes: VolumeMaker,
    most_hairs: u32,
    failure: Arc<Mutex<Option<String>>>,
}

/// The tables of a look.
struct OnCard {
    look: HairLook,
    tables: FibreTables,
    lobes: wgpu::Buffer,
    rows: wgpu::Buffer,
}

/// Strands of which only the points change.
struct StrandsOnCard {
    starts: Vec<u32>,
    pieces: u32,
    hairs: u32,
    points: wgpu::Buffer,
    marks: wgpu::Buffer,
    lights: wgpu::Buffer,
    ribbons: wgpu::Buffer,
    indices: wgpu::Buffer,
    index_count: u32,
}

/// The head with its stubble, and what else stands in the scene.
struct Bodies {
    roots: Vec<Vec3>,
    shade: f32,
    skin: Skin,
    share: f32,
    head_visible: bool,
    vertices: usize,
    head: Surface,
    others: Vec<Surface>,
    of_others: Vec<(usize, [f32; 3])>,
    at: Vec<Affine3A>,
    corners: wgpu::Buffer,
    corner_count: usize,
    lights: wgpu::Buffer,
    indices: wgpu::Buffer,
    index_count: u32,
}

impl Gpu {
    /// For a device.
    ///
    /// # Errors
    /// In words, if the device cannot do what the view needs.
    pub fn new(device: &wgpu::Device, queue: &wgpu::Queue) -> Result<Self, String> {
        let limits = device.limits();
        if limits.max_storage_buffers_per_shader_stage < 6 || limits.max_compute_invocations_per_workgroup < 64 {
            return Err(
                "This graphics driver has no compute shaders. The view needs Vulkan, Metal or Direct3D 12.".to_owned()
            );
        }
        let failure = Arc::new(Mutex::new(None));
        let told = failure.clone();
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
            told.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert_with(|| error.to_string());
        }));
        let told = failure.clone();
        device.set_device_lost_callback(move |_, why| {
            let words = format!("The graphics device was lost ({why}). Save, and start Nabiki again.");
            told.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(words);
        });
        // Some drivers, those of OpenGL among them, have all that is asked for and cannot compile what is then drawn.
        let attempts =
            [wgpu::ErrorFilter::Internal, wgpu::ErrorFilter::Validation].map(|of| device.push_error_scope(of));
        let pipelines = Pipelines::new(device);
        // The scope opened last is closed first.
        let failed = attempts.into_iter().rev().filter_map(|attempt| headless::now(attempt.pop())).count();
        if failed > 0 {
            return Err(
                "This graphics driver cannot compile the view. It needs Vulkan, Metal or Direct3D 12.".to_owned()
            );
        }
        let uniform = wgpu::BufferUsages::UNIFORM;
        Ok(Self {
            pipelines,
            globals: buffer(device, queue, "globals", &[0; size_of::<Globals>()], uniform),
            show: buffer(device, queue, "show", &[0; size_of::<Show>()], uniform),
            device: device.clone(),
            queue: queue.clone(),
            target: None,
            fibre: None,
            strands: None,
            bodies: None,
            volumes: VolumeMaker::default(),
            most_hairs: MOST_HAIRS,
            failure,
        })
    }

    /// What went wrong on the card, if anything did. From then on nothing is drawn.
    pub fn failure(&self) -> Option<String> {
        self.failure.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// Draws a picture of `drawing.view.size` pixels, and says where it is: sRGB values, opaque. `true` where it lies in another
    /// texture than the last. Nothing on a card that has failed.
    pub fn draw(&mut self, drawing: &Drawing) -> Option<(&wgpu::TextureView, bool)> {
        if self.failure().is_some() {
            return None;
        }
        let Drawing { take, picture, frame, view, lines } = drawing;
        let (strands, pose) = (take.strands(), take.pose(*frame));
        let points = take.points(*frame);
        let share = take.built.strands_of_scene as f32 / strands.len().max(1) as f32;
        let is_new = self.target.as_ref().is_none_or(|target| target.size != view.size);
        if is_new {
            self.target = Some(Target::new(&self.device, view.size));
        }
        self.set_look(&picture.hair);
        let locks = Locks::new(strands.len(), share, &take.built.head.ellipsoid, self.most_hairs);
        self.set_strands(strands, locks.hairs);
        self.set_bodies(take, picture, *frame, share);
        let lines_count = lines.len() as u32;
        let lines = buffer(&self.device, &self.queue, "lines", bytemuck::cast_slice(lines), wgpu::BufferUsages::VERTEX);
        let (Some(target), Some(fibre), Some(on_card), Some(bodies)) =
            (&self.target, &self.fibre, &self.strands, &self.bodies)
        else {
            return None;
        };

        let mut globals =
            globals::globals(picture, view, &pose, &take.built.head.ellipsoid, &fibre.tables, share, locks);
        let lamps: Vec<Vec3> = globals::lamps(picture, view, &pose).iter().map(|lamp| lamp.toward).collect();
        let casting = Casting {
            points,
            strands,
            // As much hair throws shadows as the whole has, whichever of it is shown.
            thickness: picture.hair.width * share,
            share,
            lamps: &lamps,
            zenith: live::zenith(&picture.sky, &pose),
            shadows: picture.shadows,
            occlusion: picture.sky.occlusion && picture.sky.strength > 0.0,
        };
        let volume = self.volumes.make(&casting, &take.built.head.mesh);
        globals.around(&volume);
        globals.count(points.len(), on_card.pieces, on_card.hairs);
        let queue = &self.queue;
        queue.write_buffer(&self.globals, 0, bytemuck::bytes_of(&globals));
        queue.write_buffer(&self.show, 0, bytemuck::bytes_of(&Show::new(picture)));
        queue.write_buffer(&on_card.points, 0, bytemuck::cast_slice(points));

        let scene = self.scene_group(&volume);
        let group = |layout, buffers: &[&wgpu::Buffer]| {
            let entries: Vec<_> = (0..)
                .zip(buffers)
                .map(|(binding, buffer)| wgpu::BindGroupEntry { binding, resource: buffer.as_entire_binding() })
                .collect();
            self.device.create_bind_group(&wgpu::BindGroupDescriptor { label: None, layout, entries: &entries })
        };
        let of_strands = group(
            &self.pipelines.strands,
            &[&on_card.points, &on_card.marks, &fibre.lobes, &fibre.rows, &on_card.lights, &on_card.ribbons],
        );
        let of_bodies = group(&self.pipelines.bodies, &[&bodies.corners, &bodies.lights]);
        let of_show = self.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &self.pipelines.show,
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: self.show.as_entire_binding() },
                wgpu::BindGroupEntry { binding: 1, resource: wgpu::BindingResource::TextureView(&target.light) },
            ],
        });

        let mut encoder = self.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        {
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
            pass.set_bind_group(0, &scene, &[]);
            let nodes = points.len() * (on_card.pieces * on_card.hairs) as usize;
            for (pipeline, group, threads) in [
                (&self.pipelines.light, &of_bodies, bodies.corner_count),
                (&self.pipelines.shade, &of_strands, points.len()),
                (&self.pipelines.lay, &of_strands, nodes),
            ] {
                // A dimension of a dispatch holds 65,535 groups: rows of 1,024.
                let groups = (threads as u32).div_ceil(64);
                pass.set_pipeline(pipeline);
                pass.set_bind_group(1, group, &[]);
                pass.dispatch_workgroups(groups.min(1024), groups.div_ceil(1024), 1);
            }
        }
        {
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some("scene"),
                color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                    view: &target.samples,
                    depth_slice: None,
                    resolve_target: Some(&target.light),
                    ops: wgpu::Operations {
                        load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
                        store: wgpu::StoreOp::Discard,
                    },
                })],
                depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                    view: &target.depth,
                    depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store: wgpu::StoreOp::Discard }),
                    stencil_ops: None,
                }),
                ..wgpu::RenderPassDescriptor::default()
            });
            pass.set_bind_group(0, &scene, &[]);
            // The head first: what it hides is not shaded.
            pass.set_pipeline(&self.pipelines.mesh);
            pass.set_vertex_buffer(0, bodies.corners.slice(..));
            pass.set_vertex_buffer(1, bodies.lights.slice(..));
            pass.set_index_buffer(bodies.indices.slice(..), wgpu::IndexFormat::Uint32);
            pass.draw_indexed(0..bodies.index_count, 0, 0..1);
            pass.set_pipeline(&self.pipelines.ribbon);
            pass.set_vertex_buffer(0, on_card.ribbons.slice(..));
            pass.set_index_buffer(on_card.indices.slice(..), wgpu::IndexFormat::Uint32);
            pass.draw_indexed(0..on_card.index_count, 0, 0..1);
            if lines_count > 0 {
                pass.set_pipeline(&self.pipelines.line);
                pass.set_vertex_buffer(0, lines.slice(..));
                pass.draw(0..4, 0..lines_count);
            }
        }
        {
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some("show"),
                color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                    view: &target.shown_view,
                    depth_slice: None,
                    resolve_target: None,
                    ops: wgpu::Operations::default(),
                })],
                ..wgpu::RenderPassDescriptor::default()
            });
            pass.set_pipeline(&self.pipelines.shown);
            pass.set_bind_group(0, &of_show, &[]);
            pass.draw(0..3, 0..1);
        }
        self.queue.submit([encoder.finish()]);
        Some((&target.shown_view, is_new))
    }

    fn set_look(&mut self, look: &HairLook) {
        if self.fibre.as_ref().is_some_and(|fibre| fibre.look == *look) {
            return;
        }
        let tables = FibreTables::new(look);
        let of = |label, bytes| buffer(&self.device, &self.queue, label, bytes, wgpu::BufferUsages::STORAGE);
        let lobes = of("lobes", bytemuck::cast_slice(&tables.lobes));
        let rows = of("rows", bytemuck::cast_slice(&tables.rows));
        self.fibre = Some(OnCard { look: *look, tables, lobes, rows });
    }

    fn set_strands(&mut self, strands: &Strands, hairs: u32) {
        if self.strands.as_ref().is_some_and(|on_card| on_card.hairs == hairs && on_card.starts == strands.starts()) {
            return;
        }
        let count = strands.points().len();
        let pieces = hair::pieces(count * hairs as usize);
        let marks = hair::marks(strands);
        let triangles = hair::triangles(strands, pieces, hairs);
        let usage = wgpu::BufferUsages::STORAGE;
        let room = |label, bytes: u64, usage| {
            let size = bytes.max(64);
            self.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size,
                usage,
                mapped_at_creation: false,
            })
        };
        let count = count as u64;
        self.strands = Some(StrandsOnCard {
            starts: strands.starts().to_vec(),
            pieces,
            hairs,
            points: room("points", 12 * count, usage | wgpu::BufferUsages::COPY_DST),
            marks: buffer(&self.device, &self.queue, "marks", bytemuck::cast_slice(&marks), usage),
            lights: room("lights", 16 * count, usage),
            ribbons: room(
                "ribbons",
                2 * RIBBON_BYTES * count * u64::from(pieces * hairs),
                usage | wgpu::BufferUsages::VERTEX,
            ),
            indices: buffer(
                &self.device,
                &self.queue,
                "ribbon indices",
                bytemuck::cast_slice(&triangles),
                wgpu::BufferUsages::INDEX,
            ),
            index_count: triangles.len() as u32,
        });
    }

    fn set_bodies(&mut self, take: &Take, picture: &Picture, frame: u32, share: f32) {
        let head = &take.built.head;
        let shade = picture.head.stubble * picture.hair.width;
        let skin = Skin {
            colour: picture.head.colour.map(linear_from_srgb),
            hair_of_face: (head.is_builtin && picture.head.face).then(|| colour::of_mass(&picture.hair)),
        };
        let strands = take.strands();
        let roots: Vec<Vec3> = strands.iter().filter_map(|strand| strand.first().copied()).collect();
        let bodies = take.built.drawn_bodies();
        let head_from_world = take.pose(frame).world_from_head().inverse();
        let poses = take.built.drawn_poses(frame);
        let at: Vec<_> = poses.iter().map(|pose| head_from_world * pose.world_from_head()).collect();
        let of_bodies: Vec<_> = bodies.iter().map(|body| (body.mesh.positions.len(), body.colour)).collect();
        let same = |on_card: &Bodies| {
            on_card.shade == shade
                && on_card.skin == skin
                && on_card.share == share
                && on_card.head_visible == picture.head.visible
                && on_card.vertices == head.mesh.positions.len()
                && on_card.of_others == of_bodies
                && roots == on_card.roots
        };
        let before = self.bodies.take().filter(same);
        if before.as_ref().is_some_and(|on_card| on_card.at == at) {
            self.bodies = before;
            return;
        }
        let (head, others) = match before {
            Some(before) => (before.head, before.others),
            None => {
                self.volumes.forget_head();
                let seen = if picture.head.visible {
                    Surface::head(&head.mesh, skin, &roots, shade, share)
                } else {
                    Surface::default()
                };
                let linear = |colour: [f32; 3]| colour.map(linear_from_srgb);
                (seen, bodies.iter().map(|body| Surface::of(&body.mesh, linear(body.colour))).collect())
            }
        };
        let mut all = Surface { corners: head.corners.clone(), indices: head.indices.clone() };
        others.iter().zip(&at).for_each(|(other, at)| all.add(other, at));
        let of = |label, bytes, usage| buffer(&self.device, &self.queue, label, bytes, usage);
        let storage = wgpu::BufferUsages::STORAGE;
        self.bodies = Some(Bodies {
            roots,
            shade,
            skin,
            share,
            head_visible: picture.head.visible,
            vertices: take.built.head.mesh.positions.len(),
            head,
            others,
            of_others: of_bodies,
            at,
            corners: of("corners", bytemuck::cast_slice(&all.corners), wgpu::BufferUsages::VERTEX | storage),
            corner_count: all.corners.len(),
            lights: of("lights of corners", &vec![0; 16 * all.corners.len()], wgpu::BufferUsages::VERTEX | storage),
            indices: of("skin indices", bytemuck::cast_slice(&all.indices), wgpu::BufferUsages::INDEX),
            index_count: all.indices.len() as u32,
        });
    }

    fn scene_group(&self, volume: &Volume) -> wgpu::BindGroup {
        let texture = |label, format, size: glam::UVec3, bytes: &[u8]| {
            let size = wgpu::Extent3d { width: size.x, height: size.y, depth_or_array_layers: size.z };
            let descriptor = wgpu::TextureDescriptor {
                label: Some(label),
                size,
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D3,
                format,
                usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
                view_formats: &[],
            };
            let texture = self.device.create_texture(&descriptor);
            let per_cell = format.block_copy_size(None).unwrap_or(4);
            let layout = wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(per_cell * size.width),
                rows_per_image: Some(size.height),
            };
            self.queue.write_texture(texture.as_image_copy(), bytes, layout, size);
            texture.create_view(&wgpu::TextureViewDescriptor::default())
        };
        let depth = texture(
            "hair depth",
            wgpu::TextureFormat::Rgba16Float,
            volume.size,
            bytemuck::cast_slice(volume.depth.as_flattened()),
        );
        let open = texture(
            "open sky",
            wgpu::TextureFormat::Rg16Float,
            volume.size / 2,
            bytemuck::cast_slice(volume.open.as_flattened()),
        );
        let view = wgpu::BindingResource::TextureView;
        let between = wgpu::BindingResource::Sampler(&self.pipelines.between);
        let resources = [self.globals.as_entire_binding(), view(&depth), view(&open), between];
        let entries: Vec<_> =
            (0..).zip(resources).map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource }).collect();
        let layout = &self.pipelines.scene;
        self.device.create_bind_group(&wgpu::BindGroupDescriptor { label: Some("scene"), layout, entries: &entries })
    }
}
