//! One picture as commands to the card.

use super::on_card::{LookOnCard, StrandsOnCard, SurfaceOnCard};
use super::pipelines::Pipelines;
use super::target::Target;

/// All that the passes of a picture read and write.
pub struct Passes<'a> {
    pub device: &'a wgpu::Device,
    pub pipelines: &'a Pipelines,
    pub target: &'a Target,
    pub scene: &'a wgpu::BindGroup,
    pub show: &'a wgpu::Buffer,
    pub look: &'a LookOnCard,
    pub strands: &'a StrandsOnCard,
    pub surface: &'a SurfaceOnCard,
    pub lines: &'a wgpu::Buffer,
    pub line_count: u32,
}

impl Passes<'_> {
    /// Light on corners and strands, ribbons through these, all of it drawn, and shown as sRGB.
    pub fn commands(&self) -> wgpu::CommandBuffer {
        let mut encoder = self.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        self.light(&mut encoder);
        self.draw(&mut encoder);
        self.show(&mut encoder);
        encoder.finish()
    }

    fn light(&self, encoder: &mut wgpu::CommandEncoder) {
        let Self { pipelines, look, strands, surface, .. } = self;
        let group = |layout, buffers: &[&wgpu::Buffer]| {
            let entries: Vec<_> = (0..)
                .zip(buffers)
                .map(|(binding, buffer)| wgpu::BindGroupEntry { binding, resource: buffer.as_entire_binding() })
                .collect();
            self.device.create_bind_group(&wgpu::BindGroupDescriptor { label: None, layout, entries: &entries })
        };
        let of_strands = group(
            &pipelines.strands,
            &[
                &strands.points,
                &strands.marks,
                &look.lobes,
                &look.rows,
                &look.mediums,
                &strands.lights,
                &strands.ribbons,
            ],
        );
        let of_bodies = group(&pipelines.bodies, &[&surface.corners, &surface.lights]);
        let nodes = strands.point_count * (strands.pieces * strands.hairs) as usize;
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
        pass.set_bind_group(0, self.scene, &[]);
        for (pipeline, group, threads) in [
            (&pipelines.light, &of_bodies, surface.corner_count),
            (&pipelines.shade, &of_strands, strands.point_count),
            (&pipelines.lay, &of_strands, nodes),
        ] {
            // A dimension of a dispatch holds 65,535 groups: rows of 1,024.
            let groups = (threads as u32).div_ceil(64);
            pass.set_pipeline(pipeline);
            pass.set_bind_group(1, group, &[]);
            pass.dispatch_workgroups(groups.min(1024), groups.div_ceil(1024), 1);
        }
    }

    fn draw(&self, encoder: &mut wgpu::CommandEncoder) {
        let Self { pipelines, target, strands, surface, .. } = self;
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
        pass.set_bind_group(0, self.scene, &[]);
        // The head first: what it hides is not shaded.
        pass.set_pipeline(&pipelines.mesh);
        pass.set_vertex_buffer(0, surface.corners.slice(..));
        pass.set_vertex_buffer(1, surface.lights.slice(..));
        pass.set_index_buffer(surface.indices.slice(..), wgpu::IndexFormat::Uint32);
        pass.draw_indexed(0..surface.index_count, 0, 0..1);
        pass.set_pipeline(&pipelines.ribbon);
        pass.set_vertex_buffer(0, strands.ribbons.slice(..));
        pass.set_index_buffer(strands.indices.slice(..), wgpu::IndexFormat::Uint32);
        pass.draw_indexed(0..strands.index_count, 0, 0..1);
        if self.line_count > 0 {
            pass.set_pipeline(&pipelines.line);
            pass.set_vertex_buffer(0, self.lines.slice(..));
            pass.draw(0..4, 0..self.line_count);
        }
    }

    fn show(&self, encoder: &mut wgpu::CommandEncoder) {
        let of_show = self.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &self.pipelines.show,
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: self.show.as_entire_binding() },
                wgpu::BindGroupEntry { binding: 1, resource: wgpu::BindingResource::TextureView(&self.target.light) },
            ],
        });
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("show"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &self.target.shown_view,
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
}
