//! [`configuration`]: what the viewer asks of a graphics device.

use airlight_gpu::{PassTimers, SkyPasses};
use eframe::egui_wgpu::{WgpuConfiguration, WgpuSetup, WgpuSetupCreateNew};
use eframe::wgpu;
use std::sync::Arc;

/// The usual device, with what draws faster and timers of passes, where the adapter has them.
pub fn configuration() -> WgpuConfiguration {
    let mut setup = WgpuSetupCreateNew::without_display_handle();
    let usual = setup.device_descriptor.clone();
    setup.device_descriptor = Arc::new(move |adapter: &wgpu::Adapter| {
        let mut descriptor = usual(adapter);
        let wanted = PassTimers::FEATURES | SkyPasses::OPTIONAL_FEATURES;
        descriptor.required_features |= adapter.features() & wanted;
        descriptor
    });
    WgpuConfiguration {
        wgpu_setup: WgpuSetup::CreateNew(setup),
        ..Default::default()
    }
}
