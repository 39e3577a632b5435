//! Atmospheres of published sky models, with their published constants.

use super::fixed_table::fixed_table;
use super::reference;
use crate::atmosphere::{Atmosphere, Constituent, ConstituentKind, DensityProfile, Planet};
use crate::optics::{Depolarization, PhaseFunction};
use crate::spectrum::{SpectralCurve, embedded_table, solar};
use crate::sun::{LimbDarkening, SunDisc};

const ZERO: SpectralCurve = SpectralCurve::Constant(0.0);

/// A spectrum published for red, green and blue, assigned to 680, 550 and 440 nm; linear between, constant beyond.
fn rgb([red, green, blue]: [f64; 3], factor: f64) -> SpectralCurve {
    fixed_table(&[
        (440.0, blue * factor),
        (550.0, green * factor),
        (680.0, red * factor),
    ])
}

/// The constants of the article "Sky and Atmosphere rendering: A physical approach", as printed: Rayleigh (5.8, 13.5,
/// 33.1)e-6 per m with 8 km, Mie 21e-6 per m with 1.2 km, extinction 1.11 times that, Henyey-Greenstein g = 0.76, and an
/// absorption (3.426, 8.298, 0.356) x 0.06e-5 per m, called ozone, with the Rayleigh profile. Planet radius 6360 km, top
/// at 60 km, black ground.
///
/// The solar irradiance is chosen such that direct light of the zenith sun is white at the ground, with 120 000 lx:
/// 1.6442 W m^-2 nm^-1 at every wavelength, divided by the zenith transmittance from the article's eye at 1 m. Uniform
/// disc, 0.53 degrees in diameter.
pub fn sky_article() -> Atmosphere {
    let mie = 21e-6;
    let part = |kind, height, scattering_per_m, absorption_per_m, phase| Constituent {
        kind,
        density: DensityProfile::exponential(height),
        scattering_per_m,
        absorption_per_m,
        phase,
    };
    let mut atmosphere = Atmosphere {
        name: "sky-article".into(),
        planet: Planet {
            radius_m: 6_360e3,
            top_altitude_m: 60e3,
            ground_altitude_m: 0.0,
            ground_albedo: ZERO,
        },
        constituents: vec![
            part(
                ConstituentKind::Molecules,
                8e3,
                rgb([5.8, 13.5, 33.1], 1e-6),
                ZERO,
                PhaseFunction::Rayleigh(Depolarization::None),
            ),
            part(
                ConstituentKind::Aerosol,
                1.2e3,
                SpectralCurve::Constant(mie),
                SpectralCurve::Constant(0.11 * mie),
                PhaseFunction::HenyeyGreenstein { g: 0.76 },
            ),
            part(
                ConstituentKind::Ozone,
                8e3,
                ZERO,
                rgb([3.426, 8.298, 0.356], 0.06e-5),
                PhaseFunction::Isotropic,
            ),
        ],
        solar_irradiance: ZERO,
        sun: SunDisc {
            angular_radius_rad: (0.5 * 0.53f64).to_radians(),
            limb_darkening: LimbDarkening::Uniform,
        },
    };
    let at_ground = 120_000.0 / (683.002 * 106.856_9);
    let over_transmittance = |nm: f64| {
        let depth: f64 = atmosphere
            .constituents
            .iter()
            .map(|c| c.optical_depth(1.0, 60e3, nm))
            .sum();
        at_ground * depth.exp()
    };
    atmosphere.solar_irradiance =
        fixed_table(&[440.0, 550.0, 680.0].map(|nm| (nm, over_transmittance(nm))));
    atmosphere
}

/// The Earth of E. Bruneton's "Precomputed Atmospheric Scattering: a New Implementation" (2017), demonstration, with
/// its spectral tables (every 10 nm, linear between): [`reference::earth_demo`] for all wavelengths. Uniform disc with a
/// radius of 4.675 mrad.
pub fn bruneton() -> Atmosphere {
    let rows = embedded_table::<3>(include_str!("../../../data/atmosphere/bruneton_demo.txt"));
    let column =
        |i: usize| fixed_table(&rows.iter().map(|row| (row[0], row[i])).collect::<Vec<_>>());
    let mut atmosphere = reference::earth_demo();
    atmosphere.name = "bruneton".into();
    atmosphere.solar_irradiance = column(1);
    for part in atmosphere
        .constituents
        .iter_mut()
        .filter(|part| part.kind == ConstituentKind::Ozone)
    {
        part.absorption_per_m = column(2).scaled(300.0 * 2.687e20 / 15e3);
    }
    atmosphere.sun = SunDisc {
        angular_radius_rad: 0.00935 / 2.0,
        limb_darkening: LimbDarkening::Uniform,
    };
    atmosphere
}

/// The Earth of S. Hillaire, "A Scalable and Production Ready Sky and Atmosphere Rendering Technique", Computer
/// Graphics Forum 39(4), 2020, table 1: Rayleigh (5.802, 13.558, 33.1)e-6 per m with 8 km, Mie scattering 3.996e-6 and
/// absorption 4.40e-6 per m with 1.2 km, Cornette-Shanks g = 0.8, ozone (0.650, 1.881, 0.085)e-6 per m as a tent with
/// corners at 10, 25 and 40 km; ground 6360 km, top 6460 km.
///
/// The table does not specify ground albedo and sun: 0.3 and the measured solar spectrum are used here.
pub fn hillaire() -> Atmosphere {
    let part = |kind, density, scattering_per_m, absorption_per_m, phase| Constituent {
        kind,
        density,
        scattering_per_m,
        absorption_per_m,
        phase,
    };
    Atmosphere {
        name: "hillaire".into(),
        planet: Planet {
            radius_m: 6_360e3,
            top_altitude_m: 100e3,
            ground_altitude_m: 0.0,
            ground_albedo: SpectralCurve::Constant(0.3),
        },
        constituents: vec![
            part(
                ConstituentKind::Molecules,
                DensityProfile::exponential(8e3),
                rgb([5.802, 13.558, 33.1], 1e-6),
                ZERO,
                PhaseFunction::Rayleigh(Depolarization::None),
            ),
            part(
                ConstituentKind::Aerosol,
                DensityProfile::exponential(1.2e3),
                SpectralCurve::Constant(3.996e-6),
                SpectralCurve::Constant(4.40e-6),
                PhaseFunction::CornetteShanks { g: 0.8 },
            ),
            part(
                ConstituentKind::Ozone,
                DensityProfile::Tent {
                    bottom_m: 10e3,
                    peak_m: 25e3,
                    top_m: 40e3,
                },
                ZERO,
                rgb([0.650, 1.881, 0.085], 1e-6),
                PhaseFunction::Isotropic,
            ),
        ],
        solar_irradiance: SpectralCurve::Table(solar::extraterrestrial().clone()),
        sun: SunDisc::default(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spectrum::color_matching;

    #[test]
    fn the_zenith_sun_of_the_article_is_white_with_120_klx() {
        let atmosphere = sky_article();
        for nm in [440.0, 550.0, 680.0] {
            let direct =
                atmosphere.solar_irradiance.at(nm) * (-atmosphere.vertical_optical_depth(nm)).exp();
            assert!((direct / 1.6442 - 1.0).abs() < 1e-4, "{nm}: {direct}");
        }
        let v: f64 = (360..=830).map(|nm| color_matching(f64::from(nm))[1]).sum();
        assert!((683.002 * 1.6442 * v / 120e3 - 1.0).abs() < 1e-3, "{v}");
        let aerosol = atmosphere.constituent(&ConstituentKind::Aerosol).unwrap();
        assert!((aerosol.extinction_per_m(550.0) / 21e-6 - 1.11).abs() < 1e-12);
    }

    #[test]
    fn bruneton_equals_the_reference_at_its_three_wavelengths() {
        let (full, three) = (bruneton(), reference::earth_demo());
        for nm in [440.0, 550.0, 680.0] {
            assert!(
                (full.vertical_optical_depth(nm) / three.vertical_optical_depth(nm) - 1.0).abs()
                    < 1e-12
            );
            assert_eq!(full.solar_irradiance.at(nm), three.solar_irradiance.at(nm));
        }
    }

    #[test]
    fn the_ozone_of_hillaire_is_300_dobson_units() {
        let ozone = hillaire()
            .constituent(&ConstituentKind::Ozone)
            .unwrap()
            .clone();
        let depth = ozone.optical_depth(0.0, 100e3, 550.0);
        assert!(
            (depth / (300.0 * 2.687e20 * 3.5e-25) - 1.0).abs() < 1e-3,
            "{depth}"
        );
    }
}
