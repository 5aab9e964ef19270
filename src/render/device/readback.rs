//! A drawn texture as an image.

use image::RgbaImage;

use super::gpu::Gpu;
use crate::fault::Fault;

/// Waits for the drawing and copies it; alpha is made independent of the colours.
pub(crate) fn read_back(gpu: &Gpu, texture: &wgpu::Texture) -> Result<RgbaImage, Fault> {
    let size = texture.size();
    let row = 4 * size.width;
    let stride = row.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
    let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("read back"),
        size: u64::from(stride) * u64::from(size.height),
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    let mut encoder = gpu
        .device
        .create_command_encoder(&wgpu::CommandEncoderDescriptor {
            label: Some("read back"),
        });
    encoder.copy_texture_to_buffer(
        texture.as_image_copy(),
        wgpu::TexelCopyBufferInfo {
            buffer: &buffer,
            layout: wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(stride),
                rows_per_image: None,
            },
        },
        size,
    );
    gpu.queue.submit([encoder.finish()]);
    // What the device complains about is kept there; without data the range below is refused.
    buffer.slice(..).map_async(wgpu::MapMode::Read, |_| {});
    let refused = |why: String| {
        Fault::new(
            format!("the picture cannot be read back from the graphics device ({why})"),
            "choose a smaller picture",
        )
    };
    gpu.device
        .poll(wgpu::PollType::wait_indefinitely())
        .map_err(|error| refused(error.to_string()))?;
    gpu.check()?;
    let bytes = buffer
        .get_mapped_range(..)
        .map_err(|error| refused(error.to_string()))?;
    let mut pixels = Vec::with_capacity(row as usize * size.height as usize);
    for padded in bytes.chunks(stride as usize) {
        pixels.extend_from_slice(&padded[..row as usize]);
    }
    for pixel in pixels.chunks_exact_mut(4) {
        let alpha = pixel[3];
        if alpha != 0 && alpha != 255 {
            for channel in &mut pixel[..3] {
                let full = u32::from(*channel) * 255 / u32::from(alpha);
                *channel = u8::try_from(full).unwrap_or(255);
            }
        }
    }
    RgbaImage::from_raw(size.width, size.height, pixels)
        .ok_or_else(|| refused("too few bytes".to_owned()))
}
