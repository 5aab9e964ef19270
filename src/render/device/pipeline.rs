//! Making pipelines and buffers, with what is the same for all of them said once.

use wgpu::util::DeviceExt;
use wgpu::{
    BindGroup, BindGroupLayout, BindGroupLayoutEntry, BindingType, BlendState, Buffer,
    BufferUsages, CompareFunction, DepthStencilState, Device, Face, PrimitiveTopology,
    RenderPipeline, SamplerBindingType, ShaderModule, ShaderStages, TextureFormat,
    TextureSampleType, TextureView, TextureViewDimension, VertexBufferLayout,
};

/// Gamma-space colours, as egui wants them.
pub(crate) const COLOR: TextureFormat = TextureFormat::Rgba8Unorm;
/// Reverse-z needs floating point.
pub(crate) const DEPTH: TextureFormat = TextureFormat::Depth32Float;

/// A shader's name and its text in parts: what it shares with others first.
pub(crate) type Shader = (&'static str, &'static [&'static str]);

/// What differs from pipeline to pipeline.
pub(crate) struct Recipe<'a> {
    pub(crate) module: &'a ShaderModule,
    pub(crate) vertex: &'a str,
    /// `None` draws depth alone.
    pub(crate) fragment: Option<&'a str>,
    /// Group 0, 1, ...
    pub(crate) groups: &'a [&'a BindGroupLayout],
    pub(crate) buffers: &'a [VertexBufferLayout<'a>],
    pub(crate) topology: PrimitiveTopology,
    pub(crate) cull: Option<Face>,
    /// How depths are compared, and whether they are written; `None` without a depth texture.
    pub(crate) depth: Option<(CompareFunction, bool)>,
    /// Whether colours are premultiplied and laid over what is there.
    pub(crate) translucent: bool,
    /// Overrides of the shader.
    pub(crate) constants: &'a [(&'a str, f64)],
}

pub(crate) fn module(device: &Device, (name, parts): Shader) -> ShaderModule {
    device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some(name),
        source: wgpu::ShaderSource::Wgsl(parts.concat().into()),
    })
}

pub(crate) fn pipeline(device: &Device, recipe: &Recipe<'_>) -> RenderPipeline {
    let groups: Vec<_> = recipe.groups.iter().map(|group| Some(*group)).collect();
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some(recipe.vertex),
        bind_group_layouts: &groups,
        immediate_size: 0,
    });
    let buffers: Vec<_> = recipe.buffers.iter().cloned().map(Some).collect();
    let compilation_options = wgpu::PipelineCompilationOptions {
        constants: recipe.constants,
        ..Default::default()
    };
    let targets = [Some(wgpu::ColorTargetState {
        format: COLOR,
        blend: recipe
            .translucent
            .then_some(BlendState::PREMULTIPLIED_ALPHA_BLENDING),
        write_mask: wgpu::ColorWrites::ALL,
    })];
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(recipe.fragment.unwrap_or("depth alone")),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: recipe.module,
            entry_point: Some(recipe.vertex),
            compilation_options: compilation_options.clone(),
            buffers: &buffers,
        },
        primitive: wgpu::PrimitiveState {
            topology: recipe.topology,
            cull_mode: recipe.cull,
            ..Default::default()
        },
        depth_stencil: recipe.depth.map(|(compare, write)| DepthStencilState {
            format: DEPTH,
            depth_write_enabled: Some(write),
            depth_compare: Some(compare),
            stencil: wgpu::StencilState::default(),
            bias: wgpu::DepthBiasState::default(),
        }),
        multisample: wgpu::MultisampleState::default(),
        fragment: recipe.fragment.map(|entry| wgpu::FragmentState {
            module: recipe.module,
            entry_point: Some(entry),
            compilation_options,
            targets: &targets,
        }),
        multiview_mask: None,
        cache: None,
    })
}

/// A binding of a texture that is read texel by texel.
pub(crate) fn texels(binding: u32) -> BindGroupLayoutEntry {
    texture(binding, TextureViewDimension::D2, false)
}

/// A binding of a list of pictures.
pub(crate) fn pictures(binding: u32) -> BindGroupLayoutEntry {
    texture(binding, TextureViewDimension::D2Array, true)
}

fn texture(
    binding: u32,
    view_dimension: TextureViewDimension,
    filterable: bool,
) -> BindGroupLayoutEntry {
    BindGroupLayoutEntry {
        binding,
        visibility: ShaderStages::FRAGMENT,
        ty: BindingType::Texture {
            sample_type: TextureSampleType::Float { filterable },
            view_dimension,
            multisampled: false,
        },
        count: None,
    }
}

/// A binding of a sampler.
pub(crate) fn sampler(binding: u32) -> BindGroupLayoutEntry {
    BindGroupLayoutEntry {
        binding,
        visibility: ShaderStages::FRAGMENT,
        ty: BindingType::Sampler(SamplerBindingType::Filtering),
        count: None,
    }
}

pub(crate) fn group_layout(
    device: &Device,
    label: &str,
    entries: &[BindGroupLayoutEntry],
) -> BindGroupLayout {
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some(label),
        entries,
    })
}

/// Binds textures that are read texel by texel.
pub(crate) fn texel_group(
    device: &Device,
    layout: &BindGroupLayout,
    views: &[&TextureView],
) -> BindGroup {
    let entries: Vec<_> = views
        .iter()
        .zip(0_u32..)
        .map(|(view, binding)| wgpu::BindGroupEntry {
            binding,
            resource: wgpu::BindingResource::TextureView(view),
        })
        .collect();
    device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("texels"),
        layout,
        entries: &entries,
    })
}

/// A buffer with these contents.
pub(crate) fn buffer<T: bytemuck::Pod>(
    device: &Device,
    label: &str,
    usage: BufferUsages,
    contents: &[T],
) -> Buffer {
    device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
        label: Some(label),
        contents: bytemuck::cast_slice(contents),
        usage,
    })
}

/// How many; lists for the graphics card have under 2^32 members.
pub(crate) fn count<T>(list: &[T]) -> u32 {
    u32::try_from(list.len()).unwrap_or(u32::MAX)
}
