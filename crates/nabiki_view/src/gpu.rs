//! The card's side of the view: what lies on it, and one picture drawn.

mod headless;
mod on_card;
mod passes;
mod pipelines;
mod target;
#[cfg(test)]
mod tests;

use std::sync::{Arc, Mutex, PoisonError};

use glam::{Affine3A, UVec3, Vec3};
use nabiki::{Head, Mesh, Pose, Strands};
use nabiki_render::live;
use nabiki_render::settings::HairLook;
use nabiki_render::tone_mapping::linear_from_srgb;
use nabiki_render::{Picture, View, colour};

use crate::globals::{self, Globals, Locks, Show};
use crate::mesh::{Skin, Surface};
use crate::volume::{Casting, Volume, VolumeMaker};
use on_card::{LookOnCard, StrandsOnCard, SurfaceOnCard};
use passes::Passes;
use pipelines::{Pipelines, buffer};
use target::Target;

pub use pipelines::Line;

/// Hairs of a lock at most, where there is time for them.
pub const MOST_HAIRS: u32 = 8;

/// What one picture is drawn from.
pub struct Drawing<'a> {
    /// The hair at rest (head space, cm).
    pub strands: &'a Strands,
    /// The points of its strands now, in their order (head space, cm).
    pub points: &'a [Vec3],
    /// Strands of the whole hair that each of these stands for.
    pub share: f32,
    /// What it grows on.
    pub head: &'a Head,
    /// Its vertices now (head space, cm), if its skin bends.
    pub skin: Option<&'a [Vec3]>,
    /// Where the head is now.
    pub pose: Pose,
    /// What is seen besides.
    pub bodies: &'a [Body<'a>],
    /// The look.
    pub picture: &'a Picture,
    /// The camera (world).
    pub view: View,
    /// Lines among the hair (head space).
    pub lines: &'a [Line],
    /// Hairs of a lock at most, [`MOST_HAIRS`] or fewer.
    pub most_hairs: u32,
}

/// A body besides the head.
#[derive(Clone, Copy, Debug)]
pub struct Body<'a> {
    /// Its surface (its own space, cm).
    pub mesh: &'a Mesh,
    /// Its vertices now (its own space, cm), if it bends.
    pub skin: Option<&'a [Vec3]>,
    /// Its colour (sRGB, 0..1).
    pub colour: [f32; 3],
    /// Where it is now.
    pub pose: Pose,
}

/// A card, and what of the scene lies on it.
pub struct Gpu {
    device: wgpu::Device,
    queue: wgpu::Queue,
    pipelines: Pipelines,
    target: Option<Target>,
    globals: wgpu::Buffer,
    show: wgpu::Buffer,
    fibre: Option<LookOnCard>,
    strands: Option<StrandsOnCard>,
    bodies: Option<Bodies>,
    volumes: VolumeMaker,
    failure: Arc<Mutex<Option<String>>>,
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
    /// Where the vertices of head and bodies were read, of those that bend.
    bent: Vec<Option<(usize, Vec3)>>,
    surface: SurfaceOnCard,
}

impl Gpu {
    /// For a device.
    ///
    /// # Errors
    /// In words, if the device cannot do what the view needs.
    pub fn new(device: &wgpu::Device, queue: &wgpu::Queue) -> Result<Self, String> {
        let limits = device.limits();
        if limits.max_storage_buffers_per_shader_stage < 7 || limits.max_compute_invocations_per_workgroup < 64 {
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
            failure,
        })
    }

    /// Draws one of everything that a picture is made of, where nobody sees it: drivers that compile what they draw with only
    /// when they do have done so by the first picture.
    pub fn warm_up(&self) {
        let (device, queue) = (&self.device, &self.queue);
        let mut strand = Strands::default();
        strand.push([Vec3::ZERO, Vec3::Y]);
        let triangle =
            Mesh { positions: vec![Vec3::X, Vec3::Y, Vec3::Z], triangles: vec![[0, 1, 2]], ..Mesh::default() };
        let line = buffer(device, queue, "lines", bytemuck::bytes_of(&Line::default()), wgpu::BufferUsages::VERTEX);
        let passes = Passes {
            device,
            pipelines: &self.pipelines,
            target: &Target::new(device, [24, 24]),
            scene: &self.scene_group(&Volume::empty(UVec3::splat(6))),
            show: &self.show,
            look: &LookOnCard::new(device, queue, &HairLook::default()),
            strands: &StrandsOnCard::new(device, queue, &strand, 1),
            surface: &SurfaceOnCard::new(device, queue, &Surface::of(&triangle, [0.5; 3])),
            lines: &line,
            line_count: 1,
        };
        queue.submit([passes.commands()]);
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
        let Drawing { strands, points, share, head, pose, picture, view, lines, most_hairs, .. } = *drawing;
        let is_new = self.target.as_ref().is_none_or(|target| target.size != view.size);
        if is_new {
            self.target = Some(Target::new(&self.device, view.size));
        }
        self.set_look(&picture.hair);
        let locks = Locks::new(strands.len(), share, &head.ellipsoid, most_hairs);
        self.set_strands(strands, locks.hairs);
        self.set_bodies(drawing);
        let lines_count = lines.len() as u32;
        let lines = buffer(&self.device, &self.queue, "lines", bytemuck::cast_slice(lines), wgpu::BufferUsages::VERTEX);
        let (Some(target), Some(fibre), Some(on_card), Some(bodies)) =
            (&self.target, &self.fibre, &self.strands, &self.bodies)
        else {
            return None;
        };

        let mut globals = globals::globals(picture, &view, &pose, &head.ellipsoid, &fibre.tables, share, locks);
        let lit = globals::lamps(picture, &view, &pose);
        let lamps: Vec<Vec3> = lit.iter().map(|lamp| lamp.toward).collect();
        let brightness: Vec<f32> = lit.iter().map(|lamp| colour::luminance(lamp.strength)).collect();
        let in_head = view.in_head(&pose);
        let sky = &picture.sky;
        let casting = Casting {
            points,
            strands,
            // As much hair throws shadows as the whole has, whichever of it is shown.
            thickness: picture.hair.width * share,
            share,
            lock_half_width: locks.half_width,
            lamps: &lamps,
            brightness: &brightness,
            zenith: live::zenith(sky, &pose),
            sky: [sky.above, sky.below].map(|light| sky.strength * colour::luminance(light)),
            toward_eye: &|place| in_head.toward_eye(place),
            ellipsoid: head.ellipsoid,
            shadows: picture.shadows,
            occlusion: picture.sky.occlusion && picture.sky.strength > 0.0,
        };
        let volume = self.volumes.make(&casting, &head.mesh);
        globals.around(&volume);
        globals.count(points.len(), on_card.pieces, on_card.hairs);
        let queue = &self.queue;
        queue.write_buffer(&self.globals, 0, bytemuck::bytes_of(&globals));
        queue.write_buffer(&self.show, 0, bytemuck::bytes_of(&Show::new(picture)));
        queue.write_buffer(&on_card.points, 0, bytemuck::cast_slice(points));

        let scene = self.scene_group(&volume);
        let passes = Passes {
            device: &self.device,
            pipelines: &self.pipelines,
            target,
            scene: &scene,
            show: &self.show,
            look: fibre,
            strands: on_card,
            surface: &bodies.surface,
            lines: &lines,
            line_count: lines_count,
        };
        self.queue.submit([passes.commands()]);
        Some((&target.shown_view, is_new))
    }

    fn set_look(&mut self, look: &HairLook) {
        if self.fibre.as_ref().is_some_and(|fibre| fibre.look == *look) {
            return;
        }
        self.fibre = Some(LookOnCard::new(&self.device, &self.queue, look));
    }

    fn set_strands(&mut self, strands: &Strands, hairs: u32) {
        if self.strands.as_ref().is_some_and(|on_card| on_card.hairs == hairs && on_card.starts == strands.starts()) {
            return;
        }
        self.strands = Some(StrandsOnCard::new(&self.device, &self.queue, strands, hairs));
    }

    fn set_bodies(&mut self, drawing: &Drawing) {
        let Drawing { strands, share, head, pose, bodies, picture, .. } = *drawing;
        let shade = picture.head.stubble * picture.hair.width;
        let skin = Skin {
            colour: picture.head.colour.map(linear_from_srgb),
            hair_of_face: (head.is_builtin && picture.head.face).then(|| colour::of_mass(&picture.hair)),
        };
        let roots: Vec<Vec3> = strands.iter().filter_map(|strand| strand.first().copied()).collect();
        let head_from_world = pose.world_from_head().inverse();
        let at: Vec<_> = bodies.iter().map(|body| head_from_world * body.pose.world_from_head()).collect();
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
        let skins = std::iter::once(drawing.skin).chain(bodies.iter().map(|body| body.skin));
        // Another frame may be at the place of one that is gone.
        let bent: Vec<_> = skins.map(|skin| skin.map(|skin| (skin.as_ptr() as usize, skin.iter().sum()))).collect();
        if before.as_ref().is_some_and(|on_card| on_card.at == at && on_card.bent == bent) {
            self.bodies = before;
            return;
        }
        let (surface, others) = match before {
            Some(before) => (before.head, before.others),
            None => {
                self.volumes.forget_head();
                let seen = if picture.head.visible {
                    Surface::head(&head.mesh, skin, &roots, shade, share)
                } else {
                    Surface::default()
                };
                let linear = |colour: [f32; 3]| colour.map(linear_from_srgb);
                (seen, bodies.iter().map(|body| Surface::of(body.mesh, linear(body.colour))).collect())
            }
        };
        let mut all = surface.bent(&head.mesh, drawing.skin);
        for ((other, body), at) in others.iter().zip(bodies).zip(&at) {
            match body.skin {
                Some(_) => all.add(&other.bent(body.mesh, body.skin), at),
                None => all.add(other, at),
            }
        }
        self.bodies = Some(Bodies {
            roots,
            shade,
            skin,
            share,
            head_visible: picture.head.visible,
            vertices: head.mesh.positions.len(),
            head: surface,
            others,
            of_others: of_bodies,
            at,
            bent,
            surface: SurfaceOnCard::new(&self.device, &self.queue, &all),
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
        let hair = texture("hair", wgpu::TextureFormat::R16Float, volume.size, bytemuck::cast_slice(&volume.hair));
        let sky = volume.sky.0.each_ref().map(|numbers| {
            let bytes = bytemuck::cast_slice(numbers.as_flattened());
            texture("sky", wgpu::TextureFormat::Rgba16Float, volume.size / 2, bytes)
        });
        let view = wgpu::BindingResource::TextureView;
        let between = wgpu::BindingResource::Sampler(&self.pipelines.between);
        let volumes = std::iter::once(&depth).chain(&sky).map(view);
        let resources = std::iter::once(self.globals.as_entire_binding()).chain(volumes).chain([between, view(&hair)]);
        let entries: Vec<_> =
            (0..).zip(resources).map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource }).collect();
        let layout = &self.pipelines.scene;
        self.device.create_bind_group(&wgpu::BindGroupDescriptor { label: Some("scene"), layout, entries: &entries })
    }
}
