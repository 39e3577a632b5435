//! EXR files of bands of rows, and the picture that they join to.

use crate::common::{Folder, full_metadata, size, sky};
use airlight_image::output::exr::{self, ExrCompression, ExrOptions, SamplePrecision};
use airlight_image::output::{Metadata, RowBand};
use airlight_image::rows::RowsFrom;
use airlight_image::{Control, ImageError, RowSource};
use std::{fs, ops::Range, path::PathBuf};

const RGB: [&str; 3] = ["R", "G", "B"];

/// Rows of a picture 40 pixels wide and 100 high.
fn write(folder: &Folder, name: &str, rows: Range<u32>, options: &ExrOptions) -> PathBuf {
    let path = folder.file(name);
    let whole = size(40, 100);
    let source = sky(whole, 3);
    let (first_row, picture_rows) = (rows.start, 100);
    let metadata = Metadata {
        band: (rows.len() < 100).then_some(RowBand {
            first_row,
            picture_rows,
        }),
        ..full_metadata()
    };
    let (size, control) = (size(40, rows.len() as u32), Control::default());
    let band = RowsFrom::new(&source, first_row);
    exr::write(&path, size, &RGB, &band, options, &metadata, control).unwrap();
    path
}

#[test]
fn joined_bands_are_the_bytes_of_the_picture() {
    let folder = Folder::new();
    for compression in [
        ExrCompression::None,
        ExrCompression::Rle,
        ExrCompression::Zips,
        ExrCompression::Zip,
        ExrCompression::Piz,
    ] {
        for precision in [SamplePrecision::Float, SamplePrecision::Half] {
            let options = ExrOptions {
                precision,
                compression,
            };
            let whole = write(&folder, "whole.exr", 0..100, &options);
            let bands = [64..100, 0..32, 32..64].map(|rows| {
                let name = format!("band{}.exr", rows.start);
                write(&folder, &name, rows, &options)
            });
            let joined = folder.file("joined.exr");
            let written = exr::join(&bands, &joined, Control::default()).unwrap();
            let bytes = fs::read(&joined).unwrap();
            assert_eq!(written.bytes, bytes.len() as u64);
            assert!(
                bytes == fs::read(&whole).unwrap(),
                "{compression:?} {precision:?}"
            );
        }
    }
}

#[test]
fn a_band_is_read_in_its_place() {
    let folder = Folder::new();
    let band = write(&folder, "band.exr", 32..64, &ExrOptions::default());
    let picture = airlight_image::read_picture(&band, None).unwrap();
    assert_eq!((picture.size.width(), picture.size.height()), (40, 100));
    let mut row = vec![0.0; 120];
    sky(size(40, 100), 3).fill_row(40, &mut row);
    assert_eq!(picture.rgb[40 * 120..41 * 120], row);
}

#[test]
fn bands_that_are_not_one_picture_are_refused() {
    let folder = Folder::new();
    let options = ExrOptions::default();
    let half = ExrOptions {
        precision: SamplePrecision::Half,
        ..options
    };
    let [a, b, c] = [(0..32), (32..64), (64..100)]
        .map(|rows| write(&folder, &format!("{}.exr", rows.start), rows, &options));
    let overlapping = write(&folder, "overlapping.exr", 16..64, &options);
    let other = write(&folder, "other.exr", 64..100, &half);
    let begun = write(&folder, "begun.exr", 0..20, &options);
    let odd = write(&folder, "odd.exr", 20..100, &options);
    let torn = folder.file("torn.exr");
    let bytes = fs::read(&b).unwrap();
    fs::write(&torn, &bytes[..bytes.len() - 10]).unwrap();
    let missing = folder.file("missing.exr");
    for (bands, part) in [
        (vec![], "the number of bands must be 1 or more, got 0"),
        (vec![&a, &c], "rows 32 to 63 of the picture are in no band"),
        (vec![&b, &c], "rows 0 to 31 of the picture are in no band"),
        (vec![&a, &b], "rows 64 to 99 of the picture are in no band"),
        (
            vec![&a, &overlapping, &c],
            "rows 16 to 31 are also in another band",
        ),
        (
            vec![&a, &a, &b, &c],
            "rows 0 to 31 are also in another band",
        ),
        (vec![&a, &b, &other], "a band of another picture"),
        (vec![&begun, &odd], "a multiple of 16, got 20"),
        (vec![&a, &torn, &c], "torn.exr"),
        (vec![&a, &missing, &c], "missing.exr"),
    ] {
        let bands: Vec<PathBuf> = bands.into_iter().cloned().collect();
        let target = folder.file("joined.exr");
        let error = exr::join(&bands, &target, Control::default()).unwrap_err();
        assert!(error.to_string().contains(part), "{part}: {error}");
        assert!(!target.exists());
    }
}

#[test]
fn a_band_beyond_the_picture_is_refused() {
    let source = sky(size(8, 8), 3);
    let metadata = Metadata {
        band: Some(RowBand {
            first_row: 4,
            picture_rows: 11,
        }),
        ..Metadata::default()
    };
    let folder = Folder::new();
    let path = folder.file("a.exr");
    let options = ExrOptions::default();
    let error = exr::write(
        &path,
        size(8, 8),
        &RGB,
        &source,
        &options,
        &metadata,
        Control::default(),
    );
    assert!(matches!(error, Err(ImageError::Setting { .. })));
}
