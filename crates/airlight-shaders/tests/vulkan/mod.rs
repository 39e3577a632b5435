//! The Vulkan device of the tests.

/// The first Vulkan device, with its name and driver.
///
/// # Panics
/// If there is none, with the way to get one.
pub fn open() -> (String, wgpu::Device, wgpu::Queue) {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor {
        backends: wgpu::Backends::VULKAN,
        ..wgpu::InstanceDescriptor::new_without_display_handle()
    });
    let adapter =
        pollster::block_on(instance.request_adapter(&wgpu::RequestAdapterOptions::default()))
            .unwrap_or_else(|e| {
                panic!(
                    "no Vulkan device to run shaders on ({e}): install a driver; on Debian: \
                     apt-get install mesa-vulkan-drivers libvulkan1"
                )
            });
    let (device, queue) =
        pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor::default()))
            .expect("a device of the adapter");
    let info = adapter.get_info();
    let name = format!("{}, {}", info.name, info.driver_info);
    (name, device, queue)
}
