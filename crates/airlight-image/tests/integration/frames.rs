//! Projections: round trips, orientation, solid angles.

use airlight::Named;
use airlight::axes;
use airlight_image::{Camera, CubeFace, Fisheye, Frame, Projection};
use glam::DVec3;
use std::f64::consts::PI;

fn frames() -> Vec<Frame> {
    let mut projections = vec![
        (
            Projection::Equirectangular {
                center_azimuth_deg: 0.0,
            },
            64,
            32,
        ),
        (
            Projection::Equirectangular {
                center_azimuth_deg: -123.4,
            },
            70,
            20,
        ),
        (Projection::AngularFisheye(Fisheye::ALL_SKY), 40, 60),
        (
            Projection::AngularFisheye(Fisheye {
                azimuth_deg: 77.0,
                elevation_deg: -20.0,
                field_of_view_deg: 360.0,
            }),
            64,
            64,
        ),
        (
            Projection::Perspective(Camera {
                azimuth_deg: 250.0,
                elevation_deg: 30.0,
                roll_deg: 12.0,
                vertical_fov_deg: 60.0,
            }),
            80,
            45,
        ),
        (
            Projection::Perspective(Camera {
                azimuth_deg: 10.0,
                elevation_deg: 90.0,
                roll_deg: -170.0,
                vertical_fov_deg: 170.0,
            }),
            20,
            45,
        ),
    ];
    projections.extend(
        CubeFace::ALL
            .iter()
            .flat_map(|&face| {
                [
                    Projection::CubeFace(face),
                    Projection::MirroredCubeFace(face),
                ]
            })
            .map(|projection| (projection, 32, 32)),
    );
    projections
        .into_iter()
        .map(|(projection, width, height)| Frame::new(projection, width, height).unwrap())
        .collect()
}

#[test]
fn pixels_survive_a_round_trip_through_directions() {
    for frame in frames() {
        let (width, height) = (frame.size().width(), frame.size().height());
        let mut seen = 0;
        for i in 1..4 * width {
            for j in 1..4 * height {
                let (px, py) = (f64::from(i) / 4.0, f64::from(j) / 4.0);
                let Some(direction) = frame.direction(px, py) else {
                    continue;
                };
                seen += 1;
                assert!((direction.length() - 1.0).abs() < 1e-14);
                let (x, y) = frame.pixel_of(direction).unwrap();
                assert!(
                    (x - px).hypot(y - py) < 1e-7,
                    "{frame:?}: ({px}, {py}) came back as ({x}, {y})"
                );
            }
        }
        assert!(seen > 500);
    }
}

#[test]
fn directions_survive_a_round_trip_through_pixels() {
    for frame in frames() {
        let mut seen = 0;
        for azimuth in 0..120 {
            for elevation in -59..60 {
                let direction =
                    axes::direction(f64::from(azimuth) * 3.0 + 0.1, f64::from(elevation) * 1.5);
                if let Some((px, py)) = frame.pixel_of(direction * 7.0) {
                    seen += 1;
                    let again = frame.direction(px, py).unwrap();
                    assert!(again.distance(direction) < 1e-12, "{frame:?}: {direction}");
                }
            }
        }
        assert!(seen > 100);
    }
}

#[test]
fn rows_of_directions_are_those_of_single_pixels() {
    for frame in frames() {
        let rows = frame.rows();
        let mut out = vec![DVec3::ONE; frame.size().width() as usize];
        for j in 0..frame.size().height() {
            rows.fill(j, &mut out);
            for (i, direction) in out.iter().enumerate() {
                let single = frame.pixel_direction(i as u32, j).unwrap_or(DVec3::ZERO);
                assert_eq!(*direction, single);
            }
        }
    }
}

#[test]
fn pictures_have_the_right_orientation() {
    let close = |frame: &Frame, px: f64, py: f64, azimuth: f64, elevation: f64| {
        let direction = frame.direction(px, py).unwrap();
        let want = axes::direction(azimuth, elevation);
        assert!(direction.distance(want) < 1e-9, "{direction} is not {want}");
    };
    let map = Frame::equirectangular(100).unwrap();
    close(&map, 100.0, 50.0, 0.0, 0.0);
    close(&map, 150.0, 50.0, 90.0, 0.0);
    close(&map, 50.0, 25.0, 270.0, 45.0);
    close(&map, 3.0, 0.0, 0.0, 90.0);

    let all_sky = Frame::new(Projection::AngularFisheye(Fisheye::ALL_SKY), 100, 100).unwrap();
    close(&all_sky, 50.0, 50.0, 0.0, 90.0);
    close(&all_sky, 50.0, 0.0, 0.0, 0.0);
    close(&all_sky, 0.0, 50.0, 90.0, 0.0);
    close(&all_sky, 75.0, 50.0, 270.0, 45.0);
    assert!(all_sky.direction(1.0, 1.0).is_none());

    let camera = Camera {
        azimuth_deg: 90.0,
        elevation_deg: 0.0,
        roll_deg: 0.0,
        vertical_fov_deg: 90.0,
    };
    let east = Frame::new(Projection::Perspective(camera), 100, 100).unwrap();
    close(&east, 50.0, 50.0, 90.0, 0.0);
    close(&east, 100.0, 50.0, 135.0, 0.0);
    close(&east, 50.0, 0.0, 90.0, 45.0);
    // Rolled clockwise by a right angle, the top of the picture shows what its right side did.
    let rolled = Camera {
        roll_deg: 90.0,
        ..camera
    };
    let rolled = Frame::new(Projection::Perspective(rolled), 100, 100).unwrap();
    close(&rolled, 50.0, 0.0, 135.0, 0.0);

    for (face, azimuth, elevation) in [
        (CubeFace::PositiveX, 90.0, 0.0),
        (CubeFace::NegativeX, 270.0, 0.0),
        (CubeFace::PositiveY, 0.0, 90.0),
        (CubeFace::NegativeY, 0.0, -90.0),
        (CubeFace::PositiveZ, 180.0, 0.0),
        (CubeFace::NegativeZ, 0.0, 0.0),
    ] {
        let frame = Frame::new(Projection::CubeFace(face), 8, 8).unwrap();
        close(&frame, 4.0, 4.0, azimuth, elevation);
        // A program that samples the mirrored faces at (-x, y, z) finds the light from (x, y, z).
        let mirrored = Frame::new(Projection::MirroredCubeFace(face), 8, 8).unwrap();
        for (px, py) in [(1.0, 2.0), (4.0, 4.0), (7.5, 0.5)] {
            let sampled = frame.direction(px, py).unwrap();
            let shown = mirrored.direction(px, py).unwrap();
            assert_eq!(shown, DVec3::new(-sampled.x, sampled.y, sampled.z));
        }
    }
}

#[test]
fn a_horizontal_field_of_view_spans_the_picture() {
    let size = Frame::equirectangular(100).unwrap().size();
    let camera = Camera::with_horizontal_fov(0.0, 0.0, 90.0, size);
    let frame = Frame::new(Projection::Perspective(camera), 200, 100).unwrap();
    let edge = frame.direction(200.0, 50.0).unwrap();
    assert!((axes::azimuth_deg(edge) - 45.0).abs() < 1e-9);
    let camera = Camera::with_horizontal_fov(0.0, 0.0, 180.0, size);
    assert!(Frame::new(Projection::Perspective(camera), 200, 100).is_err());
}

#[test]
fn parts_of_a_pixel_have_its_solid_angle() {
    for frame in frames() {
        let (i, j) = (frame.size().width() / 2, frame.size().height() / 2);
        let (x, y) = (f64::from(i), f64::from(j));
        let cuts = [0.0, 0.3, 0.31, 1.0];
        let mut sum = 0.0;
        for across in cuts.windows(2) {
            for down in cuts.windows(2) {
                sum +=
                    frame.solid_angle((x + across[0], x + across[1]), (y + down[0], y + down[1]));
            }
        }
        let whole = frame.pixel_solid_angle(i, j);
        assert!((sum / whole - 1.0).abs() < 1e-9, "{frame:?}: {sum} {whole}");
    }
    // The closed form cancels for small rectangles: a field of view of 1e-5 degrees.
    let camera = Camera {
        azimuth_deg: 0.0,
        elevation_deg: 0.0,
        roll_deg: 0.0,
        vertical_fov_deg: 1e-5,
    };
    let zoomed = Frame::new(Projection::Perspective(camera), 10, 10).unwrap();
    let side = 1e-6f64.to_radians();
    assert!((zoomed.pixel_solid_angle(9, 3) / (side * side) - 1.0).abs() < 1e-9);
}

fn total(frame: &Frame) -> f64 {
    let (width, height) = (frame.size().width(), frame.size().height());
    (0..height)
        .flat_map(|j| (0..width).map(move |i| (i, j)))
        .map(|(i, j)| frame.pixel_solid_angle(i, j))
        .sum()
}

#[test]
fn pixels_cover_the_sphere() {
    let whole = 4.0 * PI;
    let map = Frame::equirectangular(91).unwrap();
    assert!((total(&map) / whole - 1.0).abs() < 1e-12);
    let cube: f64 = CubeFace::ALL
        .iter()
        .map(|&face| total(&Frame::new(Projection::CubeFace(face), 33, 33).unwrap()))
        .sum();
    assert!((cube / whole - 1.0).abs() < 1e-12);
    let all_sky = Frame::new(Projection::AngularFisheye(Fisheye::ALL_SKY), 512, 512).unwrap();
    assert!((total(&all_sky) / (2.0 * PI) - 1.0).abs() < 1e-3);
    // A field of view of 90 degrees in both directions is a face of the cube.
    let camera = Camera {
        azimuth_deg: 3.0,
        elevation_deg: 20.0,
        roll_deg: 5.0,
        vertical_fov_deg: 90.0,
    };
    let view = Frame::new(Projection::Perspective(camera), 60, 60).unwrap();
    assert!((total(&view) / (whole / 6.0) - 1.0).abs() < 1e-12);
}

#[test]
fn fisheye_pixels_have_the_solid_angle_of_their_corners() {
    // Against a sum over a fine grid within the pixel, by the areas of small parallelograms.
    let frame = Frame::new(
        Projection::AngularFisheye(Fisheye {
            azimuth_deg: 0.0,
            elevation_deg: 45.0,
            field_of_view_deg: 300.0,
        }),
        64,
        64,
    )
    .unwrap();
    for (i, j) in [(32, 32), (10, 40), (3, 32), (20, 20)] {
        let n = 40;
        let at = |a: f64, b: f64| frame.direction(f64::from(i) + a, f64::from(j) + b).unwrap();
        let mut sum = 0.0;
        for a in 0..n {
            for b in 0..n {
                let (x, y) = (f64::from(a) / f64::from(n), f64::from(b) / f64::from(n));
                let step = 1.0 / f64::from(n);
                let (p, q) = (
                    at(x + step, y + step) - at(x, y),
                    at(x, y + step) - at(x + step, y),
                );
                sum += p.cross(q).length() / 2.0;
            }
        }
        let got = frame.pixel_solid_angle(i, j);
        assert!((got / sum - 1.0).abs() < 1e-5, "{got} against {sum}");
    }
}

#[test]
fn invalid_projections_are_refused_with_a_reason() {
    let camera = |vertical_fov_deg| {
        Projection::Perspective(Camera {
            azimuth_deg: 0.0,
            elevation_deg: 0.0,
            roll_deg: 0.0,
            vertical_fov_deg,
        })
    };
    for (projection, width, height, words) in [
        (camera(60.0), 0, 10, "0 x 10"),
        (camera(60.0), 10, 65_537, "65537"),
        (camera(180.0), 10, 10, "180"),
        (camera(f64::NAN), 10, 10, "NaN"),
        (Projection::CubeFace(CubeFace::PositiveX), 10, 11, "10 x 11"),
        (
            Projection::Equirectangular {
                center_azimuth_deg: f64::INFINITY,
            },
            10,
            10,
            "azimuth",
        ),
        (
            Projection::AngularFisheye(Fisheye {
                field_of_view_deg: 361.0,
                ..Fisheye::ALL_SKY
            }),
            10,
            10,
            "361",
        ),
        (
            Projection::AngularFisheye(Fisheye {
                elevation_deg: 91.0,
                ..Fisheye::ALL_SKY
            }),
            10,
            10,
            "elevation",
        ),
    ] {
        let error = Frame::new(projection, width, height)
            .unwrap_err()
            .to_string();
        assert!(error.contains(words), "`{error}` does not say `{words}`");
    }
    for frame in frames() {
        assert!(frame.direction(f64::NAN, 1.0).is_none());
        assert!(frame.direction(-1.0, 1.0).is_none());
        assert!(frame.pixel_of(DVec3::ZERO).is_none());
        assert!(frame.pixel_of(DVec3::splat(f64::NAN)).is_none());
        assert_eq!(frame.pixel_solid_angle(9999, 0), 0.0);
    }
}

#[test]
fn a_preview_shows_the_same_view() {
    for frame in frames() {
        for side in [0, 1, 7, 20, 10_000] {
            let small = frame.preview(side);
            let size = small.size();
            assert!(size.width().max(size.height()) <= side.max(1));
            assert!(size.width() <= frame.size().width());
            let middle = |f: &Frame| {
                let (w, h) = (f64::from(f.size().width()), f64::from(f.size().height()));
                f.direction(w / 2.0, h / 2.0).unwrap()
            };
            assert!(middle(&small).distance(middle(&frame)) < 1e-9);
        }
    }
}

#[test]
fn cube_faces_are_named() {
    for &face in CubeFace::ALL {
        assert_eq!(face.to_string().parse(), Ok(face));
    }
    let error = "pw".parse::<CubeFace>().unwrap_err().to_string();
    assert!(
        error.starts_with("expected a cube face (px, nx, py, ny, pz, nz), got \"pw\"; try"),
        "{error}"
    );
}
