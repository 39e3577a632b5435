//! JPEG files: baseline, 8 bits, sRGB by convention. Rows are tone mapped in parallel; one thread encodes.

pub use super::options::JpegOptions;
use super::{
    Metadata,
    bands::{Bands, RowBuffer},
    format::{FormatEntry, Written, expect_channels, into_file},
};
use crate::{Control, ImageError, RowSource, Size, tone::ToneMapper};
use jpeg_encoder::{
    Encoder, EncodingError, ImageBuffer, JpegColorType, PixelDensity, PixelDensityUnit,
    SamplingFactor,
};
use std::{
    cell::RefCell,
    io::{self, Write},
    path::Path,
    sync::{
        atomic::{AtomicBool, Ordering},
        mpsc::{Receiver, sync_channel},
    },
    thread,
};

const FORMAT: &str = "JPEG";

/// Registry entry of the format.
pub(super) static ENTRY: FormatEntry = FormatEntry {
    name: FORMAT,
    endings: &["jpg", "jpeg"],
    is_linear: false,
    holds_alpha: false,
    holds_channels: false,
    clamping: "",
    describe: |_| FORMAT.to_owned(),
    write: |path, rgb, options, control| {
        let (jpeg, metadata) = (&options.jpeg, &options.metadata);
        write(
            path, rgb.size, rgb.source, rgb.tone, jpeg, metadata, control,
        )
    },
};

/// Writes linear RGB rows, tone mapped by `tone`, to a file.
///
/// # Errors
/// [`ImageError`]; the target is then unchanged.
pub fn write(
    path: &Path,
    size: Size,
    source: &dyn RowSource,
    tone: &ToneMapper,
    options: &JpegOptions,
    metadata: &Metadata,
    control: Control<'_>,
) -> Result<Written, ImageError> {
    into_file(path, control, |out| {
        encode(out, size, source, tone, options, metadata, control)
    })
}

/// Writes linear RGB rows to a stream as [`write()`] does; [`Written::bytes`] stays 0.
///
/// # Errors
/// [`ImageError`] where the source does not have three channels, a side is above 65535, the quality is out of range, the
/// metadata state other primaries than those of sRGB, the stream fails, or the caller cancels.
pub fn encode(
    out: &mut (dyn Write + Send),
    size: Size,
    source: &dyn RowSource,
    tone: &ToneMapper,
    options: &JpegOptions,
    metadata: &Metadata,
    control: Control<'_>,
) -> Result<Written, ImageError> {
    expect_channels(FORMAT, source, 3)?;
    if !(1..=100).contains(&options.quality) {
        return Err(ImageError::Setting {
            what: "the JPEG quality",
            got: options.quality.to_string(),
            right: "1 to 100",
        });
    }
    metadata.require_srgb(FORMAT)?;
    let side = |n: u32| {
        u16::try_from(n).map_err(|_| ImageError::Encode {
            format: FORMAT,
            reason: format!("expected at most 65535 pixels a side, got {n}; try PNG or EXR"),
        })
    };
    let (width, height) = (side(size.width())?, side(size.height())?);
    let stopped = AtomicBool::new(false);
    let (sender, receiver) = sync_channel(1);
    thread::scope(|scope| {
        let encoder = scope.spawn(|| {
            let stream = Stoppable {
                out,
                stopped: &stopped,
            };
            let buffer = IncomingRows {
                width,
                height,
                incoming: receiver,
                band: RefCell::default(),
                stopped: &stopped,
            };
            run_encoder(stream, buffer, options, metadata)
        });
        // The sender is dropped with the closure, so that the encoder does not wait forever.
        let fed = Bands::for_channels(size, 3, 16).run(
            size.width() as usize * 3 * 64,
            control,
            |band| {
                Ok(planar_band(
                    source,
                    tone,
                    size,
                    Bands::for_channels(size, 3, 16),
                    band,
                ))
            },
            {
                let sender = sender;
                move |_, band| sender.send(band).map_err(|_| ImageError::Cancelled)
            },
        );
        if fed.is_err() {
            stopped.store(true, Ordering::Relaxed);
        }
        let encoded = encoder.join().unwrap_or_else(|_| {
            Err(ImageError::Encode {
                format: FORMAT,
                reason: "the encoder panicked".to_owned(),
            })
        });
        // An error of the encoder takes precedence over the closed channel that it causes.
        match (fed, control.check()) {
            (Ok(()), _) => encoded,
            (Err(_), Err(cancelled)) => Err(cancelled.into()),
            (Err(ImageError::Cancelled), Ok(())) => encoded,
            (Err(other), Ok(())) => Err(other),
        }
    })?;
    Ok(Written::default())
}

fn run_encoder(
    stream: Stoppable<'_>,
    buffer: IncomingRows<'_>,
    options: &JpegOptions,
    metadata: &Metadata,
) -> Result<(), ImageError> {
    let mut encoder = Encoder::new(stream, options.quality);
    encoder.set_sampling_factor(if options.quality >= 90 {
        SamplingFactor::F_1_1
    } else {
        SamplingFactor::F_2_2
    });
    if let Some(aspect) = metadata.pixel_aspect.filter(|aspect| *aspect != 1.0) {
        // Pixels per unit, in the largest numbers that fit.
        let largest = 1000.0;
        let density = match aspect > 1.0 {
            true => (largest / aspect, largest),
            false => (largest, largest * aspect),
        };
        encoder.set_density(PixelDensity {
            density: (density.0.round() as u16, density.1.round() as u16),
            unit: PixelDensityUnit::PixelAspectRatio,
        });
    }
    let failed = |error| match error {
        EncodingError::IoError(source) => ImageError::Stream {
            format: FORMAT,
            source,
        },
        other => ImageError::Encode {
            format: FORMAT,
            reason: other.to_string(),
        },
    };
    encoder.add_exif_metadata(&exif(metadata)).map_err(failed)?;
    encoder.encode_image(buffer).map_err(failed)
}

/// Luma and the two chroma planes of a band.
type PlanarBand = [Vec<u8>; 3];

fn planar_band(
    source: &dyn RowSource,
    tone: &ToneMapper,
    size: Size,
    bands: Bands,
    band: u32,
) -> PlanarBand {
    let width = size.width() as usize;
    let mut rows = RowBuffer::new(source, size);
    let mut rgb = vec![0u8; width * 3];
    let count = width * bands.rows(band).len();
    let mut planes: PlanarBand = std::array::from_fn(|_| vec![0; count]);
    let [luma, blue, red] = planes.each_mut().map(|plane| plane.chunks_exact_mut(width));
    for (y, ((luma, blue), red)) in bands.rows(band).zip(luma.zip(blue).zip(red)) {
        tone.row_to_u8(y, rows.row(y), &mut rgb);
        let parts = luma
            .chunks_mut(BLOCK)
            .zip(blue.chunks_mut(BLOCK))
            .zip(red.chunks_mut(BLOCK));
        for (rgb, ((luma, blue), red)) in rgb.chunks(3 * BLOCK).zip(parts) {
            to_ycbcr(rgb, luma, blue, red);
        }
    }
    planes
}

/// Pixels converted together.
const BLOCK: usize = 64;

/// Converts at most [`BLOCK`] interleaved pixels to luma and chroma (JFIF), with weights in units of 2^-16.
fn to_ycbcr(rgb: &[u8], luma: &mut [u8], blue: &mut [u8], red: &mut [u8]) {
    const ROUND: i32 = (1 << 15) - 1;
    const MIDDLE: i32 = 128 << 16;
    let mut planes = [[0i32; BLOCK]; 3];
    for (i, pixel) in rgb.as_chunks::<3>().0.iter().enumerate().take(BLOCK) {
        for (plane, &value) in planes.iter_mut().zip(pixel) {
            plane[i] = i32::from(value);
        }
    }
    let [r, g, b] = &planes;
    let convert = |out: &mut [u8], [from_r, from_g, from_b]: [i32; 3], offset: i32| {
        let mut values = [0u8; BLOCK];
        for i in 0..BLOCK {
            let sum = from_r * r[i] + from_g * g[i] + from_b * b[i] + (offset + ROUND);
            values[i] = (sum >> 16) as u8;
        }
        let count = out.len().min(BLOCK);
        out[..count].copy_from_slice(&values[..count]);
    };
    convert(luma, [19_595, 38_470, 7_471], 0);
    convert(blue, [-11_059, -21_709, 32_768], MIDDLE);
    convert(red, [32_768, -27_439, -5_329], MIDDLE);
}

/// Rows as they arrive for the encoder, which reads them from top to bottom and may repeat the last one.
struct IncomingRows<'a> {
    width: u16,
    height: u16,
    incoming: Receiver<PlanarBand>,
    /// The current band and its first row.
    band: RefCell<(PlanarBand, usize)>,
    stopped: &'a AtomicBool,
}

impl ImageBuffer for IncomingRows<'_> {
    fn get_jpeg_color_type(&self) -> JpegColorType {
        JpegColorType::Ycbcr
    }

    fn width(&self) -> u16 {
        self.width
    }

    fn height(&self) -> u16 {
        self.height
    }

    fn fill_buffers(&self, y: u16, buffers: &mut [Vec<u8>; 4]) {
        let width = usize::from(self.width);
        let mut band = self.band.borrow_mut();
        while usize::from(y) >= band.1 + band.0[0].len() / width {
            let first = band.1 + band.0[0].len() / width;
            match self.incoming.recv() {
                Ok(next) => *band = (next, first),
                Err(_) => {
                    // No more rows: stops the encoder at its next write.
                    self.stopped.store(true, Ordering::Relaxed);
                    for buffer in &mut buffers[..3] {
                        buffer.resize(buffer.len() + width, 0);
                    }
                    return;
                }
            }
        }
        let start = (usize::from(y) - band.1) * width;
        for (buffer, plane) in buffers.iter_mut().zip(&band.0) {
            buffer.extend_from_slice(&plane[start..start + width]);
        }
    }
}

/// A stream that fails once `stopped` is set: the only way to interrupt the encoder.
struct Stoppable<'a> {
    out: &'a mut (dyn Write + Send),
    stopped: &'a AtomicBool,
}

impl Write for Stoppable<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if self.stopped.load(Ordering::Relaxed) {
            return Err(io::Error::other("stopped"));
        }
        self.out.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.out.flush()
    }
}

/// A minimal Exif block (TIFF, little endian): software, description, sRGB colour space.
fn exif(metadata: &Metadata) -> Vec<u8> {
    const ASCII: u16 = 2;
    const SHORT: u16 = 3;
    const LONG: u16 = 4;
    const HEADER: usize = 8;
    let description: String = metadata
        .as_texts()
        .iter()
        .filter(|(name, _)| name != "Software")
        .map(|(name, text)| format!("{name}: {text}"))
        .collect::<Vec<_>>()
        .join("; ");
    let ascii = |text: &str| {
        let mut bytes: Vec<u8> = text
            .chars()
            .map(|c| {
                if c.is_ascii() && c != '\0' {
                    c as u8
                } else {
                    b'?'
                }
            })
            .take(8000)
            .collect();
        bytes.push(0);
        // Texts of up to 4 bytes would be stored in the entry itself.
        while bytes.len() < 5 {
            bytes.push(0);
        }
        bytes
    };
    let texts = [
        (0x010eu16, ascii(&description)),
        (0x0131, ascii(metadata.software.as_deref().unwrap_or(""))),
    ];
    let directory = HEADER + 2 + 3 * 12 + 4;
    let sub_directory = directory + 2 + 12 + 4;
    let mut bytes = Vec::from(*b"II*\0\x08\0\0\0\x03\0");
    let entry = |bytes: &mut Vec<u8>, tag: u16, kind: u16, count: usize, value: usize| {
        bytes.extend_from_slice(&tag.to_le_bytes());
        bytes.extend_from_slice(&kind.to_le_bytes());
        bytes.extend_from_slice(&(count as u32).to_le_bytes());
        bytes.extend_from_slice(&(value as u32).to_le_bytes());
    };
    let mut at = sub_directory;
    for (tag, text) in &texts {
        entry(&mut bytes, *tag, ASCII, text.len(), at);
        at += text.len();
    }
    entry(&mut bytes, 0x8769, LONG, 1, directory);
    bytes.extend_from_slice(&[0; 4]);
    bytes.extend_from_slice(&1u16.to_le_bytes());
    entry(&mut bytes, 0xa001, SHORT, 1, 1);
    bytes.extend_from_slice(&[0; 4]);
    for (_, text) in texts {
        bytes.extend_from_slice(&text);
    }
    bytes
}
