use super::*;

fn light(axis: DVec3, inner_deg: f64, outer_deg: f64) -> SpotLight<1> {
    SpotLight::new(
        DVec3::new(1.0, 2.0, 3.0),
        axis,
        Spectrum([1.0]),
        inner_deg.to_radians(),
        outer_deg.to_radians(),
        1e-3,
    )
    .expect("a lamp")
}

#[test]
fn a_line_is_in_the_cone_where_its_points_are() {
    let directions = [
        DVec3::X,
        DVec3::NEG_X,
        DVec3::new(0.0, -1.0, 1e-9),
        DVec3::new(0.3, -0.8, 0.1),
        DVec3::new(-0.3, 0.2, 0.9),
        DVec3::new(0.5, 0.5, -0.5),
    ];
    let mut inside = 0;
    for axis in directions {
        for outer in [1.0, 20.0, 60.0, 89.0, 90.0] {
            let light = light(axis, 0.5 * outer, outer);
            for offset in [
                DVec3::new(0.0, 0.0, 0.01),
                DVec3::new(0.2, 0.1, 0.0),
                DVec3::new(-3.0, 0.0, 1.0),
                DVec3::new(1.0, -7.0, 2.0),
                DVec3::new(0.0, 40.0, 0.0),
            ] {
                for direction in directions.map(DVec3::normalize) {
                    let eye = light.position + offset;
                    let geometry =
                        LightRayGeometry::new(eye, direction, 100.0, light.position, 1e-3);
                    let beam = Beam::new(&light, &geometry, eye, direction);
                    let [lit, full] = beam.lit(&geometry);
                    if geometry.nearest_m == light.radius_m {
                        // Straight through the lamp: a step there is a smooth one.
                        continue;
                    }
                    for step in -400..400 {
                        let t = 0.25 * f64::from(step) + 0.013;
                        let off = (eye + t * direction - light.position).normalize();
                        let cos = off.dot(light.axis);
                        for ((first, last), edge) in [(lit, outer), (full, 0.5 * outer)] {
                            let edge = edge.to_radians().cos();
                            if (cos - edge).abs() < 1e-9 {
                                continue;
                            }
                            let got = t > first && t < last;
                            assert_eq!(got, cos > edge, "{light:?} {eye} {direction} {t}");
                            inside += usize::from(got);
                        }
                        let u = t + geometry.start_m;
                        let r = geometry.distance_m(t);
                        assert!((beam.falloff(u, r) - light.falloff(off)).abs() < 1e-6);
                    }
                }
            }
        }
    }
    assert!(inside > 10_000, "{inside}");
}

#[test]
fn a_line_through_the_lamp_is_lit_on_the_side_it_shines_to() {
    let light = light(DVec3::X, 10.0, 30.0);
    let eye = light.position - 5.0 * DVec3::X;
    let geometry = LightRayGeometry::new(eye, DVec3::X, 50.0, light.position, light.radius_m);
    let [(first, last), _] = Beam::new(&light, &geometry, eye, DVec3::X).lit(&geometry);
    assert!((first - 5.0).abs() < 2.0 * light.radius_m && last.is_infinite());
    let geometry = LightRayGeometry::new(eye, DVec3::Y, 50.0, light.position, light.radius_m);
    let [(first, last), _] = Beam::new(&light, &geometry, eye, DVec3::Y).lit(&geometry);
    assert!(first > last);
}

#[test]
fn the_falloff_is_the_one_of_the_extension() {
    let light = light(DVec3::X, 20.0, 40.0);
    let at = |degrees: f64| {
        let (sin, cos) = degrees.to_radians().sin_cos();
        light.falloff(DVec3::new(cos, sin, 0.0))
    };
    assert_eq!(at(0.0), 1.0);
    assert_eq!(at(19.9), 1.0);
    assert_eq!(at(40.1), 0.0);
    assert_eq!(at(180.0), 0.0);
    let (c, i, o) = (30f64, 20f64, 40f64);
    let [c, i, o] = [c, i, o].map(|a| a.to_radians().cos());
    assert!((at(30.0) - ((c - o) / (i - o)).powi(2)).abs() < 1e-12);
}

#[test]
fn bad_numbers_are_refused() {
    let make = |axis, inner, outer| {
        SpotLight::new(DVec3::ZERO, axis, Spectrum([1.0f32]), inner, outer, 0.1)
    };
    assert!(make(DVec3::Y * 7.0, 0.0, 1.0).is_ok_and(|light| light.axis == DVec3::Y));
    assert!(make(DVec3::ZERO, 0.0, 1.0).is_err());
    assert!(make(DVec3::Y, 0.5, 0.4).is_err());
    assert!(make(DVec3::Y, -0.1, 0.4).is_err());
    assert!(make(DVec3::Y, 0.1, 1.6).is_err());
    assert!(make(DVec3::Y, 0.0, 0.0).is_err());
    assert!(make(DVec3::Y, 0.4, 0.4).is_ok());
    let error = make(DVec3::Y, f64::NAN, 0.4).expect_err("no angle");
    assert!(error.to_string().contains("inner angle"), "{error}");
}
