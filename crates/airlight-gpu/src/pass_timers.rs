//! [`PassTimers`]: how long a device takes for passes.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Times of the passes of a frame on the device, by its time stamps: one before the first pass and one after each. One frame at a time.
///
/// A driver may stamp before the work of compute passes is done; that of Mesa 22.3 on the processor does.
#[derive(Debug)]
pub struct PassTimers {
    stamps: u32,
    queries: wgpu::QuerySet,
    resolved: wgpu::Buffer,
    read: wgpu::Buffer,
    ms_per_tick: f64,
    /// Whether stamps are on their way from the device, and whether they have arrived.
    is_reading: bool,
    has_arrived: Arc<AtomicBool>,
}

impl PassTimers {
    /// Features of a device that times passes.
    pub const FEATURES: wgpu::Features =
        wgpu::Features::TIMESTAMP_QUERY.union(wgpu::Features::TIMESTAMP_QUERY_INSIDE_ENCODERS);

    /// Timers of a number of passes, below [`wgpu::QUERY_SET_MAX_QUERIES`]; `None` for a device without [`Self::FEATURES`].
    pub fn new(device: &wgpu::Device, queue: &wgpu::Queue, passes: u32) -> Option<Self> {
        if !device.features().contains(Self::FEATURES) {
            return None;
        }
        let stamps = passes + 1;
        let buffer = |usage| {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("airlight timers"),
                size: bytes(stamps),
                usage: usage | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            })
        };
        let resolved = wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC;
        Some(Self {
            stamps,
            queries: device.create_query_set(&wgpu::QuerySetDescriptor {
                label: Some("airlight timers"),
                ty: wgpu::QueryType::Timestamp,
                count: stamps,
            }),
            resolved: buffer(resolved),
            read: buffer(wgpu::BufferUsages::MAP_READ),
            ms_per_tick: 1e-6 * f64::from(queue.get_timestamp_period()),
            is_reading: false,
            has_arrived: Arc::default(),
        })
    }

    /// Whether the stamps of a frame before are on their way, so that another cannot be timed.
    pub fn is_reading(&self) -> bool {
        self.is_reading
    }

    /// Records the time stamp after a number of passes, from 0 to all; the last also gathers them.
    pub fn stamp(&self, encoder: &mut wgpu::CommandEncoder, passes: u32) {
        encoder.write_timestamp(&self.queries, passes);
        if passes + 1 == self.stamps {
            encoder.resolve_query_set(&self.queries, 0..self.stamps, &self.resolved, 0);
            encoder.copy_buffer_to_buffer(&self.resolved, 0, &self.read, 0, bytes(self.stamps));
        }
    }

    /// Asks for the stamps of a frame that has been submitted.
    pub fn read(&mut self) {
        let arrived = self.has_arrived.clone();
        self.is_reading = true;
        self.read
            .slice(..)
            .map_async(wgpu::MapMode::Read, move |result| {
                arrived.store(result.is_ok(), Ordering::Relaxed);
            });
    }

    /// The times of the passes of the frame whose stamps are read, ms, when they have arrived.
    pub fn take(&mut self, device: &wgpu::Device) -> Option<Vec<f64>> {
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
        let ms = |pair: &[u64]| self.ms_per_tick * pair[1].saturating_sub(pair[0]) as f64;
        Some(stamps.windows(2).map(ms).collect())
    }
}

/// Bytes of a number of stamps.
fn bytes(stamps: u32) -> u64 {
    8 * u64::from(stamps)
}

#[cfg(all(test, feature = "headless"))]
mod tests {
    use super::*;
    use crate::headless::Headless;

    #[test]
    fn passes_are_timed_where_the_device_has_timers() {
        let plain = Headless::with_features(wgpu::Features::empty()).unwrap();
        assert!(PassTimers::new(&plain.device, &plain.queue, 3).is_none());
        let Headless { device, queue, .. } = Headless::with_features(PassTimers::FEATURES).unwrap();
        let timers = PassTimers::new(&device, &queue, 3);
        let can_time = device.features().contains(PassTimers::FEATURES);
        assert_eq!(timers.is_some(), can_time);
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
        for passes in 1..=3 {
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
        assert!(times[1] > times[0] && times[1] > times[2], "{times:?}");
        assert!(!timers.is_reading() && timers.take(&device).is_none());
    }
}
