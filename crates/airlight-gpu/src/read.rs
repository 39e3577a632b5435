//! Pixels of textures, read back from the device.

use half::f16;

/// Error of [`read_texture`].
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("cannot read the pixels of a frame, as with a device that is lost: {0}")]
pub struct ReadTextureError(String);

/// The bytes of a texture that may be copied from, row by row without padding. Waits for the device.
///
/// # Errors
/// [`ReadTextureError`] if the device is lost.
pub fn read_texture(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    texture: &wgpu::Texture,
) -> Result<Vec<u8>, ReadTextureError> {
    let failed = |error: &dyn std::fmt::Display| ReadTextureError(error.to_string());
    let size = texture.size();
    let texel = texture.format().block_copy_size(None).unwrap_or(4);
    let row = size.width * texel;
    let bytes_per_row = row.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
    let buffer = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("airlight pixels"),
        size: u64::from(bytes_per_row * size.height),
        usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    encoder.copy_texture_to_buffer(
        texture.as_image_copy(),
        wgpu::TexelCopyBufferInfo {
            buffer: &buffer,
            layout: wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(bytes_per_row),
                rows_per_image: None,
            },
        },
        size,
    );
    queue.submit([encoder.finish()]);
    // A failure shows when the range is taken.
    buffer.slice(..).map_async(wgpu::MapMode::Read, |_| {});
    device
        .poll(wgpu::PollType::wait_indefinitely())
        .map_err(|error| failed(&error))?;
    let bytes = buffer
        .slice(..)
        .get_mapped_range()
        .map_err(|error| failed(&error))?;
    let rows = bytes.chunks(bytes_per_row as usize);
    Ok(rows.flat_map(|of| &of[..row as usize]).copied().collect())
}

/// Red, green and blue of a texture of `Rgba16Float` that may be copied from, row by row. Waits for the device.
///
/// # Errors
/// [`ReadTextureError`] if the device is lost, and for another format.
pub fn read_rgb(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    texture: &wgpu::Texture,
) -> Result<Vec<[f32; 3]>, ReadTextureError> {
    const TEXEL_BYTES: usize = 8;
    let (right, format) = (wgpu::TextureFormat::Rgba16Float, texture.format());
    if format != right {
        return Err(ReadTextureError(format!(
            "expected {right:?}, got {format:?}"
        )));
    }
    let bytes = read_texture(device, queue, texture)?;
    let channel = |texel: &[u8; TEXEL_BYTES], c: usize| {
        f16::from_ne_bytes([texel[2 * c], texel[2 * c + 1]]).to_f32()
    };
    let rgb = |texel| std::array::from_fn(|c| channel(texel, c));
    Ok(bytes.as_chunks().0.iter().map(rgb).collect())
}
