//! Mars: carbon dioxide and suspended dust.

use super::fixed_table::{fixed_table, sampled};
use super::molecules::carbon_dioxide_m2;
use crate::atmosphere::{
    Atmosphere, Constituent, ConstituentKind, DensityProfile, Interpolation, Planet,
};
use crate::optics::rayleigh::number_density_per_m3;
use crate::optics::{Depolarization, PhaseFunction, TabulatedPhase};
use crate::spectrum::{SpectralCurve, embedded_table, solar};
use crate::sun::SunDisc;

/// Mean distance of Mars from the sun, AU.
pub(crate) const MARS_DISTANCE_AU: f64 = 1.5237;
/// Scale height of gas and dust, m.
const SCALE_HEIGHT_M: f64 = 11.1e3;
/// Mean surface pressure (Pa) and mean temperature of the lower atmosphere (K).
pub(in crate::atmosphere) const MARS_PRESSURE_PA: f64 = 610.0;
const TEMPERATURE_K: f64 = 210.0;
/// Vertical optical depth of the dust at 880 nm: between the clear season (0.3 to 0.4) and the dusty season (1.25 and
/// more) as measured from the ground (Lemmon et al., Icarus 251, 96, 2015; Chen-Chen et al., Icarus 319, 43, 2019).
const DUST_DEPTH_880: f64 = 0.5;

/// Vertical optical depth of the dust of [`dust_storm`] at 880 nm.
const STORM_DEPTH_880: f64 = 8.5;
/// Conrath's parameter of the vertical profile of [`dust_storm`].
const STORM_CONRATH: f64 = 0.005;

/// Mars on a moderately dusty day.
///
/// - Radius 3389.5 km; gas and dust with a scale height of 11.1 km (dust 11 to 19 km at three sites, Lemmon et al. 2015).
/// - Gas: carbon dioxide at 610 Pa and 210 K, reduced by 2.8 % for the lighter gases; optical depth 0.0065 at 440 nm.
/// - Dust: optical depth 0.5 at 880 nm, nearly grey (exponent -0.09, Lemmon et al. 2024); single-scattering albedo 0.73
///   at 388 nm rising to 0.98 at 700 nm (Wolff et al., J. Geophys. Res. 114, E00D04, 2009), which makes the sky
///   butterscotch; phase function by wavelength, with a diffraction peak that is narrower and higher in the blue, which
///   makes the glow around the low sun blue (Ehlers et al., Appl. Opt. 53, 1808, 2014). At 650 nm it lies within 15 % of
///   the sky measurements of Chen-Chen et al. (Icarus 330, 16, 2019) from 0 to 150 degrees.
/// - Ground: rounded albedo of bright, dusty regions (0.07 at 440 nm, 0.29 at 680 nm), accurate to about 20 %.
/// - Sun: the solar spectrum at the Earth divided by 1.5237^2, and a disc 1.5237 times smaller.
pub fn mars() -> Atmosphere {
    let dust = DensityProfile::exponential(SCALE_HEIGHT_M);
    under_dust("mars", DUST_DEPTH_880, dust)
}

/// Mars in a planet-encircling dust storm.
///
/// - Dust: optical depth 8.5 at 880 nm, the largest that Curiosity measured in the storm of 2018 (Guzewich et al., Geophys. Res. Lett.
///   46, 71, 2019).
/// - Height: the profile of Conrath (Icarus 24, 36, 1975), `exp(-z / H) exp(nu (1 - exp(z / H)))`, with a scale height of 11.1 km and
///   `nu` 0.005: a mixing ratio that is uniform up to about 40 km and falls to a third at 60 km, as in the storm of 2018, when dust
///   reached 60 to 80 km (Kass et al., Geophys. Res. Lett. 47, e2019GL083931, 2020).
/// - All else is that of [`mars`].
pub fn dust_storm() -> Atmosphere {
    let altitudes_m: Vec<f64> = (0..=50).map(|i| 2e3 * f64::from(i)).collect();
    let density = |z: &f64| {
        let thinner = (z / SCALE_HEIGHT_M).exp();
        (STORM_CONRATH * (1.0 - thinner)).exp() / thinner
    };
    let densities = altitudes_m.iter().map(density).collect();
    let dust = DensityProfile::tabulated(altitudes_m, densities, Interpolation::LogLinear)
        .expect("constant tables are valid");
    under_dust("dust-storm", STORM_DEPTH_880, dust)
}

/// Mars under dust of this optical depth at 880 nm and this density profile.
fn under_dust(name: &str, depth_880: f64, dust_density: DensityProfile) -> Atmosphere {
    let density = DensityProfile::exponential(SCALE_HEIGHT_M);
    let top_m = 120e3;
    let molecules = 0.972 * number_density_per_m3(MARS_PRESSURE_PA, TEMPERATURE_K);
    let column_m = dust_density.column_m(0.0, top_m);
    let extinction = |nm: f64| depth_880 * (nm / 880.0).powf(0.09) / column_m;
    let albedo = fixed_table(&[
        (388.0, 0.730),
        (440.0, 0.777),
        (550.0, 0.888),
        (650.0, 0.967),
        (700.0, 0.977),
        (800.0, 0.980),
    ]);
    let dust = |of: &dyn Fn(f64) -> f64| {
        let samples = (30..=110)
            .map(|i| 10.0 * f64::from(i))
            .map(|nm| (nm, of(albedo.at(nm)) * extinction(nm)));
        fixed_table(&samples.collect::<Vec<_>>())
    };
    let distance = MARS_DISTANCE_AU;
    Atmosphere {
        name: name.into(),
        planet: Planet {
            radius_m: 3_389.5e3,
            top_altitude_m: top_m,
            ground_altitude_m: 0.0,
            ground_albedo: fixed_table(&[
                (400.0, 0.06),
                (440.0, 0.07),
                (500.0, 0.10),
                (550.0, 0.15),
                (600.0, 0.24),
                (680.0, 0.29),
                (750.0, 0.31),
            ]),
        },
        constituents: vec![
            Constituent {
                kind: ConstituentKind::Molecules,
                density,
                scattering_per_m: sampled(|nm| molecules * carbon_dioxide_m2(nm)),
                absorption_per_m: SpectralCurve::Constant(0.0),
                // From the King factor at 550 nm.
                phase: PhaseFunction::Rayleigh(Depolarization::Factor(0.079)),
            },
            Constituent {
                kind: ConstituentKind::Aerosol,
                density: dust_density,
                scattering_per_m: dust(&|albedo| albedo),
                absorption_per_m: dust(&|albedo| 1.0 - albedo),
                phase: PhaseFunction::Tabulated(dust_phase()),
            },
        ],
        solar_irradiance: SpectralCurve::Table(solar::extraterrestrial().clone())
            .scaled(distance.powi(-2)),
        sun: SunDisc::at_distance_au(distance).unwrap_or_default(),
    }
}

fn dust_phase() -> TabulatedPhase {
    let rows = embedded_table::<7>(include_str!("../../../data/atmosphere/mars_dust_phase.txt"));
    let values = (1..7)
        .flat_map(|w| rows.iter().map(move |row| row[w]))
        .collect();
    let wavelengths = vec![388.0, 440.0, 550.0, 650.0, 700.0, 800.0];
    TabulatedPhase::new(rows.iter().map(|row| row[0]).collect(), wavelengths, values)
        .expect("the embedded table is valid")
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn carbon_dioxide_is_thin() {
        let gas = mars()
            .constituent(&ConstituentKind::Molecules)
            .unwrap()
            .optical_depth(0.0, 120e3, 440.0);
        assert!((gas / 0.0065 - 1.0).abs() < 0.03, "{gas}");
    }

    #[test]
    fn the_dust_of_a_storm_is_mixed_up_to_sixty_kilometres() {
        let storm = dust_storm();
        let dust = storm.constituent(&ConstituentKind::Aerosol).unwrap();
        let depth = dust.optical_depth(0.0, 120e3, 880.0);
        assert!((depth / 8.5 - 1.0).abs() < 1e-3, "{depth}");
        let mixing = |z: f64| dust.density.at(z) / DensityProfile::exponential(11.1e3).at(z);
        assert!(mixing(40e3) > 0.8 && (0.3..0.4).contains(&mixing(60e3)));
    }

    #[test]
    fn scattering_by_dust_is_blue_near_the_sun_and_yellow_elsewhere() {
        let dust = mars()
            .constituent(&ConstituentKind::Aerosol)
            .unwrap()
            .clone();
        let scattered = |degrees: f64, nm: f64| {
            dust.scattering_per_m.at(nm) * dust.phase.evaluate(degrees.to_radians().cos(), nm)
        };
        assert!(scattered(2.0, 440.0) > 1.4 * scattered(2.0, 650.0));
        for degrees in [10.0, 30.0, 60.0, 90.0, 150.0] {
            assert!(
                scattered(degrees, 440.0) < 0.8 * scattered(degrees, 650.0),
                "{degrees}"
            );
            assert!(
                scattered(degrees, 550.0) < scattered(degrees, 650.0),
                "{degrees}"
            );
        }
        // Mean cosines to which the table was made.
        for (nm, g) in [
            (440.0, 0.766),
            (550.0, 0.693),
            (650.0, 0.684),
            (700.0, 0.711),
        ] {
            assert!(
                (dust.phase.asymmetry(nm) - g).abs() < 2e-3,
                "{nm}: {}",
                dust.phase.asymmetry(nm)
            );
        }
        let fit = |mu: f64| {
            let hg = |g: f64| (1.0 - g * g) / (4.0 * PI * (1.0 + g * g - 2.0 * g * mu).powf(1.5));
            0.743 * hg(0.889) + 0.257 * hg(0.094)
        };
        for degrees in 0..=150 {
            let mu = f64::from(degrees).to_radians().cos();
            let ratio = dust.phase.evaluate(mu, 650.0) / fit(mu);
            assert!((ratio - 1.0).abs() < 0.16, "{degrees} degrees: {ratio}");
        }
        assert!((dust.optical_depth(0.0, 120e3, 880.0) / 0.5 - 1.0).abs() < 1e-3);
    }
}
