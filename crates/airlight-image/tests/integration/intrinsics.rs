//! Cameras by focal length and principal point.

use crate::common::size;
use airlight_image::{Camera, Frame, ImageError, Intrinsics, Projection, frame::PixelCentres};
use glam::DVec3;

#[test]
fn a_middle_principal_point_is_the_perspective_projection() {
    for (width, height) in [(640, 360), (33, 77), (1, 1)] {
        let camera = Camera {
            azimuth_deg: 123.0,
            elevation_deg: -12.0,
            roll_deg: 7.0,
            vertical_fov_deg: 41.0,
        };
        let frame = Frame::new(Projection::Perspective(camera), width, height).unwrap();
        let pinhole = Intrinsics::of_camera(&camera, size(width, height)).unwrap();
        for j in 0..height {
            for i in 0..width {
                let expected = frame.pixel_direction(i, j).unwrap();
                let got = pinhole.pixel_direction(i, j);
                assert!((got - expected).length() < 1e-14, "{i} {j}");
            }
        }
    }
}

#[test]
fn a_horizontal_field_of_view_reaches_the_edges() {
    let size = size(800, 600);
    let camera = Camera::with_horizontal_fov(10.0, 5.0, 70.0, size);
    let expected = Intrinsics::of_camera(&camera, size).unwrap();
    let got = Intrinsics::from_horizontal_fov(size, 70.0)
        .unwrap()
        .looking(10.0, 5.0, 0.0)
        .unwrap();
    assert!((got.focal_px().0 - expected.focal_px().0).abs() < 1e-9);
    assert!((got.pixel_direction(3, 500) - expected.pixel_direction(3, 500)).length() < 1e-12);
    let edge = got.focal_px().0 * 35f64.to_radians().tan();
    assert!((edge - 400.0).abs() < 1e-9);
}

#[test]
fn rows_and_pixels_agree_bit_for_bit() {
    let size = size(37, 23);
    let pinhole = Intrinsics::new(size, (50.0, 51.5), (12.25, 20.0), PixelCentres::Halves)
        .unwrap()
        .looking(200.0, 30.0, -15.0)
        .unwrap();
    let mut directions = vec![DVec3::ZERO; 37];
    let mut lengths = vec![0.0; 37];
    for j in 0..23 {
        pinhole.fill(j, &mut directions, &mut lengths);
        for i in 0..37 {
            assert_eq!(directions[i as usize], pinhole.pixel_direction(i, j));
            assert_eq!(lengths[i as usize], pinhole.ray_length_per_z(i, j));
            let direction = directions[i as usize];
            assert!((direction.length() - 1.0).abs() < 1e-14);
            let cos = direction.dot(pinhole.axis());
            assert!((cos - pinhole.cos_to_axis(i, j)).abs() < 1e-14);
            assert!((lengths[i as usize] * cos - 1.0).abs() < 1e-14);
        }
    }
}

#[test]
fn the_axis_meets_the_principal_point() {
    let at = |centres| Intrinsics::new(size(741, 500), (994.978, 994.978), (311.0, 254.0), centres);
    // With centres at whole numbers, the centre of pixel (311, 254).
    let whole = at(PixelCentres::Whole).unwrap();
    assert!((whole.pixel_direction(311, 254) - whole.axis()).length() < 1e-15);
    assert_eq!(whole.ray_length_per_z(311, 254), 1.0);
    assert_eq!(whole.principal_px(), (311.5, 254.5));
    // Otherwise a corner of four pixels.
    let halves = at(PixelCentres::Halves).unwrap();
    let sum = halves.pixel_direction(310, 253) + halves.pixel_direction(311, 254);
    assert!((sum.normalize() - halves.axis()).length() < 1e-12);
    // Level and to the north: right is east, and down the picture is down.
    let right = whole.pixel_direction(700, 254);
    assert!(right.x > 0.0 && right.y.abs() < 1e-15 && right.z < 0.0);
    assert!(whole.pixel_direction(311, 400).y < 0.0);
}

#[test]
fn settings_out_of_range_are_refused() {
    let size = size(10, 10);
    let make = |focal, principal| Intrinsics::new(size, focal, principal, PixelCentres::Halves);
    for focal in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-300, 1e300] {
        let error = make((focal, 1.0), (5.0, 5.0)).unwrap_err();
        assert!(error.to_string().contains("focal length"), "{error}");
        assert!(make((1.0, focal), (5.0, 5.0)).is_err());
    }
    for principal in [f64::NAN, f64::INFINITY, -1e300] {
        assert!(make((1.0, 1.0), (principal, 5.0)).is_err());
        assert!(make((1.0, 1.0), (5.0, principal)).is_err());
    }
    for fov in [0.0, 180.0, -3.0, f64::NAN] {
        assert!(Intrinsics::from_horizontal_fov(size, fov).is_err());
    }
    let good = make((10.0, 10.0), (5.0, 5.0)).unwrap();
    assert!(good.looking(f64::NAN, 0.0, 0.0).is_err());
    assert!(good.looking(0.0, 91.0, 0.0).is_err());
    let error = good.looking(0.0, 0.0, f64::INFINITY).unwrap_err();
    assert!(matches!(error, ImageError::Setting { .. }));
}
