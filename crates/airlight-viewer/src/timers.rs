//! [`PassTimes`]: how long the graphics device takes for the passes of a picture.

use airlight_gpu::PassTimers;
use eframe::wgpu;

/// Number of passes that are timed.
pub const PASSES: u32 = 3;

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

impl PassTimes {
    /// The times of the picture whose stamps timers of [`PASSES`] read, when they have arrived.
    pub fn take(timers: &mut PassTimers, device: &wgpu::Device) -> Option<Self> {
        let times = timers.take(device)?;
        let [ground_ms, air_ms, tone_ms] = times.try_into().ok()?;
        Some(Self {
            ground_ms,
            air_ms,
            tone_ms,
        })
    }
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
