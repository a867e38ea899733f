//! The textures of one size that a picture is drawn into.

use super::pipelines::{DEPTH, LIGHT, SAMPLES, SHOWN};

pub struct Target {
    pub size: [u32; 2],
    pub samples: wgpu::TextureView,
    pub depth: wgpu::TextureView,
    pub light: wgpu::TextureView,
    pub shown: wgpu::Texture,
    pub shown_view: wgpu::TextureView,
}

impl Target {
    pub fn new(device: &wgpu::Device, size: [u32; 2]) -> Self {
        let texture = |label, format, sample_count, more| {
            device.create_texture(&wgpu::TextureDescriptor {
                label: Some(label),
                size: wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: wgpu::TextureUsages::RENDER_ATTACHMENT | more,
                view_formats: &[],
            })
        };
        let view = |texture: wgpu::Texture| texture.create_view(&wgpu::TextureViewDescriptor::default());
        let (none, read) = (wgpu::TextureUsages::empty(), wgpu::TextureUsages::TEXTURE_BINDING);
        let shown = texture("shown", SHOWN, 1, read | wgpu::TextureUsages::COPY_SRC);
        Self {
            size,
            samples: view(texture("samples", LIGHT, SAMPLES, none)),
            depth: view(texture("depth", DEPTH, SAMPLES, none)),
            light: view(texture("light", LIGHT, 1, read)),
            shown_view: shown.create_view(&wgpu::TextureViewDescriptor::default()),
            shown,
        }
    }
}
