//! Pixels of textures, read back from the device.

use crate::device_loss::is_device_lost;
use half::f16;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Error of [`read_texture`].
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("cannot read the pixels of a frame, as with a device that is lost: {0}")]
pub struct ReadTextureError(String);

/// Pixels on their way from the device: of a page, which must not wait for them, or of a window that goes on drawing.
#[derive(Debug)]
pub struct PendingPixels {
    buffer: wgpu::Buffer,
    format: wgpu::TextureFormat,
    /// Bytes of a row, and with padding.
    row: u32,
    padded_row: u32,
    has_arrived: Arc<AtomicBool>,
}

impl PendingPixels {
    /// Asks for the pixels of a texture that may be copied from. `wake` is called when they are there, or cannot be had.
    pub fn of(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        texture: &wgpu::Texture,
        wake: impl FnOnce() + Send + 'static,
    ) -> Self {
        let size = texture.size();
        let format = texture.format();
        let row = size.width * format.block_copy_size(None).unwrap_or(4);
        let padded_row = row.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let buffer = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("airlight pixels"),
            size: u64::from(padded_row * size.height),
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
                    bytes_per_row: Some(padded_row),
                    rows_per_image: None,
                },
            },
            size,
        );
        queue.submit([encoder.finish()]);
        let has_arrived = Arc::new(AtomicBool::new(false));
        let arrived = has_arrived.clone();
        // A failure shows when the range is taken.
        let arrive = move |_| {
            arrived.store(true, Ordering::Relaxed);
            wake();
        };
        match is_device_lost(device) {
            true => arrive(Err(wgpu::BufferAsyncError)),
            false => buffer.slice(..).map_async(wgpu::MapMode::Read, arrive),
        }
        Self {
            buffer,
            format,
            row,
            padded_row,
            has_arrived,
        }
    }

    /// Whether [`Self::bytes`] and [`Self::rgb`] return without waiting. Some devices find out only when they are polled.
    pub fn has_arrived(&self) -> bool {
        self.has_arrived.load(Ordering::Relaxed)
    }

    /// The bytes, row by row without padding.
    ///
    /// # Errors
    /// [`ReadTextureError`] before they have arrived, and if the device is lost.
    pub fn bytes(&self) -> Result<Vec<u8>, ReadTextureError> {
        let bytes = self.buffer.slice(..).get_mapped_range();
        let bytes = bytes.map_err(|error| ReadTextureError(error.to_string()))?;
        let rows = bytes.chunks(self.padded_row as usize);
        Ok(rows
            .flat_map(|of| &of[..self.row as usize])
            .copied()
            .collect())
    }

    /// Red, green and blue of a texture of `Rgba16Float`, row by row.
    ///
    /// # Errors
    /// As [`Self::bytes`], and for another format.
    pub fn rgb(&self) -> Result<Vec<[f32; 3]>, ReadTextureError> {
        const TEXEL_BYTES: usize = 8;
        let (right, format) = (wgpu::TextureFormat::Rgba16Float, self.format);
        if format != right {
            return Err(ReadTextureError(format!(
                "expected {right:?}, got {format:?}"
            )));
        }
        let bytes = self.bytes()?;
        let channel = |texel: &[u8; TEXEL_BYTES], c: usize| {
            f16::from_ne_bytes([texel[2 * c], texel[2 * c + 1]]).to_f32()
        };
        let rgb = |texel| std::array::from_fn(|c| channel(texel, c));
        Ok(bytes.as_chunks().0.iter().map(rgb).collect())
    }

    #[cfg(not(target_arch = "wasm32"))]
    fn wait(self, device: &wgpu::Device) -> Result<Self, ReadTextureError> {
        let polled = device.poll(wgpu::PollType::wait_indefinitely());
        polled.map_err(|error| ReadTextureError(error.to_string()))?;
        Ok(self)
    }
}

/// The bytes of a texture that may be copied from, row by row without padding. Waits for the device.
///
/// # Errors
/// [`ReadTextureError`] if the device is lost.
#[cfg(not(target_arch = "wasm32"))]
pub fn read_texture(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    texture: &wgpu::Texture,
) -> Result<Vec<u8>, ReadTextureError> {
    let pending = PendingPixels::of(device, queue, texture, || {});
    pending.wait(device)?.bytes()
}

/// Red, green and blue of a texture of `Rgba16Float` that may be copied from, row by row. Waits for the device.
///
/// # Errors
/// [`ReadTextureError`] if the device is lost, and for another format.
#[cfg(not(target_arch = "wasm32"))]
pub fn read_rgb(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    texture: &wgpu::Texture,
) -> Result<Vec<[f32; 3]>, ReadTextureError> {
    let pending = PendingPixels::of(device, queue, texture, || {});
    pending.wait(device)?.rgb()
}

/// The bytes of a buffer that may be copied from. Waits for the device.
///
/// # Errors
/// [`ReadTextureError`] if the device is lost.
#[cfg(feature = "headless")]
pub fn read_buffer(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    buffer: &wgpu::Buffer,
) -> Result<Vec<u8>, ReadTextureError> {
    let readable = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("airlight bytes"),
        size: buffer.size(),
        usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    encoder.copy_buffer_to_buffer(buffer, 0, &readable, 0, buffer.size());
    queue.submit([encoder.finish()]);
    // A failure shows when the range is taken.
    readable.slice(..).map_async(wgpu::MapMode::Read, |_| ());
    let polled = device.poll(wgpu::PollType::wait_indefinitely());
    polled.map_err(|error| ReadTextureError(error.to_string()))?;
    let bytes = readable.slice(..).get_mapped_range();
    Ok(bytes
        .map_err(|error| ReadTextureError(error.to_string()))?
        .to_vec())
}
