//! The graphics device, and what it complains about.

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
    errors: Arc<Mutex<Option<String>>>,
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
        let mut wanted = wgpu::InstanceDescriptor::new_without_display_handle_from_env();
        if std::env::var_os("WGPU_BACKEND").is_none() {
            wanted.backends = Backends::PRIMARY | Backends::GL;
        }
        let backends = wanted.backends;
        let instance = wgpu::Instance::new(wanted);
        let mut adapters = pollster::block_on(instance.enumerate_adapters(backends));
        adapters.sort_by_key(|adapter| {
            let info = adapter.get_info();
            (
                info.device_type != DeviceType::Cpu,
                info.backend == Backend::Gl,
            )
        });
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
        let kept = Arc::clone(&errors);
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
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
            errors,
        }
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

#[cfg(test)]
mod tests {
    use super::*;

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
