use super::*;
use crate::atmosphere::presets::{Preset, mars};
use crate::atmosphere::{
    AerosolType, Atmosphere, Constituent, ConstituentKind, DensityProfile, Interpolation,
};
use crate::math::quadrature::GaussRule;
use crate::names::Named;
use crate::optics::PhaseFunction;
use crate::spectrum::SpectralCurve;

/// An absorbing constituent with the extinction `per_m` at density 1.
fn absorber(density: DensityProfile, per_m: f64) -> Constituent {
    Constituent {
        kind: ConstituentKind::Other("absorber".into()),
        density,
        scattering_per_m: SpectralCurve::Constant(0.0),
        absorption_per_m: SpectralCurve::Constant(per_m),
        phase: PhaseFunction::Isotropic,
    }
}

/// The reference air of molecules with further constituents.
fn with(parts: impl IntoIterator<Item = Constituent>) -> Atmosphere {
    let mut air = Preset::ReferenceRayleigh.atmosphere();
    air.constituents.extend(parts);
    air
}

/// Air with kinks, jumps, thin layers and small scale heights.
fn extreme_airs() -> Vec<(String, Atmosphere)> {
    let layer = |bottom_m, top_m| DensityProfile::Layer { bottom_m, top_m };
    let mut airs = vec![
        (
            "absorber of 300 m".to_owned(),
            with([absorber(DensityProfile::exponential(300.0), 1e-3)]),
        ),
        (
            "absorber of 8 m".to_owned(),
            with([absorber(DensityProfile::exponential(8.0), 1e-2)]),
        ),
        (
            "layers".to_owned(),
            with([
                absorber(layer(2e3, 2.5e3), 4e-5),
                absorber(layer(30.0, 31.0), 1e-2),
                absorber(layer(11e3, 11.01e3), 1e-4),
            ]),
        ),
        (
            "layer just below the top".to_owned(),
            with([absorber(layer(98.99e3, 99e3), 1e-4)]),
        ),
        (
            "tents and a slab".to_owned(),
            with([
                absorber(
                    DensityProfile::Tent {
                        bottom_m: 1.2e3,
                        peak_m: 1.3e3,
                        top_m: 1.31e3,
                    },
                    1e-3,
                ),
                absorber(DensityProfile::slab(120.0), 1e-3),
            ]),
        ),
    ];
    for kind in [Interpolation::Linear, Interpolation::LogLinear] {
        let table = DensityProfile::tabulated(
            vec![0.0, 300.0, 310.0, 4e3, 4.01e3, 9e3, 60e3],
            vec![1.0, 1.0, 0.1, 0.2, 1e-6, 1e-7, 0.0],
            kind,
        );
        airs.push((
            format!("table {kind:?}"),
            with([absorber(table.unwrap(), 2e-4)]),
        ));
    }
    for kind in [AerosolType::Desert, AerosolType::Arctic, AerosolType::Urban] {
        airs.push((
            format!("{kind:?}"),
            with([absorber(kind.profile(0.0), 2e-4)]),
        ));
    }
    let mut cut = Preset::Hazy.atmosphere();
    cut.planet.top_altitude_m = 9e3;
    airs.push(("hazy, cut at 9 km".to_owned(), cut));
    let mut puffy = mars();
    puffy.planet.radius_m = 5e5;
    puffy.planet.top_altitude_m = 3e5;
    airs.push(("a small planet".to_owned(), puffy));
    airs
}

/// Columns along an ascending ray by quadrature in 12 parts of each interval of height between kinks.
fn by_quadrature(air: &Atmosphere, radius_m: f64, mu: f64) -> PerConstituent {
    let rule = GaussRule::new(8);
    let ray = Ray {
        radius_m,
        mu,
        mu_sun: 1.0,
        nu: 0.0,
    };
    let planet = &air.planet;
    let mut out = [0.0; MAX_CONSTITUENTS];
    for (column, part) in out.iter_mut().zip(&air.constituents) {
        let structure = part.density.structure();
        let mut heights = structure.kinks_m;
        heights.extend(structure.ramps_m.into_iter().flatten());
        for decay in structure.decays {
            heights.extend((0..32).map(|k| {
                decay.from_m.max(planet.ground_altitude_m) + f64::from(k) * decay.scale_height_m
            }));
        }
        let start_m = radius_m - planet.radius_m;
        heights.retain(|&h| h > start_m && h < planet.top_altitude_m);
        heights.extend([start_m, planet.top_altitude_m]);
        heights.sort_by(f64::total_cmp);
        heights.dedup();
        for pair in heights.windows(2) {
            let edge = |k: i32| {
                let height = pair[0] + (pair[1] - pair[0]) * f64::from(k) / 12.0;
                if k == 0 && pair[0] == start_m {
                    return 0.0;
                }
                let crossed = ray.crossings(planet.radius_m + height);
                crossed.map_or(0.0, |(_, t)| t)
            };
            for k in 0..12 {
                // Densities are evaluated inside the interval, not at jumps.
                let (from, to) = (edge(k), edge(k + 1));
                *column += rule.integrate(from, to, |t| {
                    let height = start_m + ray.climb_at(t);
                    part.density
                        .at(height.clamp(pair[0] + 1e-9, pair[1] - 1e-9))
                });
            }
        }
    }
    out
}

/// Columns to space by quadrature for a ray that misses the ground.
fn reference(air: &Atmosphere, radius_m: f64, mu: f64) -> PerConstituent {
    if mu >= 0.0 {
        return by_quadrature(air, radius_m, mu);
    }
    let tangent = radius_m * ((1.0 - mu) * (1.0 + mu)).sqrt();
    let (beyond, above) = (
        by_quadrature(air, tangent, 0.0),
        by_quadrature(air, radius_m, -mu),
    );
    std::array::from_fn(|c| 2.0 * beyond[c] - above[c])
}

fn altitudes_m(air: &Atmosphere) -> Vec<f64> {
    let (ground, top) = (air.planet.ground_altitude_m, air.planet.top_altitude_m);
    let mut all: Vec<f64> = (0..23)
        .map(|k| ground + (top - ground) * (f64::from(k) / 23.0).powi(2))
        .collect();
    all.extend([1000.0, 500.0, 100.0, 10.0, 1.0, 0.01, 0.0].map(|below| top - below));
    for part in &air.constituents {
        for kink in part.density.breakpoints_m() {
            all.extend([-500.0, -20.0, -1.0, -1e-3, 0.0, 1e-3, 3.0, 100.0].map(|d| kink + d));
        }
    }
    all.retain(|&h| h >= ground && h <= top);
    all
}

#[test]
fn transmittances_match_quadrature_at_every_height() {
    let presets = Preset::ALL
        .iter()
        .map(|p| (format!("{p:?}"), p.atmosphere()));
    for (name, air) in presets.chain(extreme_airs()) {
        let columns = SlantColumns::new(Shell::new(&air, true).unwrap());
        let shell = &columns.shell;
        let depth = |columns: &PerConstituent, nm: f64| -> f64 {
            let parts = air.constituents.iter().zip(columns);
            parts.map(|(part, n)| part.extinction_per_m(nm) * n).sum()
        };
        for altitude_m in altitudes_m(&air) {
            let radius_m = air.planet.radius_m + altitude_m;
            let horizon = -(shell.ground_radius_m / radius_m).min(1.0).acos().sin();
            for mu in [1.0, 0.7, 0.3, 0.1, 0.05, 0.02, 0.01, 3e-3, 1e-3, 1e-4, 0.0]
                .into_iter()
                .chain([0.02, 0.3, 0.7, 0.97].map(|f| f * horizon))
            {
                let want = reference(&air, radius_m, mu);
                let ray = Ray {
                    radius_m,
                    mu,
                    mu_sun: 1.0,
                    nu: mu,
                };
                let (_, end_m) = ray.crossings(shell.top_radius_m).unwrap();
                let along = columns.along_m(&ray, (0.0, end_m), &mut Vec::new());
                let half = columns.along_m(&ray, (0.0, 0.5 * end_m), &mut Vec::new());
                let rest = columns.along_m(&ray, (0.5 * end_m, end_m), &mut Vec::new());
                let parts = std::array::from_fn(|c| half[c] + rest[c]);
                for nm in [360.0, 450.0, 600.0, 830.0] {
                    let want = (-depth(&want, nm)).exp();
                    for got in [columns.to_space_m(radius_m, mu), along, parts] {
                        let got = (-depth(&got, nm)).exp();
                        assert!(
                            (got - want).abs() < 5e-4 * (want + 1e-6) && got <= 1.0,
                            "{name}, {altitude_m} m, mu {mu}, {nm} nm: {got} for {want}"
                        );
                    }
                }
            }
        }
    }
}
