//! Memory of writers: a large picture is never in memory as a whole.

use crate::common::Folder;
use airlight_image::{
    Control, PictureOptions, Size,
    output::{
        Metadata,
        exr::{ExrOptions, SamplePrecision},
        spectral::{self, SpectralLayout},
    },
    rows::RowFn,
    tone::{ToneCurve, ToneMapper},
    write_picture,
};
use std::process::Command;

/// Peak memory of this process in bytes, on Linux.
fn peak_memory() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status
        .lines()
        .find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kilobytes: u64 = line.trim().trim_end_matches(" kB").parse().ok()?;
    Some(kilobytes * 1024)
}

#[test]
#[ignore = "takes a while: 16384 pixels wide, every format, 32 threads"]
fn wide_pictures_fit_in_little_memory() {
    // In a separate process, so that no other test adds to the peak.
    const ALONE: &str = "AIRLIGHT_MEMORY_TEST_IS_ALONE";
    if std::env::var_os(ALONE).is_none() {
        let status = Command::new(std::env::current_exe().unwrap())
            .args(["memory::wide_pictures_fit_in_little_memory", "--exact"])
            .args(["--ignored", "--nocapture"])
            .env(ALONE, "1")
            .status()
            .unwrap();
        assert!(status.success());
        return;
    }
    let folder = Folder::new();
    let rows = |channels| {
        RowFn::new(channels, |y, out: &mut [f32]| {
            // Noise, which compresses little.
            let mut state = y.wrapping_mul(0x9e37_79b9) | 1;
            for value in out {
                state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                *value = 0.1 + (state >> 8) as f32 * 1e-8;
            }
        })
    };
    let tone = ToneMapper::new(1.0, ToneCurve::default()).unwrap();
    let float = ExrOptions {
        precision: SamplePrecision::Float,
        ..ExrOptions::default()
    };
    let options = PictureOptions {
        exr: float,
        ..PictureOptions::default()
    };
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(32)
        .build()
        .unwrap();
    pool.install(|| {
        let size = Size::new(16384, 1024).unwrap();
        for ending in ["png", "jpg", "hdr", "exr"] {
            let path = folder.file(format!("wide.{ending}"));
            write_picture(&path, size, &rows(3), &tone, &options, Control::default()).unwrap();
            println!("{ending}: peak {:?}", peak_memory());
        }
        let wavelengths: Vec<f64> = (0..40).map(|i| 380.0 + 10.0 * f64::from(i)).collect();
        spectral::write(
            &folder.file("spectral.exr"),
            Size::new(16384, 128).unwrap(),
            &SpectralLayout::new(&wavelengths).unwrap(),
            &rows(43),
            &float,
            &Metadata::default(),
            Control::default(),
        )
        .unwrap();
        println!("spectral: peak {:?}", peak_memory());
    });
    if let Some(peak) = peak_memory() {
        assert!(peak < 300 << 20, "{} MiB", peak >> 20);
    }
}
