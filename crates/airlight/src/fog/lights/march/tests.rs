use super::super::reference;
use super::super::{LightSettings, PointLight, SphereLight, SpotLight};
use super::*;
use crate::atmosphere::droplets::phase;

const EARTH_M: f64 = 6.371e6;

/// A layer of one lane with a single-scattering albedo of 0.9.
fn layer(density: DensityProfile, extinction: f32, phase: PhaseFunction) -> LayerLanes<1> {
    let extinction = Spectrum([extinction]);
    LayerLanes {
        density,
        extinction_per_m: extinction,
        scattering_per_m: extinction * 0.9,
        phase,
        wavelengths_nm: [550.0],
    }
}

fn alone(layer: LayerLanes<1>, ground_radius_m: f64) -> ScatteringLayer<1> {
    ScatteringLayer::new(layer, &[], ground_radius_m).expect("some fog")
}

fn hg(g: f64) -> PhaseFunction {
    PhaseFunction::henyey_greenstein(g).expect("a phase function")
}

fn point(position: DVec3) -> Light<Spectrum<1>> {
    Light::Point(PointLight::new(position, Spectrum([1.0]), 1e-3).expect("a light"))
}

/// Path radiance by quadrature.
fn march(
    light: &Light<Spectrum<1>>,
    fog: &ScatteringLayer<1>,
    view_ray: &ViewRay,
    nodes: usize,
) -> f64 {
    f64::from(LitRay::new(light, fog, view_ray).path_radiance(&Nodes::new(nodes))[0])
}

/// Largest relative error of the quadrature in uniform fog, over many rays, and the ray.
fn worst_in_uniform_fog(phase: &PhaseFunction, nodes: usize) -> (f64, String) {
    let mut worst = (0.0, String::new());
    for nearest in [0.002, 0.1, 1.0, 12.0, 300.0, 1e4] {
        for start in [-1e4, -300.0, -20.0, -1.0, 0.0, 0.5, 40.0, 3e3] {
            for length in [0.1, 10.0, 35.0, 1e3, f64::INFINITY] {
                for extinction in [1e-5f32, 1e-3, 0.03, 0.3, 3.0] {
                    let fog = alone(
                        layer(DensityProfile::Uniform, extinction, phase.clone()),
                        f64::INFINITY,
                    );
                    let light = point(DVec3::new(nearest, 0.0, 0.0));
                    let view_ray = ViewRay {
                        eye: DVec3::new(0.0, 0.0, start),
                        direction: DVec3::Z,
                        length_m: length,
                    };
                    let depth = f64::from(extinction) * nearest.hypot(start);
                    if depth > 60.0 {
                        continue;
                    }
                    let exact = reference::path_radiance(&light, &fog, &view_ray);
                    let off = (march(&light, &fog, &view_ray, nodes) / exact - 1.0).abs();
                    if off > worst.0 {
                        worst = (
                            off,
                            format!(
                                "nearest {nearest}, start {start}, length {length}, {extinction}/m"
                            ),
                        );
                    }
                }
            }
        }
    }
    worst
}

#[test]
fn errors_in_uniform_fog() {
    for (g, limit) in [
        (0.0, 1e-5),
        (0.5, 1e-5),
        (0.9, 1e-5),
        (0.95, 1e-5),
        (-0.5, 2e-5),
    ] {
        let (off, place) = worst_in_uniform_fog(&hg(g), 12);
        assert!(off < limit, "g {g}: {off:e} at {place}");
    }
}

/// A number of nodes, bold if it is the default.
fn row_of(nodes: usize) -> String {
    match nodes == LightSettings::default().nodes {
        true => format!("| **{nodes}** |"),
        false => format!("| {nodes} |"),
    }
}

/// Prints a table of the book (`--nocapture`).
#[test]
#[ignore = "takes half a minute"]
fn errors_in_uniform_fog_fall_with_the_nodes() {
    println!("\n| nodes | g = 0 | 0.5 | 0.8 | 0.9 | 0.95 | -0.3 | -0.7 |");
    println!("|---|---|---|---|---|---|---|---|");
    // Errors converge exponentially to the rounding of f32, more slowly for light scattered back.
    for (nodes, forward, backward) in [
        (4, 0.2, 0.2),
        (6, 1e-2, 2e-2),
        (8, 1e-3, 3e-3),
        (10, 1e-4, 5e-4),
        (12, 1e-5, 1e-4),
        (16, 2e-6, 1e-5),
        (24, 1e-6, 1e-6),
    ] {
        let mut row = row_of(nodes);
        for g in [0.0, 0.5, 0.8, 0.9, 0.95, -0.3, -0.7] {
            let (off, place) = worst_in_uniform_fog(&hg(g), nodes);
            let limit = if g < 0.0 { backward } else { forward };
            assert!(off < limit, "{nodes} nodes, g {g}: {off:e} at {place}");
            row += &format!(" {off:.1e} |");
        }
        println!("{row}");
    }
}

/// Visits many lights and rays in fog whose density decreases with height.
fn in_thinning_fog(visit: &mut dyn FnMut(&ScatteringLayer<1>, &Light<Spectrum<1>>, &ViewRay)) {
    let profiles = |scale_height_m| {
        [
            DensityProfile::Exponential {
                reference_height_m: 0.0,
                scale_height_m,
            },
            DensityProfile::Clamped {
                base_height_m: 6.0,
                scale_height_m,
            },
            DensityProfile::slab(2.0 * scale_height_m),
        ]
    };
    let lights = [
        DVec3::new(0.3, 5.0, -30.0),
        DVec3::new(-8.0, 25.0, -60.0),
        DVec3::new(400.0, 3.0, -900.0),
        DVec3::new(0.0, 300.0, 5.0),
    ];
    for ground_radius_m in [f64::INFINITY, EARTH_M] {
        for profile in [3.0, 40.0, 1200.0].into_iter().flat_map(profiles) {
            for extinction in [1e-3f32, 0.02, 0.5] {
                for g in [0.0, 0.8] {
                    let fog = alone(layer(profile.clone(), extinction, hg(g)), ground_radius_m);
                    for light in lights.map(point) {
                        for (height, sin_elevation, length_m) in [
                            (1.7, 0.0, 50.0),
                            (1.7, 0.0, f64::INFINITY),
                            (1.7, 0.1, f64::INFINITY),
                            (1.7, 0.9, f64::INFINITY),
                            (1.7, 0.03, 2000.0),
                            (90.0, -0.4, 220.0),
                            (90.0, -0.05, 1799.0),
                            (1500.0, -0.9, 1665.0),
                            (1500.0, -1e-3, 1e5),
                        ] {
                            let level = f64::sqrt(1.0 - sin_elevation * sin_elevation);
                            let view_ray = ViewRay {
                                eye: DVec3::new(0.0, height, 0.0),
                                direction: DVec3::new(0.05 * level, sin_elevation, -level)
                                    .normalize(),
                                length_m,
                            };
                            visit(&fog, &light, &view_ray);
                        }
                    }
                }
            }
        }
    }
}

/// Sorted relative errors over every `stride`-th of these rays, except for light attenuated by e^-30 or more.
fn errors_in_thinning_fog(nodes: usize, stride: usize) -> Vec<(f64, String)> {
    let mut all = Vec::new();
    let mut count = 0;
    in_thinning_fog(&mut |fog, light, view_ray| {
        count += 1;
        if count % stride != 0 {
            return;
        }
        let exact = reference::path_radiance(light, fog, view_ray);
        let near = (light.position() - view_ray.eye).length();
        if exact > 1e-13 * f64::from(fog.layer.extinction_per_m[0]) / near {
            let off = (march(light, fog, view_ray, nodes) / exact - 1.0).abs();
            all.push((off, format!("{fog:?} {light:?} {view_ray:?}")));
        }
    });
    all.sort_by(|a, b| a.0.total_cmp(&b.0));
    all
}

/// Error below which a share of the rays lies.
fn below(errors: &[(f64, String)], share: f64) -> f64 {
    errors[((errors.len() - 1) as f64 * share) as usize].0
}

#[test]
fn errors_in_decreasing_density() {
    let errors = errors_in_thinning_fog(12, 11);
    assert!(errors.len() > 200);
    let (worst, place) = errors.last().expect("errors");
    assert!(below(&errors, 0.5) < 3e-7);
    assert!(below(&errors, 0.9) < 1e-6, "{:e}", below(&errors, 0.9));
    assert!(below(&errors, 0.98) < 1e-4, "{:e}", below(&errors, 0.98));
    assert!(*worst < 0.01, "{worst:e} at {place}");
}

/// Prints a table of the book (`--nocapture`).
#[test]
#[ignore = "takes a minute"]
fn errors_in_decreasing_density_fall_with_the_nodes() {
    println!(
        "\n| nodes a panel | median | 90 % below | 99 % below | worst |\n|---|---|---|---|---|"
    );
    let mut rays = 0;
    for (nodes, limits) in [
        (6, [2e-6, 2e-4, 0.03, 0.2]),
        (8, [3e-7, 1e-5, 3e-3, 0.2]),
        (12, [3e-7, 1e-6, 1e-4, 1e-2]),
        (16, [3e-7, 1e-6, 5e-6, 1e-3]),
        (24, [3e-7, 1e-6, 1e-6, 1e-5]),
    ] {
        let errors = errors_in_thinning_fog(nodes, 1);
        let (worst, place) = errors.last().expect("errors");
        let [half, most, nearly] = [0.5, 0.9, 0.99].map(|share| below(&errors, share));
        for (error, limit) in [half, most, nearly, *worst].into_iter().zip(limits) {
            assert!(
                error < limit,
                "{nodes} nodes: {error:e}; worst {worst:e} at {place}"
            );
        }
        println!(
            "{} {half:.1e} | {most:.1e} | {nearly:.1e} | {worst:.1e} |",
            row_of(nodes)
        );
        rays = errors.len();
    }
    println!("{rays} rays");
}

#[test]
fn spots_and_spheres_match_quadrature() {
    let profiles = [
        DensityProfile::Uniform,
        DensityProfile::Clamped {
            base_height_m: 2.0,
            scale_height_m: 3.0,
        },
    ];
    let position = DVec3::new(0.4, 6.0, -20.0);
    let one = Spectrum([1.0]);
    let mut lights = Vec::new();
    for axis in [DVec3::NEG_Y, DVec3::new(0.2, -0.3, 0.9), DVec3::NEG_Z] {
        for (inner, outer) in [(0.0, 0.5), (0.3, 0.31), (0.4, 0.4), (0.7, 1.5)] {
            lights.push(Light::Spot(
                SpotLight::new(position, axis, one, inner, outer, 0.01).expect("a light"),
            ));
        }
    }
    for radius in [0.05, 0.5, 3.0] {
        lights.push(Light::Sphere(
            SphereLight::new(position, radius, one).expect("a light"),
        ));
    }
    let mut lit = 0;
    for profile in &profiles {
        for extinction in [1e-3, 0.1] {
            let fog = alone(layer(profile.clone(), extinction, hg(0.7)), f64::INFINITY);
            for light in &lights {
                for aim in [
                    DVec3::new(0.2, 2.0, -18.0),
                    DVec3::new(0.4, 5.0, -20.0),
                    DVec3::new(0.4, 5.9, -20.0),
                    DVec3::new(-5.0, 6.0, -30.0),
                    DVec3::new(3.0, 1.6, 10.0),
                ] {
                    for length_m in [15.0, 60.0, f64::INFINITY] {
                        let eye = DVec3::new(0.0, 1.6, 0.0);
                        let view_ray = ViewRay {
                            eye,
                            direction: (aim - eye).normalize(),
                            length_m,
                        };
                        let exact = reference::path_radiance(light, &fog, &view_ray);
                        let got = march(light, &fog, &view_ray, 12);
                        lit += usize::from(exact > 0.0);
                        // The scalar irradiance near a sphere has a square-root singularity at its surface.
                        let limit = match light {
                            Light::Sphere(_) => 2e-3,
                            _ => 1e-4,
                        };
                        assert!(
                            (got - exact).abs() <= limit * exact,
                            "{light:?} {fog:?} {view_ray:?}: {got:e} against {exact:e}"
                        );
                    }
                }
            }
        }
    }
    assert!(lit > 150, "{lit}");
}

#[test]
fn lanes_with_different_extinction_share_nodes() {
    for spread in [1.0f32, 4.0, 16.0, 64.0] {
        for (near, limit) in [(0.01, 2e-5), (1.0, 2e-5), (200.0, 2e-5)] {
            let extinction = Spectrum([0.02, 0.02 * spread.sqrt(), 0.02 * spread, 0.0]);
            let all = LayerLanes {
                density: DensityProfile::Uniform,
                extinction_per_m: extinction,
                scattering_per_m: extinction,
                phase: hg(0.8),
                wavelengths_nm: [450.0, 500.0, 550.0, 600.0],
            };
            let light = DVec3::new(near, 0.0, -20.0);
            let view_ray = ViewRay {
                eye: DVec3::ZERO,
                direction: DVec3::NEG_Z,
                length_m: 100.0,
            };
            let four = PointLight::new(light, Spectrum::<4>::ONE, 1e-3).expect("a light");
            let fog = ScatteringLayer::new(all, &[], f64::INFINITY).expect("fog");
            let got =
                LitRay::new(&Light::Point(four), &fog, &view_ray).path_radiance(&Nodes::new(12));
            assert_eq!(got[3], 0.0);
            for lane in 0..3 {
                let one = layer(DensityProfile::Uniform, extinction[lane], hg(0.8));
                let fog = alone(one, f64::INFINITY);
                let exact = reference::path_radiance(&point(light), &fog, &view_ray) / 0.9;
                if exact < 1e-30 {
                    continue;
                }
                let off = (f64::from(got[lane]) / exact - 1.0).abs();
                let limit = if spread > 20.0 { 2e-3 } else { limit };
                assert!(
                    off < limit,
                    "spread {spread}, lane {lane}, {near} m: {off:e}"
                );
            }
        }
    }
}

#[test]
fn errors_for_droplets() {
    for (diameter_um, limit) in [(5.0, 1e-3), (10.0, 1e-3), (20.0, 1.5e-3), (50.0, 2e-3)] {
        let (off, place) = worst_in_uniform_fog(&phase(diameter_um), 12);
        println!("{diameter_um} um: {off:.1e}");
        assert!(off < limit, "{diameter_um} um: {off:e} at {place}");
    }
}

/// Visits relative errors for all pairs of a scattering layer and another layer of very different heights.
fn among_other_layers(nodes: usize, visit: &mut dyn FnMut(f64, String)) {
    let profiles = [
        DensityProfile::Uniform,
        DensityProfile::slab(7.0),
        DensityProfile::Exponential {
            reference_height_m: 0.0,
            scale_height_m: 4.0,
        },
        DensityProfile::Clamped {
            base_height_m: 3.0,
            scale_height_m: 60.0,
        },
    ];
    for profile in &profiles {
        for other in &profiles {
            for [own, besides] in [[0.002, 0.05], [0.05, 0.05], [0.05, 0.002]] {
                let others = [layer(other.clone(), besides, hg(0.8))];
                let own_layer = layer(profile.clone(), own, hg(0.8));
                let fog = ScatteringLayer::new(own_layer, &others, f64::INFINITY).expect("fog");
                for light in [[0.3, 5.0, -30.0], [-8.0, 25.0, -60.0], [40.0, 3.0, 20.0]] {
                    for sin_elevation in [-0.02, 0.0, 0.1, 0.5] {
                        for length_m in [25.0, 60.0, f64::INFINITY] {
                            let eye_m = if sin_elevation < 0.0 { 12.0 } else { 1.6 };
                            let view_ray = ViewRay {
                                eye: DVec3::new(0.0, eye_m, 0.0),
                                direction: DVec3::new(0.05, sin_elevation, -1.0).normalize(),
                                length_m: if sin_elevation < 0.0 {
                                    length_m.min(500.0)
                                } else {
                                    length_m
                                },
                            };
                            let light = point(DVec3::from_array(light));
                            let exact = reference::path_radiance(&light, &fog, &view_ray);
                            let got = march(&light, &fog, &view_ray, nodes);
                            if exact > 1e-15 {
                                let off = (got / exact - 1.0).abs();
                                visit(
                                    off,
                                    format!(
                                        "{profile:?} {own} with {other:?} {besides}: {view_ray:?}"
                                    ),
                                );
                            }
                        }
                    }
                }
            }
        }
    }
}

#[test]
fn errors_with_other_layers() {
    let (mut count, mut worst) = (0, (0.0, String::new()));
    among_other_layers(12, &mut |off, place| {
        count += 1;
        if off > worst.0 {
            worst = (off, place);
        }
    });
    assert!(count > 1500, "{count}");
    assert!(worst.0 < 5e-6, "{:e} at {}", worst.0, worst.1);
}

#[test]
fn nodes_integrate_a_lorentzian() {
    let nodes = Nodes::new(12);
    for scale in [1e-6, 1.0, 1e5] {
        for end in [1e-9, 1e-3, 1.0, 1e4, 1e12, f64::INFINITY] {
            let mut sum = 0.0;
            nodes.visit(scale, end * scale, |s, ds| {
                sum += ds / (scale * (1.0 + (s / scale).powi(2)));
            });
            let exact = end.atan();
            assert!((sum / exact - 1.0).abs() < 1e-5, "{scale}, {end}: {sum}");
        }
    }
}

fn panels(profile: &DensityProfile, ray: RaySegment) -> Vec<(f64, f64)> {
    let mut all = Vec::new();
    let density = profile.at(ray.height_m);
    Cuts::of(&profile.structure(), density, &ray, 0.01).visit(|from, to| all.push((from, to)));
    all
}

#[test]
fn panels_lie_inside_a_slab() {
    let slab = DensityProfile::slab(10.0);
    let up = RaySegment::flat(2.0, 0.5, f64::INFINITY);
    assert_eq!(panels(&slab, up), [(0.0, 16.0)]);
    let above = RaySegment::flat(12.0, 0.5, f64::INFINITY);
    assert_eq!(panels(&slab, above), []);
}

#[test]
fn rays_are_split_at_heights_and_at_the_base() {
    let profile = DensityProfile::Clamped {
        base_height_m: 10.0,
        scale_height_m: 1.0,
    };
    let up = RaySegment::flat(0.0, 1.0, f64::INFINITY);
    assert_eq!(
        panels(&profile, up),
        [(0.0, 10.0), (10.0, 13.0), (13.0, 20.0), (20.0, 50.0)]
    );
    let level = RaySegment::flat(12.0, 0.0, f64::INFINITY);
    assert_eq!(panels(&profile, level), [(0.0, f64::INFINITY)]);
}

#[test]
fn descents_into_increasing_density_are_truncated() {
    let profile = DensityProfile::Exponential {
        reference_height_m: 0.0,
        scale_height_m: 10.0,
    };
    let down = RaySegment::flat(200.0, -0.7, f64::INFINITY);
    let all = panels(&profile, down);
    let end = all.last().unwrap().1;
    let depth = 0.01 * profile.column_along_m(&RaySegment::flat(200.0, -0.7, end));
    assert!((depth / MAX_DEPTH - 1.0).abs() < 1e-9, "{depth}");
    assert!(all.len() >= 3);
}

#[test]
fn the_lowest_height_of_a_ray_over_round_ground_is_at_its_dip() {
    let ray = RaySegment::new(100.0, -1e-3, 1e5, 6.371e6);
    let low = ray.lowest_height_m();
    assert!(low < 100.0 && low > 80.0);
    assert!(low <= ray.height_at(6371.0) + 1e-9);
}
