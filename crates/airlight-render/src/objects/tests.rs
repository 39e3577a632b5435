use super::shape::Shape;
use super::surface::{Checker, Gloss, Surface, fresnel};
use super::{Hit, Object, Objects, Ray, shadow_start};
use airlight::axes;
use airlight::spectrum::SpectralCurve;
use glam::DVec3;
use std::f64::consts::PI;

fn shapes() -> [Shape; 5] {
    let frustum = |top_radius_m| Shape::Frustum {
        base: DVec3::new(1.0, 0.5, -10.0),
        radius_m: 2.0,
        top_radius_m,
        height_m: 3.0,
    };
    [
        Shape::Sphere {
            centre: DVec3::new(0.5, 2.0, -9.0),
            radius_m: 1.5,
        },
        Shape::Block {
            base: DVec3::new(0.0, 0.5, -10.0),
            half_m: DVec3::new(1.0, 3.0, 2.0),
            turn: 0.6f64.sin_cos(),
        },
        frustum(2.0),
        frustum(0.0),
        frustum(3.0),
    ]
}

/// Whether a point lies inside a shape, by its implicit form.
fn inside(shape: &Shape, p: DVec3) -> bool {
    match *shape {
        Shape::Ground { height_m } => p.y < height_m,
        Shape::Sphere { centre, radius_m } => p.distance(centre) < radius_m,
        Shape::Block {
            base,
            half_m,
            turn: (sin, cos),
        } => {
            let q = p - base;
            let (x, z) = (cos * q.x + sin * q.z, cos * q.z - sin * q.x);
            x.abs() < half_m.x && z.abs() < half_m.z && (0.0..half_m.y).contains(&q.y)
        }
        Shape::Frustum {
            base,
            radius_m,
            top_radius_m,
            height_m,
        } => {
            let q = p - base;
            let radius = radius_m + (top_radius_m - radius_m) * q.y / height_m;
            (0.0..height_m).contains(&q.y) && q.x.hypot(q.z) < radius
        }
    }
}

/// Rays from all sides, some along the axes.
fn rays() -> impl Iterator<Item = Ray> {
    let slanted = (0..4000).map(|i| {
        let i = f64::from(i);
        let at = DVec3::new(
            4.0 * (0.7 * i).sin(),
            2.0 + 3.0 * (1.3 * i).sin(),
            -10.0 + 4.0 * (2.1 * i).cos(),
        );
        let direction = axes::direction(137.5 * i, 80.0 * (0.37 * i).sin());
        Ray {
            origin: at - 12.0 * direction,
            direction,
        }
    });
    let straight = [DVec3::X, DVec3::Y, DVec3::Z].into_iter().flat_map(|axis| {
        [axis, -axis].map(|direction| Ray {
            origin: DVec3::new(0.3, 1.7, -9.6) - 20.0 * direction,
            direction,
        })
    });
    slanted.chain(straight)
}

#[test]
fn intersections_match_marching() {
    for shape in shapes() {
        let mut met = 0;
        let (middle, radius_m) = shape.bounding_sphere();
        for ray in rays() {
            let steps = (1..6000).map(|i| 0.005 * f64::from(i));
            let marched = steps.clone().find(|t| inside(&shape, ray.at(*t)));
            match (shape.meet(&ray), marched) {
                (Some(hit), Some(t)) => {
                    met += 1;
                    assert!(
                        (hit.distance_m - t).abs() < 0.006,
                        "{shape:?} {ray:?}: {hit:?} {t}"
                    );
                    let n = hit.normal;
                    assert!(
                        (n.length() - 1.0).abs() < 1e-9 && n.dot(ray.direction) <= 1e-9,
                        "{n}"
                    );
                    // The normal points outwards.
                    let p = ray.at(hit.distance_m);
                    assert!(p.distance(middle) < radius_m + 1e-9, "{shape:?} {p}");
                    assert!(!inside(&shape, p + 1e-4 * n), "{shape:?} {p} {n}");
                }
                (None, None) => {}
                // Corners thinner than a step.
                (Some(hit), None) => {
                    let through = (0..100)
                        .filter(|i| inside(&shape, ray.at(hit.distance_m + 1e-4 * f64::from(*i))));
                    assert!(through.count() < 60, "{shape:?} {ray:?} {hit:?}");
                }
                (None, Some(t)) => panic!("{shape:?} {ray:?} missed what lies at {t}"),
            }
        }
        assert!(met > 200, "{shape:?}: {met}");
    }
}

#[test]
fn rays_from_inside_hit_the_far_side() {
    for shape in shapes() {
        let origin = DVec3::new(0.5, 1.8, -9.6);
        assert!(inside(&shape, origin), "{shape:?}");
        for direction in [DVec3::X, -DVec3::Z, axes::direction(40.0, 60.0)] {
            let hit = shape.meet(&Ray { origin, direction }).unwrap();
            assert!(
                hit.normal.dot(direction) > 0.0 && hit.distance_m < 5.0,
                "{shape:?} {hit:?}"
            );
        }
    }
}

#[test]
fn the_nearest_object_is_hit_and_casts_a_shadow() {
    let text = "[[object]]\nshape = \"ground\"\n\n[[object]]\nshape = \"sphere\"\nat_m = [0, 1, -10]\nradius_m = 1\n";
    let objects = Objects::from_toml(text).unwrap();
    let look = |azimuth, elevation| Ray {
        origin: DVec3::new(0.0, 1.0, 0.0),
        direction: axes::direction(azimuth, elevation),
    };
    let front = objects.hit(&look(0.0, 0.0)).unwrap();
    assert!((front.distance_m - 9.0).abs() < 1e-12 && front.index == 1);
    let ground = objects.hit(&look(180.0, -45.0)).unwrap();
    assert!((ground.normal - DVec3::Y).length() < 1e-12 && ground.index == 0);
    assert!(objects.hit(&look(90.0, 10.0)).is_none());
    // The ground below the sphere is in shadow, its front is not; points do not shadow themselves.
    let under = objects
        .hit(&Ray {
            origin: DVec3::new(0.0, 0.5, -8.0),
            direction: axes::direction(0.0, -20.0),
        })
        .unwrap();
    assert!(objects.shadowed(&under, DVec3::Y) && !objects.shadowed(&front, DVec3::Z));
    for i in 0..100 {
        let hit = objects.hit(&look(0.05 * f64::from(i) - 2.5, 0.0)).unwrap();
        assert!(!objects.shadowed(&hit, hit.normal));
    }
    assert_eq!(objects.top_m(), 2.0);
}

/// Numbers from 0 to 1.
struct Random(u64);

impl Random {
    fn uniform(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as f64 / (1u64 << 31) as f64
    }
}

/// Ground and `count` small shapes in all directions from the origin, at 0.5 m to 1 km.
fn scattered(count: usize) -> Vec<Object> {
    let surface = Surface {
        reflectance: SpectralCurve::Constant(0.5),
        checker: None,
        gloss: None,
    };
    let mut random = Random(17);
    let mut shapes = vec![Shape::Ground { height_m: -30.0 }];
    shapes.resize_with(count + 1, || {
        let distance_m = 0.5 * 2000f64.powf(random.uniform());
        let up = 60.0 * random.uniform() - 30.0;
        let base = distance_m * axes::direction(360.0 * random.uniform(), up);
        let radius_m = 0.2 * distance_m * random.uniform();
        match random.uniform() {
            kind if kind < 0.3 => Shape::Sphere {
                centre: base,
                radius_m,
            },
            kind if kind < 0.6 => Shape::Block {
                base,
                half_m: DVec3::new(radius_m, 3.0 * random.uniform(), 0.2 * radius_m),
                turn: (6.0 * kind).sin_cos(),
            },
            kind => Shape::Frustum {
                base,
                radius_m,
                top_radius_m: (kind - 0.6) * radius_m,
                height_m: 1.0 + 4.0 * radius_m * random.uniform(),
            },
        }
    });
    let object = |shape| Object {
        shape,
        surface: surface.clone(),
    };
    shapes.into_iter().map(object).collect()
}

#[test]
fn beams_find_what_single_shapes_meet() {
    let source = axes::direction(70.0, 25.0);
    let (mut met, mut in_shadow) = (0, 0);
    for count in [0, 1, 2, 3, 300] {
        let objects = Objects::new(scattered(count));
        let first = |ray: &Ray| {
            let hits = objects
                .all()
                .iter()
                .enumerate()
                .filter_map(|(index, object)| Some((index, object.shape.meet(ray)?.distance_m)));
            hits.min_by(|a, b| a.1.total_cmp(&b.1).then(a.0.cmp(&b.0)))
        };
        let mut random = Random(3);
        let mut candidates = Vec::new();
        // From rays beside each other to rays in all directions.
        for spread in [0.0, 1e-9, 1e-4, 0.02, 0.3, 1.5, 3.0] {
            for _ in 0..60 {
                let toward =
                    axes::direction(360.0 * random.uniform(), 80.0 * random.uniform() - 40.0);
                let origin = 2.0 * DVec3::Y * random.uniform();
                let directions: Vec<DVec3> = (0..16)
                    .map(|_| {
                        let mut aside = || spread * (random.uniform() - 0.5);
                        (toward + DVec3::new(aside(), aside(), aside())).normalize()
                    })
                    .collect();
                objects.candidates(origin, &directions, &mut candidates);
                let hits: Vec<Hit<'_>> = directions
                    .iter()
                    .filter_map(|&direction| {
                        let ray = Ray { origin, direction };
                        let among = objects.hit_among(&candidates, &ray);
                        let got = among.map(|hit| (hit.index, hit.distance_m));
                        assert_eq!(got, first(&ray), "{count} {spread} {ray:?}");
                        let alone = objects.hit(&ray).map(|hit| (hit.index, hit.distance_m));
                        assert_eq!(alone, got, "{count} {spread} {ray:?}");
                        among
                    })
                    .collect();
                objects.shadow_candidates(hits.iter(), source, &mut candidates);
                for hit in &hits {
                    let ray = Ray {
                        origin: shadow_start(hit),
                        direction: source,
                    };
                    let dark = first(&ray).is_some();
                    assert_eq!(objects.shadowed_by(&candidates, hit, source), dark);
                    assert_eq!(objects.shadowed(hit, source), dark);
                    in_shadow += usize::from(dark);
                }
                met += hits.len();
            }
        }
    }
    assert!(met > 10_000 && in_shadow > 1_000, "{met} {in_shadow}");
}

#[test]
fn beams_reach_few_of_many_objects() {
    let objects = Objects::new(scattered(5000));
    let direction = axes::direction(10.0, 3.0);
    let beside = (direction + 1e-3 * DVec3::Y).normalize();
    let mut candidates = Vec::new();
    objects.candidates(DVec3::ZERO, &[direction, beside], &mut candidates);
    assert!(candidates.len() < 200, "{}", candidates.len());
}

#[test]
fn errors_of_a_file_name_the_value() {
    for (text, said) in [
        ("", "expected an object"),
        ("[[object]]\nshape = \"cube\"", "try \"cone\""),
        ("[[object]]\nshape = \"sphere\"\nradius = 2", "radius_m"),
        (
            "[[object]]\nshape = \"sphere\"",
            "object 1 (sphere): radius_m: expected a number above 0",
        ),
        ("[[object]]\nshape = \"sphere\"\nradius_m = nan", "radius_m"),
        (
            "[[object]]\nshape = \"ground\"\nradius_m = 2",
            "radius_m: expected no value",
        ),
        (
            "[[object]]\nshape = \"ground\"\nreflectance = 1.5",
            "reflectance: expected numbers from 0 to 1",
        ),
        (
            "[[object]]\nshape = \"ground\"\nreflectance = { wavelengths_nm = [500, 400], values = [0, 1] }",
            "reflectance",
        ),
        (
            "[[object]]\nshape = \"cone\"\nradius_m = 1\nheight_m = -2",
            "height_m",
        ),
        (
            "[[object]]\nshape = \"block\"\nsize_m = [1, 0, 1]",
            "size_m",
        ),
        ("[[object]]\nshape = \"ground\"\nat_m = [0, inf, 0]", "at_m"),
        (
            "[[object]]\nshape = \"ground\"\ngloss = { roughness = 0 }",
            "gloss.roughness",
        ),
        (
            "[[object]]\nshape = \"ground\"\nchecker = { size_m = 0, reflectance = 0.1 }",
            "checker.size_m",
        ),
        (
            "[[object]]\nshape = \"sphere\"\nradius_m = 1\nrepeat = { count = 20000, step_m = [1, 0, 0] }",
            "repeat.count",
        ),
    ] {
        let error = Objects::from_toml(text).unwrap_err().to_string();
        assert!(error.contains(said), "{text}: {error}");
    }
}

fn surface(gloss: Option<Gloss>) -> Surface {
    Surface {
        reflectance: SpectralCurve::Constant(0.5),
        checker: None,
        gloss,
    }
}

#[test]
fn checkers_are_sharp_nearby_and_grey_far_away() {
    let tiles = Surface {
        checker: Some(Checker {
            size_m: 2.0,
            reflectance: SpectralCurve::Constant(0.0),
        }),
        ..surface(None)
    };
    let share = |x, z, footprint| {
        let point = DVec3::new(x, -1e-3, z);
        tiles.checker_share(point, DVec3::new(footprint, 1e-9, footprint))
    };
    assert_eq!(
        [share(1.0, 1.0, 1e-3), share(3.0, 1.0, 1e-3)]
            .map(|s| (s * 1e4).round() / 1e4)
            .iter()
            .sum::<f32>(),
        1.0
    );
    assert_eq!(share(1.0, 1.0, 1e-3), share(3.0, 3.0, 1e-3));
    assert!((share(0.3, 17.0, 200.0) - 0.5).abs() < 0.02);
    for i in 0..1000 {
        let share = share(
            0.37 * f64::from(i),
            0.11 * f64::from(i),
            0.01 * f64::from(i),
        );
        assert!((-1e-5..=1.00001).contains(&share), "{share}");
    }
}

#[test]
fn surfaces_do_not_amplify_uniform_light() {
    // White furnace: in uniform light no surface reflects more than arrives, and a black matt one reflects nothing.
    for gloss in [
        None,
        Some(Gloss {
            roughness: 0.2,
            index: 1.5,
        }),
    ] {
        for elevation_deg in [90.0, 40.0, 10.0, 1.0] {
            let to_eye = axes::direction(0.0, elevation_deg);
            let shading = surface(gloss).shading(DVec3::Y, to_eye, DVec3::Y);
            // Radiance 1 from all directions: an irradiance of pi.
            let at = |reflectance: f32| reflectance * shading.ambient + shading.mirrored;
            assert!(
                at(1.0) <= 1.0 + 1e-6 && at(1.0) > 0.8,
                "{gloss:?} {elevation_deg}: {}",
                at(1.0)
            );
            assert!(at(0.0) >= 0.0);
        }
    }
}

#[test]
fn facets_conserve_energy_and_are_reciprocal() {
    for roughness in [0.1, 0.3, 0.6] {
        let gloss = Gloss {
            roughness,
            index: 1.5,
        };
        // The projected area of all facets is that of the surface: int D (n.h) = 1.
        let mut facets = 0.0;
        let mut sent = 0.0;
        let sun = axes::direction(0.0, 50.0);
        let (n, m) = (600, 400);
        for i in 0..n {
            // Equal solid angles.
            let up = (f64::from(i) + 0.5) / f64::from(n);
            for j in 0..m {
                let azimuth = 360.0 * (f64::from(j) + 0.5) / f64::from(m);
                let direction = axes::direction(azimuth, up.asin().to_degrees());
                let weight = 2.0 * PI / f64::from(n * m);
                // Retroreflection, v = l = h, gives F D G / (4 v), and so D.
                let d = 4.0 * up * gloss.mirrored_sun(DVec3::Y, direction, direction)
                    / fresnel(1.0, 1.5)
                    / (2.0 * up * up).min(1.0);
                facets += weight * up * d;
                sent += weight * up * gloss.mirrored_sun(DVec3::Y, direction, sun);
            }
        }
        assert!((facets - 1.0).abs() < 0.01, "{roughness}: {facets}");
        assert!(sent > 0.0 && sent < sun.y, "{roughness}: {sent}");
        let (a, b) = (axes::direction(20.0, 30.0), axes::direction(190.0, 50.0));
        let there = gloss.mirrored_sun(DVec3::Y, a, b) / b.y;
        let back = gloss.mirrored_sun(DVec3::Y, b, a) / a.y;
        assert!((there / back - 1.0).abs() < 1e-12, "{there} {back}");
    }
    assert!((fresnel(1.0, 1.5) - 0.04).abs() < 1e-12 && (fresnel(0.0, 1.5) - 1.0).abs() < 1e-12);
}

#[test]
fn objects_repeat_at_equal_steps() {
    let text = "[[object]]\nshape = \"cylinder\"\nat_m = [1, 0, -5]\nradius_m = 0.2\nheight_m = 4\n\
        repeat = { count = 3, step_m = [0, 0, -10] }\n";
    let objects = Objects::from_toml(text).unwrap();
    let places: Vec<f64> = objects
        .all()
        .iter()
        .map(|Object { shape, .. }| match shape {
            Shape::Frustum { base, .. } => base.z,
            other => panic!("{other:?}"),
        })
        .collect();
    assert_eq!(places, [-5.0, -15.0, -25.0]);
}
