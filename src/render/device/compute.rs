//! What computing needs, where nothing is drawn: shaders, buffers with contents, work done, contents back.

use wgpu::{BufferUsages, PollType};

use super::gpu::Gpu;
use crate::fault::Fault;

const REMEDY: &str = "let the processor do it";

impl Gpu {
    /// The pipeline of a compute shader; its bindings are as the shader says.
    ///
    /// # Errors
    /// Where the device refuses the shader.
    pub fn compute_pipeline(
        &self,
        label: &str,
        shader: &str,
        entry: &str,
    ) -> Result<wgpu::ComputePipeline, Fault> {
        let source = wgpu::ShaderSource::Wgsl(shader.into());
        let label = Some(label);
        let module = wgpu::ShaderModuleDescriptor { label, source };
        let module = self.device.create_shader_module(module);
        let pipeline = wgpu::ComputePipelineDescriptor {
            label,
            layout: None,
            module: &module,
            entry_point: Some(entry),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            cache: None,
        };
        let pipeline = self.device.create_compute_pipeline(&pipeline);
        self.computed()?;
        Ok(pipeline)
    }

    /// A buffer with these contents, a multiple of four bytes.
    pub fn buffer(&self, label: &str, contents: &[u8], usage: BufferUsages) -> wgpu::Buffer {
        // (A buffer that is mapped to begin with panics where the device is lost.)
        let buffer = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some(label),
            size: contents.len() as u64,
            usage: usage | BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        self.queue.write_buffer(&buffer, 0, contents);
        buffer
    }

    /// A buffer of so many bytes that a shader fills.
    pub fn empty_buffer(&self, label: &str, bytes: usize) -> wgpu::Buffer {
        self.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some(label),
            size: bytes as u64,
            usage: BufferUsages::STORAGE | BufferUsages::COPY_SRC,
            mapped_at_creation: false,
        })
    }

    /// Runs a pipeline once over so many work groups with these buffers as the bindings 0, 1, ... of group 0, and
    /// waits: systems end programs that keep a card for seconds, so each call is to be short.
    ///
    /// # Errors
    /// Where the device refuses, or was lost.
    pub fn compute(
        &self,
        pipeline: &wgpu::ComputePipeline,
        buffers: &[&wgpu::Buffer],
        groups: [u32; 2],
    ) -> Result<(), Fault> {
        let entries: Vec<_> = (0_u32..)
            .zip(buffers)
            .map(|(binding, buffer)| wgpu::BindGroupEntry {
                binding,
                resource: buffer.as_entire_binding(),
            })
            .collect();
        let group = self.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &pipeline.get_bind_group_layout(0),
            entries: &entries,
        });
        let encoder = wgpu::CommandEncoderDescriptor::default();
        let mut encoder = self.device.create_command_encoder(&encoder);
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.dispatch_workgroups(groups[0], groups[1], 1);
        drop(pass);
        self.queue.submit([encoder.finish()]);
        self.wait()
    }

    /// The bytes of a buffer that may be copied from.
    ///
    /// # Errors
    /// Where the device refuses, or was lost.
    pub fn contents(&self, buffer: &wgpu::Buffer) -> Result<Vec<u8>, Fault> {
        let copy = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("read back"),
            size: buffer.size(),
            usage: BufferUsages::COPY_DST | BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        let encoder = wgpu::CommandEncoderDescriptor::default();
        let mut encoder = self.device.create_command_encoder(&encoder);
        encoder.copy_buffer_to_buffer(buffer, 0, &copy, 0, buffer.size());
        self.queue.submit([encoder.finish()]);
        copy.slice(..).map_async(wgpu::MapMode::Read, |_| {});
        self.wait()?;
        let bytes = copy.get_mapped_range(..).map_err(|error| {
            let what = format!("results cannot be read back from the graphics device ({error})");
            Fault::new(what, REMEDY)
        })?;
        Ok(bytes.to_vec())
    }

    fn wait(&self) -> Result<(), Fault> {
        let waited = self.device.poll(PollType::wait_indefinitely());
        self.computed()?;
        waited.map(drop).map_err(|error| {
            let what = format!("the graphics device does not answer ({error})");
            Fault::new(what, REMEDY)
        })
    }

    fn computed(&self) -> Result<(), Fault> {
        match self.take_error() {
            None => Ok(()),
            Some(sentence) => Err(Fault::new(sentence, REMEDY)),
        }
    }
}
