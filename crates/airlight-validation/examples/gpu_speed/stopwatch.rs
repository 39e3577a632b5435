//! Times of passes on a device.

use airlight_gpu::headless::Headless;
use airlight_gpu::{PassTimers, SkyPasses};
use std::cell::{Cell, RefCell};
use std::error::Error;
use std::time::Instant;

/// Part of the time until the device is idle that its time stamps have to cover, where this is far longer than a submission takes.
const COVERED: f64 = 0.2;
const LONG_MS: f64 = 3.0;

/// A device, and its clock.
pub struct Stopwatch {
    pub device: wgpu::Device,
    pub queue: wgpu::Queue,
    pub adapter: String,
    pub driver: String,
    timers: Option<RefCell<PassTimers>>,
    /// Whether time stamps come before the work between them is done.
    is_early: Cell<bool>,
}

impl Stopwatch {
    /// The first Vulkan device, with time stamps if it has them.
    pub fn new() -> Result<Self, Box<dyn Error>> {
        let wanted = PassTimers::FEATURES | SkyPasses::OPTIONAL_FEATURES;
        let Headless {
            device,
            queue,
            name,
            driver,
            ..
        } = Headless::with_features(wanted)?;
        Ok(Self {
            timers: PassTimers::new(&device, &queue, 1).map(RefCell::new),
            device,
            queue,
            adapter: name,
            driver,
            is_early: Cell::new(false),
        })
    }

    /// Checks the time stamps of the device by a compute pass: where they do not cover it, passes are timed without them.
    pub fn check(
        &self,
        pass: impl FnOnce(&mut wgpu::CommandEncoder),
    ) -> Result<(), Box<dyn Error>> {
        let (stamped_ms, elapsed_ms) = self.times(pass)?;
        let is_early = |ms| elapsed_ms > LONG_MS && ms < COVERED * elapsed_ms;
        self.is_early.set(stamped_ms.is_some_and(is_early));
        Ok(())
    }

    /// What passes are timed by.
    pub fn clock(&self) -> &'static str {
        match (&self.timers, self.is_early.get()) {
            (None, _) => "until the device is idle, as it has no time stamps",
            (_, true) => "until the device is idle, as its time stamps come too early",
            _ => "time stamps of the device",
        }
    }

    /// Time of recorded commands, ms.
    pub fn time(
        &self,
        record: impl FnOnce(&mut wgpu::CommandEncoder),
    ) -> Result<f64, Box<dyn Error>> {
        let (stamped_ms, elapsed_ms) = self.times(record)?;
        Ok(stamped_ms
            .filter(|_| !self.is_early.get())
            .unwrap_or(elapsed_ms))
    }

    /// Time of recorded commands by the time stamps of the device, and from their submission until the device is idle, ms.
    fn times(
        &self,
        record: impl FnOnce(&mut wgpu::CommandEncoder),
    ) -> Result<(Option<f64>, f64), Box<dyn Error>> {
        self.wait()?;
        let mut encoder = self
            .device
            .create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let stamp = |encoder: &mut wgpu::CommandEncoder, passes| {
            if let Some(timers) = &self.timers {
                timers.borrow().stamp(encoder, passes);
            }
        };
        stamp(&mut encoder, 0);
        record(&mut encoder);
        stamp(&mut encoder, 1);
        let commands = encoder.finish();
        let start = Instant::now();
        self.queue.submit([commands]);
        self.wait()?;
        let elapsed_ms = 1e3 * start.elapsed().as_secs_f64();
        let Some(timers) = &self.timers else {
            return Ok((None, elapsed_ms));
        };
        let mut timers = timers.borrow_mut();
        timers.read();
        self.wait()?;
        let times = timers
            .take(&self.device)
            .ok_or("expected time stamps from the device, got none")?;
        Ok((times.first().copied(), elapsed_ms))
    }

    /// Time of work on the processor and of its uploads, ms.
    pub fn time_work<E: Error + 'static>(
        &self,
        work: impl FnOnce() -> Result<(), E>,
    ) -> Result<f64, Box<dyn Error>> {
        self.wait()?;
        let start = Instant::now();
        work()?;
        self.queue.submit([]);
        self.wait()?;
        Ok(1e3 * start.elapsed().as_secs_f64())
    }

    /// Waits until the device is idle.
    fn wait(&self) -> Result<(), wgpu::PollError> {
        self.device
            .poll(wgpu::PollType::wait_indefinitely())
            .map(|_| ())
    }
}

/// The middle value.
pub fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    let middle = values.len() / 2;
    match values.len() % 2 {
        1 => values[middle],
        _ => 0.5 * (values[middle - 1] + values[middle]),
    }
}
