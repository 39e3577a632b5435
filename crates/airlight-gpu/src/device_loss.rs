//! [`is_device_lost`]: devices that can no longer draw.

/// Whether a device is lost, as after a reset of the driver, when a graphics card is taken away, or after [`wgpu::Device::destroy`].
///
/// It asks for a few bytes of the device, and needs no callback, so that a program may set its own. In a browser, where such a request
/// never fails, it is always false; there, use [`wgpu::Device::set_device_lost_callback`].
pub fn is_device_lost(device: &wgpu::Device) -> bool {
    let buffer = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("airlight device loss"),
        size: wgpu::COPY_BUFFER_ALIGNMENT,
        usage: wgpu::BufferUsages::COPY_SRC,
        mapped_at_creation: true,
    });
    buffer.get_mapped_range(..).is_err()
}
