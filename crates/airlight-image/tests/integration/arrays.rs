//! Pictures in memory: from arrays, and drawn to arrays.

use crate::common::size;
use airlight::Cancelled;
use airlight_image::input::{LightReference, Picture};
use airlight_image::rows::{RowFn, draw_rows};
use airlight_image::{Control, RowSource};
use std::sync::atomic::AtomicBool;

#[test]
fn arrays_are_pictures_of_their_kind_of_light() {
    let size = size(2, 1);
    let bytes = Picture::from_srgb_u8(size, &[0, 255, 128, 1, 2, 3]).unwrap();
    assert_eq!(bytes.reference, LightReference::Display);
    assert_eq!(bytes.rgb[..2], [0.0, 1.0]);
    assert!((bytes.rgb[2] - 0.215_861).abs() < 1e-6);
    let words = [0, 255, 128, 1, 2, 3].map(|v| 257 * v);
    let wide = Picture::from_srgb_u16(size, &words).unwrap();
    for (wide, byte) in wide.rgb.iter().zip(&bytes.rgb) {
        assert!((wide - byte).abs() < 1e-7, "{wide} {byte}");
    }
    let light = [0.5, f32::NAN, -1.0, f32::INFINITY, 2.0, 3.0];
    let linear = Picture::from_linear(size, &light).unwrap();
    assert_eq!(linear.reference, LightReference::Scene);
    assert_eq!(linear.rgb, [0.5, 0.0, -1.0, 65504.0, 2.0, 3.0]);
    assert!(Picture::from_linear(size, &light[..5]).is_err());
}

#[test]
fn rows_are_drawn_in_order_and_stop_when_cancelled() {
    let rows = RowFn::new(1, |y, out: &mut [f32]| {
        for (x, out) in out.iter_mut().enumerate() {
            *out = 10.0 * y as f32 + x as f32;
        }
    });
    let rows: &dyn RowSource = &rows;
    let drawn = draw_rows(rows, size(2, 3), Control::default()).unwrap();
    assert_eq!(drawn, [0.0, 1.0, 10.0, 11.0, 20.0, 21.0]);
    let stop = AtomicBool::new(true);
    let stopped = draw_rows(rows, size(2, 3), Control::cancelled_by(&stop));
    assert_eq!(stopped, Err(Cancelled));
}
