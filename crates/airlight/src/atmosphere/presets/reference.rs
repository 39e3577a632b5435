//! Atmospheres of published comparisons, exactly as published: solvers are tested against their reference values.
//!
//! All have an Earth radius of 6360 km, a top at 60 km, and scale heights of 8 km (molecules) and 1.2 km (aerosol).

use super::fixed_table::fixed_table;
use crate::atmosphere::{Atmosphere, Constituent, ConstituentKind, DensityProfile, Planet};
use crate::optics::{Depolarization, PhaseFunction};
use crate::spectrum::{SpectralCurve, embedded_table};
use crate::sun::SunDisc;

const ZERO: SpectralCurve = SpectralCurve::Constant(0.0);

fn planet(ground_albedo: SpectralCurve) -> Planet {
    Planet {
        radius_m: 6_360e3,
        top_altitude_m: 60e3,
        ground_altitude_m: 0.0,
        ground_albedo,
    }
}

fn molecules(scattering_per_m: SpectralCurve) -> Constituent {
    Constituent {
        kind: ConstituentKind::Molecules,
        density: DensityProfile::exponential(8e3),
        scattering_per_m,
        absorption_per_m: ZERO,
        phase: PhaseFunction::Rayleigh(Depolarization::None),
    }
}

fn aerosol(
    scattering_per_m: SpectralCurve,
    absorption_per_m: SpectralCurve,
    g: f64,
) -> Constituent {
    Constituent {
        kind: ConstituentKind::Aerosol,
        density: DensityProfile::exponential(1.2e3),
        scattering_per_m,
        absorption_per_m,
        phase: PhaseFunction::CornetteShanks { g },
    }
}

/// Molecules only: sea-level scattering 5.8, 13.5, 33.1 per 1000 km at 680, 550, 440 nm (linear between), solar irradiance
/// 1, and this ground albedo (there are reference values for 0 and 0.3).
pub fn rayleigh(ground_albedo: f64) -> Atmosphere {
    Atmosphere {
        name: "reference-rayleigh".into(),
        planet: planet(SpectralCurve::Constant(ground_albedo)),
        constituents: vec![molecules(fixed_table(&[
            (440.0, 33.1e-6),
            (550.0, 13.5e-6),
            (680.0, 5.8e-6),
        ]))],
        solar_irradiance: SpectralCurve::Constant(1.0),
        sun: SunDisc::default(),
    }
}

/// The Earth of the demonstration of E. Bruneton's "Precomputed Atmospheric Scattering: a New Implementation" (2017):
/// molecules 1.24062e-6 (lambda/um)^-4 per m, aerosol of optical depth 5.328e-3 at every wavelength with
/// single-scattering albedo 0.9 and Cornette-Shanks g = 0.8, 300 Dobson units of ozone as a tent with corners at 10, 25
/// and 40 km, ground albedo 0.1. Ozone and sun are given at 680, 550 and 440 nm; linear between.
pub fn earth_demo() -> Atmosphere {
    let dobson_unit_m2 = 2.687e20;
    // The column of the tent is 15 km at peak density.
    let peak_per_m3 = 300.0 * dobson_unit_m2 / 15e3;
    let cross_sections_m2 =
        fixed_table(&[(440.0, 1.582e-26), (550.0, 3.5e-25), (680.0, 1.209e-25)]);
    let ozone = Constituent {
        kind: ConstituentKind::Ozone,
        density: DensityProfile::Tent {
            bottom_m: 10e3,
            peak_m: 25e3,
            top_m: 40e3,
        },
        scattering_per_m: ZERO,
        absorption_per_m: cross_sections_m2.scaled(peak_per_m3),
        phase: PhaseFunction::Isotropic,
    };
    let mie_extinction = 5.328e-3 / 1.2e3;
    Atmosphere {
        name: "reference-earth-demo".into(),
        planet: planet(SpectralCurve::Constant(0.1)),
        constituents: vec![
            molecules(SpectralCurve::PowerLaw {
                value_at_550_nm: 1.24062e-6 * 0.55f64.powi(-4),
                exponent: 4.0,
            }),
            aerosol(
                SpectralCurve::Constant(0.9 * mie_extinction),
                SpectralCurve::Constant(0.1 * mie_extinction),
                0.8,
            ),
            ozone,
        ],
        solar_irradiance: fixed_table(&[(440.0, 1.91198), (550.0, 1.8504), (680.0, 1.474)]),
        sun: SunDisc::default(),
    }
}

/// The atmosphere of Bruneton's comparison of clear-sky models (IEEE TVCG 23(12), 2017) at its 40 wavelengths: aerosol
/// of optical depth 0.04 (lambda/um)^-0.8, single-scattering albedo 0.8, Cornette-Shanks g = 0.7, no ozone, grass.
pub fn csm() -> Atmosphere {
    let rows = embedded_table::<6>(include_str!("../../../data/atmosphere/csm_atmosphere.txt"));
    let column = |of: fn(&[f64; 6]) -> f64| {
        fixed_table(&rows.iter().map(|row| (row[0], of(row))).collect::<Vec<_>>())
    };
    Atmosphere {
        name: "reference-csm".into(),
        planet: planet(column(|row| row[5])),
        constituents: vec![
            molecules(column(|row| row[2])),
            aerosol(column(|row| row[4]), column(|row| row[3] - row[4]), 0.7),
        ],
        solar_irradiance: column(|row| row[1]),
        sun: SunDisc::default(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn references_are_valid() {
        for atmosphere in [rayleigh(0.0), rayleigh(0.3), earth_demo(), csm()] {
            atmosphere.validate().unwrap();
        }
    }

    #[test]
    fn optical_depths_match_the_publications() {
        let demo = earth_demo();
        let part = |kind, nm: f64| {
            demo.constituent(&kind)
                .unwrap()
                .optical_depth(0.0, 60e3, nm)
        };
        assert!((part(ConstituentKind::Aerosol, 550.0) / 5.328e-3 - 1.0).abs() < 1e-12);
        assert!(
            (part(ConstituentKind::Ozone, 550.0) / (300.0 * 2.687e20 * 3.5e-25) - 1.0).abs()
                < 1e-12
        );
        assert!(
            (demo
                .constituent(&ConstituentKind::Molecules)
                .unwrap()
                .scattering_per_m
                .at(680.0)
                / 5.8022e-6
                - 1.0)
                .abs()
                < 1e-4
        );
        let csm = csm();
        let depth = csm
            .constituent(&ConstituentKind::Aerosol)
            .unwrap()
            .optical_depth(0.0, 60e3, 360.0);
        assert!(
            (depth / (0.04 * 0.36f64.powf(-0.8)) - 1.0).abs() < 1e-6,
            "{depth}"
        );
        assert_eq!(csm.planet.ground_albedo.at(360.0), 0.0179999992);
    }
}
