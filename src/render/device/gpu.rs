//! The graphics device, and what it complains about.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use wgpu::{Adapter, AdapterInfo, Backend, Backends, DeviceDescriptor, DeviceType, Limits};

use crate::fault::Fault;

/// The package that draws where there is no graphics card.
const REMEDY: &str = "install a graphics driver; without a graphics card the Debian package mesa-vulkan-drivers draws on the processor";

/// A graphics device, from the window or without one.
#[derive(Debug, Clone)]
pub struct Gpu {
    /// Makes buffers, textures and pipelines.
    pub device: wgpu::Device,
    /// Takes what is to be done.
    pub queue: wgpu::Queue,
    /// Whether the processor draws: then one sample a pixel is all it can afford.
    pub software: bool,
    /// What it is, and through which interface: `NVIDIA H100 (Vulkan)`.
    pub name: String,
    errors: Arc<Mutex<Option<String>>>,
    /// Whether the window lost a frame to a resize.
    lost_frame: Arc<AtomicBool>,
}

/// What to ask of a device: the largest textures and buffers that its adapter offers, within reason.
/// eframe's default buffer limit of 256 MiB is too small for large clouds.
pub fn device_descriptor(adapter: &Adapter) -> DeviceDescriptor<'static> {
    let offered = adapter.limits();
    let base = if adapter.get_info().backend == Backend::Gl {
        Limits::downlevel_webgl2_defaults()
    } else {
        Limits::default()
    };
    DeviceDescriptor {
        label: Some("fragscale"),
        required_limits: Limits {
            max_texture_dimension_2d: offered.max_texture_dimension_2d.min(16384),
            max_buffer_size: offered.max_buffer_size.min(4 << 30),
            ..base
        },
        ..DeviceDescriptor::default()
    }
}

impl Gpu {
    /// A device without a window. The processor's driver comes first: it draws the same picture on
    /// every machine, which is what reports and tests want of a single picture.
    ///
    /// # Errors
    /// Where there is no graphics driver, naming the package to install.
    pub fn headless() -> Result<Self, Fault> {
        Self::first_usable(Backends::PRIMARY | Backends::GL, |info| {
            let is_gl = u8::from(info.backend == Backend::Gl);
            2 * u8::from(info.device_type != DeviceType::Cpu) + is_gl
        })
    }

    /// A device to compute with: a card of its own before one in the processor, software last.
    ///
    /// # Errors
    /// Where there is no graphics driver that computes, naming the package to install.
    pub fn fastest() -> Result<Self, Fault> {
        Self::first_usable(Backends::PRIMARY, |info| match info.device_type {
            DeviceType::DiscreteGpu => 0,
            DeviceType::IntegratedGpu | DeviceType::VirtualGpu => 1,
            DeviceType::Other => 2,
            DeviceType::Cpu => 3,
        })
    }

    /// The usable device of the smallest rank. The environment's `WGPU_BACKEND` goes before `backends`.
    fn first_usable(backends: Backends, rank: impl Fn(&AdapterInfo) -> u8) -> Result<Self, Fault> {
        let mut wanted = wgpu::InstanceDescriptor::new_without_display_handle_from_env();
        if std::env::var_os("WGPU_BACKEND").is_none() {
            wanted.backends = backends;
        }
        let backends = wanted.backends;
        let instance = wgpu::Instance::new(wanted);
        let mut adapters = pollster::block_on(instance.enumerate_adapters(backends));
        adapters.sort_by_key(|adapter| rank(&adapter.get_info()));
        let mut why = "none was found".to_owned();
        for adapter in adapters {
            match pollster::block_on(adapter.request_device(&device_descriptor(&adapter))) {
                Ok((device, queue)) => {
                    return Ok(Self::of_window(device, queue, &adapter.get_info()));
                }
                Err(error) => why = error.to_string(),
            }
        }
        Err(Fault::new(
            format!("no graphics driver can be used ({why})"),
            REMEDY,
        ))
    }

    /// The device that the window draws with. From here on its errors are kept for
    /// [`Self::take_error`] instead of ending the program.
    pub fn of_window(device: wgpu::Device, queue: wgpu::Queue, adapter: &AdapterInfo) -> Self {
        let errors = Arc::new(Mutex::new(None));
        let keep = |kept: &Mutex<Option<String>>, sentence: String| {
            // The first error is the cause; the rest mostly follow from it.
            kept.lock()
                .unwrap_or_else(PoisonError::into_inner)
                .get_or_insert(sentence);
        };
        let lost_frame = Arc::new(AtomicBool::new(false));
        let (kept, lost) = (Arc::clone(&errors), Arc::clone(&lost_frame));
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
            if is_of_a_resize(&error.to_string()) {
                lost.store(true, Ordering::Relaxed);
                return;
            }
            keep(&kept, format!("the graphics device refused: {error}"));
        }));
        let kept = Arc::clone(&errors);
        device.set_device_lost_callback(move |reason, message| {
            // A device that we dropped ourselves is not lost.
            if reason != wgpu::DeviceLostReason::Destroyed {
                keep(&kept, format!("the graphics device was lost: {message}"));
            }
        });
        Self {
            device,
            queue,
            software: adapter.device_type == DeviceType::Cpu,
            name: format!("{} ({:?})", adapter.name, adapter.backend),
            errors,
            lost_frame,
        }
    }

    /// Whether the window lost a frame since the last call, because it was resized: it wants another one.
    pub fn take_lost_frame(&self) -> bool {
        self.lost_frame.swap(false, Ordering::Relaxed)
    }

    /// Lets the device take what was written into buffers and textures: otherwise it would wait for
    /// the next frame, and cost the window's thread time.
    pub(crate) fn hand_over(&self) {
        self.queue.submit([]);
    }

    /// The first thing that went wrong on the device since the last call.
    pub fn take_error(&self) -> Option<String> {
        self.errors
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .take()
    }

    /// [`Self::take_error`] as a fault.
    ///
    /// # Errors
    /// Where something went wrong since the last call.
    pub(crate) fn check(&self) -> Result<(), Fault> {
        match self.take_error() {
            None => Ok(()),
            Some(sentence) => Err(Fault::new(sentence, "choose a smaller picture or surface")),
        }
    }
}

/// Whether this is the complaint about a frame of the window that was laid out for the size before a resize
/// and would be drawn into a surface of the size after it: egui_wgpu's encoder clips to what is not there
/// any more; or that a slow device was still busy when the surface was to get its new size, which is tried
/// again with the next frame. Nothing of ours clips or has a surface, and the next frame is right, so nobody
/// has to know.
fn is_of_a_resize(error: &str) -> bool {
    let clips = ["set_scissor_rect", "Scissor Rect", "render target"];
    let waits = ["Surface::configure", "Failed to wait for GPU"];
    let has_all = |words: &[&str]| words.iter().all(|words| error.contains(words));
    has_all(&clips) || has_all(&waits)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What egui_wgpu does when the window became smaller while a frame was laid out.
    #[test]
    fn a_resize_is_no_error_but_wants_another_frame() {
        let gpu = Gpu::headless().unwrap();
        let target = gpu.device.create_texture(&wgpu::TextureDescriptor {
            label: None,
            size: wgpu::Extent3d {
                width: 1199,
                height: 417,
                depth_or_array_layers: 1,
            },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: wgpu::TextureFormat::Rgba8Unorm,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT,
            view_formats: &[],
        });
        let view = target.create_view(&wgpu::TextureViewDescriptor::default());
        let label = Some("encoder");
        let descriptor = wgpu::CommandEncoderDescriptor { label };
        let mut encoder = gpu.device.create_command_encoder(&descriptor);
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &view,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations::default(),
            })],
            ..Default::default()
        });
        pass.set_scissor_rect(0, 0, 1336, 25);
        drop(pass);
        let _refused = encoder.finish();
        assert_eq!(gpu.take_error(), None);
        assert!(gpu.take_lost_frame());
        assert!(!gpu.take_lost_frame());
        // As it was told on a screen.
        assert!(is_of_a_resize(
            "Validation Error Caused by: In Surface::configure Failed to wait for GPU to come idle before \
             reconfiguring the Surface"
        ));
        assert!(!is_of_a_resize(
            "In Device::create_buffer, label = 'far too large'"
        ));
    }

    #[test]
    fn an_error_is_kept_as_a_sentence() {
        let gpu = Gpu::headless().unwrap();
        assert_eq!(gpu.take_error(), None);
        let _refused = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("far too large"),
            size: u64::MAX / 2,
            usage: wgpu::BufferUsages::VERTEX,
            mapped_at_creation: false,
        });
        let sentence = gpu.take_error().unwrap();
        assert!(sentence.contains("far too large"), "{sentence}");
        assert_eq!(gpu.take_error(), None);
    }
}
