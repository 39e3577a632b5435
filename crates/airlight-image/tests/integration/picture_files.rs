//! Atomic files, errors, progress, and equal bytes on every run.

use crate::common::{Folder, full_metadata, size, sky, tone};
use airlight_image::{
    Control, DepthOptions, ImageError, PictureFormat, PictureOptions, Progress, RowSource, Size,
    output::{
        Metadata, Written,
        exr::{self, ExrOptions},
        hdr,
        jpeg::{self, JpegOptions},
        png::{self, PngOptions},
    },
    read_depth_with, read_picture_with,
    rows::RowFn,
    write_picture,
};
use std::{
    fs,
    io::Cursor,
    path::Path,
    sync::{
        Mutex,
        atomic::{AtomicBool, Ordering},
    },
    time::Duration,
};

fn write_to(path: &Path, size: Size, source: &dyn RowSource) -> Result<Written, ImageError> {
    write_picture(
        path,
        size,
        source,
        &tone(),
        &PictureOptions::default(),
        Control::default(),
    )
}

#[test]
fn the_ending_names_the_format() {
    let folder = Folder::new();
    let size = size(40, 20);
    let endings = PictureFormat::ALL.iter().flat_map(|f| f.endings());
    let endings: Vec<String> = endings
        .map(|ending| (*ending).to_owned())
        .chain(["JPEG".to_owned(), "PNG".to_owned()])
        .collect();
    for ending in &endings {
        let path = folder.file(format!("sky.{ending}"));
        let written = write_to(&path, size, &sky(size, 3)).unwrap();
        assert_eq!(fs::metadata(&path).unwrap().len(), written.bytes);
        assert!(written.bytes > 100);
        // Again, replacing the first.
        write_to(&path, size, &sky(size, 3)).unwrap();
    }
    assert_eq!(folder.names("").len(), endings.len());
    assert_eq!(
        PictureFormat::from_path(Path::new("a.b.Hdr")).unwrap(),
        PictureFormat::HDR
    );
    let error = PictureFormat::from_path(Path::new("sky.tif"))
        .unwrap_err()
        .to_string();
    assert!(
        error.contains("sky.tif") && error.contains(".exr") && error.contains("`.tif`"),
        "{error}"
    );
    let error = PictureFormat::from_path(Path::new("sky"))
        .unwrap_err()
        .to_string();
    assert!(error.contains("no ending"), "{error}");
}

#[test]
fn a_bad_path_is_named_with_the_reason() {
    let folder = Folder::new();
    let size = size(40, 20);
    let missing = folder.file("none").join("sky.png");
    let error = write_to(&missing, size, &sky(size, 3))
        .unwrap_err()
        .to_string();
    assert!(
        error.contains("none") && error.contains("no folder"),
        "{error}"
    );
    fs::create_dir(folder.file("folder.png")).unwrap();
    let error = write_to(&folder.file("folder.png"), size, &sky(size, 3)).unwrap_err();
    assert!(error.to_string().contains("it is a folder"), "{error}");
    let error = write_to(&folder.file("sky.exr"), size, &sky(size, 4)).unwrap_err();
    assert!(error.to_string().contains('4'), "{error}");
    assert_eq!(folder.names(""), ["folder.png"]);
}

#[test]
fn a_cancelled_write_leaves_nothing() {
    let folder = Folder::new();
    let size = size(1000, 3000);
    for ending in ["exr", "hdr", "png", "jpg"] {
        let path = folder.file(format!("sky.{ending}"));
        fs::write(&path, "before").unwrap();
        let cancel = AtomicBool::new(false);
        let inner = sky(size, 3);
        let source = RowFn::new(3, |y, out: &mut [f32]| {
            if y == 1500 {
                cancel.store(true, Ordering::Relaxed);
            }
            inner.fill_row(y, out);
        });
        let error = write_picture(
            &path,
            size,
            &source,
            &tone(),
            &PictureOptions::default(),
            Control::cancelled_by(&cancel),
        )
        .unwrap_err();
        assert!(error.is_cancelled(), "{ending}: {error}");
        assert_eq!(fs::read(&path).unwrap(), b"before");
    }
    assert_eq!(folder.names("").len(), 4);
}

/// Wherever it is cancelled, a reader says so, not that the file is corrupt.
#[test]
fn a_reader_is_cancelled_on_its_way() {
    let folder = Folder::new();
    let size = size(1500, 1000);
    let (tone, options) = (tone(), PictureOptions::default());
    for ending in ["exr", "hdr", "png", "jpg"] {
        let path = folder.file(format!("sky.{ending}"));
        let rows = sky(size, 3);
        write_picture(&path, size, &rows, &tone, &options, Control::default()).unwrap();
        for delay_ms in [0, 3, 10, 30] {
            let cancel = AtomicBool::new(false);
            let error = std::thread::scope(|scope| {
                scope.spawn(|| {
                    std::thread::sleep(Duration::from_millis(delay_ms));
                    cancel.store(true, Ordering::Relaxed);
                });
                let read = || read_picture_with(&path, None, Control::cancelled_by(&cancel)).err();
                std::iter::repeat_with(read).find_map(|error| error)
            });
            let error = error.unwrap();
            assert!(error.is_cancelled(), "{ending}: {error}");
        }
    }
}

#[test]
fn a_cancelled_reader_ends() {
    let folder = Folder::new();
    let size = size(64, 32);
    let cancel = AtomicBool::new(true);
    let cancelled = || Control::cancelled_by(&cancel);
    let (tone, options) = (tone(), PictureOptions::default());
    for ending in ["exr", "hdr", "png", "jpg"] {
        let path = folder.file(format!("sky.{ending}"));
        let rows = sky(size, 3);
        write_picture(&path, size, &rows, &tone, &options, Control::default()).unwrap();
        let error = read_picture_with(&path, None, cancelled()).unwrap_err();
        assert!(error.is_cancelled(), "{ending}: {error}");
        read_picture_with(&path, None, Control::default()).unwrap();
    }
    let path = folder.file("sky.exr");
    let options = DepthOptions {
        channel: Some("R".to_owned()),
        ..DepthOptions::default()
    };
    let error = read_depth_with(&path, &options, cancelled()).unwrap_err();
    assert!(error.is_cancelled(), "{error}");
    read_depth_with(&path, &options, Control::default()).unwrap();
    let none = folder.file("none.png");
    let error = read_picture_with(&none, None, cancelled()).unwrap_err();
    assert!(error.is_cancelled(), "{error}");
}

#[test]
fn a_panicking_source_leaves_nothing() {
    let folder = Folder::new();
    let size = size(200, 100);
    for ending in ["exr", "hdr", "png", "jpg"] {
        let path = folder.file(format!("sky.{ending}"));
        let source = RowFn::new(3, |y, out: &mut [f32]| {
            assert!(y < 50, "the source gives up");
            out.fill(0.5);
        });
        let outcome = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| {
            write_to(&path, size, &source)
        }));
        assert!(outcome.is_err());
    }
    assert!(folder.names("").is_empty(), "{:?}", folder.names(""));
}

#[test]
fn a_full_disk_is_reported() {
    struct Full(usize);
    impl std::io::Write for Full {
        fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
            if self.0 < bytes.len() {
                return Err(std::io::Error::other("the disk is full"));
            }
            self.0 -= bytes.len();
            Ok(bytes.len())
        }
        fn flush(&mut self) -> std::io::Result<()> {
            Ok(())
        }
    }
    let size = size(500, 2000);
    let source = sky(size, 3);
    for room in [0, 10, 5000] {
        let metadata = Metadata::default();
        let control = Control::default();
        for outcome in [
            hdr::encode(&mut Full(room), size, &source, &metadata, control),
            png::encode(
                &mut Full(room),
                size,
                &source,
                &tone(),
                &PngOptions::default(),
                &metadata,
                control,
            ),
            jpeg::encode(
                &mut Full(room),
                size,
                &source,
                &tone(),
                &JpegOptions::default(),
                &metadata,
                control,
            ),
        ] {
            let error = outcome.unwrap_err().at(Path::new("sky.x")).to_string();
            assert!(
                error.contains("disk is full") && error.contains("sky.x"),
                "{error}"
            );
        }
    }
}

#[test]
fn progress_is_reported_in_order_and_to_the_end() {
    #[derive(Default)]
    struct Heard(Mutex<Vec<u64>>);
    impl Progress for Heard {
        fn advanced(&self, done: u64, total: u64) {
            assert_eq!(total, 1000);
            self.0.lock().unwrap().push(done);
        }
    }
    let folder = Folder::new();
    let size = size(500, 1000);
    for ending in ["exr", "hdr", "png", "jpg"] {
        let heard = Heard::default();
        write_picture(
            &folder.file(format!("sky.{ending}")),
            size,
            &sky(size, 3),
            &tone(),
            &PictureOptions::default(),
            Control::default().reporting_to(&heard),
        )
        .unwrap();
        let rows = heard.0.into_inner().unwrap();
        assert!(rows.is_sorted() && rows.len() > 2, "{rows:?}");
        assert_eq!(rows.last(), Some(&1000));
    }
}

#[test]
fn equal_rows_give_equal_files() {
    let size = size(700, 400);
    let make = |threads| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| {
            let mut out = Cursor::new(Vec::new());
            exr::encode(
                &mut out,
                size,
                &["R", "G", "B"],
                &sky(size, 3),
                &ExrOptions::default(),
                &full_metadata(),
                Control::default(),
            )
            .unwrap();
            let mut png = Vec::new();
            png::encode(
                &mut png,
                size,
                &sky(size, 3),
                &tone(),
                &PngOptions::default(),
                &full_metadata(),
                Control::default(),
            )
            .unwrap();
            (out.into_inner(), png)
        })
    };
    let (one, four) = (make(1), make(4));
    assert!(one == four);
}
