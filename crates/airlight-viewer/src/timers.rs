//! [`PassTimers`]: how long the graphics device takes for the passes of a picture.

use eframe::wgpu;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Features of a device that times passes.
pub const FEATURES: wgpu::Features =
    wgpu::Features::TIMESTAMP_QUERY.union(wgpu::Features::TIMESTAMP_QUERY_INSIDE_ENCODERS);

/// Number of passes, and of time stamps: one before the first pass, and one after each.
const PASSES: usize = 3;
const STAMPS: u32 = PASSES as u32 + 1;
const BYTES: u64 = 8 * STAMPS as u64;

/// Times that the device took for the passes of a picture, ms.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PassTimes {
    /// For the terrain, and for clearing the picture.
    pub ground_ms: f64,
    /// For sky, air, fog, sun and lights.
    pub air_ms: f64,
    /// For exposure, tone curve and white balance.
    pub tone_ms: f64,
}

/// Times of the passes of pictures, as far as they are wanted.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Times {
    /// They are not wanted.
    #[default]
    Off,
    /// The device has no timers.
    Missing,
    /// They are wanted; those of the last picture, once they are there.
    On(Option<PassTimes>),
}

/// Time stamps of the passes of a picture at a time.
#[derive(Debug)]
pub struct PassTimers {
    queries: wgpu::QuerySet,
    resolved: wgpu::Buffer,
    read: wgpu::Buffer,
    ms_per_tick: f64,
    /// Whether stamps are on their way from the device, and whether they have arrived.
    is_reading: bool,
    has_arrived: Arc<AtomicBool>,
}

impl PassTimers {
    /// Timers of a device; `None` if it lacks [`FEATURES`].
    pub fn new(device: &wgpu::Device, queue: &wgpu::Queue) -> Option<Self> {
        if !device.features().contains(FEATURES) {
            return None;
        }
        let buffer = |usage| {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("airlight timers"),
                size: BYTES,
                usage: usage | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            })
        };
        let resolved = wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC;
        Some(Self {
            queries: device.create_query_set(&wgpu::QuerySetDescriptor {
                label: Some("airlight timers"),
                ty: wgpu::QueryType::Timestamp,
                count: STAMPS,
            }),
            resolved: buffer(resolved),
            read: buffer(wgpu::BufferUsages::MAP_READ),
            ms_per_tick: 1e-6 * f64::from(queue.get_timestamp_period()),
            is_reading: false,
            has_arrived: Arc::default(),
        })
    }

    /// Whether the stamps of a picture before are on their way, so that another cannot be timed.
    pub fn is_reading(&self) -> bool {
        self.is_reading
    }

    /// Records the time stamp after a number of passes; the last also gathers them.
    pub fn stamp(&self, encoder: &mut wgpu::CommandEncoder, passes: usize) {
        encoder.write_timestamp(&self.queries, passes as u32);
        if passes == PASSES {
            encoder.resolve_query_set(&self.queries, 0..STAMPS, &self.resolved, 0);
            encoder.copy_buffer_to_buffer(&self.resolved, 0, &self.read, 0, BYTES);
        }
    }

    /// Asks for the stamps of a picture that has been handed to the device.
    pub fn read(&mut self) {
        let arrived = self.has_arrived.clone();
        self.is_reading = true;
        self.read
            .slice(..)
            .map_async(wgpu::MapMode::Read, move |result| {
                arrived.store(result.is_ok(), Ordering::Relaxed);
            });
    }

    /// The times of the picture whose stamps are read, when they have arrived.
    pub fn take(&mut self, device: &wgpu::Device) -> Option<PassTimes> {
        if !self.is_reading || device.poll(wgpu::PollType::Poll).is_err() {
            return None;
        }
        if !self.has_arrived.swap(false, Ordering::Relaxed) {
            return None;
        }
        let stamps: Vec<u64> = {
            let bytes = self.read.slice(..).get_mapped_range().ok()?;
            let stamps = bytes.as_chunks().0.iter();
            stamps.map(|stamp| u64::from_ne_bytes(*stamp)).collect()
        };
        self.read.unmap();
        self.is_reading = false;
        let ms =
            |pass: usize| self.ms_per_tick * stamps[pass + 1].saturating_sub(stamps[pass]) as f64;
        Some(PassTimes {
            ground_ms: ms(0),
            air_ms: ms(1),
            tone_ms: ms(2),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A device that has the features times what it does; another has no timers.
    #[test]
    fn passes_are_timed_where_the_device_has_timers() {
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor {
            backends: wgpu::Backends::VULKAN,
            ..wgpu::InstanceDescriptor::new_without_display_handle()
        });
        let adapter = instance.request_adapter(&wgpu::RequestAdapterOptions::default());
        let adapter = pollster::block_on(adapter).expect("a Vulkan device");
        let plain = adapter.request_device(&wgpu::DeviceDescriptor::default());
        let (device, queue) = pollster::block_on(plain).unwrap();
        assert!(PassTimers::new(&device, &queue).is_none());
        let timed = adapter.request_device(&wgpu::DeviceDescriptor {
            required_features: FEATURES & adapter.features(),
            ..Default::default()
        });
        let (device, queue) = pollster::block_on(timed).unwrap();
        let timers = PassTimers::new(&device, &queue);
        assert_eq!(timers.is_some(), adapter.features().contains(FEATURES));
        let Some(mut timers) = timers else {
            return;
        };
        assert_eq!(timers.take(&device), None);
        let buffer = device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: 1 << 24,
            usage: wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        timers.stamp(&mut encoder, 0);
        for passes in 1..=PASSES {
            // Work in the second pass alone.
            if passes == 2 {
                encoder.clear_buffer(&buffer, 0, None);
            }
            timers.stamp(&mut encoder, passes);
        }
        queue.submit([encoder.finish()]);
        timers.read();
        device.poll(wgpu::PollType::wait_indefinitely()).unwrap();
        let times = timers.take(&device).unwrap();
        println!("{times:?}");
        assert!(
            times.air_ms > times.ground_ms && times.air_ms > times.tone_ms,
            "{times:?}"
        );
        assert!(!timers.is_reading() && timers.take(&device).is_none());
    }
}
