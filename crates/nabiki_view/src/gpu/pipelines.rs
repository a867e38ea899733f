//! The shaders, and what they are given where.

use crate::mesh::Corner;

/// Light is kept in half precision until it is shown.
pub const LIGHT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;
/// What is shown: sRGB values as they are, which is what egui takes.
pub const SHOWN: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;
/// Reversed: 1 near, 0 far.
pub const DEPTH: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;
/// Samples of a pixel. Hair thinner than a pixel lives by them.
pub const SAMPLES: u32 = 4;
/// Bytes of a vertex of a ribbon.
pub const RIBBON_BYTES: u64 = 32;

/// A line in space (head space, cm).
#[derive(Clone, Copy, Debug, Default, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub struct Line {
    /// From here.
    pub a: [f32; 3],
    /// Thickness (px).
    pub width: f32,
    /// To there.
    pub b: [f32; 3],
    /// Keeps the numbers at their places.
    pub pad: f32,
    /// Linear colour, not weighted by its alpha, at `a`.
    pub a_colour: [f32; 4],
    /// The same at `b`.
    pub b_colour: [f32; 4],
}

/// All pipelines, and how their bindings lie.
pub struct Pipelines {
    pub scene: wgpu::BindGroupLayout,
    pub strands: wgpu::BindGroupLayout,
    pub bodies: wgpu::BindGroupLayout,
    pub show: wgpu::BindGroupLayout,
    pub light: wgpu::ComputePipeline,
    pub shade: wgpu::ComputePipeline,
    pub lay: wgpu::ComputePipeline,
    pub ribbon: wgpu::RenderPipeline,
    pub mesh: wgpu::RenderPipeline,
    pub line: wgpu::RenderPipeline,
    pub shown: wgpu::RenderPipeline,
    pub between: wgpu::Sampler,
}

impl Pipelines {
    pub fn new(device: &wgpu::Device) -> Self {
        let seen = wgpu::ShaderStages::COMPUTE | wgpu::ShaderStages::VERTEX_FRAGMENT;
        let volume = wgpu::BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Float { filterable: true },
            view_dimension: wgpu::TextureViewDimension::D3,
            multisampled: false,
        };
        let sampler = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering);
        let buffer = |ty| wgpu::BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None };
        let uniform = buffer(wgpu::BufferBindingType::Uniform);
        let storage = |read_only| buffer(wgpu::BufferBindingType::Storage { read_only });
        let layout = |label, visibility, types: &[wgpu::BindingType]| {
            let entries: Vec<_> = (0..)
                .zip(types)
                .map(|(binding, &ty)| wgpu::BindGroupLayoutEntry { binding, visibility, ty, count: None })
                .collect();
            device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some(label), entries: &entries })
        };
        let mut of_scene = vec![uniform, volume];
        of_scene.extend([volume; crate::volume::KINDS]);
        of_scene.extend([sampler, volume]);
        let scene = layout("scene", seen, &of_scene);
        let read = storage(true);
        let written = storage(false);
        let compute = wgpu::ShaderStages::COMPUTE;
        let strands = layout("strands", compute, &[read, read, read, read, read, written, written]);
        let bodies = layout("bodies", compute, &[read, written]);
        let light = wgpu::BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Float { filterable: false },
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: false,
        };
        let show = layout("show", wgpu::ShaderStages::FRAGMENT, &[uniform, light]);

        let common = include_str!("../common.wgsl");
        let module = |label, text: &str| {
            let source = wgpu::ShaderSource::Wgsl(text.into());
            device.create_shader_module(wgpu::ShaderModuleDescriptor { label: Some(label), source })
        };
        let with_common = |label, text| module(label, &format!("{common}\n{text}"));
        let hair = with_common("hair", include_str!("../hair.wgsl"));
        let skin = with_common("skin", include_str!("../mesh.wgsl"));
        let of_strands = pipeline_layout(device, &[&scene, &strands]);
        let of_bodies = pipeline_layout(device, &[&scene, &bodies]);
        let compute = |layout, module, entry_point| {
            device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label: Some(entry_point),
                layout: Some(layout),
                module,
                entry_point: Some(entry_point),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                cache: None,
            })
        };
        let of_scene = pipeline_layout(device, &[&scene]);
        let step_mode = wgpu::VertexStepMode::Vertex;
        let vertices = |array_stride, attributes| wgpu::VertexBufferLayout { array_stride, step_mode, attributes };
        let [four, three] = [wgpu::VertexFormat::Float32x4, wgpu::VertexFormat::Float32x3];
        let of_ribbons =
            [attribute(0, four, 0), attribute(1, three, 16), attribute(2, wgpu::VertexFormat::Float32, 28)];
        let ribbon = with_common("ribbon", include_str!("../ribbon.wgsl"));
        let ribbon = drawing(device, &of_scene, &ribbon, &[vertices(RIBBON_BYTES, &of_ribbons)], &Kind::OPAQUE);
        let (places, lights) = ([attribute(0, three, 0)], [attribute(1, three, 0)]);
        let of_skin = [vertices(size_of::<Corner>() as u64, &places), vertices(16, &lights)];
        let mesh = with_common("mesh", include_str!("../skin.wgsl"));
        let mesh = drawing(device, &of_scene, &mesh, &of_skin, &Kind::OPAQUE);
        let lines = wgpu::VertexBufferLayout {
            array_stride: size_of::<Line>() as u64,
            step_mode: wgpu::VertexStepMode::Instance,
            attributes: &[
                attribute(0, wgpu::VertexFormat::Float32x3, 0),
                attribute(1, wgpu::VertexFormat::Float32, 12),
                attribute(2, wgpu::VertexFormat::Float32x3, 16),
                attribute(3, wgpu::VertexFormat::Float32x4, 32),
                attribute(4, wgpu::VertexFormat::Float32x4, 48),
            ],
        };
        let line = with_common("line", include_str!("../line.wgsl"));
        let line = drawing(device, &of_scene, &line, &[lines], &Kind::LINES);
        Self {
            light: compute(&of_bodies, &skin, "light"),
            shade: compute(&of_strands, &hair, "shade"),
            lay: compute(&of_strands, &hair, "lay"),
            ribbon,
            mesh,
            line,
            shown: showing(device, &show, &module("show", include_str!("../show.wgsl"))),
            between: device.create_sampler(&wgpu::SamplerDescriptor {
                label: Some("between cells"),
                mag_filter: wgpu::FilterMode::Linear,
                min_filter: wgpu::FilterMode::Linear,
                ..wgpu::SamplerDescriptor::default()
            }),
            scene,
            strands,
            bodies,
            show,
        }
    }
}

/// What tells the pipelines that draw into the scene from one another.
struct Kind {
    topology: wgpu::PrimitiveTopology,
    blend: Option<wgpu::BlendState>,
    writes_depth: bool,
}

impl Kind {
    const OPAQUE: Self = Self { topology: wgpu::PrimitiveTopology::TriangleList, blend: None, writes_depth: true };
    const LINES: Self = Self {
        topology: wgpu::PrimitiveTopology::TriangleStrip,
        blend: Some(wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING),
        writes_depth: false,
    };
}

fn attribute(shader_location: u32, format: wgpu::VertexFormat, offset: u64) -> wgpu::VertexAttribute {
    wgpu::VertexAttribute { format, offset, shader_location }
}

fn pipeline_layout(device: &wgpu::Device, groups: &[&wgpu::BindGroupLayout]) -> wgpu::PipelineLayout {
    let groups: Vec<_> = groups.iter().map(|group| Some(*group)).collect();
    device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: None,
        bind_group_layouts: &groups,
        immediate_size: 0,
    })
}

fn drawing(
    device: &wgpu::Device,
    layout: &wgpu::PipelineLayout,
    module: &wgpu::ShaderModule,
    buffers: &[wgpu::VertexBufferLayout<'_>],
    kind: &Kind,
) -> wgpu::RenderPipeline {
    let buffers: Vec<_> = buffers.iter().cloned().map(Some).collect();
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: None,
        layout: Some(layout),
        vertex: wgpu::VertexState {
            module,
            entry_point: Some("vertex"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &buffers,
        },
        primitive: wgpu::PrimitiveState { topology: kind.topology, ..wgpu::PrimitiveState::default() },
        depth_stencil: Some(wgpu::DepthStencilState {
            format: DEPTH,
            depth_write_enabled: Some(kind.writes_depth),
            depth_compare: Some(wgpu::CompareFunction::Greater),
            stencil: wgpu::StencilState::default(),
            bias: wgpu::DepthBiasState::default(),
        }),
        multisample: wgpu::MultisampleState { count: SAMPLES, ..wgpu::MultisampleState::default() },
        fragment: Some(wgpu::FragmentState {
            module,
            entry_point: Some("fragment"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            targets: &[Some(wgpu::ColorTargetState {
                format: LIGHT,
                blend: kind.blend,
                write_mask: wgpu::ColorWrites::ALL,
            })],
        }),
        multiview_mask: None,
        cache: None,
    })
}

fn showing(device: &wgpu::Device, show: &wgpu::BindGroupLayout, module: &wgpu::ShaderModule) -> wgpu::RenderPipeline {
    let layout = pipeline_layout(device, &[show]);
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("show"),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module,
            entry_point: Some("vertex"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &[],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: None,
        multisample: wgpu::MultisampleState::default(),
        fragment: Some(wgpu::FragmentState {
            module,
            entry_point: Some("fragment"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            targets: &[Some(SHOWN.into())],
        }),
        multiview_mask: None,
        cache: None,
    })
}

/// A buffer that holds these bytes; never empty, which devices refuse to bind. Nothing is mapped: that panics on a lost device.
pub fn buffer(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    label: &str,
    contents: &[u8],
    usage: wgpu::BufferUsages,
) -> wgpu::Buffer {
    let buffer = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(label),
        size: contents.len().max(64) as u64,
        usage: usage | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    queue.write_buffer(&buffer, 0, contents);
    buffer
}
